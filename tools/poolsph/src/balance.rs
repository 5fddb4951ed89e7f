//! Mass, momentum and energy of all metal, and whether they close.

use artefact::Record;
use particles::POSITION;
use steps::Figure;

use crate::domain::bounds::SPATTER;
use crate::state::{DROPLET, ENTHALPY, PHASE, State, VELOCITY, WALL, marked, phase};

/// An energy balance that closes to this part is good.
pub const CLOSES: f64 = 5e-3;

/// More of the fed metal than this part thrown off is no weld that anybody means.
pub const LOST_MOST: f64 = 0.05;

/// Conserved totals at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    time: f64,
    liquid: usize,
    mass: f64,
    from_wire: f64,
    momentum: [f64; 3],
    kinetic: f64,
    height: f64,
    /// Masses that stages tell \[kg\].
    masses: Vec<(&'static str, f64)>,
    heat: Option<Heat>,
}

/// Figures of one unit, by name.
fn of_unit(figures: &[(&'static str, Figure)], unit: &str) -> Vec<(&'static str, f64)> {
    let found = figures.iter().filter(|(_, figure)| figure.unit == unit);
    found
        .map(|(_, figure)| (figure.name, figure.value))
        .collect()
}

/// The energies of a scene with heat.
#[derive(Debug, Clone, PartialEq)]
struct Heat {
    /// Enthalpy of all metal \[J\].
    stored: f64,
    /// Cumulative sums of the stages \[J\].
    parts: Vec<(&'static str, f64)>,
}

/// Totals at the start, against which later ones are held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// Mass of the bodies \[kg\].
    pub mass: f64,
    /// Enthalpy of the bodies \[J\].
    pub stored: f64,
}

impl Balance {
    /// The totals of `state`, with the cumulative energies among `figures`.
    #[must_use]
    pub fn of(state: &State, figures: &[(&'static str, Figure)]) -> Self {
        let mass = state.metal.matter.mass();
        let (places, velocities) = (state.metal.column(&POSITION), state.metal.column(&VELOCITY));
        let (phases, wall) = (state.metal.column(&PHASE), state.metal.column(&WALL));
        let metal = || (0..state.len()).filter(|a| !marked(wall, *a));
        let mut momentum = [0.0; 3];
        let mut kinetic = 0.0;
        // Particles by their mass in that of one of metal, and their heights.
        let (mut count, mut height) = (0.0, 0.0);
        for a in metal() {
            let part = state.mass(a) / mass;
            let mass = part * mass;
            count += part;
            height += part * places[a][2];
            if phases[a] != phase::SOLID {
                let u = velocities[a];
                (0..3).for_each(|k| momentum[k] += mass * u[k]);
                kinetic += 0.5 * mass * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
            }
        }
        let enthalpies = state.metal.column(&ENTHALPY);
        let heat = (!enthalpies.is_empty()).then(|| Heat {
            stored: match state.slag {
                None => mass * enthalpies.iter().sum::<f64>(),
                Some(_) => (enthalpies.iter().enumerate())
                    .map(|(a, own)| state.mass(a) * own)
                    .sum(),
            },
            parts: of_unit(figures, "J"),
        });
        Self {
            time: state.time,
            liquid: state.liquid(),
            mass: mass * count,
            from_wire: mass * state.metal.column(&DROPLET).iter().filter(|d| **d).count() as f64,
            momentum,
            kinetic,
            height: if count > 0.0 { height / count } else { 0.0 },
            masses: of_unit(figures, "kg"),
            heat,
        }
    }

    /// What later balances are held against.
    #[must_use]
    pub fn start(&self) -> Start {
        Start {
            mass: self.mass - self.from_wire,
            stored: self.heat.as_ref().map_or(0.0, |heat| heat.stored),
        }
    }

    /// (mass - start - droplets) / mass.
    #[must_use]
    pub fn mass_error(&self, start: Start) -> f64 {
        (self.mass - self.from_wire - start.mass) / self.mass.max(f64::MIN_POSITIVE)
    }

    /// Energy in, energy out \[J\], and (in - out - stored) over the larger of them; `None` without heat.
    #[must_use]
    pub fn closure(&self, start: Start) -> Option<(f64, f64, f64)> {
        let heat = self.heat.as_ref()?;
        let sum = |prefix: &str| -> f64 {
            let parts = heat
                .parts
                .iter()
                .filter(|(name, _)| name.starts_with(prefix));
            parts
                .map(|(_, value)| value)
                .fold(0.0, |sum, value| sum + value)
        };
        let (input, output) = (sum("energy_in_"), sum("energy_out_"));
        let scale = input.abs().max(output.abs());
        let missing = input - output - (heat.stored - start.stored);
        let closure = if scale > 0.0 { missing / scale } else { 0.0 };
        Some((input, output, closure))
    }

    /// Spatter over the metal that was fed; `None` where none is fed or none is followed.
    #[must_use]
    pub fn lost(&self) -> Option<f64> {
        let (_, spatter) = self.masses.iter().find(|(name, _)| *name == SPATTER)?;
        (self.from_wire > 0.0).then(|| spatter / self.from_wire)
    }

    /// The totals as written to `/balance`.
    #[must_use]
    pub fn record(&self, start: Start) -> Record {
        let mut record = Record::new()
            .with("time_s", "s", self.time)
            .with("liquid_particles", "1", self.liquid as f64)
            .with("mass_kg", "kg", self.mass)
            .with("mass_droplets_kg", "kg", self.from_wire)
            .with("momentum_x", "kg m/s", self.momentum[0])
            .with("momentum_y", "kg m/s", self.momentum[1])
            .with("momentum_z", "kg m/s", self.momentum[2])
            .with("kinetic_energy_j", "J", self.kinetic)
            .with("centre_of_mass_height_m", "m", self.height);
        for (name, value) in &self.masses {
            record = record.with(name, "kg", *value);
        }
        if let (Some(heat), Some((_, _, closure))) = (&self.heat, self.closure(start)) {
            record = record.with("energy_stored_j", "J", heat.stored - start.stored);
            for (name, value) in &heat.parts {
                record = record.with(name, "J", *value);
            }
            record = record.with("closure", "1", closure);
        }
        record
    }

    /// The totals of the closing block: name, unit, value.
    #[must_use]
    pub fn closing(&self, start: Start) -> Vec<(&'static str, &'static str, f64)> {
        let mut rows = vec![
            ("mass_kg", "kg", self.mass),
            ("mass_droplets_kg", "kg", self.from_wire),
            ("mass_error", "1", self.mass_error(start)),
        ];
        rows.extend(
            self.masses
                .iter()
                .map(|(name, value)| (*name, "kg", *value)),
        );
        rows.extend(self.lost().map(|share| ("spatter_of_fed", "1", share)));
        if let (Some(heat), Some((input, output, closure))) = (&self.heat, self.closure(start)) {
            rows.extend(heat.parts.iter().map(|(name, value)| (*name, "J", *value)));
            rows.push(("energy_in_j", "J", input));
            rows.push(("energy_out_j", "J", output));
            rows.push(("energy_stored_j", "J", heat.stored - start.stored));
            rows.push(("energy_balance", "1", closure));
        }
        rows
    }
}

/// What to warn of where more of the fed metal is thrown off than a weld loses.
#[must_use]
pub fn thrown(share: f64) -> Option<String> {
    (share > LOST_MOST).then(|| {
        format!(
            "{:.1} % of the fed metal is thrown off, at most {:.0} % is good",
            1e2 * share,
            1e2 * LOST_MOST
        )
    })
}

/// What to warn of where the energy does not close, by (in - out - stored) over the larger of in and out.
#[must_use]
pub fn unclosed(closure: f64) -> Option<String> {
    // A closure that is no number closes nothing.
    let closes = closure.abs() <= CLOSES;
    (!closes).then(|| {
        format!(
            "the energy balance is open by {closure:.1e} of the energy put in or lost, at most {CLOSES:.0e} is good"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Particle;
    use particles::Matter;

    fn state(enthalpy: f64) -> State {
        let metal = Matter {
            density: 1000.0,
            spacing: 1e-2,
            smoothing_length: 1e-2,
        };
        let mut state = State::new(metal);
        state.metal.declare(&ENTHALPY);
        for (phase, wall) in [
            (phase::LIQUID, false),
            (phase::SOLID, false),
            (phase::SOLID, true),
        ] {
            state.push(Particle {
                position: [0.0, 0.0, 0.5],
                velocity: [0.0, 2.0, 0.0],
                phase,
                droplet: false,
                wall,
                temperature: 300.0,
                enthalpy,
            });
        }
        state
    }

    fn figure(name: &'static str, value: f64) -> (&'static str, Figure) {
        let unit = if name.ends_with("_j") { "J" } else { "1" };
        ("stage", Figure { name, unit, value })
    }

    #[test]
    fn walls_have_no_mass_and_solids_no_momentum() {
        let balance = Balance::of(&state(0.0), &[]);
        let record = balance.record(balance.start());
        assert!((record.get("mass_kg").unwrap() - 2e-3).abs() < 1e-18);
        assert!((record.get("momentum_y").unwrap() - 2e-3).abs() < 1e-18);
        assert!((record.get("kinetic_energy_j").unwrap() - 2e-3).abs() < 1e-18);
        assert!(balance.mass_error(balance.start()).abs() < 1e-15);
    }

    #[test]
    fn energy_that_goes_missing_is_seen() {
        let start = Balance::of(&state(0.0), &[]).start();
        let figures = [
            figure("energy_in_arc_j", 4.0),
            figure("energy_out_radiation_j", 1.0),
            figure("sweeps", 7.0),
        ];
        // Three particles of 1 g with 1000 J/kg hold 3 J.
        let (_, _, closed) = Balance::of(&state(1000.0), &figures)
            .closure(start)
            .unwrap();
        assert!(closed.abs() < 1e-15);
        let (_, _, open) = Balance::of(&state(900.0), &figures).closure(start).unwrap();
        assert!((open - 0.3 / 4.0).abs() < 1e-15);
    }

    #[test]
    fn an_open_energy_balance_is_warned_of() {
        for closed in [0.0, 4.9e-3, -5e-3] {
            assert_eq!(unclosed(closed), None);
        }
        for open in [5.1e-3, -0.2, f64::NAN] {
            assert!(unclosed(open).is_some_and(|text| text.contains("5e-3")));
        }
    }

    #[test]
    fn fed_metal_that_is_thrown_off_is_warned_of() {
        let mut fed = state(0.0);
        fed.metal.declare(&DROPLET);
        fed.metal.set(&DROPLET, 0, true);
        let caught = |value: f64| {
            let figure = Figure {
                name: SPATTER,
                unit: "kg",
                value,
            };
            Balance::of(&fed, &[("bounds", figure)])
        };
        // One particle of 1 g is fed.
        assert_eq!(caught(4.9e-5).lost().and_then(thrown), None);
        let balance = caught(6e-5);
        let told = balance.lost().and_then(thrown).unwrap();
        assert!(told.contains("6.0 %"), "{told}");
        let rows = balance.closing(balance.start());
        assert!(rows.iter().any(|row| row.0 == "spatter_of_fed"));
        // Nothing is fed, or nobody looks.
        assert_eq!(Balance::of(&fed, &[]).lost(), None);
        assert_eq!(Balance::of(&state(0.0), &[]).lost(), None);
    }

    #[test]
    fn lost_mass_is_seen() {
        let start = Balance::of(&state(0.0), &[]).start();
        let mut fewer = state(0.0);
        fewer.metal.declare(&WALL);
        fewer.metal.set(&WALL, 1, true);
        assert!(Balance::of(&fewer, &[]).mass_error(start) < -0.9);
    }
}
