use num_complex::Complex;

use krylov::{Options, Rule};

use super::super::charge::{Charge, Side};
use super::super::coupled::{Coupled, Parts};
use super::super::diffusion::Conductors;
use super::super::factors;
use super::super::region::Region;
use super::super::sides::{Form, Sides};
use super::shells;
use crate::source::{MU0, Origin, Source, Uniform};

type C = Complex<f64>;

const FORM: Form = Form {
    order: 2,
    support: None,
    positive: false,
    harmonic: false,
    around: 1.0,
};

/// Conductivity over R^2 for a skin of half a radius at 100 kHz.
const SIGMA: f64 = 10.0;

/// `A + A_s + grad phi` within a ball in a field along z from a magnet, by point of the ball; and phi.
fn driven(region: &Region<3>, origin: Origin) -> (Vec<[C; 3]>, Vec<C>, Charge) {
    let sides = Sides::new(region, &FORM).unwrap();
    let conductivity = [0.0, SIGMA];
    let charge = Charge::new(region, &conductivity, &FORM).unwrap().unwrap();
    let conductors = Conductors {
        mu_sigma: conductivity.map(|s| MU0 * s).to_vec(),
    };
    let source = Source {
        uniform: vec![Uniform {
            flux: [0.0, 0.0, 1.0].map(C::from),
            origin,
        }],
        ..Source::default()
    };
    let given = source.potential(&region.places);
    let parts = Parts {
        region,
        sides: &sides,
        conductors: &conductors,
        conductivity: &conductivity,
        charge: &charge,
        omega: std::f64::consts::TAU * 1e5,
    };
    let coupled = Coupled::new(&parts, (&given, &[]), None);
    let rule = Rule {
        reduction: 1e-12,
        ..Rule::default()
    };
    let solved = factors::solve(&parts, &coupled, (&Options::default(), rule)).unwrap();
    let ((a, phi), solved) = solved;
    assert!(solved.converged(), "{}", solved.ending);
    let all = charge.points.iter().map(|i| {
        let i = *i as usize;
        let mut sum: [C; 3] = std::array::from_fn(|k| a[i][k] + given[i][k]);
        for (q, w) in charge.gradient(i, Side::Inner) {
            for k in 0..3 {
                sum[k] += phi[q] * w[k];
            }
        }
        sum
    });
    (all.collect(), phi.clone(), charge)
}

#[test]
fn a_magnet_between_sheets_drives_what_a_solenoid_drives() {
    let (region, _) = shells(0.15, 0.3);
    let (round, still, charge) = driven(&region, Origin::Solenoid([0.0; 3]));
    let (flat, phi, _) = driven(&region, Origin::Sheets([1.0, 0.0, 0.0]));
    let (far, _, _) = driven(&region, Origin::Solenoid([3.0, -2.0, 5.0]));
    for ((a, b), c) in round.iter().zip(&flat).zip(&far) {
        for k in 0..3 {
            assert!((a[k] - b[k]).norm() < 1e-6, "{a:?} {b:?}");
            assert!((a[k] - c[k]).norm() < 1e-6, "{a:?} {c:?}");
        }
    }
    // A of the sheets is that of the solenoid and grad (x y / 2); a constant is free.
    let known = |i: &u32| {
        let x = region.places[*i as usize];
        0.5 * x[0] * x[1]
    };
    let apart: Vec<C> = phi.iter().zip(&still).map(|(a, b)| a - b).collect();
    let sums = apart.iter().zip(&charge.points).map(|(p, i)| p + known(i));
    let mean = sums.sum::<C>() / phi.len() as f64;
    for (phi, i) in apart.iter().zip(&charge.points) {
        assert!((phi + known(i) - mean).norm() < 1e-6, "{phi}, {mean}");
    }
}

#[test]
fn no_current_leaves_the_ball() {
    let (region, _) = shells(0.15, 0.3);
    let (all, _, charge) = driven(&region, Origin::Sheets([0.0, 1.0, 0.0]));
    for face in &region.faces {
        let p = charge.unknown(face.point as usize).unwrap();
        let out: C = (0..3).map(|k| all[p][k] * face.normal[k]).sum();
        assert!(out.norm() < 1e-7, "{out}");
    }
}

#[test]
fn bodies_apart_have_constants_of_their_own() {
    let (mut region, _) = shells(0.3, 0.5);
    let one = Charge::new(&region, &[0.0, 1.0], &FORM).unwrap().unwrap();
    assert_eq!(one.bodies, vec![0..one.len()]);
    assert_eq!(
        one.len(),
        region
            .kinds
            .iter()
            .enumerate()
            .filter(|(i, _)| region.touches(*i, 1))
            .count()
    );
    // Nothing conducts: no unknowns.
    assert!(Charge::new(&region, &[0.0, 0.0], &FORM).unwrap().is_none());
    // A second ball beside the first.
    let first = region.clone();
    let far = 20.0;
    for (place, metric) in first.places.iter().zip(&first.metrics) {
        region.places.push([place[0] + far, place[1], place[2]]);
        region.metrics.push(*metric);
    }
    region
        .kinds
        .extend(first.kinds.iter().map(|kind| match kind {
            super::super::region::Kind::Interface(f) => {
                super::super::region::Kind::Interface(f + first.faces.len() as u32)
            }
            other => *other,
        }));
    region.wall_normals.extend(first.wall_normals.iter());
    for face in &first.faces {
        let mut face = *face;
        face.point += first.len() as u32;
        region.faces.push(face);
    }
    let two = Charge::new(&region, &[0.0, 1.0], &FORM).unwrap().unwrap();
    assert_eq!(two.bodies, vec![0..one.len(), one.len()..2 * one.len()]);
}
