//! Alexander's stiffly accurate two-stage Runge-Kutta method of second order (Alexander 1977, SIAM
//! J. Numer. Anal. 14), with the step chosen by comparing one step with two halves.

/// gamma = 1 - 1/sqrt 2.
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// What is marched: `dT/dt = f(T)`.
pub trait Stiff {
    /// Solves `T = base + dt f(T)`, starting from what stands in `t`; false when it cannot.
    fn implicit(&self, base: &[f64], dt: f64, t: &mut Vec<f64>) -> bool;
}

/// How a march goes.
#[derive(Debug, Clone, Copy)]
pub struct March {
    /// Largest difference of one step and two halves, in the unit of the state.
    pub tolerance: f64,
    /// First step \[s\].
    pub first_s: f64,
}

/// States at each of the times `at` \[s\], which rise; `None` when a step becomes hopelessly small.
pub fn march<S: Stiff>(system: &S, start: &[f64], at: &[f64], how: March) -> Option<Vec<Vec<f64>>> {
    let mut state = start.to_vec();
    let mut time = 0.0;
    let mut dt = how.first_s;
    let mut found = Vec::new();
    for end in at {
        while end - time > 1e-13 * end {
            let step = dt.min(end - time);
            let tried = attempt(system, &state, step);
            let error = tried.as_ref().map_or(f64::INFINITY, |(_, e)| *e);
            // The difference of a method of second order shrinks as the cube of the step.
            let factor = (0.9 * (how.tolerance / error.max(1e-300)).cbrt()).clamp(0.2, 3.0);
            if let (Some((next, _)), true) = (tried, error <= how.tolerance) {
                state = next;
                time += step;
                if step >= dt || factor < 1.0 {
                    dt = step * factor;
                }
            } else {
                dt = step * factor.min(0.5);
                if dt < 1e-12 * how.first_s {
                    return None;
                }
            }
        }
        found.push(state.clone());
    }
    Some(found)
}

/// Two half steps, improved by what one whole step gives, and the largest difference of the two.
fn attempt<S: Stiff>(system: &S, state: &[f64], dt: f64) -> Option<(Vec<f64>, f64)> {
    let whole = step(system, state, dt)?;
    let half = step(system, state, 0.5 * dt)?;
    let mut halves = step(system, &half, 0.5 * dt)?;
    let mut worst = 0.0_f64;
    for (h, w) in halves.iter_mut().zip(&whole) {
        worst = worst.max((*h - w).abs());
        *h += (*h - w) / 3.0;
    }
    worst.is_finite().then_some((halves, worst))
}

fn step<S: Stiff>(system: &S, state: &[f64], dt: f64) -> Option<Vec<f64>> {
    let mut stage = state.to_vec();
    if !system.implicit(state, GAMMA * dt, &mut stage) {
        return None;
    }
    // base = T + (1 - gamma) dt f(T1), with f(T1) = (T1 - T) / (gamma dt).
    let share = (1.0 - GAMMA) / GAMMA;
    let base: Vec<f64> = state
        .iter()
        .zip(&stage)
        .map(|(t, t1)| t + share * (t1 - t))
        .collect();
    system
        .implicit(&base, GAMMA * dt, &mut stage)
        .then_some(stage)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// dT/dt = -50 (T - 2), and another that has long decayed.
    struct Decay;

    impl Stiff for Decay {
        fn implicit(&self, base: &[f64], dt: f64, t: &mut Vec<f64>) -> bool {
            t[0] = (base[0] + 100.0 * dt) / (1.0 + 50.0 * dt);
            t[1] = base[1] / (1.0 + 1e9 * dt);
            true
        }
    }

    #[test]
    fn a_stiff_decay_is_followed() {
        let how = March {
            tolerance: 1e-9,
            first_s: 1e-6,
        };
        let found = march(&Decay, &[3.0, 1.0], &[0.01, 0.02, 0.1], how).unwrap();
        for (state, t) in found.iter().zip([0.01, 0.02, 0.1]) {
            let wanted = 2.0 + (-50.0_f64 * t).exp();
            assert!((state[0] - wanted).abs() < 1e-7, "{} {wanted}", state[0]);
            assert!(state[1].abs() < 1e-7);
        }
    }

    #[test]
    fn one_step_is_of_second_order() {
        let miss = |n: usize| {
            let mut state = vec![3.0, 0.0];
            for _ in 0..n {
                state = step(&Decay, &state, 0.02 / n as f64).unwrap();
            }
            (state[0] - 2.0 - (-1.0_f64).exp()).abs()
        };
        let order = (miss(20) / miss(40)).log2();
        assert!((order - 2.0).abs() < 0.1, "{order}");
    }
}
