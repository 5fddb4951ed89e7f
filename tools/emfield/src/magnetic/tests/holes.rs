use crate::magnetic::holes::{Holes, Media};
use crate::stencils::region::Region;
use crate::stencils::sides::{Form, Sides};
use crate::stencils::tests::rings;

/// Points of a hole of radius 1 in a conductor that ends at walls, or of a conductor of radius 1 in air.
fn disc() -> (Region<2>, Sides<2>) {
    let region = rings(0.1);
    let sides = Sides::new(&region, &Form::default()).unwrap();
    (region, sides)
}

#[test]
fn a_hole_is_what_conductors_enclose() {
    let (region, sides) = disc();
    let hole = Holes::of(&region, &sides, |m| m == 0);
    let body = Holes::of(&region, &sides, |m| m == 1);
    for (i, [x, y]) in region.places.iter().enumerate() {
        let within = x.hypot(*y) < 1.0 + 1e-9;
        assert_eq!(hole.at(i).is_some(), within, "{x} {y}");
        assert_eq!(hole.at(i), hole.at(0).filter(|_| within));
        assert_eq!(body.at(i), None);
    }
}

#[test]
fn the_law_of_induction_is_exact_for_quadratics() {
    let (region, sides) = disc();
    let holes = Holes::of(&region, &sides, |m| m == 0);
    let hole = holes.at(0).unwrap();
    let [without, with] = [[0.0; 2], [0.0, 3.0]];
    let [without, with] = [&without, &with].map(|mu| Media {
        mu_sigma: &[1.0, 0.0],
        resistivity: &[1.0, 0.0],
        mu,
    });
    // The mean slope of x^2 + 2 y^2 + x along a circle is half its Laplacian.
    let mut slope = 0.0;
    hole.row(&region, &sides, without, |j, w| {
        let [x, y] = region.places[j];
        slope += w * (x * x + 2.0 * y * y + x);
    });
    let shares = -hole.rate(&region, &sides, without);
    assert!(
        (slope + 6.0 * shares - 3.0).abs() < 1e-9,
        "{slope} {shares}"
    );
    // A permeability of 3 times the area, over the length.
    let flux = hole.rate(&region, &sides, with) + shares;
    assert!((flux - 1.5).abs() < 1e-12, "{flux}");
}
