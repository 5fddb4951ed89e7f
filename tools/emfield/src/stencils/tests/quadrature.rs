use crate::stencils::quadrature::weights;
use crate::stencils::region::Kind;
use crate::stencils::sides::Form;
use crate::stencils::tests::shells;

/// The integral of `exp(3 (z - 1))` over the unit ball, and its error over a ball of shells.
fn error(across: f64, along: f64, order: u8) -> f64 {
    let (region, cells) = shells(across, along);
    let form = Form {
        order,
        ..Form::default()
    };
    let found: f64 = weights(&region, &cells, &form)
        .unwrap()
        .iter()
        .zip(&region.places)
        .map(|(w, x)| w * (3.0 * (x[2] - 1.0)).exp())
        .sum();
    let k = 3.0_f64;
    let exact = 4.0 * std::f64::consts::PI * (k * k.cosh() - k.sinh()) / k.powi(3) * (-k).exp();
    (found / exact - 1.0).abs()
}

#[test]
fn integrals_over_cells_are_of_third_order() {
    for order in [2, 4] {
        let errors = [0.3, 0.2, 0.14, 0.1].map(|h| error(0.6 * h, h, order));
        println!("{order} {errors:?}");
        assert!(errors[3] < 1e-4, "{errors:?}");
        let found = (errors[0] / errors[3]).ln() / 3.0_f64.ln();
        assert!(found > 3.0, "order {found}: {errors:?}");
    }
}

#[test]
fn a_cell_outside_takes_nothing_from_the_inner_side_of_an_interface() {
    let (region, mut cells) = shells(0.2, 0.4);
    let near = |i: &usize| region.kinds[*i] == Kind::Inside(0);
    let i = (0..region.len()).find(near).unwrap();
    cells.iter_mut().for_each(|c| c.volume = 0.0);
    (cells[i].volume, cells[i].first) = (1.0, [0.0, 0.0, 0.05]);
    cells[i].second = [[0.0; 3]; 3];
    let found = weights(&region, &cells, &Form::default()).unwrap();
    let height = |(w, x): (&f64, &[f64; 3])| w * (x[2] - region.places[i][2]);
    assert!((found.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    let first: f64 = found.iter().zip(&region.places).map(height).sum();
    assert!((first - 0.05).abs() < 1e-9);
    assert!((0..region.len()).all(|j| found[j] == 0.0 || region.medium(j) == 0));
}

#[test]
fn where_nothing_conducts_nothing_is_weighed() {
    let (region, _) = shells(0.2, 0.4);
    let found = weights(&region, &[], &Form::default()).unwrap();
    assert!(found.iter().all(|w| *w == 0.0));
}
