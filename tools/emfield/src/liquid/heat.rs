//! Heat in a liquid and through its surface, with melting, by the enthalpy H of a mass.
//!
//! ```text
//! rho V_i dH_i/dt = sum_j k A_ij/d_ij (T_j - T_i) + Q_i + rho V_i ((w - u) . grad) H - A_i a (T^4 - T_far^4)
//! T = H/c below the melting point T_m, T_m from c T_m to c T_m + L, (H - L)/c beyond
//! ```
//!
//! for points that move at w, with the parts of the drop that belong to them ([`super::parts`]), in the two stages of Alexander (see
//! [`super::step`]). Each is solved for H by Newton's method: `dT/dH` is 0 where something melts and 1/c elsewhere, so that a sharp
//! melting point needs no interval. What one part gives another takes: conduction keeps the heat, however sharp its bends are.

use krylov::{Keep, Method, Options, Rows, Rule, System};
use rayon::prelude::*;
use run::Failure;

use super::effort::{Effort, failed};
use super::parts::Parts;
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

    /// How that grows with the temperature \[W/(m2 K)\].
    fn steeper(&self, temperature: f64) -> f64 {
        let [a, _] = self.radiation.unwrap_or_default();
        4.0 * a * temperature.powi(3)
    }

    /// Heat that leaves the surface of all parts \[W\].
    #[must_use]
    pub fn leaves(&self, parts: &Parts, enthalpy: &[f64]) -> f64 {
        let each = parts.area.iter().zip(enthalpy);
        let each = each.map(|(area, h)| area * self.radiated(self.temperature(*h)));
        each.sum()
    }
}

/// What a step adds beside conduction.
#[derive(Debug, Clone, Copy)]
pub struct Added<'a> {
    /// Power by point \[W\]; nothing where there is none.
    pub heat: &'a [f64],
    /// `rho ((w - u) . grad) H` by point, of the surface first \[W/m3\]; nothing where points go with the liquid.
    pub drift: &'a [f64],
}

impl Added<'_> {
    /// What a part of some volume takes of it \[W\].
    fn at(&self, i: usize, volume: f64) -> f64 {
        let of = |all: &[f64]| all.get(i).copied().unwrap_or(0.0);
        of(self.heat) + volume * of(self.drift)
    }
}

/// How heat goes for a while.
#[derive(Clone, Copy)]
pub struct Flow<'a> {
    /// Parts of the drop, by point.
    pub parts: &'a Parts,
    /// Beside conduction.
    pub added: Added<'a>,
    /// When solves end.
    pub rule: Rule<'a>,
    /// For how long \[s\].
    pub dt: f64,
}

/// What a step makes of heat.
#[derive(Debug, Clone, PartialEq)]
pub struct Warmed {
    /// By point \[J/kg\].
    pub enthalpy: Vec<f64>,
    /// What has left the surface \[J\].
    pub radiated: f64,
}

/// Enthalpies of the points of a liquid at the end of a step.
///
/// # Errors
/// Where the equations have no solution.
pub fn warmed(
    warmth: &Warmth,
    flow: Flow<'_>,
    enthalpy: &[f64],
    effort: &mut Effort,
) -> Result<Warmed, Failure> {
    let tau = PART * flow.dt;
    let part = Flow { dt: tau, ..flow };
    let first = stage(warmth, part, enthalpy, enthalpy, effort)?;
    // The rate of the first stage acts for what is left of the step.
    let rest = (flow.dt - tau) / tau;
    let base: Vec<f64> = (enthalpy.iter().zip(&first))
        .map(|(h, end)| h + rest * (end - h))
        .collect();
    let end = stage(warmth, part, &base, &first, effort)?;
    let leaves = |enthalpy: &[f64]| warmth.leaves(flow.parts, enthalpy);
    Ok(Warmed {
        radiated: (flow.dt - tau) * leaves(&first) + tau * leaves(&end),
        enthalpy: end,
    })
}

/// `rho V (H - H_base) = tau Q(H)`, with the heat Q that parts take.
fn stage(
    warmth: &Warmth,
    flow: Flow<'_>,
    base: &[f64],
    guess: &[f64],
    effort: &mut Effort,
) -> Result<Vec<f64>, Failure> {
    let most = base.iter().fold(0.0_f64, |m, h| m.max(h.abs()));
    let mut now = guess.to_vec();
    for _ in 0..ROUNDS {
        let t: Vec<f64> = now.iter().map(|h| warmth.temperature(*h)).collect();
        let taken = (0..base.len()).into_par_iter();
        let taken = taken.map(|i| flow.share(warmth, i) * flow.takes(warmth, &t, i));
        let lack: Vec<f64> = taken
            .enumerate()
            .map(|(i, gain)| base[i] + gain - now[i])
            .collect();
        let worst = lack.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
        if !worst.is_finite() {
            return Err(failed(&"the enthalpy is no number"));
        }
        if worst <= SETTLED * most {
            return Ok(now);
        }
        let options = Options {
            method: Method::Incomplete(Keep::PATTERN),
            ..Options::default()
        };
        let matrix = flow.matrix(warmth, &now, &t);
        let mut system = System::new(matrix, Vec::new(), options).map_err(|e| failed(&e))?;
        let sides: Vec<[f64; 1]> = lack.iter().map(|r| [*r]).collect();
        let mut change = vec![[0.0; 1]; base.len()];
        effort.add(&system.solve(&sides, &mut change, flow.rule))?;
        for (h, [c]) in now.iter_mut().zip(&change) {
            *h += c;
        }
    }
    effort.unsettled += 1;
    Ok(now)
}

impl Flow<'_> {
    /// Time over the mass of a part \[s/kg\].
    fn share(&self, warmth: &Warmth, i: usize) -> f64 {
        self.dt / (warmth.density * self.parts.volume[i])
    }

    /// Heat that a part takes \[W\].
    fn takes(&self, warmth: &Warmth, t: &[f64], i: usize) -> f64 {
        let faces = self.parts.faces[i].iter();
        let flows = faces.map(|face| face.reach * (t[face.other as usize] - t[i]));
        let area = self.parts.area.get(i).copied().unwrap_or(0.0);
        let added = self.added.at(i, self.parts.volume[i]);
        warmth.conductivity * flows.sum::<f64>() + added - area * warmth.radiated(t[i])
    }

    /// What enthalpies change in the equations of a stage.
    fn matrix(&self, warmth: &Warmth, enthalpy: &[f64], t: &[f64]) -> Rows<f64> {
        let bent: Vec<f64> = enthalpy.iter().map(|h| warmth.slope(*h)).collect();
        Rows::gathered(bent.len(), 0.0, |i, row| {
            let share = self.share(warmth, i);
            let mut own = 0.0;
            for face in &self.parts.faces[i] {
                let flow = share * warmth.conductivity * face.reach;
                own += flow * bent[i];
                row.push((face.other, -flow * bent[face.other as usize]));
            }
            let area = self.parts.area.get(i).copied().unwrap_or(0.0);
            own += share * area * warmth.steeper(t[i]) * bent[i];
            row.push((i as u32, 1.0 + own));
        })
    }
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
