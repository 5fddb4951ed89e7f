//! How many points a layout has at least, and what memory they take, before any is made.
//!
//! A lattice of spacing `h` has a point in each `h^d`. The domain is halved, part by part, where the wanted spacing changes
//! most; each part then has at least the points of the largest spacing that is wanted anywhere in it. Surfaces are counted by
//! their area in coarse pieces.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

use run::Fault;
use shapes::frame::{Vector, length};
use shapes::surface::{Piece, pieces};

use crate::cloud::Filling;
use crate::cloud::layout::{Layout, Wall};
use crate::cloud::points::Arrangement;

/// Most points of a cloud: their numbers have 32 bits.
const MOST: f64 = 4e9;
/// Most spacings across the domain: places are known to a part in 1e16.
const ACROSS: f64 = 1e12;
/// Parts into which the domain is halved.
const PARTS: usize = 2000;
/// Pieces across the widest side of a body whose area is measured.
const PIECES: f64 = 24.0;
/// Bytes of a piece of surface, while points are chosen among them.
const PIECE: f64 = (size_of::<Piece>() + 24) as f64;
/// Pieces per spacing of a surface of even and of uneven points: see [`super::surface`].
const EVEN: [f64; 2] = [512.0, 36.0];
const UNEVEN: [f64; 2] = [512.0, 9.0];
/// Least spacing over that of a body where another is near: see [`super::faces`].
const NEAR: f64 = 8.0;
/// Bytes of a point itself.
const POINT: f64 = 112.0;

/// What there is at least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Least {
    /// Points.
    pub(crate) points: f64,
    /// Memory of points and of the weights of their stencils \[byte\].
    pub(crate) bytes: f64,
}

/// A part of the domain: a box along the axes.
struct Part {
    middle: Vector,
    half: Vector,
    /// Points in it: at least, and at most as far as is known.
    points: [f64; 2],
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    /// The part of which least is known is the greatest.
    fn cmp(&self, other: &Self) -> Ordering {
        let doubt = |part: &Self| part.points[1] - part.points[0];
        doubt(self).total_cmp(&doubt(other))
    }
}

/// Refuses what cannot be counted, or takes more memory than there is.
pub(crate) fn check(layout: &Layout, filling: &Filling<'_>) -> Result<(), Vec<Fault>> {
    if layout.across() > ACROSS {
        let what = format!(
            "the domain is {:.1e} spacings of {} m wide; at most {ACROSS:.0e}, beyond which places are not told apart",
            layout.across(),
            layout.spacing
        );
        return Err(vec![Fault::at("/domain", what)]);
    }
    for (k, solid) in layout.solids.iter().enumerate() {
        let [low, high] = solid.body.bounds();
        let widest = (0..layout.dimensions).fold(0.0_f64, |w, k| w.max(high[k] - low[k]));
        // What is infinite has a face in the domain alone.
        if widest.is_finite() && widest > ACROSS * solid.spacing {
            let what = format!(
                "is {widest:.1e} m wide, {:.1e} spacings; at most {ACROSS:.0e}, beyond which places are not told apart",
                widest / solid.spacing
            );
            return Err(vec![Fault::at(&format!("/bodies/{k}/shape"), what)]);
        }
    }
    let least = least(layout, filling);
    let what = format!(
        "spacing {} m in this domain gives at least {:.1e} points",
        layout.spacing, least.points
    );
    let at = "/points/spacing_m";
    let change = "take larger spacings, a smaller domain, or let \"outward\" and \"largest_m\" widen the points far away";
    let fault = if least.points > MOST {
        let what = format!("{what}; at most {MOST:.0e}; {change}");
        Some(Fault::at(at, what))
    } else {
        run::crowded(at, &what, least.bytes, change)
    };
    fault.map_or(Ok(()), |fault| Err(vec![fault]))
}

