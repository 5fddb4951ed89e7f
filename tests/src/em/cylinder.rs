//! An infinite conducting cylinder in an axial alternating field.

use std::f64::consts::PI;

use super::bessel::{ratio_i, scaled_i};
use super::{C, MU0};

/// The cylinder. Phasors go as `exp(j w t)`.
#[derive(Debug, Clone, Copy)]
pub struct Cylinder {
    /// Radius \[m\].
    pub radius: f64,
    /// Conductivity \[S/m\].
    pub conductivity: f64,
    /// Relative permeability.
    pub permeability: f64,
    /// Frequency \[Hz\].
    pub frequency: f64,
    /// Axial field at the surface \[A/m\].
    pub field: f64,
}

impl Cylinder {
    /// `sqrt(j w sigma mu)` \[1/m\].
    #[must_use]
    pub fn wave_number(&self) -> C {
        let w = 2.0 * PI * self.frequency;
        C::new(0.0, w * self.conductivity * self.permeability * MU0).sqrt()
    }

    /// Skin depth \[m\].
    #[must_use]
    pub fn skin_depth(&self) -> f64 {
        1.0 / self.wave_number().re
    }

    /// Axial field at the radius r \[A/m\], Matsuzawa (2017), eq. 3.12.
    #[must_use]
    pub fn magnetic(&self, r: f64) -> C {
        let k = self.wave_number();
        self.field * ratio_i((0, k * r), (0, k * self.radius))
    }

    /// Current density around the axis \[A/m2\], `-dH/dr`.
    #[must_use]
    pub fn current(&self, r: f64) -> C {
        let k = self.wave_number();
        -self.field * k * ratio_i((1, k * r), (0, k * self.radius))
    }

    /// Joule heat per length \[W/m\] if `field` is an rms value, half of it if a peak value: what
    /// Poynting's vector carries in.
    #[must_use]
    pub fn power(&self) -> f64 {
        let z = self.wave_number() * self.radius;
        let slope = self.wave_number() * scaled_i(1, z) / scaled_i(0, z);
        2.0 * PI * self.radius * self.field * self.field * slope.re / self.conductivity
    }
}

/// A cylinder around a core of another conductivity, by integration from the axis outwards:
/// `H'' + H'/r = j w mu sigma H`, with `H` and `H'/sigma`, the electric field, continuous.
#[derive(Debug, Clone)]
pub struct Cored {
    /// The cylinder, with the field at its surface.
    pub cylinder: Cylinder,
    /// Radius of the core \[m\].
    pub radius: f64,
    /// Conductivity of the core \[S/m\].
    pub conductivity: f64,
    /// Relative permeability of the core.
    pub permeability: f64,
}

/// Field and slope at a radius.
#[derive(Debug, Clone, Copy)]
struct Node {
    r: f64,
    field: C,
    slope: C,
}

impl Cored {
    /// Steps of the integration in the core, and around it.
    const STEPS: usize = 4000;

    /// Where the square of the wave number is `square`, by Runge and Kutta's fourth order.
    fn outward(mut at: Node, end: f64, square: C, nodes: &mut Vec<Node>) -> Node {
        let h = (end - at.r) / Self::STEPS as f64;
        // Beside the axis H'/r is H''.
        let bend = |r: f64, field: C, slope: C| {
            if r > 0.0 {
                square * field - slope / r
            } else {
                0.5 * square * field
            }
        };
        nodes.push(at);
        for _ in 0..Self::STEPS {
            let Node { r, field, slope } = at;
            let half = 0.5 * h;
            let a = (slope, bend(r, field, slope));
            let (f, g) = (field + half * a.0, slope + half * a.1);
            let b = (g, bend(r + half, f, g));
            let (f, g) = (field + half * b.0, slope + half * b.1);
            let c = (g, bend(r + half, f, g));
            let (f, g) = (field + h * c.0, slope + h * c.1);
            let d = (g, bend(r + h, f, g));
            at = Node {
                r: r + h,
                field: field + h / 6.0 * (a.0 + 2.0 * (b.0 + c.0) + d.0),
                slope: slope + h / 6.0 * (a.1 + 2.0 * (b.1 + c.1) + d.1),
            };
            nodes.push(at);
        }
        at
    }

