//! Where water touches a solid, also by its image beyond a wall.
//!
//! Where a solid stands on a wall, the water beside it needs the image of the solid as it needs that of the water: without
//! it, it creeps between the two. The line from a point of the solid to the image of a particle meets the wall and goes on
//! from there to the particle itself. It leaves the solid before or behind that place. Behind it, water and solid push each
//! other and the wall bears nothing; before it, both push the wall. Nothing fits into a gap below half a spacing of the
//! water: there the solid is taken to touch the wall.

use super::faces::{Moving, Place, Reached};
use super::skin::Skin;
use crate::matter::water::images::Plane;

/// Where a particle of water, or its image, touches a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// The place.
    pub place: Place,
    /// Which of the mirrors of the image the line has met before it left the solid, by bits.
    met: u8,
}

impl Touch {
    /// A vector of the solid as the image sees it, or of the image as the solid does.
    #[inline(always)]
    #[must_use]
    pub fn seen(&self, mirror: &[Plane], vector: [f64; 3]) -> [f64; 3] {
        let met = mirror.iter().enumerate();
        let met = met.filter(|(k, _)| self.met >> k & 1 == 1);
        met.fold(vector, |seen, (_, plane)| plane.mirrored(seen))
    }

    /// Shares what is not borne by water and solid \[N\] among the walls that the line has not met.
    pub fn bear(&self, mirror: &[Plane], mut rest: [f64; 3], walls: &mut [[f64; 3]]) {
        let mut free = mirror.iter().enumerate();
        let mut next = free.find(|(k, _)| self.met >> k & 1 == 0);
        while let Some((_, plane)) = next {
            next = free.find(|(k, _)| self.met >> k & 1 == 0);
            let part = if next.is_some() {
                let n = plane.normal;
                let across = rest[0] * n[0] + rest[1] * n[1] + rest[2] * n[2];
                n.map(|n| across * n)
            } else {
                rest
            };
            for k in 0..3 {
                walls[plane.wall][k] += part[k];
                rest[k] -= part[k];
            }
        }
    }
}

impl Skin {
    /// Where the water at an offset `dx` \[m\] from point `p` touches the solid; it is the image by a mirror of a particle at `own`.
    #[must_use]
    pub fn touch(
        &self,
        moving: &Moving<'_>,
        p: u32,
        mut dx: [f64; 3],
        own: [f64; 3],
        mirror: &[Plane],
    ) -> Touch {
        let point = &self.points[p as usize];
        let cell = point.cell as usize;
        let middle = Touch {
            place: Place {
                cell,
                offset: [0.0; 3],
                depth: [0.0; 3],
            },
            met: 0,
        };
        let cells = self.cells.as_ref();
        let Some(mut walk) = cells.and_then(|c| c.walk(moving.broken, cell, point.offset)) else {
            return middle;
        };
        let back = |dx: [f64; 3]| [0, 1, 2].map(|k| (0..3).map(|i| point.back[i][k] * dx[i]).sum());
        let stretch = point.volume / self.part_volume();
        // Heights of the point and of the image over each plane, and the part of the line before it.
        let mut planes: Vec<(usize, f64, f64, f64)> = Vec::new();
        for (k, plane) in mirror.iter().enumerate() {
            let (over, under) = (plane.height(own, point.x).max(0.0), plane.distance.max(0.0));
            let part = if over > 0.0 {
                over / (over + under)
            } else {
                0.0
            };
            planes.push((k, over, under, part));
        }
        planes.sort_by(|a, b| a.3.total_cmp(&b.3));
        let (mut met, mut gone) = (0, 0.0);
        for (k, over, under, part) in planes {
            match walk.go(back(dx), (part - gone).max(0.0) / stretch) {
                Reached::End => gone = part,
                Reached::Face(place, more) => {
                    gone += more * stretch;
                    if over - gone * (over + under) > self.closed_gap() {
                        return Touch { place, met };
                    }
                }
                Reached::Nothing => return middle,
            }
            dx = mirror[k].mirrored(dx);
            met |= 1 << k;
        }
        match walk.go(back(dx), f64::INFINITY) {
            Reached::Face(place, _) => Touch { place, met },
            Reached::End | Reached::Nothing => middle,
        }
    }
}
