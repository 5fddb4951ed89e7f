//! Neighbours of water, found with a skin and used until a particle has moved through half of it.

use neighbours::Grid;
use particles::{Column, Rows, sweep};

/// Where a particle was when neighbours were last found \[m\].
pub const LISTED: Column<[f64; 3]> = Column::new("listed", "m", [f64::NAN; 3]).saved();

/// The skin in smoothing lengths.
const SKIN: f64 = 0.3;

/// How neighbours are listed.
pub trait Lists: Default + Send + Sync {
    /// Lists those of places that `grid` was given, closer than `radius` \[m\].
    fn find(&mut self, listed: &[[f64; 3]], grid: &Grid, radius: f64);

    /// Tells who stands beside walls.
    fn stand_beside(&mut self, _beside: &[u32], _listed: (&[[f64; 3]], &Grid, f64)) {}

    /// All neighbours of a particle that stands beside a wall, of any where nobody was told.
    fn row(&self, a: usize) -> &[u32];

    /// Bytes held.
    fn bytes(&self) -> usize;
}

impl Lists for Rows {
    fn find(&mut self, listed: &[[f64; 3]], grid: &Grid, radius: f64) {
        self.within(listed, grid, radius);
    }

    fn row(&self, a: usize) -> &[u32] {
        self.row(a)
    }

    fn bytes(&self) -> usize {
        self.bytes()
    }
}

/// Neighbours within a set.
#[derive(Debug, Clone)]
pub struct Near<L = Rows> {
    grid: Grid,
    /// For each particle, those within the support and the skin.
    pub rows: L,
    radius: f64,
    skin: f64,
    /// The exchange of particles that they know of.
    seen: u64,
}

impl<L: Lists> Near<L> {
    /// None yet; `h` is the smoothing length \[m\].
    #[must_use]
    pub fn new(h: f64) -> Self {
        let skin = SKIN * h;
        let radius = 2.0 * h + skin;
        Self {
            grid: Grid::new(0.5 * radius),
            rows: L::default(),
            radius,
            skin,
            seen: u64::MAX,
        }
    }

    /// Support and skin \[m\].
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Finds them anew where that is due; tells whether it was.
    pub fn refresh(
        &mut self,
        position: &[[f64; 3]],
        listed: &mut [[f64; 3]],
        exchanges: u64,
    ) -> bool {
        let limit = 0.25 * self.skin * self.skin;
        let moved = |a: usize| {
            let (x, y) = (position[a], listed[a]);
            (x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2) + (x[2] - y[2]).powi(2)
        };
        // What is no number was never listed.
        let holds = self.seen == exchanges
            && sweep::greatest(position.len(), moved).is_none_or(|(_, most)| most < limit);
        if !holds {
            listed.copy_from_slice(position);
            self.find(listed);
            self.seen = exchanges;
        }
        !holds
    }

    fn find(&mut self, listed: &[[f64; 3]]) {
        self.grid.bin(listed);
        self.rows.find(listed, &self.grid, self.radius);
    }

    /// Tells who stands beside walls, where they were last listed.
    pub fn stand_beside(&mut self, beside: &[u32], listed: &[[f64; 3]]) {
        self.rows
            .stand_beside(beside, (listed, &self.grid, self.radius));
    }

    /// What a checkpoint keeps.
    #[must_use]
    pub fn save(&self) -> f64 {
        self.seen as f64
    }

    /// Takes up what was listed when the checkpoint was written.
    pub fn restore(&mut self, listed: &[[f64; 3]], seen: f64) {
        self.seen = seen as u64;
        if listed.iter().flatten().all(|x| x.is_finite()) {
            self.find(listed);
        } else {
            self.seen = u64::MAX;
        }
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.rows.bytes()
    }
}
