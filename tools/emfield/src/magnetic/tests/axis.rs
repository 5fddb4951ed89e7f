use krylov::{Options, Rule, System};
use nalgebra::DMatrix;

use crate::cloud;
use crate::electric::equations::{Held, Problem};
use crate::magnetic::diffusion::Conductors;
use crate::magnetic::unknown::Unknown;
use crate::scene::Scene;
use crate::stencils::region::Kind;
use crate::stencils::setup::region;
use crate::stencils::sides::{Form, Sides};

/// Rates at which fields in conductors with `mu sigma` of 1 fall, slowest first; the rows that hold at each instant are
/// solved for.
fn rates(scene: &str, order: u8) -> Vec<f64> {
    let scene: Scene = serde_json::from_str(scene).unwrap();
    let cloud = cloud::setup::cloud(&scene).unwrap();
    let region = region::<2>(&scene, &cloud, &|_| false);
    let form = Form {
        order,
        around: Unknown::Around.around(),
        ..Form::default()
    };
    let sides = Sides::new(&region, &form).unwrap();
    let conductors = Conductors {
        mu_sigma: (0..cloud.media.len())
            .map(|m| scene.medium(m).conductivity_s_m)
            .collect(),
        axial: None,
        permeable: None,
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
    for order in [1, 2, 3, 4] {
        let found = rates(&scene(false, r#"{"spacing_m": 0.07}"#), order);
        assert!((found[0] / rod - 1.0).abs() < 0.02, "{order}: {}", found[0]);
        for points in [
            r#"{"spacing_m": 0.1}"#,
            r#"{"spacing_m": 0.1, "jitter": 0.2}"#,
            r#"{"spacing_m": 0.15, "layers": {"first_m": 0.05}}"#,
        ] {
            // pi^2 in free space; walls at twice the radius leave the field less room.
            let least = rates(&scene(true, points), order)[0];
            // Slopes of linear polynomials at the surface err by a tenth of the spacing or so.
            let range = if order == 1 { 8.7..11.2 } else { 9.7..11.2 };
            assert!(range.contains(&least), "{order}, {points}: {least}");
        }
    }
}

/// Largest errors of potential, and of field over its largest, of a ball of permittivity 80 in a uniform field, whose
/// exact potential holds on the walls.
fn ball(spacing: f64, order: u8) -> [f64; 2] {
    let scene = scene(
        true,
        &format!(r#"{{"spacing_m": {spacing}, "outward": 0}}"#),
    );
    let scene: Scene = serde_json::from_str(&scene).unwrap();
    let cloud = cloud::setup::cloud(&scene).unwrap();
    let region = region::<2>(&scene, &cloud, &|_| false);
    let form = Form {
        order,
        ..Form::default()
    };
    let sides = Sides::new(&region, &form.for_potentials()).unwrap();
    let share = 79.0 / 82.0;
    let exact = |[r, z]: [f64; 2]| {
        let cube = r.hypot(z).powi(3).max(1.0);
        -z * (1.0 - share / cube)
    };
    let held = |i: usize| {
        matches!(region.kinds[i], Kind::Wall { .. })
            .then(|| Held::Potential(exact(region.places[i])))
    };
    let problem = Problem {
        permittivity: vec![1.0, 80.0],
        electrodes: vec![None; 2],
        held: (0..region.len()).map(held).collect(),
    };
    let (rows, right) = problem.rows(&region, &sides);
    let mut x = vec![[0.0]; region.len()];
    let mut system = System::new(rows, vec![], Options::default()).unwrap();
    assert!(system.solve(&right, &mut x, Rule::default()).converged());
    let v: Vec<f64> = x.into_iter().map(|x| x[0]).collect();
    let field = Problem::field(&region, &sides, &v, true);
    let mut worst: [f64; 2] = [0.0; 2];
    for (i, place) in region.places.iter().enumerate() {
        worst[0] = worst[0].max((v[i] - exact(*place)).abs());
        if region.touches(i, 1) {
            let [r, z] = field[i];
            worst[1] = worst[1].max(r.hypot(z - 3.0 / 82.0) / (1.0 + 2.0 * share));
        }
    }
    worst
}

#[test]
fn linear_slopes_about_an_axis_are_of_first_order() {
    let errors = [0.1, 0.05, 0.025].map(|h| ball(h, 1));
    for pair in errors.windows(2) {
        let falls = pair[1].iter().zip(&pair[0]).all(|(b, a)| *b < 0.72 * a);
        assert!(falls, "{errors:?}");
    }
    assert!(errors[2][0] < 5e-4 && errors[2][1] < 2e-3, "{errors:?}");
}
