//! Points of a liquid whose surface is to stand elsewhere: where drops have met, or one has parted.
//!
//! Points of the old surface that lie on the new one stay, and so do those inside that are deep enough. Where the old surface
//! is left, new points are strewn on the new one, from what stays outward, and the gaps inside are filled. What new points carry is the value
//! of a linear fit over all old points: it lies between theirs, so that no velocity grows where two streams meet. What fields do on
//! the surface is that of the nearest old point, until they are found anew.

use std::collections::BTreeSet;

use neighbours::Tree;
use run::Failure;
use wls::Stencils;

use super::level::Rim;
use crate::liquid::effort::failed;
use crate::liquid::fill::Crowd;
use crate::liquid::matter::Way;
use crate::liquid::points::Liquid;
use crate::liquid::renew::holes::Holes;
use crate::liquid::renew::valued;
use crate::liquid::surface::Seat;
use crate::liquid::vector::{across, along, difference, dot, length};

/// Spacings off the new surface within which a point of the old one stays.
const STAYS: f64 = 0.05;
/// Spacings that points inside keep off the surface.
const DEPTH: f64 = 0.55;
/// Step of the lattice from which new points fall on the surface, and how far it reaches about what is left, in spacings.
const PITCH: f64 = 0.5;
const ABOUT: f64 = 1.5;
/// Spacings from the surface within which they fall.
const FALLS: f64 = 0.7;
/// Spacings that points strewn on the surface keep from each other.
const APART: f64 = 0.85;
/// Rounds in which they push each other apart.
const ROUNDS: usize = 15;
/// Rounds that fill gaps inside.
const FILLS: usize = 5;

/// The liquid below `rim`, of the points of `old`; none where nothing is left of it.
pub(super) fn reshaped<H: Fn(&[f64; 3]) -> f64>(
    old: &Liquid<3>,
    rim: &Rim<H>,
) -> Result<Option<Liquid<3>>, Failure> {
    let (surface, spacing) = (old.surface(), rim.spacing);
    let heights: Vec<f64> = old.position.iter().map(|x| (rim.height)(x)).collect();
    let (on, off): (Vec<usize>, Vec<usize>) =
        (0..surface).partition(|&i| heights[i].abs() < STAYS * spacing);
    let mut skin: Vec<Seat<3>> = on.iter().map(|&i| old.seat(i)).collect();
    let left: Vec<[f64; 3]> = off.iter().map(|&i| old.position[i]).collect();
    strew(&mut skin, &left, rim);
    let inside = surface..old.position.len();
    let within: Vec<usize> = inside.filter(|&i| heights[i] < -DEPTH * spacing).collect();
    let mut inner: Vec<[f64; 3]> = within.iter().map(|&i| old.position[i]).collect();
    let holes = Holes { spacing };
    for _ in 0..FILLS {
        let more = holes.inside(&skin, &inner);
        if more.is_empty() {
            break;
        }
        inner.extend(more);
    }
    if skin.is_empty() || inner.is_empty() {
        return Ok(None);
    }
    let from = From {
        rows: linear(old, &skin[on.len()..], &inner[within.len()..], spacing)?,
        skin: skin.len() - on.len(),
        inner: inner.len() - within.len(),
        on,
        within,
    };
    let pressure = old.pressure.as_chunks::<1>().0;
    let beside = Beside::new(old, &skin);
    Ok(Some(Liquid {
        pull: [beside.carried(&old.pull[0]), Vec::new()],
        drag: beside.carried(&old.drag),
        charge: beside.carried(&old.charge),
        velocity: from.carried(&old.velocity),
        rate: from.carried(&old.rate),
        pressure: from.carried(pressure).into_flattened(),
        stress: vec![0.0; skin.len()],
        normal: skin.iter().map(|s| s.normal).collect(),
        position: skin.iter().map(|s| s.place).chain(inner).collect(),
        borne: None,
        ..old.clone()
    }))
}

/// The point of the old surface that is nearest to each of the new one.
struct Beside(Vec<usize>);

impl Beside {
    fn new(old: &Liquid<3>, skin: &[Seat<3>]) -> Self {
        let tree = Tree::new(&old.position[..old.surface()]);
        let nearest = skin.iter().filter_map(|s| tree.nearest(s.place));
        Self(nearest.collect())
    }

