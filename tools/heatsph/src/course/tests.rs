use run::property::{Arguments, Bounds, Curve, Formula, Property};

use super::pieces::{Varies, divide};
use super::*;

struct Formula1(Curve);

impl Varies for Formula1 {
    fn places(&self) -> usize {
        1
    }
    fn value(&self, _: usize, time: f64) -> f64 {
        self.0.value(&Arguments::at([0.0; 3], time)).unwrap()
    }
    fn bounds(&self, _: usize, times: [f64; 2]) -> Bounds {
        let [low, high] = times.map(|t| Arguments::at([0.0; 3], t));
        self.0.bounds(&low, &high)
    }
}

fn varies(text: &str) -> Formula1 {
    let formula = Property::Formula(Formula {
        expr: text.to_owned(),
    });
    Formula1(formula.compile("/q", &["t"]).unwrap())
}

/// The course of a formula until `end`.
fn course(text: &str, end: f64) -> Course {
    let mut course = Course {
        resolved: true,
        ..Course::default()
    };
    course.add(divide(&varies(text), end));
    course
}

#[test]
fn jumps_lie_between_neighbouring_numbers() {
    for (text, jumps) in [
        ("if(t - 1, if(1.1 - t, 1e7, 0), 0)", vec![1.0, 1.1]),
        ("step(t - 1)*step(1.0000001 - t)", vec![1.0, 1.000_000_1]),
        ("300 + 5*sign(t - 2)", vec![2.0]),
        ("if(t, 1e7, 0)", vec![0.0]),
        (
            "if(0.25 - fract(t), 1, 0)",
            vec![0.25, 1.0, 1.25, 2.0, 2.25, 3.0, 3.25, 4.0, 4.25, 5.0],
        ),
    ] {
        let course = course(text, 5.0);
        assert!(course.resolved, "{text}");
        assert_eq!(
            course.jumps.len(),
            jumps.len(),
            "{text}: {:?}",
            course.jumps
        );
        for ([before, after], exact) in course.jumps.iter().zip(jumps) {
            assert!((before - exact).abs() < 1e-14 && (after - exact).abs() < 1e-14);
            assert!(before < after);
        }
    }
}

#[test]
fn no_pulse_is_too_short_to_be_met() {
    for width in [1e-1, 1e-3, 1e-6, 1e-9] {
        for text in [
            format!("exp(-((t - 3.217)/{width})^2)"),
            format!("1e3 + 1e6*exp(-((t - 3.217)/{width})^2)"),
            format!("1e-6*t/(((t - 3.217)/{width})^2 + 1)^4"),
            format!("max(0, 1 - abs(t - 3.217)/{width})"),
        ] {
            let course = course(&text, 10.0);
            assert!(course.resolved, "{text}");
            // Steps as long as the course lets them be integrate the pulse by the trapezoidal rule.
            let of = varies(&text);
            let (mut time, mut sum, mut steps) = (0.0, 0.0, 0);
            let base = of.value(0, 0.0);
            while time < 10.0 {
                let step = course.longest(time).min(10.0 - time);
                let [a, b] = [time, time + step].map(|t| of.value(0, t) - base);
                sum += 0.5 * step * (a + b);
                time += step;
                steps += 1;
            }
            assert!(steps < 2000, "{text}: {steps} steps");
            assert!(sum > 0.0, "{text}");
            if text.starts_with("exp") {
                let exact = width * std::f64::consts::PI.sqrt();
                assert!((sum / exact - 1.0).abs() < 1e-3, "{text}: {sum} {exact}");
            }
        }
    }
}

#[test]
fn whole_periods_do_not_hide_between_samples() {
    for (frequency, end) in [
        (50.0, 10.0),
        (50.0, 1.0),
        (50.0, 0.3),
        (60.0, 1.0),
        (100.0, 5.0),
        (1e3, 0.25),
        (333.3, 1.0),
    ] {
        for text in ["sin", "cos"] {
            let course = course(&format!("300 + 100*{text}(2*pi*{frequency}*t)"), end);
            assert!(course.resolved, "{text} {frequency} {end}");
            for look in 0..997 {
                let longest = course.longest(end * f64::from(look) / 997.0);
                assert!(
                    longest <= 0.25 / frequency,
                    "{text} {frequency} Hz over {end} s: {longest} s"
                );
            }
        }
    }
}

#[test]
fn what_runs_smoothly_bounds_few_steps() {
    for (text, most) in [
        ("300 + 20*t", 1e-9),
        ("5", 1e-9),
        ("if(t - 1, 7, 2)", 1e-9),
        ("sin(t)", 250.0),
    ] {
        let course = course(text, 10.0);
        let (mut time, mut steps) = (0.0, 0.0);
        while time < 10.0 {
            let step = course.longest(time);
            steps += 1.0;
            time += step;
        }
        assert!(steps <= most + 1.0, "{text}: {steps}");
    }
}
