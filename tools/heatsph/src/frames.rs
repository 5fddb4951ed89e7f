//! What is written: frames of points, monitors, heat through the surface, the balance of heat.

use artefact::{Frame, Precision, Record, one_time};
use run::{Failure, Session};
use steps::instants::{Instant, every, merged};

use crate::march::State;
use crate::monitor::Monitor;
use crate::scene::Scene;
use crate::system::storage::Storage;
use crate::system::{Rates, System};

/// Part of the heat of a body that is none.
const NOTHING: f64 = 1e-10;
/// Part of the heat that has moved by which the balance of a march may be off: its solves leave 1e-8.
const UNBALANCED: f64 = 1e-6;

/// What is written, and what was there at the start.
#[derive(Debug, Clone)]
pub struct Output {
    precision: Precision,
    monitors: Vec<Monitor>,
    events: Vec<Instant>,
    /// Temperatures at the start \[K\].
    first: Vec<f64>,
    /// Heats of the cells then \[J\], where capacities depend on temperature.
    heat: Vec<f64>,
    outer: Vec<u8>,
}

impl Output {
    /// The output of a scene whose points begin with the given temperatures.
    #[must_use]
    pub fn new(scene: &Scene, system: &System, temperature: &[f64]) -> Self {
        let mut outer = vec![0; system.len()];
        for patch in &system.cloud.patches {
            outer[patch.point as usize] = 1;
        }
        Self {
            precision: scene.output.precision.into(),
            monitors: scene
                .output
                .monitors
                .iter()
                .map(|m| Monitor::new(&m.name, &m.place_m, &system.cloud))
                .collect(),
            events: events(scene),
            first: temperature.to_vec(),
            heat: State::new(system, temperature.to_vec()).heat,
            outer,
        }
    }

    /// All instants, rising, from the start to the end.
    #[must_use]
    pub fn events(&self) -> Vec<Instant> {
        self.events.clone()
    }

    /// Writes what an event asks for.
    ///
    /// # Errors
    /// When a value is no number or the disk refuses.
    pub fn write(
        &mut self,
        system: &System,
        state: &State,
        rates: &Rates,
        event: Instant,
        session: &mut Session,
    ) -> Result<(), Failure> {
        if event.whole {
            session.frame("/points", event.time, &self.frame(system, state))?;
        }
        if !self.monitors.is_empty() {
            let mut record = Record::new();
            for monitor in &self.monitors {
                record = record.with(&monitor.name, "K", monitor.temperature(&state.temperature));
            }
            session.record("/monitors", event.time, &record)?;
        }
        if !system.surface.is_insulated() {
            session.record("/boundaries", event.time, &boundaries(system, state, rates))?;
        }
        session.record("/balance", event.time, &self.balance(system, state))
    }

    fn frame(&self, system: &System, state: &State) -> Frame {
        let t = &state.temperature;
        let conductivity = (0..system.len()).map(|i| system.conductivity(i, t[i]));
        let mut frame = Frame::new(self.precision)
            .positions(system.cloud.position.iter().copied())
            .scalar("temperature", "K", t.iter().copied())
            .scalar("conductivity", "W/(m K)", conductivity);
        let unit = if system.cloud.dimensions == 2 {
            "m2"
        } else {
            "m3"
        };
        frame = frame.scalar("volume", unit, system.links.volume.iter().copied());
        if system.materials.len() > 1 {
            frame = frame.flag("material", system.material.iter().map(|m| *m as u8));
        }
        frame.flag("boundary", self.outer.iter().copied())
    }

    /// Heat stored since the start, and the sum of what each point has stored or given up \[J\].
    fn stored(&self, system: &System, state: &State) -> (f64, f64) {
        let risen = |i: usize| match &system.storage {
            Storage::Fixed(capacity) => capacity[i] * (state.temperature[i] - self.first[i]),
            Storage::Varies(_) => state.heat[i] - self.heat[i],
        };
        (0..system.len())
            .map(risen)
            .fold((0.0, 0.0), |(sum, gross), heat| {
                (sum + heat, gross + heat.abs())
            })
    }

    /// The balance of heat since the start.
    fn balance(&self, system: &System, state: &State) -> Record {
        let (stored, _) = self.stored(system, state);
        let through: f64 = state.entries.iter().sum();
        let (joule, _) = units(system);
        let mut record =
            Record::new()
                .with("stored", joule, stored)
                .with("boundaries", joule, through);
        if system.has_source() {
            record = record.with("source", joule, state.source);
        }
        record.with("imbalance", joule, stored - through - state.source)
    }

