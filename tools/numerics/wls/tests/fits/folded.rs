//! Points and their images beyond a plane of symmetry.

use wls::{Everything, Plan, Stencils, Wants};

use crate::clouds::{Points, lattice};

#[test]
fn an_image_counts_as_its_point() {
    let half = lattice::<2>(12, 0.2);
    let own = half.places.len();
    let mut whole = half.clone();
    for (place, metric) in half.places.iter().zip(&half.metrics) {
        whole.places.push([-place[0], place[1]]);
        whole.metrics.push(metric.mirrored(0));
    }
    let origin: Vec<u32> = (0..2 * own).map(|j| (j % own) as u32).collect();
    let wants = Wants {
        gradient: true,
        laplacian: true,
        ..Wants::default()
    };
    let plan = Plan::new::<2>(4, wants);
    let build = |points: &Points<2>| Stencils::build(&points.search(), &plan, &Everything).unwrap();
    let (plain, folded) = (build(&whole), build(&whole).folded(&origin));
    assert_eq!(folded.rows(), own);
    let even = |p: [f64; 2]| (2.0 * p[0]).cos() * p[1].exp();
    let (all, part) = (whole.field(even), half.field(even));
    // Beside the plane and elsewhere.
    let mut worst = [0.0_f64; 2];
    for i in 0..own {
        assert!(folded.neighbours(i).iter().all(|j| (*j as usize) < own));
        let [a, b] = [
            plain.laplacian(i).apply(&all),
            folded.laplacian(i).apply(&part),
        ];
        assert!((a - b).abs() < 1e-12, "{a} {b}");
        let place = half.places[i];
        let far = (b + 3.0 * even(place)).abs();
        if (0.3..0.7).contains(&place[1]) {
            let side = usize::from(place[0] > 0.3);
            if place[0] < 0.7 {
                worst[side] = worst[side].max(far);
            }
        }
        if place[0] < 0.1 {
            let image = origin.len() / 2 + i;
            let both = plain.laplacian(i).own(i) + plain.laplacian(i).own(image);
            assert!((folded.laplacian(i).own(i) - both).abs() < 1e-9 * both.abs());
        }
    }
    assert!(worst[0] < 2.0 * worst[1] && worst[1] < 0.1, "{worst:?}");
}

#[test]
fn a_mirrored_metric_measures_the_image_of_an_offset_alike() {
    let metric = wls::Metric::<2>::layered([0.6, 0.8], 0.1, 0.3);
    let [a, b] = [
        metric.scaled([0.02, 0.05]),
        metric.mirrored(0).scaled([-0.02, 0.05]),
    ];
    assert!((a[0] + b[0]).abs() < 1e-15 && (a[1] - b[1]).abs() < 1e-15);
}
