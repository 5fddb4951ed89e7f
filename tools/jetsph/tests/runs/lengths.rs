//! Solids that break by the mean of their strain over a length.

use super::{BROKEN, CUT, begun, bits, bits_are_the_same, is_taken_up, parsed, steps};
use jetsph::assemble::assemble;

/// The block that a jet breaks, over a length \[m\].
fn over(length: f64) -> String {
    CUT.replace(
        r#""fracture": {"#,
        &format!(r#""fracture_length_m": {length}, "fracture": {{"#),
    )
}

#[test]
fn over_one_spacing_a_cell_breaks_by_itself() {
    let after = |scene: &str| {
        let mut run = begun(scene);
        steps(&mut run, 1000);
        assert!(run.state.sets[0].column(&BROKEN).contains(&1));
        bits(&run.state)
    };
    assert_eq!(after(CUT), after(&over(0.002)));
}

#[test]
fn bits_are_the_same_on_any_threads_and_after_a_checkpoint() {
    let scene = over(0.004);
    bits_are_the_same(&scene);
    is_taken_up(&scene);
}

#[test]
fn lengths_without_sense_are_refused() {
    let refused = |scene: &str| {
        let faults = assemble(&parsed(scene)).err().unwrap();
        let said: String = faults.iter().map(ToString::to_string).collect();
        assert!(said.contains("/solids/0/fracture_length_m"), "{said}");
        said
    };
    assert!(refused(&over(0.001)).contains("less than the spacing of 0.002 m"));
    assert!(refused(&over(0.2)).contains("1.000e2 spacings, at most 64"));
    let by_energy = over(0.004).replace("\"equivalent_strain\": 0.1", "\"energy_release_j_m2\": 1");
    assert!(refused(&by_energy).contains("an energy has no length"));
    let whole = over(0.004).replace(r#", "fracture": {"equivalent_strain": 0.1}"#, "");
    assert!(refused(&whole).contains("nothing breaks"));
}
