//! Whether a scene fits a machine, told before a particle is made.

use std::ops::RangeInclusive;

use run::Fault;

use super::{Scene, Wire};

/// Most particles of a run, droplets included: some 10 GB.
const PARTICLES_MOST: f64 = 2e7;
/// Spacings whose cube, the volume of a particle, is far from the ends of the floating-point range \[m\].
const SPACING: RangeInclusive<f64> = 1e-9..=1e3;
/// Spacings from the origin at which a place still has a billionth of a spacing.
const REACH: f64 = 1e6;

/// Lengths that no particle can have, and bodies or droplets of too many particles.
pub(super) fn faults(scene: &Scene) -> Vec<Fault> {
    let d = scene.spacing_m;
    if !SPACING.contains(&d) {
        let (least, most) = (SPACING.start(), SPACING.end());
        let what = format!("{d:e} m is out of range: from {least:e} m to {most:e} m");
        return vec![Fault::at("/spacing_m", what)];
    }
    let mut faults = Vec::new();
    let mut total = 0.0;
    for (i, body) in scene.bodies.iter().enumerate() {
        let (low, high) = body.shape.bounds();
        let shape = format!("/bodies/{i}/shape");
        let far = far(&shape, &[low, high], d);
        let lattice = body.lattice_m.as_slice();
        let anchor = self::far(&format!("/bodies/{i}/lattice_m"), lattice, d);
        if far.is_some() || anchor.is_some() {
            faults.extend(far.into_iter().chain(anchor));
            continue;
        }
        let sites = body.shape.sites([d; 3]);
        let number: f64 = sites.iter().product();
        total += number;
        if number > PARTICLES_MOST {
            faults.push(crowd(&shape, sites, d));
        }
    }
    if faults.is_empty() && total > PARTICLES_MOST {
        let what = format!("hold {total:.1e} particles in all, at most {PARTICLES_MOST:.0e}");
        faults.push(Fault::at("/bodies", what));
    }
    faults.extend(scene.wires().filter_map(|wire| droplets(scene, &wire)));
    faults
}

/// A corner farther away than the digits of a place reach.
fn far(at: &str, corners: &[[f64; 3]], d: f64) -> Option<Fault> {
    let reach = corners
        .as_flattened()
        .iter()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    (reach > REACH * d).then(|| {
        let most = REACH * d;
        let what = format!("reaches to {reach:e} m; with a spacing of {d} m at most to {most:e} m");
        Fault::at(at, what)
    })
}

fn crowd(at: &str, sites: [f64; 3], d: f64) -> Fault {
    let number: f64 = sites.iter().product();
    // Two digits, rounded up, so that what is advised is enough.
    let wanted = d * (number / PARTICLES_MOST).cbrt();
    let unit = 10f64.powf(wanted.log10().floor() - 1.0);
    let advised = (1.02 * wanted / unit).ceil() * unit;
    let [x, y, z] = sites;
    let what = format!(
        "asks for {x} x {y} x {z} = {number:.1e} particles, at most {PARTICLES_MOST:.0e}: \
         spacing_m = {advised:.1e} would do, or a smaller shape"
    );
    Fault::at(at, what)
}

/// A droplet of a wire, or all of them, of too many particles.
fn droplets(scene: &Scene, wire: &Wire) -> Option<Fault> {
    let droplets = wire.droplets;
    let across = (2.0 * droplets.radius_m / scene.spacing_m).max(1.0);
    let each = across.powi(3);
    if each > PARTICLES_MOST {
        let at = format!("{}/radius_m", wire.at);
        return Some(crowd(&at, [across.round(); 3], scene.spacing_m));
    }
    let period = scene.droplet_period(wire)?;
    let born = (scene.time.end_s / period).floor() + 1.0;
    let all = born * each;
    (all > PARTICLES_MOST).then(|| {
        let what = format!(
            "one every {period:e} s gives {born:.1e} droplets until {} s, {all:.1e} particles; at most {PARTICLES_MOST:.0e}",
            scene.time.end_s
        );
        let key = if droplets.period_s.is_some() {
            "period_s"
        } else {
            "feed_m3_s"
        };
        Fault::at(&format!("{}/{key}", wire.at), what)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn paths(patch: &Value) -> Vec<(String, String)> {
        let mut scene = json!({
            "spacing_m": 5e-4,
            "time": {"step_s": 1e-4, "end_s": 10.0},
            "density_kg_m3": 7850,
            "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [0.02, 0.065, 0.005]}}, "state": "solid"}],
            "droplets": {"period_s": 0.016, "radius_m": 7.5e-4, "height_m": 5e-3, "speed_m_s": 1.56},
            "output": {"particles_interval_s": 0.1}
        });
        for (key, value) in patch.as_object().unwrap() {
            scene[key] = value.clone();
        }
        let scene: Scene = serde_json::from_value(scene).unwrap();
        let found = faults(&scene).into_iter();
        found
            .map(|fault| (fault.path().to_owned(), fault.to_string()))
            .collect()
    }

    fn body(min: [f64; 3], max: [f64; 3]) -> Value {
        json!({"shape": {"box": {"min_m": min, "max_m": max}}, "state": "solid"})
    }

    #[test]
    fn the_plate_of_the_study_fits() {
        assert_eq!(paths(&json!({})), []);
    }

    #[test]
    fn what_does_not_fit_is_told_with_its_place_and_a_way_out() {
        let large = body([0.0; 3], [2.0, 2.0, 0.02]);
        let told = paths(&json!({"bodies": [large]}));
        assert_eq!(told[0].0, "/bodies/0/shape");
        assert!(
            told[0].1.contains("4000 x 4000 x 40 = 6.4e8 particles"),
            "{told:?}"
        );
        // What is advised is enough.
        let advised = told[0].1.split("spacing_m = ").nth(1).unwrap();
        let advised: f64 = advised.split(' ').next().unwrap().parse().unwrap();
        let large = body([0.0; 3], [2.0, 2.0, 0.02]);
        assert_eq!(paths(&json!({"bodies": [large], "spacing_m": advised})), []);

        let far = body([1e300; 3], [2e300; 3]);
        assert_eq!(paths(&json!({"bodies": [far]}))[0].0, "/bodies/0/shape");
        assert_eq!(paths(&json!({"spacing_m": 1e-12}))[0].0, "/spacing_m");
        let droplets = |period: f64, radius: f64| {
            let droplets =
                json!({"period_s": period, "radius_m": radius, "height_m": 1, "speed_m_s": 1});
            paths(&json!({"droplets": droplets}))
        };
        assert_eq!(droplets(1e-9, 7.5e-4)[0].0, "/droplets/period_s");
        assert_eq!(droplets(0.016, 1.0)[0].0, "/droplets/radius_m");
        let fed = json!({"feed_m3_s": 10.0, "radius_m": 7.5e-4, "height_m": 1, "speed_m_s": 1});
        let told = paths(&json!({"droplets": fed}));
        assert_eq!(told[0].0, "/droplets/feed_m3_s");
    }

    #[test]
    fn bodies_are_counted_together() {
        let half = || body([0.0; 3], [0.13, 0.13, 0.13]);
        assert_eq!(paths(&json!({"bodies": [half()]})), []);
        assert_eq!(paths(&json!({"bodies": [half(), half()]}))[0].0, "/bodies");
    }
}
