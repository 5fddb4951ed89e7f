//! Flux that takes up radiation behind the wall that it falls on.

use arcfvm::assemble::assemble;
use arcfvm::bed;
use arcfvm::resume;
use arcfvm::scene::Scene;
use arcfvm::settings::Settings;
use arcfvm::solver::Arc;
use serde_json::json;

use crate::setup;

/// A small submerged arc; `length` is that of absorption \[m\].
fn an_arc(length: Option<f64>) -> Arc {
    let mut scene = setup::scene("pipelines/stability/bed/arc.json");
    let flux = &mut scene["bodies"]["flux"];
    flux["moving"] = json!({"speed_m_s": 0.005, "ahead_m": 0.005});
    if let Some(length) = length {
        flux["granular"]["absorption_length_m"] = json!(length);
    }
    let scene: Scene = serde_json::from_value(scene).unwrap();
    let case = assemble(&scene, None).unwrap();
    Arc::new(case, Settings::from(&scene.iterate))
}

fn iterate(arc: &mut Arc, times: usize) {
    for _ in 0..times {
        arc.iterate(&mut ()).unwrap();
    }
}

#[test]
fn what_is_taken_up_at_the_wall_melts_more() {
    let found = |length| {
        let mut arc = an_arc(length);
        iterate(&mut arc, 300);
        let balance = arc.settle().unwrap();
        let sources = &arc.heating.as_ref().unwrap().sources;
        let radiation = sources.granular;
        let part = 0.8 * sources.emission.iter().sum::<f64>();
        assert!((radiation / part - 1.0).abs() < 1e-12);
        assert!(
            balance.closure().abs() < 1e-4 * part,
            "{}",
            balance.closure()
        );
        bed::figures::measure(&arc).unwrap()
    };
    let [even, wall] = [None, Some(5e-4)].map(found);
    assert!(wall.slag_volume > even.slag_volume, "{even:?} {wall:?}");
}

#[test]
fn slag_by_heat_holds_the_heat_of_the_bed() {
    let mut arc = an_arc(Some(5e-4));
    iterate(&mut arc, 100);
    arc.settle();
    let bed = bed::figures::measure(&arc).unwrap();
    // From 600 K to the end of melting at 2870 K: 1200 J/(kg K), and 5e5 J/kg of fusion; 3230 kg/m3 at 5 mm/s.
    let rise = 1200.0 * 2270.0 + 5e5;
    let radiation = arc.heating.as_ref().unwrap().sources.granular;
    let heat = radiation + bed.convection - bed.into_metal;
    let want = heat / (3230.0 * 0.005 * rise);
    assert!(
        (bed.by_heat / want - 1.0).abs() < 1e-3,
        "{} {want}",
        bed.by_heat
    );
}

#[test]
fn a_checkpoint_goes_on_to_the_same_bits() {
    let mut straight = an_arc(Some(1e-3));
    iterate(&mut straight, 30);
    let mut checkpoint = setup::checkpoint();
    resume::keep(&straight, &mut checkpoint).unwrap();
    let mut resumed = an_arc(Some(1e-3));
    resume::restore(&mut resumed, &mut checkpoint).unwrap();
    for arc in [&mut straight, &mut resumed] {
        iterate(arc, 20);
    }
    for (a, b) in straight.temperature().iter().zip(resumed.temperature()) {
        assert_eq!(a.to_bits(), b.to_bits());
    }
}
