//! The electric field on points that move, against exact ones.

use shapes::Body;
use shapes::shape::{Shape, Sphere};

use super::*;
use crate::liquid::fill::{Filled, fill};

const FIELD: f64 = 2e6;

fn filled(radius: f64, parts: f64) -> Filled<3> {
    let shape = Shape::Sphere(Sphere {
        name: None,
        centre_m: vec![0.0; 3],
        radius_m: radius,
    });
    fill::<3>(&Body::new(&shape, 3), radius / parts)
}

fn place(filled: &Filled<3>, spacing: f64) -> Place<'_> {
    Place::of(&filled.position, &filled.normal, spacing)
}

fn pulled(electric: &mut Electric, place: Place<'_>) -> (Vec<f64>, Effort) {
    let mut effort = Effort::default();
    let stood = electric.stand(place).unwrap();
    let sides = electric.fit(&stood).unwrap();
    let rule = Rule {
        reduction: 1e-9,
        ..Rule::default()
    };
    let pull = electric.traction(&stood, &sides, rule, &mut effort);
    assert_eq!(effort.field_unsolved, 0);
    (pull.unwrap(), effort)
}

fn applied(permittivity: Option<f64>) -> Applied {
    Applied {
        field: [0.0, 0.0, FIELD],
        permittivity,
        leak: None,
        charge: 0.0,
    }
}

/// Traction on a sphere: of the even field inside, or of the field outside a conductor.
fn exact(permittivity: Option<f64>, cosine: f64) -> f64 {
    let whole = EPS0 * FIELD * FIELD;
    match permittivity {
        None => 4.5 * whole * cosine * cosine,
        Some(s) => {
            let inside = 3.0 / (s + 2.0);
            let square = cosine * cosine;
            0.5 * whole * (s - 1.0) * inside * inside * (s * square + 1.0 - square)
        }
    }
}

/// Largest lack of a traction over the largest exact one, and how far its part along P_2 is off.
fn lack(pull: &[f64], place: Place<'_>, wanted: impl Fn(f64) -> f64) -> [f64; 2] {
    let (mut most, mut found, mut own, mut scale) = (0.0_f64, 0.0, 0.0, 0.0_f64);
    for (p, n) in pull.iter().zip(place.skin.normal) {
        let exact = wanted(n[2]);
        let p2 = 1.5 * n[2] * n[2] - 0.5;
        most = most.max((p - exact).abs());
        scale = scale.max(exact.abs());
        found += p * p2;
        own += exact * p2;
    }
    [most / scale, (found / own - 1.0).abs()]
}

/// Of any size: fields know no length of their own.
#[test]
fn a_sphere_in_an_even_field_is_pulled_as_exactly_known() {
    for (radius, s) in [(5e-5, Some(80.0)), (2.5e-6, Some(2.0)), (5e-3, None)] {
        let filled = filled(radius, 5.0);
        let place = place(&filled, radius / 5.0);
        let mut electric = Electric::new(applied(s), 3);
        let (pull, _) = pulled(&mut electric, place);
        let [most, p2] = lack(&pull, place, |cosine| exact(s, cosine));
        assert!(most < 1.5e-2 && p2 < 1e-2, "{s:?}: {most:e} {p2:e}");
    }
}

/// En = 3 E cos + Q/(4 pi eps0 R^2): the pull of both at once adds up to the force Q E; and V = Q/(4 pi eps0 R).
#[test]
fn a_charged_conductor_is_pulled_along_the_field() {
    let radius = 5e-5;
    let filled = filled(radius, 5.0);
    let place = place(&filled, radius / 5.0);
    let charge = 1e-12;
    let height = charge / (4.0 * std::f64::consts::PI * EPS0 * radius);
    let mut electric = Electric::new(
        Applied {
            charge,
            ..applied(None)
        },
        3,
    );
    let (pull, _) = pulled(&mut electric, place);
    assert!((electric.height / height - 1.0).abs() < 2e-3);
    let wanted = |cosine: f64| 0.5 * EPS0 * (3.0 * FIELD * cosine + height / radius).powi(2);
    let [most, p2] = lack(&pull, place, wanted);
    assert!(most < 1.5e-2 && p2 < 1e-2, "{most:e} {p2:e}");
    // The mean of P_1 over the surface is a third of its factor.
    let along: f64 = pull
        .iter()
        .zip(place.skin.normal)
        .map(|(p, n)| p * n[2])
        .sum();
    let force = along / pull.len() as f64 * 4.0 * std::f64::consts::PI * radius * radius;
    let exact = electric.force()[2];
    assert!((force / exact - 1.0).abs() < 1e-2, "{force:e} {exact:e}");
}

