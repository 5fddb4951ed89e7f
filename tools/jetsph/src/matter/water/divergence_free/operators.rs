//! Divergence, moments and couplings of a row of neighbours.
//!
//! With the weights w = -V (dW/dr)/r of the neighbours, s = -w, and B the inverse of the sum of w x x,
//!
//! ```text
//! grad p = B sum_b s x_ab (p_b - p_a)        div u = B : sum_b s x_ab (u_b - u_a)        (Bonet and Lok 1999)
//! lap p = 2/m sum_b w (p_b - p_a)            m = 1/D sum_b w r^2                           (Brookshaw 1985)
//! ```
//!
//! Images beyond plain walls are neighbours with mirrored velocities and, but for the weight, the same pressure. Water that a
//! nozzle leads has the velocity 2 U - u_a: the face between it and free water moves with U.
//!
//! What a particle of the surface lacks of the weights that the lattice has stands one spacing away across the surface,
//! mirrored there: its pressure is -p_a, its velocity that of the particle, and it adds to the moments. Where particles lie
//! scattered B means little, and the lattice's stands for it.

use kernels::Kernel;
use kernels::moments::{Moments, beyond, inverse, times, within};

use super::filled::Filled;
use super::shore::Partner;
use crate::matter::water::around::Around;
use crate::matter::water::seen::Seen;

/// Lack of weight, in parts of the lattice's, from which on a particle lies at the surface, and at which it does so wholly.
const LACKS: [f64; 2] = [0.10, 0.20];
/// Part of the lattice's weight up to which B is the lattice's, and from which on it is the row's own.
const TRUST: [f64; 2] = [0.45, 0.60];

/// What the operators need of a row.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    /// Sum of w over those to which the pressure is coupled \[1/m2\].
    pub(super) coupled: f64,
    /// Sum of w over all free water, its own images included \[1/m2\].
    pub(super) free: f64,
    /// Weight that the surface lacks \[1/m2\].
    pub(super) missing: f64,
    /// Sum of w over all, over that of the lattice \[1\].
    pub(super) fill: f64,
    /// Sum of s x: towards the neighbours \[1/m\].
    pub(super) inwards: [f64; 3],
    /// The part of it that is the surface's; zero in the inside \[1/m\].
    pub(super) open: [f64; 3],
    /// B: xx, yy, zz, xy, xz, yz \[1\].
    pub(super) inverse: Moments,
    /// Mean moment along an axis, what is missing included \[1\].
    pub(super) moment: f64,
    /// Sum of V W, the own one included \[1\].
    pub(super) number: f64,
    /// div u \[1/s\].
    pub(super) divergence: f64,
    /// grad u: of each axis the change of u along it \[1/s\].
    pub(super) slope: [[f64; 3]; 3],
}

impl Sums {
    /// |grad u| \[1/s\].
    pub(super) fn strain(&self) -> f64 {
        self.slope
            .iter()
            .flatten()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt()
    }
}

/// Couplings of some rows.
#[derive(Debug, Clone, Default)]
pub(super) struct Couplings {
    /// Ends of the rows.
    pub(super) ends: Vec<u32>,
    /// Whom, and w \[1/m2\].
    pub(super) with: Vec<(u32, f64)>,
}

/// Whether a nozzle leads what is seen.
#[inline(always)]
pub(super) fn is_led(seen: &Seen) -> bool {
    seen.value > 0.0
}

/// What is gathered over a row.
#[derive(Debug, Clone, Copy, Default)]
struct Gathered {
    all: f64,
    sums: Sums,
    moments: Moments,
    change: [[f64; 3]; 3],
}

impl Gathered {
    #[inline(always)]
    fn add(&mut self, own: &Seen, other: &Seen, x: [f64; 3], w: f64, value: f64) {
        self.all += w;
        self.sums.number += other.volume * value;
        let twice = if is_led(other) { 2.0 } else { 1.0 };
        let step = [0, 1, 2].map(|k| twice * (other.u[k] - own.u[k]));
        let [p, q, r] = x.map(|x| -w * x);
        for (k, way) in [p, q, r].into_iter().enumerate() {
            self.sums.inwards[k] += way;
            (0..3).for_each(|i| self.change[k][i] += way * step[i]);
        }
        let squares = [p * x[0], q * x[1], r * x[2], p * x[1], p * x[2], q * x[2]];
        (0..6).for_each(|i| self.moments[i] -= squares[i]);
        if !is_led(other) {
            self.sums.free += w;
        }
    }
}

impl Sums {
    /// Those of particle `a`; its couplings are added to `with`.
    pub(super) fn of<const D: usize, K: Kernel>(
        around: &Around<K>,
        a: usize,
        is_beside: bool,
        filled: &Filled,
        partners: &[Partner],
        with: &mut Vec<(u32, f64)>,
    ) -> Self {
        let own = &around.seen[a];
        let mut gathered = Gathered::default();
        gathered.sums.number = own.volume * around.kernel.value(0.0);
        let mut coupled = 0.0;
        let mut add = |b: usize, other: &Seen, x: [f64; 3], square: f64, slope: f64| {
            // A film that lies on a wall is no more filled by its own images than one half a spacing above it.
            let slope = if b == a && square < filled.spacing * filled.spacing {
                around.kernel.slope(filled.spacing)
            } else {
                slope
            };
            let w = -other.volume * slope;
            let value = around.kernel.value(square.sqrt());
            gathered.add(own, other, x, w, value);
            if !is_led(other) && b != a {
                coupled += w;
                with.push((b as u32, w));
            }
        };
        around.each(a, &mut add);
        if is_beside {
            around.mirrored(a, |(_, b), other, x, square, slope| {
                add(b, other, x, square, slope)
            });
        }
        for partner in partners {
            let led = partner.led(own.u);
            add(usize::MAX, &led, partner.dx, partner.square, partner.slope);
        }
        gathered.sums.coupled = coupled;
        gathered.ended::<D>(filled)
    }
}

impl Gathered {
    fn ended<const D: usize>(self, filled: &Filled) -> Sums {
        let Self {
            all,
            mut sums,
            mut moments,
            change,
        } = self;
        sums.fill = all / filled.weight;
        let part = within(1.0 - sums.fill, LACKS);
        sums.missing = part * (filled.weight - all).max(0.0);
        sums.moment =
            (moments[0] + moments[1] + moments[2] + sums.missing * filled.beside) / D as f64;
        if sums.missing > 0.0 {
            sums.open = sums.inwards.map(|x| part * x);
            beyond::<D>(&mut moments, sums.open, sums.missing, filled.spacing);
        }
        if D == 2 {
            moments[2] = filled.moment;
        }
        sums.inverse = inverse(moments, filled.moment, within(sums.fill, TRUST));
        // grad u = B change, by columns.
        let columns = [0, 1, 2].map(|i| times(sums.inverse, change.map(|row| row[i])));
        sums.slope = [0, 1, 2].map(|k| columns.map(|column| column[k]));
        sums.divergence = (0..D).map(|k| sums.slope[k][k]).sum();
        sums
    }
}
