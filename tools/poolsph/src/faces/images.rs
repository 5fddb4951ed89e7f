//! Images beyond the faces, behind the points that they are images of.

use super::planes::{Faces, TiltedFace, Turn};

/// An image of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Image {
    /// Its original, by number.
    pub of: u32,
    turn: u8,
}

/// The images of a cloud; the k-th stands in columns `k` places behind the last of its points.
#[derive(Debug, Clone, Default)]
pub struct Images {
    points: usize,
    list: Vec<Image>,
    turns: Vec<Turn>,
    /// Faces of each axis, and whether they are periodic.
    planes: [([Option<f64>; 2], bool); 3],
    /// Faces that the free surface meets askew.
    tilted: Vec<TiltedFace>,
}

impl Images {
    /// Puts the images of all `places` that are within `reach` \[m\] of a face behind them.
    pub fn place(&mut self, faces: &Faces, reach: f64, places: &mut Vec<[f64; 3]>) {
        self.points = places.len();
        self.list.clear();
        if !faces.any() {
            return;
        }
        if self.turns.is_empty() {
            self.turns = faces.turns().to_vec();
            self.planes = [0, 1, 2].map(|axis| (faces.planes(axis), faces.is_periodic(axis)));
            self.tilted = faces.tilted_faces();
        }
        self.reflect(reach, places);
    }

    /// As [`Images::place`], beyond the faces of `other` images.
    pub fn place_beside(&mut self, other: &Self, reach: f64, places: &mut Vec<[f64; 3]>) {
        self.points = places.len();
        self.list.clear();
        if other.turns.is_empty() {
            return;
        }
        if self.turns.is_empty() {
            self.turns.clone_from(&other.turns);
            self.planes = other.planes;
            self.tilted.clone_from(&other.tilted);
        }
        self.reflect(reach, places);
    }

    fn reflect(&mut self, reach: f64, places: &mut Vec<[f64; 3]>) {
        for axis in 0..3 {
            let (planes, periodic) = self.planes[axis];
            // Images in the faces of an axis have images in those of the next.
            for k in 0..places.len() {
                let x = places[k][axis];
                for side in 0..2 {
                    // What lies at one face of a periodic box stands beyond the other.
                    let from = if periodic { 1 - side } else { side };
                    let near = planes[from].is_some_and(|plane| (x - plane).abs() < reach);
                    if planes[side].is_some() && near {
                        self.add(places, k, axis, side);
                    }
                }
            }
        }
    }

    fn add(&mut self, places: &mut Vec<[f64; 3]>, k: usize, axis: usize, side: usize) {
        let before = match k.checked_sub(self.points) {
            None => Image {
                of: k as u32,
                turn: 0,
            },
            Some(image) => self.list[image],
        };
        let turn = before.turn + (side as u8 + 1) * 3_u8.pow(axis as u32);
        places.push(self.turns[turn as usize].place(places[before.of as usize]));
        self.list.push(Image { turn, ..before });
    }

    /// The faces that the free surface meets at another angle than a right one.
    #[must_use]
    pub fn tilted_faces(&self) -> &[TiltedFace] {
        &self.tilted
    }

    /// True without images.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Number of images.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Each image, in order.
    #[must_use]
    pub fn list(&self) -> &[Image] {
        &self.list
    }

    /// The point that the entry `k` of a column that goes on with images is an image of; itself for a point.
    #[must_use]
    #[inline]
    pub fn original(&self, k: usize) -> usize {
        let image = k.checked_sub(self.points).and_then(|k| self.list.get(k));
        image.map_or(k, |image| image.of as usize)
    }

    /// How the entry `k` of a column that goes on with images follows from its original; none for a point.
    #[must_use]
    #[inline]
    pub fn turn(&self, k: usize) -> Option<&Turn> {
        let image = self.list.get(k.checked_sub(self.points)?)?;
        self.turns.get(image.turn as usize)
    }

    /// Completes a column of points behind its last one with what `of` says of an original's value, the image's number
    /// and its turn.
    pub fn complete<T: Copy>(&self, column: &mut Vec<T>, of: impl Fn(T, usize, &Turn) -> T) {
        if self.turns.is_empty() {
            return;
        }
        column.truncate(self.points);
        for image in &self.list {
            let value = of(
                column[image.of as usize],
                column.len(),
                &self.turns[image.turn as usize],
            );
            column.push(value);
        }
    }
}
