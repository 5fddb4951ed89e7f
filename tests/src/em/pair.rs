//! Two conducting spheres at given potentials.
//!
//! A charge of potential V in the middle of one sphere, its image in the other, the image of that in the first, and so on
//! leave the first sphere at V and the second at zero (Maxwell 1873, arts. 172 to 174; Smythe 1950, section 5.08): of a
//! charge `q` at the distance `s` from the middle of a sphere of radius `b` the image is `-q b / s`, `b^2 / s` from the
//! middle. Both spheres together are the sum of two such rows.

use std::f64::consts::PI;

use super::EPS0;

/// Images are as small as this part of the first charge when no more are taken.
const LEAST: f64 = 1e-15;

/// A charge on the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Charge {
    /// Place on the axis \[m\].
    pub z: f64,
    /// Potential times distance \[V m\]: the charge over `4 pi eps`.
    pub strength: f64,
}

/// A sphere on the axis, a conductor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Place of its middle on the axis \[m\].
    pub z: f64,
    /// Radius \[m\].
    pub radius: f64,
    /// Potential \[V\].
    pub potential: f64,
}

impl Sphere {
    /// The image of a charge outside.
    fn image(&self, of: Charge) -> Charge {
        let away = of.z - self.z;
        Charge {
            z: self.z + self.radius * self.radius / away,
            strength: -of.strength * self.radius / away.abs(),
        }
    }
}

/// Two spheres and their images, in empty space.
#[derive(Debug, Clone)]
pub struct Pair {
    /// The spheres, the lower one first.
    pub spheres: [Sphere; 2],
    /// Images within each, from the middle on.
    pub images: [Vec<Charge>; 2],
}

impl Pair {
    /// The pair; none where the spheres touch.
    #[must_use]
    pub fn of(spheres: [Sphere; 2]) -> Option<Self> {
        let [low, high] = spheres;
        if high.z - high.radius <= low.z + low.radius {
            return None;
        }
        let mut images = [Vec::new(), Vec::new()];
        for first in 0..2 {
            let own = spheres[first];
            let (mut at, mut last) = (
                first,
                Charge {
                    z: own.z,
                    strength: own.potential * own.radius,
                },
            );
            let least = LEAST * last.strength.abs();
            while last.strength.abs() > least {
                images[at].push(last);
                at = 1 - at;
                last = spheres[at].image(last);
            }
        }
        Some(Self { spheres, images })
    }

    /// Halfway between the spheres on the axis \[m\].
    #[must_use]
    pub fn middle(&self) -> f64 {
        let [low, high] = self.spheres;
        0.5 * (low.z + low.radius + high.z - high.radius)
    }

    fn charges(&self) -> impl Iterator<Item = &Charge> {
        self.images.iter().flatten()
    }

    /// Potential outside \[V\], at a distance from the axis and a place along it \[m\].
    #[must_use]
    pub fn potential(&self, radial: f64, z: f64) -> f64 {
        let part = |c: &Charge| c.strength / radial.hypot(z - c.z);
        self.charges().map(part).sum()
    }

    /// Field outside along the axis \[V/m\].
    #[must_use]
    pub fn field(&self, radial: f64, z: f64) -> f64 {
        let part = |c: &Charge| c.strength * (z - c.z) / radial.hypot(z - c.z).powi(3);
        self.charges().map(part).sum()
    }

    /// Force on the upper sphere along the axis \[N\]: that of all charges of the one on all of the other.
    #[must_use]
    pub fn force(&self) -> f64 {
        let [low, high] = &self.images;
        let pull = |c: &Charge| -> f64 {
            let each = |other: &Charge| other.strength / (c.z - other.z).powi(2);
            c.strength * low.iter().map(each).sum::<f64>()
        };
        4.0 * PI * EPS0 * high.iter().map(pull).sum::<f64>()
    }

