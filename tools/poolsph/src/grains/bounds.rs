//! How long a step may be.
//!
//! A contact of stiffness k and damping eta between grains of the masses m_a and m_b is one of n_a and of n_b contacts. Given
//! an equal part of the mass of each grain, it swings by itself, and no mode of all grains is faster than the fastest of these
//! (Irons and Treharne 1971). Verlet steps whose dashpots see velocities that are led on by a part l of the step are stable where
//!
//! ```text
//! h^2 k + 4 l h eta <= 4 / q,    q = n_a/m_a + n_b/m_b        along the normal: 2/omega without damping
//! h^2 k_t + 4 l h eta_t <= 4 / (q (1 + 1/c))                   across it, where the springs also turn the grains
//! ```
//!
//! The force of the last step leads the velocity of a grain with one contact on to the end of the step, l = 1: impacts are of second
//! order. In a crowd, where that force is not the contact's own and dampers add up, it is left in the middle of the step, l = 1/2.
//!
//! c is the inertia factor I / (m r^2). Where the springs lie all around, both are far too careful: a turn stretches no spring at its poles. A
//! grain among neighbours that stand still feels `k s/m`, where s is the greatest eigenvalue of
//!
//! ```text
//! | n I                     sum [n]x / sqrt(c)      |      sums over its contacts, of unit normals n
//! | sum [n]x^T / sqrt(c)    (n I - sum n n^T) / c   |      s <= (n + r)/2 + sqrt(((n - r)/2)^2 + |sum n|^2 / c)
//! ```
//!
//! and r is the greatest eigenvalue of the last block. Give a contact the share `b^T b / s` of the matrix of masses, b being what its springs
//! feel of the grain: then the shares of a grain add up to less than the whole, and no mode is faster than `q = s_a/m_a + s_b/m_b` of the
//! worst contact says, with the greater of k and k_t. The longer of both bounds holds. With eta = 2 zeta sqrt(m k) both are `h = 2 g / sqrt(k)`, where the [`Slack`] g is known from
//! the masses and the numbers of contacts alone.

use contact::{Meeting, Normal};

use super::parameters::Parameters;

/// Part of the stable step that is taken.
const PART: f64 = 0.8;
/// Grains move by at most this part of the least radius in a step.
const FAR: f64 = 0.1;

/// Least values of g \[kg^1/2\] of all contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slack {
    /// Along the normal.
    pub normal: f64,
    /// Across it.
    pub tangential: f64,
    /// Of both together, by how the contacts lie; zero where that is not known.
    pub joint: f64,
}

/// What a grain bears: numbers over its mass \[1/kg\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Load {
    /// n / m.
    pub number: f64,
    /// s / m.
    pub joint: f64,
}

impl std::ops::Add for Load {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            number: self.number + other.number,
            joint: self.joint + other.joint,
        }
    }
}

impl Slack {
    /// Of a contact of effective `mass` \[kg\] whose grains bear `load` together; `zeta` is its share of critical damping times l.
    #[inline]
    #[must_use]
    pub fn of(mass: f64, load: Load, zeta: f64, inertia_factor: f64) -> Self {
        let damped = 4.0 * zeta * zeta * mass;
        let g = |load: f64| {
            let root = (damped + 1.0 / load).sqrt();
            // root - sqrt(damped) without loss of digits
            1.0 / (load * (root + damped.sqrt()))
        };
        Self {
            normal: g(load.number),
            tangential: g(load.number * (1.0 + 1.0 / inertia_factor)),
            joint: g(load.joint),
        }
    }

    /// The lesser of two.
    #[inline]
    #[must_use]
    pub fn least(self, other: Self) -> Self {
        Self {
            normal: self.normal.min(other.normal),
            tangential: self.tangential.min(other.tangential),
            joint: self.joint.min(other.joint),
        }
    }
}

/// What bounds a step besides the contacts themselves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Mass of the lightest grain \[kg\].
    pub lightest: f64,
    /// That of every grain, if it is the same \[kg\].
    pub alike: Option<f64>,
    /// Radii of the smallest and the largest grain \[m\].
    pub radii: [f64; 2],
    /// I / (m r^2).
    pub inertia_factor: f64,
    /// Whether contacts rub.
    pub rubs: bool,
    /// Steps in the duration of a contact, at least.
    pub steps_per_contact: f64,
}

/// What the grains are doing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Doing {
    /// Of all contacts.
    pub slack: Slack,
    /// Greatest overlap \[m\].
    pub deepest: f64,
    /// Greatest speed \[m/s\].
    pub fastest: f64,
}

impl Setting {
    /// Of grains of these masses \[kg\] and radii \[m\].
    #[must_use]
    pub fn of(scene: &Parameters, masses: &[f64], radii: &[f64]) -> Self {
        let least = |column: &[f64]| column.iter().copied().fold(f64::INFINITY, f64::min);
        Self {
            lightest: least(masses),
            alike: masses
                .first()
                .copied()
                .filter(|first| masses.iter().all(|mass| mass.to_bits() == first.to_bits())),
            radii: [least(radii), radii.iter().copied().fold(0.0, f64::max)],
            inertia_factor: scene.inertia_factor,
            rubs: scene.contact.friction.is_some(),
            steps_per_contact: scene.steps_per_contact,
        }
    }

