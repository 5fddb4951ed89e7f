//! Images of points beyond periodic faces and mirrors.

use std::borrow::Cow;

use super::{Room, Side};

/// Images stand within so many spacings of the room.
const DEPTH: f64 = 6.0;

/// Which points images are of, and how they are turned.
#[derive(Debug, Clone, PartialEq)]
pub struct Images<const D: usize> {
    own: usize,
    origin: Vec<u32>,
    sign: Vec<[f64; D]>,
}

/// How a coordinate becomes that of an image: `sign x + shift`.
type Turn = (f64, f64);

impl<const D: usize> Images<D> {
    /// Points without images.
    #[must_use]
    pub fn none(own: usize) -> Self {
        Self {
            own,
            origin: Vec::new(),
            sign: Vec::new(),
        }
    }

    /// Number of points that are no images.
    #[must_use]
    pub fn own(&self) -> usize {
        self.own
    }

    /// The point that `j` is or is an image of.
    #[must_use]
    pub fn origin(&self, j: usize) -> usize {
        match j.checked_sub(self.own) {
            None => j,
            Some(image) => self.origin[image] as usize,
        }
    }

    /// The sign of a component of a vector at `j`.
    #[must_use]
    pub fn sign(&self, j: usize, component: usize) -> f64 {
        match j.checked_sub(self.own) {
            None => 1.0,
            Some(image) => self.sign[image][component],
        }
    }

    /// Values of points, then those of their images.
    #[must_use]
    pub fn scalars<'a>(&self, f: &'a [f64]) -> Cow<'a, [f64]> {
        if self.origin.is_empty() {
            return Cow::Borrowed(f);
        }
        let images = self.origin.iter().map(|&o| f[o as usize]);
        Cow::Owned(f.iter().copied().chain(images).collect())
    }

    /// Vectors of points, then those of their images.
    #[must_use]
    pub fn vectors<'a>(&self, f: &'a [[f64; D]]) -> Cow<'a, [[f64; D]]> {
        if self.origin.is_empty() {
            return Cow::Borrowed(f);
        }
        let turned = |(&o, sign): (&u32, &[f64; D])| -> [f64; D] {
            std::array::from_fn(|k| sign[k] * f[o as usize][k])
        };
        let images = self.origin.iter().zip(&self.sign).map(turned);
        Cow::Owned(f.iter().copied().chain(images).collect())
    }
}

impl<const D: usize> Room<D> {
    /// Points, then their images in the order of the points.
    #[must_use]
    pub fn images<'a>(
        &self,
        points: &'a [[f64; D]],
        spacing: f64,
    ) -> (Cow<'a, [[f64; D]]>, Images<D>) {
        let mut images = Images::none(points.len());
        if !self.bounds() {
            return (Cow::Borrowed(points), images);
        }
        let depth = DEPTH * spacing;
        let turns: [Vec<Turn>; D] = std::array::from_fn(|k| self.turns(k, depth));
        let mut all = points.to_vec();
        for (i, x) in points.iter().enumerate() {
            let mut choice = [0; D];
            while next(&mut choice, &turns) {
                let turn: [Turn; D] = std::array::from_fn(|k| turns[k][choice[k]]);
                let image: [f64; D] = std::array::from_fn(|k| turn[k].0 * x[k] + turn[k].1);
                let near = |k: usize| {
                    choice[k] == 0
                        || (image[k] > self.min[k] - depth && image[k] < self.max[k] + depth)
                };
                if (0..D).all(near) {
                    all.push(image);
                    images.origin.push(i as u32);
                    images.sign.push(turn.map(|t| t.0));
                }
            }
        }
        (Cow::Owned(all), images)
    }

    /// How coordinates along an axis become those of images; the first leaves them.
    fn turns(&self, axis: usize, depth: f64) -> Vec<Turn> {
        let (low, high, length) = (self.min[axis], self.max[axis], self.length(axis));
        let many = (depth / length).ceil() as i64;
        let both = (1..=many).flat_map(|k| [k, -k]);
        let mut turns = vec![(1.0, 0.0)];
        match self.sides[axis] {
            [Side::Periodic, _] => turns.extend(both.map(|k| (1.0, k as f64 * length))),
            [Side::Mirror, Side::Mirror] => {
                let shifts = both.map(|k| 2.0 * k as f64 * length);
                let shifts: Vec<f64> = std::iter::once(0.0).chain(shifts).collect();
                turns.extend(shifts[1..].iter().map(|s| (1.0, *s)));
                turns.extend(shifts.iter().map(|s| (-1.0, 2.0 * low + s)));
            }
            [Side::Mirror, _] => turns.push((-1.0, 2.0 * low)),
            [_, Side::Mirror] => turns.push((-1.0, 2.0 * high)),
            _ => {}
        }
        turns
    }
}

