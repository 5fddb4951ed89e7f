//! Parts of a drop, one for each of its points: what is nearer to it than to any other, beneath the surface.
//!
//! A part ends halfway to its neighbours, so that what flows from one to the next through their common face is `k A/d (T_j - T_i)`,
//! along the way between them. What leaves one arrives in the other, so that the sum over all parts is kept.

use neighbours::Tree;
use rayon::prelude::*;

use super::polyhedron::Polyhedron;
use super::surface::Patch;
use super::vector::{along, difference, dot, length};

/// Half the edge of the cube that a part is cut from, and the reach of its neighbours, in spacings.
const CUBE: f64 = 1.5;
const REACH: f64 = 3.0;
/// A plane that touches the surface passes outside of it; over a disc of area A it is on the average `kappa A/(8 pi)` above it.
const BOW: f64 = 25.132_741_228_718_345;
/// Least volume of a part, over a cubed spacing: where points coincide or stand out of the surface, one has none.
const LEAST: f64 = 1e-3;
/// Areas of faces below this part of a squared spacing are rounding.
const FACE: f64 = 1e-9;

/// A face that a part shares with that of another point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    /// The other point.
    pub other: u32,
    /// Area over the distance of both points \[m\].
    pub reach: f64,
}

/// Parts of all points of a drop.
#[derive(Debug, Clone, PartialEq)]
pub struct Parts {
    /// Volumes \[m3\].
    pub volume: Vec<f64>,
    /// Areas on the surface, whose points come first \[m2\].
    pub area: Vec<f64>,
    /// Faces by point, in the order of the other points.
    pub faces: Vec<Vec<Face>>,
}

/// A part before it is matched with others.
struct Cut {
    volume: f64,
    faces: Vec<Face>,
}

impl Parts {
    /// Parts of points at about `spacing` \[m\], of the surface first. Together they have the given volume and area.
    #[must_use]
    pub fn new(
        points: &[[f64; 3]],
        patches: &[Patch<3>],
        spacing: f64,
        [volume, area]: [f64; 2],
    ) -> Self {
        let tree = Tree::new(points);
        let skin = Tree::new(&points[..patches.len()]);
        let cuts: Vec<Cut> = (0..points.len())
            .into_par_iter()
            .map(|i| {
                let above = if i < patches.len() {
                    Some(i)
                } else {
                    skin.nearest(points[i])
                };
                let top = above.map(|j| (&points[j], &patches[j]));
                cut(i, points, top, &tree, spacing)
            })
            .collect();
        let whole: f64 = cuts.iter().map(|c| c.volume).sum();
        let skin: f64 = patches.iter().map(|p| p.area).sum();
        Self {
            volume: cuts.iter().map(|c| c.volume * volume / whole).collect(),
            area: patches.iter().map(|p| p.area * area / skin).collect(),
            faces: (0..cuts.len()).map(|i| shared(i, &cuts)).collect(),
        }
    }
}

/// The part of a point beneath the surface near `top`.
fn cut(
    i: usize,
    points: &[[f64; 3]],
    top: Option<(&[f64; 3], &Patch<3>)>,
    tree: &Tree,
    spacing: f64,
) -> Cut {
    let place = &points[i];
    let mut near: Vec<(f64, u32)> = Vec::new();
    tree.within(*place, REACH * spacing, |j, square| {
        if j != i && square > 0.0 {
            near.push((square, j as u32));
        }
    });
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut part = Polyhedron::cube(CUBE * spacing);
    if let Some((on, patch)) = top {
        let sunk = -patch.curvature * patch.area / BOW;
        let seat = along(&difference(on, place), sunk, &patch.normal);
        part.cut(None, &patch.normal, dot(&patch.normal, &seat));
    }
    for (square, j) in near {
        if 0.25 * square > part.farthest() {
            break;
        }
        let way = difference(&points[j as usize], place);
        part.cut(Some(j), &way, 0.5 * square);
    }
    let least = FACE * spacing * spacing;
    let face = |other: u32, area: f64| Face {
        other,
        reach: area / length(&difference(&points[other as usize], place)),
    };
    let found = part.faces().filter_map(|f| Some((f.beyond?, f.area())));
    let mut faces: Vec<Face> = found
        .filter(|(_, area)| *area > least)
        .map(|(other, area)| face(other, area))
        .collect();
    faces.sort_by_key(|f| f.other);
    Cut {
        volume: part.volume().max(LEAST * spacing.powi(3)),
        faces,
    }
}

