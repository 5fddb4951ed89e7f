//! What is told of drops that meet and part.

use artefact::{Frame, Precision, Record};

use super::{Group, Groups, Parcel, Seen};
use crate::liquid::matter::Matter;
use crate::liquid::vector::{along, dot};

/// All drops and parcels together.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Totals {
    /// Drops and parcels.
    pub counts: [usize; 2],
    /// Volume, and that of parcels in it \[m3\].
    pub volume: [f64; 2],
    /// Area of drops \[m2\].
    pub area: f64,
    /// Centre \[m\].
    pub centre: [f64; 3],
    /// Its velocity: momentum over mass \[m/s\].
    pub drift: [f64; 3],
    /// Energies \[J\].
    pub kinetic: f64,
    /// Of the surfaces of drops; parcels have none.
    pub surface: f64,
    /// Of all in the field of gravity.
    pub potential: f64,
    /// Length along x, y and z from one end of the drops to the other \[m\].
    pub extent: [f64; 3],
}

impl Groups {
    /// Totals of drops, as their surfaces and points have them, and of parcels.
    #[must_use]
    pub fn totals(&self, seen: &[Seen], matter: &Matter<3>) -> Totals {
        let mut sum = Totals {
            counts: [self.drops.len(), self.parcels.len()],
            ..Totals::default()
        };
        let half = 0.5 * matter.density;
        for (group, seen) in self.drops.iter().zip(seen) {
            sum.add(seen.hull.volume, &seen.hull.centre, &group.moves(seen));
            sum.area += seen.hull.area;
            let all = seen.volumes.iter().zip(&group.liquid.velocity);
            sum.kinetic += half * all.map(|(v, u)| v * dot(u, u)).sum::<f64>();
        }
        for parcel in &self.parcels {
            sum.add(parcel.volume, &parcel.centre, &parcel.drift);
            sum.volume[1] += parcel.volume;
            sum.kinetic += half * parcel.volume * dot(&parcel.drift, &parcel.drift);
        }
        let over = sum.volume[0].recip();
        sum.centre = sum.centre.map(|c| c * over);
        sum.drift = sum.drift.map(|c| c * over);
        sum.surface = matter.tension * sum.area;
        let mass = matter.density * sum.volume[0];
        sum.potential = -mass * dot(&matter.gravity, &sum.centre);
        let skins = self.drops.iter();
        let skins = skins.flat_map(|g| &g.liquid.position[..g.liquid.surface()]);
        let places: Vec<[f64; 3]> = skins.copied().collect();
        sum.extent = std::array::from_fn(|k| {
            let along = places.iter().map(|x| x[k]);
            let high = along.clone().fold(f64::NEG_INFINITY, f64::max);
            let low = along.fold(f64::INFINITY, f64::min);
            (high - low).max(0.0)
        });
        sum
    }

    /// A frame with a point for each drop and each parcel, with charges where they are conductors.
    #[must_use]
    pub fn frame(&self, charged: bool, precision: Precision) -> Frame {
        let drops = self.drops.iter().map(Group::parcel);
        let all: Vec<Parcel> = drops.chain(self.parcels.iter().copied()).collect();
        let shaped = (0..all.len()).map(|k| u8::from(k < self.drops.len()));
        let frame = Frame::new(precision)
            .positions(all.iter().map(|p| p.centre))
            .vector("velocity", "m/s", all.iter().map(|p| p.drift))
            .scalar("volume", "m3", all.iter().map(|p| p.volume))
            .flag("shaped", shaped);
        if charged {
            frame.scalar("charge", "C", all.iter().map(|p| p.charge))
        } else {
            frame
        }
    }
}

impl Totals {
    fn add(&mut self, volume: f64, centre: &[f64; 3], drift: &[f64; 3]) {
        self.volume[0] += volume;
        self.centre = along(&self.centre, volume, centre);
        self.drift = along(&self.drift, volume, drift);
    }

    /// The sum of the energies, which friction alone lessens \[J\].
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.kinetic + self.surface + self.potential
    }

    /// A row of numbers.
    #[must_use]
    pub fn row(&self) -> Record {
        let [drops, parcels] = self.counts.map(|n| n as f64);
        let [volume, strewn] = self.volume;
        let mut record = Record::new()
            .with("drops", "1", drops)
            .with("parcels", "1", parcels)
            .with("volume", "m3", volume)
            .with("volume_parcels", "m3", strewn)
            .with("area", "m2", self.area);
        for (k, axis) in ["x", "y", "z"].iter().enumerate() {
            record = record
                .with(&format!("extent_{axis}"), "m", self.extent[k])
                .with(&format!("centre_{axis}"), "m", self.centre[k])
                .with(&format!("velocity_{axis}"), "m/s", self.drift[k]);
        }
        record
            .with("kinetic_energy", "J", self.kinetic)
            .with("surface_energy", "J", self.surface)
    }
}
