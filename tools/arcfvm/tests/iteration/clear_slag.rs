//! Slag that is clear: it conducts heat by its own radiation.

use arcfvm::assemble::assemble;
use arcfvm::bed;
use arcfvm::resume;
use arcfvm::scene::Scene;
use arcfvm::settings::Settings;
use arcfvm::solver::Arc;
use serde_json::{Value, json};

use crate::setup;

fn arc(scene: Value) -> Arc {
    let scene: Scene = serde_json::from_value(scene).unwrap();
    let case = assemble(&scene, None).unwrap();
    Arc::new(case, Settings::from(&scene.iterate))
}

/// A small submerged arc in flux that moves, whose channel begins at `start` \[K\].
fn in_a_bed(clear: bool, start: f64) -> Arc {
    let mut scene = setup::scene("pipelines/stability/bed/arc.json");
    let flux = &mut scene["bodies"]["flux"];
    flux["moving"] = json!({"speed_m_s": 0.005, "ahead_m": 0.005});
    if clear {
        flux["granular"]["absorption_length_m"] = json!(0.004);
        flux["granular"]["refractive_index"] = json!(1.6);
    }
    scene["start"]["channel"]["temperature_k"] = json!(start);
    arc(scene)
}

fn iterate(arc: &mut Arc, times: usize) -> f64 {
    let mut worst = 0.0;
    for _ in 0..times {
        worst = arc.iterate(&mut ()).unwrap().worst();
    }
    worst
}

/// Ends of the layer \[K\], conductivity of the plates \[W/(m K)\], thickness of each and of the bed between them \[m\].
const COLD: f64 = 1000.0;
const HOT: f64 = 2900.0;
const PLATE: f64 = 30.0;
const THIN: f64 = 0.002;
const BED: f64 = 0.006;

/// Flux between a cold plate and a hot one, melted from its upper side, beside a slit of gas that conducts next to nothing.
fn a_layer() -> Arc {
    let ring = |from: f64, to: f64| json!({"ring": {"r_m": [0, 0.002], "z_m": [from, to]}});
    let plate = json!({"density_kg_m3": 7750, "specific_heat_j_kg_k": 700, "thermal_conductivity_w_m_k": PLATE});
    let top = 2.0 * THIN + BED;
    arc(json!({
        "title": "Flux between two plates",
        "domain": {"r_m": [0, 0.003], "z_m": [0, top]},
        "grid": {"r": 0.001, "z": 0.0005},
        "gas": {"given": {"density_kg_m3": 0.1, "specific_heat_j_kg_k": 1000, "thermal_conductivity_w_m_k": 1e-9}},
        "bodies": {
            "below": {"shape": ring(0.0, THIN), "material": plate},
            "above": {"shape": ring(THIN + BED, top), "material": plate},
            "flux": {
                "shape": ring(THIN, THIN + BED),
                "material": {
                    "density_kg_m3": 3230,
                    "specific_heat_j_kg_k": 1200,
                    "thermal_conductivity_w_m_k": 0.8,
                    "melting": {"point_k": 2572, "half_range_k": 25, "latent_heat_j_kg": 5e5}
                },
                "granular": {
                    "slag_conductivity_ratio": 3,
                    "boiling_k": 3500,
                    "absorbed_radiation": 0.8,
                    "absorption_length_m": 0.004,
                    "refractive_index": 1.6
                }
            }
        },
        "heat": {"edges": {
            "bottom": [{"over_m": [0, 0.002], "temperature_k": COLD}],
            "top": [{"over_m": [0, 0.002], "temperature_k": HOT}]
        }},
        "start": {"temperature_k": 600}
    }))
}

/// Integral of the conductivity of the flux up to `t`, by the law itself \[W/m\].
fn integral(t: f64) -> f64 {
    let law = |t: f64| {
        let molten = ((t - 2547.0) / 50.0).clamp(0.0, 1.0);
        let radiative = 16.0 / 3.0 * 1.6_f64.powi(2) * 5.670_374_419e-8 * t.powi(3) * 0.004;
        0.8 * (1.0 + 2.0 * molten) + molten * radiative
    };
    let steps = 20_000;
    let step = (t - COLD) / f64::from(steps);
    (0..steps)
        .map(|n| step * law(COLD + (f64::from(n) + 0.5) * step))
        .sum()
}

/// Bisects `f`, which grows, for zero.
fn root(f: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[test]
fn a_layer_that_melts_between_plates_is_exact_on_any_cells() {
    let mut arc = a_layer();
    let residual = iterate(&mut arc, 300);
    assert!(residual < 1e-6, "{residual:e}");
    // The heat that passes all three layers \[W/m2\].
    let faces = |q: f64| [COLD + q * THIN / PLATE, HOT - q * THIN / PLATE];
    let heat = root(
        |q| q * BED - (integral(faces(q)[1]) - integral(faces(q)[0])),
        [0.0, 1e7],
    );
    let [below, above] = faces(heat);
    let exact = |z: f64| {
        if z < THIN {
            COLD + heat * z / PLATE
        } else if z < THIN + BED {
            let want = integral(below) + heat * (z - THIN);
            root(|t| integral(t) - want, [below, above])
        } else {
            HOT - heat * (2.0 * THIN + BED - z) / PLATE
        }
    };
    let grid = &arc.case.grid;
    for j in 0..grid.nz {
        let (found, want) = (arc.temperature()[grid.cell(0, j)], exact(grid.zc[j]));
        assert!((found - want).abs() < 0.5, "{}: {found} {want}", grid.zc[j]);
    }
    assert!(above > 2597.0 && below < 2547.0);
}

#[test]
fn clear_slag_is_thicker_and_wherever_the_arc_begins_the_same() {
    let found = |clear, start| {
        let mut arc = in_a_bed(clear, start);
        let residual = iterate(&mut arc, 1000);
        assert!(residual < 1e-4, "{clear} {start}: {residual:e}");
        bed::figures::measure(&arc).unwrap()
    };
    let both = |clear| [9e3, 14e3].map(|start| found(clear, start));
    for [cool, hot] in [both(false), both(true)] {
        assert_eq!(cool.wall.to_bits(), hot.wall.to_bits(), "{cool:?} {hot:?}");
        assert!((cool.slag_volume / hot.slag_volume - 1.0).abs() < 1e-3);
    }
    let [opaque, clear] = [false, true].map(|clear| found(clear, 12e3));
    assert!(
        clear.slag_volume > 2.0 * opaque.slag_volume,
        "{opaque:?} {clear:?}"
    );
}

#[test]
fn a_bed_is_clear_only_where_its_slag_has_a_refractive_index() {
    assert!(in_a_bed(false, 12e3).case.clear_bed().is_none());
    assert!(in_a_bed(true, 12e3).case.clear_bed().is_some());
}

#[test]
fn a_checkpoint_goes_on_to_the_same_bits() {
    let mut straight = in_a_bed(true, 12e3);
    iterate(&mut straight, 33);
    let mut checkpoint = setup::checkpoint();
    resume::keep(&straight, &mut checkpoint).unwrap();
    let mut resumed = in_a_bed(true, 12e3);
    resume::restore(&mut resumed, &mut checkpoint).unwrap();
    for arc in [&mut straight, &mut resumed] {
        iterate(arc, 20);
    }
    for (a, b) in straight.temperature().iter().zip(resumed.temperature()) {
        assert_eq!(a.to_bits(), b.to_bits());
    }
}
