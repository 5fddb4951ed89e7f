use super::*;

/// Four loops of wire 1 mm thick below a drop, 200 A rms.
fn levitated(frequency: f64) -> Solution {
    let body = Body {
        radius: 2.5e-3,
        conductivity: 1e7,
        permeability: 1.0,
        frequency,
    };
    let one = |k: u32| Loop {
        radius: 2.5e-3 + 1.25e-3 * f64::from(k),
        height: -3.5e-3 - 1.25e-3 * f64::from(k),
        current: 200.0,
    };
    let sources = Sources {
        loops: (0..4).flat_map(|k| one(k).thick(0.5e-3)).collect(),
        uniform: 0.0,
    };
    Solution::of(body, sources)
}

fn near(found: f64, wanted: f64, tolerance: f64) {
    assert!(
        (found / wanted - 1.0).abs() < tolerance,
        "{found} is not {wanted}"
    );
}

/// Mean over the sphere of what `f` gives at (rho, z), by the rule of Gauss along the radius and the
/// angle's cosine, times the volume.
fn integral(radius: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
    let panels = 60;
    let nodes = [-0.774_596_669_241_483_4, 0.0, 0.774_596_669_241_483_4];
    let weights = [5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0];
    let mut rule = Vec::new();
    for p in 0..panels {
        for (x, w) in nodes.iter().zip(weights) {
            rule.push((
                (f64::from(p) + 0.5 + 0.5 * x) / f64::from(panels),
                w / f64::from(panels),
            ));
        }
    }
    let mut sum = 0.0;
    for (s, v) in &rule {
        // Finer toward the surface.
        let r = radius * (1.0 - (1.0 - s) * (1.0 - s));
        let dr = radius * 2.0 * (1.0 - s) * v;
        for (t, w) in &rule {
            let cosine = 2.0 * t - 1.0;
            let sine = (1.0 - cosine * cosine).sqrt();
            sum += 2.0 * PI * r * r * dr * 2.0 * w * f(r * sine, r * cosine);
        }
    }
    sum
}

#[test]
fn the_levitated_drop_has_its_published_lift_heat_and_current() {
    let s = levitated(1e5);
    near(s.lift(), 0.026_570, 2e-5);
    near(s.power(), 16.337, 3e-5);
    near(s.largest_current().0, 1.687e8, 3e-4);
}

#[test]
fn heat_and_lift_agree_with_their_volume_integrals() {
    for frequency in [3e4, 1e5, 1e6] {
        let s = levitated(frequency);
        let heat = integral(2.5e-3, |rho, z| s.current(rho, z).norm_sqr() / 1e7);
        near(heat, s.power(), 1e-4);
        // J x B along z is -J_phi B_rho.
        let lift = integral(2.5e-3, |rho, z| {
            -(s.current(rho, z) * s.flux(rho, z)[0].conj()).re
        });
        near(lift, s.lift(), 1e-4);
    }
}

#[test]
fn the_potential_and_its_curl_are_continuous() {
    for frequency in [10.0, 1e5, 1e7] {
        let s = levitated(frequency);
        for angle in [0.3_f64, 1.2, 2.6] {
            let at = |r: f64| (r * angle.sin(), r * angle.cos());
            let [(a, b), (c, d)] = [at(2.5e-3 * (1.0 - 1e-10)), at(2.5e-3 * (1.0 + 1e-10))];
            let [inner, outer] = [s.potential(a, b), s.potential(c, d)];
            assert!((inner - outer).norm() < 1e-6 * inner.norm());
            let [inner, outer] = [s.flux(a, b), s.flux(c, d)];
            let scale = inner[0].norm() + inner[1].norm();
            for k in 0..2 {
                assert!((inner[k] - outer[k]).norm() < 1e-6 * scale);
            }
        }
    }
}