/// A drop that has moved by a part of a spacing keeps its air, its far rows and its factors; the field is that of one that
/// knows nothing of the past.
#[test]
fn a_field_that_goes_on_is_that_of_a_new_one() {
    let spacing = 1e-5;
    let mut filled = filled(5e-5, 5.0);
    let mut electric = Electric::new(applied(Some(80.0)), 3);
    let _ = pulled(&mut electric, place(&filled, spacing));
    for x in &mut filled.position {
        x[2] += 0.4 * spacing;
    }
    let place = place(&filled, spacing);
    let (kept, effort) = pulled(&mut electric, place);
    assert_eq!(electric.renewed(), 1);
    assert!(effort.field_products < 60, "{}", effort.field_products);
    let [most, p2] = lack(&kept, place, |cosine| exact(Some(80.0), cosine));
    assert!(most < 1.5e-2 && p2 < 1e-2, "{most:e} {p2:e}");
    for x in &mut filled.position {
        x[2] += 2.0 * spacing;
    }
    let _ = pulled(&mut electric, self::place(&filled, spacing));
    assert_eq!(electric.renewed(), 2);
}

/// Rows that stay against rows of the same points made anew, where they are fine enough that some stay. A few of them, on
/// supports of a lattice that are symmetric, choose by rounding alone between two fits that are as good: both are exact.
#[test]
fn rows_that_stay_are_those_made_anew() {
    let spacing = 5e-5 / 8.0;
    let mut filled = filled(5e-5, 8.0);
    let mut electric = Electric::new(applied(None), 3);
    electric.stand(place(&filled, spacing)).unwrap();
    for x in &mut filled.position {
        x[0] += 0.7 * spacing;
    }
    let stood = electric.stand(place(&filled, spacing)).unwrap();
    assert_eq!(electric.renewed(), 1);
    let kept = electric.kept.as_ref().unwrap();
    let rows = kept.against_fresh(&stood.region, &electric.form);
    let mut chosen = 0;
    for (i, [kept, fresh]) in &rows {
        let both = kept.iter().zip(fresh);
        assert_eq!(kept.len(), fresh.len());
        assert!(both.clone().all(|(a, b)| a.0 == b.0));
        if both.map(|(a, b)| (a.1 - b.1).abs()).fold(0.0, f64::max) < 1e-12 {
            continue;
        }
        chosen += 1;
        for row in [kept, fresh] {
            assert!(lack_of_harmonics(*i, row, &stood.region) < 1e-10, "{i}");
        }
    }
    assert!(
        rows.len() > 500 && 500 * chosen < rows.len(),
        "{chosen} of {}",
        rows.len()
    );
}

/// How far a row that gives a value from those around it is from harmonic quadratics.
fn lack_of_harmonics(i: usize, row: &[(usize, f64)], region: &Region<3>) -> f64 {
    let harmonics: [fn([f64; 3]) -> f64; 7] = [
        |_| 1.0,
        |[x, ..]| x,
        |[_, y, _]| y,
        |[.., z]| z,
        |[x, y, _]| x * y,
        |[x, _, z]| x * x - z * z,
        |[x, y, z]| x * x + y * y - 2.0 * z * z + y * z,
    ];
    let scaled = |j: usize| {
        let off: [f64; 3] = std::array::from_fn(|k| region.places[j][k] - region.places[i][k]);
        off.map(|c| c / region.metrics[i].spacing())
    };
    let lack = |f: fn([f64; 3]) -> f64| {
        let sum: f64 = row.iter().map(|(j, w)| w * f(scaled(*j))).sum();
        (sum - f([0.0; 3])).abs()
    };
    harmonics.map(lack).into_iter().fold(0.0, f64::max)
}
