//! Forces that are known in several ways, and what to say where these disagree.
//!
//! Ways share little: densities or tractions added up at the bodies, Maxwell's stress of both sides of their surfaces or
//! over a surface in the medium around them, the reaction on the sources. Exact fields give the same by each. They are
//! apart by more than they may be where the difference exceeds a share of the force, or, where stresses cancel, of a tenth
//! of what they come to without their directions.

use num_complex::Complex;
use shapes::frame::{Vector, length};

use super::enclosed::Closed;
use super::forces::{seen, unit};
use super::setting::Setting;
use crate::cloud::{Class, Cloud, SurfacePoint};
use crate::electric::traction::{EPS0, stress};
use crate::magnetic::fields::{Beyond, Fields};
use crate::magnetic::source::minus;
use crate::magnetic::totals::{Acting, Totals, spread};
use crate::magnetic::unknown::Unknown;
use crate::output::Doubt;
use crate::scene::currents::OuterReaction;
use crate::scene::{Geometry, Scene};

/// Difference of two ways over the size of the force from which it is told.
const APART: f64 = 0.05;
/// What stresses come to without their directions counts as a force in this part.
const CANCELLED: f64 = 0.1;
/// Forces of currents that come to less than this part of all stresses on their conductors are not compared alone.
const WEAK: f64 = 0.01;

/// Heats of less than this part of what Poynting's vector comes to without its phase are noise of the solve.
const NOISE: f64 = 1e-7;

/// A force in several ways.
pub(super) struct Ways<'a> {
    /// What it acts on.
    pub(super) of: &'a str,
    /// Each with how it was found.
    pub(super) ways: Vec<(String, Vector)>,
    /// What the stresses come to without their directions \[N\].
    pub(super) gross: f64,
    /// The largest force on one of several on which it acts together \[N\]; nothing on one alone.
    pub(super) largest: f64,
    /// Where they are least certain, or largest.
    pub(super) at: Vector,
}

/// The size with which differences of a force are compared.
fn size(ways: impl Iterator<Item = Vector>, (gross, largest): (f64, f64)) -> f64 {
    ways.map(length)
        .fold(largest.max(CANCELLED * gross), f64::max)
}

/// What helps.
const HELP: &str = "points there do not resolve an edge, a wedge, a gap or a layer; take smaller spacings or another order";

/// A place in words.
fn told((x, y, z): (f64, f64, f64)) -> String {
    format!("most near ({x:.3e}, {y:.3e}, {z:.3e}) m")
}

impl Ways<'_> {
    /// What to say, if the ways disagree.
    pub(super) fn doubt(&self, geometry: Geometry) -> Option<Doubt> {
        let forces: Vec<Vector> = self.ways.iter().map(|(_, f)| seen(geometry, *f)).collect();
        let apart = spread(&forces);
        let size = size(forces.iter().copied(), (self.gross, self.largest));
        let share = apart / size;
        // Nothing over nothing is no doubt.
        if share.is_nan() || share <= APART {
            return None;
        }
        let unit = unit(geometry);
        let way = |((way, _), force): (&(String, Vector), &Vector)| {
            format!("{:.3e} {unit} by {way}", length(*force))
        };
        let ways: Vec<String> = self.ways.iter().zip(&forces).map(way).collect();
        Some(Doubt {
            of: self.of.to_owned(),
            share,
            what: format!(
                "force on {}: {}: they differ by {apart:.2e} {unit}, {:.0} % of the largest force or of a tenth of all stresses, {:.2e} {unit}, {}: {HELP}",
                self.of,
                ways.join(", "),
                100.0 * share,
                self.gross,
                told(self.at.into()),
            ),
        })
    }
}

/// What to say of a heat by volume and by what flows in through surfaces, if they disagree; `gross` is what that comes to without
/// its phase.
fn heats(ways: [f64; 2], gross: f64, (unit, at): (&str, Vector)) -> Option<Doubt> {
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
            told(at.into()),
        ),
    })
}

/// Tractions added up over some surfaces.
#[derive(Clone, Copy, Default)]
struct Pulled {
    /// By the tractions.
    force: Vector,
    /// By Maxwell's stress of both sides.
    stress: Vector,
    /// The stresses without their directions.
    gross: f64,
    /// Where both differ most, and by how much.
    worst: (f64, Vector),
}

impl Pulled {
    fn add(&mut self, area: f64, (pull, [inside, outside]): (Vector, [Vector; 2]), place: Vector) {
        let jump = minus(outside, inside);
        for k in 0..3 {
            self.force[k] += area * pull[k];
            self.stress[k] += area * jump[k];
        }
        // Of media that are nearly alike hardly anything is left of both stresses.
        self.gross += area * length(pull).max(length(outside));
        let apart = area * length(minus(jump, pull));
        if apart >= self.worst.0 {
            self.worst = (apart, place);
        }
    }
}

