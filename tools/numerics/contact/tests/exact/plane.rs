//! A sphere on a plane: it slides and rolls, sticks on a slope, is sheared to and fro.

use contact::{Contact, Ending, Friction, Grain, History, Linear, Meeting, Rolling};

const GRAVITY: f64 = 9.81;
const RADIUS: f64 = 1e-3;
const MASS: f64 = 1e-5;

/// A sphere on a plane of this slope, z out of the plane, x down the slope.
struct Plane {
    grain: Grain,
    contact: Contact<Linear>,
    rolling: Option<Rolling>,
    inertia_factor: f64,
    tangent: f64,
    history: History,
    rolled: [f64; 3],
    acceleration: [[f64; 3]; 2],
}

impl Plane {
    fn new(friction: f64, tangent: f64, inertia_factor: f64) -> Self {
        let stiffness = 1e4;
        // It rests on its spring.
        let sunk = MASS * GRAVITY / stiffness / tangent.hypot(1.0);
        let mut plane = Self {
            grain: Grain {
                position: [0.0, 0.0, RADIUS - sunk],
                velocity: [0.0; 3],
                spin: [0.0; 3],
                radius: RADIUS,
                mass: MASS,
            },
            contact: Contact {
                normal: Linear::new(stiffness, 0.8 * stiffness, 0.3, Ending::ZeroForce),
                friction: Some(Friction {
                    coefficient: friction,
                }),
            },
            rolling: None,
            inertia_factor,
            tangent,
            history: History::default(),
            rolled: [0.0; 3],
            acceleration: [[0.0; 3]; 2],
        };
        plane.feel(0.0);
        plane
    }

    fn feel(&mut self, step: f64) {
        let weight = GRAVITY / self.tangent.hypot(1.0);
        let mut linear = [self.tangent * weight, 0.0, -weight];
        let mut turning = [0.0; 3];
        let grain = &self.grain;
        if let Some(meeting) = Meeting::at_wall(grain, grain.position[2], [0.0, 0.0, 1.0], [0.0; 3])
        {
            let reply = match self.rolling {
                Some(rolling) => self.contact.act_rolling(
                    &meeting,
                    rolling,
                    &mut self.history,
                    &mut self.rolled,
                    step,
                ),
                None => self.contact.act(&meeting, &mut self.history, step),
            };
            let inertia = self.inertia_factor * MASS * RADIUS * RADIUS;
            for i in 0..3 {
                linear[i] += reply.force[i] / MASS;
                turning[i] = reply.moment[i] / inertia;
            }
        }
        self.acceleration = [linear, turning];
    }

    fn kick(&mut self, step: f64) {
        for i in 0..3 {
            self.grain.velocity[i] += 0.5 * step * self.acceleration[0][i];
            self.grain.spin[i] += 0.5 * step * self.acceleration[1][i];
        }
    }

    fn advance(&mut self, step: f64) {
        self.kick(step);
        for i in 0..3 {
            self.grain.position[i] += step * self.grain.velocity[i];
        }
        self.feel(step);
        self.kick(step);
    }

    /// Time and speed at which the surface no longer slips.
    fn until_it_rolls(&mut self, step: f64) -> [f64; 2] {
        for n in 1..1_000_000 {
            self.advance(step);
            let slip = self.grain.velocity[0] - self.grain.position[2] * self.grain.spin[1];
            if slip.abs() < 1e-3 * self.grain.velocity[0].abs() {
                return [f64::from(n) * step, self.grain.velocity[0]];
            }
        }
        panic!("it slides for ever");
    }
}

const STEP: f64 = 1e-6;

#[test]
fn a_sliding_sphere_rolls_in_the_end() {
    for (c, v, mu) in [(0.4, 0.1, 0.3), (0.5, 0.1, 0.3), (0.4, 0.02, 0.05)] {
        let mut plane = Plane::new(mu, 0.0, c);
        plane.grain.velocity[0] = v;
        let [time, speed] = plane.until_it_rolls(STEP);
        let exact = v / (mu * GRAVITY * (1.0 + 1.0 / c));
        assert!((time / exact - 1.0).abs() < 0.01, "{time} {exact}");
        let rolling = v / (1.0 + c);
        assert!((speed / rolling - 1.0).abs() < 0.005, "{speed} {rolling}");
    }
}

#[test]
fn back_spin_turns_a_sphere_back() {
    let mut plane = Plane::new(0.3, 0.0, 0.4);
    plane.grain.velocity[0] = 0.05;
    plane.grain.spin[1] = -0.3 / RADIUS;
    let [_, speed] = plane.until_it_rolls(STEP);
    // v' = (v - c r |w|) / (1 + c), r w = -0.3 m/s: about the line of contact nothing turns it.
    let exact = (0.05 - 0.4 * 0.3) / 1.4;
    assert!((speed / exact - 1.0).abs() < 0.005, "{speed} {exact}");
}

