//! Heat between grains, and bounds of steps.

use contact::{heat, steps};

#[test]
fn two_half_spaces_conduct_two_k_r() {
    let h = heat::constriction([3.0, 3.0], 1e-4);
    assert!((h / (2.0 * 3.0 * 1e-4) - 1.0).abs() < 1e-14);
    assert!((heat::constriction_as_printed([3.0, 3.0], 1e-4) / h - 0.5).abs() < 1e-14);
    // Against a perfect conductor all resistance is in one half-space: 4 k r.
    let one = heat::constriction([3.0, 3e12], 1e-4);
    assert!((one / (4.0 * 3.0 * 1e-4) - 1.0).abs() < 1e-9);
}

#[test]
fn the_contact_of_a_push_does_not_hang_on_the_soft_spring() {
    // A grain of 0.5 mm that carries 1 mN rests on springs of 75 N/m and of 1e5 N/m: 13 um and 10 nm deep.
    let by_overlap = |k: f64| heat::radius_by_overlap(2.5e-4, 5e-4 - 1e-3 / k);
    assert!(by_overlap(75.0) / by_overlap(1e5) > 30.0);
    let by_force = heat::radius_by_force(1e-3, 1.25e-4, 3.5e10);
    assert!((by_force - (0.75 * 1e-3 * 1.25e-4 / 3.5e10_f64).cbrt()).abs() < 1e-20);
}

#[test]
fn gas_conducts_less_as_the_contact_grows() {
    let whole = heat::gas(0.05, 2.5e-4, 0.0);
    let exact = 0.05 * std::f64::consts::TAU * 2.5e-4 / (1.0 - 0.25 * std::f64::consts::PI);
    assert!((whole / exact - 1.0).abs() < 1e-14);
    assert!(heat::gas(0.05, 2.5e-4, 1e-4) < whole);
    assert!(heat::gas(0.05, 2.5e-4, 2.5e-4).abs() < 1e-18);
}

#[test]
fn steps_of_the_paper_are_bounded_as_its_springs_ask() {
    // d = 0.5 mm, 3230 kg/m3, 75 N/m: 75 and 40 us for a pair, 22 and 12 us with twelve contacts.
    let pair = steps::Pair {
        mass: 3230.0 * std::f64::consts::PI / 6.0 * 0.5e-3_f64.powi(3),
        stiffness: 75.0,
        tangential: 75.0,
        inertia_factor: steps::SOLID_SPHERE,
        damping_ratio: 0.0,
    };
    for (found, told) in [
        (pair.normal_bound(1.0), 75e-6),
        (pair.tangential_bound(1.0), 40e-6),
        (pair.normal_bound(12.0), 22e-6),
        (pair.tangential_bound(12.0), 12e-6),
    ] {
        assert!((found / told - 1.0).abs() < 0.05, "{found} {told}");
    }
}
