use std::f64::consts::PI;

use super::*;
use crate::measure::section::{Metal, Plane};

const D: f64 = 0.5e-3;
const BASE: Base = Base {
    centre: Some(0.0),
    thickness: Some(10.0 * D),
    spacing: D,
};

/// Part of the particle at `p` for which `inside` holds.
fn share(p: [f64; 3], inside: impl Fn([f64; 3]) -> bool) -> f64 {
    const FINE: u32 = 6;
    let part = |n: u32| ((f64::from(n) + 0.5) / f64::from(FINE) - 0.5) * D;
    let cells = FINE.pow(3);
    let counted = (0..cells).filter(|c| {
        let off = [c % FINE, c / FINE % FINE, c / FINE / FINE].map(part);
        inside([p[0] + off[0], p[1] + off[1], p[2] + off[2]])
    });
    counted.count() as f64 / f64::from(cells)
}

/// A plate with a half-ellipsoid of fused metal below its surface and a cap above it, filled
/// with particles whose lattice is shifted by `shift`.
fn weld(half: f64, deep: f64, high: f64, shift: f64) -> (Vec<[f64; 3]>, Vec<f64>) {
    let mut position = Vec::new();
    let mut fused = Vec::new();
    let inside = |p: [f64; 3], up: f64| {
        (p[0] / half).powi(2) + (p[1] / 8e-3).powi(2) + (p[2] / up).powi(2) < 1.0
    };
    for i in -20..20 {
        for j in -3..3 {
            for k in -10..14 {
                let place = |n: i32| (f64::from(n) + 0.5) * D;
                let p = [place(i) + shift, place(j), place(k)];
                if k < 0 {
                    position.push(p);
                    fused.push(share(p, |p| inside(p, deep)));
                } else if inside(p, high) {
                    position.push(p);
                    fused.push(1.0);
                }
            }
        }
    }
    (position, fused)
}

fn of(position: &[[f64; 3]], fused: &[f64]) -> Bead {
    let metal = Metal {
        position,
        fused,
        spacing: D,
    };
    measure(&Section::cut(&metal, Plane::Across, 0.0), BASE)
}

fn found(half: f64, deep: f64, high: f64, shift: f64) -> Bead {
    let (position, fused) = weld(half, deep, high, shift);
    of(&position, &fused)
}

#[test]
fn a_half_ellipsoid_is_measured_within_a_fraction_of_a_particle() {
    let mut mean = [0.0_f64; 4];
    let count = 24;
    for n in 0..count {
        let part = f64::from(n) / f64::from(count);
        let (half, deep, high) = (5e-3 + part * 1e-3, 2e-3 + part * 1e-3, 3e-3 + part * 1e-3);
        let bead = found(half, deep, high, 0.37 * part * D);
        // The width is defined half a spacing below the surface.
        let wide = 2.0 * half * (1.0 - (0.5 * D / deep).powi(2)).sqrt();
        let top = 2.0 * half * (1.0 - (0.5 * D / high).powi(2)).sqrt();
        let error = [
            bead.penetration - deep,
            bead.fused_width - wide,
            bead.reinforcement - high,
            bead.bead_width - top,
        ];
        // The fusion line is known to a part of a particle. The surface is that of whole
        // particles and may lie half a spacing off on each side of what is measured.
        let allowed = [0.15, 0.3, 0.55, 1.1];
        for ((sum, e), allowed) in mean.iter_mut().zip(error).zip(allowed) {
            assert!(e.abs() < allowed * D, "{error:?} m with half width {half}");
            *sum += e / f64::from(count);
        }
        assert!((bead.fused_half_width - bead.fused_width / 2.0).abs() < 0.15 * D);
    }
    for (mean, allowed) in mean.iter().zip([0.1, 0.2, 0.25, 0.25]) {
        assert!(mean.abs() < allowed * D, "mean error {mean} m");
    }
}

