//! A round pool at rest under a pressure (Young 1805, Laplace 1806).
//!
//! ```text
//! (gamma/r) d/dr (r psi) = p(r) + rho g eta - c      psi = eta' / sqrt(1 + eta'^2)
//! eta'(0) = 0     eta(R) = 0     int_0^R eta r dr = 0
//! ```
//!
//! The liquid keeps its volume, which sets c, and its edge on the rim. Second order on equal steps,
//! by Newton's method; the pressure is put on in parts.

/// A pool with its rim at the height zero.
pub(crate) struct Pool {
    /// R \[m\].
    pub(crate) radius: f64,
    /// gamma \[N/m\].
    pub(crate) tension: f64,
    /// rho g \[N/m3\].
    pub(crate) weight: f64,
}

/// Steps along the radius.
const STEPS: usize = 2000;
/// Parts in which the pressure is put on.
const PARTS: u32 = 20;
/// Newton's steps within each part.
const TRIES: u32 = 50;
/// Change of height that is none \[part of R\].
const SETTLED: f64 = 1e-12;

/// The surface of a pool.
pub(crate) struct Meniscus {
    step: f64,
    /// eta at the middles of the steps \[m\].
    pub(crate) height: Vec<f64>,
}

impl Pool {
    /// The surface under `pressure` \[Pa\] over r \[m\]; `None` where there is none at rest.
    pub(crate) fn under(&self, pressure: impl Fn(f64) -> f64) -> Option<Meniscus> {
        let step = self.radius / STEPS as f64;
        let whole: Vec<f64> = (0..STEPS)
            .map(|i| pressure((i as f64 + 0.5) * step))
            .collect();
        let mut meniscus = Meniscus {
            step,
            height: vec![0.0; STEPS],
        };
        let mut level = 0.0;
        for part in 1..=PARTS {
            let share = f64::from(part) / f64::from(PARTS);
            let pressed: Vec<f64> = whole.iter().map(|p| share * p).collect();
            let settled = (0..TRIES).any(|_| {
                let change = self.newton(&mut meniscus, &mut level, &pressed);
                change < SETTLED * self.radius
            });
            if !settled {
                return None;
            }
        }
        Some(meniscus)
    }

    /// One step of Newton's method; the greatest change of height \[m\].
    fn newton(&self, meniscus: &mut Meniscus, level: &mut f64, pressure: &[f64]) -> f64 {
        let (h, n) = (meniscus.step, STEPS);
        let eta = &mut meniscus.height;
        // psi and its slope at the face i between the middles i - 1 and i; half a step to the rim.
        let face = |eta: &[f64], i: usize| -> [f64; 2] {
            if i == 0 {
                return [0.0; 2];
            }
            let (after, length) = if i == n { (0.0, 0.5 * h) } else { (eta[i], h) };
            let slope = (after - eta[i - 1]) / length;
            let root = (1.0 + slope * slope).sqrt();
            let r = i as f64 * h;
            [r * slope / root, r / (root.powi(3) * length)]
        };
        let (mut below, mut on, mut above) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let (mut rest, mut lift) = (vec![0.0; n], vec![0.0; n]);
        for i in 0..n {
            let ring = (i as f64 + 0.5) * h * h / self.tension;
            let ([left, dl], [right, dr]) = (face(eta, i), face(eta, i + 1));
            (below[i], above[i]) = (dl, if i + 1 == n { 0.0 } else { dr });
            on[i] = -dl - dr - ring * self.weight;
            rest[i] = ring * (pressure[i] + self.weight * eta[i] - *level) - (right - left);
            lift[i] = -ring;
        }
        // J x = rest + lift y, with y the change of c from the volume.
        let by_rest = tridiagonal(&below, &on, &above, rest);
        let by_lift = tridiagonal(&below, &on, &above, lift);
        let volume = |x: &[f64]| -> f64 { (0..n).map(|i| x[i] * (i as f64 + 0.5)).sum() };
        let y = -(volume(eta) + volume(&by_rest)) / volume(&by_lift);
        let mut most = 0.0_f64;
        for i in 0..n {
            let change = by_rest[i] + y * by_lift[i];
            eta[i] += change;
            most = most.max(change.abs());
        }
        *level += y;
        most
    }
}

/// Thomas's algorithm.
fn tridiagonal(below: &[f64], on: &[f64], above: &[f64], mut x: Vec<f64>) -> Vec<f64> {
    let n = x.len();
    let mut pivot = vec![on[0]; n];
    for i in 1..n {
        let factor = below[i] / pivot[i - 1];
        pivot[i] = on[i] - factor * above[i - 1];
        x[i] -= factor * x[i - 1];
    }
    x[n - 1] /= pivot[n - 1];
    for i in (0..n - 1).rev() {
        x[i] = (x[i] - above[i] * x[i + 1]) / pivot[i];
    }
    x
}

impl Meniscus {
    /// int eta w 2 pi r dr with a window over r \[m3 where w has no unit\].
    pub(crate) fn volume(&self, window: impl Fn(f64) -> f64) -> f64 {
        let ring = |(i, eta): (usize, &f64)| {
            let r = (i as f64 + 0.5) * self.step;
            2.0 * std::f64::consts::PI * r * self.step * eta * window(r)
        };
        self.height.iter().enumerate().map(ring).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POOL: Pool = Pool {
        radius: 6e-3,
        tension: 1.0,
        weight: 7850.0 * 9.8,
    };

    /// The pressure that makes eta = -A (1 - s)^3 (1 - 5 s), s = (r/L)^2, and eta.
    fn made(r: f64) -> (f64, f64) {
        let (depth, length) = (1.2e-3, 5e-3);
        let s = (r * r / (length * length)).min(1.0);
        let a = 8.0 * depth / (length * length);
        let over_r = a * (1.0 - s).powi(2) * (2.0 - 5.0 * s);
        let second = over_r + a * 2.0 * s * (1.0 - s) * (15.0 * s - 9.0);
        let root = (1.0 + (over_r * r).powi(2)).sqrt();
        let eta = -depth * (1.0 - s).powi(3) * (1.0 - 5.0 * s);
        let pressure = POOL.tension * (second / root.powi(3) + over_r / root) - POOL.weight * eta;
        (pressure, eta)
    }

    #[test]
    fn a_made_surface_comes_back() {
        let found = POOL.under(|r| made(r).0).unwrap();
        let miss = |i: usize| (found.height[i] - made((i as f64 + 0.5) * found.step).1).abs();
        let worst = (0..STEPS).map(miss).fold(0.0, f64::max);
        assert!(worst < 1e-5 * 1.2e-3, "{worst:e}");
    }

    #[test]
    fn an_even_pressure_moves_nothing_and_the_volume_stays() {
        let flat = POOL.under(|_| 1000.0).unwrap();
        assert!(flat.height.iter().all(|eta| eta.abs() < 1e-12));
        let dented = POOL.under(|r| 500.0 * (-r * r / 2e-6).exp()).unwrap();
        assert!(dented.height[0] < -1e-4);
        assert!(dented.volume(|_| 1.0).abs() < 1e-18);
    }

    #[test]
    fn a_pressure_that_no_surface_bears_has_none() {
        assert!(POOL.under(|r| 1e5 * (-r * r / 2e-6).exp()).is_none());
    }
}
