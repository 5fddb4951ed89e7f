//! Heat in a liquid and through its surface, with melting, by the enthalpy H of a mass.
//!
//! ```text
//! rho dH/dt = k div grad T + q + rho ((w - u) . grad) H,      -k dT/dn = a (T^4 - T_far^4) on the surface
//! T = H/c below the melting point T_m, T_m from c T_m to c T_m + L, (H - L)/c beyond
//! ```
//!
//! for points that move at w, in the two stages of Alexander (see [`super::step`]). Each is solved for H by Newton's method: `dT/dH`
//! is 0 where something melts and 1/c elsewhere, so that a sharp melting point needs no interval. Fits conserve no heat: what
//! is lost or won by them is put back evenly, and told.

use krylov::{Keep, Method, Options, Rows, Rule, System};
use rayon::prelude::*;
use run::Failure;
use wls::Stencils;

use super::effort::{Effort, failed};
use super::step::PART;

/// Rounds of Newton's method, and the residual over the greatest enthalpy that ends them.
const ROUNDS: usize = 40;
const SETTLED: f64 = 1e-10;

/// What melts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Melting {
    /// Where \[K\].
    pub point: f64,
    /// Heat that it takes \[J/kg\].
    pub latent: f64,
}

/// What heat meets in a liquid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Warmth {
    /// Density \[kg/m3\].
    pub density: f64,
    /// Specific heat \[J/(kg K)\].
    pub specific: f64,
    /// Conductivity \[W/(m K)\].
    pub conductivity: f64,
    /// Radiance `a = eps sigma` \[W/(m2 K4)\] and the temperature far away \[K\]; none where nothing leaves the surface.
    pub radiation: Option<[f64; 2]>,
    /// None where nothing melts.
    pub melting: Option<Melting>,
}

impl Warmth {
    /// Temperature at an enthalpy \[K\].
    #[must_use]
    pub fn temperature(&self, enthalpy: f64) -> f64 {
        let bare = |h: f64| h / self.specific;
        match self.melting {
            Some(Melting { point, latent }) if bare(enthalpy) > point => {
                bare(enthalpy - latent).max(point)
            }
            _ => bare(enthalpy),
        }
    }

    /// `dT/dH` \[kg K/J\].
    fn slope(&self, enthalpy: f64) -> f64 {
        let melts = self.molten(enthalpy);
        if melts.is_some_and(|m| m > 0.0 && m < 1.0) {
            0.0
        } else {
            self.specific.recip()
        }
    }

    /// Enthalpy at a temperature \[J/kg\]; at the melting point nothing is molten.
    #[must_use]
    pub fn enthalpy(&self, temperature: f64) -> f64 {
        let latent = self.melting.filter(|m| temperature > m.point);
        self.specific * temperature + latent.map_or(0.0, |m| m.latent)
    }

    /// The share that is molten; none where nothing melts.
    #[must_use]
    pub fn molten(&self, enthalpy: f64) -> Option<f64> {
        let Melting { point, latent } = self.melting?;
        Some(((enthalpy - self.specific * point) / latent).clamp(0.0, 1.0))
    }

    /// Heat that leaves the surface at a temperature \[W/m2\].
    #[must_use]
    pub fn radiated(&self, temperature: f64) -> f64 {
        let [a, far] = self.radiation.unwrap_or_default();
        a * (temperature.powi(4) - far.powi(4))
    }
}

/// Where heat flows: rows of the Laplacian inside, and on the surface with the slope along the normal as a datum.
pub struct Ground<'a, const D: usize> {
    /// Inside.
    pub inside: &'a Stencils<D>,
    /// On the surface, whose points come first.
    pub surface: &'a Stencils<D>,
    /// Number of points on the surface.
    pub on: usize,
}

impl<const D: usize> Ground<'_, D> {
    /// `div grad T`, with `slope(i)` along the normal on the surface \[K/m2\].
    fn laplacian(&self, i: usize, t: &[f64], slope: impl Fn(usize) -> f64) -> f64 {
        if i < self.on {
            let row = self.surface.laplacian(i);
            row.apply(t) + row.conditions().sum::<f64>() * slope(i)
        } else {
            self.inside.laplacian(i).apply(t)
        }
    }
}

/// What a step adds beside conduction.
#[derive(Debug, Clone, Copy)]
pub struct Added<'a> {
    /// Heat by point \[W/m3\]; nothing where there is none.
    pub heat: &'a [f64],
    /// `rho ((w - u) . grad) H` by point, of the surface first \[W/m3\]; nothing where points go with the liquid.
    pub drift: &'a [f64],
}

impl Added<'_> {
    fn at(&self, i: usize) -> f64 {
        let of = |all: &[f64]| all.get(i).copied().unwrap_or(0.0);
        of(self.heat) + of(self.drift)
    }
}

