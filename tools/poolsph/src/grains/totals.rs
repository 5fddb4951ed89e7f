//! Mass, momentum and energy of all grains.

use artefact::Record;
use particles::{POSITION, Set, sweep};
use shapes::frame::{cross, dot};

use super::columns::ENTHALPY;
use super::{FORCE, MASS, RADIUS, SPIN, VELOCITY};

/// Sums over all grains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Totals {
    /// Number of grains.
    pub number: usize,
    /// Mass \[kg\].
    pub mass: f64,
    /// Momentum \[kg m/s\].
    pub momentum: [f64; 3],
    /// Angular momentum about the origin, spins among it \[kg m2/s\].
    pub angular_momentum: [f64; 3],
    /// Kinetic energy of the centres \[J\].
    pub kinetic: f64,
    /// Kinetic energy of the spins \[J\].
    pub rotational: f64,
    /// Force of all walls on the grains \[N\].
    pub held: [f64; 3],
    /// Mean height \[m\].
    pub height: f64,
    /// Enthalpy \[J\], where grains have one.
    pub stored: Option<f64>,
}

impl Totals {
    /// The sums over `set`, whose grains have an inertia of the factor `c`.
    #[must_use]
    pub fn of(set: &Set, c: f64) -> Self {
        let (place, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
        let (spin, mass) = (set.column(&SPIN), set.column(&MASS));
        let (radius, force) = (set.column(&RADIUS), set.column(&FORCE));
        let sums = sweep::sum(set.len(), |a| {
            let m = mass[a];
            let inertia = c * m * radius[a] * radius[a];
            let turning = cross(place[a], velocity[a]);
            let angular = [0, 1, 2].map(|k| m * turning[k] + inertia * spin[a][k]);
            let [p, q, r] = velocity[a].map(|u| m * u);
            let [x, y, z] = angular;
            let [f, g, h] = force[a];
            let kinetic = 0.5 * m * dot(velocity[a], velocity[a]);
            let rotational = 0.5 * inertia * dot(spin[a], spin[a]);
            [
                m,
                p,
                q,
                r,
                x,
                y,
                z,
                kinetic,
                rotational,
                m * place[a][2],
                f,
                g,
                h,
            ]
        });
        let [mass, p, q, r, x, y, z, kinetic, rotational, height, f, g, h] = sums;
        Self {
            number: set.len(),
            mass,
            momentum: [p, q, r],
            angular_momentum: [x, y, z],
            kinetic,
            rotational,
            held: [f, g, h],
            stored: set.has(&ENTHALPY).then(|| {
                let (enthalpy, mass) = (set.column(&ENTHALPY), set.column(&MASS));
                sweep::sum(set.len(), |a| [mass[a] * enthalpy[a]])[0]
            }),
            height: if mass > 0.0 { height / mass } else { 0.0 },
        }
    }

    /// For the closing block: name, unit, value.
    #[must_use]
    pub fn closing(&self) -> Vec<(&'static str, &'static str, f64)> {
        vec![
            ("grains", "1", self.number as f64),
            ("grains_mass_kg", "kg", self.mass),
            (
                "grains_kinetic_energy_j",
                "J",
                self.kinetic + self.rotational,
            ),
        ]
    }

    /// As written to `/grains_balance`.
    #[must_use]
    pub fn record(&self, time: f64) -> Record {
        let mut record = Record::new()
            .with("time_s", "s", time)
            .with("grains", "1", self.number as f64)
            .with("mass_kg", "kg", self.mass);
        let vectors = [
            ("momentum", "kg m/s", self.momentum),
            ("angular_momentum", "kg m2/s", self.angular_momentum),
            ("contact_force", "N", self.held),
        ];
        for (name, unit, vector) in vectors {
            for (axis, value) in ["x", "y", "z"].into_iter().zip(vector) {
                record = record.with(&format!("{name}_{axis}"), unit, value);
            }
        }
        if let Some(stored) = self.stored {
            record = record.with("enthalpy_j", "J", stored);
        }
        record
            .with("kinetic_energy_j", "J", self.kinetic)
            .with("rotational_energy_j", "J", self.rotational)
            .with("centre_of_mass_height_m", "m", self.height)
    }
}