#[test]
fn a_sphere_rolls_down_a_slope_without_slip_up_to_three_and_a_half_times_the_friction() {
    let fall = |tangent: f64, mu: f64| {
        let mut plane = Plane::new(mu, tangent, 0.4);
        for _ in 0..50_000 {
            plane.advance(STEP);
        }
        plane.grain.velocity[0] / 0.05
    };
    let along = |tangent: f64| GRAVITY * tangent / tangent.hypot(1.0);
    let rolls = fall(0.5, 0.2);
    assert!((rolls / (along(0.5) * 5.0 / 7.0) - 1.0).abs() < 0.01);
    let slips = fall(0.9, 0.2);
    let exact = along(0.9) - 0.2 * GRAVITY / 0.9_f64.hypot(1.0);
    assert!((slips / exact - 1.0).abs() < 0.01, "{slips} {exact}");
    // Just below and beyond tan = 3.5 mu.
    let below = fall(0.69, 0.2) / (along(0.69) * 5.0 / 7.0);
    let beyond = fall(0.72, 0.2) / (along(0.72) * 5.0 / 7.0);
    assert!(
        (below - 1.0).abs() < 0.01 && beyond > 1.01,
        "{below} {beyond}"
    );
}

#[test]
fn what_resists_rolling_rests_on_a_slope_and_does_not_creep() {
    let gone = |tangent: f64| {
        let mut plane = Plane::new(0.6, tangent, 0.4);
        plane.rolling = Some(Rolling {
            coefficient: 0.2,
            stiffness_ratio: 1.0,
        });
        for _ in 0..400_000 {
            plane.advance(STEP);
        }
        let settled = plane.grain.position[0];
        for _ in 0..100_000 {
            plane.advance(STEP);
        }
        (plane.grain.position[0] - settled) / RADIUS
    };
    assert!(gone(0.19).abs() < 1e-6, "{}", gone(0.19));
    assert!(gone(0.21) > 1e-2, "{}", gone(0.21));
}

#[test]
fn reversing_shear_below_sliding_closes_its_loop() {
    let contact = Contact {
        normal: Linear::new(1e4, 8e3, 1.0, Ending::ZeroForce),
        friction: Some(Friction { coefficient: 0.5 }),
    };
    let (mut history, mut work, mut greatest) = (History::default(), 0.0, 0.0_f64);
    let (step, amplitude) = (1e-4, 1e-6);
    let mut grain = Grain {
        position: [0.0, 0.0, 0.99 * RADIUS],
        velocity: [0.0; 3],
        spin: [0.0; 3],
        radius: RADIUS,
        mass: MASS,
    };
    let mut forces = [0.0; 2];
    for n in 0..2000 {
        let phase = |n: f64| amplitude * (std::f64::consts::TAU * n / 1000.0).sin();
        let moved = phase(f64::from(n) + 1.0) - phase(f64::from(n));
        grain.velocity[0] = moved / step;
        let meeting =
            Meeting::at_wall(&grain, grain.position[2], [0.0, 0.0, 1.0], [0.0; 3]).unwrap();
        let reply = contact.act(&meeting, &mut history, step);
        work -= reply.force[0] * moved;
        greatest = greatest.max(reply.force[0].abs());
        if n == 999 || n == 1999 {
            forces[usize::from(n == 1999)] = reply.force[0];
        }
    }
    assert!((greatest - 8e3 * amplitude).abs() < 0.01 * greatest);
    assert!((forces[0] - forces[1]).abs() < 1e-9 * greatest);
    assert!(work.abs() < 0.02 * greatest * amplitude, "{work}");
}

#[test]
fn sliding_shear_takes_the_work_of_friction() {
    let contact = Contact {
        normal: Linear::new(1e4, 8e3, 1.0, Ending::ZeroForce),
        friction: Some(Friction { coefficient: 0.5 }),
    };
    let push = 1e4 * 0.01 * RADIUS;
    let (mut history, mut work) = (History::default(), 0.0);
    let mut grain = Grain {
        position: [0.0, 0.0, 0.99 * RADIUS],
        velocity: [0.0; 3],
        spin: [0.0; 3],
        radius: RADIUS,
        mass: MASS,
    };
    // To and fro by 20 um: the spring gives way after mu N / k_t, twice that on reversal.
    let (travel, step) = (2e-5, 1e-4);
    for part in 0..8 {
        let direction = if part % 2 == 0 { 1.0 } else { -1.0 };
        for _ in 0..500 {
            let moved = direction * travel / 500.0;
            grain.velocity[0] = moved / step;
            let meeting =
                Meeting::at_wall(&grain, grain.position[2], [0.0, 0.0, 1.0], [0.0; 3]).unwrap();
            let reply = contact.act(&meeting, &mut history, step);
            if part >= 2 {
                work -= reply.force[0] * moved;
            }
        }
    }
    let stretch = 0.5 * push / 8e3;
    let exact = 6.0 * 0.5 * push * (travel - 2.0 * stretch);
    assert!((work / exact - 1.0).abs() < 0.02, "{work} {exact}");
}
