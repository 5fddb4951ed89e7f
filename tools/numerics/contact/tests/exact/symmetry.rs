//! Invariances of a contact.

use contact::{
    Contact, Elastic, Ending, Friction, Grain, Hertz, History, Linear, Meeting, Rolling,
};
use proptest::prelude::*;

fn vector() -> impl Strategy<Value = [f64; 3]> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0_f64]
}

fn grain(position: [f64; 3], velocity: [f64; 3], spin: [f64; 3], radius: f64) -> Grain {
    Grain {
        position: position.map(|x| 1e-3 * x),
        velocity,
        spin: spin.map(|w| 1e3 * w),
        radius,
        mass: 3000.0 * radius.powi(3),
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    shapes::frame::cross(a, b)
}

proptest! {
    #[test]
    fn a_grain_beside_a_mirror_meets_its_image(x in vector(), u in vector(), w in vector(), distance in 0.05..1.2_f64) {
        let a = grain([distance, x[1], x[2]], u, w, 1e-3);
        let mut image = a;
        image.position[0] = -a.position[0];
        image.velocity[0] = -a.velocity[0];
        // A turn about the normal looks the same in a mirror, one about the plane is reversed.
        image.spin = [a.spin[0], -a.spin[1], -a.spin[2]];
        let told = Meeting::with_image(&a, a.position[0], [1.0, 0.0, 0.0]);
        let Some(pair) = Meeting::of(&a, &image) else {
            prop_assert!(told.overlap <= 0.0);
            return Ok(());
        };
        let near = |one: f64, other: f64, size: f64| (one - other).abs() <= 1e-13 * size;
        prop_assert!(near(told.overlap, pair.overlap, 1e-3) && near(told.approach, pair.approach, 1.0));
        prop_assert!(near(told.mass, pair.mass, a.mass) && near(told.radius, pair.radius, 1e-3));
        for k in 0..3 {
            prop_assert!(near(told.normal[k], pair.normal[k], 1.0) && near(told.slide[k], pair.slide[k], 1.0));
            prop_assert!(near(told.turn[k], pair.turn[k], 1e3) && near(told.swing[k], pair.swing[k], 1e3));
        }
        prop_assert!(near(told.arms[0], pair.arms[0], 1e-3) && near(told.arms[1], pair.arms[1], 1e-3));
    }

    #[test]
    fn swapping_grains_negates_every_bit_and_keeps_angular_momentum(
        xa in vector(), xb in vector(), ua in vector(), ub in vector(), wa in vector(), wb in vector(), s in vector()
    ) {
        let (a, b) = (grain(xa, ua, wa, 0.8e-3), grain(xb, ub, wb, 1.9e-3));
        let contact = Contact {
            normal: Linear::new(75.0, 60.0, 0.6, Ending::ZeroForce),
            friction: Some(Friction { coefficient: 0.4 }),
        };
        let rolling = Rolling { coefficient: 0.1, stiffness_ratio: 0.5 };
        let stretch = s.map(|x| 1e-5 * x);
        if let (Some(one), Some(other)) = (Meeting::of(&a, &b), Meeting::of(&b, &a)) {
            let mut seen = [History { stretch, stiffness: 60.0 }, History { stretch: stretch.map(|x| -x), stiffness: 60.0 }];
            let mut rolled = [stretch, stretch.map(|x| -x)];
            let on_a = contact.act_rolling(&one, rolling, &mut seen[0], &mut rolled[0], 1e-5);
            let on_b = contact.act_rolling(&other, rolling, &mut seen[1], &mut rolled[1], 1e-5);
            // `+ 0.0` turns -0 into 0, which alone differs in its bits.
            let bits = |v: [f64; 3]| v.map(|x| (x + 0.0).to_bits());
            prop_assert_eq!(bits(on_a.force), bits(on_b.force.map(|f| -f)));
            prop_assert_eq!(bits(on_a.moment_on_b), bits(on_b.moment));
            prop_assert_eq!(bits(seen[0].stretch), bits(seen[1].stretch.map(|x| -x)));
            prop_assert_eq!(bits(rolled[0]), bits(rolled[1].map(|x| -x)));
            // x_a x F - x_b x F + M_a + M_b = 0
            let arm = [0, 1, 2].map(|i| a.position[i] - b.position[i]);
            let lever = cross(arm, on_a.force);
            let size = on_a.force.iter().map(|f| f.abs()).fold(0.0, f64::max);
            for (i, lever) in lever.iter().enumerate() {
                let sum = lever + on_a.moment[i] + on_a.moment_on_b[i];
                prop_assert!(sum.abs() <= 1e-14 * size.max(1e-12), "{sum}");
            }
            let friction = on_a.friction.iter().map(|f| f * f).sum::<f64>().sqrt();
            prop_assert!(friction <= 0.4 * on_a.push * (1.0 + 1e-12));
        }
    }

    #[test]
    fn a_turned_contact_is_the_contact_turned(
        x in vector(), u in vector(), w in vector(), angle in 0.0..std::f64::consts::TAU
    ) {
        let (sin, cos) = angle.sin_cos();
        let turn = |v: [f64; 3]| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1], v[2]];
        let law = Contact {
            normal: Linear::new(75.0, 60.0, 0.6, Ending::ZeroForce),
            friction: Some(Friction { coefficient: 0.4 }),
        };
        let still = grain([0.0; 3], [0.0; 3], [0.0; 3], 1e-3);
        let force = |x, u, w| {
            let a = grain(x, u, w, 1e-3);
            Meeting::of(&a, &still).map(|m| law.act(&m, &mut History::default(), 1e-5).force)
        };
        if let (Some(plain), Some(turned)) = (force(x, u, w), force(turn(x), turn(u), turn(w))) {
            let size = plain.iter().map(|f| f.abs()).fold(1e-9, f64::max);
            for (expected, found) in turn(plain).iter().zip(turned) {
                prop_assert!((expected - found).abs() < 1e-10 * size);
            }
        }
    }
}