    /// Field \[A/m\] at each of the radii, and the heat per length as [`Cylinder::power`] has it \[W/m\].
    #[must_use]
    pub fn solve(&self, radii: &[f64]) -> (Vec<C>, f64) {
        let outer = &self.cylinder;
        let core = Cylinder {
            conductivity: self.conductivity,
            permeability: self.permeability,
            ..*outer
        };
        let axis = Node {
            r: 0.0,
            field: C::new(1.0, 0.0),
            slope: C::new(0.0, 0.0),
        };
        let mut nodes = Vec::new();
        let mut face = Self::outward(axis, self.radius, core.wave_number().powu(2), &mut nodes);
        face.slope *= outer.conductivity / self.conductivity;
        let end = Self::outward(face, outer.radius, outer.wave_number().powu(2), &mut nodes);
        let scale = outer.field / end.field;
        let field = |r: &f64| {
            let next = nodes
                .partition_point(|n| n.r < *r)
                .clamp(1, nodes.len() - 1);
            let (a, b) = (nodes[next - 1], nodes[next]);
            let h = b.r - a.r;
            let t = if h > 0.0 { (r - a.r) / h } else { 1.0 };
            let u = 1.0 - t;
            let ends = a.field * (u * u * (1.0 + 2.0 * t)) + b.field * (t * t * (1.0 + 2.0 * u));
            scale * (ends + (a.slope * u - b.slope * t) * (h * t * u))
        };
        let flow = (scale * end.slope * outer.field).re / outer.conductivity;
        let power = 2.0 * PI * outer.radius * flow;
        (radii.iter().map(field).collect(), power)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_core_like_its_shell_changes_nothing() {
        let cylinder = paper(60.0);
        let cored = Cored {
            cylinder,
            radius: 0.04,
            conductivity: cylinder.conductivity,
            permeability: 1.0,
        };
        let radii = [0.0, 0.02, 0.04, 0.0733, 0.1];
        let (found, power) = cored.solve(&radii);
        for (r, found) in radii.iter().zip(found) {
            assert!((found - cylinder.magnetic(*r)).norm() < 1e-9, "{r}");
        }
        assert!((power / cylinder.power() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_core_that_hardly_conducts_holds_the_field_of_its_surface() {
        let cored = Cored {
            cylinder: paper(60.0),
            radius: 0.05,
            conductivity: 1.0,
            permeability: 1.0,
        };
        // The flux through the hole drives the current around it: 2 pi a E = -j w mu H pi a^2.
        let (found, _) = cored.solve(&[0.0, 0.03, 0.05]);
        assert!((found[0] - found[2]).norm() < 1e-5);
        assert!((found[0] - C::new(-0.117_83, -0.078_06)).norm() < 1e-4);
    }

    fn paper(frequency: f64) -> Cylinder {
        Cylinder {
            radius: 0.1,
            conductivity: 7.7e6,
            permeability: 1.0,
            frequency,
            field: 1.0,
        }
    }

    #[test]
    fn the_field_diffuses() {
        // 1/r d/dr (r dH/dr) = j w sigma mu H.
        let c = paper(60.0);
        let k = c.wave_number();
        for r in [0.02, 0.07, 0.095] {
            let h = 1e-4;
            let [a, b, d] = [c.magnetic(r - h), c.magnetic(r), c.magnetic(r + h)];
            let laplacian = (a + d - 2.0 * b) / (h * h) + (d - a) / (2.0 * h * r);
            assert!((laplacian - k * k * b).norm() < 1e-4 * (k * k * b).norm());
        }
        assert!((c.magnetic(0.1) - 1.0).norm() < 1e-14);
    }

    #[test]
    fn heat_within_is_what_flows_in() {
        for frequency in [1.0, 60.0, 400.0, 1e4] {
            let c = paper(frequency);
            let count = 20_000;
            let mut sum = 0.0;
            for k in 0..count {
                let r = 0.1 * (f64::from(k) + 0.5) / f64::from(count);
                sum += c.current(r).norm_sqr() * r;
            }
            let heat = sum * 2.0 * PI * 0.1 / f64::from(count) / c.conductivity;
            assert!((heat / c.power() - 1.0).abs() < 1e-4, "{frequency}");
        }
    }

    #[test]
    fn no_frequency_is_too_high() {
        let c = paper(1e9);
        assert!(c.magnetic(0.05).norm() == 0.0);
        assert!((c.magnetic(0.1 - c.skin_depth()).norm() - (-1.0_f64).exp()).abs() < 1e-4);
    }
}
