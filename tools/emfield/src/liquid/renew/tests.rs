//! Drops whose points are taken away, crowded and turned.

use shapes::Body;
use shapes::shape::{EllipsoidShape, Shape};

use super::*;
use crate::liquid::fill::fill;
use crate::liquid::outline::Outline;

/// Spacings in the radius of the sphere that is as large.
const PARTS: f64 = 5.0;

fn way(spacing: f64) -> Way {
    Way {
        spacing,
        order: 3,
        tolerance: 1e-9,
        products: 1000,
    }
}

/// What points carry in these tests: fits of cubics are exact for it.
fn wind(x: &[f64; 3]) -> [f64; 3] {
    let [x, y, z] = *x;
    [x * y + z, y * y - 2.0 * x * z, 1.0 + z * z * x]
}

/// A spheroid as large as the sphere of radius 1, whose points carry the wind.
fn spheroid(ratio: f64) -> Liquid<3> {
    let wide = ratio.cbrt().recip();
    let shape = Shape::Ellipsoid(EllipsoidShape {
        name: None,
        centre_m: vec![0.0; 3],
        semi_axes_m: vec![wide, wide, ratio * wide],
    });
    let filled = fill::<3>(&Body::new(&shape, 3), PARTS.recip());
    let velocity: Vec<[f64; 3]> = filled.position.iter().map(wind).collect();
    Liquid {
        rate: velocity.clone(),
        pressure: velocity.iter().map(|u| u[0]).collect(),
        stress: vec![0.0; filled.normal.len()],
        velocity,
        position: filled.position,
        normal: filled.normal,
        ..Liquid::default()
    }
}

fn without(liquid: &Liquid<3>, gone: &[usize]) -> Liquid<3> {
    let mut leaves = vec![false; liquid.position.len()];
    gone.iter().for_each(|i| leaves[*i] = true);
    let surface = liquid.surface();
    let vectors =
        |old: &[[f64; 3]]| rebuilt(old, &leaves, surface.min(old.len()), empty(), empty());
    let numbers = |old: &[f64]| rebuilt(old, &leaves, surface.min(old.len()), empty(), empty());
    Liquid {
        position: vectors(&liquid.position),
        velocity: vectors(&liquid.velocity),
        rate: vectors(&liquid.rate),
        normal: vectors(&liquid.normal),
        pressure: numbers(&liquid.pressure),
        stress: numbers(&liquid.stress),
        ..liquid.clone()
    }
}

/// The point nearest to a place, of a range.
fn nearest(liquid: &Liquid<3>, range: std::ops::Range<usize>, place: [f64; 3]) -> usize {
    let far = |i: usize| length(&difference(&liquid.position[i], &place));
    range.min_by(|i, j| far(*i).total_cmp(&far(*j))).unwrap()
}

fn outline(liquid: &Liquid<3>) -> Outline {
    let skin = &liquid.position[..liquid.surface()];
    Outline::new(skin, &liquid.normal, [0.0; 3]).unwrap()
}

#[test]
fn even_drops_stay_as_they_are() {
    for ratio in [1.0, 0.6, 1.5, 2.0] {
        let mut liquid = spheroid(ratio);
        let before = liquid.clone();
        let count = liquid.renew(&way(PARTS.recip())).unwrap();
        assert_eq!((count, liquid), (Renewed::default(), before), "{ratio}");
    }
}

#[test]
fn what_is_missing_comes_with_the_values_of_its_place() {
    let whole = spheroid(1.5);
    let (surface, all) = (whole.surface(), whole.position.len());
    let gone = [
        nearest(&whole, 0..surface, [0.0, 0.9, 0.0]),
        nearest(&whole, surface..all, [0.0; 3]),
        nearest(&whole, surface..all, [0.0, 0.0, 0.5]),
    ];
    let mut liquid = without(&whole, &gone);
    let count = liquid.renew(&way(PARTS.recip())).unwrap();
    assert_eq!((count.added, count.merged), (3, 0));
    assert_eq!((liquid.surface(), liquid.position.len()), (surface, all));
    for i in gone {
        let range = if i < surface {
            0..surface
        } else {
            surface..all
        };
        let new = nearest(&liquid, range, whole.position[i]);
        let place = liquid.position[new];
        let off = length(&difference(&place, &whole.position[i]));
        assert!(off < 0.3 / PARTS, "{off}");
        let lack = length(&difference(&liquid.velocity[new], &wind(&place)));
        let most = if i < surface { 2e-3 } else { 1e-12 };
        assert!(lack < most, "{lack:e}");
    }
}