#[test]
fn a_permeable_sphere_draws_a_slow_field_in() {
    // B = 3 mu / (mu + 2) times that far away (Jackson 1999, section 5.11).
    for mu in [0.1, 30.0, 1e4] {
        let body = Body {
            radius: 0.01,
            conductivity: 1.0,
            permeability: mu,
            frequency: 1e-3,
        };
        let sources = Sources {
            loops: Vec::new(),
            uniform: 0.02,
        };
        let s = Solution::of(body, sources);
        let [away, along] = s.flux(0.003, -0.004);
        near(along.re, 0.02 * 3.0 * mu / (mu + 2.0), 1e-6);
        assert!(away.norm() < 1e-6 * along.norm());
    }
}

#[test]
fn the_field_along_a_permeable_surface_is_continuous_over_the_permeability() {
    let body = Body {
        permeability: 40.0,
        ..levitated(3e4).body
    };
    let s = Solution::of(body, levitated(3e4).sources);
    let [low, high] = [1.0 - 1e-12, 1.0 + 1e-12].map(|part| s.radial_total(part * body.radius));
    for (low, high) in low.iter().zip(&high).take(8) {
        assert!((low[0] - high[0]).norm() < 1e-9 * high[0].norm());
        assert!((low[1] / 40.0 - high[1]).norm() < 1e-9 * high[1].norm().max(high[0].norm()));
    }
}

#[test]
fn a_loop_has_its_field_on_the_axis() {
    // Biot and Savart: mu0 I b^2 / (2 ((z-h)^2 + b^2)^(3/2)), with a sphere that hardly conducts.
    let body = Body {
        radius: 1.0,
        conductivity: 1e-6,
        permeability: 1.0,
        frequency: 1.0,
    };
    let one = Loop {
        radius: 1.2,
        height: -0.9,
        current: 3.0,
    };
    let sources = Sources {
        loops: vec![one],
        uniform: 0.0,
    };
    let s = Solution::of(body, sources);
    for z in [-0.8, 0.1, 0.7_f64] {
        let distance = (z + 0.9).hypot(1.2);
        let exact = 0.5 * MU0 * 3.0 * 1.44 / distance.powi(3);
        near(s.flux(0.0, z)[1].re, exact, 1e-9);
    }
}

#[test]
fn a_uniform_field_has_the_polarisability_of_landau() {
    // alpha = -(3/2)(1 - 3/x^2 + 3/x cot x) per volume and H, x = (1 + j) R / delta for exp(-j w t)
    // (Landau and Lifshitz, Electrodynamics of continuous media, section 59); P = w/2 alpha'' V mu0
    // H_peak^2, that is w alpha'' V B_rms^2 / mu0.
    let body = Body {
        radius: 0.01,
        conductivity: 5e7,
        permeability: 1.0,
        frequency: 800.0,
    };
    let sources = Sources {
        loops: Vec::new(),
        uniform: 0.02,
    };
    let s = Solution::of(body, sources);
    let depth = (2.0 / (s.omega() * MU0 * 5e7)).sqrt();
    let x = C::new(1.0, 1.0) * (0.01 / depth);
    let alpha = -1.5 * (1.0 - 3.0 / (x * x) + 3.0 / x * x.cos() / x.sin());
    let volume = 4.0 / 3.0 * PI * 1e-6;
    let power = s.omega() * alpha.im * volume * 0.02 * 0.02 / MU0;
    near(s.power(), power, 1e-9);
    assert!(s.lift() == 0.0);
}

#[test]
fn a_thick_loop_carries_its_current_with_its_middle_and_spread() {
    let one = Loop {
        radius: 2.0,
        height: -3.0,
        current: 5.0,
    };
    let parts = one.thick(0.4);
    let sum = |f: &dyn Fn(&Loop) -> f64| parts.iter().map(|l| l.current / 5.0 * f(l)).sum::<f64>();
    near(sum(&|_| 1.0), 1.0, 1e-12);
    near(sum(&|l| l.radius), 2.0, 1e-12);
    // The mean square distance of a disc from its diameter is a quarter of the radius squared, that
    // of its fourth power an eighth.
    near(sum(&|l| (l.radius - 2.0).powi(2)), 0.04, 1e-12);
    near(
        sum(&|l| (l.height + 3.0).powi(4)),
        0.4_f64.powi(4) / 8.0,
        1e-12,
    );
}
