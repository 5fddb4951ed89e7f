use std::f64::consts::PI;

use num_complex::Complex;
use shapes::frame::{cross, difference, dot};

use super::*;

fn ring() -> Loop {
    Loop {
        centre: [0.3, -0.2, 0.1],
        axis: [0.48, 0.6, 0.64],
        radius: 0.7,
        wire_radius: 1e-3,
        current: Complex::new(2.0, -1.0),
    }
}

/// Sum of straight pieces, which closes on the loop by the square of their number.
fn polygon(ring: &Loop, count: usize) -> Vec<Segment> {
    let pieces = ring.pieces(count);
    pieces
        .iter()
        .map(|(p, t)| Segment {
            from: [0, 1, 2].map(|k| p[k] - 0.5 * t[k]),
            to: [0, 1, 2].map(|k| p[k] + 0.5 * t[k]),
            wire_radius: 1e-3,
            current: ring.current,
        })
        .collect()
}

#[test]
fn a_loop_is_a_polygon_of_many_segments() {
    let one = Source {
        loops: vec![ring()],
        ..Source::default()
    };
    let many = Source {
        segments: polygon(&ring(), 4000),
        ..Source::default()
    };
    for p in [
        [0.3, -0.2, 0.1],
        [1.5, 0.4, -0.3],
        [0.31, -0.19, 0.9],
        [0.9, 0.1, -0.2],
    ] {
        let pairs = [
            (one.potential_at(p), many.potential_at(p)),
            (one.flux_at(p), many.flux_at(p)),
        ];
        for (a, b) in pairs {
            for k in 0..3 {
                let scale = MU0 * 3.0;
                assert!((a[k] - b[k]).norm() < 3e-6 * scale, "{p:?} {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn on_the_axis_the_field_is_exact() {
    let one = ring();
    for height in [0.0, 0.4, -3.0] {
        let p = [0, 1, 2].map(|k| one.centre[k] + height * one.axis[k]);
        let exact = 0.5 * MU0 * 0.49 / (0.49_f64 + height * height).powf(1.5);
        let found = dot(one.flux(p), one.axis);
        assert!((found / exact - 1.0).abs() < 1e-12, "{found} {exact}");
        // Beside the axis too.
        let q = [p[0] + 1e-9, p[1], p[2]];
        assert!((dot(one.flux(q), one.axis) / exact - 1.0).abs() < 1e-7);
        assert!(one.potential(p).iter().all(|a| a.abs() < 1e-20));
    }
}

#[test]
fn flux_is_the_curl_of_the_potential_and_neither_has_sources() {
    let source = Source {
        loops: vec![ring()],
        segments: vec![Segment {
            from: [0.0, 0.0, -1.0],
            to: [0.2, 0.9, 1.0],
            wire_radius: 1e-3,
            current: Complex::new(0.0, 4.0),
        }],
        wires: vec![Wire {
            place: [-1.0, 0.3],
            wire_radius: 1e-3,
            current: Complex::new(1.0, 1.0),
        }],
        uniform: vec![
            Uniform {
                flux: [1e-6, 2e-6, -3e-7].map(Complex::from),
                origin: Origin::Solenoid([0.1, 0.0, 0.0]),
            },
            Uniform {
                flux: [2e-6, 0.0, 1e-6].map(Complex::from),
                origin: Origin::Sheets([0.0, 1.0, 0.0]),
            },
        ],
    };
    let h = 1e-4;
    for p in [[0.6, 0.5, 0.3], [-0.5, 0.2, 0.1], [0.35, -0.1, 0.2]] {
        let slope = |of: usize, along: usize| {
            let [mut a, mut b] = [p, p];
            a[along] -= h;
            b[along] += h;
            (source.potential_at(b)[of] - source.potential_at(a)[of]) / (2.0 * h)
        };
        let curl = [
            slope(2, 1) - slope(1, 2),
            slope(0, 2) - slope(2, 0),
            slope(1, 0) - slope(0, 1),
        ];
        let flux = source.flux_at(p);
        let scale: f64 = flux.iter().map(|b| b.norm()).sum();
        for k in 0..3 {
            assert!((curl[k] - flux[k]).norm() < 1e-6 * scale);
        }
    }
}

#[test]
fn the_loop_alone_has_no_divergence() {
    let one = ring();
    let h = 1e-4;
    for p in [[0.6, 0.5, 0.3], [-0.5, 0.2, 0.1]] {
        let mut sum = 0.0;
        for k in 0..3 {
            let [mut a, mut b] = [p, p];
            a[k] -= h;
            b[k] += h;
            sum += (one.flux(b)[k] - one.flux(a)[k]) / (2.0 * h);
        }
        assert!(sum.abs() < 1e-6 * MU0);
    }
}

#[test]
fn near_its_wire_a_field_is_bounded_and_right_on_its_surface() {
    let one = Loop {
        wire_radius: 0.01,
        ..ring()
    };
    let (place, tangent) = one.pieces(8)[3];
    let size = dot(tangent, tangent).sqrt();
    let t = tangent.map(|x| x / size);
    let away = cross(t, one.axis);
    for part in [0.0, 0.3, 1.0, 1.5] {
        let p = [0, 1, 2].map(|k| place[k] + 0.01 * part * away[k]);
        let b = one.flux(p);
        let size = dot(b, b).sqrt();
        let straight = MU0 / (2.0 * PI * 0.01) * if part < 1.0 { part } else { 1.0 / part };
        assert!(
            (size - straight).abs() < 0.06 * MU0 / (2.0 * PI * 0.01),
            "{part}"
        );
        assert!(one.potential(p).iter().all(|a| a.is_finite()));
    }
}

#[test]
fn filaments_carry_the_current_with_its_middle_and_spread() {
    let one = Loop {
        wire_radius: 0.1,
        ..ring()
    };
    let parts = one.filaments();
    let sum = |f: &dyn Fn(&Loop) -> f64| {
        let parts = parts.iter().map(|l| (l.current / one.current).re * f(l));
        parts.sum::<f64>()
    };
    let height = |l: &Loop| dot(difference(l.centre, one.centre), one.axis);
    assert!((sum(&|_| 1.0) - 1.0).abs() < 1e-14);
    assert!((sum(&|l| l.radius) - 0.7).abs() < 1e-14);
    assert!((sum(&|l| (l.radius - 0.7).powi(2)) - 0.0025).abs() < 1e-15);
    assert!((sum(&|l| height(l).powi(4)) - 1e-4 / 8.0).abs() < 1e-15);
}
