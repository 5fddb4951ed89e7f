//! A heat flux over the distance from the axis of the arc.

use std::sync::Arc;

use props::Table;
use run::property::{Arguments, Curve};

use super::cathode::Emitter;
use super::film::Film;
use crate::mean;
use crate::stage::StageError;

/// Distance from the axis within which a formula is taken as its mean over squares, in spacings.
const NEAR: f64 = 2.5;
/// Parts of a side of a square.
const PARTS: u32 = 8;
/// Share of a square's flux on one of its parts from which on it is not resolved.
const NARROW: f64 = 0.6;

/// A flux by name.
pub(super) struct Flux {
    /// Of the energy that it puts in.
    pub(super) name: &'static str,
    law: Law,
}

/// What a flux follows.
pub(super) enum Law {
    /// Zero beyond the last row.
    Table(Table),
    Curve(Curve),
    Electrons(Arc<Emitter>),
    Ions(Arc<Emitter>),
    Film(Film),
}

impl Flux {
    pub(super) fn new(name: &'static str, law: Law) -> Self {
        Self { name, law }
    }

    /// The flux at the distance `r` \[m\] into metal of `t` \[K\] \[W/m2\], that of a formula as its mean from `time`
    /// over `dt` \[s\]; and whether all of it was found.
    pub(super) fn at(&self, r: f64, t: f64, time: f64, dt: f64) -> Result<(f64, bool), StageError> {
        if r > self.reach() {
            return Ok((0.0, true));
        }
        let value = match &self.law {
            Law::Table(table) => table.held(r),
            Law::Electrons(emitter) => emitter.electrons(r, t),
            Law::Ions(emitter) => emitter.ions(r, t),
            Law::Film(film) => film.heat(r, t),
            Law::Curve(curve) => {
                let at = Arguments {
                    r,
                    time,
                    ..Arguments::default()
                };
                let mean = mean::in_time(curve, &at, dt);
                return mean
                    .map_err(|fault| StageError::Data(format!("heat flux of the arc: {fault}")));
            }
        };
        Ok((value, true))
    }

    /// The same on the square of the side `d` \[m\] that a particle has of the plan, `from` the axis; near the axis that of a formula is its
    /// mean over the square, so that none is too narrow for the particles. Not found is one that falls on one part of
    /// the square under the axis.
    pub(super) fn over(
        &self,
        from: [f64; 2],
        d: f64,
        t: f64,
        times: [f64; 2],
    ) -> Result<(f64, bool), StageError> {
        let [time, dt] = times;
        let r = (from[0] * from[0] + from[1] * from[1]).sqrt();
        if !self.is_formula() || r > NEAR * d {
            return self.at(r, t, time, dt);
        }
        self.even(from, d, t, times)
    }

    /// Its mean on the square of the side `d` \[m\], `from` the axis.
    pub(super) fn even(
        &self,
        from: [f64; 2],
        d: f64,
        t: f64,
        times: [f64; 2],
    ) -> Result<(f64, bool), StageError> {
        let [time, dt] = times;
        let (mut sum, mut most, mut whole) = (0.0, 0.0_f64, true);
        for i in 0..PARTS {
            for j in 0..PARTS {
                let off = [i, j].map(|k| d * ((f64::from(k) + 0.5) / f64::from(PARTS) - 0.5));
                let (value, found) =
                    self.at((from[0] + off[0]).hypot(from[1] + off[1]), t, time, dt)?;
                (sum, most) = (sum + value, most.max(value.abs()));
                whole &= found;
            }
        }
        let under = from.iter().all(|x| x.abs() <= 0.5 * d);
        whole &= !under || most <= NARROW * sum.abs();
        Ok((sum / f64::from(PARTS * PARTS), whole))
    }

    /// Temperature of the metal from which on it is known \[K\].
    pub(super) fn lowest(&self) -> f64 {
        match &self.law {
            Law::Film(film) => film.lowest(),
            _ => 0.0,
        }
    }

    /// Its table, if it follows one.
    pub(super) fn table(&self) -> Option<&Table> {
        match &self.law {
            Law::Table(table) => Some(table),
            _ => None,
        }
    }

    /// Whether it is a formula in the distance from the axis and in time.
    pub(super) fn is_formula(&self) -> bool {
        matches!(self.law, Law::Curve(_))
    }

    /// Distance beyond which there is nothing \[m\].
    pub(super) fn reach(&self) -> f64 {
        match &self.law {
            Law::Table(table) => table.last(),
            Law::Curve(_) => f64::INFINITY,
            Law::Electrons(emitter) | Law::Ions(emitter) => emitter.reach(),
            Law::Film(film) => film.reach(),
        }
    }

    /// Greatest fall with the temperature of the metal, below `hottest` \[K\] \[W/(m2 K)\]; the ions
    /// bring that of the electrons along.
    pub(super) fn steepest(&self, hottest: f64) -> f64 {
        match &self.law {
            Law::Table(_) | Law::Curve(_) | Law::Electrons(_) => 0.0,
            Law::Ions(emitter) => emitter.steepest(hottest),
            Law::Film(film) => film.steepest(),
        }
    }
}
