//! Properties: formulas against Rust's own arithmetic, tables against their rows, every fault.

use std::f64::consts::{E, PI};

use run::property::{Arguments, Expression, Extrapolate, OutOfRange, Property, TemperatureTable};

const ALL: [&str; 6] = ["x", "y", "z", "r", "T", "t"];

fn at() -> Arguments {
    Arguments {
        x: 0.3,
        y: -1.7,
        z: 2.5,
        r: 0.9,
        temperature: 1800.0,
        time: 0.125,
        fraction: 0.25,
        flux_density: 1.25,
    }
}

fn value(text: &str) -> f64 {
    Expression::parse(text, &ALL)
        .unwrap_or_else(|e| panic!("{text}: {e}"))
        .value(&at())
}

#[test]
fn formulas_give_what_the_same_code_gives() {
    let a = at();
    let (x, y, z, r, temperature, t) = (a.x, a.y, a.z, a.r, a.temperature, a.time);
    let cases = [
        (
            "1 + 2*sin(pi*x)*sin(pi*y)",
            1.0 + 2.0 * (PI * x).sin() * (PI * y).sin(),
        ),
        ("-x^2", -(x * x)),
        ("(-x)^2", x * x),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("2*-3", -6.0),
        ("- -3", 3.0),
        ("8-3-2", 3.0),
        ("8/4/2", 1.0),
        ("1e-3*T", 1e-3 * temperature),
        ("2.5E+2", 250.0),
        (".5", 0.5),
        ("e", E),
        ("exp(-r^2/0.5)*t", (-(r * r) / 0.5).exp() * t),
        ("min(x, y) + max(x, z)", y + z),
        ("atan2(y, x)", y.atan2(x)),
        ("hypot(3, 4)", 5.0),
        ("mod(-1, 3)", 2.0),
        ("if(T - 1750, 1, 2)", 1.0),
        ("if(1750 - T, 1, 2)", 2.0),
        ("step(t - 0.125)", 1.0),
        ("sqrt(2)^2", 2.0),
        ("ln(e^3)", 3.0),
        ("z^2.5", z.powf(2.5)),
    ];
    for (text, wanted) in cases {
        let found = value(text);
        assert!(
            (found - wanted).abs() <= 1e-14 * wanted.abs().max(1.0),
            "{text}: {found}, wanted {wanted}"
        );
    }
}

#[test]
fn faults_in_formulas_name_their_column() {
    let cases = [
        ("sin(x", "column 6: a ')' is missing"),
        ("1 +", "column 4: ends where"),
        ("2 x", "column 3: 'x' was not expected here"),
        (
            "x < 3",
            "column 3: '<' was not expected here; a choice is if(a, b, c): b where a is above 0, c elsewhere",
        ),
        (
            "if(x > 3, 1, 0)",
            "column 6: '>' was not expected here; a choice is",
        ),
        ("foo(x)", "unknown function 'foo'"),
        ("sinn(x)", "did you mean 'sin'?"),
        ("1 + tt", "column 5: unknown name 'tt'"),
        ("atan2(x)", "atan2 takes 2 arguments, found 1"),
        ("1.2.3", "'1.2.3' is not a number"),
        ("", "column 1: ends where"),
        ("x ° y", "'°'"),
    ];
    for (text, wanted) in cases {
        let found = Expression::parse(text, &ALL).expect_err(text);
        assert!(found.contains(wanted), "{text}: {found}");
    }
    let found = Expression::parse("T", &["x", "y"]).expect_err("T is not admitted");
    assert!(
        found.contains("nothing depends on 'T' here, only on x, y"),
        "{found}"
    );
}

#[test]
fn deep_formulas_are_refused_instead_of_ending_the_process() {
    let nested = format!("{}1{}", "(".repeat(100_000), ")".repeat(100_000));
    assert!(
        Expression::parse(&nested, &ALL)
            .expect_err("too deep")
            .contains("64 parentheses")
    );
    let tower = vec!["2"; 100].join("^");
    assert!(
        Expression::parse(&tower, &ALL)
            .expect_err("too deep")
            .contains("32 values")
    );
    assert!((value(&format!("{}1", "-".repeat(100_000))) - 1.0).abs() < f64::EPSILON);
}

fn table(t_k: &[f64], value: &[f64], extrapolate: Extrapolate) -> Property {
    Property::Table(TemperatureTable {
        t_k: t_k.to_vec(),
        value: value.to_vec(),
        extrapolate,
    })
}

