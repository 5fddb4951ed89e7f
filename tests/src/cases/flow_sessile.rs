//! `flow-sessile`: a drop that sits on a plane which it meets at a contact angle.

use std::f64::consts::PI;

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::{Frames, mean, measurement, number};

/// The case.
pub(super) struct FlowSessile;

/// The contact angle where a scene says none [degree].
const RIGHT: f64 = 90.0;
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

    fn methods(&self) -> &'static [&'static str] {
        &["90-degrees", "60-degrees", "120-degrees"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = self.methods().iter().flat_map(|method| {
            [2, 3].into_iter().flat_map(move |level| {
                ["height", "width"]
                    .map(|name| Target::error(name, 0.02).at_level(level).of(*method))
            })
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // 7, 9 and 11 particles along the radius.
        let spacing = 5e-3 / (5.0 + 2.0 * f64::from(level));
        let mut patch = json!({"spacing_m": spacing});
        let degrees = method.strip_suffix("-degrees").map(str::parse::<f64>);
        if let Some(Ok(degrees)) = degrees
            && degrees != RIGHT
        {
            let angle = json!({"face": "z-", "angle_deg": degrees});
            patch["faces"] = json!({"contact_angles": [angle]});
        }
        let name = format!("{method}-level{level}");
        let run = lab.run("poolsph", self.name(), &name, &patch)?;
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
    let degrees = number(run, "/faces/contact_angles/0/angle_deg").unwrap_or(RIGHT);
    let exact = Sessile::of(volume, weight / tension, degrees.to_radians());
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
    /// The drop of this volume \[m3\], with rho g/gamma \[1/m2\], at this contact angle.
    fn of(volume: f64, bond: f64, angle: f64) -> Self {
        // The radius of the top grows with the volume.
        let ball = (1.5 * volume / PI).cbrt();
        let (mut low, mut high) = (0.3 * ball, 1e3 * ball);
        for _ in 0..200 {
            let middle = (low * high).sqrt();
            if Self::topped(middle, bond, angle).volume < volume {
                low = middle;
            } else {
                high = middle;
            }
        }
        Self::topped(low, bond, angle)
    }

    /// The drop with the radius `top` \[m\] at its top. From there on along the surface dr = cos(phi) ds, dz = sin(phi) ds, and
    /// dphi/ds = 2/top + bond z - sin(phi)/r; it ends where phi is the contact angle. phi is taken for the length.
    fn topped(top: f64, bond: f64, angle: f64) -> Self {
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
        let step = angle / f64::from(STEPS);
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
        let drop = Sessile::of(volume, 0.0, 0.5 * PI);
        assert!((drop.height - 3.0 / 8.0).abs() < 1e-6, "{drop:?}");
        assert!((drop.width - 0.4_f64.sqrt()).abs() < 1e-6, "{drop:?}");
    }

    #[test]
    fn without_weight_it_is_a_cap() {
        // Of a ball of radius 1 whose middle is cos(angle) below the plane: heights z, radius^2 1 - (z + c)^2.
        for degrees in [30.0_f64, 60.0, 120.0, 150.0] {
            let angle = degrees.to_radians();
            let c = angle.cos();
            let (mut volume, mut moment, mut square) = (0.0, 0.0, 0.0);
            for k in 0..20_000 {
                let z = (1.0 - c) * (f64::from(k) + 0.5) / 20_000.0;
                let slice = PI * (1.0 - (z + c).powi(2)) * (1.0 - c) / 20_000.0;
                volume += slice;
                moment += slice * z;
                square += 0.5 * slice * (1.0 - (z + c).powi(2));
            }
            let drop = Sessile::of(volume, 0.0, angle);
            let (height, width) = (moment / volume, (square / volume).sqrt());
            assert!(
                (drop.height / height - 1.0).abs() < 1e-6,
                "{drop:?} {height}"
            );
            assert!((drop.width / width - 1.0).abs() < 1e-6, "{drop:?} {width}");
        }
    }

    #[test]
    fn a_puddle_is_as_high_as_tension_bears() {
        // rho g h^2/2 = gamma at a right angle, and the middle is half as high.
        let drop = Sessile::of(1e6, 1.0, 0.5 * PI);
        assert!(
            (drop.height / 0.5_f64.sqrt() - 1.0).abs() < 0.02,
            "{drop:?}"
        );
    }
}
