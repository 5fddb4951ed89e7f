//! Grains that begin within each other, within walls or within metal. A contact pushes by its depth, so that what begins deep in
//! another is thrown out.

use neighbours::Grid;
use particles::{POSITION, Set};
use rayon::prelude::*;
use run::Fault;
use shapes::Body;
use shapes::frame::{difference, length};

use super::fill::radii;
use super::wall_parameters::WallScene;
use super::{DRIVEN, GLUED, RADIUS};

/// Part of the smaller radius from which on an overlap at the start is told.
const DEEP: f64 = 0.1;

/// Overlaps of one kind.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Found {
    /// Grains that have one.
    count: usize,
    /// The deepest, in smaller radii.
    depth: f64,
    /// Where it is \[m\].
    place: [f64; 3],
    /// Grains whose centre lies in the other.
    hidden: usize,
}

/// The deepest overlap of a grain in smaller radii, and whether a centre lies in the other.
type Own = (f64, bool);

impl Found {
    /// What grains have, of those that have any; `places` of all.
    fn of(places: &[[f64; 3]], own: impl Fn(usize) -> Own + Sync + Send) -> Option<Self> {
        let each: Vec<Own> = (0..places.len()).into_par_iter().map(own).collect();
        let deep = each.iter().enumerate().filter(|(_, own)| own.0 > DEEP);
        let (a, (depth, _)) = deep.clone().max_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
        Some(Self {
            count: deep.clone().count(),
            depth: *depth,
            place: places[a],
            hidden: deep.filter(|(_, own)| own.1).count(),
        })
    }

    fn told(&self, all: usize, other: &str) -> String {
        let [x, y, z] = self.place;
        format!(
            "{} of {all} grains begin within {other}, by up to {:.2} of the smaller radius at ({x:.4e}, {y:.4e}, {z:.4e}) m: \
             their contacts throw them out",
            self.count, self.depth
        )
    }
}

/// What is told of grains that begin deep within others; those of the rows `laid` lie as a bed has left them.
///
/// # Errors
/// Grains whose centres lie within each other.
pub fn overlaps(
    walls: &[WallScene],
    grains: &Set,
    laid: &[bool],
    metal: Option<&Set>,
) -> Result<Vec<String>, Fault> {
    let (places, widths) = (grains.column(&POSITION), grains.column(&RADIUS));
    let all = places.len();
    let mut told = Vec::new();
    if let Some(found) = Found::of(places, each_other(grains, laid)) {
        if found.hidden > 0 {
            let what = format!(
                "{}; the centres of {} lie within others: set them apart",
                found.told(all, "each other"),
                found.hidden
            );
            return Err(Fault::at("/bodies", what));
        }
        told.push(found.told(all, "each other"));
    }
    for (number, wall) in walls.iter().enumerate() {
        let body = Body::new(&wall.shape, 3);
        let side = if wall.hollow { -1.0 } else { 1.0 };
        let driven = grains.column(&DRIVEN);
        let within = |a: usize| {
            let free = driven.get(a).is_none_or(|body| *body == 0);
            let depth = 1.0 - side * body.distance(places[a]) / widths[a];
            (if free { depth } else { 0.0 }, false)
        };
        told.extend(Found::of(places, within).map(|f| f.told(all, &format!("wall {number}"))));
    }
    if let Some(metal) = metal {
        told.extend(Found::of(places, in_metal(grains, metal)).map(|f| f.told(all, "metal")));
    }
    Ok(told)
}

