//! Exact flows between plates, means over layers, and the exact swing of a drop.

use std::f64::consts::PI;

use num_complex::Complex;

use crate::lab::{Finished, LabError};
use crate::norms::Worst;

/// Ways in which metal is kept incompressible beside faces, the default first.
pub(crate) const METHODS: &[&str] = &["divergence_free", "projection"];

/// Terms of a series; at 1e-3 of the viscous time its last one is below 1e-15.
const TERMS: u32 = 200;

/// What drives a layer on a floor to which it sticks, as the speeds \[m/s\] that belong to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Driven {
    /// tau h / mu of the stress on its surface.
    pub(crate) stress: f64,
    /// g h^2 / nu of the force along it.
    pub(crate) force: f64,
}

impl Driven {
    /// Speed at the part `c` of the height, `tau` viscous times h^2/nu after rest.
    ///
    /// u_t = nu u_zz + g with u = 0 below and mu u_z = stress above, by sines of lambda = (k + 1/2) pi; a return flow has
    /// force = -3/2 stress, and tends to stress (3 c^2 - 2 c)/4.
    pub(crate) fn speed(self, c: f64, tau: f64) -> f64 {
        let mut speed = self.stress * c + self.force * (c - 0.5 * c * c);
        for k in 0..TERMS {
            let lambda = (f64::from(k) + 0.5) * PI;
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            let part = 2.0 * (self.stress * sign / lambda.powi(2) + self.force / lambda.powi(3));
            speed -= part * (lambda * c).sin() * (-lambda * lambda * tau).exp();
        }
        speed
    }
}

/// What drives a liquid between two plates, as the speeds \[m/s\] that belong to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Channel {
    /// U of the upper plate; the lower one rests.
    pub(crate) plate: f64,
    /// g H^2 / (8 nu) of the force along them, the greatest speed that it gives.
    pub(crate) force: f64,
}

impl Channel {
    /// Speed at the part `c` of the height, `tau` viscous times H^2/nu after rest, by sines of k pi.
    pub(crate) fn speed(self, c: f64, tau: f64) -> f64 {
        let mut speed = self.plate * c + 4.0 * self.force * c * (1.0 - c);
        for k in 1..=TERMS {
            let lambda = f64::from(k) * PI;
            let odd = k % 2 == 1;
            let plate = 2.0 * self.plate / lambda * if odd { -1.0 } else { 1.0 };
            let force = if odd {
                -32.0 * self.force / lambda.powi(3)
            } else {
                0.0
            };
            speed += (plate + force) * (lambda * c).sin() * (-lambda * lambda * tau).exp();
        }
        speed
    }
}

/// Mean height and mean value of each of `n` layers between 0 and `high` \[m\], of those that hold something.
pub(crate) fn layers(
    points: impl Iterator<Item = (f64, f64)>,
    high: f64,
    n: usize,
) -> Vec<[f64; 2]> {
    let mut sums = vec![[0.0; 3]; n];
    for (z, value) in points {
        let layer = ((z / high * n as f64).max(0.0) as usize).min(n - 1);
        let sum = &mut sums[layer];
        *sum = [sum[0] + z, sum[1] + value, sum[2] + 1.0];
    }
    let held = sums.iter().filter(|sum| sum[2] > 0.0);
    held.map(|[z, value, count]| [z / count, value / count])
        .collect()
}

/// Greatest difference of two profiles, over the layers that hold something in both.
pub(crate) fn apart(one: &[[f64; 2]], other: &[[f64; 2]], high: f64, n: usize) -> f64 {
    let layer = |z: f64| ((z / high * n as f64).max(0.0) as usize).min(n - 1);
    let of = |at: usize| other.iter().find(|[z, _]| layer(*z) == at);
    let differences = one
        .iter()
        .filter_map(|[z, u]| Some((u - of(layer(*z))?[1]).abs()));
    differences.worst()
}

/// Times at which `y` changes its sign, between the rows on a line.
pub(crate) fn zeros(time: &[f64], y: &[f64]) -> Vec<f64> {
    let pairs = time.windows(2).zip(y.windows(2));
    let crossing = pairs.filter(|(_, y)| (y[0] > 0.0) != (y[1] > 0.0));
    crossing
        .map(|(t, y)| t[0] + (t[1] - t[0]) * y[0] / (y[0] - y[1]))
        .collect()
}

/// Twice the mean time between the moments at which the swing `y` of a run stands still \[s\].
pub(crate) fn period(run: &Finished, time: &[f64], y: &[f64]) -> Result<f64, LabError> {
    let stills = zeros(time, y);
    let (Some(first), Some(last), true) = (stills.first(), stills.last(), stills.len() > 2) else {
        return Err(LabError::Content {
            path: run.artefact.clone(),
            what: format!("stands still {} times, not three", stills.len()),
        });
    };
    Ok(2.0 * (last - first) / (stills.len() - 1) as f64)
}

