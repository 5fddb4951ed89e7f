//! The stage of water: densities at the middle of a step, forces at its end.

use kernels::Kernel;
use particles::{Column, Set, sweep};
use shapes::Body;
use steps::Limit;

use super::around::Around;
use super::compression::Compression;
use super::diffusion::DensityDiffusion;
use super::friction::Artificial;
use super::near::LISTED;
use super::pairs::Pairs;
use super::tait::Tait;
use super::walls::Walls;
use crate::stage::{Course, Entry, Figure, Stage, StageError};
use crate::state::{ACCELERATION, DENSITY, DENSITY_RATE, MASS, State, VELOCITY};

/// p \[Pa\].
pub const PRESSURE: Column<f64> = Column::new("pressure", "Pa", 0.0).shown();

/// Part of h that sound may go in a step.
const COURANT: f64 = 0.4;
/// Part of the time in which friction evens out a kernel that a step may take.
const FRICTION: f64 = 0.2;
/// Part of the time in which an acceleration moves by h that a step may take.
const PUSH: f64 = 0.25;

/// What a scene says of its water.
#[derive(Debug, Clone)]
pub struct Water {
    /// Number of the set.
    pub set: usize,
    /// Equation of state.
    pub law: Tait,
    /// h \[m\].
    pub smoothing_length: f64,
    /// Artificial viscosity, if any.
    pub artificial: Option<Artificial>,
    /// True viscosity \[Pa s\], if any.
    pub viscosity: Option<f64>,
    /// Diffusion of density, if any.
    pub diffusion: Option<DensityDiffusion>,
    /// Plain walls with their names.
    pub walls: Vec<(String, Body)>,
}

/// The stage.
pub struct Flow<const D: usize, K> {
    pub(super) water: Water,
    pub(super) around: Around<K, Pairs>,
    /// Corrected slopes of density.
    pub(super) slopes: Vec<[f64; 3]>,
    pub(super) walls: Walls,
    /// The force of all walls on the water and what friction takes.
    course: Course<4>,
    entry: Entry,
    compression: Compression,
}

impl<const D: usize, K: Kernel> Flow<D, K> {
    /// The stage of a scene's water.
    #[must_use]
    pub fn new(water: Water, kernel: K) -> Self {
        let h = water.smoothing_length;
        Self {
            around: Around::new(
                kernel,
                h,
                water.walls.iter().map(|(_, body)| body.clone()).collect(),
            ),
            slopes: Vec::new(),
            walls: Walls::new(water.walls.iter().map(|(name, _)| name.clone()).collect()),
            course: Course::default(),
            entry: Entry::default(),
            compression: Compression::default(),
            water,
        }
    }

    /// Looks at all particles; `value` gives what they show beside their volume.
    fn look(&mut self, set: &mut Set, exchanges: u64, value: impl Fn(f64) -> f64 + Sync) {
        let law = self.water.law;
        let (mass, density) = (set.take(&MASS), set.take(&DENSITY));
        self.around.look(set, exchanges, |a| {
            (mass[a] / law.filling(density[a]), value(density[a]))
        });
        self.around.near.rows.look(&self.around.seen);
        set.put(&MASS, mass);
        set.put(&DENSITY, density);
    }
}

