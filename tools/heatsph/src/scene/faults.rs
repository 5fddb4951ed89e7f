//! What a schema cannot tell of a scene.

use run::Fault;
use run::property::Property;

use shapes::check::{Misfit, check, coordinates, filled};
use torch::Waveform;

use super::{Boundary, Scene, Time};

/// Most corners of a waveform, at each of which a step ends.
const CORNERS: f64 = 200_000.0;

impl Scene {
    /// Everything that is wrong with the scene as far as it can be told without points.
    #[must_use]
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        self.solution(&mut faults);
        faults.extend(self.misfits());
        self.torches(&mut faults);
        faults
    }

    /// What is wrong with shapes and places.
    fn misfits(&self) -> impl Iterator<Item = Fault> {
        let mut faults = Vec::new();
        let spacing = self.points.spacing_m;
        filled(&self.body, "/body", self.dimensions, spacing, &mut faults);
        for (number, material) in self.materials.iter().enumerate() {
            let at = format!("/materials/{number}/region");
            match &material.region {
                Some(region) => check(region, &at, self.dimensions, &mut faults),
                None if number + 1 < self.materials.len() => faults.push(Misfit::at(
                    &at,
                    "only the last material may do without a region: those after it would be nowhere",
                )),
                None => {}
            }
        }
        for (number, entry) in self.boundaries.iter().enumerate() {
            if let Some(within) = &entry.within {
                let at = format!("/boundaries/{number}/within");
                check(within, &at, self.dimensions, &mut faults);
            }
        }
        for (number, monitor) in self.output.monitors.iter().enumerate() {
            let at = format!("/output/monitors/{number}/place_m");
            coordinates(&monitor.place_m, &at, self.dimensions, &mut faults);
        }
        for (number, extra) in self.points.extra_m.iter().enumerate() {
            let at = format!("/points/extra_m/{number}");
            coordinates(extra, &at, self.dimensions, &mut faults);
        }
        faults.into_iter().map(|m| Fault::at(&m.path, m.what))
    }

    fn solution(&self, faults: &mut Vec<Fault>) {
        match (&self.time, &self.steady) {
            (None, None) => faults.push(Fault::at("", "either \"time\" or \"steady\" is wanted")),
            (Some(_), Some(_)) => {
                let what = "\"time\" and \"steady\" exclude each other";
                faults.push(Fault::at("/steady", what).or_at("/time"));
            }
            (Some(time), None) => {
                time.method(faults);
                self.times(time, faults);
            }
            (None, Some(_)) => {
                faults.extend(self.timed());
                faults.extend(self.sources());
            }
        }
    }

    /// A boundary whose total has the name of that of the sources.
    fn sources(&self) -> Option<Fault> {
        let named = |b: &Boundary| b.name.as_deref() == Some("source");
        let number = self.boundaries.iter().position(named)?;
        let what = "'source' is the name of the total of heat sources: take another";
        Some(Fault::at(&format!("/boundaries/{number}/name"), what))
    }

    /// Formulas in t, of which a steady state would take those of t = 0 alone.
    fn timed(&self) -> impl Iterator<Item = Fault> {
        let source = self.source_w_m3.iter();
        let mut given: Vec<(String, &Property)> =
            source.map(|p| ("/source_w_m3".to_owned(), p)).collect();
        for (number, entry) in self.boundaries.iter().enumerate() {
            let (convection, radiation) = (entry.convection.as_ref(), entry.radiation.as_ref());
            let own = [
                ("temperature_k", entry.temperature_k.as_ref()),
                ("heat_flux_w_m2", entry.heat_flux_w_m2.as_ref()),
                (
                    "convection/coefficient_w_m2_k",
                    convection.map(|c| &c.coefficient_w_m2_k),
                ),
                ("convection/ambient_k", convection.map(|c| &c.ambient_k)),
                ("radiation/emissivity", radiation.map(|r| &r.emissivity)),
                (
                    "radiation/surroundings_k",
                    radiation.map(|r| &r.surroundings_k),
                ),
            ];
            let own = own.into_iter();
            given.extend(
                own.filter_map(|(key, p)| Some((format!("/boundaries/{number}/{key}"), p?))),
            );
        }
        given.into_iter().filter_map(|(at, property)| {
            // What does not compile is told where it is compiled.
            let curve = property.compile(&at, &["x", "y", "z", "r", "T", "t"]).ok()?;
            curve.depends_on("t").then(|| {
                let what = "depends on t, and a steady state has no time; write it without t, or ask for \"time\" in place of \"steady\"";
                Fault::at(&format!("{at}/expr"), what).or_at("/steady")
            })
        })
    }

    fn torches(&self, faults: &mut Vec<Fault>) {
        if !self.torches.is_empty() && (self.dimensions != 3 || self.time.is_none()) {
            let what = "torches move in space and time: \"dimensions\" is 3 and \"time\" is there";
            faults.push(Fault::at("/torches", what));
        }
        for (number, torch) in self.torches.iter().enumerate() {
            let misfits = torch.misfits().into_iter();
            faults.extend(
                misfits.map(|m| Fault::at(&format!("/torches/{number}{}", m.path), m.what)),
            );
            let waveform = torch.waveform.as_ref().zip(self.time.as_ref());
            faults.extend(waveform.and_then(|(wave, time)| many(number, wave, time.end_s)));
        }
    }

    fn times(&self, time: &Time, faults: &mut Vec<Fault>) {
        for (number, at) in self.output.at_s.iter().enumerate() {
            let path = format!("/output/at_s/{number}");
            if !(*at >= 0.0 && *at <= time.end_s) {
                let what = format!(
                    "{at} s is out of range: from 0 s to the end at {} s",
                    time.end_s
                );
                faults.push(Fault::at(&path, what));
            } else if number > 0 && *at <= self.output.at_s[number - 1] {
                faults.push(Fault::at(
                    &path,
                    format!("{at} s does not rise above the time before it"),
                ));
            }
        }
        for (key, every) in [
            ("every_s", self.output.every_s),
            ("monitors_every_s", self.output.monitors_every_s),
        ] {
            if every.is_some_and(|every| time.end_s / every > 1e6) {
                let what = format!(
                    "{} outputs are too many: at most 1e6",
                    time.end_s / every.unwrap_or(1.0)
                );
                faults.push(Fault::at(&format!("/output/{key}"), what));
            }
        }
    }
}

impl Time {
    fn method(&self, faults: &mut Vec<Fault>) {
        let given = [
            self.explicit.is_some(),
            self.stabilised.is_some(),
            self.implicit.is_some(),
        ];
        if given.iter().filter(|g| **g).count() > 1 {
            let what = "at most one of \"explicit\", \"stabilised\" and \"implicit\" is wanted";
            faults.push(Fault::at("/time", what));
        }
    }
}

/// A waveform with more corners than a march can end its steps at.
fn many(number: usize, wave: &Waveform, end: f64) -> Option<Fault> {
    let corners = wave.times_s.len() as f64 * end / wave.period_s;
    (corners > CORNERS).then(|| {
        let what = format!(
            "has {corners:.3e} corners in {end} s, at each of which a step ends; at most {CORNERS:e} are followed: \
             give a longer period, or a mean power without a waveform"
        );
        Fault::at(&format!("/torches/{number}/waveform/period_s"), what)
    })
}