#[test]
fn points_that_crowd_merge_and_those_of_the_surface_stay_on_it() {
    let mut liquid = spheroid(1.5);
    let (surface, all) = (liquid.surface(), liquid.position.len());
    let skin = nearest(&liquid, 0..surface, [0.9, 0.0, 0.0]);
    let other = (0..surface)
        .filter(|j| *j != skin)
        .min_by(|a, b| {
            let far = |i: usize| length(&difference(&liquid.position[i], &liquid.position[skin]));
            far(*a).total_cmp(&far(*b))
        })
        .unwrap();
    // Seven tenths of the way to its neighbour, along the fit of the surface.
    let way_there = difference(&liquid.position[other], &liquid.position[skin]);
    let mut seats = [Seat {
        place: along(&liquid.position[skin], 0.7, &way_there),
        normal: liquid.normal[skin],
    }];
    let sheet = Sheet {
        points: &liquid.position[..surface],
        normals: &liquid.normal,
    };
    between(sheet, &mut seats, PARTS.recip()).unwrap();
    (liquid.position[skin], liquid.normal[skin]) = (seats[0].place, seats[0].normal);
    liquid.velocity[skin] = wind(&seats[0].place);
    let before = outline(&liquid).volume().0;
    let count = liquid.renew(&way(PARTS.recip())).unwrap();
    assert_eq!(count.merged, 1);
    assert_eq!(liquid.position.len(), all - 1 + count.added as usize);
    let change = outline(&liquid).volume().0 / before - 1.0;
    assert!(change.abs() < 1e-4, "{change:e}");
}

#[test]
fn large_turned_and_shifted_drops_change_alike() {
    let whole = spheroid(1.5);
    let surface = whole.surface();
    let gone: Vec<usize> = (0..whole.position.len()).step_by(17).collect();
    let thin = without(&whole, &gone);
    let mut plain = thin.clone();
    let count = plain.renew(&way(PARTS.recip())).unwrap();
    assert!(count.added > 20, "{count:?}");
    assert!(plain.surface() > surface - gone.len());
    let (sine, cosine) = 0.7_f64.sin_cos();
    let turn = |x: &[f64; 3]| {
        [
            cosine * x[0] - sine * x[2],
            x[1],
            sine * x[0] + cosine * x[2],
        ]
    };
    for size in [3.5e-5, 1.0, 20.0] {
        let put = |x: &[f64; 3]| along(&[0.3 * size, -size, 2.0 * size], size, &turn(x));
        let mut other = thin.clone();
        other.position = thin.position.iter().map(put).collect();
        other.normal = thin.normal.iter().map(turn).collect();
        assert_eq!(other.renew(&way(size / PARTS)).unwrap(), count, "{size}");
        for (x, y) in plain.position.iter().zip(&other.position) {
            let off = length(&difference(&put(x), y));
            assert!(off < 1e-9 * size, "{off:e}");
        }
        for (u, v) in plain.velocity.iter().zip(&other.velocity) {
            assert!(length(&difference(u, v)) < 1e-9);
        }
    }
}

#[test]
fn two_thousand_renewals_keep_volume_and_shape() {
    let mut liquid = spheroid(1.2);
    let first = outline(&liquid);
    let (wanted, area) = (first.volume().0, first.area());
    let (mut count, mut most) = (Renewed::default(), 0.0_f64);
    for k in 0..2000_usize {
        let surface = liquid.surface();
        let inner = liquid.position.len() - surface;
        let gone = [(7 * k) % surface, surface + (11 * k) % inner];
        liquid = without(&liquid, &gone);
        count.add(liquid.renew(&way(PARTS.recip())).unwrap());
        let lack = wanted - outline(&liquid).volume().0;
        most = most.max((lack / wanted).abs());
        liquid.swell(lack / area);
    }
    let last = outline(&liquid);
    assert!(count.added > 3000, "{count:?}");
    // What one renewal changes, and what the march, which puts that right, keeps after all of them.
    assert!(most < 1e-5, "{most:e}");
    let (volume, centre) = last.volume();
    let off = length(&centre);
    assert!((volume / wanted - 1.0).abs() < 1e-6, "{volume:e}");
    assert!(off < 1e-3, "{off:e}");
    let (long, now) = (first.mode(2), last.mode(2));
    assert!((now / long - 1.0).abs() < 2e-2, "{long:e} {now:e}");
}
