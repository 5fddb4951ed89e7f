//! Points of air about a liquid: layers that follow its surface, and a lattice beyond them that stays.
//!
//! Layers stand above each surface point along its normal, one spacing apart (2.70, Matsuzawa 2017, with beta = 1). A node of
//! the lattice sleeps while the liquid or a layer is where it is. Numbers of points stay the same until the lattice is made
//! anew, so that solutions go on and factors serve again.

use neighbours::Tree;

use super::vector::{along, difference, dot, length};
use crate::cloud::lattice::{Node, graded};
use crate::cloud::layout::Layout;
use crate::cloud::occupied::Occupied;
use crate::cloud::seeds;
use crate::stencils::region::{Face, Kind, Region as Points};
use crate::surface::enclosing::Enclosing;
use shapes::shape::{Shape, Sphere};
use shapes::{Body, rule::rule};
use wls::Metric;

/// Layers.
const LAYERS: usize = 2;
/// Media: the air, the liquid, points that sleep, and behind them other drops of the liquid.
const AIR: u16 = 0;
const LIQUID: u16 = 1;
pub(super) const ASLEEP: u16 = 2;
/// Multipoles are counted on a ball so far from the middle, over the wall's distance.
const COUNTED: f64 = 0.6;
/// Distance of places there over the radius of the ball.
const PLACES: f64 = 0.28;
/// Points nearer to others than this part of a spacing sleep.
const CLOSE: f64 = 0.65;
/// Layers sleep where another part of the surface is nearer than this part of their height.
const LEAN: f64 = 0.75;
/// The wall is so many times as far from the middle as the farthest point of the surface.
const WALL: f64 = 3.0;
/// Fastest rise of spacings outward.
const STEEPEST: f64 = 0.25;
/// Beyond the layers the lattice is as fine as the surface for so many spacings, so that the surface may move.
const MARGIN: f64 = 1.0;
/// A surface that has moved so many spacings wants a new lattice.
const MOVED: f64 = 1.0;
/// Rows farther from the surface than so many spacings of it, and of their own, stay.
const NEAR: f64 = LAYERS as f64 + CLOSE + 2.0 * MOVED;
const REACH: f64 = 3.6;

/// The surface of a liquid: places, unit normals out of it, and how far its points are apart \[m\].
#[derive(Debug, Clone, Copy)]
pub struct Skin<'a> {
    /// Places \[m\].
    pub place: &'a [[f64; 3]],
    /// Normals.
    pub normal: &'a [[f64; 3]],
    /// Distance of points \[m\].
    pub spacing: f64,
}

/// Where a liquid is: its surface and the points inside.
#[derive(Debug, Clone, Copy)]
pub struct Place<'a> {
    /// The surface.
    pub skin: Skin<'a>,
    /// Points inside \[m\].
    pub inside: &'a [[f64; 3]],
    /// Numbers of the drops of all points, those of the surface first; nothing where all are of one.
    pub of: &'a [u32],
}

impl<'a> Place<'a> {
    /// Where a liquid of such points is, those of the surface first, with their normals.
    #[must_use]
    pub fn of(position: &'a [[f64; 3]], normal: &'a [[f64; 3]], spacing: f64) -> Self {
        let (place, inside) = position.split_at(normal.len());
        let skin = Skin {
            place,
            normal,
            spacing,
        };
        Self {
            skin,
            inside,
            of: &[],
        }
    }

    /// The medium of a point: drops have media of their own, so that no fit reaches from one into another.
    fn medium(&self, i: usize) -> u16 {
        match self.of.get(i) {
            None | Some(0) => LIQUID,
            Some(drop) => u16::try_from(*drop).map_or(u16::MAX, |k| ASLEEP.saturating_add(k)),
        }
    }
}

/// A surface that is ready to be asked what is near.
pub(super) struct Near<'a> {
    skin: Skin<'a>,
    tree: Tree,
}

impl<'a> Near<'a> {
    pub(super) fn new(skin: Skin<'a>) -> Self {
        Self {
            skin,
            tree: Tree::new(skin.place),
        }
    }

