//! Electric forces that are known in several ways, and what to say where these disagree.

use shapes::frame::{Vector, difference, length};

use super::enclosed::Closed;
use super::equations::Problem;
use super::traction::{EPS0, stress};
use crate::cloud::{Cloud, SurfacePoint};
use crate::frames::Doubt;
use crate::geometry::Geometry;
use crate::surface::ways::{APART, HELP, Ways, size, told};

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
    fn add(&mut self, area: f64, pull: Vector, [inside, outside]: [Vector; 2], place: Vector) {
        let jump = difference(outside, inside);
        for k in 0..3 {
            self.force[k] += area * pull[k];
            self.stress[k] += area * jump[k];
        }
        // Of media that are nearly alike hardly anything is left of both stresses.
        self.gross += area * length(pull).max(length(outside));
        let apart = area * length(difference(jump, pull));
        if apart >= self.worst.0 {
            self.worst = (apart, place);
        }
    }
}

/// Doubts about electric forces: of each body by its tractions and by the stress of both sides, of all within each closed
/// surface by the stress over it. Tractions and fields of both sides are by surface point.
pub(crate) fn doubts(
    cloud: &Cloud,
    problem: &Problem,
    pulls: &[Vector],
    sides: [&[Vector]; 2],
    closed: &[Closed],
) -> Vec<Doubt> {
    let mut bodies = vec![Pulled::default(); cloud.media.len() - 1];
    let mut within = vec![Pulled::default(); closed.len()];
    for (n, (s, pull)) in cloud.surface.iter().zip(pulls).enumerate() {
        let both = both(problem, s, sides.map(|fields| fields[n]));
        let place = cloud.position[s.point as usize];
        if s.inner > 0 {
            bodies[s.inner as usize - 1].add(s.area, *pull, both, place);
        }
        for (all, one) in within.iter_mut().zip(closed) {
            if one.within.is_none_or(|w| w[s.point as usize]) {
                all.add(s.area, *pull, both, place);
            }
        }
    }
    let geometry = cloud.geometry;
    let own = cloud
        .media
        .iter()
        .skip(1)
        .zip(&bodies)
        .filter_map(|(body, own)| {
            let ways = Ways {
                of: body,
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
    let sizes = bodies.iter().map(|own| length(geometry.seen(own.force)));
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
        doubt.or_else(|| charged(cloud, problem, one, &ways, all))
    });
    let worst = |a: Doubt, b: Doubt| if b.share > a.share { b } else { a };
    own.reduce(worst)
        .into_iter()
        .chain(all.reduce(worst))
        .collect()
}

/// Maxwell's stress on both sides of a surface point, from the fields there; none is within electrodes.
fn both(problem: &Problem, s: &SurfacePoint, fields: [Vector; 2]) -> [Vector; 2] {
    [(s.inner, fields[0]), (s.outer, fields[1])].map(|(m, field)| {
        let held = problem.electrodes[m as usize].is_some();
        if held {
            return [0.0; 3];
        }
        let eps = problem.permittivity[m as usize];
        stress(field, s.normal).map(|t| EPS0 * eps * t)
    })
}

/// What to say where a surface about dielectrics lets a flux through as if they carried charge: the field about them
/// pulls at it.
fn charged(
    cloud: &Cloud,
    problem: &Problem,
    one: &Closed,
    ways: &Ways,
    all: &Pulled,
) -> Option<Doubt> {
    if problem.electrodes.iter().any(Option::is_some) {
        return None;
    }
    let pull = (one.charge * one.field).abs();
    let forces = [all.force, one.force].map(|f| cloud.geometry.seen(f));
    let share = pull / size(forces.into_iter(), ways.gross, ways.largest);
    (share > APART).then(|| Doubt {
        of: ways.of.to_owned(),
        share,
        what: format!(
            "force on {}: a flux passes through as if they carried {:.2e} {}, though nothing does: the field there pulls at that by {pull:.2e} {}, {:.0} % of the largest force or of a tenth of all stresses, {}: {HELP}",
            ways.of,
            one.charge,
            if cloud.geometry == Geometry::Plane { "C/m" } else { "C" },
            cloud.geometry.unit_of_force(),
            100.0 * share,
            told(ways.at),
        ),
    })
}