/// Faces that both parts have, as large as the mean of what each finds: planes of the surface cut one of them alone.
fn shared(i: usize, cuts: &[Cut]) -> Vec<Face> {
    let own = cuts[i].faces.iter();
    let both = own.filter_map(|face| {
        let theirs = &cuts[face.other as usize].faces;
        let back = theirs.binary_search_by_key(&(i as u32), |f| f.other).ok()?;
        Some(Face {
            reach: 0.5 * (face.reach + theirs[back].reach),
            ..*face
        })
    });
    both.collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use shapes::Body;
    use shapes::shape::{Shape, Sphere};

    use super::*;
    use crate::liquid::fill::fill;
    use crate::liquid::surface::patches;

    const SPACING: f64 = 0.2;

    fn ball() -> (Vec<[f64; 3]>, Vec<Patch<3>>, Parts) {
        let shape = Shape::Sphere(Sphere {
            name: None,
            centre_m: vec![0.0; 3],
            radius_m: 1.0,
        });
        let filled = fill::<3>(&Body::new(&shape, 3), SPACING);
        let surface = &filled.position[..filled.normal.len()];
        let patches = patches(surface, &filled.normal, SPACING).unwrap();
        let size = [4.0 / 3.0 * PI, 4.0 * PI];
        let parts = Parts::new(&filled.position, &patches, SPACING, size);
        (filled.position, patches, parts)
    }

    /// What parts take from each other at some temperatures.
    fn flows(parts: &Parts, t: &[f64]) -> Vec<f64> {
        let each = parts.faces.iter().zip(t);
        let each = each.map(|(faces, own)| {
            let flows = faces.iter().map(|f| f.reach * (t[f.other as usize] - own));
            flows.sum()
        });
        each.collect()
    }

    #[test]
    fn what_one_part_gives_another_takes() {
        let (points, patches, parts) = ball();
        let t: Vec<f64> = points.iter().map(|x| (7.0 * x[0]).sin() + x[2]).collect();
        let flows = flows(&parts, &t);
        let whole: f64 = flows.iter().map(|q| q.abs()).sum();
        assert!(flows.iter().sum::<f64>().abs() < 1e-12 * whole);
        assert!((parts.volume.iter().sum::<f64>() - 4.0 / 3.0 * PI).abs() < 1e-12);
        assert!((parts.area.iter().sum::<f64>() - 4.0 * PI).abs() < 1e-12);
        assert_eq!(parts.area.len(), patches.len());
        // Points inside stand for about a cube each, those on the surface for less.
        let cube = SPACING * SPACING * SPACING;
        for (i, v) in parts.volume.iter().enumerate() {
            let least = if i < patches.len() { 0.2 } else { 0.6 };
            assert!((least..1.6).contains(&(v / cube)), "{i}: {}", v / cube);
        }
    }

    #[test]
    fn nothing_stays_where_a_temperature_rises_evenly() {
        let (points, patches, parts) = ball();
        let t: Vec<f64> = points.iter().map(|x| x[0]).collect();
        let flows = flows(&parts, &t);
        for (i, flow) in flows.iter().enumerate() {
            let x = &points[i];
            if length(x) < 1.0 - 1.2 * SPACING {
                assert!(flow.abs() < 1e-9 * SPACING * SPACING, "{i}: {flow:e}");
            }
        }
        // What passes the surface is what its parts take: as much as enters on one side leaves on the other.
        let leaves = (0..patches.len()).map(|i| parts.area[i] * patches[i].normal[0].abs());
        let taken = flows.iter().map(|q| q.abs()).sum::<f64>();
        assert!((leaves.sum::<f64>() / taken - 1.0).abs() < 0.05);
    }
}
