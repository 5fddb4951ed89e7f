//! The general transport equation (Komen 2019, eqs 3.1, 3.2) in the hybrid scheme.
//!
//! With F the mass flux out of the cell through a face and D the diffusive conductance, the
//! neighbour's coefficient is (eqs 3.54 to 3.57)
//!
//! ```text
//! A = max(-F, D - F/2, 0)
//! ```
//!
//! central for |F/D| < 2 (second order), upwind without diffusion beyond (first order). The text
//! under eq. 3.53 says that diffusion is dropped for |Pe| <= 2; it is dropped for |Pe| >= 2. The
//! sum of the coefficients is the central one, the mass fluxes being balanced: values stay between
//! those of their neighbours. `A(-F) = A(F) + F`, so what leaves one cell enters the next exactly:
//! the flux of phi is `F phi_P + A (phi_P - phi_E)`.

use relax::Coefficients;

/// The coefficient of the neighbour, from the mass flux out and the diffusive conductance.
#[must_use]
#[inline]
pub fn hybrid(out: f64, diffusion: f64) -> f64 {
    (-out).max(diffusion - 0.5 * out).max(0.0)
}

/// The coefficient of a fixed value on the face itself: that value is carried in by an inflow, and
/// an outflow carries the cell's own once it outweighs diffusion.
#[must_use]
#[inline]
pub fn dirichlet(out: f64, diffusion: f64) -> f64 {
    (diffusion - out).max(0.0)
}

/// Mass that leaves a cell beyond what enters it, before the fluxes are balanced, takes the cell's `own`
/// value along: else a cell that all of its sides flow out of would have no equation. Balanced fluxes
/// add nothing.
pub fn unbalanced(c: &mut Coefficients, outflow: f64, own: f64) {
    c.centre += outflow.max(0.0);
    c.source += outflow.max(0.0) * own;
}

/// A cell that all of its sides flow out of faster than they conduct keeps its `own` value, where nothing else
/// gives it an equation; `outflow` is what leaves it.
pub fn kept(c: &mut Coefficients, outflow: f64, own: f64) {
    if c.centre <= 0.0 {
        unbalanced(c, outflow - c.centre, own);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_without_an_equation_keeps_its_value() {
        let mut empty = Coefficients {
            source: 6.0,
            ..Coefficients::default()
        };
        kept(&mut empty, 3.0, 500.0);
        assert!((empty.source / empty.centre - 502.0).abs() < 1e-12);
        let mut whole = Coefficients {
            centre: 2.0,
            ..Coefficients::default()
        };
        kept(&mut whole, 3.0, 500.0);
        assert!((whole.centre - 2.0).abs() < 1e-12 && whole.source.abs() < 1e-12);
    }

    /// Steady 1-D convection and diffusion between phi = 0 and phi = 1 (eq. 3.35), walls on nodes'
    /// half distance; returns the largest error.
    fn profile(peclet: f64, n: usize) -> f64 {
        let dx = 1.0 / n as f64;
        let (flux, d) = (peclet, 1.0 / dx);
        let (mut diagonal, mut upper, mut source) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        for k in 0..n {
            let east = if k + 1 < n {
                hybrid(flux, d)
            } else {
                dirichlet(flux, 2.0 * d)
            };
            let west = if k > 0 {
                hybrid(-flux, d)
            } else {
                dirichlet(-flux, 2.0 * d)
            };
            diagonal[k] = east + west;
            if k + 1 == n {
                source[k] = east;
            } else {
                upper[k] = east;
            }
            if k > 0 {
                let m = west / diagonal[k - 1];
                diagonal[k] -= m * upper[k - 1];
                source[k] += m * source[k - 1];
            }
        }
        let mut worst = 0.0_f64;
        let mut next = 0.0;
        for k in (0..n).rev() {
            let value = (source[k] + upper[k] * next) / diagonal[k];
            next = value;
            let x = (k as f64 + 0.5) * dx;
            let exact = (peclet * x).exp_m1() / peclet.exp_m1();
            worst = worst.max((value - exact).abs());
        }
        worst
    }

    #[test]
    fn central_below_two_upwind_above() {
        assert!((hybrid(1.0, 1.0) - 0.5).abs() < 1e-15);
        assert!((hybrid(-1.0, 1.0) - 1.5).abs() < 1e-15);
        assert!(hybrid(3.0, 1.0).abs() < 1e-15);
        assert!((hybrid(-3.0, 1.0) - 3.0).abs() < 1e-15);
    }

    #[test]
    fn what_leaves_one_cell_enters_the_next() {
        for (f, d) in [(0.3, 1.0), (5.0, 1.0), (-5.0, 1.0), (2.0, 1.0), (1.0, 0.0)] {
            assert!((hybrid(-f, d) - hybrid(f, d) - f).abs() < 1e-15);
        }
    }

    #[test]
    fn what_is_not_balanced_yet_takes_the_own_value_along() {
        let equation = Coefficients {
            centre: 3.0,
            source: 5.0,
            ..Coefficients::default()
        };
        for (outflow, centre, source) in [(0.0, 3.0, 5.0), (-2.0, 3.0, 5.0), (2.0, 5.0, 13.0)] {
            let mut c = equation;
            unbalanced(&mut c, outflow, 4.0);
            assert!((c.centre - centre).abs() < 1e-15 && (c.source - source).abs() < 1e-15);
        }
    }

    #[test]
    fn order_two_where_central_and_bounded_where_upwind() {
        let order = (profile(2.0, 20) / profile(2.0, 40)).log2();
        assert!(order > 1.9, "{order}");
        // Large cell Peclet number: no overshoot, the boundary layer is lost within a cell.
        for peclet in [50.0, 500.0, -500.0] {
            assert!(profile(peclet, 10) < 1.0);
        }
    }
}
