//! What a schema cannot tell of a scene.

use run::Fault;

use super::shape::BoxShape;
use super::{Scene, Shape, Time};

impl Scene {
    /// Everything that is wrong with the scene as far as it can be told without points.
    #[must_use]
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        self.solution(&mut faults);
        check(&self.body, "/body", self.dimensions, &mut faults);
        for (number, material) in self.materials.iter().enumerate() {
            let at = format!("/materials/{number}/region");
            match &material.region {
                Some(region) => check(region, &at, self.dimensions, &mut faults),
                None if number + 1 < self.materials.len() => faults.push(Fault::at(
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
        faults
    }

    fn solution(&self, faults: &mut Vec<Fault>) {
        match (&self.time, &self.steady) {
            (None, None) => faults.push(Fault::at("", "either \"time\" or \"steady\" is wanted")),
            (Some(_), Some(_)) => {
                faults.push(Fault::at(
                    "/steady",
                    "\"time\" and \"steady\" exclude each other",
                ));
            }
            (Some(time), None) => {
                time.method(faults);
                self.times(time, faults);
            }
            (None, Some(_)) => {}
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

fn coordinates(numbers: &[f64], at: &str, dimensions: usize, faults: &mut Vec<Fault>) -> bool {
    if numbers.len() == dimensions {
        return true;
    }
    let what = format!(
        "{} numbers; a scene of {dimensions} dimensions wants {dimensions}",
        numbers.len()
    );
    faults.push(Fault::at(at, what));
    false
}

fn check(shape: &Shape, at: &str, dimensions: usize, faults: &mut Vec<Fault>) {
    let only_in_space = |what: &str, faults: &mut Vec<Fault>| {
        if dimensions == 2 {
            faults.push(Fault::at(
                at,
                format!("a {what} has no place in a plane scene; a disc has"),
            ));
        }
    };
    match shape {
        Shape::Box(b) => corners(b, &format!("{at}/box"), dimensions, faults),
        Shape::Cylinder(_) => only_in_space("cylinder", faults),
        Shape::Sphere(_) => only_in_space("sphere", faults),
        Shape::Disc(d) => {
            coordinates(
                &d.centre_m,
                &format!("{at}/disc/centre_m"),
                dimensions,
                faults,
            );
        }
        Shape::HalfSpace(h) => {
            let at = format!("{at}/half_space");
            coordinates(&h.point_m, &format!("{at}/point_m"), dimensions, faults);
            if coordinates(&h.normal, &format!("{at}/normal"), dimensions, faults)
                && h.normal.iter().all(|n| *n == 0.0)
            {
                faults.push(Fault::at(
                    &format!("{at}/normal"),
                    "a normal has a direction: it is not zero",
                ));
            }
        }
        Shape::Turned(t) => {
            let at = format!("{at}/turned");
            if dimensions == 2 && t.axis.index() != 2 {
                faults.push(Fault::at(
                    &format!("{at}/axis"),
                    "a plane scene turns about z alone",
                ));
            }
            if let Some(about) = &t.about_m {
                coordinates(about, &format!("{at}/about_m"), dimensions, faults);
            }
            check(&t.shape, &format!("{at}/shape"), dimensions, faults);
        }
        Shape::Union(all) => parts(all, &format!("{at}/union"), dimensions, faults),
        Shape::Intersection(all) => parts(all, &format!("{at}/intersection"), dimensions, faults),
        Shape::Difference(all) => parts(all, &format!("{at}/difference"), dimensions, faults),
    }
}

fn corners(b: &BoxShape, at: &str, dimensions: usize, faults: &mut Vec<Fault>) {
    let both = coordinates(&b.min_m, &format!("{at}/min_m"), dimensions, faults)
        & coordinates(&b.max_m, &format!("{at}/max_m"), dimensions, faults);
    for k in (0..dimensions).filter(|_| both) {
        if b.max_m[k] <= b.min_m[k] {
            let what = format!("{} m is not above min_m, {} m", b.max_m[k], b.min_m[k]);
            faults.push(Fault::at(&format!("{at}/max_m/{k}"), what));
        }
    }
}

fn parts(all: &[Shape], at: &str, dimensions: usize, faults: &mut Vec<Fault>) {
    if all.is_empty() {
        faults.push(Fault::at(at, "at least one shape is wanted"));
    }
    for (number, shape) in all.iter().enumerate() {
        check(shape, &format!("{at}/{number}"), dimensions, faults);
    }
}
