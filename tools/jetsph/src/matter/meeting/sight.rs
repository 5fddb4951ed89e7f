//! Which points of a solid each particle of water meets, and each of its images in plain walls.

use kernels::Kernel;
use neighbours::Grid;
use particles::{POSITION, Rows};
use shapes::Body;

use super::skin::Skin;
use crate::matter::water::images::{Mirror, Plane, image, mirrors};
use crate::state::State;

/// The image of a particle of water.
#[derive(Debug, Clone)]
struct Image {
    /// The particle.
    of: usize,
    mirror: Mirror,
}

/// A solid as the water around it sees it.
pub struct Sight<K> {
    /// Number of the set of water.
    pub water: usize,
    /// The solid.
    pub skin: Skin,
    /// Kernel of the mean smoothing length.
    pub kernel: K,
    walls: Vec<Body>,
    grid: Grid,
    points: Grid,
    /// The points of the skin that each particle of water meets; none where the solid is out of sight.
    rows: Rows,
    images: Vec<Image>,
    /// Those that each image meets.
    image_rows: Rows,
}

impl<K: Kernel> Sight<K> {
    /// Of a solid by the water of a set, with a kernel of the mean smoothing length, beside plain walls.
    #[must_use]
    pub fn new(water: usize, skin: Skin, kernel: K, walls: Vec<Body>) -> Self {
        let reach = kernel.support();
        Self {
            water,
            skin,
            kernel,
            walls,
            grid: Grid::new(reach),
            points: Grid::new(reach),
            rows: Rows::new(),
            images: Vec::new(),
            image_rows: Rows::new(),
        }
    }

    /// Finds who meets whom.
    pub fn look(&mut self, state: &State) {
        let water = state.sets[self.water].column(&POSITION);
        let reach = self.kernel.support();
        self.grid.bin(water);
        let grid = &self.grid;
        self.skin.look(&state.sets[self.skin.set], reach, |x, r| {
            grid.any_within(x, r)
        });
        let places: Vec<[f64; 3]> = self.skin.points.iter().map(|p| p.x).collect();
        self.points.bin(&places);
        self.images.clear();
        if places.is_empty() {
            self.rows.between(&[], &self.points, reach);
            self.image_rows.between(&[], &self.points, reach);
        } else {
            self.rows.between(water, &self.points, reach);
            self.look_into_walls(water, reach);
        }
    }

    /// Who meets an image meets the particle, too: it is nearer.
    fn look_into_walls(&mut self, water: &[[f64; 3]], reach: f64) {
        let mut places = Vec::new();
        if !self.walls.is_empty() {
            for of in (0..water.len()).filter(|a| !self.rows.row(*a).is_empty()) {
                for mirror in mirrors(&self.walls, water[of], reach) {
                    if let Some((x, _)) = image(&mirror, water[of], water[of], [0.0; 3]) {
                        places.push(x);
                        self.images.push(Image { of, mirror });
                    }
                }
            }
        }
        self.image_rows.between(&places, &self.points, reach);
    }

    /// Number of plain walls.
    #[must_use]
    pub fn walls(&self) -> usize {
        self.walls.len()
    }

    /// Number of particles of water and of their images; none where the solid is out of sight.
    #[must_use]
    pub fn visitors(&self) -> usize {
        self.rows.len() + self.images.len()
    }

    /// The particle of a visitor, and the mirrors by which it is its image.
    #[must_use]
    pub fn visitor(&self, v: usize) -> (usize, &[Plane]) {
        match v.checked_sub(self.rows.len()) {
            None => (v, &[]),
            Some(i) => (self.images[i].of, &self.images[i].mirror),
        }
    }

    /// The points that a visitor meets.
    #[must_use]
    pub fn row(&self, v: usize) -> &[u32] {
        match v.checked_sub(self.rows.len()) {
            None => self.rows.row(v),
            Some(i) => self.image_rows.row(i),
        }
    }
}
