//! Bodies in open space: one sphere or cylinder in a uniform field, or two electrodes.
//!
//! - A ball of radius R, n = 3, or a cylinder, n = 2, about c in the field E: beyond it, d being the place from c,
//!   `V = -E.x + chi R^n E.d / |d|^n`, with `chi = (k - 1) / (k + n - 1)` of the ratio k of permittivities, 1 of an
//!   electrode. A ball held at V0 has the charge `4 pi eps R (V0 + E.c)` besides; a cylinder is held at what is there.
//! - Two balls on an axis: images ([`super::pair`]).
//! - Two cylinders with lines of charge about `+-a`: `V = C + K ln(r_2 / r_1)` of the distances from both, which is constant
//!   on the circles with `a / R = sinh(tau)`, `tau = acosh(x / R)`, x being the distance of the middle of the circle from the
//!   point between both lines (Smythe 1950, section 4.13).

use std::f64::consts::{PI, TAU};

use serde_json::Value;

use super::EPS0;
use super::pair::{Pair, Sphere};

/// One ball or cylinder.
#[derive(Debug, Clone, PartialEq)]
pub struct One {
    /// Middle \[m\].
    middle: [f64; 3],
    /// \[m\]
    radius: f64,
    /// Applied \[V/m\].
    field: [f64; 3],
    /// Share of the dipole of an electrode.
    share: f64,
    /// Potential of an electrode over that which is applied in its middle \[V\]; 0 of a dielectric.
    charge: f64,
    /// 3 of a ball, 2 of a cylinder.
    power: i32,
    /// Whether the inside is an electrode.
    metal: bool,
}

/// Two cylinders at potentials, without a charge together.
#[derive(Debug, Clone, PartialEq)]
pub struct Lines {
    /// Places of the lines of charge along x \[m\].
    lines: [f64; 2],
    /// Potential far away \[V\].
    far: f64,
    /// What `ln(r_2 / r_1)` is multiplied with \[V\].
    slope: f64,
    /// Middles along x, radii \[m\] and potentials \[V\].
    bodies: [[f64; 3]; 2],
}

/// A solution.
#[derive(Debug, Clone)]
pub enum Open {
    /// One body.
    One(One),
    /// Two balls on the axis.
    Balls(Pair),
    /// Two cylinders.
    Lines(Lines),
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

impl One {
    fn potential(&self, p: [f64; 3]) -> f64 {
        let d = std::array::from_fn(|k| p[k] - self.middle[k]);
        let r = dot(d, d).sqrt();
        let along = dot(self.field, d);
        let there = -dot(self.field, self.middle);
        if r <= self.radius {
            let inside = if self.metal {
                0.0
            } else {
                along * (1.0 - self.share)
            };
            return there + self.charge - inside;
        }
        let dipole = self.share * (self.radius / r).powi(self.power) * along;
        let charge = if self.power == 3 {
            self.radius / r
        } else {
            1.0
        };
        there + self.charge * charge - along + dipole
    }
}

impl Lines {
    fn of(bodies: [[f64; 3]; 2]) -> Self {
        let [[left, a, v], [right, b, w]] = bodies;
        let apart = right - left;
        // From the left middle to the point between the lines.
        let x = (apart * apart + a * a - b * b) / (2.0 * apart);
        let half = (x * x - a * a).sqrt();
        let taus = [(x / a).acosh(), ((apart - x) / b).acosh()];
        let slope = (v - w) / (taus[0] + taus[1]);
        Self {
            lines: [left + x - half, left + x + half],
            far: v - slope * taus[0],
            slope,
            bodies,
        }
    }

    fn potential(&self, p: [f64; 3]) -> f64 {
        for [middle, radius, potential] in self.bodies {
            if (p[0] - middle).hypot(p[1]) <= radius {
                return potential;
            }
        }
        let [near, far] = self.lines.map(|x| (p[0] - x).hypot(p[1]));
        self.far + self.slope * (far / near).ln()
    }
}

impl Open {
    /// The solution of a scene.
    ///
    /// # Errors
    /// Where it has other bodies.
    pub fn of(scene: &Value) -> Result<Self, String> {
        let bodies = scene["bodies"].as_array().map_or(&[][..], Vec::as_slice);
        let bodies: Vec<Body> = bodies
            .iter()
            .map(Body::read)
            .collect::<Option<_>>()
            .ok_or("bodies are no balls or discs")?;
        let plane = scene["geometry"] == "plane";
        let around = scene.pointer("/surroundings/relative_permittivity");
        let around = around.and_then(Value::as_f64).unwrap_or(1.0);
        match (&bodies[..], plane) {
            ([body], _) => Ok(Self::One(body.alone(scene, around))),
            ([low, high], false) => {
                let pair = [low, high].map(|b| Sphere {
                    z: b.middle[b.middle.len() - 1],
                    radius: b.radius,
                    potential: b.potential.unwrap_or(0.0),
                });
                Pair::of(pair)
                    .map(Self::Balls)
                    .ok_or_else(|| "the balls touch".to_owned())
            }
            ([left, right], true) => {
                Ok(Self::Lines(Lines::of([left, right].map(|b| {
                    [b.middle[0], b.radius, b.potential.unwrap_or(0.0)]
                }))))
            }
            _ => Err(format!(
                "{} bodies have no exact potential here",
                bodies.len()
            )),
        }
    }

