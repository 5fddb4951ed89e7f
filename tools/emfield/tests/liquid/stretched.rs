//! Drops that are let go far from the sphere.

use std::f64::consts::PI;

use serde_json::json;

use super::{column, run};

/// Energy that may come back, and volume that may be lost.
const ENERGY: f64 = 1e-3;
const VOLUME: f64 = 1e-4;

/// A spheroid of some ratio of axes and Ohnesorge number, five spacings in the radius of its sphere, let go at rest for some
/// periods of small swings.
fn let_go(ratio: f64, ohnesorge: f64, periods: f64) {
    let (radius, density, tension) = (1e-3_f64, 1000.0_f64, 0.072_f64);
    let wide = radius / ratio.cbrt();
    let time = (density * radius.powi(3) / tension).sqrt();
    let scene = json!({"kind": "emfield.scene", "version": 1, "geometry": "space",
        "liquid": {"shape": {"ellipsoid": {"centre_m": [0, 0, 0], "semi_axes_m": [wide, wide, ratio * wide]}},
            "density_kg_m3": density, "surface_tension_n_m": tension,
            "viscosity_pa_s": ohnesorge * (density * tension * radius).sqrt(),
            "march": {"end_s": periods * 2.0 * PI / 8.0_f64.sqrt() * time}},
        "points": {"spacing_m": radius / 5.0}, "output": {"precision": "f64"}});
    let folder = tempfile::tempdir().unwrap();
    let reader = run(folder.path(), &scene);
    let [kinetic, surface, volume, axes] =
        ["kinetic_energy", "surface_energy", "volume", "axis_ratio"]
            .map(|name| column(&reader, name));
    let energy = kinetic.iter().zip(&surface).map(|(k, s)| k.1 + s.1);
    let first = kinetic[0].1 + surface[0].1;
    let mut least = first;
    for e in energy {
        least = least.min(e);
        assert!(e - least < ENERGY * first, "{:e}", (e - least) / first);
    }
    for (_, v) in &volume {
        assert!((v / volume[0].1 - 1.0).abs() < VOLUME);
    }
    let shortest = axes.iter().map(|a| a.1).fold(f64::INFINITY, f64::min);
    assert!(shortest < 0.8, "{shortest}");
}

#[test]
fn a_slender_drop_loses_energy_and_holds() {
    let_go(2.5, 0.1, 0.75);
}

#[test]
fn a_stretched_drop_of_little_friction_loses_energy_and_holds() {
    let_go(1.5, 0.02, 0.55);
}