    /// The potential as a formula, `square` being that of the distance from the axis: of each sphere the `count` greatest
    /// images, and the rest, which crowd together, as one.
    #[must_use]
    pub fn formula(&self, square: &str, count: usize) -> String {
        let term = |c: Charge| format!("{:e}/({square} + (z - {:e})^2)^0.5", c.strength, c.z);
        let terms = self.images.iter().flat_map(|images| {
            let mut images = images.clone();
            images.sort_by(|a, b| b.strength.abs().total_cmp(&a.strength.abs()));
            let rest = images.split_off(count.min(images.len()));
            images.extend(together(&rest));
            images
        });
        terms.map(term).collect::<Vec<_>>().join(" + ")
    }
}

/// Charges as one in their middle.
fn together(charges: &[Charge]) -> Option<Charge> {
    let strength: f64 = charges.iter().map(|c| c.strength).sum();
    let moment: f64 = charges.iter().map(|c| c.strength * c.z).sum();
    (strength != 0.0).then(|| Charge {
        z: moment / strength,
        strength,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat::formula::At;
    use crate::heat::property::Property;
    use serde_json::json;

    fn pair(gap: f64) -> Pair {
        let low = Sphere {
            z: -1.0,
            radius: 1.0,
            potential: 3.0,
        };
        let high = Sphere {
            z: 0.5 + gap,
            radius: 0.5,
            potential: -0.5,
        };
        Pair::of([low, high]).unwrap()
    }

    #[test]
    fn surfaces_have_the_potentials_of_their_spheres() {
        for gap in [1.0, 0.1, 0.01, 1e-3] {
            let pair = pair(gap);
            for sphere in pair.spheres {
                for angle in [0.0, 0.1, 1.0, 2.0, 3.0] {
                    let (sine, cosine) = f64::sin_cos(angle);
                    let at = (sphere.radius * sine, sphere.z + sphere.radius * cosine);
                    let found = pair.potential(at.0, at.1);
                    assert!((found - sphere.potential).abs() < 1e-10, "{gap} {found}");
                }
            }
        }
        assert!(Pair::of(pair(0.1).spheres.map(|s| Sphere { z: 0.0, ..s })).is_none());
    }

    /// The force is the slope of the energy at fixed potentials, `F = d(sum Q V)/ds / 2`.
    #[test]
    fn the_force_is_the_slope_of_the_energy() {
        let energy = |gap: f64| {
            let pair = pair(gap);
            let of = |k: usize| -> f64 {
                let all = pair.images[k].iter().map(|c| c.strength);
                all.sum::<f64>() * pair.spheres[k].potential
            };
            2.0 * PI * EPS0 * (of(0) + of(1))
        };
        for gap in [1.0, 0.05, 0.01] {
            let step = 1e-5 * gap;
            let slope = (energy(gap + step) - energy(gap - step)) / (2.0 * step);
            assert!((pair(gap).force() / slope - 1.0).abs() < 1e-5, "{gap}");
        }
    }

    #[test]
    fn the_field_is_minus_the_slope_of_the_potential() {
        let pair = pair(0.02);
        for (r, z) in [(0.0, 0.01), (0.1, 0.02), (2.0, -1.0)] {
            let slope = (pair.potential(r, z - 1e-6) - pair.potential(r, z + 1e-6)) / 2e-6;
            assert!((slope / pair.field(r, z) - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn the_formula_is_the_potential_away_from_the_spheres() {
        let pair = pair(0.01);
        let formula = pair.formula("(x^2 + y^2)", 40);
        let read = Property::read(&json!({"expr": formula})).unwrap();
        for place in [[3.0_f64, 0.0, 0.0], [0.0, -2.0, 2.5], [1.0, 1.0, -3.0]] {
            let exact = pair.potential(place[0].hypot(place[1]), place[2]);
            let found = read.value(&At::place(place));
            assert!((found / exact - 1.0).abs() < 1e-5, "{found} {exact}");
        }
    }
}