    /// Potential at a place in space \[V\].
    #[must_use]
    pub fn potential(&self, p: [f64; 3]) -> f64 {
        match self {
            Self::One(one) => one.potential(p),
            Self::Lines(lines) => lines.potential(p),
            Self::Balls(pair) => {
                let radial = p[0].hypot(p[1]);
                let inside = |s: &&Sphere| radial.hypot(p[2] - s.z) <= s.radius;
                let own = pair.spheres.iter().find(inside);
                own.map_or_else(|| pair.potential(radial, p[2]), |s| s.potential)
            }
        }
    }

    /// Name and value of a total by which it is seen from afar: the charge of electrodes in space, a dipole of others, the
    /// potential far away of two cylinders.
    #[must_use]
    pub fn seen(&self) -> (&'static str, f64) {
        match self {
            Self::One(one) if one.charge != 0.0 && one.power == 3 => {
                ("electric_charge", 4.0 * PI * EPS0 * one.radius * one.charge)
            }
            Self::One(one) => {
                let (name, axis) = if one.power == 3 {
                    ("electric_dipole_z", 2)
                } else {
                    ("electric_dipole_x", 0)
                };
                let turn = if one.power == 3 { 2.0 * TAU } else { TAU };
                let size = one.share * one.radius.powi(one.power);
                (name, turn * EPS0 * size * one.field[axis])
            }
            Self::Balls(pair) => {
                let strength: f64 = pair.images.iter().flatten().map(|c| c.strength).sum();
                ("electric_charge", 4.0 * PI * EPS0 * strength)
            }
            Self::Lines(lines) => {
                // A pair of lines of charges 2 pi eps K and its opposite.
                let arm = lines.lines[0] - lines.lines[1];
                ("electric_dipole_x", TAU * EPS0 * lines.slope * arm)
            }
        }
    }
}

/// What a scene says of a body.
struct Body {
    middle: Vec<f64>,
    radius: f64,
    ratio: f64,
    potential: Option<f64>,
}

impl Body {
    fn read(body: &Value) -> Option<Self> {
        let shape = body["shape"]
            .get("sphere")
            .or_else(|| body["shape"].get("disc"))?;
        let middle = shape["centre_m"].as_array()?;
        Some(Self {
            middle: middle.iter().map(Value::as_f64).collect::<Option<_>>()?,
            radius: shape["radius_m"].as_f64()?,
            ratio: body["relative_permittivity"].as_f64().unwrap_or(1.0),
            potential: body["potential_v"].as_f64(),
        })
    }

    fn alone(&self, scene: &Value, around: f64) -> One {
        let axial = scene["geometry"] == "axisymmetric";
        let raise = |x: &[f64]| match x {
            [x, y, z] => [*x, *y, *z],
            [r, z] if axial => [*r, 0.0, *z],
            [x, y] => [*x, *y, 0.0],
            _ => [0.0; 3],
        };
        let field = scene.pointer("/electrostatics/applied_field_v_m");
        let field: Vec<f64> = field
            .and_then(Value::as_array)
            .into_iter()
            .flatten()
            .filter_map(Value::as_f64)
            .collect();
        let (middle, field) = (raise(&self.middle), raise(&field));
        let power = if scene["geometry"] == "plane" { 2 } else { 3 };
        let k = self.ratio / around;
        let share = (k - 1.0) / (k + f64::from(power) - 1.0);
        let over = |v: f64| v + dot(field, middle);
        One {
            middle,
            radius: self.radius,
            field,
            share: if self.potential.is_some() { 1.0 } else { share },
            charge: self.potential.map_or(0.0, over),
            power,
            metal: self.potential.is_some(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cylinders_are_at_their_potentials() {
        let lines = Lines::of([[-0.7e-3, 1e-3, 3.0], [1.3e-3, 0.5e-3, 1.0]]);
        for [middle, radius, potential] in lines.bodies {
            for angle in [0.1_f64, 1.0, 2.0, 3.0] {
                let r = radius * (1.0 + 1e-12);
                let p = [middle + r * angle.cos(), r * angle.sin(), 0.0];
                assert!((lines.potential(p) - potential).abs() < 1e-9);
            }
        }
        assert!((lines.potential([1e6, 0.0, 0.0]) - lines.far).abs() < 1e-8);
    }

    /// Displacement and potential go on through the surface of a dielectric.
    #[test]
    fn a_dielectric_is_continuous() {
        for power in [2, 3] {
            let k = 80.0;
            let one = One {
                middle: [0.1, 0.2, 0.0],
                radius: 0.5,
                field: [1.0, -2.0, 0.0],
                share: (k - 1.0) / (k + f64::from(power) - 1.0),
                charge: 0.0,
                power,
                metal: false,
            };
            let at = |r: f64| one.potential([0.1 + 0.6 * r, 0.2 + 0.8 * r, 0.0]);
            let step = 1e-6;
            let inner = (at(0.5) - at(0.5 - step)) / step;
            let outer = (at(0.5 + 2.0 * step) - at(0.5 + step)) / step;
            assert!((at(0.5 + step) - at(0.5)).abs() < 1e-5);
            assert!((k * inner - outer).abs() < 1e-4, "{inner} {outer}");
        }
    }
}
