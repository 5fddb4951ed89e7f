//! All sets of particles at one time.

use particles::{Column, Ids, Set};

/// u \[m/s\].
pub const VELOCITY: Column<[f64; 3]> = Column::new("velocity", "m/s", [0.0; 3]).saved().shown();
/// du/dt \[m/s2\] of the last positions: the next step begins with it.
pub const ACCELERATION: Column<[f64; 3]> = Column::new("acceleration", "m/s2", [0.0; 3]).saved();
/// Mass of the particle \[kg\], in the plane \[kg/m\].
pub const MASS: Column<f64> = Column::new("mass", "kg", 0.0).saved();

/// rho \[kg/m3\] of water.
pub const DENSITY: Column<f64> = Column::new("density", "kg/m3", 0.0).saved().shown();
/// d(rho)/dt \[kg/(m3 s)\] at the middle of a step.
pub const DENSITY_RATE: Column<f64> = Column::new("density_rate", "kg/(m3 s)", 0.0);

/// All sets of particles at one time.
#[derive(Debug, Clone)]
pub struct State {
    /// Simulated time \[s\].
    pub time: f64,
    /// Steps taken.
    pub step: u64,
    /// 2: per metre of depth; 3.
    pub dimensions: usize,
    /// Sets, in the order of the scene.
    pub sets: Vec<Set>,
    /// Numbers of the particles.
    pub ids: Ids,
    /// How often particles have come or left.
    pub exchanges: u64,
    /// What plain walls bear of pairs of water and solids \[N\], until the water counts it.
    pub on_walls: Vec<[f64; 3]>,
}

impl State {
    /// No sets.
    #[must_use]
    pub fn new(dimensions: usize) -> Self {
        Self {
            time: 0.0,
            step: 0,
            dimensions,
            sets: Vec::new(),
            ids: Ids::default(),
            exchanges: 0,
            on_walls: Vec::new(),
        }
    }

    /// Number of particles of all sets.
    #[must_use]
    pub fn len(&self) -> usize {
        self.sets.iter().map(Set::len).sum()
    }

    /// True without particles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Name and bytes of each set, for the plan and the record.
    pub fn memory(&self) -> impl Iterator<Item = (String, usize)> {
        self.sets
            .iter()
            .map(|set| (format!("particles of {}", set.name()), set.bytes()))
    }
}
