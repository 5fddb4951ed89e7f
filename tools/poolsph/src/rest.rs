//! Resting particles and their neighbours: rows that change only where something melts or sets.
//!
//! A particle rests while it is solid or held, or liquid before the flow starts. Its distances to other
//! resting particles never change, so rows and kernel values are kept and only the rows around a
//! particle that changes its part are touched. Rows are ascending in index: they follow from the
//! membership and the start alone, and a resumed run repeats them.
//!
//! Beside flat faces a row is completed by mirror images. The pair (a, b) then has the weight
//! `sum of W(|x_a - image of x_b|)` over b and its images in the named planes, which is symmetric
//! in a and b: conduction along a flat face is as in the inside, and across it nothing flows.
//! Only particles that have never moved take part; a mirror would be wrong for a bead. What has moved is completed by its images beyond the faces
//! of the flow, which nothing crosses. Beside free faces that no scene names
//! weights are raised for what flows along them (`rest/cut`). Where the spacings of the lattice differ along the axes, weights make it conduct
//! alike along all of them (`rest/stretched`).

mod cut;
mod standing;
mod stretched;

use std::collections::{BTreeMap, BTreeSet};

use kernels::CubicSpline;
use particles::{Matter, POSITION};
use shapes::frame::{difference, distance, squared};

use self::cut::Cuts;
use self::standing::Standing;
use self::stretched::Stretched;
use crate::faces::{Faces, Images};
use crate::state::{DROPLET, FUSED, LIQUID, PHASE, State, marked, phase};

/// A plane across an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// 0 = x, 1 = y, 2 = z.
    pub axis: usize,
    /// Where it cuts the axis \[m\].
    pub at: f64,
    /// Which side is outside: +1 or -1.
    pub outward: f64,
}

/// One neighbour of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// Index of the neighbour.
    pub to: u32,
    /// W of the pair with its images \[1/m3\].
    pub weight: f64,
}

/// Part that a particle plays here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    /// Moves or flies.
    Away,
    /// Rests where it was made.
    Pristine,
    /// Rests again after moving.
    Settled,
}

/// Rows of the resting particles.
#[derive(Debug, Clone, Default)]
pub struct Rest {
    kernel: Option<CubicSpline<3>>,
    /// Of the lattice \[m\].
    spacing: f64,
    mirrors: Vec<Plane>,
    /// The lattice of what has never moved, where it is not even.
    lattice: Option<Stretched>,
    /// All named faces.
    faces: Vec<Plane>,
    part: Vec<Part>,
    /// Those that rested at the start beside faces without a name; none before the start.
    cuts: Option<Cuts>,
    cells: BTreeMap<[i32; 3], Vec<u32>>,
    /// Those of what has moved, beyond the faces of the flow, and their places.
    images: Images,
    beyond: Vec<[f64; 3]>,
    rows: Vec<Vec<Link>>,
    changed: Vec<u32>,
}

impl Rest {
    /// No rows yet; `mirrors` are the flat faces that complete rows, `open` those that the metal goes on behind.
    #[must_use]
    pub fn new(metal: Matter, mirrors: Vec<Plane>, open: &[Plane]) -> Self {
        Self {
            kernel: Some(CubicSpline::new(metal.smoothing_length)),
            spacing: metal.spacing,
            faces: [&mirrors, open].concat(),
            mirrors,
            ..Self::default()
        }
    }

    /// The same on a lattice whose spacings along the axes are `cell` \[m\], where that of the even one has the sum `second` of r^2 W
    /// \[1/m\].
    #[must_use]
    pub fn of_cells(mut self, cell: [f64; 3], second: f64) -> Self {
        let lattice = |kernel| Stretched::of(cell, kernel, second);
        self.lattice = self.kernel.and_then(lattice);
        self
    }

    /// Row of particle `a`, ascending; empty for one that does not rest.
    #[must_use]
    #[inline]
    pub fn row(&self, a: usize) -> &[Link] {
        self.rows.get(a).map_or(&[], Vec::as_slice)
    }

    /// True if `a` rests.
    #[must_use]
    #[inline]
    pub fn holds(&self, a: usize) -> bool {
        self.part.get(a).is_some_and(|part| *part != Part::Away)
    }