    /// The nearest surface point: its number, and the distance \[m\], negative within the liquid.
    pub(super) fn distance(&self, x: &[f64; 3]) -> (usize, f64) {
        let own = self.tree.nearest(*x).unwrap_or(0);
        let away = difference(x, &self.skin.place[own]);
        let side = dot(&away, &self.skin.normal[own]);
        (own, length(&away) * if side < 0.0 { -1.0 } else { 1.0 })
    }
}

/// The air about a liquid, as it was made for one of its surfaces.
#[derive(Debug, Clone)]
pub(super) struct Air {
    /// That surface.
    made_for: Vec<[f64; 3]>,
    /// Middle of the wall \[m\].
    pub(super) centre: [f64; 3],
    /// Its radius \[m\].
    pub(super) radius: f64,
    /// Points on the wall with their spacing.
    pub(super) wall: Vec<Node>,
    /// Nodes of the lattice.
    pub(super) lattice: Vec<Node>,
    /// Nodes whose rows stay.
    stays: Vec<bool>,
}

/// Which points of air stand as they are, and where layers are.
pub(super) struct Standing {
    /// Places of layers, layer by layer.
    pub(super) layers: Vec<[f64; 3]>,
    /// By layer point and node: awake.
    pub(super) layers_awake: Vec<bool>,
    pub(super) lattice_awake: Vec<bool>,
}

impl Air {
    /// Makes the air about a surface.
    pub(super) fn new(skin: Skin<'_>) -> Self {
        let near = Near::new(skin);
        let count = skin.place.len() as f64;
        let mut centre = [0.0; 3];
        for x in skin.place {
            centre = along(&centre, count.recip(), x);
        }
        let reach = skin.place.iter().map(|x| length(&difference(x, &centre)));
        let farthest = reach.fold(0.0, f64::max);
        let spacing = skin.spacing;
        // The radius of a ball of as large a surface.
        let ball = spacing * (count / (4.0 * std::f64::consts::PI)).sqrt();
        let growth = (spacing / ball).min(STEEPEST);
        let radius = WALL * farthest;
        let fine = (LAYERS as f64 + MARGIN) * spacing;
        let wanted = |x: [f64; 3], nearer: f64| {
            let (_, away) = near.distance(&x);
            spacing + growth * (away - nearer - fine).max(0.0)
        };
        let largest = spacing + growth * (radius - fine);
        let region = Layout::ball(centre, radius, [spacing, largest]);
        let lattice = graded(&region, &wanted);
        let edge = (0..6)
            .map(|k| {
                let mut x = centre;
                x[k / 2] += if k % 2 == 0 { -radius } else { radius };
                wanted(x, 0.0)
            })
            .fold(largest, f64::min);
        let body = Body::new(
            &Shape::Sphere(Sphere {
                name: None,
                centre_m: centre.to_vec(),
                radius_m: radius,
            }),
            3,
        );
        let wall = seeds(&body, 3, edge, edge, &|_| edge)
            .into_iter()
            .map(|seed| Node {
                place: seed.place,
                spacing: edge,
                face: Some(0),
            })
            .collect();
        let lattice: Vec<Node> = lattice
            .into_iter()
            .filter(|n| near.distance(&n.place).1 > -MOVED * spacing)
            .collect();
        let stays = lattice
            .iter()
            .map(|n| near.distance(&n.place).1 > NEAR * spacing + REACH * n.spacing)
            .collect();
        Self {
            made_for: skin.place.to_vec(),
            centre,
            radius,
            wall,
            lattice,
            stays,
        }
    }

    /// Whether the row of a point stays, of so many points of which the nodes of the lattice are the last.
    pub(super) fn stays(&self, i: usize, points: usize) -> bool {
        let first = points - self.lattice.len();
        i >= first && self.stays[i - first]
    }

    /// Whether a surface has moved too far for this air.
    pub(super) fn outrun(&self, skin: Skin<'_>) -> bool {
        let tree = Tree::new(&self.made_for);
        let limit = MOVED * skin.spacing;
        let mut lone = false;
        for x in skin.place {
            let mut found = false;
            // Between two points of the old surface the way to the nearer is half a spacing.
            tree.within(*x, limit, |_, _| found = true);
            lone |= !found;
        }
        lone
    }

