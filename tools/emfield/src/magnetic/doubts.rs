//! Forces and heats of currents that are known in several ways, and what to say where these disagree.

use shapes::frame::{Vector, length};

use super::fields::{Beyond, Fields};
use super::problem::Problem;
use super::source::C;
use super::totals::Totals;
use super::unknown::Unknown;
use crate::cloud::{Class, SurfacePoint};
use crate::frames::Doubt;
use crate::surface::ways::{APART, HELP, Ways, told};

/// Forces of currents that come to less than this part of all stresses on their conductors are not compared alone.
const WEAK: f64 = 0.01;

/// Heats of less than this part of what Poynting's vector comes to without its phase are noise of the solve.
const NOISE: f64 = 1e-7;

/// What to say of a heat by volume and by what flows in through surfaces, if they disagree; `gross` is what that comes to without
/// its phase.
fn heats(ways: [f64; 2], gross: f64, unit: &str, at: Vector) -> Option<Doubt> {
    let apart = (ways[0] - ways[1]).abs();
    let most = ways[0].abs().max(ways[1].abs());
    let share = apart / most.max(NOISE * gross);
    // Nothing over nothing is no doubt.
    (share > APART).then(|| Doubt {
        of: "heat".to_owned(),
        share,
        what: format!(
            "heat in all conductors: {:.3e} {unit} by volume, {:.3e} {unit} by what flows in through their surfaces: they differ by {apart:.2e} {unit}, {:.0} % of the larger, {}: {HELP}",
            ways[0],
            ways[1],
            100.0 * share,
            told(at),
        ),
    })
}

impl<const D: usize> Problem<'_, D> {
    /// A doubt about the force on all bodies; none where a wall counts as a part of one, whose surface lacks that.
    pub(crate) fn doubt(&self, fields: &Fields, totals: &Totals) -> Option<Doubt> {
        if self.parameters.unknown == Unknown::Axial || self.walled() {
            return None;
        }
        let volume = ("volume".to_owned(), totals.force_volume);
        let stress = ("the stress on surfaces".to_owned(), totals.force_stress);
        // Walls that screen take a part of the reaction.
        let whole = self.parameters.open;
        let coil = ("the reaction on sources".to_owned(), totals.force_coil);
        let coil = whole.then_some(coil);
        let (mut gross, mut most) = (0.0, (0.0, 0));
        for (i, (w, f)) in self.weights.iter().zip(&fields.force).enumerate() {
            let pull = (w * length(*f)).abs();
            gross += pull;
            if pull > most.0 {
                most = (pull, i);
            }
        }
        let doubt = |ways: Vec<(String, Vector)>, gross: f64| {
            let all = Ways {
                of: if self.acting().permeable.is_some() {
                    "all bodies"
                } else {
                    "all conductors"
                },
                ways,
                gross,
                largest: 0.0,
                at: self.cloud.position[most.1],
            };
            all.doubt(self.cloud.geometry)
        };
        // The stress is that of the sources too, whose sum over points is not nothing. Beside them weak currents are noise.
        let all = [volume.clone(), stress].into_iter().chain(coil.clone());
        let most = self.stresses(fields);
        let found = doubt(all.collect(), gross.max(most));
        let pair = || doubt(vec![volume, coil?], gross);
        found.or_else(|| (gross > WEAK * most).then(pair).flatten())
    }

    /// Whether a wall counts as a part of what is acted on, whose surface lacks that.
    fn walled(&self) -> bool {
        let acting = self.acting();
        let acts = |m: u16| acting.acts[m as usize];
        let walled = |class: &Class| matches!(class, Class::Outer { medium, .. } if acts(*medium));
        self.cloud.class.iter().any(walled)
    }

    /// A doubt about the heat in all conductors in a sinusoidal steady state: what is released in them is what flows in through
    /// their surfaces (Poynting 1884).
    pub(crate) fn heat_doubt(&self, fields: &Fields, totals: &Totals) -> Option<Doubt> {
        if self.parameters.omega.is_none()
            || self.parameters.unknown == Unknown::Axial
            || self.walled()
        {
            return None;
        }
        let heat = |i: &usize| (self.weights[*i] * fields.heat[*i]).abs();
        let hottest = (0..self.weights.len()).max_by(|a, b| heat(a).total_cmp(&heat(b)))?;
        heats(
            [totals.heat_volume, totals.heat_surface],
            totals.heat_gross,
            self.cloud.geometry.unit_of_power(),
            self.cloud.position[hottest],
        )
    }

    /// What the stresses on surfaces of bodies come to without their directions, from without \[N\].
    fn stresses(&self, fields: &Fields) -> f64 {
        let acting = self.acting();
        let square = |(s, beyond): (&SurfacePoint, &Beyond)| -> f64 {
            let [a, b] = [s.inner, s.outer].map(|m| acting.acts[m as usize]);
            if a == b {
                return 0.0;
            }
            let (flux, other) = if a {
                (beyond.flux, s.outer)
            } else {
                (fields.flux[s.point as usize], s.inner)
            };
            let square: f64 = flux.iter().map(C::norm_sqr).sum();
            s.area * square / (2.0 * acting.laws[other as usize].permeability(square.sqrt()))
        };
        let outer = self.cloud.surface.iter().zip(&fields.beyond);
        outer.map(square).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heats_that_disagree_are_told() {
        let told = |ways, gross| heats(ways, gross, "W", [0.0; 3]);
        let far = told([34.6, 1.7e-6], 100.0).unwrap();
        assert!(
            far.share > 0.99 && far.what.contains("3.460e1 W by volume, 1.700e-6 W by"),
            "{far:?}"
        );
        assert!((told([60.8, 30.3], 100.0).unwrap().share - 30.5 / 60.8).abs() < 1e-12);
        assert_eq!(told([1.0, 1.04], 100.0), None);
        // Noise of the solve beside fields that bring no heat.
        assert_eq!(told([1e-12, 2e-10], 1.0), None);
        assert_eq!(told([0.0; 2], 0.0), None);
    }
}
