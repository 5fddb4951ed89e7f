//! That in each scene something happens that a stop might spoil.

use artefact::Reader;

/// The scene must be worth the test: metal moves, and melts or sets.
pub(super) fn happens(reader: &Reader) {
    let balance = reader.records("/balance").unwrap();
    let liquid = |i: usize| balance[i].1.get("liquid_particles").unwrap();
    let (first, last) = (liquid(0), liquid(balance.len() - 1));
    assert!(
        (first - last).abs() > 100.0,
        "{first} and {last} liquid particles"
    );
    let frames = reader.count("/particles");
    let at = |i: usize| {
        let frame = reader.frame("/particles", i).unwrap();
        frame.position_vectors().unwrap()
    };
    let (start, end) = (at(frames - 2), at(frames - 1));
    let moved = start.iter().zip(&end).map(|(a, b)| (a[2] - b[2]).abs());
    assert!(moved.fold(0.0, f64::max) > 1e-4);
}

/// The drop must change its shape, and fall.
pub(super) fn swings(reader: &Reader) {
    let rows = reader.records("/liquid").unwrap();
    let at = |i: usize, name: &str| rows[i].1.get(name).unwrap();
    let last = rows.len() - 1;
    assert!(at(0, "axis_ratio") - at(last, "axis_ratio") > 0.01);
    assert!(at(last, "centre_z") < -1e-5);
}

/// The drops must become one.
pub(super) fn meet(reader: &Reader) {
    let rows = reader.records("/liquid").unwrap();
    let drops = |i: usize| rows[i].1.get("drops").unwrap() as u32;
    assert_eq!((drops(0), drops(rows.len() - 1)), (2, 1));
}

/// The surface must rise and fall.
pub(super) fn sloshes(reader: &Reader) {
    let last = reader.count("/points") - 1;
    let heights = |i: usize| {
        let frame = reader.frame("/points", i).unwrap();
        frame.position_vectors().unwrap()
    };
    let moved = heights(0).into_iter().zip(heights(last));
    let most = moved.map(|(a, b)| (a[2] - b[2]).abs().max((a[1] - b[1]).abs()));
    assert!(most.fold(0.0, f64::max) > 1e-5);
}

/// Temperatures must change, and heat must not be lost.
pub(super) fn warms(reader: &Reader) {
    let balance = reader.records("/balance").unwrap();
    let last = &balance[balance.len() - 1].1;
    let (stored, lost) = (last.get("stored").unwrap(), last.get("imbalance").unwrap());
    assert!(stored.abs() > 0.01, "stored {stored} J");
    assert!(
        lost.abs() < 1e-6 * stored.abs(),
        "lost {lost} J of {stored} J"
    );
}

/// The field must enter the ball, and heat it less in the end than at first.
pub(super) fn enters(reader: &Reader) {
    let totals = reader.records("/totals").unwrap();
    let heat = |i: usize| totals[i].1.get("power_volume").unwrap();
    let (early, late) = (heat(1), heat(totals.len() - 1));
    assert!(totals.len() > 10 && heat(0).abs() < 1e-300);
    assert!(late > 0.0 && late < 0.5 * early, "{early} W and {late} W");
}