/// How heat goes for a while.
#[derive(Clone, Copy)]
pub struct Flow<'a, const D: usize> {
    /// Where.
    pub ground: &'a Ground<'a, D>,
    /// Beside conduction.
    pub added: Added<'a>,
    /// When solves end.
    pub rule: Rule<'a>,
    /// For how long \[s\].
    pub dt: f64,
}

/// Enthalpies of the points of a liquid at the end of a step.
///
/// # Errors
/// Where the equations have no solution.
pub fn warmed<const D: usize>(
    warmth: &Warmth,
    flow: Flow<'_, D>,
    enthalpy: &[f64],
    effort: &mut Effort,
) -> Result<Vec<f64>, Failure> {
    let tau = PART * flow.dt;
    let part = Flow { dt: tau, ..flow };
    let first = stage(warmth, part, enthalpy, enthalpy, effort)?;
    // The rate of the first stage acts for what is left of the step.
    let rest = (flow.dt - tau) / tau;
    let base: Vec<f64> = (enthalpy.iter().zip(&first))
        .map(|(h, end)| h + rest * (end - h))
        .collect();
    stage(warmth, part, &base, &first, effort)
}

/// `rho (H - H_base) = tau (k div grad T(H) + q)`.
fn stage<const D: usize>(
    warmth: &Warmth,
    flow: Flow<'_, D>,
    base: &[f64],
    guess: &[f64],
    effort: &mut Effort,
) -> Result<Vec<f64>, Failure> {
    let Flow {
        ground,
        added,
        rule,
        dt: tau,
    } = flow;
    let share = tau / warmth.density;
    let (n, k) = (base.len(), warmth.conductivity);
    let most = base.iter().fold(0.0_f64, |m, h| m.max(h.abs()));
    let mut now = guess.to_vec();
    for _ in 0..ROUNDS {
        let t: Vec<f64> = now.iter().map(|h| warmth.temperature(*h)).collect();
        let slope = |i: usize| -warmth.radiated(t[i]) / k;
        let lack: Vec<f64> = (0..n)
            .into_par_iter()
            .map(|i| {
                let flow = k * ground.laplacian(i, &t, slope) + added.at(i);
                base[i] + share * flow - now[i]
            })
            .collect();
        let worst = lack.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
        if !worst.is_finite() {
            return Err(failed(&"the enthalpy is no number"));
        }
        if worst <= SETTLED * most {
            return Ok(now);
        }
        let bent: Vec<f64> = now.iter().map(|h| warmth.slope(*h)).collect();
        let matrix = Rows::gathered(n, 0.0, |i, row| {
            row.push((i as u32, 1.0));
            let rows = if i < ground.on {
                ground.surface.laplacian(i)
            } else {
                ground.inside.laplacian(i)
            };
            let flows = rows.iter();
            row.extend(flows.map(|(j, w)| (j as u32, -share * k * w * bent[j])));
            if let Some([a, _]) = warmth.radiation.filter(|_| i < ground.on) {
                let data: f64 = rows.conditions().sum();
                row.push((i as u32, share * data * 4.0 * a * t[i].powi(3) * bent[i]));
            }
        });
        let options = Options {
            method: Method::Incomplete(Keep::PATTERN),
            ..Options::default()
        };
        let mut system = System::new(matrix, Vec::new(), options).map_err(|e| failed(&e))?;
        let sides: Vec<[f64; 1]> = lack.iter().map(|r| [*r]).collect();
        let mut change = vec![[0.0; 1]; n];
        effort.add(&system.solve(&sides, &mut change, rule))?;
        for (h, [c]) in now.iter_mut().zip(&change) {
            *h += c;
        }
    }
    effort.unsettled += 1;
    Ok(now)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn temperature_and_enthalpy_are_each_others_inverse() {
        let warmth = Warmth {
            density: 7000.0,
            specific: 800.0,
            conductivity: 30.0,
            radiation: Some([5.67e-8, 300.0]),
            melting: Some(Melting {
                point: 1800.0,
                latent: 2.5e5,
            }),
        };
        for t in [0.0, 300.0, 1799.0, 1800.0, 1801.0, 2500.0] {
            assert!((warmth.temperature(warmth.enthalpy(t)) - t).abs() < 1e-9);
        }
        let half = warmth.enthalpy(1800.0) + 1.25e5;
        assert!((warmth.temperature(half) - 1800.0).abs() < 1e-9);
        assert_eq!(warmth.molten(half), Some(0.5));
        assert!(warmth.slope(half).abs() < 1e-30);
        assert!(warmth.radiated(300.0).abs() < 1e-12);
        let bare = Warmth {
            radiation: None,
            melting: None,
            ..warmth
        };
        assert!(bare.radiated(2000.0).abs() < 1e-30 && bare.molten(half).is_none());
    }
}
