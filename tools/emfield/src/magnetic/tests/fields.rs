use num_complex::Complex;

use krylov::{Options, Rule, System};

use crate::magnetic::diffusion::{Conductors, shift};
use crate::magnetic::driven::right::Drive;
use crate::magnetic::fields::{Fields, Media, Solution, steady_change};
use crate::magnetic::medium::interface::Acting;
use crate::magnetic::medium::law::Law;
use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::source::{Loop, MU0, Source};
use crate::magnetic::totals::Totals;
use crate::magnetic::unknown::Unknown;
use crate::stencils::quadrature;
use crate::stencils::sides::{Form, Sides};
use crate::stencils::tests::shells;

/// Four loops of thick wire below a ball of 2.5 mm, as in Matsuzawa (2017), section 4.2; lengths in
/// radii of the ball.
fn coils() -> Source {
    let one = |k: u32| Loop {
        centre: [0.0, 0.0, -1.4 - 0.5 * f64::from(k)],
        axis: [0.0, 0.0, 1.0],
        radius: 1.0 + 0.5 * f64::from(k),
        wire_radius: 0.2,
        current: Complex::new(200.0, 0.0),
    };
    Source {
        loops: (0..4).flat_map(|k| one(k).filaments()).collect(),
        ..Source::default()
    }
}

fn levitated(frequency: f64, across: f64, along: f64, order: u8) -> Totals {
    let (region, cells) = shells(across, along);
    let form = Form {
        order,
        ..Form::default()
    };
    let sides = Sides::new(&region, &form).unwrap();
    // In radii, sigma R^2 takes the place of sigma.
    let sigma = 1e7 * 2.5e-3_f64.powi(2);
    let omega = std::f64::consts::TAU * frequency;
    let conductors = Conductors {
        mu_sigma: vec![0.0, MU0 * sigma],
        axial: None,
        permeable: None,
    };
    let source = coils();
    let drive = Drive {
        omega,
        source: source.potential(&region.places),
        held: [Complex::default(); 3],
    };
    let weights = quadrature::weights(&region, &cells, &form).unwrap();
    let unknown = Unknown::Potential;
    let rates = conductors.rates(&region, &sides, unknown);
    let mut right = drive.right(&conductors, &region, unknown, &rates);
    let multipoles = Multipoles::new(&region, &weights);
    let pairs = drive.pairs(&conductors, &region, unknown, &multipoles, &mut right);
    let rows = conductors.rows(&region, &sides, unknown);
    let shift = shift(&rates, omega);
    let mut system = System::new(rows, shift, Options::default()).unwrap();
    let mut found = vec![[Complex::default(); 3]; region.len()];
    let rule = Rule {
        reduction: 1e-8,
        ..Rule::default()
    };
    let solved = system.solve_with(&pairs, &right, &mut found, rule);
    assert!(solved.converged(), "{}", solved.ending);
    let flux = source.flux(&region.places);
    let media = Media {
        conductivity: &[0.0, sigma],
        laws: &[Law::Constant(MU0), Law::Constant(MU0)],
        flux: &flux,
    };
    let fields = Fields::new(
        &region,
        &sides,
        unknown,
        Solution {
            found: &found,
            source: &drive.source,
            change: &steady_change(omega, &found, &drive.source),
            waves: None,
        },
        &media,
    );
    let acting = Acting {
        acts: &[false, true],
        laws: &[Law::Constant(MU0), Law::Constant(MU0)],
        permeable: None,
    };
    Totals::of(&region, &fields, &weights, &source, None, acting)
}

#[test]
fn a_levitated_drop_has_its_exact_lift_and_heat() {
    // In spherical harmonics: 0.026570 N and 16.337 W; in lengths of R, heat is that over R.
    let totals = levitated(1e5, 0.045, 0.16, 4);
    let heat = totals.heat_volume * 2.5e-3;
    assert!(
        (totals.force_coil[2] / 0.026_570 - 1.0).abs() < 0.01,
        "{totals:?}"
    );
    assert!(
        (totals.force_volume[2] / 0.026_570 - 1.0).abs() < 0.02,
        "{totals:?}"
    );
    assert!((heat / 16.337 - 1.0).abs() < 0.015, "{totals:?}");
    assert!(totals.spread() < 0.06 * 0.026_570);
}

#[test]
fn where_nothing_conducts_nothing_is_driven() {
    let (region, _) = shells(0.2, 0.4);
    let sides = Sides::new(&region, &Form::default()).unwrap();
    let conductors = Conductors {
        mu_sigma: vec![0.0, 0.0],
        axial: None,
        permeable: None,
    };
    assert!(conductors.none());
    let rates = conductors.rates(&region, &sides, Unknown::Potential);
    assert!(rates.iter().all(|r| *r == 0.0));
    let drive = Drive {
        omega: 1e3,
        source: coils().potential(&region.places),
        held: [Complex::default(); 3],
    };
    let right = drive.right(&conductors, &region, Unknown::Potential, &rates);
    assert!(right.iter().flatten().all(|r| r.norm() == 0.0));
}
