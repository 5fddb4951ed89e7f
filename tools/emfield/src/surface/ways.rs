//! Forces that are known in several ways, and what to say where these disagree.
//!
//! Ways share little: densities or tractions added up at the bodies, Maxwell's stress of both sides of their surfaces or
//! over a surface in the medium around them, the reaction on the sources. Exact fields give the same by each. They are
//! apart by more than they may be where the difference exceeds a share of the force, or, where stresses cancel, of a tenth
//! of what they come to without their directions.

use shapes::frame::{Vector, length};

use crate::frames::{Doubt, Found};
use crate::geometry::Geometry;
use crate::magnetic::source::C;
use crate::magnetic::totals::spread;

/// Difference of two ways over the size of the force from which it is told.
pub(crate) const APART: f64 = 0.05;
/// What stresses come to without their directions counts as a force in this part.
const CANCELLED: f64 = 0.1;
/// A force in several ways.
pub(crate) struct Ways<'a> {
    /// What it acts on.
    pub(crate) of: &'a str,
    /// Each with how it was found.
    pub(crate) ways: Vec<(String, Vector)>,
    /// What the stresses come to without their directions \[N\].
    pub(crate) gross: f64,
    /// The largest force on one of several on which it acts together \[N\]; nothing on one alone.
    pub(crate) largest: f64,
    /// Where they are least certain, or largest.
    pub(crate) at: Vector,
}

/// The size with which differences of a force are compared.
pub(crate) fn size(ways: impl Iterator<Item = Vector>, gross: f64, largest: f64) -> f64 {
    ways.map(length)
        .fold(largest.max(CANCELLED * gross), f64::max)
}

/// What helps.
pub(crate) const HELP: &str = "points there do not resolve an edge, a wedge, a gap or a layer; take smaller spacings or another order";

/// A place in words.
pub(crate) fn told(place: Vector) -> String {
    let [x, y, z] = place;
    format!("most near ({x:.3e}, {y:.3e}, {z:.3e}) m")
}

impl Ways<'_> {
    /// What to say, if the ways disagree.
    pub(crate) fn doubt(&self, geometry: Geometry) -> Option<Doubt> {
        let forces: Vec<Vector> = self.ways.iter().map(|(_, f)| geometry.seen(*f)).collect();
        let apart = spread(&forces);
        let size = size(forces.iter().copied(), self.gross, self.largest);
        let share = apart / size;
        // Nothing over nothing is no doubt.
        if share.is_nan() || share <= APART {
            return None;
        }
        let unit = geometry.unit_of_force();
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
                told(self.at),
            ),
        })
    }
}

/// Adds the components of a force that there are.
pub(crate) fn push_force(geometry: Geometry, name: &str, force: Vector, all: &mut Found) {
    for k in geometry.pulled() {
        let name = format!("{name}_{}", ['x', 'y', 'z'][*k]);
        all.totals.push((name, geometry.unit_of_force(), force[*k]));
    }
}

/// Adds a force, and the largest difference between the ways of finding it.
pub(crate) fn push(geometry: Geometry, name: &str, ways: &[Vector], all: &mut Found) {
    push_force(geometry, name, ways[0], all);
    let part = |force: &Vector| geometry.seen(*force);
    let ways: Vec<Vector> = ways.iter().map(part).collect();
    all.totals.push((
        format!("{name}_spread"),
        geometry.unit_of_force(),
        spread(&ways),
    ));
}

/// The root of the mean square of fields over areas.
pub(crate) fn strength(fields: &[[C; 3]], areas: &[f64]) -> f64 {
    let square = |f: &[C; 3]| f.iter().map(C::norm_sqr).sum::<f64>();
    let sum: f64 = fields.iter().zip(areas).map(|(f, a)| a * square(f)).sum();
    (sum / areas.iter().sum::<f64>()).sqrt()
}

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
}
