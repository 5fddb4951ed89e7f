use super::cells::{Cells, Ground};
use super::*;
use crate::cloud::Cloud;
use crate::operator::{Links, Operator};
use run::property::{Formula, Property};

fn materials(text: &str, contacts: &str) -> Materials {
    let scene = format!(
        r#"{{"dimensions": 2, "body": {{"box": {{"min_m": [0, 0], "max_m": [1, 1]}}}},
            "points": {{"spacing_m": 0.1}}, "initial_temperature_k": 0,
            "materials": {text}, "contacts": {contacts}}}"#
    );
    setup::materials(&serde_json::from_str(&scene).unwrap(), (0.0, 1.0)).unwrap()
}

const TWO: &str = r#"[
    {"name": "left", "density_kg_m3": 2, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": 10,
     "region": {"half_space": {"point_m": [0.43, 0], "normal": [1, 0]}}},
    {"name": "right", "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": 0.1}]"#;

#[test]
fn layers_are_resistances_in_series() {
    let layers = materials(TWO, "[]");
    let (a, b) = ([0.4, 0.2, 0.0], [0.5, 0.6, 0.0]);
    let k = layers.fixed(a, b).unwrap();
    let exact = 1.0 / (0.3 / 10.0 + 0.7 / 0.1);
    assert!((k - exact).abs() < 1e-10 * exact, "{k} {exact}");
    assert!((layers.fixed(b, a).unwrap() - k).abs() < 1e-12 * k);
    assert!((layers.fixed([0.1, 0.0, 0.0], [0.2, 0.3, 0.0]).unwrap() - 10.0).abs() < 1e-12);
}

#[test]
fn a_contact_adds_its_resistance_across_the_interface() {
    let layers = materials(
        TWO,
        r#"[{"between": ["right", "left"], "resistance_m2_k_w": 0.5}]"#,
    );
    // Along a slanted link of a field that varies with x alone: dx / k = dx1/k1 + R + dx2/k2.
    let (a, b) = ([0.4, 0.2, 0.0], [0.5, 0.6, 0.0]);
    let exact = 0.1 / (0.03 / 10.0 + 0.5 + 0.07 / 0.1);
    let k = layers.fixed(a, b).unwrap();
    assert!((k - exact).abs() < 1e-8 * exact, "{k} {exact}");
}

#[test]
fn no_layer_is_too_thin_to_be_met() {
    // A film between 0.43 and 0.43 + w, with contacts on both of its faces.
    for width in [0.05, 1e-2, 1e-3, 1e-6] {
        let text = format!(
            r#"[{{"name": "film", "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": 1e-3,
                "region": {{"box": {{"min_m": [0.43, -9], "max_m": [{}, 9]}}}}}},
               {{"name": "rest", "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": 10}}]"#,
            0.43 + width
        );
        for resistance in [0.0, 0.5] {
            let contacts =
                format!(r#"[{{"between": ["film", "rest"], "resistance_m2_k_w": {resistance}}}]"#);
            let layers = materials(&text, &contacts);
            for b in [[0.5, 0.2, 0.0], [0.5, 0.3, 0.0], [0.5, -0.1, 0.0]] {
                let k = layers.fixed([0.4, 0.2, 0.0], b).unwrap();
                let exact = 0.1 / ((0.1 - width) / 10.0 + width / 1e-3 + 2.0 * resistance);
                assert!(
                    (k - exact).abs() < 1e-7 * exact,
                    "{width} {b:?}: {k} {exact}"
                );
            }
        }
    }
}

#[test]
fn a_conductivity_of_place_has_its_harmonic_mean() {
    let graded = materials(
        r#"[{"name": "m", "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": {"expr": "exp(3*x)"}}]"#,
        "[]",
    );
    let exact = 0.1 * 3.0 / ((-0.6_f64).exp() - (-0.9_f64).exp());
    let k = graded.fixed([0.2, 0.0, 0.0], [0.3, 0.0, 0.0]).unwrap();
    assert!((k - exact).abs() < 1e-7 * exact, "{k} {exact}");
    assert!(!graded.nonlinear());
    let jump = materials(
        r#"[{"name": "m", "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": {"expr": "if(x - 0.25, 100, 1)"}}]"#,
        "[]",
    );
    let k = jump.fixed([0.2, 0.0, 0.0], [0.3, 0.0, 0.0]).unwrap();
    assert!((k - 1.0 / 0.505).abs() < 0.02, "{k}");
}

