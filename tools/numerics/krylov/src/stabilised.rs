//! Stabilised bi-conjugate gradients of second order, for several columns.

use crate::columns::{add, add_two, dot, gather, norms, sum, turn};
use crate::ending::PATIENCE;
use crate::operator::{Preconditioned, residual};
use crate::scratch::{Scratch, fits};
use crate::{Breakdown, Ending, Inverse, Operator, Rule, Scalar, Solved, Stagnation, Watch};

/// A divisor this small beside the norms it is made of counts as zero.
const TINY: f64 = 1e-28;
/// Most evaluations of the true residual that begin anew.
const RENEWALS: usize = 8;

/// Scalars of the columns between steps.
struct State<S, const C: usize> {
    rho: [S; C],
    alpha: [S; C],
    omega: [S; C],
    live: [bool; C],
}

impl<S: Scalar, const C: usize> State<S, C> {
    fn new(watch: &Watch<C>) -> Self {
        Self {
            rho: [S::ONE; C],
            alpha: [S::ZERO; C],
            omega: [S::ONE; C],
            live: std::array::from_fn(|c| !watch.done(c)),
        }
    }

    /// `a / b` of the columns that are still at work, zero of the others.
    fn ratio(&self, a: [S; C], b: [S; C], large: [f64; C]) -> Option<[S; C]> {
        let mut ratio = [S::ZERO; C];
        for c in (0..C).filter(|c| self.live[*c]) {
            if b[c].modulus() <= TINY * large[c] || !b[c].finite() {
                return None;
            }
            ratio[c] = a[c] / b[c];
        }
        Some(ratio)
    }
}

/// Stabilised bi-conjugate gradients with minimising steps of second degree, preconditioned from
/// the right (Sleijpen and Fokkema 1993, Electron. Trans. Numer. Anal. 1, 11). `x` is the first
/// guess and becomes the solution. The columns share products with the matrix and have scalars of
/// their own; one that has converged rests. Where the true residual turns out larger than the one
/// that is carried along, the method begins anew from there.
///
/// # Panics
/// When lengths differ.
pub fn bicgstab2<S: Scalar, const C: usize>(
    a: &impl Operator<S, C>,
    rhs: &[[S; C]],
    x: &mut [[S; C]],
    inverse: &mut impl Inverse<S, C>,
    rule: Rule,
    scratch: &mut Scratch<S>,
) -> Solved {
    let n = fits(a.len(), rhs, x);
    let vectors = scratch.columns::<9>(n * C).map(|v| v.as_chunks_mut().0);
    let [r0, r1, r2, u0, u1, u2, shadow, y, z] = vectors;
    let mut set = Set {
        r: [r0, r1, r2],
        u: [u0, u1, u2],
        shadow,
        y,
    };
    let mut whole = Preconditioned { a, inverse, z };
    let start = residual(a, rhs, x, set.r[0]);
    let mut watch = Watch::new(&rule, norms(rhs), start);
    let (mut products, mut renewals) = (1, 0);
    let mut broken = None;
    loop {
        if !watch.finite() {
            return watch.solved(Ending::BrokenDown(Breakdown::NotFinite), products);
        }
        if watch.all_done() {
            return watch.solved(Ending::Converged, products);
        }
        let before = watch.now;
        let end = set.run(&mut whole, &rule, &mut watch, &mut products);
        // x += M^-1 y, and what is really left.
        whole.correct(x, set.y);
        let carried = watch.now;
        let now = residual(a, rhs, x, set.r[0]);
        products += 1;
        watch.note(now, products);
        if watch.all_done() {
            continue;
        }
        renewals += 1;
        let worse = (0..C).any(|c| !watch.done(c) && now[c] > 0.5 * before[c]);
        match end {
            Some(end @ (Ending::Spent | Ending::Stopped)) => return watch.solved(end, products),
            Some(Ending::Stagnated(why)) => {
                return watch.solved(Ending::Stagnated(why), products);
            }
            Some(Ending::BrokenDown(what)) if worse && broken == Some(what) => {
                return watch.solved(Ending::BrokenDown(what), products);
            }
            Some(Ending::BrokenDown(what)) => broken = Some(what),
            _ if worse || renewals > RENEWALS => {
                // Carried residuals fell, the true one does not: rounding.
                let level = (0..C).map(|c| now[c] / watch.scale[c].max(carried[c]));
                let level = level.fold(0.0, f64::max);
                return watch.solved(Ending::Stagnated(Stagnation::Rounding { level }), products);
            }
            _ => {}
        }
    }
}

