//! `flow-sessile`: a drop that sits on a plane which it meets at a right angle.

use std::f64::consts::PI;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::{Frames, mean, measurement, number};

/// The case.
pub(super) struct FlowSessile;

/// Steps along the surface.
const STEPS: u32 = 2000;

impl Case for FlowSessile {
    fn name(&self) -> &'static str {
        "flow-sessile"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Young (1805), Laplace (1806): gamma kappa = c + rho g z, integrated; Bashforth and Adams (1883)"
    }

    fn targets(&self) -> Vec<Target> {
        let each = [2, 3].iter().flat_map(|level| {
            ["height", "width"].map(|name| Target::error(name, 0.02).at_level(*level))
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        // 7, 9 and 11 particles along the radius.
        let spacing = 5e-3 / (5.0 + 2.0 * f64::from(level));
        let patch = serde_json::json!({"spacing_m": spacing});
        let run = lab.run("poolsph", self.name(), &format!("level{level}"), &patch)?;
        let frames = Frames::read(&run.artefact, "pressure")?;
        let errors = errors(&run, &frames)?;
        measurement(run, frames.liquid.len(), errors)
    }
}

/// The height of the middle of the drop, and its width as the root mean square of the distances from its axis; means over
/// the second half of the run.
fn errors(run: &Finished, frames: &Frames) -> Result<Errors, LabError> {
    let volume = frames.liquid.len() as f64 * frames.volume;
    let weight = -number(run, "/density_kg_m3")? * number(run, "/flow/gravity_m_s2/2")?;
    let tension = number(run, "/tension/surface_tension_n_m")?;
    let exact = Sessile::of(volume, weight / tension);
    let all = || frames.second_half().map(|k| &frames.position[k]);
    let height = mean(all().map(|places| mean(places.iter().map(|x| x[2]))));
    let square = mean(all().map(|places| {
        let [x, y] = [0, 1].map(|i| mean(places.iter().map(|x| x[i])));
        mean(
            places
                .iter()
                .map(|place| (place[0] - x).powi(2) + (place[1] - y).powi(2)),
        )
    }));
    let errors = [
        ("height", (height / exact.height - 1.0).abs()),
        ("width", (square.sqrt() / exact.width - 1.0).abs()),
    ];
    Ok(errors.map(|(name, error)| (name.to_owned(), error)).into())
}

/// A drop at rest.
#[derive(Debug, Clone, Copy)]
struct Sessile {
    volume: f64,
    /// Mean height above the plane \[m\].
    height: f64,
    /// Root mean square of the distances from the axis \[m\].
    width: f64,
}

impl Sessile {
    /// The drop of this volume \[m3\], with rho g/gamma \[1/m2\].
    fn of(volume: f64, bond: f64) -> Self {
        // The radius of the top grows with the volume.
        let ball = (1.5 * volume / PI).cbrt();
        let (mut low, mut high) = (0.5 * ball, 1e3 * ball);
        for _ in 0..200 {
            let middle = (low * high).sqrt();
            if Self::topped(middle, bond).volume < volume {
                low = middle;
            } else {
                high = middle;
            }
        }
        Self::topped(low, bond)
    }

    /// The drop with the radius `top` \[m\] at its top. From there on along the surface dr = cos(phi) ds, dz = sin(phi) ds, and
    /// dphi/ds = 2/top + bond z - sin(phi)/r; it ends where it is upright. phi is taken for the length.
    fn topped(top: f64, bond: f64) -> Self {
        let slopes = |phi: f64, [r, z, ..]: [f64; 5]| {
            let turn = if phi > 0.0 {
                2.0 / top + bond * z - phi.sin() / r
            } else {
                1.0 / top
            };
            let (dr, dz) = (phi.cos() / turn, phi.sin() / turn);
            let slice = PI * r * r * dz;
            [dr, dz, slice, slice * z, 0.5 * slice * r * r]
        };
        let step = 0.5 * PI / f64::from(STEPS);
        let mut at = [0.0; 5];
        for k in 0..STEPS {
            let phi = f64::from(k) * step;
            let next = |slope: [f64; 5], part: f64| {
                std::array::from_fn(|i| at[i] + part * step * slope[i])
            };
            let one = slopes(phi, at);
            let two = slopes(phi + 0.5 * step, next(one, 0.5));
            let three = slopes(phi + 0.5 * step, next(two, 0.5));
            let four = slopes(phi + step, next(three, 1.0));
            at = std::array::from_fn(|i| {
                at[i] + step / 6.0 * (one[i] + 2.0 * two[i] + 2.0 * three[i] + four[i])
            });
        }
        let [_, depth, volume, moment, square] = at;
        Self {
            volume,
            height: depth - moment / volume,
            width: (square / volume).sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_weight_it_is_half_a_ball() {
        let volume = 2.0 / 3.0 * PI;
        let drop = Sessile::of(volume, 0.0);
        assert!((drop.height - 3.0 / 8.0).abs() < 1e-6, "{drop:?}");
        assert!((drop.width - 0.4_f64.sqrt()).abs() < 1e-6, "{drop:?}");
    }

    #[test]
    fn a_puddle_is_as_high_as_tension_bears() {
        // rho g h^2/2 = gamma at a right angle, and the middle is half as high.
        let drop = Sessile::of(1e6, 1.0);
        assert!(
            (drop.height / 0.5_f64.sqrt() - 1.0).abs() < 0.02,
            "{drop:?}"
        );
    }
}
