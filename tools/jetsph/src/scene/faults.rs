//! What the types of a scene cannot tell.

use run::Fault;
use shapes::Shape;
use shapes::check::{Misfit, check};

use super::{Scene, Solid};

/// Most frames and balances of a run.
const EVENTS_MOST: f64 = 1e7;

impl Scene {
    /// Every fault that the types cannot tell.
    #[must_use]
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        if self.solids.is_empty() {
            faults.push(Fault::at(
                "",
                "there is nothing in the scene: it wants 'solids'",
            ));
        }
        if self.dimensions == 3 && self.plane.is_some() {
            faults.push(Fault::at("/plane", "a scene of 3 dimensions has no plane"));
        }
        let end = self.time.end_s;
        for (key, interval) in [
            ("frames_interval_s", Some(self.output.frames_interval_s)),
            ("balance_interval_s", self.output.balance_interval_s),
        ] {
            if let Some(interval) = interval.filter(|interval| end / interval > EVENTS_MOST) {
                let what = format!(
                    "{interval} s is too short: {:.1e} times until {end} s, at most {EVENTS_MOST:.0e}",
                    end / interval
                );
                faults.push(Fault::at(&format!("/output/{key}"), what));
            }
        }
        for (i, solid) in self.solids.iter().enumerate() {
            solid.faults(&format!("/solids/{i}"), self.dimensions, &mut faults);
            if let Some(k) = self.solids[..i]
                .iter()
                .position(|other| other.name == solid.name)
            {
                let what = format!("\"{}\" is the name of /solids/{k} too", solid.name);
                faults.push(Fault::at(&format!("/solids/{i}/name"), what));
            }
        }
        faults
    }
}

impl Solid {
    fn faults(&self, at: &str, dimensions: usize, faults: &mut Vec<Fault>) {
        let mut misfits = Vec::new();
        check(&self.body, &format!("{at}/body"), dimensions, &mut misfits);
        let mut within = |shape: Option<&Shape>, at: &str| {
            if let Some(shape) = shape {
                check(shape, &format!("{at}/within"), dimensions, &mut misfits);
            }
        };
        for (k, clamp) in self.clamps.iter().enumerate() {
            within(clamp.within.as_ref(), &format!("{at}/clamps/{k}"));
        }
        for (k, load) in self.loads.iter().enumerate() {
            within(load.within.as_ref(), &format!("{at}/loads/{k}"));
        }
        faults.extend(
            misfits
                .into_iter()
                .map(|Misfit { path, what }| Fault::at(&path, what)),
        );
        let lengths = self.clamps.iter().enumerate().map(|(k, clamp)| {
            (
                format!("{at}/clamps/{k}/velocity_m_s"),
                clamp.velocity_m_s.as_ref().map(Vec::len),
            )
        });
        let lengths = lengths.chain(self.loads.iter().enumerate().map(|(k, load)| {
            (
                format!("{at}/loads/{k}/traction_pa"),
                Some(load.traction_pa.len()),
            )
        }));
        let own = (
            format!("{at}/velocity_m_s"),
            self.velocity_m_s.as_ref().map(Vec::len),
        );
        for (at, length) in lengths.chain([own]) {
            if let Some(length) = length.filter(|length| *length != dimensions) {
                let what = format!(
                    "{length} numbers; a scene of {dimensions} dimensions wants {dimensions}"
                );
                faults.push(Fault::at(&at, what));
            }
        }
    }
}
