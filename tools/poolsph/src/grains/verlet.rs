//! A step of velocity Verlet of one grain, with velocities that are led on by a part of the step.

use contact::Grain;
use shapes::frame::Vector;

/// How much of a step velocities are led on, for the rows from a first one on.
pub trait Lead: Fn(usize, &mut [f64]) + Sync {}

impl<F: Fn(usize, &mut [f64]) + Sync> Lead for F {}

/// Turns force and moment of a step into the motion of a grain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Verlet {
    /// dt \[s\].
    pub(super) step: f64,
    /// g \[m/s2\].
    pub(super) gravity: Vector,
    /// I / (m r^2).
    pub(super) inertia_factor: f64,
}

impl Verlet {
    /// x += dt u + dt^2/2 a, u += `lead` dt a. Gives the square of the way \[m2\].
    #[inline(always)]
    pub(super) fn predict(
        &self,
        grain: &mut Grain,
        [force, moment]: [&Vector; 2],
        lead: f64,
    ) -> f64 {
        let (step, inverse) = (self.step, 1.0 / grain.mass);
        let turns = lead * step * inverse / (self.inertia_factor * grain.radius * grain.radius);
        let mut square = 0.0;
        for k in 0..3 {
            let gained = step * (force[k] * inverse + self.gravity[k]);
            let way = step * (grain.velocity[k] + 0.5 * gained);
            grain.position[k] += way;
            grain.velocity[k] += lead * gained;
            grain.spin[k] += turns * moment[k];
            square += way * way;
        }
        square
    }

    /// u += dt (a'/2 + (1/2 - `lead`) a).
    #[inline(always)]
    pub(super) fn correct(
        &self,
        grain: &mut Grain,
        now: [&Vector; 2],
        before: [&Vector; 2],
        lead: f64,
    ) {
        let (half, back) = (0.5 * self.step / grain.mass, 2.0 * lead - 1.0);
        let turns = half / (self.inertia_factor * grain.radius * grain.radius);
        let fall = 0.5 * self.step * (1.0 - back);
        for k in 0..3 {
            grain.velocity[k] += half * (now[0][k] - back * before[0][k]) + fall * self.gravity[k];
            grain.spin[k] += turns * (now[1][k] - back * before[1][k]);
        }
    }
}
