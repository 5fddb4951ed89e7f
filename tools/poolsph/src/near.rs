//! The moving particles and all that they touch, as a compact copy sorted by cell.
//!
//! Flow works on this copy alone, so a large cold plate costs it nothing. Membership and order
//! are a function of the state only, so a resumed run repeats them. Mobility is that of the
//! moment of gathering: what melts during a step starts to move in the next.

use neighbours::{Grid, Lists};

use crate::state::{Metal, Phase, State};

/// Solid particles are gathered this far beyond the support, in smoothing lengths: the way that a
/// liquid particle may go within a step.
const MARGIN: f64 = 0.5;

/// Compact particles: liquid ones, and solid ones within the support of a liquid one.
#[derive(Debug, Clone)]
pub struct Near {
    support: f64,
    /// Index into [`State`], `[m]`, sorted by cell.
    pub id: Vec<u32>,
    /// Moves, `[m]`.
    pub liquid: Vec<bool>,
    /// x \[m\], `[m][3]`.
    pub position: Vec<[f64; 3]>,
    /// u \[m/s\], `[m][3]`; zero for solid ones.
    pub velocity: Vec<[f64; 3]>,
    /// Force density \[N/m3\], `[m][3]`; zero after gathering, force stages add to it.
    pub force: Vec<[f64; 3]>,
    /// Rows of liquid particles hold all neighbours within the support; rows of solid ones hold
    /// their liquid neighbours only.
    pub lists: Lists,
    liquid_count: usize,
    liquid_grid: Grid,
    grid: Grid,
    candidates: Vec<u32>,
    places: Vec<[f64; 3]>,
}

impl Near {
    /// Empty.
    #[must_use]
    pub fn new(metal: Metal) -> Self {
        let support = metal.support();
        Self {
            support,
            id: Vec::new(),
            liquid: Vec::new(),
            position: Vec::new(),
            velocity: Vec::new(),
            force: Vec::new(),
            lists: Lists::new(),
            liquid_count: 0,
            liquid_grid: Grid::new(support),
            grid: Grid::new(support),
            candidates: Vec::new(),
            places: Vec::new(),
        }
    }

    /// Number of particles in the copy.
    #[must_use]
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// True while nothing moves.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Number of moving particles in the copy.
    #[must_use]
    pub fn liquid_count(&self) -> usize {
        self.liquid_count
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        (4 + 1 + 3 * 24) * self.id.capacity() + self.lists.bytes()
    }

    /// Collects members, sorts them by cell and finds their neighbours.
    pub(crate) fn gather(&mut self, state: &State) {
        self.candidates.clear();
        self.places.clear();
        if state.flowing {
            self.collect(state);
        }
        self.grid.bin(&self.places);
        let members = self
            .grid
            .order()
            .iter()
            .map(|&k| self.candidates[k as usize]);
        self.id.clear();
        self.id.extend(members);
        self.position.clear();
        self.position.extend_from_slice(self.grid.sorted());
        self.liquid.clear();
        self.liquid.extend(
            self.id
                .iter()
                .map(|&id| state.phase[id as usize] == Phase::Liquid),
        );
        self.liquid_count = self.liquid.iter().filter(|liquid| **liquid).count();
        let still = |(&id, &liquid): (&u32, &bool)| {
            if liquid {
                state.velocity[id as usize]
            } else {
                [0.0; 3]
            }
        };
        self.velocity.clear();
        self.velocity
            .extend(self.id.iter().zip(&self.liquid).map(still));
        self.force.clear();
        self.force.resize(self.id.len(), [0.0; 3]);
        self.search();
    }

    /// Finds the neighbours anew for the present positions of the copy.
    pub(crate) fn search(&mut self) {
        self.grid.bin(&self.position);
        let liquid = &self.liquid;
        self.lists.build(
            &self.grid,
            &self.position,
            self.support,
            |_| true,
            |a, b| liquid[a] | liquid[b],
        );
    }

    /// Liquid particles, and solid ones within the support of a liquid one.
    fn collect(&mut self, state: &State) {
        for (id, phase) in state.phase.iter().enumerate() {
            if *phase == Phase::Liquid {
                self.candidates.push(id as u32);
                self.places.push(state.position[id]);
            }
        }
        self.liquid_grid.bin(&self.places);
        let reach = self.support + MARGIN * 0.5 * self.support;
        for (id, phase) in state.phase.iter().enumerate() {
            let place = state.position[id];
            if *phase == Phase::Solid && self.liquid_grid.any_within(place, reach, |_| true) {
                self.candidates.push(id as u32);
                self.places.push(place);
            }
        }
    }
}
