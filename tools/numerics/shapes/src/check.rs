//! What the schema of a shape cannot tell.

use crate::body::Body;
use crate::mesh;
use crate::shape::{BoxShape, EllipsoidShape, Shape, Stl};

/// Something that is wrong with a shape, and where in the scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Misfit {
    /// JSON pointer.
    pub path: String,
    /// What is wrong.
    pub what: String,
}

impl Misfit {
    /// What is wrong at a JSON pointer.
    #[must_use]
    pub fn at(path: &str, what: impl Into<String>) -> Self {
        Self {
            path: path.to_owned(),
            what: what.into(),
        }
    }
}

/// Whether there are as many coordinates as dimensions; says so where not.
pub fn coordinates(numbers: &[f64], at: &str, dimensions: usize, faults: &mut Vec<Misfit>) -> bool {
    if numbers.len() == dimensions {
        return true;
    }
    let what = format!(
        "{} numbers; a scene of {dimensions} dimensions wants {dimensions}",
        numbers.len()
    );
    faults.push(Misfit::at(at, what));
    false
}

/// Points begin at most so many of their distances from the origin: there coordinates are rounded by 2e-7 of that distance.
const FARTHEST: f64 = 1e9;

/// Whether points so far apart \[m\] can be told apart where they begin, between two coordinates \[m\]; says so where not.
pub fn reach(ends: [f64; 2], at: &str, spacing: f64, faults: &mut Vec<Misfit>) -> bool {
    let [low, high] = ends;
    let nearest = if low > 0.0 { low } else { high.min(0.0) };
    let most = FARTHEST * spacing;
    // What is not finite is told elsewhere.
    if !nearest.is_finite() || nearest.abs() <= most {
        return true;
    }
    let what = format!(
        "begins {nearest:.3e} m from the origin; points {spacing:.3e} m apart are told apart up to {most:.3e} m: move the scene to the origin"
    );
    faults.push(Misfit::at(at, what));
    false
}

/// [`check`] for a shape that holds points so far apart \[m\].
pub fn filled(shape: &Shape, at: &str, dimensions: usize, spacing: f64, faults: &mut Vec<Misfit>) {
    let before = faults.len();
    check(shape, at, dimensions, faults);
    if faults.len() > before {
        return;
    }
    let [low, high] = Body::new(shape, dimensions).bounds();
    for k in 0..dimensions {
        if !reach([low[k], high[k]], at, spacing, faults) {
            break;
        }
    }
}

/// Finds what the types of a scene cannot tell: numbers of coordinates, corners, shapes of the other kind of scene.
pub fn check(shape: &Shape, at: &str, dimensions: usize, faults: &mut Vec<Misfit>) {
    let only_in_space = |what: &str, faults: &mut Vec<Misfit>| {
        if dimensions == 2 {
            faults.push(Misfit::at(
                at,
                format!("a {what} has no place in a plane scene; a disc and an ellipsoid have"),
            ));
        }
    };
    match shape {
        Shape::Box(b) => corners(b, &format!("{at}/box"), dimensions, faults),
        Shape::Cylinder(_) => only_in_space("cylinder", faults),
        Shape::Sphere(_) => only_in_space("sphere", faults),
        Shape::Disc(d) => {
            coordinates(
                &d.centre_m,
                &format!("{at}/disc/centre_m"),
                dimensions,
                faults,
            );
        }
        Shape::Ellipsoid(e) => semi_axes(e, &format!("{at}/ellipsoid"), dimensions, faults),
        Shape::HalfSpace(h) => {
            let at = format!("{at}/half_space");
            coordinates(&h.point_m, &format!("{at}/point_m"), dimensions, faults);
            if coordinates(&h.normal, &format!("{at}/normal"), dimensions, faults)
                && h.normal.iter().all(|n| *n == 0.0)
            {
                faults.push(Misfit::at(
                    &format!("{at}/normal"),
                    "a normal has a direction: it is not zero",
                ));
            }
        }
        Shape::Stl(stl) => {
            only_in_space("surface of triangles", faults);
            closed(stl, &format!("{at}/stl"), faults);
        }
        Shape::Turned(t) => {
            let at = format!("{at}/turned");
            if dimensions == 2 && t.axis.index() != 2 {
                faults.push(Misfit::at(
                    &format!("{at}/axis"),
                    "a plane scene turns about z alone",
                ));
            }
            if let Some(about) = &t.about_m {
                coordinates(about, &format!("{at}/about_m"), dimensions, faults);
            }
            check(&t.shape, &format!("{at}/shape"), dimensions, faults);
        }
        Shape::Union(all) => parts(all, &format!("{at}/union"), dimensions, faults),
        Shape::Intersection(all) => parts(all, &format!("{at}/intersection"), dimensions, faults),
        Shape::Difference(all) => parts(all, &format!("{at}/difference"), dimensions, faults),
    }
}

fn closed(stl: &Stl, at: &str, faults: &mut Vec<Misfit>) {
    let what = match (&stl.vertices_m, &stl.triangles) {
        (Some(vertices), Some(triangles)) => mesh::open(vertices, triangles),
        _ => Some("has not been read".to_owned()),
    };
    let named = |what| Misfit::at(&format!("{at}/file"), format!("{} {what}", stl.file));
    faults.extend(what.map(named));
}

fn corners(b: &BoxShape, at: &str, dimensions: usize, faults: &mut Vec<Misfit>) {
    let both = coordinates(&b.min_m, &format!("{at}/min_m"), dimensions, faults)
        & coordinates(&b.max_m, &format!("{at}/max_m"), dimensions, faults);
    for k in (0..dimensions).filter(|_| both) {
        if b.max_m[k] <= b.min_m[k] {
            let what = format!("{} m is not above min_m, {} m", b.max_m[k], b.min_m[k]);
            faults.push(Misfit::at(&format!("{at}/max_m/{k}"), what));
        }
    }
}

/// Least and greatest ratio of the semi-axes: beyond, points of a sharp edge are lost in rounding.
const FLATTEST: f64 = 1e-4;

fn semi_axes(e: &EllipsoidShape, at: &str, dimensions: usize, faults: &mut Vec<Misfit>) {
    coordinates(&e.centre_m, &format!("{at}/centre_m"), dimensions, faults);
    let at = format!("{at}/semi_axes_m");
    if !coordinates(&e.semi_axes_m, &at, dimensions, faults) {
        return;
    }
    let longest = e.semi_axes_m.iter().copied().fold(0.0, f64::max);
    for (k, half) in e.semi_axes_m.iter().enumerate() {
        let what = if *half <= 0.0 {
            format!("{half} m is out of range: more than 0 m")
        } else if *half < FLATTEST * longest {
            format!(
                "{half} m is out of range: at least {FLATTEST} of the longest semi-axis, {longest} m"
            )
        } else {
            continue;
        };
        faults.push(Misfit::at(&format!("{at}/{k}"), what));
    }
}

fn parts(all: &[Shape], at: &str, dimensions: usize, faults: &mut Vec<Misfit>) {
    if all.is_empty() {
        faults.push(Misfit::at(at, "at least one shape is wanted"));
    }
    for (number, shape) in all.iter().enumerate() {
        check(shape, &format!("{at}/{number}"), dimensions, faults);
    }
}