    /// A ball over which moments are counted.
    pub(super) fn ball(&self) -> Enclosing {
        let (centre, radius) = (self.centre, COUNTED * self.radius);
        let shape = Shape::Sphere(Sphere {
            name: None,
            centre_m: centre.to_vec(),
            radius_m: radius,
        });
        let pieces = rule(&Body::new(&shape, 3), 3, PLACES * radius);
        Enclosing {
            name: "a ball about the liquid".to_owned(),
            places: pieces.iter().map(|p| p.place).collect(),
            normals: pieces.iter().map(|p| p.normal).collect(),
            areas: pieces.iter().map(|p| p.area).collect(),
            medium: AIR,
            within: Vec::new(),
        }
    }

    /// What stands where the surface is now.
    pub(super) fn standing(&self, skin: Skin<'_>) -> Standing {
        let near = Near::new(skin);
        let spacing = skin.spacing;
        let mut occupied = Occupied::new(spacing);
        for x in skin.place {
            occupied.push(*x);
        }
        let mut layers = Vec::with_capacity(LAYERS * skin.place.len());
        let mut layers_awake = Vec::with_capacity(layers.capacity());
        for k in 1..=LAYERS {
            let height = k as f64 * spacing;
            for (x, n) in skin.place.iter().zip(skin.normal) {
                let place = along(x, height, n);
                let awake = near.distance(&place).1 > LEAN * height
                    && !occupied.any(place, CLOSE * spacing, |_, _, _| true);
                if awake {
                    occupied.push(place);
                }
                layers.push(place);
                layers_awake.push(awake);
            }
        }
        let free = |(node, stays): (&Node, &bool)| {
            *stays
                || near.distance(&node.place).1 > CLOSE * spacing
                    && !occupied.any(node.place, CLOSE * node.spacing, |_, _, _| true)
        };
        Standing {
            layers,
            layers_awake,
            lattice_awake: self.lattice.iter().zip(&self.stays).map(free).collect(),
        }
    }
}

impl Standing {
    /// All points in this order: surface, inside, layers, wall, lattice. A conductor has none inside, and its surface is a wall.
    pub(super) fn region(&self, place: Place<'_>, air: &Air, conducts: bool) -> Points<3> {
        let skin = place.skin;
        let mut region = Points::default();
        let mut push = |x: [f64; 3], spacing: f64, kind: Kind| {
            region.places.push(x);
            region.metrics.push(Metric::round(spacing));
            region.kinds.push(kind);
        };
        for (i, x) in skin.place.iter().enumerate() {
            let wall = Kind::Wall {
                medium: AIR,
                wall: 1,
            };
            let kind = if conducts {
                wall
            } else {
                Kind::Interface(i as u32)
            };
            push(*x, skin.spacing, kind);
        }
        if !conducts {
            for (x, i) in place.inside.iter().zip(skin.place.len()..) {
                push(*x, skin.spacing, Kind::Inside(place.medium(i)));
            }
        }
        let inside = |awake: bool| Kind::Inside(if awake { AIR } else { ASLEEP });
        for (x, awake) in self.layers.iter().zip(&self.layers_awake) {
            push(*x, skin.spacing, inside(*awake));
        }
        for node in &air.wall {
            let wall = Kind::Wall {
                medium: AIR,
                wall: 0,
            };
            push(node.place, node.spacing, wall);
        }
        for (node, awake) in air.lattice.iter().zip(&self.lattice_awake) {
            push(node.place, node.spacing, inside(*awake));
        }
        region.wall_normals = vec![[0.0; 3]; region.places.len()];
        region.wall_normals[..skin.normal.len()].copy_from_slice(skin.normal);
        if !conducts {
            let face = |(i, n): (usize, &[f64; 3])| Face {
                point: i as u32,
                inner: place.medium(i),
                outer: AIR,
                normal: *n,
                area: skin.spacing * skin.spacing,
            };
            region.faces = skin.normal.iter().enumerate().map(face).collect();
        }
        region
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn each_of_hundreds_of_drops_is_a_medium_of_its_own() {
        let of: Vec<u32> = (0..1000).collect();
        let place = Place {
            of: &of,
            ..Place::of(&[], &[], 1.0)
        };
        let media: BTreeSet<u16> = (0..of.len()).map(|i| place.medium(i)).collect();
        assert_eq!(media.len(), of.len());
        assert!(!media.contains(&AIR));
    }
}