    /// Particles that came, went or got another row in the last update, ascending.
    #[must_use]
    pub fn changed(&self) -> &[u32] {
        &self.changed
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let links: usize = self.rows.iter().map(Vec::capacity).sum();
        let cuts = self.cuts.as_ref().map_or(0, Cuts::bytes);
        16 * links + 25 * self.rows.len() + cuts
    }

    /// Takes in who has begun or ceased to rest.
    pub fn update(&mut self, state: &State) {
        self.changed.clear();
        self.rows.resize(state.len(), Vec::new());
        self.part.resize(state.len(), Part::Away);
        let (places, droplet) = (state.metal.column(&POSITION), state.metal.column(&DROPLET));
        let fused = state.metal.column(&FUSED);
        let melted = |a: usize| fused.get(a).is_some_and(|part| *part >= LIQUID);
        for (a, phase) in state.metal.column(&PHASE).iter().enumerate() {
            let rests = rests(*phase, state.flowing);
            if rests && self.part[a] == Part::Away {
                let moved = marked(droplet, a) || (melted(a) && state.flowing);
                let part = if moved { Part::Settled } else { Part::Pristine };
                self.enter(places, &state.faces, a, part);
            } else if !rests && self.part[a] != Part::Away {
                self.leave(places, a);
            }
        }
        if self.cuts.is_none() {
            self.complete(places);
        }
        self.changed.sort_unstable();
        self.changed.dedup();
    }

    /// Raises the weights of what rests at the start beside faces without a name.
    fn complete(&mut self, places: &[[f64; 3]]) {
        let Some(kernel) = self.kernel else { return };
        let standing = Standing {
            places,
            faces: &self.faces,
            reach: kernel.support(),
            spacing: self.spacing,
        };
        let cuts = Cuts::of(&self.rows, &standing);
        if !cuts.is_empty() {
            for (a, row) in self.rows.iter_mut().enumerate() {
                for link in row {
                    let b = link.to as usize;
                    link.weight *= cuts.factor(a, b, difference(places[a], places[b]));
                }
            }
        }
        self.cuts = Some(cuts);
    }

    /// How many parts, the parts, and the cut sums, as numbers, for a checkpoint.
    #[must_use]
    pub fn save(&self) -> Vec<f64> {
        let parts = self.part.iter().map(|part| f64::from(*part as u8));
        let cuts = self.cuts.iter().flat_map(Cuts::save);
        let count = std::iter::once(self.part.len() as f64);
        count.chain(parts).chain(cuts).collect()
    }

    /// Builds the rows of the parts that [`Rest::save`] gave.
    pub fn restore(&mut self, state: &State, saved: &[f64]) {
        let Some((count, saved)) = saved.split_first() else {
            return;
        };
        let (parts, cuts) = saved.split_at((*count as usize).min(saved.len()).min(state.len()));
        self.rows = vec![Vec::new(); parts.len()];
        self.part = vec![Part::Away; parts.len()];
        self.cuts = Some(Cuts::restored(cuts));
        self.cells.clear();
        let places = state.metal.column(&POSITION);
        for (a, part) in parts.iter().enumerate() {
            match *part as u8 {
                1 => self.enter(places, &state.faces, a, Part::Pristine),
                2 => self.enter(places, &state.faces, a, Part::Settled),
                _ => {}
            }
        }
        self.changed.clear();
    }

    fn enter(&mut self, places: &[[f64; 3]], faces: &Faces, a: usize, part: Part) {
        let Some(kernel) = self.kernel else { return };
        self.part[a] = part;
        let cell = cell(places[a], kernel.support());
        let mut row = Vec::with_capacity(26);
        for near in around(cell) {
            for &b in self.cells.get(&near).map_or(&[][..], Vec::as_slice) {
                let weight = self.weight(places, a, b as usize, kernel);
                if weight > 0.0 {
                    row.push(Link { to: b, weight });
                }
            }
        }
        row.sort_unstable_by_key(|link| link.to);
        self.add_images(places, faces, a, &mut row);
        for link in &row {
            let other = &mut self.rows[link.to as usize];
            let place = other.partition_point(|l| l.to < a as u32);
            other.insert(
                place,
                Link {
                    to: a as u32,
                    weight: link.weight,
                },
            );
            self.changed.push(link.to);
        }
        self.rows[a] = row;
        self.changed.push(a as u32);
        self.cells.entry(cell).or_default().push(a as u32);
    }