    /// The slack of two of the lightest grains that touch nothing else.
    #[must_use]
    pub fn pair(&self, zeta: f64) -> Slack {
        let m = self.lightest;
        // One contact: n = 1, |sum n| = 1, r = 1/c.
        let load = Load {
            number: 2.0 / m,
            joint: 2.0 * (1.0 + 1.0 / self.inertia_factor) / m,
        };
        Slack::of(0.5 * m, load, zeta, self.inertia_factor)
    }

    /// The step \[s\] in which grains do not go too far at the speed `fastest` \[m/s\]: all that bounds grains that are driven.
    #[must_use]
    pub fn far(&self, fastest: f64) -> (f64, &'static str) {
        let seconds = FAR * self.radii[0] / fastest.max(f64::MIN_POSITIVE);
        (seconds, "grain_speed")
    }

    /// The longest step \[s\] and what bounds it. `elastic` gives overlap and duration of an elastic impact of two of the lightest
    /// grains at a speed \[m/s\].
    #[must_use]
    pub fn limit<N: Normal>(
        &self,
        law: &N,
        doing: Doing,
        elastic: impl Fn(f64) -> [f64; 2],
    ) -> (f64, &'static str) {
        let [deep, duration] = elastic(doing.fastest);
        let meeting = Meeting {
            normal: [1.0, 0.0, 0.0],
            overlap: doing.deepest.max(deep).max(f64::MIN_POSITIVE),
            arms: [self.radii[1]; 2],
            approach: 0.0,
            slide: [0.0; 3],
            turn: [0.0; 3],
            swing: [0.0; 3],
            mass: 0.5 * self.lightest,
            radius: self.radii[1],
        };
        let stable = |g: f64, k: f64| PART * 2.0 * g / k.sqrt();
        let tangential = if self.rubs {
            stable(doing.slack.tangential, law.tangential(&meeting))
        } else {
            f64::INFINITY
        };
        let normal = stable(doing.slack.normal, law.stiffness(&meeting));
        let stiffest = law.stiffness(&meeting).max(law.tangential(&meeting));
        let joint = stable(doing.slack.joint, stiffest);
        let bounds = [
            (normal.max(joint), "grain_normal"),
            (tangential.max(joint), "grain_tangential"),
            (duration / self.steps_per_contact, "grain_contact"),
            self.far(doing.fastest),
        ];
        bounds
            .into_iter()
            .fold((f64::INFINITY, "grain_speed"), |least, bound| {
                if bound.0 < least.0 { bound } else { least }
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a swing of `zeta` grows at steps of `h` over the natural frequency 1, velocities led on by `lead`.
    fn grows(zeta: f64, h: f64, lead: f64) -> bool {
        let (mut x, mut u, mut a) = (1.0_f64, 0.3, -1.0 - 0.6 * zeta);
        for _ in 0..4000 {
            x += h * u + 0.5 * h * h * a;
            let new = -x - 2.0 * zeta * (u + lead * h * a);
            u += 0.5 * h * (new + a);
            a = new;
        }
        // Where nothing grows, nothing is larger than the start by orders.
        let bounded = x.abs() + u.abs() < 10.0;
        !bounded
    }

    #[test]
    fn a_damped_swing_is_stable_up_to_its_bound_and_not_beyond() {
        for (zeta, lead) in [0.0, 0.05, 0.3, 0.7, 1.0, 3.0]
            .map(|zeta| [(zeta, 1.0), (zeta, 0.5)])
            .concat()
        {
            // Masses of 2 make an effective mass of 1, load 1.
            let load = Load {
                number: 1.0,
                joint: 1.0,
            };
            let g = Slack::of(1.0, load, lead * zeta, 0.4).normal;
            assert!(
                !grows(zeta, 0.999 * 2.0 * g, lead),
                "zeta {zeta}, lead {lead}"
            );
            assert!(
                grows(zeta, 1.01 * 2.0 * g, lead),
                "zeta {zeta}, lead {lead}"
            );
        }
    }

    #[test]
    fn bounds_of_flux_are_those_of_the_source() {
        // k = 75 N/m, d = 0.5 mm, 3230 kg/m3: 75 us and 40 us for a pair, 22 and 12 us with 12 contacts.
        let m = 3230.0 * std::f64::consts::PI / 6.0 * 0.5e-3_f64.powi(3);
        let bound = |n: f64| {
            let load = Load {
                number: 2.0 * n / m,
                joint: 0.0,
            };
            let slack = Slack::of(0.5 * m, load, 0.0, 0.4);
            [slack.normal, slack.tangential].map(|g| 2e6 * g / 75.0_f64.sqrt())
        };
        let close =
            |found: [f64; 2], told: [f64; 2]| (0..2).all(|k| (found[k] - told[k]).abs() < 0.6);
        assert!(close(bound(1.0), [75.0, 40.0]), "{:?}", bound(1.0));
        assert!(close(bound(12.0), [21.7, 11.6]), "{:?}", bound(12.0));
    }
}