impl<const D: usize, K: Kernel> Stage for Flow<D, K> {
    fn name(&self) -> &'static str {
        "water"
    }

    fn declare(&self, state: &mut State) {
        let set = &mut state.sets[self.water.set];
        set.declare(&LISTED);
        set.declare(&DENSITY_RATE);
        set.declare(&PRESSURE);
    }

    fn limit(&self, state: &State) -> Option<Limit> {
        let set = &state.sets[self.water.set];
        let (h, c) = (self.water.smoothing_length, self.water.law.sound_speed);
        let square = |x: [f64; 3]| x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
        let fastest = |column: &[[f64; 3]]| {
            let most = sweep::greatest(column.len(), |a| square(column[a]));
            most.map_or(0.0, |(_, most)| most.sqrt())
        };
        // Of speeds only how they differ counts; the whole is at most that.
        let speed = fastest(set.column(&VELOCITY));
        let push = fastest(set.column(&ACCELERATION));
        let density = self.water.law.density;
        let kinematic = self.water.viscosity.map_or(0.0, |mu| mu / density)
            + self.water.artificial.map_or(0.0, |a| {
                (a.linear + 2.0 * a.quadratic * speed / h) / density / (2.0 * (D as f64 + 2.0))
            });
        let limits = [
            ("acoustic", COURANT * h / (c + speed)),
            ("viscous", FRICTION * h * h / kinematic),
            ("acceleration", PUSH * (h / push).sqrt()),
        ];
        let all = limits
            .into_iter()
            .map(|(name, seconds)| Limit::dividing(name, seconds));
        all.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }

    fn flows(&self) -> bool {
        true
    }

    fn flow(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let exchanges = state.exchanges;
        let set = &mut state.sets[self.water.set];
        self.look(set, exchanges, |density| density);
        let rates = self.rates();
        let law = self.water.law;
        let mut total = set.take(&DENSITY_RATE);
        sweep::change(&mut total, |a, rate| *rate += rates[a][0] + rates[a][1]);
        set.put(&DENSITY_RATE, total);
        let mass = set.column(&MASS);
        let gained = |a: usize| {
            let density = self.around.seen[a].value;
            [mass[a] * law.pressure(density) / (density * density) * rates[a][1]]
        };
        if self.water.diffusion.is_some() {
            self.entry.spent -= dt * sweep::sum(rates.len(), gained)[0];
        }
        Ok(())
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let exchanges = state.exchanges;
        let law = self.water.law;
        let set = &mut state.sets[self.water.set];
        self.look(set, exchanges, |density| law.pressure(density));
        self.compression.over(dt, set, &law);
        let forces = self.all_forces();
        self.walls.bear(&mut state.on_walls);
        let mut acceleration = set.take(&ACCELERATION);
        let mass = set.column(&MASS);
        sweep::change(&mut acceleration, |a, own| {
            (0..3).for_each(|k| own[k] += forces[a][k] / mass[a]);
        });
        set.put(&ACCELERATION, acceleration);
        let [lost] = sweep::sum(forces.len(), |a| [forces[a][3]]);
        let [x, y, z] = self.walls.press(dt);
        let [x, y, z, lost] = self.course.over(dt, [x, y, z, lost]);
        let given = self.entry.impulse.iter_mut().zip([x, y, z]);
        given.for_each(|(sum, part)| *sum += part);
        self.entry.spent += lost;
        Ok(())
    }

    fn exchange(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        if !self.around.beside.is_empty() {
            let set = &mut state.sets[self.water.set];
            self.walls.land(set, &self.around, dt, &mut self.entry);
        }
        Ok(())
    }

    fn show(&self, state: &mut State) {
        let law = self.water.law;
        let set = &mut state.sets[self.water.set];
        let density = set.column(&DENSITY).to_vec();
        sweep::fill(set.column_mut(&PRESSURE), |a| law.pressure(density[a]));
    }

    fn entry(&self, state: &State) -> Entry {
        let set = &state.sets[self.water.set];
        let (mass, density) = (set.column(&MASS), set.column(&DENSITY));
        let law = self.water.law;
        let stored = sweep::sum(set.len(), |a| [mass[a] * law.energy(density[a])])[0];
        Entry {
            stored,
            ..self.entry
        }
    }

    fn figures(&self, _: &State) -> Vec<Figure> {
        self.walls.figures(D)
    }

    fn warning(&self, _: &State) -> Option<String> {
        self.compression.warning(&self.water.law)
    }

    fn bytes(&self) -> usize {
        self.around.bytes()
    }

    fn save(&self) -> Vec<f64> {
        let mut saved = [
            &self.entry.save()[..],
            &self.course.last(),
            &[self.around.near.save()],
            &self.compression.save(),
        ]
        .concat();
        saved.extend(self.walls.save());
        saved
    }

    fn restore(&mut self, state: &State, saved: &[f64]) {
        let listed = state.sets[self.water.set].column(&LISTED);
        let rest = self.entry.restore(saved);
        if let [seen, whole, much, most, walls @ ..] = self.course.restore(rest) {
            self.compression = Compression::restored([*whole, *much, *most]);
            self.around.near.restore(listed, *seen);
            self.walls.restore(walls);
        }
        self.around.stand_beside(listed);
    }
}