/// The vectors: residuals, directions, shadow residual, and the solution before preconditioning.
struct Set<'a, S, const C: usize> {
    r: [&'a mut [[S; C]]; 3],
    u: [&'a mut [[S; C]]; 3],
    shadow: &'a mut [[S; C]],
    y: &'a mut [[S; C]],
}

impl<S: Scalar, const C: usize> Set<'_, S, C> {
    /// Steps from the true residual in `r[0]` until all columns seem to have converged (none) or
    /// something ends them; their sum is left in `y`.
    fn run(
        &mut self,
        whole: &mut Preconditioned<'_, impl Operator<S, C>, impl Inverse<S, C>, S, C>,
        rule: &Rule,
        watch: &mut Watch<C>,
        products: &mut usize,
    ) -> Option<Ending> {
        let mut state: State<S, C> = State::new(watch);
        self.shadow.copy_from_slice(self.r[0]);
        self.u[0].fill([S::ZERO; C]);
        self.y.fill([S::ZERO; C]);
        let shadow = watch.now;
        while !watch.all_done() {
            if *products >= rule.products {
                return Some(Ending::Spent);
            }
            if rule.stopped() {
                return Some(Ending::Stopped);
            }
            if watch.stuck(*products) {
                let products = PATIENCE;
                return Some(Ending::Stagnated(Stagnation::Plateau { products }));
            }
            for c in 0..C {
                state.rho[c] = (state.omega[c] * state.rho[c]).times_real(-1.0);
            }
            for j in 0..2 {
                if !self.conjugate(j, &mut state, whole, watch, &shadow) {
                    return Some(Ending::BrokenDown(Breakdown::Shadow));
                }
                if rule.stopped() {
                    return Some(Ending::Stopped);
                }
            }
            *products += 4;
            let Some(now) = self.minimise(&mut state, &watch.now) else {
                return Some(Ending::BrokenDown(Breakdown::Polynomial));
            };
            watch.step(now, *products);
            if !watch.finite() {
                return Some(Ending::BrokenDown(Breakdown::NotFinite));
            }
            state.live = std::array::from_fn(|c| !watch.done(c));
        }
        None
    }

    /// Step `j` of bi-conjugate gradients; false if a divisor vanishes.
    fn conjugate(
        &mut self,
        j: usize,
        state: &mut State<S, C>,
        whole: &mut Preconditioned<'_, impl Operator<S, C>, impl Inverse<S, C>, S, C>,
        watch: &Watch<C>,
        shadow: &[f64; C],
    ) -> bool {
        let large: [f64; C] = std::array::from_fn(|c| shadow[c] * watch.now[c]);
        let rho = dot(self.shadow, self.r[j]);
        let Some(part) = state.ratio(rho, state.rho, [0.0; C]) else {
            return false;
        };
        let mut beta = part;
        for (beta, alpha) in beta.iter_mut().zip(state.alpha) {
            *beta *= alpha;
        }
        state.rho = rho;
        for i in 0..=j {
            turn(self.u[i], beta, self.r[i]);
        }
        let (u, next) = self.u.split_at_mut(j + 1);
        whole.apply(u[j], next[0]);
        let gamma = dot(self.shadow, self.u[j + 1]);
        let Some(alpha) = state.ratio(rho, gamma, large) else {
            return false;
        };
        state.alpha = alpha;
        let back = alpha.map(|a| -a);
        for i in 0..=j {
            add(self.r[i], back, self.u[i + 1]);
        }
        let (r, next) = self.r.split_at_mut(j + 1);
        whole.apply(r[j], next[0]);
        add(self.y, alpha, self.u[0]);
        true
    }

    /// The step that minimises the residual over its first two powers; norms of the new residual.
    fn minimise(&mut self, state: &mut State<S, C>, now: &[f64; C]) -> Option<[f64; C]> {
        let [r0, r1, r2] = &mut self.r;
        let [s11, s12, s22, t1, t2] = sum(r0.len(), |rows| {
            let mut sums = [[S::ZERO; C]; 5];
            let parts = r0[rows.clone()].iter().zip(&r1[rows.clone()]);
            for ((a, b), c) in parts.zip(&r2[rows]) {
                gather(&mut sums[0], b, b);
                gather(&mut sums[1], b, c);
                gather(&mut sums[2], c, c);
                gather(&mut sums[3], b, a);
                gather(&mut sums[4], c, a);
            }
            sums
        });
        let (mut g1, mut g2) = ([S::ZERO; C], [S::ZERO; C]);
        for c in (0..C).filter(|c| state.live[*c]) {
            // Orthogonalise the second power against the first.
            let (p, q) = (s11[c].real_part(), s22[c].real_part());
            if p.is_nan() || p <= TINY * now[c] * now[c] {
                return None;
            }
            let mix = s12[c].times_real(1.0 / p);
            let left = q - s12[c].square() / p;
            g1[c] = t1[c].times_real(1.0 / p);
            if left > 1e-14 * q {
                g2[c] = (t2[c] - mix.conjugate() * t1[c]).times_real(1.0 / left);
                g1[c] -= mix * g2[c];
                state.omega[c] = g2[c];
            } else {
                return None;
            }
        }
        add_two(self.y, g1, r0, g2, r1);
        let back = |g: [S; C]| g.map(|g| -g);
        add_two(r0, back(g1), r1, back(g2), r2);
        let [u0, u1, u2] = &mut self.u;
        add_two(u0, back(g1), u1, back(g2), u2);
        Some(norms(r0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Identity, Rows};
    use num_complex::Complex;

    type C64 = Complex<f64>;

    /// A chain with flow along it; `shift` is added to the diagonal.
    fn chain(n: usize, shift: C64) -> Rows<C64> {
        Rows::gathered(n, C64::ZERO, |i, row| {
            row.push((i as u32, C64::new(2.0, 0.0) + shift));
            if i > 0 {
                row.push((i as u32 - 1, C64::new(-1.3, 0.0)));
            }
            if i + 1 < n {
                row.push((i as u32 + 1, C64::new(-0.7, 0.0)));
            }
        })
    }

    #[test]
    fn columns_converge_on_their_own() {
        let n = 300;
        let a = chain(n, C64::new(0.05, 0.4));
        let exact: Vec<[C64; 3]> = (0..n)
            .map(|i| {
                [
                    C64::new(1.0, i as f64),
                    C64::ZERO,
                    C64::new(0.0, ((i * 7) % 5) as f64),
                ]
            })
            .collect();
        let mut rhs = exact.clone();
        a.apply(&exact, &mut rhs);
        let mut x = vec![[C64::ZERO; 3]; n];
        let rule = Rule {
            reduction: 1e-11,
            ..Rule::default()
        };
        let solved = bicgstab2(
            &a,
            &rhs,
            &mut x,
            &mut Identity,
            rule,
            &mut Scratch::default(),
        );
        assert!(solved.converged() && solved.worst() <= 1e-11, "{solved:?}");
        for (x, e) in x.iter().zip(&exact) {
            for c in 0..3 {
                assert!((x[c] - e[c]).norm() < 1e-8 * n as f64, "{x:?} {e:?}");
            }
        }
        // Alone, a column takes the same steps.
        let one: Vec<[C64; 1]> = rhs.iter().map(|r| [r[2]]).collect();
        let mut y = vec![[C64::ZERO; 1]; n];
        let again = bicgstab2(
            &a,
            &one,
            &mut y,
            &mut Identity,
            rule,
            &mut Scratch::default(),
        );
        assert!(again.converged());
        let far = x.iter().zip(&y).map(|(x, y)| (x[2] - y[0]).norm());
        assert!(far.fold(0.0, f64::max) < 1e-8);
    }

    #[test]
    fn a_singular_matrix_does_not_converge_and_says_so() {
        let n = 200;
        // Rows that add up to zero, and a right side that does not.
        let a = Rows::gathered(n, 0.0, |i, row| {
            for j in [(i + 1) % n, (i + n - 1) % n] {
                row.push((j as u32, -1.0));
                row.push((i as u32, 1.0));
            }
        });
        let rhs = vec![[1.0]; n];
        let mut x = vec![[0.0]; n];
        let solved = bicgstab2(
            &a,
            &rhs,
            &mut x,
            &mut Identity,
            Rule::default(),
            &mut Scratch::default(),
        );
        assert!(!solved.converged(), "{:?}", solved.ending);
        assert!(!solved.ending.to_string().is_empty());
        let nothing = bicgstab2(
            &a,
            &vec![[0.0]; n],
            &mut vec![[0.0]; n],
            &mut Identity,
            Rule::default(),
            &mut Scratch::default(),
        );
        assert!(nothing.converged() && nothing.products == 1);
    }

    #[test]
    fn what_is_no_number_is_told() {
        let a = chain(10, C64::ZERO);
        let mut rhs = vec![[C64::ONE]; 10];
        rhs[3] = [C64::new(f64::NAN, 0.0)];
        let mut x = vec![[C64::ZERO]; 10];
        let solved = bicgstab2(
            &a,
            &rhs,
            &mut x,
            &mut Identity,
            Rule::default(),
            &mut Scratch::default(),
        );
        assert_eq!(solved.ending, Ending::BrokenDown(Breakdown::NotFinite));
    }
}
