//! Drops that meet, part and keep what they have.

use shapes::Body;
use shapes::shape::{EllipsoidShape, Shape, Sphere};

use super::level::Level;
use super::*;
use crate::liquid::fill::fill;
use crate::liquid::matter::Way;

const SPACING: f64 = 0.2;
const RULE: Rule = Rule {
    join: 0.5,
    part: 1.2,
};

fn way() -> Way {
    Way {
        spacing: SPACING,
        order: 3,
        tolerance: 1e-9,
        products: 1000,
    }
}

/// A liquid that fills a shape and moves at a velocity.
fn filled(shape: &Shape, moves: impl Fn(&[f64; 3]) -> [f64; 3]) -> Liquid<3> {
    let filled = fill::<3>(&Body::new(shape, 3), SPACING);
    Liquid {
        velocity: filled.position.iter().map(moves).collect(),
        rate: vec![[0.0; 3]; filled.position.len()],
        pressure: vec![0.0; filled.position.len()],
        stress: vec![0.0; filled.normal.len()],
        position: filled.position,
        normal: filled.normal,
        ..Liquid::default()
    }
}

fn ball(centre: [f64; 3], radius: f64, velocity: [f64; 3]) -> Group {
    let shape = Shape::Sphere(Sphere {
        name: None,
        centre_m: centre.to_vec(),
        radius_m: radius,
    });
    Group::new(filled(&shape, |_| velocity), SPACING).unwrap()
}

/// Volume, and its sums with centres and velocities.
fn totals(groups: &Groups) -> [f64; 7] {
    let drops = groups.drops.iter().map(|g| (g.volume, g.centre, g.drift));
    let parcels = groups.parcels.iter().map(|p| (p.volume, p.centre, p.drift));
    let mut sum = [0.0; 7];
    for (v, x, u) in drops.chain(parcels) {
        sum[0] += v;
        for k in 0..3 {
            sum[1 + k] += v * x[k];
            sum[4 + k] += v * u[k];
        }
    }
    sum
}

fn kept(before: &[f64; 7], after: &[f64; 7]) {
    for (a, b) in before.iter().zip(after) {
        assert!((a - b).abs() < 1e-12 * before[0], "{before:?} {after:?}");
    }
}

#[test]
fn drops_that_approach_become_one_and_others_do_not() {
    let gap = 0.3 * SPACING;
    let pair = |speed: f64| Groups {
        drops: vec![
            ball([0.0, 0.0, -1.0 - 0.5 * gap], 1.0, [0.0, 0.1, speed]),
            ball([0.2, 0.0, 0.8 + 0.5 * gap], 0.8, [0.0, 0.0, -speed]),
        ],
        parcels: Vec::new(),
    };
    let mut leaving = pair(-1.0);
    assert_eq!(leaving.join(&RULE, &way()).unwrap(), 0);
    let mut groups = pair(1.0);
    for (group, charge) in groups.drops.iter_mut().zip([2.0, -1.5]) {
        let skin = group.liquid.position[..group.liquid.surface()].iter();
        let heights: Vec<f64> = skin.map(|x| x[2]).collect();
        group.charge = charge;
        group.liquid.charge.clone_from(&heights);
        group.liquid.pull = [heights.clone(), heights];
    }
    let before = totals(&groups);
    let area = |g: &Group| g.seen(SPACING).unwrap().hull.area;
    let areas: f64 = groups.drops.iter().map(area).sum();
    assert_eq!(groups.join(&RULE, &way()).unwrap(), 1);
    let [one] = &mut groups.drops[..] else {
        panic!("{}", groups.drops.len())
    };
    assert!(one.met && (one.charge - 0.5).abs() < 1e-12);
    // What fields do is that of the nearest old point.
    let surface = one.liquid.surface();
    assert!([one.liquid.pull[0].len(), one.liquid.charge.len()] == [surface; 2]);
    assert!(one.liquid.pull[1].is_empty());
    for (x, pull) in one.liquid.position.iter().zip(&one.liquid.pull[0]) {
        assert!((x[2] - pull).abs() < SPACING, "{x:?} {pull}");
    }
    let raw = one.seen(SPACING).unwrap();
    assert!(
        (raw.hull.volume / one.volume - 1.0).abs() < 0.02,
        "{} {}",
        raw.hull.volume,
        one.volume
    );
    let seen = one.keep(SPACING).unwrap();
    assert!((seen.hull.volume / one.volume - 1.0).abs() < 1e-6);
    assert!(seen.hull.area < areas, "{} {areas}", seen.hull.area);
    // No point of the surface is left in the liquid, and none inside is out of it.
    let liquid = &one.liquid;
    let level = Level::new(&liquid.position[..liquid.surface()], &seen.patches, SPACING);
    let inside = &liquid.position[liquid.surface()..];
    assert!(inside.iter().all(|x| level.height(x) < -0.4 * SPACING));
    let gap = (0..liquid.surface()).filter(|&i| liquid.position[i][2].abs() < 0.2 * SPACING);
    assert!(gap.clone().count() > 5, "{}", gap.count());
    assert!(groups.part(&RULE, &way()).unwrap() == 0);
    kept(&before, &totals(&groups));
}

