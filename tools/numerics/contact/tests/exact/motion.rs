//! Two grains, or one above a wall, moved by leap-frog steps.

use contact::{Contact, Grain, History, Meeting, Normal, Reply};

/// Two grains at rest, a at the origin and b a distance `gap` beyond touching it along x, a moving towards b with `speed`.
pub(crate) fn approaching([a, b]: [(f64, f64); 2], gap: f64, speed: f64) -> [Grain; 2] {
    let grain = |x: f64, u: f64, (radius, mass): (f64, f64)| Grain {
        position: [x, 0.0, 0.0],
        velocity: [u, 0.0, 0.0],
        spin: [0.0; 3],
        radius,
        mass,
    };
    [grain(0.0, speed, a), grain(a.0 + b.0 + gap, 0.0, b)]
}

/// A step: half a kick, a drift, half a kick. Dashpots feel the velocities of the end of the step, as the last force predicts them.
pub(crate) fn advance<N: Normal>(
    grains: &mut [Grain; 2],
    contact: &Contact<N>,
    history: &mut History,
    last: &mut Option<Reply>,
    step: f64,
) {
    let kick = |grains: &mut [Grain; 2], reply: &Option<Reply>| {
        let Some(reply) = reply else { return };
        let [a, b] = grains;
        for i in 0..3 {
            a.velocity[i] += 0.5 * step * reply.force[i] / a.mass;
            b.velocity[i] -= 0.5 * step * reply.force[i] / b.mass;
            a.spin[i] += 0.5 * step * reply.moment[i] / (0.4 * a.mass * a.radius * a.radius);
            b.spin[i] += 0.5 * step * reply.moment_on_b[i] / (0.4 * b.mass * b.radius * b.radius);
        }
    };
    kick(grains, last);
    for grain in grains.iter_mut() {
        for i in 0..3 {
            grain.position[i] += step * grain.velocity[i];
        }
    }
    let mut predicted = *grains;
    kick(&mut predicted, last);
    *last = Meeting::of(&predicted[0], &predicted[1]).map(|m| contact.act(&m, history, step));
    if last.is_none() {
        *history = History::default();
    }
    kick(grains, last);
}
