//! Clouds on which operators by weighted least squares are measured, and what they err by.
//!
//! The cloud is the unit square or cube: a lattice, jittered by 10 or 30 % of the spacing, or by 10 % and
//!
//! - `graded`: the spacing grows three times along x;
//! - `half`: supports have no points with greater x than their own, but near the face x = 0;
//! - `near-coplanar`: the two layers in the middle lie in one plane but for a thousandth of the spacing, one between the
//!   other's points; rows on a line in a plane.

pub mod measured;

use std::collections::BTreeMap;

use wls::{Cloud, Metric, Plan, Rules, Search, Stencils, Wants};

/// A cloud.
#[derive(Debug)]
pub struct Points<const D: usize> {
    places: Vec<[f64; D]>,
    metrics: Vec<Metric<D>>,
    half: bool,
    spacing: f64,
}

impl<const D: usize> Rules<D> for Points<D> {
    fn allowed(&self, i: usize, j: usize) -> bool {
        !self.half || self.places[i][0] < 0.5 || self.places[j][0] <= self.places[i][0]
    }
}

impl<const D: usize> Points<D> {
    /// A cloud of a kind with `side` points along each side.
    #[must_use]
    pub fn new(kind: &str, side: usize) -> Self {
        let spacing = 1.0 / side as f64;
        let jitter = match kind {
            "jitter-30" => 0.3,
            "regular" => 0.0,
            _ => 0.1,
        };
        let mut random = Random(side as u64);
        let mut points = Self {
            places: Vec::new(),
            metrics: Vec::new(),
            half: kind == "half",
            spacing,
        };
        for k in 0..side.pow(D as u32) {
            let cell: [usize; D] = std::array::from_fn(|a| k / side.pow(a as u32) % side);
            let mut place = cell.map(|c| spacing * (c as f64 + 0.5 + jitter * random.next()));
            let mut own = spacing;
            if kind == "graded" {
                // The slope of (x + x^2) / 2 grows from 1/2 to 3/2.
                own *= (0.5 + place[0]).max(1.0);
                place[0] = 0.5 * (place[0] + place[0].powi(2));
            }
            let layer = cell[D - 1];
            if kind == "near-coplanar" && (layer + 1 == side / 2 || layer == side / 2) {
                place[D - 1] = 0.5 + 1e-3 * spacing * random.next();
                let aside = 0.5 * spacing * (layer + 1 - side / 2) as f64;
                for x in &mut place[..D - 1] {
                    *x += aside;
                }
            }
            points.places.push(place);
            points.metrics.push(Metric::round(own));
        }
        points
    }

