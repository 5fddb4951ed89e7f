//! Grains at the start, and what is wrong with them in a scene.

use particles::{Ids, Matter, POSITION, Set};
use run::Fault;
use shapes::check;
use shapes::frame::{along, cross, difference, scaled};
use shapes::jitter::signed;
use shapes::{Body, Shape};

use super::parameters::{GrainBody, Parameters};
use super::slow::SLOW;
use super::{
    DRIVEN, FORCE, GLUED, GLUED_AT, LISTED, MASS, MOMENT, RADIUS, SPIN, TURNED, VELOCITY, WATCHED,
};

/// Place \[m\] and radius \[m\] of a grain.
pub type Lying = ([f64; 3], f64);

/// Most grains of a run: some 5 GB.
const MOST: f64 = 2e7;
/// A lattice place is in a shape where the grain reaches out of it by at most this part of its radius: rounding.
const OUT: f64 = 1e-6;

/// Every fault of the grains, at keys from the root of their part of the scene.
#[must_use]
pub fn faults(scene: &Parameters) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut total = 0.0;
    for (i, body) in scene.bodies.iter().enumerate() {
        let at = format!("/bodies/{i}");
        match checked(body, &at) {
            Ok(number) => total += number,
            Err(fault) => faults.push(fault),
        }
    }
    for (i, wall) in scene.walls.iter().enumerate() {
        let found = wall.faults().into_iter();
        faults.extend(found.map(|fault| fault.within(&format!("/walls/{i}"))));
    }
    if let Some(bounds) = scene.bounds {
        let flat = (0..3).find(|k| bounds.max_m[*k] <= bounds.min_m[*k]);
        faults.extend(flat.map(|k| {
            let (low, high) = (bounds.min_m[k], bounds.max_m[k]);
            let axis = ["x", "y", "z"][k];
            let what =
                format!("its upper corner in {axis}, {high} m, is not above the lower, {low} m");
            Fault::at("/bounds", what)
        }));
    }
    faults.extend(never_rests(scene));
    if faults.is_empty() && total > MOST {
        let what = format!("hold {total:.1e} grains in all, at most {MOST:.0e}");
        faults.push(Fault::at("/bodies", what));
    }
    faults
}

/// A time of rest so short that a grain that is thrown up would pass for one at rest: it is slower than v for 2 v/g.
fn never_rests(scene: &Parameters) -> Option<Fault> {
    let rest = scene.until?;
    let g = scene
        .gravity_m_s2?
        .map(|g| g * g)
        .iter()
        .sum::<f64>()
        .sqrt();
    let least = 2.0 * rest.speed_m_s / g;
    (rest.held_s <= least).then(|| {
        let (v, held) = (rest.speed_m_s, rest.held_s);
        let what = format!(
            "{held} s: a grain that falls freely is slower than {v} m/s for as long as {least:.3} s and would pass for one \
             at rest; hold for longer, or ask for a lower speed"
        );
        Fault::at("/until/held_s", what)
    })
}

/// Places on the lattice of a body, or what is wrong with it.
fn checked(body: &GrainBody, at: &str) -> Result<f64, Fault> {
    let told = [body.shape.is_some(), !body.places_m.is_empty(), body.bed];
    if told.iter().filter(|told| **told).count() != 1 {
        let what = "needs one of the keys 'shape', 'places_m' and 'bed'";
        return Err(Fault::at(at, what));
    }
    if body.glued && (body.bed || body.driven_m_s.is_some()) {
        let what = "a body is glued, or 'driven_m_s', or a 'bed': one of these";
        return Err(Fault::at(&format!("{at}/glued"), what));
    }
    if body.bed {
        return Ok(0.0);
    }
    let Some(radius) = body.radius_m else {
        return Err(Fault::at(at, "needs the key 'radius_m'"));
    };
    let Some(shape) = &body.shape else {
        return Ok(body.places_m.len() as f64);
    };
    let at_shape = format!("{at}/shape");
    let mut misfits = Vec::new();
    check::check(shape, &at_shape, 3, &mut misfits);
    if let Some(misfit) = misfits.into_iter().next() {
        return Err(Fault::at(&misfit.path, misfit.what));
    }
    let [low, high] = Body::new(shape, 3).bounds();
    let spacing = body.spacing_m.unwrap_or(2.0 * radius);
    if spacing < 2.0 * radius * (1.0 - OUT) {
        let what = format!(
            "{spacing} m is less than a diameter, {} m: grains would begin within each other",
            2.0 * radius
        );
        return Err(Fault::at(&format!("{at}/spacing_m"), what));
    }
    let number: f64 = (0..3).map(|k| (high[k] - low[k]) / spacing).product();
    // An infinite shape has no number that is less.
    let fits = number <= MOST;
    if !fits {
        let what = format!("asks for {number:.1e} grains, at most {MOST:.0e}");
        return Err(Fault::at(&at_shape, what));
    }
    Ok(number)
}

impl GrainBody {
    /// Places and radii of the grains \[m\].
    fn places(&self, bed: &[Lying]) -> Vec<Lying> {
        if self.bed {
            return bed.to_vec();
        }
        let radius = self.radius_m.unwrap_or(0.0);
        let lying = |place: &[f64; 3]| (*place, radius);
        match &self.shape {
            Some(shape) => self.lattice(shape).iter().map(lying).collect(),
            None => self.places_m.iter().map(lying).collect(),
        }
    }

