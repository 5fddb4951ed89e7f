//! The branch of drops at rest in a uniform field: from the sphere, by the height of the pole, through its limit.

pub use super::balance::{Kind, Place, Shape};

/// Step of the height along the branch, and its end.
const STEP: f64 = 0.02;
const LONGEST: f64 = 2.2;
/// Rounds that find a height.
const BISECTIONS: usize = 60;

/// Even harmonics of the shape beyond the first at least.
pub const FEWEST: usize = 3;
/// The same at most.
pub const MOST: usize = 16;

/// A drop that is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sought {
    /// What it is made of.
    pub kind: Kind,
    /// Even harmonics of its shape beyond the first, from [`FEWEST`] to [`MOST`].
    pub harmonics: usize,
}

/// The branch of drops from the sphere to its limit.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// The drop at the field.
    Rest(Shape),
    /// There is none: the greatest Ca that has one.
    Limit(f64),
    /// Newton's method fails at this height of the pole.
    Lost(f64),
}

/// The drop at rest at `capillary`, stable: on the branch that begins with the sphere.
#[must_use]
pub fn rest(sought: Sought, capillary: f64) -> Found {
    let Sought { kind, harmonics } = sought;
    let mut low = Shape::sphere(harmonics);
    let mut height = 1.0;
    let (mut before, mut last) = ([1.0, 0.0], [1.0, 0.0]);
    while height < LONGEST {
        height += STEP;
        let Some(next) = low.taller(kind, height) else {
            return Found::Lost(height);
        };
        if next.capillary >= capillary {
            return between(kind, &low, next, height, capillary);
        }
        let now = [height, next.capillary];
        if now[1] < last[1] {
            return Found::Limit(summit(before, last, now));
        }
        (before, last, low) = (last, now, next);
    }
    Found::Lost(height)
}

/// The greatest Ca at which a drop is at rest; none where the branch has no limit.
#[must_use]
pub fn limit(sought: Sought) -> Option<f64> {
    match rest(sought, f64::INFINITY) {
        Found::Limit(most) => Some(most),
        _ => None,
    }
}

/// The top of the parabola through three places.
fn summit(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let (u, v) = ((b[1] - a[1]) / (b[0] - a[0]), (c[1] - b[1]) / (c[0] - b[0]));
    let bend = (v - u) / (c[0] - a[0]);
    let top = 0.5 * (a[0] + b[0]) - 0.5 * u / bend;
    a[1] + u * (top - a[0]) + bend * (top - a[0]) * (top - b[0])
}

fn between(kind: Kind, low: &Shape, high: Shape, height: f64, capillary: f64) -> Found {
    let (mut short, mut tall) = (height - STEP, height);
    let mut best = if high.capillary - capillary < capillary - low.capillary {
        high
    } else {
        low.clone()
    };
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (short + tall);
        let Some(next) = low.taller(kind, middle) else {
            return Found::Lost(middle);
        };
        if next.capillary < capillary {
            short = middle;
        } else {
            tall = middle;
        }
        let done = (next.capillary - capillary).abs() <= 1e-12 * capillary;
        best = next;
        if done {
            break;
        }
    }
    Found::Rest(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sought(kind: Kind) -> Sought {
        Sought { kind, harmonics: 8 }
    }

    #[test]
    fn a_little_field_draws_a_drop_out_as_taylor_says() {
        for (kind, factor) in [
            (Kind::Dielectric(2.0), 0.25_f64),
            (Kind::Dielectric(80.0), 79.0 / 82.0),
            (Kind::Dielectric(0.5), -0.2),
            (Kind::Conductor, 1.0),
        ] {
            let Found::Rest(shape) = rest(sought(kind), 1e-3) else {
                panic!("{kind:?} has no drop at rest");
            };
            let wanted = 9.0 / 16.0 * 1e-3 * factor * factor;
            assert!(
                (shape.deformation() / wanted - 1.0).abs() < 5e-3,
                "{kind:?} {}",
                shape.deformation()
            );
        }
    }

    #[test]
    fn limits_are_near_those_of_spheroids() {
        for (kind, spheroids) in [(Kind::Conductor, 0.2102), (Kind::Dielectric(80.0), 0.2404)] {
            let found = limit(sought(kind)).unwrap();
            assert!(
                found > 0.95 * spheroids && found < 1.02 * spheroids,
                "{kind:?} {found}"
            );
            assert!(matches!(rest(sought(kind), 1.01 * found), Found::Limit(_)));
        }
    }

    #[test]
    fn the_limit_converges_with_the_harmonics() {
        let [few, more, most] = [3, 5, 8].map(|harmonics| {
            let kind = Kind::Conductor;
            limit(Sought { kind, harmonics }).unwrap()
        });
        assert!((few - most).abs() < 1e-5 * most && (more - most).abs() < 1e-8 * most);
    }

    #[test]
    fn stress_is_balanced_at_every_place() {
        let kind = Kind::Dielectric(20.0);
        let Found::Rest(shape) = rest(sought(kind), 0.15) else {
            panic!("no drop at rest");
        };
        for p in shape.places(kind) {
            let left = p.curvature - shape.pressure - 0.15 * p.traction;
            assert!(left.abs() < 1e-8, "{left:e} at {}", p.z);
        }
    }
}
