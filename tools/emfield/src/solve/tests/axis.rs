use nalgebra::DMatrix;

use super::super::diffusion::{Conductors, Unknown};
use super::super::sides::{Form, Sides};
use crate::assemble::region;
use crate::cloud::Cloud;
use crate::scene::Scene;

/// Rates at which fields in conductors with `mu sigma` of 1 fall, slowest first; the rows that hold at each instant are
/// solved for.
fn rates(scene: &str, order: u8) -> Vec<f64> {
    let scene: Scene = serde_json::from_str(scene).unwrap();
    let cloud = Cloud::new(&scene).unwrap();
    let region = region::<2>(&scene, &cloud, &|_| false);
    let form = Form {
        order,
        around: Unknown::Around.around(),
        ..Form::default()
    };
    let sides = Sides::new(&region, &form).unwrap();
    let conductors = Conductors {
        mu_sigma: (0..cloud.media)
            .map(|m| scene.medium(m).conductivity_s_m)
            .collect(),
    };
    let rows = conductors.rows(&region, &sides, Unknown::Around);
    let rates = conductors.rates(&region, &sides, Unknown::Around);
    let n = region.len();
    let (moving, still): (Vec<usize>, Vec<usize>) = (0..n).partition(|i| rates[*i] != 0.0);
    let mut dense: DMatrix<f64> = DMatrix::zeros(n, n);
    for i in 0..n {
        for (j, v) in rows.columns(i).iter().zip(rows.values(i)) {
            dense[(i, *j as usize)] += v;
        }
    }
    let part =
        |a: &[usize], b: &[usize]| DMatrix::from_fn(a.len(), b.len(), |i, j| dense[(a[i], b[j])]);
    let bound = part(&still, &still).lu().solve(&part(&still, &moving));
    let mut reduced: DMatrix<f64> = part(&moving, &moving) - part(&moving, &still) * bound.unwrap();
    for (k, &i) in moving.iter().enumerate() {
        reduced.row_mut(k).scale_mut(1.0 / rates[i]);
    }
    let mut found: Vec<f64> = reduced
        .complex_eigenvalues()
        .iter()
        .map(|c| -c.re)
        .collect();
    found.sort_by(f64::total_cmp);
    found
}

/// A ball of radius 1 in air, or a rod that fills the domain.
fn scene(ball: bool, points: &str) -> String {
    let (walls, conductor) = if ball {
        (
            2,
            r#""bodies": [{"name": "ball", "shape": {"disc": {"centre_m": [0, 0], "radius_m": 1}}, "conductivity_s_m": 1}]"#,
        )
    } else {
        (1, r#""surroundings": {"conductivity_s_m": 1}"#)
    };
    format!(
        r#"{{"geometry": "axisymmetric", "domain": {{"box": {{"min_m": [0, -{walls}], "max_m": [{walls}, {walls}]}}}}, {conductor},
        "eddy_currents": {{"transient": {{"end_s": 1, "step_s": 1}}, "applied_flux_density_t": [0, 1]}}, "points": {points}}}"#
    )
}

#[test]
fn no_field_grows_about_an_axis() {
    // j_11^2 + (pi/2)^2: A_phi goes as J1 across a rod of radius 1, and as half a wave along its length of 2.
    let rod = 3.831_705_970_207_512_f64.powi(2) + std::f64::consts::FRAC_PI_2.powi(2);
    for order in [2, 3, 4] {
        let found = rates(&scene(false, r#"{"spacing_m": 0.07}"#), order);
        assert!((found[0] / rod - 1.0).abs() < 0.02, "{order}: {}", found[0]);
        for points in [
            r#"{"spacing_m": 0.1}"#,
            r#"{"spacing_m": 0.1, "jitter": 0.2}"#,
            r#"{"spacing_m": 0.15, "layers": {"first_m": 0.05}}"#,
        ] {
            // pi^2 in free space; walls at twice the radius leave the field less room.
            let least = rates(&scene(true, points), order)[0];
            assert!((9.7..11.2).contains(&least), "{order}, {points}: {least}");
        }
    }
}