    /// Places on the lattice \[m\].
    fn lattice(&self, shape: &Shape) -> Vec<[f64; 3]> {
        let body = Body::new(shape, 3);
        let [low, high] = body.bounds();
        let radius = self.radius_m.unwrap_or(0.0);
        let spacing = self.spacing_m.unwrap_or(2.0 * radius);
        let reach = radius * (1.0 - OUT);
        // A side that a whole number of spacings fills to rounding holds as many.
        let counts = [0, 1, 2].map(|k| ((high[k] - low[k]) / spacing + OUT).floor() as usize);
        let mut places = Vec::new();
        for k in 0..counts[2] {
            for j in 0..counts[1] {
                for i in 0..counts[0] {
                    let at = [i, j, k];
                    let place: [f64; 3] =
                        std::array::from_fn(|axis| low[axis] + (at[axis] as f64 + 0.5) * spacing);
                    if body.distance(place) <= -reach {
                        let number = 3 * places.len();
                        places.push(std::array::from_fn(|axis| {
                            place[axis] + self.jitter * spacing * signed(0, (number + axis) as u64)
                        }));
                    }
                }
            }
        }
        places
    }
}

/// Declares the columns that the scene needs.
fn declare(set: &mut Set, scene: &Parameters) {
    for column in [&VELOCITY, &SPIN, &FORCE, &MOMENT, &LISTED] {
        set.declare(column);
    }
    for column in [&RADIUS, &MASS] {
        set.declare(column);
    }
    if scene.bodies.iter().any(|body| body.driven_m_s.is_some()) {
        set.declare(&DRIVEN);
    }
    if scene.bodies.iter().any(|body| body.glued) {
        set.declare(&GLUED);
        set.declare(&GLUED_AT);
    }
    if scene.sleep.is_some() {
        for column in [&WATCHED, &TURNED] {
            set.declare(column);
        }
    }
    if scene
        .sleep
        .is_some_and(|sleep| sleep.heat_interval_steps > 1)
    {
        set.declare(&SLOW);
    }
}

/// The grains of all bodies, and how many each holds; `bed` are those of the input.
#[must_use]
pub fn fill(scene: &Parameters, bed: &[Lying]) -> (Set, Vec<usize>) {
    let radii = scene.bodies.iter().filter_map(|b| b.radius_m);
    let widest = radii.chain(bed.iter().map(|(_, r)| *r)).fold(0.0, f64::max);
    let matter = Matter {
        density: scene.density_kg_m3,
        spacing: 2.0 * widest,
        smoothing_length: 2.0 * widest,
    };
    let mut set = Set::new("grains", matter);
    let mut ids = Ids::default();
    declare(&mut set, scene);
    let mut counts = Vec::new();
    for (i, body) in scene.bodies.iter().enumerate() {
        let places = body.places(bed);
        let density = body.density_kg_m3.unwrap_or(scene.density_kg_m3);
        counts.push(places.len());
        let centre = centre(&places);
        for (place, radius) in places {
            let row = set.push(&mut ids);
            set.column_mut(&POSITION)[row] = place;
            set.column_mut(&VELOCITY)[row] = body.velocity_m_s.unwrap_or_default();
            set.column_mut(&SPIN)[row] = body.spin_rad_s.unwrap_or_default();
            set.column_mut(&RADIUS)[row] = radius;
            set.column_mut(&MASS)[row] =
                density * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
            if body.driven_m_s.is_some() {
                set.column_mut(&DRIVEN)[row] = i as u8 + 1;
            }
            if body.glued {
                let (arm, velocity) = (
                    difference(place, centre),
                    &mut set.column_mut(&VELOCITY)[row],
                );
                *velocity = along(
                    *velocity,
                    1.0,
                    cross(body.spin_rad_s.unwrap_or_default(), arm),
                );
                set.column_mut(&GLUED_AT)[row] = arm;
                set.column_mut(&GLUED)[row] = i as u8 + 1;
            }
        }
    }
    (set, counts)
}

/// Centre of mass of grains that are alike.
fn centre(places: &[Lying]) -> [f64; 3] {
    let sum = places
        .iter()
        .fold([0.0; 3], |sum, (x, _)| along(sum, 1.0, *x));
    scaled(1.0 / places.len().max(1) as f64, sum)
}

/// Least and greatest radius \[m\].
#[must_use]
pub fn radii(set: &Set) -> [f64; 2] {
    let radii = set.column(&RADIUS).iter();
    radii.fold([f64::INFINITY, 0.0], |[least, widest], r| {
        [least.min(*r), widest.max(*r)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_glued_grains_have_the_columns_of_a_body() {
        let filled = |more: &str| {
            let text = format!(
                r#"{{"density_kg_m3": 2500,
                "contact": {{"law": {{"linear": {{"stiffness_n_m": 200}}}}, "restitution": 0.6}},
                "bodies": [{{"shape": {{"box": {{"min_m": [0, 0, 0], "max_m": [4e-3, 4e-3, 2e-3]}}}}, "radius_m": 1e-3{more}}}]}}"#
            );
            fill(&serde_json::from_str(&text).unwrap(), &[]).0
        };
        let (free, glued) = (filled(""), filled(r#", "glued": true"#));
        assert_eq!(free.len(), glued.len());
        assert!(glued.has(&GLUED) && glued.has(&GLUED_AT));
        assert!(!free.has(&GLUED) && !free.has(&GLUED_AT));
        assert!(free.bytes() < glued.bytes());
    }
}
