//! A nozzle: water that comes in with a velocity that the scene tells.
//!
//! Particles stand in columns along the jet, start a few smoothing lengths before the exit and are led until they pass
//! it: they move as they are told, at the density of rest, and what pushes them back pushes the nozzle. Each column brings
//! its share of the cross-section exactly, so that the flow is rho A V whatever the spacing.

use particles::{Column, POSITION, sweep};
use run::property::{Arguments, Curve};
use steps::Limit;

use super::near::LISTED;
use crate::matter::lattice::cross_section;
use crate::stage::{Course, Entry, Figure, Stage, StageError};
use crate::state::{ACCELERATION, DENSITY, DENSITY_RATE, MASS, State, VELOCITY};

/// 1 + number of the nozzle that leads a particle; 0 for a free one.
pub const LED: Column<u8> = Column::new("led", "1", 0).saved();

/// Way of what comes in within a step, in spacings: a column takes in one particle a step at most.
const LONGEST: f64 = 0.5;
/// Part of the spacing by which a place is inside of a nozzle or not.
const EDGE: f64 = 1e-6;

/// What a scene says of a nozzle.
#[derive(Debug, Clone)]
pub struct Nozzle {
    /// Its name.
    pub name: String,
    /// Number of the set of water.
    pub set: usize,
    /// 1 + its number.
    pub mark: u8,
    /// Middle of its exit at the start \[m\].
    pub exit: [f64; 3],
    /// Where it points.
    pub direction: [f64; 3],
    /// Axes across; the second only in space.
    pub across: [[f64; 3]; 2],
    /// Width of the slot or diameter \[m\].
    pub width: f64,
    /// Mean speed over time \[m/s\].
    pub speed: Curve,
    /// The greatest that was found of it until the end \[m/s\].
    pub fastest: f64,
    /// Its shape over r, the distance from the axis over half the width; mean 1 after scaling.
    pub profile: Option<Curve>,
    /// Its own velocity \[m/s\].
    pub traverse: [f64; 3],
    /// From when to when it runs \[s\].
    pub runs: (f64, f64),
    /// Density of the water at rest \[kg/m3\], its spacing and its support \[m\].
    pub matter: (f64, f64, f64),
    /// 2 or 3.
    pub dimensions: usize,
    /// Whether the water has sound, and densities that change.
    pub has_sound: bool,
}

impl Nozzle {
    /// The greatest speed of its water on average until the end, with its own \[m/s\].
    #[must_use]
    pub fn most(&self) -> f64 {
        let [x, y, z] = self.traverse;
        self.fastest + x.hypot(y).hypot(z)
    }

    /// Length of the part before its exit where it leads particles \[m\].
    #[must_use]
    pub fn led(&self) -> f64 {
        let (_, spacing, support) = self.matter;
        spacing * ((support / spacing).ceil() + 1.0)
    }

    /// Whether a place is where it leads particles at the start.
    #[must_use]
    pub fn holds(&self, place: [f64; 3]) -> bool {
        let from = [0, 1, 2].map(|k| place[k] - self.exit[k]);
        let dot = |axis: [f64; 3]| -> f64 { (0..3).map(|k| from[k] * axis[k]).sum() };
        let margin = EDGE * self.matter.1;
        let along = dot(self.direction);
        let [a, b] = self.across.map(dot);
        let off = match self.dimensions {
            2 => a.abs(),
            _ => a.hypot(b),
        };
        along < -margin && along > margin - self.led() && off < 0.5 * self.width - margin
    }
}

/// A column of particles.
#[derive(Debug, Clone, Copy)]
struct Lane {
    /// From the axis \[m\].
    offset: [f64; 3],
    /// Speed over the mean.
    share: f64,
    /// Where its last particle is along the jet, from the exit \[m\].
    last: f64,
}

/// The stage.
pub struct Feed {
    nozzle: Nozzle,
    lanes: Vec<Lane>,
    /// Mass of a particle \[kg\].
    mass: f64,
    /// Length of the led part \[m\].
    length: f64,
    entered: f64,
    /// What the nozzle does to hold those that it leads: force and power.
    course: Course<4>,
    entry: Entry,
}

impl Feed {
    /// The stage of a nozzle.
    ///
    /// # Errors
    /// Says why its profile is none.
    pub fn new(nozzle: Nozzle) -> Result<Self, String> {
        let (density, spacing, _) = nozzle.matter;
        let (places, area) = cross_section(nozzle.width, spacing, nozzle.dimensions);
        let share = |r: f64| match &nozzle.profile {
            None => Ok(1.0),
            Some(curve) => {
                let at = Arguments {
                    r,
                    ..Arguments::default()
                };
                curve.value(&at).map_err(|e| e.to_string())
            }
        };
        let mut lanes = Vec::new();
        let length = nozzle.led();
        for [a, b] in places {
            let offset = [0, 1, 2].map(|k| a * nozzle.across[0][k] + b * nozzle.across[1][k]);
            let share = share(2.0 * a.hypot(b) / nozzle.width)?;
            if share.is_nan() || share < 0.0 {
                return Err(format!(
                    "is {share} at {} of half the width; at least 0",
                    2.0 * a.hypot(b) / nozzle.width
                ));
            }
            lanes.push(Lane {
                offset,
                share,
                last: 0.5 * spacing - length,
            });
        }
        let mean = lanes.iter().map(|lane| lane.share).sum::<f64>() / lanes.len() as f64;
        if mean <= 0.0 {
            return Err("is nowhere above 0".to_owned());
        }
        lanes.iter_mut().for_each(|lane| lane.share /= mean);
        Ok(Self {
            mass: density * area / lanes.len() as f64 * spacing,
            length,
            lanes,
            nozzle,
            entered: 0.0,
            course: Course::default(),
            entry: Entry::default(),
        })
    }