/// Doubts about electric forces: of each body by its tractions and by the stress of both sides, of all within each closed
/// surface by the stress over it. Tractions and fields of both sides are by surface point.
pub(super) fn electric(
    (scene, cloud): (&Scene, &Cloud),
    (pulls, sides): (&[Vector], [&[Vector]; 2]),
    closed: &[Closed],
) -> Vec<Doubt> {
    let mut bodies = vec![Pulled::default(); scene.bodies.len()];
    let mut within = vec![Pulled::default(); closed.len()];
    for (n, (s, pull)) in cloud.surface.iter().zip(pulls).enumerate() {
        let both = both(scene, s, sides.map(|fields| fields[n]));
        let place = cloud.position[s.point as usize];
        if s.inner > 0 {
            bodies[s.inner as usize - 1].add(s.area, (*pull, both), place);
        }
        for (all, one) in within.iter_mut().zip(closed) {
            if one.within.is_none_or(|w| w[s.point as usize]) {
                all.add(s.area, (*pull, both), place);
            }
        }
    }
    let geometry = scene.geometry;
    let own = scene.bodies.iter().zip(&bodies).filter_map(|(body, own)| {
        let ways = Ways {
            of: &body.name,
            ways: vec![
                ("its tractions".to_owned(), own.force),
                ("the stress of both sides".to_owned(), own.stress),
            ],
            gross: own.gross,
            largest: 0.0,
            at: own.worst.1,
        };
        ways.doubt(geometry)
    });
    let sizes = bodies.iter().map(|own| length(seen(geometry, own.force)));
    let largest = sizes.fold(0.0, f64::max);
    let all = closed.iter().zip(&within).filter_map(|(one, all)| {
        let ways = Ways {
            of: &format!("all within {}", one.name),
            ways: vec![
                ("tractions".to_owned(), all.force),
                ("the stress over that".to_owned(), one.force),
            ],
            gross: all.gross,
            largest,
            at: all.worst.1,
        };
        let doubt = ways.doubt(geometry);
        doubt.or_else(|| charged(scene, one, (&ways, all)))
    });
    let worst = |a: Doubt, b: Doubt| if b.share > a.share { b } else { a };
    own.reduce(worst)
        .into_iter()
        .chain(all.reduce(worst))
        .collect()
}

/// Maxwell's stress on both sides of a surface point, from the fields there; none is within electrodes.
fn both(scene: &Scene, s: &SurfacePoint, fields: [Vector; 2]) -> [Vector; 2] {
    [(s.inner, fields[0]), (s.outer, fields[1])].map(|(m, field)| {
        let held = m > 0 && scene.bodies[m as usize - 1].potential_v.is_some();
        if held {
            return [0.0; 3];
        }
        let eps = scene.medium(m as usize).relative_permittivity;
        stress(field, s.normal).map(|t| EPS0 * eps * t)
    })
}

/// What to say where a surface about dielectrics lets a flux through as if they carried charge: the field about them
/// pulls at it.
fn charged(scene: &Scene, one: &Closed, (ways, all): (&Ways, &Pulled)) -> Option<Doubt> {
    if scene.bodies.iter().any(|b| b.potential_v.is_some()) {
        return None;
    }
    let pull = (one.charge * one.field).abs();
    let forces = [all.force, one.force].map(|f| seen(scene.geometry, f));
    let share = pull / size(forces.into_iter(), (ways.gross, ways.largest));
    (share > APART).then(|| Doubt {
        of: ways.of.to_owned(),
        share,
        what: format!(
            "force on {}: a flux passes through as if they carried {:.2e} {}, though nothing does: the field there pulls at that by {pull:.2e} {}, {:.0} % of the largest force or of a tenth of all stresses, {}: {HELP}",
            ways.of,
            one.charge,
            if scene.geometry == Geometry::Plane { "C/m" } else { "C" },
            unit(scene.geometry),
            100.0 * share,
            told(ways.at.into()),
        ),
    })
}