#[test]
fn tables_are_linear_between_their_rows_and_end_at_the_last() {
    let property = table(
        &[300.0, 800.0, 1800.0],
        &[60.0, 40.0, 30.0],
        Extrapolate::Error,
    );
    let curve = property.compile("/k", &["T"]).expect("a good table");
    for (t, wanted) in [
        (300.0, 60.0),
        (550.0, 50.0),
        (800.0, 40.0),
        (1300.0, 35.0),
        (1800.0, 30.0),
    ] {
        let found = curve.at_temperature(t).expect("within");
        assert!((found - wanted).abs() < 1e-12, "{t} K: {found}");
    }
    for t in [299.9, 1800.1, f64::NAN, f64::INFINITY] {
        assert!(
            matches!(curve.at_temperature(t), Err(OutOfRange::Table { from, .. }) if (from - 300.0).abs() < 1e-9)
        );
    }
    let held = table(&[300.0, 800.0], &[60.0, 40.0], Extrapolate::Constant)
        .compile("/k", &["T"])
        .expect("good");
    assert!((held.at_temperature(1e4).expect("held") - 40.0).abs() < 1e-12);
    assert!((held.at_temperature(0.0).expect("held") - 60.0).abs() < 1e-12);
    assert!(held.at_temperature(f64::NAN).is_err());
    assert_eq!(
        (held.range_k(), curve.range_k()),
        (None, Some((300.0, 1800.0)))
    );
}

#[test]
fn wrong_properties_are_refused_where_they_are_wrong() {
    let refused = |property: Property, names: &[&str]| {
        property
            .compile("/k", names)
            .expect_err("wrong")
            .to_string()
    };
    let falling = refused(
        table(&[300.0, 200.0], &[1.0, 2.0], Extrapolate::Error),
        &["T"],
    );
    assert!(
        falling.starts_with("/k/t_k/1: 200 K does not rise above 300 K"),
        "{falling}"
    );
    let cold = refused(
        table(&[-1.0, 200.0], &[1.0, 2.0], Extrapolate::Error),
        &["T"],
    );
    assert!(
        cold.starts_with("/k/t_k/0: -1 K is out of range: at least 0 K"),
        "{cold}"
    );
    let unequal = refused(
        table(&[300.0, 400.0, 500.0], &[1.0, 2.0], Extrapolate::Error),
        &["T"],
    );
    assert!(unequal.contains("3 temperatures and 2 values"), "{unequal}");
    let nowhere = refused(
        table(&[300.0, 400.0], &[1.0, 2.0], Extrapolate::Error),
        &["x"],
    );
    assert!(nowhere.contains("nothing depends on T"), "{nowhere}");
    let infinite = refused(Property::Constant(f64::INFINITY), &["T"]);
    assert!(infinite.contains("not a finite number"), "{infinite}");
}

#[test]
fn a_formula_without_a_finite_value_is_an_error_where_it_is_asked() {
    let property: Property =
        serde_json::from_str(r#"{"expr": "1/(x - 0.5)"}"#).expect("a property");
    let curve = property.compile("/q", &["x"]).expect("a formula");
    assert!((curve.value(&Arguments { x: 1.5, ..at() }).expect("finite") - 1.0).abs() < 1e-15);
    let error = curve
        .value(&Arguments { x: 0.5, ..at() })
        .expect_err("infinite");
    assert!(error.to_string().contains("x = 0.5"), "{error}");
}

#[test]
fn a_formula_without_variables_costs_no_more_than_a_number() {
    let property: Property = serde_json::from_str(r#"{"expr": "2*pi"}"#).expect("a property");
    let curve = property.compile("/q", &["x"]).expect("a formula");
    assert!((curve.constant().expect("constant") - 2.0 * PI).abs() < 1e-15);
}

#[test]
fn quantities_that_must_be_positive_are_refused_at_their_row() {
    let refused = |property: Property| {
        property
            .compile_positive("/rho", &["T"], "kg/m3")
            .expect_err("wrong")
            .to_string()
    };
    assert_eq!(
        refused(Property::Constant(-7850.0)),
        "/rho: -7850 kg/m3 is out of range: above 0 kg/m3"
    );
    let rows = refused(table(
        &[300.0, 400.0, 500.0],
        &[1.0, 2.0, 0.0],
        Extrapolate::Error,
    ));
    assert_eq!(rows, "/rho/value/2: 0 kg/m3 is out of range: above 0 kg/m3");
    let minus: Property = serde_json::from_str(r#"{"expr": "2 - 3"}"#).expect("a property");
    assert!(refused(minus).contains("-1 kg/m3"));
    assert!(
        Property::Constant(7850.0)
            .compile_positive("/rho", &["T"], "kg/m3")
            .is_ok()
    );
}
