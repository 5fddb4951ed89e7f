use super::*;

fn film(depth: f64, entries: Vec<u32>) -> Film {
    Film {
        point: 0,
        depth,
        area: 2.0,
        place: [0.0; 3],
        above: [0.0; 3],
        piece: Piece {
            centre: [0.0; 3],
            half: [[0.0; 3]; 3],
            rank: 0,
        },
        entries,
    }
}

fn surface(conditions: Vec<Condition>) -> Surface {
    Surface {
        conditions,
        ..Surface::default()
    }
}

fn number(value: f64) -> Curve {
    Curve::Constant(value)
}

#[test]
fn conditions_add_on_a_surface() {
    let all = surface(vec![
        Condition::Flux(Flux::new(number(10.0))),
        Condition::Convection(number(3.0), number(400.0)),
        Condition::Radiation(number(0.5), number(1000.0)),
    ]);
    let film = film(0.0, vec![0, 1, 2]);
    let passed = all.pass(&film, 300.0, 0.0, |_, _| 1.0).unwrap();
    let radiant = 0.5 * STEFAN_BOLTZMANN * (1e12 - 300.0_f64.powi(4));
    let exact = 2.0 * (10.0 + 300.0 + radiant);
    assert!((passed.heat - exact).abs() < 1e-9 * exact);
    let sum: f64 = (0..3)
        .map(|e| all.part(&film, e, passed, 0.0).unwrap())
        .sum();
    assert!((sum - exact).abs() < 1e-9 * exact);
}

#[test]
fn a_deep_point_and_its_surface_are_resistances_in_series() {
    let robin = surface(vec![Condition::Convection(number(4.0), number(100.0))]);
    let passed = robin
        .pass(&film(0.5, vec![0]), 0.0, 0.0, |_, _| 2.0)
        .unwrap();
    // 1/h + d/k = 1/4 + 1/4.
    assert!((passed.heat - 2.0 * 100.0 / 0.5).abs() < 1e-12);
    assert!((passed.slope + 2.0 / 0.5).abs() < 1e-12);
    assert!((passed.temperature - 50.0).abs() < 1e-12);
    let held = surface(vec![Condition::Temperature(number(100.0))]);
    let passed = held
        .pass(&film(0.5, vec![0]), 0.0, 0.0, |_, _| 2.0)
        .unwrap();
    assert!((passed.heat - 800.0).abs() < 1e-12);
}

#[test]
fn a_radiating_surface_finds_its_temperature() {
    let hot = surface(vec![Condition::Radiation(number(1.0), number(3000.0))]);
    for (t, k) in [(300.0, 1e-3), (300.0, 1e4), (4000.0, 1.0)] {
        let passed = hot.pass(&film(0.01, vec![0]), t, 0.0, |_, _| k).unwrap();
        let through = 2.0 * k / 0.01 * (passed.temperature - t);
        assert!(
            (through - passed.heat).abs() < 1e-9 * passed.heat.abs(),
            "{t} {k}: {passed:?}"
        );
        let step = 1e-3 * t;
        let near = |t: f64| {
            hot.pass(&film(0.01, vec![0]), t, 0.0, |_, _| k)
                .unwrap()
                .heat
        };
        let slope = (near(t + step) - near(t - step)) / (2.0 * step);
        assert!((slope - passed.slope).abs() < 1e-3 * slope.abs());
    }
}

#[test]
fn a_factor_that_leaves_its_range_in_a_march_ends_it() {
    // Between the times at which formulas are looked at before.
    let formula = |text: &str| {
        let formula = run::property::Formula {
            expr: text.to_owned(),
        };
        run::property::Property::Formula(formula)
            .compile("/e", &["t"])
            .unwrap()
    };
    let film = film(0.0, vec![0]);
    let kinds = [
        Condition::Radiation(formula("0.5 + if(t - 1, 1, 0)"), number(400.0)),
        Condition::Convection(formula("5 - if(t - 1, 9, 0)"), number(400.0)),
    ];
    for kind in kinds {
        let all = surface(vec![kind]);
        let passed = |time: f64| all.pass(&film, 300.0, time, |_, _| 1.0);
        assert!(passed(0.9).unwrap().heat > 0.0);
        assert!(passed(1.1).is_err());
    }
}