    /// Adds the pairs of the images of `a` beyond the faces of the flow, where one of both has moved.
    fn add_images(&mut self, places: &[[f64; 3]], faces: &Faces, a: usize, row: &mut Vec<Link>) {
        let Some(kernel) = self.kernel.filter(|_| faces.any()) else {
            return;
        };
        for to in self.behind(places, faces, a, kernel) {
            let b = to as usize;
            // Of the images of one of both, whoever came last: the same to the last bit after a checkpoint.
            self.reflect(places[a.min(b)], faces, kernel);
            let other = places[a.max(b)];
            let images = self.beyond[1..].iter();
            let weight: f64 = images
                .map(|image| kernel.value(distance(*image, other)))
                .sum();
            match row.binary_search_by_key(&to, |link| link.to) {
                Ok(place) => row[place].weight += weight,
                Err(place) => row.insert(place, Link { to, weight }),
            }
        }
    }

    /// Who stands within a support of an image of `a` beyond the faces of the flow, where one of both has moved, ascending.
    fn behind(
        &mut self,
        places: &[[f64; 3]],
        faces: &Faces,
        a: usize,
        kernel: CubicSpline<3>,
    ) -> BTreeSet<u32> {
        self.reflect(places[a], faces, kernel);
        let mut found = BTreeSet::new();
        for image in &self.beyond[1..] {
            for near in around(cell(*image, kernel.support())) {
                let all = self.cells.get(&near).map_or(&[][..], Vec::as_slice);
                found.extend(all.iter().filter(|b| {
                    let b = **b as usize;
                    let moved = [a, b].iter().any(|one| self.part[*one] == Part::Settled);
                    moved && kernel.value(distance(*image, places[b])) > 0.0
                }));
            }
        }
        found
    }

    /// A place and behind it its images beyond the faces of the flow.
    fn reflect(&mut self, place: [f64; 3], faces: &Faces, kernel: CubicSpline<3>) {
        self.beyond.clear();
        self.beyond.push(place);
        (self.images).place(faces, kernel.support(), &mut self.beyond);
    }

    fn leave(&mut self, places: &[[f64; 3]], a: usize) {
        let Some(kernel) = self.kernel else { return };
        let row = std::mem::take(&mut self.rows[a]);
        for link in &row {
            self.rows[link.to as usize].retain(|l| l.to != a as u32);
            self.changed.push(link.to);
        }
        self.changed.push(a as u32);
        self.part[a] = Part::Away;
        if let Some(cell) = self.cells.get_mut(&cell(places[a], kernel.support())) {
            cell.retain(|b| *b != a as u32);
        }
    }

    /// W of the pair, summed over the images of `b` in the mirrors.
    fn weight(&self, places: &[[f64; 3]], a: usize, b: usize, kernel: CubicSpline<3>) -> f64 {
        let (at, to) = (places[a], places[b]);
        let direct = kernel.value(distance(at, to));
        if direct <= 0.0 || self.part[a] == Part::Settled || self.part[b] == Part::Settled {
            return direct;
        }
        let weigh = |way: [f64; 3]| {
            let factor = self.lattice.map_or(1.0, |lattice| lattice.factor(way));
            factor * kernel.value(squared(way).sqrt())
        };
        let reach = kernel.support();
        let beside = |plane: &&Plane| (at[plane.axis] - plane.at).abs() < reach;
        let planes: Vec<&Plane> = self.mirrors.iter().filter(beside).collect();
        let mut sum = 0.0;
        for images in 0..1_u32 << planes.len() {
            let mut image = to;
            for (k, plane) in planes.iter().enumerate() {
                if images >> k & 1 == 1 {
                    image[plane.axis] = 2.0 * plane.at - image[plane.axis];
                }
            }
            sum += weigh(difference(at, image));
        }
        match self.cuts.as_ref().filter(|cuts| !cuts.is_empty()) {
            Some(cuts) => sum * cuts.factor(a, b, difference(at, to)),
            None => sum,
        }
    }
}

