//! Two blocks that meet: along their lattices, and with turned ones.

use particles::{Matter, Set};

use super::*;
use crate::matter::lattice::{Filling, Lattice};

const D: f64 = 0.1;
const K: f64 = 5.0;

/// Two blocks in the plane, one on the other with an overlap \[m\], the upper one moved aside \[m\], on lattices that are turned.
fn blocks(overlap: f64, aside: f64, turned: f64) -> (State, Contact) {
    let mut state = State::new(2);
    let mut parties = Vec::new();
    for (number, (low, high)) in [(-1.0, 0.0), (0.0, 1.0)].into_iter().enumerate() {
        let shape = serde_json::json!({"box": {"min_m": [-2.0, low], "max_m": [2.0, high]}});
        let body = Body::new(&serde_json::from_value(shape).unwrap(), 2);
        let filling = Filling {
            spacing: D,
            turned,
            jitter: 0.0,
            dimensions: 2,
        };
        let lattice = Lattice::fill(&body, &filling).unwrap();
        let matter = Matter {
            density: 1.0,
            spacing: D,
            smoothing_length: 1.5 * D,
        };
        let mut set = Set::new(format!("block {number}"), matter);
        set.declare(&VELOCITY);
        set.declare(&ACCELERATION);
        set.declare(&MASS);
        set.declare(&REST);
        let moved = number as f64;
        for x in &lattice.places {
            let row = set.push(&mut state.ids);
            set.column_mut(&POSITION)[row] = [x[0] + moved * aside, x[1] - moved * overlap, 0.0];
            set.column_mut(&REST)[row] = *x;
            set.column_mut(&MASS)[row] = 1.0;
        }
        parties.push(Party {
            set: number,
            spacing: D,
            stiffness: K,
            depths: lattice.places.iter().map(|x| -body.distance(*x)).collect(),
        });
        state.sets.push(set);
    }
    (state, Contact::new(parties, Vec::new(), 0.0))
}

/// Force on the lower block \[N\] and what is stored \[J\].
fn pressed(overlap: f64, aside: f64, turned: f64) -> ([f64; 2], f64) {
    let (mut state, mut contact) = blocks(overlap, aside, turned);
    contact.act(&mut state, 0.0).unwrap();
    let sum = |set: &Set| {
        let each = set.column(&ACCELERATION).iter();
        each.fold([0.0; 2], |sum, a| [sum[0] + a[0], sum[1] + a[1]])
    };
    let [lower, upper] = [0, 1].map(|k: usize| sum(&state.sets[k]));
    let size = lower[0].hypot(lower[1]);
    assert!((lower[0] + upper[0]).hypot(lower[1] + upper[1]) <= 1e-12 * size);
    (lower, contact.entry(&state).stored)
}

#[test]
fn faces_along_the_lattice_are_springs() {
    let (mut state, mut contact) = blocks(0.1 * D, 0.0, 0.0);
    contact.act(&mut state, 0.0).unwrap();
    let set = &state.sets[0];
    let inside = |a: &usize| set.column(&REST)[*a][0].abs() < 1.0;
    let pushed = (0..set.len())
        .filter(inside)
        .map(|a| set.column(&ACCELERATION)[a]);
    let force = pushed.fold([0.0; 2], |sum, a| [sum[0] + a[0], sum[1] + a[1]]);
    let exact = -20.0 * K * 0.1 * D;
    assert!((force[1] / exact - 1.0).abs() < 1e-12, "{force:?} {exact}");
    assert!(force[0].abs() < 1e-12 * exact.abs());
}

#[test]
fn the_force_is_the_slope_of_what_it_stores() {
    let at = |overlap: f64, aside: f64| pressed(overlap, aside, 0.35).1;
    let (force, _) = pressed(0.3 * D, 0.02, 0.35);
    let step = 1e-6;
    let up = (at(0.3 * D + step, 0.02) - at(0.3 * D - step, 0.02)) / (2.0 * step);
    let along = (at(0.3 * D, 0.02 + step) - at(0.3 * D, 0.02 - step)) / (2.0 * step);
    // What presses the upper block in presses the lower one down; what would store more pushes it back, and the lower one on.
    assert!((up + force[1]).abs() < 1e-6 * up, "{up} {force:?}");
    assert!((along - force[0]).abs() < 1e-6 * up, "{along} {force:?}");
}

#[test]
fn turned_lattices_hardly_catch_in_each_other() {
    for step in 0..10 {
        let (force, _) = pressed(0.3 * D, 0.1 * D * f64::from(step), 0.35);
        assert!(force[0].abs() < 0.02 * force[1].abs(), "{step}: {force:?}");
    }
}

#[test]
fn who_does_not_touch_is_not_pushed() {
    for turned in [0.0, 0.35] {
        let (force, stored) = pressed(-1e-9, 0.0, turned);
        assert!(force[0].abs() + force[1].abs() + stored <= 0.0);
    }
}

#[test]
fn what_breaks_at_rest_does_not_push_on_lattices_that_are_no_squares() {
    let mut state = State::new(2);
    let matter = Matter {
        density: 1.0,
        spacing: D,
        smoothing_length: 1.5 * D,
    };
    let mut set = Set::new("crushed", matter);
    set.declare(&VELOCITY);
    set.declare(&ACCELERATION);
    set.declare(&MASS);
    set.declare(&REST);
    set.declare(&BROKEN);
    for i in 0..36 {
        let place = [0.8 * D * f64::from(i % 6), 1.25 * D * f64::from(i / 6), 0.0];
        let row = set.push(&mut state.ids);
        set.column_mut(&POSITION)[row] = place;
        set.column_mut(&REST)[row] = place;
        set.column_mut(&MASS)[row] = 1.0;
        set.column_mut(&BROKEN)[row] = 1;
    }
    state.sets.push(set);
    let party = Party {
        set: 0,
        spacing: D,
        stiffness: K,
        depths: Vec::new(),
    };
    let mut contact = Contact::new(vec![party], Vec::new(), 0.0);
    contact.act(&mut state, 0.0).unwrap();
    let pushed = state.sets[0].column(&ACCELERATION).iter().flatten();
    assert!(pushed.fold(contact.entry(&state).stored, |sum, a| sum + a.abs()) <= 0.0);
    // Pressed together they push.
    state.sets[0].column_mut(&POSITION)[7][0] += 0.1 * D;
    contact.act(&mut state, 0.0).unwrap();
    assert!(contact.entry(&state).stored > 0.0);
}
