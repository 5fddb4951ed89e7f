//! Recombined iterations lead where plain ones do, and go on from a checkpoint to the same bits.

use arcfvm::assemble::assemble;
use arcfvm::march::recombination::Recombination;
use arcfvm::resume;
use arcfvm::scene::Scene;
use arcfvm::settings::Settings;
use arcfvm::solver::Arc;

use crate::setup;

/// A small arc between wire and plate in argon.
fn an_arc() -> Arc {
    let scene = setup::scene("pipelines/verify/arc-surface/scene.json");
    let scene: Scene = serde_json::from_value(scene).unwrap();
    let gas = serde_json::from_value(setup::json("pipelines/gases/argon-1atm.json")).unwrap();
    let case = assemble(&scene, Some(&gas)).unwrap();
    Arc::new(case, Settings::from(&scene.iterate))
}

/// Iterates `times`; gives the last of the greatest residuals.
fn iterate(arc: &mut Arc, recombination: &mut Option<Recombination>, times: usize) -> f64 {
    let mut worst = f64::INFINITY;
    for _ in 0..times {
        let residuals = arc.iterate(&mut ()).unwrap();
        worst = residuals.worst();
        if let Some(recombination) = recombination {
            recombination.recombine(arc, &residuals);
        }
    }
    worst
}

/// Iterations, recombined or not, until the greatest residual is below 1e-9.
fn until_at_rest(arc: &mut Arc, recombination: &mut Option<Recombination>) -> usize {
    (1..2000)
        .find(|_| iterate(arc, recombination, 1) < 1e-9)
        .unwrap()
}

/// How many they are goes with the last bits of the arc they begin at, so that several are looked at.
#[test]
fn they_lead_where_plain_iterations_do_and_most_of_them_sooner() {
    let mut plain = an_arc();
    let slow = until_at_rest(&mut plain, &mut None);
    let mut counts = [50, 55, 65, 70, 80].map(|before| {
        let mut mixed = an_arc();
        iterate(&mut mixed, &mut None, before);
        let mut recombination = Some(Recombination::new(&mut mixed));
        let count = before + until_at_rest(&mut mixed, &mut recombination);
        for (a, b) in plain.temperature().iter().zip(mixed.temperature()) {
            assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
        }
        count
    });
    counts.sort_unstable();
    assert!(counts[2] < slow, "{counts:?} {slow}");
}

#[test]
fn a_checkpoint_goes_on_to_the_same_bits() {
    let mut straight = an_arc();
    iterate(&mut straight, &mut None, 30);
    let mut recombination = Some(Recombination::new(&mut straight));
    iterate(&mut straight, &mut recombination, 14);
    let mut checkpoint = setup::checkpoint();
    resume::keep(&straight, &mut checkpoint).unwrap();
    let kept = recombination.as_ref().unwrap();
    kept.keep(&mut checkpoint).unwrap();
    let mut resumed = an_arc();
    resume::restore(&mut resumed, &mut checkpoint).unwrap();
    let mut restored = Some(Recombination::restored(&mut checkpoint).unwrap());
    iterate(&mut straight, &mut recombination, 9);
    iterate(&mut resumed, &mut restored, 9);
    for (a, b) in straight.temperature().iter().zip(resumed.temperature()) {
        assert_eq!(a.to_bits(), b.to_bits());
    }
}