    /// Totals of a march.
    pub fn close(&self, system: &System, state: &State, session: &mut Session) {
        let (stored, moved) = self.stored(system, state);
        let through: f64 = state.entries.iter().sum();
        let gross: f64 = state.entries.iter().map(|e| e.abs()).sum();
        // What rounding leaves of what a body holds is no heat that has moved.
        let held: f64 = system.stored(&self.first).abs();
        let whole = moved.max(gross).max(state.source.abs()).max(NOTHING * held);
        let imbalance = (stored - through - state.source).abs();
        let (joule, _) = units(system);
        session.closing("heat_stored", joule, stored);
        session.closing("heat_boundaries", joule, through);
        if system.has_source() {
            session.closing("heat_source", joule, state.source);
        }
        if let Some(torches) = &system.torches {
            torches.close(state.time, &system.cloud, session);
        }
        let relative = if whole > 0.0 { imbalance / whole } else { 0.0 };
        session.closing("energy_balance", "1", relative);
        if relative.is_nan() || relative > UNBALANCED {
            session.warn(format!(
                "heat stored and heat that came in differ by {relative:.1e} of what has moved, beyond {UNBALANCED:.0e}"
            ));
        }
    }
}

/// Writes a steady state and its totals.
///
/// # Errors
/// When a value is no number or the disk refuses.
pub fn steady(
    scene: &Scene,
    system: &System,
    state: &State,
    rates: &Rates,
    session: &mut Session,
) -> Result<(), Failure> {
    let mut output = Output::new(scene, system, &state.temperature);
    output.write(system, state, rates, Instant::whole(0.0), session)?;
    let (_, watt) = units(system);
    let through: f64 = rates.entries.iter().sum();
    let gross: f64 = rates.entries.iter().map(|e| e.abs()).sum::<f64>() + rates.source.abs();
    for (name, heat) in system.surface.names.iter().zip(&rates.entries) {
        session.closing(&format!("heat_rate {name}"), watt, *heat);
    }
    if system.has_source() {
        session.closing("heat_rate source", watt, rates.source);
    }
    let relative = if gross > 0.0 {
        (through + rates.source).abs() / gross
    } else {
        0.0
    };
    session.closing("energy_balance", "1", relative);
    Ok(())
}

/// Units of heat and of its rate: per metre of depth in a plane scene.
fn units(system: &System) -> (&'static str, &'static str) {
    if system.cloud.dimensions == 2 {
        ("J/m", "W/m")
    } else {
        ("J", "W")
    }
}

/// Area, heat rate, heat since the start and mean temperature of each entry of the surface.
fn boundaries(system: &System, state: &State, rates: &Rates) -> Record {
    let surface = &system.surface;
    let mut mean = vec![(0.0, 0.0); surface.conditions.len()];
    for film in &surface.films {
        for entry in &film.entries {
            let (sum, area) = &mut mean[*entry as usize];
            *sum += film.area * state.temperature[film.point as usize];
            *area += film.area;
        }
    }
    for held in &surface.held {
        let (sum, area) = &mut mean[held.entry as usize];
        let own = system.cloud.spacing[held.point as usize];
        *sum += own * state.temperature[held.point as usize];
        *area += own;
    }
    let mut record = Record::new();
    for (entry, name) in surface.names.iter().enumerate() {
        let unit = if system.cloud.dimensions == 2 {
            ("m", "W/m", "J/m")
        } else {
            ("m2", "W", "J")
        };
        let (sum, area) = mean[entry];
        record = record
            .with(&format!("{name}.area"), unit.0, surface.area[entry])
            .with(&format!("{name}.heat_rate"), unit.1, rates.entries[entry])
            .with(&format!("{name}.heat"), unit.2, state.entries[entry])
            .with(&format!("{name}.temperature"), "K", sum / area);
    }
    record
}

/// When something is written: all, or records alone.
fn events(scene: &Scene) -> Vec<Instant> {
    let Some(time) = &scene.time else {
        return vec![Instant::whole(0.0)];
    };
    let output = &scene.output;
    let every = |interval: Option<f64>, whole: bool| {
        let times = interval.into_iter().flat_map(|s| every(s, time.end_s));
        times.map(move |time| Instant { time, whole })
    };
    let typed = output.at_s.iter().map(|t| Instant::whole(*t));
    let frames = typed.chain(every(output.every_s, true));
    let all = frames.chain(every(output.monitors_every_s, false));
    merged(all.collect(), time.end_s, one_time)
}