#[test]
fn a_drop_without_a_waist_parts_and_keeps_what_it_has() {
    // Two ellipsoids that overlap by little hang together by a neck that is thinner than two spacings.
    let tip = |z: f64| {
        Shape::Ellipsoid(EllipsoidShape {
            name: None,
            centre_m: vec![0.0, 0.0, z],
            semi_axes_m: vec![0.8, 0.8, 1.2],
        })
    };
    let shape = Shape::Union(vec![tip(-1.19), tip(1.19)]);
    let body = Body::new(&shape, 3);
    assert!(body.distance([0.0; 3]) < 0.0);
    let liquid = filled(&shape, |x| [0.0, 0.0, x[2]]);
    let mut group = Group::new(liquid, SPACING).unwrap();
    let skin = group.liquid.position[..group.liquid.surface()].iter();
    group.liquid.charge = skin.map(|x| x[2]).collect();
    group.charge = 0.3;
    let mut groups = Groups {
        drops: vec![group],
        parcels: Vec::new(),
    };
    let before = totals(&groups);
    assert_eq!(groups.part(&RULE, &way()).unwrap(), 2);
    kept(&before, &totals(&groups));
    assert_eq!(groups.drops.len(), 2);
    for group in &mut groups.drops {
        let seen = group.keep(SPACING).unwrap();
        let left = seen.hull.volume / group.volume - 1.0;
        assert!(left.abs() < 1e-6, "{left:e} {}", group.liquid.surface());
    }
    assert!(groups.drops[0].drift[2] * groups.drops[1].drift[2] < 0.0);
    // Each takes the charge of its side with it, and together they have what there was.
    let charges = [groups.drops[0].charge, groups.drops[1].charge];
    let whole: f64 = charges.iter().sum();
    assert!((whole - 0.3).abs() < 1e-12, "{charges:?}");
    let side = groups.drops[0].centre[2].signum();
    // The area of a half is 9.8, and the mean height of its places 1.2.
    let apart = side * (charges[0] - charges[1]);
    assert!((apart - 23.0).abs() < 3.0, "{charges:?}");
    assert_eq!(groups.part(&RULE, &way()).unwrap(), 0);
    assert_eq!(groups.join(&RULE, &way()).unwrap(), 0);
}

#[test]
fn parcels_fall() {
    let mut groups = Groups {
        parcels: vec![Parcel {
            volume: 1.0,
            centre: [0.0; 3],
            drift: [1.0, 0.0, 2.0],
            charge: 0.0,
        }],
        ..Groups::default()
    };
    groups.fly(|_| [0.0, 0.0, -10.0], 0.1);
    groups.fly(|_| [0.0, 0.0, -10.0], 0.1);
    let [parcel] = groups.parcels[..] else {
        panic!()
    };
    assert!((parcel.centre[2] - 0.2).abs() < 1e-12 && (parcel.drift[2]).abs() < 1e-12);
}
