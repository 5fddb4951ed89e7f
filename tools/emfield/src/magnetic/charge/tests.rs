use krylov::{Options, Rule};

use crate::magnetic::charge::equations::Coupled;
use crate::magnetic::charge::parts::Parts;
use crate::magnetic::charge::potential::{Charge, Side};
use crate::magnetic::charge::solution::AtRate;
use crate::magnetic::charge::stage::Charged;
use crate::magnetic::diffusion::Conductors;
use crate::magnetic::source::{C, MU0, Origin, Source, Uniform};
use crate::march::scheme::{March, slope};
use crate::stencils::region::Region;
use crate::stencils::sides::{Form, Sides};
use crate::stencils::tests::shells;

const FORM: Form = Form {
    order: 2,
    support: None,
    positive: false,
    harmonic: false,
    around: 1.0,
};

/// Conductivity over R^2 for a skin of half a radius at 100 kHz.
const SIGMA: f64 = 10.0;

/// The potential of a field along z from a magnet, by point.
fn applied(region: &Region<3>, origin: Origin) -> Vec<[C; 3]> {
    let source = Source {
        uniform: vec![Uniform {
            flux: [0.0, 0.0, 1.0].map(C::from),
            origin,
        }],
        ..Source::default()
    };
    source.potential(&region.places)
}

/// The stencils and equations of charges on a ball.
fn ball(region: &Region<3>) -> (Charge, Coupled) {
    let sides = Sides::new(region, &FORM).unwrap();
    let conductivity = [0.0, SIGMA];
    let charge = Charge::new(region, &conductivity, &FORM).unwrap();
    let conductors = Conductors {
        mu_sigma: conductivity.map(|s| MU0 * s).to_vec(),
        axial: None,
        permeable: None,
    };
    let parts = Parts {
        region,
        sides: &sides,
        conductors: &conductors,
        conductivity: &conductivity,
        charge: &charge,
    };
    let coupled = Coupled::new(&parts, None);
    (charge, coupled)
}

const RULE: Rule = Rule::to(1e-12, 2000);

