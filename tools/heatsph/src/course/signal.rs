//! Properties that depend on time, at some of the places where they act.

use run::property::{Arguments, Bounds, Curve};

use super::pieces::{Pieces, Varies};
use crate::boundary::Condition;
use crate::material::arguments;
use crate::source::Source;
use crate::system::System;
use shapes::frame::Vector;

/// Most places at which a property is followed.
const PLACES: usize = 32;

/// What a property does.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Acts {
    /// It is a temperature.
    Temperature,
    /// It brings heat, which makes this difference of temperature over a spacing for each of its unit.
    Heat(f64),
    /// It is a factor.
    Factor,
}

/// A property that varies in time.
pub(super) struct Signal<'a> {
    curve: &'a Curve,
    places: Vec<Arguments>,
    acts: Acts,
}

/// All properties of a system that depend on time; `temperature` is that of the points.
pub(super) fn signals<'a>(system: &'a System, temperature: &[f64]) -> Vec<Signal<'a>> {
    let mut found = Vec::new();
    let mut add = |curve: &'a Curve, places: &dyn Fn() -> Vec<Arguments>, acts: Acts| {
        found.extend(Signal::new(curve, places, acts));
    };
    let at = |x: Vector| Arguments::at(x, 0.0);
    for (entry, condition) in system.surface.conditions.iter().enumerate() {
        let own = |entries: &[u32]| entries.contains(&(entry as u32));
        let films = || {
            let own = system.surface.films.iter().filter(|f| own(&f.entries));
            own.map(|film| at(film.place)).collect::<Vec<_>>()
        };
        let held = || {
            let own = system.surface.held.iter().filter(|h| own(&[h.entry]));
            let held = own.map(|h| at(system.place(h.point as usize)));
            films().into_iter().chain(held).collect::<Vec<_>>()
        };
        match condition {
            Condition::Temperature(curve) => add(curve, &held, Acts::Temperature),
            Condition::Flux(flux) => {
                let curve = &flux.curve;
                let mut films_of = system.surface.films.iter().filter(|f| own(&f.entries));
                let across =
                    |i: usize| system.cloud.spacing[i] / system.conductivity(i, temperature[i]);
                let skin = films_of
                    .next()
                    .map_or(0.0, |film| across(film.point as usize));
                add(curve, &films, Acts::Heat(skin));
            }
            Condition::Convection(coefficient, surroundings)
            | Condition::Radiation(coefficient, surroundings) => {
                add(coefficient, &films, Acts::Factor);
                add(surroundings, &films, Acts::Temperature);
            }
        }
    }
    if let Some(source) = system.source.as_ref().map(Source::curve) {
        let points = || {
            let each = temperature.iter().enumerate();
            each.map(|(i, t)| arguments(system.place(i), *t, 0.0))
                .collect()
        };
        let rise = temperature.first().map_or(0.0, |t| {
            system.cloud.spacing[0].powi(2) / system.conductivity(0, *t)
        });
        add(source, &points, Acts::Heat(rise));
    }
    found
}

impl<'a> Signal<'a> {
    /// The signal of a property at some of `places`; none of one that does not vary.
    fn new(curve: &'a Curve, places: &dyn Fn() -> Vec<Arguments>, acts: Acts) -> Option<Self> {
        if !curve.depends_on("t") {
            return None;
        }
        let places = places();
        let somewhere = ["x", "y", "z", "r", "T"];
        let every = if somewhere.iter().any(|name| curve.depends_on(name)) {
            places.len().div_ceil(PLACES)
        } else {
            places.len()
        };
        Some(Self {
            curve,
            places: places.into_iter().step_by(every.max(1)).collect(),
            acts,
        })
    }

    fn at(&self, place: usize, time: f64) -> Arguments {
        Arguments {
            time,
            ..self.places[place]
        }
    }

    /// The difference of temperature that it makes between neighbouring points \[K\].
    pub(super) fn range(&self, pieces: &Pieces) -> f64 {
        match self.acts {
            Acts::Temperature => pieces.values.width().max(0.0),
            Acts::Heat(rise) => rise * pieces.values.most(),
            Acts::Factor => 0.0,
        }
    }
}

impl Varies for Signal<'_> {
    fn places(&self) -> usize {
        self.places.len()
    }

    fn value(&self, place: usize, time: f64) -> f64 {
        // Where it has no value the march says so.
        self.curve.value(&self.at(place, time)).unwrap_or(0.0)
    }

    fn bounds(&self, place: usize, [from, to]: [f64; 2]) -> Bounds {
        self.curve
            .bounds(&self.at(place, from), &self.at(place, to))
    }
}