#[test]
fn the_toe_angle_is_that_of_the_foot() {
    // A ridge whose sides rise straight: 3 mm over 6 mm.
    let rise = |half: f64| move |p: [f64; 3]| p[2] < 3e-3 * (1.0 - p[0].abs() / half);
    for half in [6e-3, 9e-3] {
        let (mut position, mut fused) = weld(1e-9, 1e-9, 1e-9, 0.0);
        for i in -20..20 {
            for (j, k) in (-3..3).flat_map(|j| (0..14).map(move |k| (j, k))) {
                let p = [i, j, k].map(|n: i32| (f64::from(n) + 0.5) * D);
                if rise(half)(p) {
                    position.push(p);
                    fused.push(1.0);
                }
            }
        }
        let bead = of(&position, &fused);
        let exact = (3e-3_f64 / half).atan().to_degrees();
        assert!(
            (bead.toe_angle - exact).abs() < 3.0,
            "{} {exact}",
            bead.toe_angle
        );
    }
    assert!(found(1e-9, 1e-9, 1e-9, 0.0).toe_angle.abs() < 1e-12);
}

#[test]
fn areas_and_dilution_are_those_of_the_ellipse() {
    let bead = found(5e-3, 2.5e-3, 3e-3, 0.0);
    let (below, above) = (0.5 * PI * 5e-3 * 2.5e-3, 0.5 * PI * 5e-3 * 3e-3);
    assert!(
        (bead.area_below / below - 1.0).abs() < 0.08,
        "{}",
        bead.area_below / below
    );
    assert!(
        (bead.area_above / above - 1.0).abs() < 0.08,
        "{}",
        bead.area_above / above
    );
    assert!((bead.dilution() - 2.5 / 5.5).abs() < 0.03);
}

#[test]
fn a_bare_plate_has_no_bead_and_a_drop_in_flight_is_none() {
    let (mut position, mut fused) = weld(1e-9, 1e-9, 1e-9, 0.0);
    position.push([0.0, 0.0, 4e-3]);
    fused.push(1.0);
    let bead = of(&position, &fused);
    assert!(
        bead.penetration == 0.0 && bead.fused_width == 0.0,
        "{bead:?}"
    );
    assert!(
        bead.reinforcement < 0.05 * D && bead.bead_width == 0.0,
        "{bead:?}"
    );
}

#[test]
fn a_plate_that_is_fused_through_is_as_deep_as_it_is_thick() {
    // Ten layers, all of them fused within 5 mm of the centre, a root that hangs lower, and a drop on its way below it.
    let (mut position, mut fused) = weld(1e-9, 1e-9, 1e-9, 0.0);
    for (p, fused) in position.iter().zip(&mut fused) {
        *fused = f64::from(u8::from(p[0].abs() < 5e-3));
    }
    let mut hanging = |x: f64, z: f64| {
        for j in -3..3 {
            position.push([x, (f64::from(j) + 0.5) * D, z]);
            fused.push(1.0);
        }
    };
    for i in -2..2 {
        hanging((f64::from(i) + 0.5) * D, -10.5 * D);
    }
    hanging(0.0, -14.0 * D);
    let bead = of(&position, &fused);
    assert!(
        bead.through && (bead.penetration - 10.0 * D).abs() < 1e-12,
        "{bead:?}"
    );
    assert!((bead.fused_width - 10e-3).abs() < 0.1 * D, "{bead:?}");
    assert!(!found(5e-3, 2.5e-3, 3e-3, 0.0).through);
}

#[test]
fn without_a_centre_plane_the_half_width_is_half_of_the_width() {
    let (position, fused) = weld(5e-3, 2.5e-3, 3e-3, 0.0);
    let moved: Vec<_> = position.iter().map(|p| [p[0] + 3e-3, p[1], p[2]]).collect();
    let metal = Metal {
        position: &moved,
        fused: &fused,
        spacing: D,
    };
    let unknown = Base {
        centre: None,
        ..BASE
    };
    let bead = measure(&Section::cut(&metal, Plane::Across, 0.0), unknown);
    assert!((bead.fused_half_width / bead.fused_width - 0.5).abs() < 1e-12);
    let known = Base {
        centre: Some(3e-3),
        ..BASE
    };
    let same = measure(&Section::cut(&metal, Plane::Across, 0.0), known);
    assert!((same.fused_half_width - bead.fused_half_width).abs() < 0.05 * D);
}

#[test]
fn nothing_measures_nothing() {
    assert_eq!(of(&[], &[]), Bead::default());
}