/// `A + A_s + grad phi` within a ball in a field along z from a magnet, by point of the ball; and phi.
fn driven(region: &Region<3>, origin: Origin) -> (Vec<[C; 3]>, Vec<C>, Charge) {
    let (charge, coupled) = ball(region);
    let given = applied(region, origin);
    let rate = C::new(0.0, std::f64::consts::TAU * 1e5);
    let mut push: Vec<C> = given.as_flattened().iter().map(|a| rate * a).collect();
    push.resize(coupled.len(), C::default());
    let pull: Vec<C> = (0..charge.len()).map(|p| coupled.pull(p, &given)).collect();
    let right = coupled.right(&push, 1.0, &pull, &[]);
    let mut factors = AtRate::new(&coupled, rate, &Options::default()).unwrap();
    let mut x = vec![C::default(); coupled.len()];
    let solved = factors.solve(&coupled, right, &mut x, RULE);
    assert!(solved.converged(), "{}", solved.ending);
    let (a, phi) = x.split_at(3 * region.len());
    let (a, phi) = (a.as_chunks::<3>().0, coupled.whole(phi));
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
    (all.collect(), phi, charge)
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
fn quadratics_are_exact_in_layers_thinner_than_their_surface_bends() {
    let (mut region, _) = shells(0.01, 0.25);
    for metric in &mut region.metrics {
        if let Some([x, y, z]) = metric.normal() {
            let across = if z.abs() < 0.9 {
                [-y, x, 0.0]
            } else {
                [0.0, -z, y]
            };
            let size = across.iter().map(|a| a * a).sum::<f64>().sqrt();
            *metric = metric.bent(across.map(|a| a / size), [1.0, 1.0]);
        }
    }
    let charge = Charge::new(&region, &[0.0, SIGMA], &FORM).unwrap();
    let phi = |q: usize| {
        let x = region.places[charge.points[q] as usize];
        x[0] * x[1] - 0.3 * x[2] * x[0] + 0.2 * x[2]
    };
    for i in charge.points.iter().map(|i| *i as usize) {
        let x = region.places[i];
        let mut left = [x[1] - 0.3 * x[2], x[0], 0.2 - 0.3 * x[0]];
        for (q, w) in charge.gradient(i, Side::Inner) {
            for k in 0..3 {
                left[k] -= phi(q) * w[k];
            }
        }
        assert!(left.iter().all(|x| x.abs() < 1e-9), "{x:?}: {left:?}");
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

/// Times of the diffusion through the ball that a march takes.
const END: f64 = 0.2;

/// Rates of `A + A_s + grad phi`, by point of the ball, and V after a march; the field rises as `wave` of the time over
/// that of the diffusion.
fn marched(
    region: &Region<3>,
    origin: Origin,
    steps: u32,
    wave: fn(f64) -> f64,
) -> (Vec<[f64; 3]>, Vec<f64>) {
    let (charge, coupled) = ball(region);
    let given: Vec<[f64; 3]> = applied(region, origin)
        .iter()
        .map(|a| a.map(|a| a.re))
        .collect();
    let time = MU0 * SIGMA;
    let step = END * time / f64::from(steps);
    let (slope, options) = (slope(step), Options::default());
    let stage = Charged::new(&coupled, &given, Vec::new(), slope, options).unwrap();
    let source = given.into_flattened();
    let mut march = March::new(Box::new(stage), source, coupled.len(), step);
    for k in 0..steps {
        let at = |t: f64| Ok::<f64, std::convert::Infallible>(wave(t / time));
        let solved = march.advance(f64::from(k) * step, at, RULE).unwrap();
        assert!(solved.iter().all(|s| s.converged()), "{solved:?}");
    }
    let state = march.state();
    let (change, phi) = state.change.split_at(3 * region.len());
    let (change, phi) = (change.as_chunks::<3>().0, coupled.whole(phi));
    let all = charge.points.iter().map(|i| {
        let mut sum = change[*i as usize];
        for (q, w) in charge.gradient(*i as usize, Side::Inner) {
            for k in 0..3 {
                sum[k] += phi[q] * w[k];
            }
        }
        sum.map(|e| e * time)
    });
    let voltage = coupled.whole(&state.following);
    (all.collect(), voltage.iter().map(|v| v * time).collect())
}

/// The largest difference.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let each = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    each.fold(0.0, f64::max)
}

#[test]
fn a_march_drives_the_same_whatever_the_magnet() {
    let (region, _) = shells(0.2, 0.4);
    let (round, still) = marched(&region, Origin::Solenoid([0.0; 3]), 3, |_| 1.0);
    let (flat, voltage) = marched(&region, Origin::Sheets([1.0, 0.0, 0.0]), 3, |_| 1.0);
    let most = apart(round.as_flattened(), &vec![0.0; 3 * round.len()]);
    let far = apart(round.as_flattened(), flat.as_flattened());
    assert!(most > 0.1 && far < 1e-6 * most, "{far:e} of {most:e}");
    // What was switched on at once charged the ball at once.
    let far = apart(&voltage, &still);
    assert!(far < 1e-6, "{far:e}");
}

#[test]
fn charges_follow_what_rises_with_second_order_in_time() {
    let (region, _) = shells(0.25, 0.5);
    let rises: fn(f64) -> f64 = |t| (5.0 * t).sin();
    let run = |steps, origin| marched(&region, origin, steps, rises);
    let sheets = Origin::Sheets([1.0, 0.0, 0.0]);
    let [a, b, c] = [2, 4, 8].map(|steps| run(steps, sheets));
    // V of the sheets is that of the solenoid less the rate of x y / 2.
    let (_, still) = run(8, Origin::Solenoid([0.0; 3]));
    let rate = 5.0 * (5.0 * END).cos();
    let (charge, _) = ball(&region);
    let turned = charge.points.iter().map(|i| {
        let x = region.places[*i as usize];
        0.5 * rate * x[0] * x[1]
    });
    let known: Vec<f64> = turned.zip(&still).map(|(t, v)| v - t).collect();
    let mean = known.iter().sum::<f64>() / known.len() as f64;
    let known: Vec<f64> = known.iter().map(|v| v - mean).collect();
    let off = [&a, &b, &c].map(|run| apart(&run.1, &known));
    assert!(off[2] < 0.03, "{off:?}");
    assert!(off[1] > 3.0 * off[2] && off[0] > 3.0 * off[1], "{off:?}");
    // Fields err by their points too, which does not fall with the step.
    let [a, b, c] = [&a, &b, &c].map(|run| run.0.as_flattened());
    let (coarse, fine) = (apart(a, b), apart(b, c));
    assert!(coarse > 3.0 * fine, "{coarse:e} {fine:e}");
}

#[test]
fn bodies_apart_have_constants_of_their_own() {
    let (mut region, _) = shells(0.3, 0.5);
    let one = Charge::new(&region, &[0.0, 1.0], &FORM).unwrap();
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
    assert!(Charge::new(&region, &[0.0, 0.0], &FORM).unwrap().is_empty());
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
            crate::stencils::region::Kind::Interface(f) => {
                crate::stencils::region::Kind::Interface(f + first.faces.len() as u32)
            }
            other => *other,
        }));
    region.wall_normals.extend(first.wall_normals.iter());
    for face in &first.faces {
        let mut face = *face;
        face.point += first.len() as u32;
        region.faces.push(face);
    }
    let two = Charge::new(&region, &[0.0, 1.0], &FORM).unwrap();
    assert_eq!(two.bodies, vec![0..one.len(), one.len()..2 * one.len()]);
}
