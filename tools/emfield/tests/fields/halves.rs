//! One body as two halves, one of which has finer points: the field is that of the whole.

use serde_json::{Value, json};

use super::run;

const PERMITTIVITY: f64 = 4.0;

/// A disc or ball of radius 1 in a uniform field of 1 V/m along the last coordinate, which parts it.
fn halves(dimensions: usize, spacings: [f64; 2]) -> Value {
    let (around, last) = (dimensions as f64 - 1.0, ["", "", "y", "z"][dimensions]);
    let share = (PERMITTIVITY - 1.0) / (PERMITTIVITY + around);
    let square = ["x^2", "y^2", "z^2"][..dimensions].join(" + ");
    let outer = format!(
        "-{last}*(1 - {share}/({square})^{})",
        0.5 * dimensions as f64
    );
    let whole = ["", "", "disc", "sphere"][dimensions];
    let half = |name: &str, side: f64, spacing: f64| {
        let mut normal = vec![0.0; dimensions];
        normal[dimensions - 1] = side;
        let middle = vec![0.0; dimensions];
        json!({"name": name, "relative_permittivity": PERMITTIVITY, "spacing_m": spacing,
            "shape": {"intersection": [{whole: {"centre_m": middle, "radius_m": 1}},
                {"half_space": {"point_m": middle, "normal": normal}}]}})
    };
    let geometry = ["", "", "plane", "space"][dimensions];
    json!({"kind": "emfield.scene", "version": 1,
        "geometry": geometry,
        "domain": {"box": {"min_m": vec![-2; dimensions], "max_m": vec![2; dimensions]}},
        "bodies": [half("coarse", 1.0, spacings[0]), half("fine", -1.0, spacings[1])],
        "electrostatics": {"outer": [{"potential_v": {"expr": outer}}]},
        "points": {"spacing_m": spacings[1]},
        "method": {"order": 4},
        "output": {"precision": "f64"}})
}

/// The largest error of the potential \[V\].
fn error(dimensions: usize, spacings: [f64; 2]) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let reader = run(folder.path(), &halves(dimensions, spacings));
    let points = reader.frame("/points", 0).unwrap();
    let found = points.f64("potential").unwrap();
    let places = points.position_vectors().unwrap();
    let around = dimensions as f64 - 1.0;
    let share = (PERMITTIVITY - 1.0) / (PERMITTIVITY + around);
    let off = places.iter().zip(found).map(|(x, found)| {
        let r = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let inside = (around + 1.0) / (PERMITTIVITY + around);
        let part = if r < 1.0 {
            inside
        } else {
            1.0 - share / r.powi(dimensions as i32)
        };
        (found + part * x[dimensions - 1]).abs()
    });
    off.fold(0.0, f64::max)
}

/// Points of the coarse half draw together towards the fine one. Where they did not, the field of the disc was off by 7e-3, and
/// that of the ball beyond all bounds.
#[test]
fn halves_of_different_spacing_are_as_exact_as_the_coarser() {
    for (dimensions, spacings) in [(2, [0.2, 0.05]), (3, [0.2, 0.1])] {
        let coarse = error(dimensions, [spacings[0]; 2]);
        let both = error(dimensions, spacings);
        assert!(
            coarse < 1e-3 && both < 2.5 * coarse,
            "{dimensions}: {both} {coarse}"
        );
    }
}