/// The next choice of a turn for each axis; none after the last.
fn next<const D: usize>(choice: &mut [usize; D], turns: &[Vec<Turn>; D]) -> bool {
    for k in 0..D {
        choice[k] += 1;
        if choice[k] < turns[k].len() {
            return true;
        }
        choice[k] = 0;
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::liquid::matter::Way;
    use crate::liquid::operators::{Fits, Points, derivatives};
    use crate::liquid::room::furnish;

    /// Periodic along x, mirrors across y.
    fn room() -> Room<2> {
        Room {
            min: [0.0, 1.0],
            max: [2.0, 2.0],
            sides: [[Side::Periodic; 2], [Side::Mirror; 2]],
            ..Room::default()
        }
    }

    #[test]
    fn images_repeat_and_turn_over() {
        let (all, images) = room().images(&[[0.25, 1.25]], 0.1);
        let found = |x: [f64; 2]| {
            let near = |y: &[f64; 2]| (0..2).all(|k| (x[k] - y[k]).abs() < 1e-12);
            all.iter().position(near)
        };
        let beside = found([2.25, 1.25]).unwrap();
        let below = found([0.25, 0.75]).unwrap();
        assert_eq!((images.origin(beside), images.sign(beside, 1)), (0, 1.0));
        assert_eq!((images.sign(below, 0), images.sign(below, 1)), (1.0, -1.0));
        assert!(found([2.25, 0.75]).is_some() && found([0.25, 2.75]).is_none());
        assert_eq!(
            images.vectors(&[[3.0, 4.0]])[below].map(|c| c as i32),
            [3, -4]
        );
    }

    /// The greatest error of `laplace sin(pi x) cos(pi (y - 1))` on points `spacing` apart.
    fn worst(spacing: f64) -> f64 {
        let mut room = room();
        let filled = furnish(&mut room, spacing, 0.2, 1);
        let (all, images) = room.images(&filled.position, spacing);
        let own = filled.position.len();
        let points = Points { all: &all, own };
        let way = Way {
            spacing,
            order: 3,
            tolerance: 1e-9,
            products: 100,
        };
        let rows = derivatives(points, &way, Fits::default()).unwrap();
        let pi = std::f64::consts::PI;
        let of = |x: &[f64; 2]| (pi * x[0]).sin() * (pi * (x[1] - 1.0)).cos();
        let f: Vec<f64> = filled.position.iter().map(of).collect();
        let wide = images.scalars(&f);
        let lack =
            |(i, f): (usize, &f64)| (rows.laplacian(i).apply(&wide) + 2.0 * pi * pi * f).abs();
        f.iter().enumerate().map(lack).fold(0.0, f64::max)
    }

    #[test]
    fn fits_know_what_lies_beyond() {
        let (coarse, fine) = (worst(0.05), worst(0.025));
        assert!(fine < 0.1 && fine < 0.4 * coarse, "{coarse} {fine}");
    }

    #[test]
    fn without_faces_nothing_is_copied() {
        let points = [[1.0, 2.0]];
        let (all, images) = Room::default().images(&points, 0.1);
        assert!(matches!(all, Cow::Borrowed(_)) && images == Images::none(1));
        assert!(matches!(images.scalars(&[1.0]), Cow::Borrowed(_)));
    }
}