    /// Mean speed at a time \[m/s\].
    fn speed(&self, time: f64) -> Result<f64, StageError> {
        let (from, to) = self.nozzle.runs;
        if time < from || time >= to {
            return Ok(0.0);
        }
        let at = Arguments::at([0.0; 3], time);
        let speed = self.nozzle.speed.value(&at);
        let name = &self.nozzle.name;
        let speed = speed.map_err(|e| StageError::Data(format!("nozzle {name}: {e}")))?;
        if speed < 0.0 {
            let what = format!("nozzle {name}: {speed} m/s at {time} s; it does not suck");
            return Err(StageError::Data(what));
        }
        Ok(speed)
    }

    /// The middle of the exit at a time \[m\].
    fn exit(&self, time: f64) -> [f64; 3] {
        [0, 1, 2].map(|k| self.nozzle.exit[k] + time * self.nozzle.traverse[k])
    }

    fn velocity(&self, lane: &Lane, speed: f64) -> [f64; 3] {
        [0, 1, 2].map(|k| lane.share * speed * self.nozzle.direction[k] + self.nozzle.traverse[k])
    }

    /// The lane in which a place is.
    fn lane_of(&self, place: [f64; 3], exit: [f64; 3]) -> (usize, f64) {
        let from = [0, 1, 2].map(|k| place[k] - exit[k]);
        let along: f64 = (0..3).map(|k| from[k] * self.nozzle.direction[k]).sum();
        let square = |lane: &Lane| -> f64 {
            let off = |k: usize| from[k] - along * self.nozzle.direction[k] - lane.offset[k];
            (0..3).map(|k| off(k).powi(2)).sum()
        };
        let near = (0..self.lanes.len())
            .min_by(|a, b| square(&self.lanes[*a]).total_cmp(&square(&self.lanes[*b])));
        (near.unwrap_or(0), along)
    }

    /// A new particle of a lane.
    fn emit(&mut self, state: &mut State, lane: usize, along: f64, exit: [f64; 3], speed: f64) {
        let State { sets, ids, .. } = state;
        let set = &mut sets[self.nozzle.set];
        let row = set.push(ids);
        let Lane { offset, .. } = self.lanes[lane];
        let velocity = self.velocity(&self.lanes[lane], speed);
        set.column_mut(&POSITION)[row] =
            [0, 1, 2].map(|k| exit[k] + offset[k] + along * self.nozzle.direction[k]);
        set.column_mut(&VELOCITY)[row] = velocity;
        set.column_mut(&MASS)[row] = self.mass;
        set.column_mut(&DENSITY)[row] = self.nozzle.matter.0;
        set.column_mut(&LED)[row] = self.nozzle.mark;
        set.column_mut(&LISTED)[row] = [f64::NAN; 3];
        self.entry.bring(1.0, self.mass, velocity, 0.0);
        self.entered += self.mass;
        self.lanes[lane].last = along;
        state.exchanges += 1;
    }

    /// Where particles stand before the first step \[m\].
    #[must_use]
    pub fn places(&self) -> Vec<[f64; 3]> {
        let Nozzle {
            exit,
            direction,
            matter: (_, spacing, _),
            ..
        } = self.nozzle;
        let rows = (self.length / spacing).round() as usize;
        let along = (0..rows).map(|row| (row as f64 + 0.5) * spacing - self.length);
        let place = |along: f64, lane: &Lane| {
            [0, 1, 2].map(|k| exit[k] + lane.offset[k] + along * direction[k])
        };
        along
            .flat_map(|along| self.lanes.iter().map(move |lane| place(along, lane)))
            .collect()
    }

    /// Fills the led part before the first step.
    ///
    /// # Errors
    /// When the speed is none.
    pub fn fill(&mut self, state: &mut State) -> Result<(), StageError> {
        let speed = self.speed(0.0)?;
        let spacing = self.nozzle.matter.1;
        let rows = (self.length / spacing).round() as usize;
        for row in (0..rows).rev() {
            for lane in 0..self.lanes.len() {
                let along = (row as f64 + 0.5) * spacing - self.length;
                self.emit(state, lane, along, self.nozzle.exit, speed);
            }
        }
        // What stands there at the start has not come in.
        self.entry = Entry::default();
        self.entered = 0.0;
        Ok(())
    }
}