const LATTICE: &str = r#"{"spacing_m": 0.1}"#;

/// Capacities and first temperatures of points in a square across the interface at 0.43.
fn cells(materials: &Materials, points: &str) -> (Cloud, Cells) {
    let body = Body::new(
        &serde_json::from_str(r#"{"box": {"min_m": [0, 0], "max_m": [1, 1]}}"#).unwrap(),
        2,
    );
    let cloud = Cloud::fill(&body, &serde_json::from_str(points).unwrap(), 2).unwrap();
    let links = Links::new(&cloud, Operator::default()).unwrap();
    let step = Property::Formula(Formula {
        expr: "if(0.43 - x, 5, 1)".to_owned(),
    });
    let ground = Ground {
        cloud: &cloud,
        links: &links,
        body: &body,
    };
    let cells = materials
        .cells(ground, &step.compile("/t", &PLACE).unwrap())
        .unwrap();
    (cloud, cells)
}

fn capacities(cells: &Cells) -> Vec<f64> {
    let each = cells.temperature.iter().enumerate();
    each.map(|(i, t)| cells.storage.capacity(i, *t)).collect()
}

#[test]
fn cells_store_what_the_body_stores() {
    for contacts in [
        "[]",
        r#"[{"between": ["left", "right"], "resistance_m2_k_w": 0.5}]"#,
    ] {
        let layers = materials(TWO, contacts);
        let (_, cells) = cells(&layers, LATTICE);
        let each = capacities(&cells);
        let capacity: f64 = each.iter().sum();
        assert!((capacity - (2.0 * 0.43 + 0.57)).abs() < 1e-9, "{capacity}");
        let heat = each.iter().zip(&cells.temperature).map(|(c, t)| c * t);
        let heat: f64 = heat.sum();
        assert!((heat - (5.0 * 2.0 * 0.43 + 0.57)).abs() < 1e-9, "{heat}");
    }
}

#[test]
fn cells_of_shifted_points_share_the_body_between_them() {
    // Cubes about the points overlap and leave gaps: they err by up to 1e-3 here.
    for seed in 1..=8 {
        let points = format!(r#"{{"spacing_m": 0.05, "jitter": 0.3, "seed": {seed}}}"#);
        let (_, cells) = cells(&materials(TWO, "[]"), &points);
        let capacity: f64 = capacities(&cells).iter().sum();
        let error = capacity / (2.0 * 0.43 + 0.57) - 1.0;
        assert!(error.abs() < 3e-4, "seed {seed}: {error}");
    }
}

#[test]
fn a_foreign_part_goes_to_those_who_conduct_to_it() {
    // The cell about x = 0.4 reaches from 0.35 to 0.45, the interface is at 0.43, the next point at 0.5 is behind
    // 0.07 of the poor conductor: half of that, 0.035, is the good one's, for it is as good as at 0.43.
    let (cloud, found) = cells(&materials(TWO, "[]"), LATTICE);
    let at = |x: f64, cells: &Cells| {
        let place = cloud
            .position
            .iter()
            .position(|p| (p[0] - x).abs() + (p[1] - 0.5).abs() < 1e-9);
        capacities(cells)[place.unwrap()]
    };
    let whole = 0.1 * (0.08 * 2.0 + 0.035);
    let found_there = at(0.4, &found);
    assert!((found_there - whole).abs() < 2e-3 * whole, "{found_there}");
    let rest = 0.1 * (0.55 - 0.465);
    let found_there = at(0.5, &found);
    assert!((found_there - rest).abs() < 5e-3 * rest, "{found_there}");
    // Behind a contact it hangs on its own kind.
    let behind = r#"[{"between": ["left", "right"], "resistance_m2_k_w": 1e6}]"#;
    let (_, found) = cells(&materials(TWO, behind), LATTICE);
    assert!((at(0.4, &found) - 0.01 * 1.6).abs() < 1e-6);
}

#[test]
fn a_formula_of_place_and_temperature_is_told_from_the_others() {
    let one = |k: &str| {
        let text = format!(
            r#"[{{"name": "m", "density_kg_m3": 1, "specific_heat_j_kg_k": 1, "conductivity_w_m_k": {k}}}]"#
        );
        materials(&text, "[]")
    };
    assert!(matches!(
        one(r#"{"expr": "x + exp(T)"}"#).law(0),
        Law::Formula(_)
    ));
    assert!(one(r#"{"expr": "exp(T)"}"#).nonlinear());
    assert!(!one("7").nonlinear());
}