/// A particle rests while it is solid or held, or liquid before the flow starts.
fn rests(phase: u8, flowing: bool) -> bool {
    matches!(phase, phase::SOLID | phase::HELD) || (phase == phase::LIQUID && !flowing)
}

/// A cell and those beside it.
fn around(cell: [i32; 3]) -> impl Iterator<Item = [i32; 3]> {
    let beside = |k: i32| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1];
    (0..27).map(move |k| std::array::from_fn(|axis| cell[axis] + beside(k)[axis]))
}

/// Cell of a place; a search looks into 27 of them.
fn cell(place: [f64; 3], edge: f64) -> [i32; 3] {
    place.map(|x| (x / edge).floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Particle;

    const METAL: Matter = Matter {
        density: 1.0,
        spacing: 1.0,
        smoothing_length: 1.0,
    };

    /// A block of 6^3 cells of 1 m, one corner in the origin.
    fn block() -> State {
        let mut state = State::new(METAL);
        for cell in 0..216 {
            let at = [cell % 6, cell / 6 % 6, cell / 36].map(|i| f64::from(i) + 0.5);
            state.push(Particle {
                position: at,
                velocity: [0.0; 3],
                phase: phase::SOLID,
                droplet: false,
                wall: false,
                temperature: 0.0,
                enthalpy: 0.0,
            });
        }
        state
    }

    #[test]
    fn mirrors_complete_the_rows_beside_flat_faces() {
        let state = block();
        let plane = |axis, at, outward| Plane { axis, at, outward };
        let faces = (0..3).flat_map(|axis| [plane(axis, 0.0, -1.0), plane(axis, 6.0, 1.0)]);
        let mut rest = Rest::new(METAL, faces.collect(), &[]);
        rest.update(&state);
        // The sum of r^2 W along x is the same for the corner as for the middle.
        let moment = |a: usize| -> f64 {
            let row = rest.row(a).iter();
            row.map(|link| {
                let dx = state.metal.column(&POSITION)[a][0]
                    - state.metal.column(&POSITION)[link.to as usize][0];
                link.weight * dx * dx
            })
            .sum()
        };
        let (corner, middle) = (moment(0), moment(2 + 6 * 2 + 36 * 2));
        // The middle of the block sees both neighbours in x, the corner one.
        assert!(
            (2.0 * corner - middle).abs() < 1e-12 * middle,
            "{corner} {middle}"
        );
    }

    #[test]
    fn a_lattice_of_unlike_spacings_conducts_alike_along_all_axes() {
        let kernel = CubicSpline::<3>::new(1.0);
        // Sum r^2 W over the faces, edges and corners of a cell of 1 m, with W = 0 from 2 m on.
        let of = |count: f64, square: f64| count * square * kernel.value(square.sqrt());
        let second = of(6.0, 1.0) + of(12.0, 2.0) + of(8.0, 3.0);
        for cell in [[1.0; 3], [1.03, 0.99, 0.98], [0.97, 1.01, 1.02]] {
            let mut state = block();
            for place in state.metal.column_mut(&POSITION) {
                *place = std::array::from_fn(|k| place[k] * cell[k]);
            }
            let plane = |axis: usize, at, outward| Plane { axis, at, outward };
            let ends = |k: usize| [plane(k, 0.0, -1.0), plane(k, 6.0 * cell[k], 1.0)];
            let mirrors = (0..3).flat_map(ends).collect();
            let mut rest = Rest::new(METAL, mirrors, &[]).of_cells(cell, second);
            rest.update(&state);
            let places = state.metal.column(&POSITION);
            for axis in 0..3 {
                let moment = |a: usize| -> f64 {
                    let row = rest.row(a).iter();
                    let way = |b: u32| difference(places[a], places[b as usize])[axis];
                    row.map(|link| link.weight * way(link.to).powi(2)).sum()
                };
                // In the middle on both sides, in the corner on one, where next but one neighbours are a little off.
                for (whole, close) in [(moment(2 + 6 * 2 + 36 * 2), 1e-12), (2.0 * moment(0), 1e-3)]
                {
                    let off = 3.0 * whole / second - 1.0;
                    assert!(off.abs() < close, "{cell:?}, axis {axis}: {off}");
                }
            }
        }
    }

    #[test]
    fn what_set_again_is_completed_beyond_the_faces_of_the_flow() {
        let faces = r#"{"min_m": [0, 0, 0], "max_m": [6, 6, 6], "periodic": ["x"], "mirror": ["y-", "y+", "z-"], "wall": [{"face": "z+"}]}"#;
        let faces: crate::faces::Parameters = serde_json::from_str(faces).unwrap();
        let mut state = block();
        state.faces = faces.faces(2.0, false).unwrap();
        state.flowing = true;
        state.metal.declare(&FUSED);
        state.metal.column_mut(&FUSED).fill(1.0);
        let mut rest = Rest::new(METAL, Vec::new(), &[]);
        // Nothing rested at the start.
        rest.update(&State::new(METAL));
        rest.update(&state);
        // A neighbour on a face, edge or corner of the cell, and its images: the same sum everywhere.
        let sum = |a: usize| rest.row(a).iter().map(|link| link.weight).sum::<f64>();
        let kernel = CubicSpline::<3>::new(1.0);
        let one = |square: f64| kernel.value(square.sqrt());
        let (middle, own) = (sum(2 + 6 * 2 + 36 * 2), [one(1.0), one(2.0), one(3.0)]);
        assert!((middle - 6.0 * own[0] - 12.0 * own[1] - 8.0 * own[2]).abs() < 1e-12);
        // Beside a periodic face nothing lacks, beside a mirror or a wall its own image.
        let off = sum(6 * 2 + 36 * 2) - middle;
        assert!(off.abs() < 1e-12, "{off} {own:?}");
        assert!((sum(2 + 36 * 2) - middle + own[0]).abs() < 1e-12);
        assert!((sum(2 + 6 * 2 + 36 * 5) - middle + own[0]).abs() < 1e-12);
        // Who came last makes no difference, as after a checkpoint.
        for phase in [phase::LIQUID, phase::SOLID] {
            for a in [3, 72, 78, 215] {
                state.metal.column_mut(&PHASE)[a] = phase;
            }
            rest.update(&state);
        }
        let mut resumed = Rest::new(METAL, Vec::new(), &[]);
        resumed.restore(&state, &rest.save());
        for a in 0..state.len() {
            assert_eq!(rest.row(a), resumed.row(a), "{a}");
        }
        // Rows are symmetric.
        for a in 0..state.len() {
            for link in rest.row(a) {
                let back = rest
                    .row(link.to as usize)
                    .iter()
                    .find(|l| l.to as usize == a);
                assert_eq!(back.map(|l| l.weight), Some(link.weight));
            }
        }
    }

    #[test]
    fn rows_after_changes_are_those_of_a_fresh_start() {
        let mut state = block();
        state.flowing = true;
        let plane = |axis, at, outward| Plane { axis, at, outward };
        let faces = (0..3).flat_map(|axis| [plane(axis, 0.0, -1.0), plane(axis, 6.0, 1.0)]);
        let faces: Vec<Plane> = faces.collect();
        // With free faces rows know the start too.
        for faces in [&faces[..], &[]] {
            after_changes(&mut state, faces);
        }
    }

    fn after_changes(state: &mut State, faces: &[Plane]) {
        let new = || Rest::new(METAL, faces.to_vec(), &[]);
        state.metal.column_mut(&PHASE)[80] = phase::SOLID;
        let mut rest = new();
        rest.update(state);
        state.metal.column_mut(&PHASE)[80] = phase::LIQUID;
        rest.update(state);
        assert!(!rest.holds(80) && rest.row(80).is_empty());
        assert!(rest.changed().contains(&80) && rest.changed().len() > 6);
        let mut fresh = new();
        fresh.update(state);
        let saved = rest.save();
        let mut resumed = new();
        resumed.restore(state, &saved);
        for a in 0..state.len() {
            assert!(faces.is_empty() || rest.row(a) == fresh.row(a));
            assert_eq!(rest.row(a), resumed.row(a));
        }
    }
}