    /// How many they are.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.places.len() as u64
    }

    /// The mean spacing; the side is 1.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Gradient, and of orders from 2 on Laplacian, of all points.
    ///
    /// # Errors
    /// Where no stencil can be made.
    pub fn stencils(&self, order: u8) -> Result<Stencils<D>, wls::Error> {
        let wants = Wants {
            gradient: true,
            laplacian: order > 1,
            ..Wants::default()
        };
        let search = Search::new(Cloud {
            points: &self.places,
            metrics: &self.metrics,
        })?;
        Stencils::build(&search, &Plan::new::<D>(order, wants), self)
    }

    /// Errors on exp(x) sin(2 y + 1) cos(z), in a plane z = 0, over the largest derivative: root of the mean square and
    /// largest, of the gradient and of the Laplacian.
    #[must_use]
    pub fn smooth(&self, stencils: &Stencils<D>, order: u8) -> BTreeMap<String, f64> {
        let z = |p: &[f64; D]| if D == 3 { p[2] } else { 0.0 };
        let value = |p: &[f64; D]| p[0].exp() * (2.0 * p[1] + 1.0).sin() * z(p).cos();
        let field: Vec<f64> = self.places.iter().map(value).collect();
        let (mut slope, mut bend) = (Norms::default(), Norms::default());
        for (i, p) in self.places.iter().enumerate() {
            let exact = [
                field[i],
                2.0 * p[0].exp() * (2.0 * p[1] + 1.0).cos() * z(p).cos(),
                -p[0].exp() * (2.0 * p[1] + 1.0).sin() * z(p).sin(),
            ];
            for (found, exact) in stencils.gradient_of(&field, i).iter().zip(exact) {
                slope.add(*found, exact);
            }
            if order > 1 {
                let exact = if D == 3 { -4.0 } else { -3.0 } * field[i];
                bend.add(stencils.laplacian(i).apply(&field), exact);
            }
        }
        let mut errors = BTreeMap::new();
        slope.tell("gradient", &mut errors);
        if order > 1 {
            bend.tell("laplacian", &mut errors);
        }
        errors
    }

    /// Greatest error on a polynomial of the degree of the fit that has all its monomials, derivatives counted by the
    /// spacing.
    #[must_use]
    pub fn polynomial(&self, stencils: &Stencils<D>, order: u8) -> f64 {
        let all = monomials::<D>(order);
        let at = |p: &[f64; D], derived: &[usize]| -> f64 {
            all.iter().map(|m| m.derivative(p, derived)).sum()
        };
        let field: Vec<f64> = self.places.iter().map(|p| at(p, &[])).collect();
        let mut worst = 0.0_f64;
        for (i, p) in self.places.iter().enumerate() {
            for (axis, found) in stencils.gradient_of(&field, i).iter().enumerate() {
                worst = worst.max((found - at(p, &[axis])).abs() * self.spacing);
            }
            if order > 1 {
                let exact: f64 = (0..D).map(|axis| at(p, &[axis, axis])).sum();
                let found = stencils.laplacian(i).apply(&field);
                worst = worst.max((found - exact).abs() * self.spacing.powi(2));
            }
        }
        worst
    }
}

/// Sums of errors and the largest.
#[derive(Default)]
struct Norms {
    square: f64,
    worst: f64,
    most: f64,
    count: f64,
}

impl Norms {
    fn add(&mut self, found: f64, exact: f64) {
        let away = (found - exact).abs();
        self.square += away * away;
        // `max` forgets what is no number.
        self.worst = match away.is_nan() || self.worst.is_nan() {
            true => f64::NAN,
            false => self.worst.max(away),
        };
        self.most = self.most.max(exact.abs());
        self.count += 1.0;
    }

    fn tell(&self, name: &str, errors: &mut BTreeMap<String, f64>) {
        let l2 = (self.square / self.count).sqrt() / self.most;
        errors.insert(format!("{name}_l2"), l2);
        errors.insert(format!("{name}_linf"), self.worst / self.most);
    }
}

/// A monomial about the middle, with a factor.
struct Monomial<const D: usize> {
    factor: f64,
    exponents: [i32; D],
}

impl<const D: usize> Monomial<D> {
    /// Its derivative along the axes that are named.
    fn derivative(&self, p: &[f64; D], derived: &[usize]) -> f64 {
        let mut value = self.factor;
        for (axis, (x, e)) in p.iter().zip(self.exponents).enumerate() {
            let times = derived.iter().filter(|a| **a == axis).count() as i32;
            if times > e {
                return 0.0;
            }
            for k in 0..times {
                value *= f64::from(e - k);
            }
            value *= (x - 0.5).powi(e - times);
        }
        value
    }
}

/// All monomials up to a degree, with factors between 1/2 and 1 of either sign.
fn monomials<const D: usize>(degree: u8) -> Vec<Monomial<D>> {
    let side = usize::from(degree) + 1;
    let mut random = Random(7);
    let exponents =
        |k: usize| -> [i32; D] { std::array::from_fn(|a| (k / side.pow(a as u32) % side) as i32) };
    let all = (0..side.pow(D as u32)).map(exponents);
    all.filter(|e| e.iter().sum::<i32>() <= i32::from(degree))
        .map(|exponents| {
            let factor = random.next();
            Monomial {
                factor: 0.5 * (factor + factor.signum()),
                exponents,
            }
        })
        .collect()
}

/// Numbers between -1 and 1 that are the same on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
    }
}