/// Frequency and decay \[1/s\] of the second mode of a drop in a vacuum: Rayleigh's frequency `rayleigh` \[1/s\], and
/// `diffusion` nu/R^2 \[1/s\].
///
/// Chandrasekhar (1961), section 98: motion as e^(-sigma t) with sigma = x^2 nu/R^2 obeys, for the mode l,
///
/// ```text
/// alpha^4 = 2 x^2 (l - 1) [l + (l + 1) (x - 2 l Q) / (x - 2 Q)] - x^4,    Q = j_(l+1)(x) / j_l(x),  alpha^2 = omega R^2/nu
/// ```
///
/// which is solved by Newton's method from Lamb's sigma = 5 nu/R^2 + i omega on.
pub(crate) fn drop_mode(rayleigh: f64, diffusion: f64) -> (f64, f64) {
    let alpha = (rayleigh / diffusion).powi(2);
    let f = |x: Complex<f64>| {
        let q = bessel_ratio(x);
        let square = x * x;
        let bracket = 2.0 + 3.0 * (x - 4.0 * q) / (x - 2.0 * q);
        2.0 * square * bracket - square * square - alpha
    };
    let mut x = (Complex::new(5.0 * diffusion, rayleigh) / diffusion).sqrt();
    for _ in 0..60 {
        let step = x * 1e-6;
        let slope = (f(x + step) - f(x - step)) / (2.0 * step);
        let change = f(x) / slope;
        x -= change;
        if change.norm() < 1e-13 * x.norm() {
            break;
        }
    }
    let sigma = x * x * diffusion;
    (sigma.im.abs(), sigma.re)
}

/// j_3(x) / j_2(x), by the recurrence of spherical Bessel functions divided through by j_0.
fn bessel_ratio(x: Complex<f64>) -> Complex<f64> {
    // j_1/j_0 = 1/x - cot x; far from the real axis the tangent is that of its limit.
    let i = Complex::new(0.0, 1.0);
    let cot = if x.im.abs() > 300.0 {
        -i * x.im.signum()
    } else {
        x.cos() / x.sin()
    };
    let first = 1.0 / x - cot;
    let second = 3.0 / x * first - 1.0;
    let third = 5.0 / x * second - first;
    third / second
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_without_a_common_layer_are_not_alike() {
        assert!(apart(&[], &[[0.5, 1.0]], 1.0, 4).is_nan());
        assert!(apart(&[[0.1, 1.0]], &[[0.9, 1.0]], 1.0, 4).is_nan());
        assert!((apart(&[[0.1, 1.0]], &[[0.2, 3.0]], 1.0, 4) - 2.0).abs() < 1e-15);
    }

    #[test]
    fn a_return_flow_has_no_flux_and_turns_at_two_thirds() {
        let flow = Driven {
            stress: 4.0,
            force: -6.0,
        };
        let n = 1000;
        let flux: f64 = (0..n)
            .map(|k| flow.speed((f64::from(k) + 0.5) / f64::from(n), 30.0))
            .sum();
        assert!((flux / f64::from(n)).abs() < 1e-5);
        assert!(flow.speed(2.0 / 3.0, 30.0).abs() < 1e-12);
        assert!((flow.speed(1.0, 30.0) - 1.0).abs() < 1e-12);
        // At the start everything falls alike; the stress has not come down yet.
        let early = flow.speed(0.3, 1e-3);
        assert!((early + 6e-3).abs() < 1e-6, "{early}");
    }

    #[test]
    fn channels_start_at_rest_and_end_as_they_should() {
        let couette = Channel {
            plate: 2.0,
            force: 0.0,
        };
        let poiseuille = Channel {
            plate: 0.0,
            force: 3.0,
        };
        assert!((couette.speed(0.25, 9.0) - 0.5).abs() < 1e-12);
        assert!((poiseuille.speed(0.5, 9.0) - 3.0).abs() < 1e-12);
        assert!((poiseuille.speed(0.5, 1e-3) - 24.0 * 1e-3).abs() < 1e-5);
        // A plate that has just begun to move drags as one beside a half-space: erfc(1/2) at z^2 = nu t.
        let near = couette.speed(0.96, 1.6e-3);
        assert!((near / 2.0 - 0.4795).abs() < 1e-3, "{near}");
        // tau = 0.1: 1 - 8/pi^2 e^(-pi^2/40 ...) differs by less than the next term, which is 1e-7.
        let middle = 3.0 * (1.0 - 32.0 / PI.powi(3) * (-PI * PI * 0.1).exp());
        let next = 3.0 * 32.0 / (3.0 * PI).powi(3);
        let found = poiseuille.speed(0.5, 0.1);
        assert!(
            (found - middle).abs() < next * (-9.0 * PI * PI * 0.1).exp() * 1.01,
            "{found}"
        );
    }

    #[test]
    fn a_drop_swings_as_others_have_computed() {
        // A drop of water of 35 um: 54.371 us at mu = 0.02 sqrt(rho gamma R), decay 3791 1/s.
        let (radius, tension, density) = (3.5e-5_f64, 0.07196, 1000.0);
        let rayleigh = (8.0 * tension / (density * radius.powi(3))).sqrt();
        assert!((2.0 * PI / rayleigh - 54.224e-6).abs() < 1e-9);
        let nu = 0.02 * (density * tension * radius).sqrt() / density;
        let (frequency, decay) = drop_mode(rayleigh, nu / radius.powi(2));
        assert!(
            (2.0 * PI / frequency - 54.371e-6).abs() < 2e-9,
            "{frequency}"
        );
        assert!((decay - 3791.0).abs() < 2.0, "{decay}");
        // Hardly any viscosity: Lamb's decay.
        let (_, decay) = drop_mode(1.0, 1e-8);
        assert!((decay / 5e-8 - 1.0).abs() < 1e-3, "{decay}");
    }
}