    /// What fields do there; nothing where there is none.
    fn carried<T: Copy>(&self, field: &[T]) -> Vec<T> {
        let each = self.0.iter();
        each.filter_map(|&i| field.get(i).copied()).collect()
    }
}

/// Linear fits over old points at new places.
fn linear(
    old: &Liquid<3>,
    skin: &[Seat<3>],
    inner: &[[f64; 3]],
    spacing: f64,
) -> Result<Stencils<3>, Failure> {
    let skin = skin.iter().map(|s| s.place);
    let places: Vec<[f64; 3]> = skin.chain(inner.iter().copied()).collect();
    let way = Way {
        spacing,
        order: 1,
        tolerance: 0.0,
        products: 0,
    };
    valued(&old.position, &places, &way).map_err(|e| failed(&e))
}

/// Where what points carry is from.
struct From {
    /// Old points that stay on the surface, and inside.
    on: Vec<usize>,
    within: Vec<usize>,
    /// Fits at new places, and how many of these are on the surface, which come first, and inside.
    rows: Stencils<3>,
    skin: usize,
    inner: usize,
}

impl From {
    fn carried<const C: usize>(&self, field: &[[f64; C]]) -> Vec<[f64; C]> {
        let value = |k: usize| {
            let row = self.rows.value(k).iter();
            row.fold([0.0; C], |sum, (j, w)| along(&sum, w, &field[j]))
        };
        let on = self.on.iter().map(|&i| field[i]);
        let within = self.within.iter().map(|&i| field[i]);
        let skin = on.chain((0..self.skin).map(value));
        let inner = within.chain((self.skin..self.skin + self.inner).map(value));
        skin.chain(inner).collect()
    }
}

/// Strews points on the new surface about what is `left` of the old one.
fn strew<H: Fn(&[f64; 3]) -> f64>(skin: &mut Vec<Seat<3>>, left: &[[f64; 3]], rim: &Rim<H>) {
    let (spacing, first) = (rim.spacing, skin.len());
    let mut falling: Vec<([f64; 3], f64)> = lattice(left, spacing)
        .filter(|x| (rim.height)(x).abs() < FALLS * spacing)
        .filter_map(|x| rim.nearest(x))
        .map(|x| (x, gap(skin, &x)))
        .collect();
    falling.sort_by(|a, b| a.1.total_cmp(&b.1));
    for (place, near) in falling {
        let normal = rim.normal(&place);
        if near > APART * spacing && gap(&skin[first..], &place) > APART * spacing {
            skin.push(Seat { place, normal });
        }
    }
    for _ in 0..ROUNDS {
        let places: Vec<[f64; 3]> = skin.iter().map(|s| s.place).collect();
        let crowd = Crowd::new(&places, spacing);
        for seat in &mut skin[first..] {
            let push = across(&crowd.push(&seat.place), &seat.normal);
            if let Some(place) = rim.nearest(along(&seat.place, 1.0, &push)) {
                let normal = rim.normal(&place);
                *seat = Seat { place, normal };
            }
        }
    }
}

/// How far the nearest seat is from a place \[m\].
fn gap(skin: &[Seat<3>], place: &[f64; 3]) -> f64 {
    let squares = skin.iter().map(|s| {
        let d = difference(place, &s.place);
        dot(&d, &d)
    });
    squares.fold(f64::INFINITY, f64::min).sqrt()
}

/// Points of a lattice about places.
fn lattice(places: &[[f64; 3]], spacing: f64) -> impl Iterator<Item = [f64; 3]> {
    let (pitch, reach) = (PITCH * spacing, (ABOUT / PITCH) as i64);
    let mut cells = BTreeSet::new();
    for x in places {
        let at = x.map(|c| (c / pitch).round() as i64);
        for step in 0..(2 * reach + 1).pow(3) {
            let side = 2 * reach + 1;
            let offset = [step % side, step / side % side, step / side / side];
            let cell: [i64; 3] = std::array::from_fn(|k| at[k] + offset[k] - reach);
            let node = cell.map(|c| c as f64 * pitch);
            if length(&difference(&node, x)) <= ABOUT * spacing {
                cells.insert(cell);
            }
        }
    }
    cells.into_iter().map(move |c| c.map(|c| c as f64 * pitch))
}
