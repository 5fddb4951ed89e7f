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
    assert!((electric.heights[0] / height - 1.0).abs() < 2e-3);
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

/// Potentials over Q/(4 pi eps0 R) of two spheres of which one has the charge Q, with `apart` between their centres over R, by the
/// image charges of each (Maxwell 1891, section 173): the capacities are `sinh b sum 1/sinh((2n - 1) b)` and `-sinh b sum
/// 1/sinh(2n b)`, with `cosh b` half of `apart`.
fn beside(apart: f64) -> [f64; 2] {
    let b = (0.5 * apart).acosh();
    let sum = |first: u32| -> f64 {
        let each = (0..60).map(|n| f64::from(2 * n + first));
        b.sinh() * each.map(|k| (k * b).sinh().recip()).sum::<f64>()
    };
    let (own, other) = (sum(1), -sum(2));
    let whole = own * own - other * other;
    [own / whole, -other / whole]
}

/// One has a charge and the other none. The neutral one is attracted as the energy says.
#[test]
fn two_conductors_have_potentials_of_their_own() {
    let (radius, apart, charge) = (5e-5, 3.0, 1e-12);
    let one = filled(radius, 5.0);
    let surface = one.normal.len();
    let both: Vec<[f64; 3]> = [-0.5, 0.5]
        .iter()
        .flat_map(|side| {
            let skin = one.position[..surface].iter();
            skin.map(move |x| [x[0], x[1], x[2] + side * apart * radius])
        })
        .collect();
    let normals = [one.normal.as_slice(), &one.normal].concat();
    let place = Place::of(&both, &normals, radius / 5.0);
    let area = 4.0 * std::f64::consts::PI * radius * radius / surface as f64;
    let mut electric = Electric::new(
        Applied {
            field: [0.0; 3],
            ..applied(None)
        },
        3,
    );
    electric.drops = Some(Drops {
        of: (0..2 * surface).map(|i| u32::from(i >= surface)).collect(),
        area: vec![area; 2 * surface],
        charge: vec![charge, 0.0],
    });
    let (pull, _) = pulled(&mut electric, place);
    let scale = charge / (4.0 * std::f64::consts::PI * EPS0 * radius);
    let wanted = beside(apart);
    for (height, wanted) in electric.heights.iter().zip(wanted) {
        let lack = height / (scale * wanted) - 1.0;
        assert!(lack.abs() < 1e-2, "{lack:e}");
    }
    let sums = [0..surface, surface..2 * surface].map(|own| {
        let force: f64 = own.clone().map(|i| pull[i] * normals[i][2]).sum();
        let held: f64 = electric.charge[own].iter().sum();
        [force * area, held * area]
    });
    assert!((sums[0][1] / charge - 1.0).abs() < 2e-2, "{sums:?}");
    assert!((sums[1][1] / charge).abs() < 2e-2, "{sums:?}");
    // F = -Q^2/2 dp/d(apart).
    let step = 1e-4;
    let slope = (beside(apart + step)[0] - beside(apart - step)[0]) / (2.0 * step);
    let force = 0.5 * charge * scale * slope / radius;
    for (found, wanted) in [(sums[0][0], force), (sums[1][0], -force)] {
        assert!((found / wanted - 1.0).abs() < 5e-2, "{found:e} {wanted:e}");
    }
}

/// Two drops of permittivity 80 and unlike size, nearer to each other than fits reach, attract each other alike. Where fits of one reach
/// into the other they are found to repel.
#[test]
fn drops_near_each_other_pull_alike() {
    let (radius, parts) = (5e-5, 5.0);
    let spacing = radius / parts;
    let large = filled(radius, parts);
    let small = filled(0.7 * radius, 0.7 * parts);
    let rise = 1.7 * radius + 0.8 * spacing;
    let up = |x: &[f64; 3]| [x[0], x[1], x[2] + rise];
    let (m, n) = (large.normal.len(), small.normal.len());
    let positions = |a: &[[f64; 3]], b: &[[f64; 3]]| -> Vec<[f64; 3]> {
        a.iter().copied().chain(b.iter().map(up)).collect()
    };
    let skin = positions(&large.position[..m], &small.position[..n]);
    let all = [skin, positions(&large.position[m..], &small.position[n..])].concat();
    let normals = [large.normal.as_slice(), &small.normal].concat();
    let inside = [large.position.len() - m, small.position.len() - n];
    let counts = [m, n, inside[0], inside[1]].into_iter().zip([0, 1, 0, 1]);
    let of: Vec<u32> = counts
        .flat_map(|(count, k)| std::iter::repeat_n(k, count))
        .collect();
    let mut place = Place::of(&all, &normals, spacing);
    let forces = |place: Place<'_>| {
        let (pull, _) = pulled(&mut Electric::new(applied(Some(80.0)), 3), place);
        let force = |own: std::ops::Range<usize>, area: f64| -> f64 {
            own.map(|i| area * pull[i] * normals[i][2]).sum()
        };
        [
            force(0..m, 1.0 / m as f64),
            force(m..m + n, 0.49 / n as f64),
        ]
    };
    let [a, b] = forces(place);
    assert!(a < 0.0 && b > 0.0, "{a:e} {b:e}");
    place.of = &of;
    let [a, b] = forces(place);
    assert!(a > 0.0 && b < 0.0, "{a:e} {b:e}");
    assert!((a + b).abs() < 5e-2 * (a - b), "{a:e} {b:e}");
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
