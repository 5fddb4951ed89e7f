//! How long a step may be now, and when there is none any more.

use contact::Grain;
use steps::Limit;

use super::law::Law;
use super::metal::Metal;
use super::motion::Motion;
use crate::stage::StageError;
use crate::state::State;

impl Motion {
    /// The longest step \[s\] and what bounds it.
    pub(super) fn limit(&self) -> Limit {
        let (setting, doing) = (&self.setting, self.doing);
        let rests = self.metal.as_ref().is_none_or(Metal::rests);
        let (mass, radius) = (0.5 * setting.lightest, 0.5 * setting.radii[0]);
        let (seconds, name) = match &self.law {
            // What grains that are held do to each other moves nothing, and without friction no contact has a history.
            _ if self.moving.all_driven() && self.friction.is_none() && rests => {
                setting.far(doing.fastest)
            }
            Law::Linear(law) => setting.limit(law, doing, |_| [0.0, law.duration(mass)]),
            Law::Hertz(law) => setting.limit(law, doing, |speed| {
                let speed = speed.max(f64::MIN_POSITIVE);
                let duration = law.elastic_duration(mass, radius, speed);
                [law.deepest(mass, radius, speed), duration]
            }),
        };
        Limit::dividing(name, seconds)
    }

    /// The next step of `left` \[s\]: an equal part of it that the limit allows.
    pub(super) fn part(&self, left: f64) -> f64 {
        let parts = (left / self.limit().seconds - 1e-9).ceil().max(1.0);
        left / parts
    }

    /// The error of grains whose speed is no number.
    pub(super) fn diverged(&self, state: &State) -> Option<StageError> {
        self.doing.fastest.is_nan().then(|| {
            let bad = |g: &Grain| !(g.velocity[0] + g.velocity[1] + g.velocity[2]).is_finite();
            let row = self.moving.grains.iter().position(bad).unwrap_or(0);
            StageError::Diverged {
                step: state.step,
                particle: row,
                place: self.moving.grains[row].position,
                quantity: "speed of a grain",
                value: f64::NAN,
                limit: self.setting.radii[0] / self.limit().seconds,
                unit: "m/s",
            }
        })
    }
}