/// The overlap of each grain with others.
fn each_other<'a>(grains: &'a Set, laid: &'a [bool]) -> impl Fn(usize) -> Own + Sync + Send + 'a {
    let (places, widths) = (grains.column(&POSITION), grains.column(&RADIUS));
    let [_, widest] = radii(grains);
    let mut grid = Grid::new(2.0 * widest.max(f64::MIN_POSITIVE));
    grid.bin(places);
    let (glued, driven) = (grains.column(&GLUED), grains.column(&DRIVEN));
    let one = |marks: &[u8], a: usize, b: usize| {
        marks.get(a).is_some_and(|body| *body > 0) && marks.get(a) == marks.get(b)
    };
    move |a| {
        let mut deepest = (0.0, false);
        grid.runs(places[a], widths[a] + widest, |run| {
            for &b in &grid.order()[run] {
                let b = b as usize;
                let same = one(glued, a, b) || one(driven, a, b);
                if a == b || same || (laid[a] && laid[b]) {
                    continue;
                }
                let away = length(difference(places[a], places[b]));
                let (less, more) = (widths[a].min(widths[b]), widths[a].max(widths[b]));
                let depth = (less + more - away) / less;
                if depth > deepest.0 {
                    deepest = (depth, away < more);
                }
            }
        });
        deepest
    }
}

/// The overlap of each grain with particles of metal whose centres lie in it, or its own in them: a liquid that a grain floats in
/// touches it less deeply.
fn in_metal<'a>(grains: &'a Set, metal: &'a Set) -> impl Fn(usize) -> Own + Sync + Send + 'a {
    let (places, widths) = (grains.column(&POSITION), grains.column(&RADIUS));
    let others = metal.column(&POSITION);
    let own = 0.5 * metal.matter.spacing;
    let [_, widest] = radii(grains);
    let mut grid = Grid::new(own + widest.max(f64::MIN_POSITIVE));
    grid.bin(others);
    move |a| {
        let mut depth: f64 = 0.0;
        grid.runs(places[a], widths[a] + own, |run| {
            for &b in &grid.order()[run] {
                let away = length(difference(places[a], others[b as usize]));
                if away < widths[a].max(own) {
                    depth = depth.max((widths[a] + own - away) / widths[a].min(own));
                }
            }
        });
        (depth, false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grains::Parameters;
    use crate::grains::fill::fill;

    /// What is told of grains of radius 1 at places.
    fn told(bodies: &str) -> Result<Vec<String>, String> {
        let scene = format!(
            r#"{{"density_kg_m3": 3000, "contact": {{"law": {{"linear": {{"stiffness_n_m": 75}}}}, "restitution": 0.3}},
                "walls": [{{"shape": {{"box": {{"min_m": [-9, -9, -9], "max_m": [9, 9, 0]}}}}}}], "bodies": [{bodies}]}}"#
        );
        let scene: Parameters = serde_json::from_str(&scene).unwrap();
        let (set, _) = fill(&scene, &[]);
        let laid = vec![false; set.len()];
        overlaps(&scene.walls, &set, &laid, None).map_err(|fault| fault.to_string())
    }

    #[test]
    fn grains_that_begin_in_each_other_or_in_walls_are_told() {
        let pair = |apart: f64| {
            let up = 1.0 + apart;
            told(&format!(
                r#"{{"places_m": [[0, 0, 1], [0, 0, {up}]], "radius_m": 1}}"#
            ))
        };
        assert_eq!(pair(2.0), Ok(vec![]));
        assert_eq!(pair(1.95), Ok(vec![]));
        let deep = pair(1.5).unwrap();
        assert!(
            deep[0].contains("2 of 2 grains begin within each other, by up to 0.50"),
            "{deep:?}"
        );
        let hidden = pair(0.9).unwrap_err();
        assert!(
            hidden.contains("the centres of 2 lie within others"),
            "{hidden}"
        );
        let wall = told(r#"{"places_m": [[0, 0, 0.4], [4, 0, 1]], "radius_m": 1}"#).unwrap();
        assert!(wall[0].contains("1 of 2 grains begin within wall 0, by up to 0.60"));
    }

    #[test]
    fn a_small_grain_in_a_large_one_is_refused_and_glued_ones_may_overlap() {
        let small = r#"{"places_m": [[0, 0, 9]], "radius_m": 5}, {"places_m": [[0, 0, 12]], "radius_m": 1}"#;
        assert!(told(small).unwrap_err().contains("centres of 2"));
        let glued = r#"{"places_m": [[0, 0, 1], [0, 0, 2]], "radius_m": 1, "glued": true}"#;
        assert_eq!(told(glued), Ok(vec![]));
    }
}