/// What a layout has at least.
pub(crate) fn least(layout: &Layout, filling: &Filling<'_>) -> Least {
    let dimensions = layout.dimensions;
    let layers = &filling.points.layers;
    let (mut points, mut choice) = (lattice(layout), 0.0);
    for (k, solid) in layout.solids.iter().enumerate() {
        let [low, high] = solid.body.bounds();
        let widths = (0..dimensions).map(|a| high[a] - low[a]);
        let widest = widths.clone().fold(0.0, f64::max);
        if !widest.is_finite() {
            continue;
        }
        let coarse = (widest / PIECES).max(solid.spacing);
        let found = pieces(&solid.body, dimensions, coarse);
        let (mut whole, mut within, mut finest) = (0.0, 0.0, solid.spacing);
        for piece in &found {
            let (reach, area) = (coarse, piece.area);
            whole += area;
            finest = finest.min(layout.beside_near(piece.place, k, reach));
            if layout.depth(piece.place) > 0.0 {
                let spacing = layout.beside(piece.place, k) + layout.steepest() * reach;
                within += area / spacing.min(solid.spacing).powi(dimensions as i32 - 1);
            }
        }
        let columns = [layers.inside, layers.outside].map(|n| n.unwrap_or(1).min(1) as f64);
        points += within * (1.0 + columns[0] + columns[1]);
        let even = finest >= 0.999 * solid.spacing;
        let [per, step] = if even {
            [EVEN, [solid.spacing; 2]]
        } else {
            [UNEVEN, [finest.min(solid.spacing / NEAR); 2]]
        }
        .map(|pair| pair[dimensions - 2]);
        choice += PIECE * per * whole / step.powi(dimensions as i32 - 1);
        if filling.points.arrangement == Arrangement::Hexagonal {
            let cells = widths.map(|w| (w / solid.spacing).max(1.0));
            choice += POINT * cells.product::<f64>();
        }
    }
    let radius = filling.support;
    let ball = if dimensions == 3 {
        4.0 / 3.0 * PI * radius
    } else {
        PI
    };
    // Numbers of neighbours, and weights of the Laplacian and of the slopes.
    let stencil = ball * radius * radius * (4 + 8 * (dimensions + 1)) as f64;
    Least {
        points,
        bytes: choice.max(points * (POINT + stencil)),
    }
}

/// Points of the lattices and of the wall at least.
fn lattice(layout: &Layout) -> f64 {
    let dimensions = layout.dimensions;
    let (mut middle, mut half) = ([0.0; 3], [0.0; 3]);
    let mut wall = 0.0;
    match &layout.wall {
        Wall::Box { low, high, .. } => {
            for k in 0..dimensions {
                middle[k] = 0.5 * (low[k] + high[k]);
                half[k] = 0.5 * (high[k] - low[k]);
            }
        }
        Wall::Ball { centre, radius } => {
            middle = *centre;
            half[..dimensions].fill(*radius);
            if layout.axisymmetric() {
                (middle[0], half[0]) = (0.5 * radius, 0.5 * radius);
            }
            let turn = if layout.axisymmetric() { PI } else { 2.0 * PI };
            let area = if dimensions == 3 {
                4.0 * PI * radius * radius
            } else {
                turn * radius
            };
            wall = area / layout.largest.powi(dimensions as i32 - 1);
        }
    }
    let mut parts = BinaryHeap::from([part(layout, middle, half)]);
    for _ in 0..PARTS {
        let Some(whole) = parts.pop() else { break };
        if whole.points[1] <= 0.0 {
            parts.push(whole);
            break;
        }
        let widest = (0..dimensions).max_by(|a, b| whole.half[*a].total_cmp(&whole.half[*b]));
        let axis = widest.unwrap_or_default();
        let mut half = whole.half;
        half[axis] *= 0.5;
        for side in [-1.0, 1.0] {
            let mut middle = whole.middle;
            middle[axis] += side * half[axis];
            parts.push(part(layout, middle, half));
        }
    }
    wall + parts.iter().map(|part| part.points[0]).sum::<f64>()
}

