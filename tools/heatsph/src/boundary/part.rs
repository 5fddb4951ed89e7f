//! Parts of patches: where a shape ends within a patch, each of its sides has its own conditions.
//!
//! A patch that the surface of a shape may cross is sampled, and becomes one patch for each set of conditions that samples have, with
//! their part of its area and their middle.

use super::tangent::tangent;
use crate::cloud::Patch;
use shapes::Body;
use shapes::frame::{Vector, along};

/// Samples along an edge of a patch, and samples along an edge of a small shape, up to a number along the patch.
const SAMPLES: f64 = 8.0;
const SMALL: f64 = 32.0;
const MOST: f64 = 256.0;

/// Where a condition holds: on faces, and there within a shape.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Extent {
    pub(super) faces: Vec<u32>,
    pub(super) within: Option<Body>,
}

impl Extent {
    /// Whether it holds at a place of a face.
    pub(super) fn holds(&self, face: u32, x: Vector) -> bool {
        let inside = |region: &Body| region.holds(x);
        self.faces.contains(&face) && self.within.as_ref().is_none_or(inside)
    }

    /// The shape whose surface may lie within `reach` of the middle of a patch.
    fn near(&self, patch: &Patch, reach: f64) -> Option<&Body> {
        let region = self.within.as_ref()?;
        let near = self.faces.contains(&patch.face) && region.distance(patch.place).abs() < reach;
        near.then_some(region)
    }
}

/// A patch, or a part of one, and the numbers of the conditions that hold there.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    pub(super) patch: Patch,
    pub(super) entries: Vec<u32>,
}

/// What holds at a place of a face.
fn entries(all: &[Extent], face: u32, x: Vector) -> Vec<u32> {
    let holds = |e: &u32| all[*e as usize].holds(face, x);
    (0..all.len() as u32).filter(holds).collect()
}

/// A patch as it is, with the conditions at its middle.
pub(super) fn whole(patch: &Patch, all: &[Extent]) -> Part {
    Part {
        patch: *patch,
        entries: entries(all, patch.face, patch.place),
    }
}

/// The parts of a patch.
pub(super) fn parts(patch: &Patch, all: &[Extent], dimensions: usize) -> Vec<Part> {
    let rank = dimensions - 1;
    let edge = patch.area.powf(1.0 / rank as f64);
    let reach = 0.5 * edge * (rank as f64).sqrt();
    let near: Vec<&Body> = all.iter().filter_map(|e| e.near(patch, reach)).collect();
    if near.is_empty() {
        return vec![whole(patch, all)];
    }
    let size = near.iter().map(|region| least(region, dimensions));
    let size = size.fold(f64::INFINITY, f64::min);
    let count = (SMALL * edge / size).clamp(SAMPLES, MOST).ceil() as usize;
    let half = tangent(patch, dimensions).half;
    let offset = |k: usize| (2.0 * k as f64 + 1.0) / count as f64 - 1.0;
    let mut found: Vec<(Part, f64)> = Vec::new();
    for j in 0..if rank == 2 { count } else { 1 } {
        let row = match rank {
            2 => along(patch.place, offset(j), half[1]),
            _ => patch.place,
        };
        for i in 0..count {
            let x = along(row, offset(i), half[0]);
            let own = entries(all, patch.face, x);
            match found.iter_mut().find(|(part, _)| part.entries == own) {
                Some((part, samples)) => {
                    *samples += 1.0;
                    part.patch.place = along(part.patch.place, 1.0, x);
                }
                None => {
                    let patch = Patch { place: x, ..*patch };
                    found.push((
                        Part {
                            patch,
                            entries: own,
                        },
                        1.0,
                    ));
                }
            }
        }
    }
    if let [(part, _)] = found.as_mut_slice() {
        part.patch = *patch;
        return found.into_iter().map(|(part, _)| part).collect();
    }
    let total: f64 = found.iter().map(|(_, samples)| samples).sum();
    for (part, samples) in &mut found {
        part.patch.area *= *samples / total;
        part.patch.place = part.patch.place.map(|x| x / *samples);
    }
    found.into_iter().map(|(part, _)| part).collect()
}

/// Least extent of a shape \[m\].
fn least(region: &Body, dimensions: usize) -> f64 {
    let [low, high] = region.bounds();
    (0..dimensions)
        .map(|k| high[k] - low[k])
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn patch() -> Patch {
        Patch {
            point: 0,
            face: 5,
            area: 4.0,
            normal: [0.0, 0.0, 1.0],
            place: [1.0, 1.0, 0.0],
        }
    }

    fn extent(shape: &str) -> Extent {
        Extent {
            faces: vec![5],
            within: Some(Body::new(&serde_json::from_str(shape).unwrap(), 3)),
        }
    }

    #[test]
    fn a_spot_within_a_patch_has_its_own_area() {
        let everywhere = Extent {
            faces: vec![5],
            within: None,
        };
        for radius in [0.9, 0.4, 0.1] {
            let spot = extent(&format!(
                r#"{{"sphere": {{"centre_m": [0.95, 1.05, 0], "radius_m": {radius}}}}}"#
            ));
            let found = parts(&patch(), &[everywhere.clone(), spot], 3);
            assert_eq!(found.len(), 2);
            let own = found.iter().find(|part| part.entries == [0, 1]).unwrap();
            let exact = PI * radius * radius;
            assert!(
                (own.patch.area / exact - 1.0).abs() < 0.03,
                "{radius}: {own:?}"
            );
            assert!(
                (own.patch.place[0] - 0.95).abs() < 0.02
                    && (own.patch.place[1] - 1.05).abs() < 0.02
            );
            let rest: f64 = found.iter().map(|part| part.patch.area).sum();
            assert!((rest - 4.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_patch_that_no_shape_crosses_stays_as_it_is() {
        for (least, most) in [(0.0, 2.0), (-9.0, 2.0), (2.0, 9.0)] {
            let shape =
                format!(r#"{{"box": {{"min_m": [{least}, -9, -9], "max_m": [{most}, 9, 9]}}}}"#);
            let found = parts(&patch(), &[extent(&shape)], 3);
            assert_eq!(found.len(), 1);
            assert_eq!(found[0].patch, patch());
            assert_eq!(found[0].entries.is_empty(), least > 1.0);
        }
    }
}
