//! Heat in a ball that depends on the radius alone, by finite volumes: shells of even thickness, explicit steps.

/// What heat meets in the ball.
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    /// Radius \[m\].
    pub radius: f64,
    /// Density \[kg/m3\].
    pub density: f64,
    /// Specific heat \[J/(kg K)\].
    pub specific: f64,
    /// Conductivity \[W/(m K)\].
    pub conductivity: f64,
    /// Emissivity times Stefan and Boltzmann's constant \[W/(m2 K4)\], and the temperature around \[K\].
    pub radiation: [f64; 2],
    /// Melting point \[K\] and latent heat \[J/kg\].
    pub melting: [f64; 2],
}

/// A ball at an instant.
#[derive(Debug, Clone, Copy)]
pub struct Instant {
    /// Mean temperature \[K\].
    pub mean: f64,
    /// Temperature in the middle \[K\].
    pub middle: f64,
    /// Temperature at the surface \[K\].
    pub surface: f64,
    /// Share of the volume that is molten.
    pub molten: f64,
}

/// Shells.
const SHELLS: usize = 150;
/// Rounds of Newton's method for the temperature of the surface.
const ROUNDS: usize = 8;
/// Part of the longest stable step.
const STEP: f64 = 0.4;

impl Ball {
    fn temperature(&self, enthalpy: f64) -> f64 {
        let [point, latent] = self.melting;
        let solid = enthalpy / self.specific;
        if solid <= point {
            solid
        } else {
            ((enthalpy - latent) / self.specific).max(point)
        }
    }

    /// The ball at rising times \[s\], from an even temperature \[K\], with `source` of heat by radius \[W/m3\].
    #[must_use]
    pub fn at(&self, times: &[f64], start: f64, source: impl Fn(f64) -> f64) -> Vec<Instant> {
        let thick = self.radius / SHELLS as f64;
        let edge = |k: usize| thick * k as f64;
        let volume: Vec<f64> = (0..SHELLS)
            .map(|k| (edge(k + 1).powi(3) - edge(k).powi(3)) / 3.0)
            .collect();
        let heat: Vec<f64> = (0..SHELLS).map(|k| source(edge(k) + 0.5 * thick)).collect();
        let [point, latent] = self.melting;
        let more = if start > point { latent } else { 0.0 };
        let mut enthalpy = vec![self.specific * start + more; SHELLS];
        let longest = STEP * 0.5 * thick * thick * self.density * self.specific / self.conductivity;
        let mut now = 0.0;
        let mut found = Vec::new();
        for time in times {
            let steps = ((time - now) / longest).ceil().max(1.0);
            let dt = (time - now) / steps;
            for _ in 0..steps as u64 {
                self.step(&mut enthalpy, &volume, &heat, thick, dt);
            }
            now = *time;
            found.push(self.told(&enthalpy, &volume));
        }
        found
    }

    /// Temperature of the surface, where what leaves is conducted from the middle of the last shell \[K\].
    fn skin(&self, last: f64) -> f64 {
        let across = 0.5 * self.radius / SHELLS as f64 / self.conductivity;
        let mut t = last;
        for _ in 0..ROUNDS {
            let lack = t - last + across * self.radiated(t);
            t -= lack / (1.0 + across * 4.0 * self.radiation[0] * t.powi(3));
        }
        t
    }

    /// Heat that leaves the surface \[W/m2\].
    fn radiated(&self, t: f64) -> f64 {
        let [a, far] = self.radiation;
        a * (t.powi(4) - far.powi(4))
    }

    fn step(&self, enthalpy: &mut [f64], volume: &[f64], heat: &[f64], thick: f64, dt: f64) {
        let t: Vec<f64> = enthalpy.iter().map(|h| self.temperature(*h)).collect();
        let mut inward = 0.0;
        for k in 0..SHELLS {
            let r = thick * (k + 1) as f64;
            let outward = if k + 1 == SHELLS {
                r * r * self.radiated(self.skin(t[k]))
            } else {
                r * r * self.conductivity * (t[k] - t[k + 1]) / thick
            };
            let gain = (inward - outward) / volume[k] + heat[k];
            enthalpy[k] += dt * gain / self.density;
            inward = outward;
        }
    }

    fn told(&self, enthalpy: &[f64], volume: &[f64]) -> Instant {
        let [point, latent] = self.melting;
        let whole: f64 = volume.iter().sum();
        let mean = |of: &dyn Fn(f64) -> f64| {
            let each = enthalpy.iter().zip(volume);
            each.map(|(h, v)| v * of(*h)).sum::<f64>() / whole
        };
        let last = self.temperature(enthalpy[SHELLS - 1]);
        Instant {
            mean: mean(&|h| self.temperature(h)),
            middle: self.temperature(enthalpy[0]),
            surface: self.skin(last),
            molten: mean(&|h| ((h - self.specific * point) / latent).clamp(0.0, 1.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_evenly_heated_ball_warms_evenly() {
        let ball = Ball {
            radius: 1.0,
            density: 2.0,
            specific: 3.0,
            conductivity: 1.0,
            radiation: [0.0, 0.0],
            melting: [1e9, 1.0],
        };
        let found = ball.at(&[0.5, 1.0], 300.0, |_| 12.0);
        assert!((found[1].mean - 302.0).abs() < 1e-9 && (found[1].middle - 302.0).abs() < 1e-9);
    }

    #[test]
    fn a_ball_cools_to_what_is_around() {
        let ball = Ball {
            radius: 1.0,
            density: 1.0,
            specific: 1.0,
            conductivity: 1.0,
            radiation: [1e-6, 100.0],
            melting: [150.0, 20.0],
        };
        let found = ball.at(&[0.01, 20.0], 300.0, |_| 0.0);
        assert!(found[0].surface < found[0].middle && found[0].molten > 0.5);
        assert!((found[1].mean - 100.0).abs() < 1.0 && found[1].molten < 1e-12);
    }

    #[test]
    fn a_ball_in_a_hot_room_is_as_warm_on_its_surface_as_a_layer_conducts() {
        let ball = Ball {
            radius: 1.0,
            density: 1.0,
            specific: 1.0,
            conductivity: 0.1,
            radiation: [1e-8, 1000.0],
            melting: [1e9, 1.0],
        };
        // What the room gives is conducted across half a shell.
        let (last, half) = (500.0, 0.5 / SHELLS as f64);
        let t = ball.skin(last);
        let given = -ball.radiated(t);
        assert!(
            given > 0.0 && (given * half / ball.conductivity - (t - last)).abs() < 1e-9,
            "{t}"
        );
    }
}