fn part(layout: &Layout, middle: Vector, half: Vector) -> Part {
    let dimensions = layout.dimensions;
    let reach = length(half);
    let volume: f64 = half[..dimensions].iter().map(|h| 2.0 * h).product();
    let fits = |spacing: f64| volume / spacing.powi(dimensions as i32);
    let widest = (layout.wanted(middle, 0.0) + layout.steepest() * reach).min(layout.widest());
    let depth = layout.depth(middle);
    let points = match &layout.wall {
        Wall::Ball { .. } if depth < -reach => [0.0; 2],
        // Of what the wall cuts nothing is certain.
        Wall::Ball { .. } if depth < reach => [0.0, fits(layout.wanted(middle, reach))],
        _ => [fits(widest), fits(layout.wanted(middle, reach))],
    };
    Part {
        middle,
        half,
        points,
    }
}

#[cfg(test)]
mod tests {
    use crate::cloud::setup;
    use crate::scene::Scene;

    fn scene(text: &str) -> Scene {
        serde_json::from_str(text).unwrap()
    }

    /// Never more than there are, and not much less.
    #[test]
    fn what_is_counted_beforehand_is_there() {
        let ball = r#""bodies": [{"name": "ball", "potential_v": 1,
            "shape": {"SHAPE": {"centre_m": [CENTRE], "radius_m": 1}}}]"#;
        let of = |shape: &str, centre: &str| ball.replace("SHAPE", shape).replace("CENTRE", centre);
        for (geometry, domain, bodies, points) in [
            (
                "plane",
                r#"{"box": {"min_m": [-4, -4], "max_m": [4, 4]}}"#,
                of("disc", "0, 0"),
                "0.05",
            ),
            (
                "axisymmetric",
                r#"{"sphere": {"centre_m": [0, 0], "radius_m": 6}}"#,
                of("disc", "0, 0"),
                "0.05",
            ),
            (
                "space",
                r#"{"box": {"min_m": [-4, -4, -4], "max_m": [4, 4, 9]}}"#,
                of("sphere", "0, 0, 0"),
                "0.15",
            ),
            (
                "space",
                r#"{"sphere": {"centre_m": [0, 0, 0], "radius_m": 4}}"#,
                of("sphere", "0, 0, 1"),
                "0.1",
            ),
        ] {
            let scene = scene(&format!(
                r#"{{"geometry": "{geometry}", "domain": {domain}, {bodies}, "points": {{"spacing_m": {points}}},
                "electrostatics": {{"outer": [{{"potential_v": 0}}]}}}}"#
            ));
            let [least, _] = setup::least(&scene);
            let there = setup::cloud(&scene).unwrap().len() as f64;
            assert!(
                least < 1.1 * there && least > 0.25 * there,
                "{geometry} {domain}: {least} of {there}"
            );
        }
    }

    /// Domains of any size are refused at once where their points have no room.
    #[test]
    fn what_has_no_room_is_refused_before_it_is_made() {
        let began = std::time::Instant::now();
        for (high, at) in [
            ("1e3", "/points/spacing_m"),
            ("1e12", "/points/spacing_m"),
            ("1e300", "/points/spacing_m"),
        ] {
            let scene = scene(&format!(
                r#"{{"geometry": "space", "domain": {{"box": {{"min_m": [-5e-4, -5e-4, -5e-4], "max_m": [5e-4, {high}, 5e-4]}}}},
                "points": {{"spacing_m": 5e-6}}, "electrostatics": {{"outer": [{{"potential_v": 0}}]}}}}"#
            ));
            let faults = setup::cloud(&scene).unwrap_err();
            assert!(faults[0].to_string().starts_with(at), "{faults:?}");
        }
        for (radius, spacing) in [("1e-3", "1e-9"), ("1e6", "1e-5"), ("1e100", "1e-3")] {
            let scene = scene(&format!(
                r#"{{"geometry": "space", "domain": {{"sphere": {{"centre_m": [0, 0, 0], "radius_m": 2e100}}}},
                "bodies": [{{"name": "a", "potential_v": 1, "shape": {{"sphere": {{"centre_m": [0, 0, 0], "radius_m": {radius}}}}}}}],
                "points": {{"spacing_m": {spacing}, "inward": 1}}, "electrostatics": {{"outer": [{{"potential_v": 0}}]}}}}"#
            ));
            assert!(!setup::cloud(&scene).unwrap_err().is_empty());
        }
        assert!(began.elapsed().as_secs_f64() < 5.0);
    }
}