#[test]
fn a_mindlin_contact_that_is_pressed_while_sheared_makes_no_energy() {
    let glass = Elastic {
        youngs_modulus: 7e10,
        poisson_ratio: 0.2,
    };
    let law = Contact {
        normal: Hertz::new([glass; 2], 1.0, Ending::ZeroForce),
        friction: Some(Friction { coefficient: 10.0 }),
    };
    let mut history = History::default();
    let mut last = 0.0;
    let mut work = 0.0;
    // Closed loops in (overlap, shear), the worst way round: pressed while stretched, released while not.
    for n in 0..4000 {
        let phase = f64::from(n) * std::f64::consts::TAU / 1000.0;
        let overlap = 1e-6 * (1.0 + 0.5 * phase.cos());
        let shear = 2e-7 * phase.sin();
        let a = Grain {
            position: [0.0, 0.0, 1e-3 - overlap],
            velocity: [(shear - last) / 1e-6, 0.0, 0.0],
            spin: [0.0; 3],
            radius: 1e-3,
            mass: 1e-5,
        };
        let meeting = Meeting::at_wall(&a, a.position[2], [0.0, 0.0, 1.0], [0.0; 3]);
        let reply = meeting.map(|m| law.act(&m, &mut history, 1e-6));
        work += reply.map_or(0.0, |r| r.force[0]) * (shear - last);
        last = shear;
    }
    assert!(work <= 0.0, "the contact gave {work} J");
}

#[test]
fn grains_apart_or_on_one_place_have_no_contact() {
    let a = grain([0.0; 3], [0.0; 3], [0.0; 3], 1e-3);
    assert!(Meeting::of(&a, &a).is_none());
    let b = grain([2.0, 0.0, 0.0], [0.0; 3], [0.0; 3], 1e-3);
    assert!(Meeting::of(&a, &b).is_none());
}

#[test]
fn a_grain_leaves_a_body_the_way_it_came_in() {
    let shape: shapes::Shape = half_space();
    let body = shapes::Body::new(&shape, 3);
    let a = grain([0.0, 0.0, 1.5], [0.0, 0.0, -1.0], [0.0; 3], 1e-3);
    let meeting = Meeting::at_body(&a, &body, [0.0; 3]);
    let meeting = meeting.map(|m| (m.normal[2], m.overlap, m.approach));
    assert!(
        meeting.is_some_and(|(n, overlap, approach)| (n - 1.0).abs() < 1e-6
            && (overlap - 0.5e-3).abs() < 1e-9
            && (approach - 1.0).abs() < 1e-9)
    );
}

fn half_space() -> shapes::Shape {
    shapes::Shape::HalfSpace(shapes::shape::HalfSpace {
        name: None,
        point_m: vec![0.0, 0.0, 1e-3],
        normal: vec![0.0, 0.0, 1.0],
    })
}