impl<const D: usize> Setting<'_, D> {
    /// A doubt about the force on all bodies; none where a wall counts as a part of one, whose surface lacks that.
    pub(super) fn doubt(
        &self,
        fields: &Fields,
        (totals, acting): (&Totals, Acting<'_>),
    ) -> Option<Doubt> {
        if self.unknown == Unknown::Axial || self.walled(acting) {
            return None;
        }
        let volume = ("volume".to_owned(), totals.force_volume);
        let stress = ("the stress on surfaces".to_owned(), totals.force_stress);
        // Walls that screen take a part of the reaction.
        let whole = self.currents.outer == OuterReaction::Multipole;
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
                of: if acting.permeable.is_some() {
                    "all bodies"
                } else {
                    "all conductors"
                },
                ways,
                gross,
                largest: 0.0,
                at: self.cloud.position[most.1],
            };
            all.doubt(self.scene.geometry)
        };
        // The stress is that of the sources too, whose sum over points is not nothing. Beside them weak currents are noise.
        let all = [volume.clone(), stress].into_iter().chain(coil.clone());
        let most = self.stresses(fields, acting);
        let found = doubt(all.collect(), gross.max(most));
        let pair = || doubt(vec![volume, coil?], gross);
        found.or_else(|| (gross > WEAK * most).then(pair).flatten())
    }

    /// Whether a wall counts as a part of what is acted on, whose surface lacks that.
    fn walled(&self, acting: Acting<'_>) -> bool {
        let acts = |m: u8| acting.acts[m as usize];
        let walled = |class: &Class| matches!(class, Class::Outer { medium, .. } if acts(*medium));
        self.cloud.class.iter().any(walled)
    }

    /// A doubt about the heat in all conductors in a sinusoidal steady state: what is released in them is what flows in through
    /// their surfaces (Poynting 1884).
    pub(super) fn heat_doubt(
        &self,
        fields: &Fields,
        (totals, acting): (&Totals, Acting<'_>),
    ) -> Option<Doubt> {
        if self.omega.is_none() || self.unknown == Unknown::Axial || self.walled(acting) {
            return None;
        }
        let heat = |i: &usize| (self.weights[*i] * fields.heat[*i]).abs();
        let hottest = (0..self.weights.len()).max_by(|a, b| heat(a).total_cmp(&heat(b)))?;
        let unit = match self.scene.geometry {
            Geometry::Plane => "W/m",
            _ => "W",
        };
        let at = (unit, self.cloud.position[hottest]);
        heats(
            [totals.heat_volume, totals.heat_surface],
            totals.heat_gross,
            at,
        )
    }

    /// What the stresses on surfaces of bodies come to without their directions, from without \[N\].
    fn stresses(&self, fields: &Fields, acting: Acting<'_>) -> f64 {
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

/// A complex number.
type C = Complex<f64>;

#[cfg(test)]
mod tests {
    use super::*;

    fn ways(forces: &[Vector], gross: f64) -> Option<Doubt> {
        let way = |f: &Vector| ("some way".to_owned(), *f);
        let ways = Ways {
            of: "ball",
            ways: forces.iter().map(way).collect(),
            gross,
            largest: 0.0,
            at: [1.0, 2.0, 3.0],
        };
        ways.doubt(Geometry::Space)
    }

    #[test]
    fn ways_that_disagree_are_told_with_their_place() {
        let near = [[0.0, 0.0, 1.0], [0.0, 0.0, 1.04]];
        assert_eq!(ways(&near, 2.0), None);
        let far = ways(&[[0.0, 0.0, 1.0], [0.0, 0.1, 1.0]], 2.0).unwrap();
        assert!((far.share - 0.1 / 1.01_f64.sqrt()).abs() < 1e-12);
        let said = &far.what;
        assert!(
            said.starts_with("force on ball: 1.000e0 N by some way, 1.005e0 N"),
            "{said}"
        );
        assert!(
            said.contains("differ by 1.00e-1 N, 10 %") && said.contains("(1.000e0, 2.000e0"),
            "{said}"
        );
    }

    #[test]
    fn pulls_that_cancel_are_no_doubt_and_nothing_is_none() {
        assert_eq!(ways(&[[1e-3, 0.0, 0.0], [-1e-3, 0.0, 0.0]], 1.0), None);
        assert!(ways(&[[4e-3, 0.0, 0.0], [-4e-3, 0.0, 0.0]], 1.0).is_some());
        assert_eq!(ways(&[[0.0; 3], [0.0; 3]], 0.0), None);
    }

    #[test]
    fn heats_that_disagree_are_told() {
        let told = |ways, gross| heats(ways, gross, ("W", [0.0; 3]));
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

    #[test]
    fn what_a_scene_does_not_have_is_not_seen() {
        let force = [1.0, 2.0, 4.0];
        assert!((length(seen(Geometry::Axisymmetric, force)) - 4.0).abs() < 1e-15);
        assert!((length(seen(Geometry::Plane, force)) - 5.0_f64.sqrt()).abs() < 1e-15);
    }
}