impl Stage for Feed {
    fn name(&self) -> &'static str {
        "nozzle"
    }

    fn declare(&self, state: &mut State) {
        state.sets[self.nozzle.set].declare(&LED);
    }

    fn limit(&self, _: &State) -> Option<Limit> {
        let shares = self.lanes.iter().map(|lane| lane.share);
        let fastest = shares.fold(0.0, f64::max) * self.nozzle.fastest;
        (!self.nozzle.has_sound && fastest > 0.0)
            .then(|| Limit::dividing("nozzle", LONGEST * self.nozzle.matter.1 / fastest))
    }

    fn flows(&self) -> bool {
        self.nozzle.has_sound
    }

    fn flow(&mut self, state: &mut State, _: f64) -> Result<(), StageError> {
        let set = &mut state.sets[self.nozzle.set];
        let mut rate = set.take(&DENSITY_RATE);
        let led = set.column(&LED);
        let mark = self.nozzle.mark;
        sweep::change(&mut rate, |a, rate| {
            if led[a] == mark {
                *rate = 0.0;
            }
        });
        set.put(&DENSITY_RATE, rate);
        Ok(())
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let time = state.time + dt;
        let speed = self.speed(time)?;
        let exit = self.exit(time);
        let set = &mut state.sets[self.nozzle.set];
        let (mut acceleration, mut velocity) = (set.take(&ACCELERATION), set.take(&VELOCITY));
        let (led, position) = (set.column(&LED), set.column(&POSITION));
        let mut holds = [0.0; 4];
        for a in (0..led.len()).filter(|a| led[*a] == self.nozzle.mark) {
            let (lane, _) = self.lane_of(position[a], exit);
            let told = self.velocity(&self.lanes[lane], speed);
            let (u, f) = (velocity[a], acceleration[a]);
            for k in 0..3 {
                holds[k] -= self.mass * f[k];
                holds[3] -= self.mass * f[k] * told[k];
                self.entry.impulse[k] += self.mass * (told[k] - u[k]);
                self.entry.work += 0.5 * self.mass * (told[k] * told[k] - u[k] * u[k]);
            }
            velocity[a] = told;
            acceleration[a] = [0.0; 3];
        }
        set.put(&ACCELERATION, acceleration);
        set.put(&VELOCITY, velocity);
        let [x, y, z, work] = self.course.over(dt, holds);
        let given = self.entry.impulse.iter_mut().zip([x, y, z]);
        given.for_each(|(sum, part)| *sum += part);
        self.entry.work += work;
        Ok(())
    }

    fn exchange(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let (begun, time) = (state.time, state.time + dt);
        let exit = self.exit(time);
        let speed = self.speed(time)?;
        let (gone, spacing) = (self.speed(begun)? * dt, self.nozzle.matter.1);
        let set = &mut state.sets[self.nozzle.set];
        let mut led = set.take(&LED);
        let position = set.column(&POSITION);
        sweep::change(&mut led, |a, led| {
            if *led == self.nozzle.mark && self.lane_of(position[a], exit).1 > 0.0 {
                *led = 0;
            }
        });
        set.put(&LED, led);
        for lane in 0..self.lanes.len() {
            let Lane { share, .. } = self.lanes[lane];
            if share * gone > spacing {
                let what = format!(
                    "nozzle {}: its water goes {} m in a step of {dt} s, further than the spacing of {spacing} m; \
                     give a smaller 'step_s'",
                    self.nozzle.name,
                    share * gone
                );
                return Err(StageError::Data(what));
            }
            self.lanes[lane].last += share * gone;
            let next = self.lanes[lane].last - spacing;
            if next >= -self.length - 0.5 * spacing && speed > 0.0 {
                self.emit(state, lane, next, exit, speed);
            }
        }
        Ok(())
    }

    fn entry(&self, _: &State) -> Entry {
        self.entry
    }

    fn figures(&self, _: &State) -> Vec<Figure> {
        vec![Figure {
            name: format!("{}_entered", self.nozzle.name),
            unit: "kg",
            value: self.entered,
        }]
    }

    fn warning(&self, state: &State) -> Option<String> {
        let (from, _) = self.nozzle.runs;
        (state.time <= from && from > 0.0).then(|| {
            format!(
                "nozzle {} brought no water: its 'start_s' of {from} s is not before the end at {} s",
                self.nozzle.name, state.time
            )
        })
    }

    fn save(&self) -> Vec<f64> {
        let mut saved = [&self.entry.save()[..], &self.course.last(), &[self.entered]].concat();
        saved.extend(self.lanes.iter().map(|lane| lane.last));
        saved
    }

    fn restore(&mut self, _: &State, saved: &[f64]) {
        let rest = self.entry.restore(saved);
        if let [entered, lasts @ ..] = self.course.restore(rest) {
            self.entered = *entered;
            let lanes = self.lanes.iter_mut().zip(lasts);
            lanes.for_each(|(lane, last)| lane.last = *last);
        }
    }
}
