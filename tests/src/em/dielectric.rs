//! A dielectric sphere in a uniform electrostatic field.

use super::EPS0;

/// A sphere of relative permittivity `ratio` in what was a field along z.
#[derive(Debug, Clone, Copy)]
pub struct Sphere {
    /// Radius \[m\].
    pub radius: f64,
    /// Permittivity inside over that outside.
    pub ratio: f64,
    /// Relative permittivity outside.
    pub around: f64,
    /// The far field along z \[V/m\]; negative where the potential rises with z.
    pub field: f64,
    /// Potential in the plane z = 0 \[V\].
    pub middle: f64,
}

impl Sphere {
    /// `(S - 1) / (S + 2)`.
    fn moment(&self) -> f64 {
        (self.ratio - 1.0) / (self.ratio + 2.0)
    }

    /// Is the place inside?
    #[must_use]
    pub fn holds(&self, p: [f64; 3]) -> bool {
        length(p) <= self.radius
    }

    /// Potential \[V\], Matsuzawa (2017), eqs 3.3 (with its sign put right, so that it joins 3.4) and
    /// 3.4, about the middle.
    #[must_use]
    pub fn potential(&self, p: [f64; 3]) -> f64 {
        if self.holds(p) {
            return self.middle - 3.0 / (self.ratio + 2.0) * self.field * p[2];
        }
        let cube = (self.radius / length(p)).powi(3);
        self.middle - self.field * p[2] * (1.0 - self.moment() * cube)
    }

    /// Field inside \[V/m\], eqs 3.9 to 3.11.
    #[must_use]
    pub fn inside(&self) -> [f64; 3] {
        [0.0, 0.0, 3.0 / (self.ratio + 2.0) * self.field]
    }

    /// Field outside \[V/m\], eqs 3.6 to 3.8.
    #[must_use]
    pub fn outside(&self, p: [f64; 3]) -> [f64; 3] {
        let r = length(p);
        let dipole = self.moment() * (self.radius / r).powi(3) * self.field;
        let share = |axis: usize| 3.0 * p[axis] * p[2] / (r * r);
        [
            dipole * share(0),
            dipole * share(1),
            self.field + dipole * (share(2) - 1.0),
        ]
    }

    /// Field \[V/m\]; on the surface that inside.
    #[must_use]
    pub fn electric(&self, p: [f64; 3]) -> [f64; 3] {
        if self.holds(p) {
            self.inside()
        } else {
            self.outside(p)
        }
    }

    /// Traction along the outward normal of the surface \[Pa\] at the polar angle whose cosine is
    /// given: `eps (S-1)/2 (S En^2 + Et^2)` with the field inside. Eq. 2.62 has the part of the
    /// normal field of a conductor alone.
    #[must_use]
    pub fn traction(&self, cosine: f64) -> f64 {
        let e = self.inside()[2];
        let normal = (e * cosine).powi(2);
        let tangential = e * e * (1.0 - cosine * cosine);
        0.5 * EPS0 * self.around * (self.ratio - 1.0) * (self.ratio * normal + tangential)
    }
}

fn length(p: [f64; 3]) -> f64 {
    p.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sphere(ratio: f64) -> Sphere {
        Sphere {
            radius: 2.0,
            ratio,
            around: 1.0,
            field: -5.0,
            middle: 7.0,
        }
    }

    #[test]
    fn the_potential_is_continuous_and_so_is_the_displacement() {
        for ratio in [0.1, 2.0, 80.0, 1e6] {
            let s = sphere(ratio);
            let n = [0.48, 0.6, 0.64];
            let at = |r: f64| n.map(|x| x * r);
            let jump = s.potential(at(2.0 * (1.0 - 1e-12))) - s.potential(at(2.0 * (1.0 + 1e-12)));
            assert!(jump.abs() < 1e-9, "{jump}");
            let dot = |e: [f64; 3]| e[0] * n[0] + e[1] * n[1] + e[2] * n[2];
            let [a, b] = [ratio * dot(s.inside()), dot(s.outside(at(2.0)))];
            assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
        }
    }

    #[test]
    fn the_field_is_minus_the_slope_of_the_potential() {
        let s = sphere(80.0);
        for p in [[1.7, -1.1, 2.3], [0.3, 0.4, -0.2]] {
            for axis in 0..3 {
                let h = 1e-5;
                let [mut a, mut b] = [p, p];
                a[axis] -= h;
                b[axis] += h;
                let slope = (s.potential(a) - s.potential(b)) / (2.0 * h);
                assert!((slope - s.electric(p)[axis]).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn the_traction_is_the_jump_of_the_stress_of_maxwell() {
        let s = sphere(80.0);
        let p = [1.2, 0.0, 1.6];
        let n = p.map(|x| x / 2.0);
        let stress = |eps: f64, e: [f64; 3]| {
            let normal: f64 = (0..3).map(|k| e[k] * n[k]).sum();
            let square: f64 = e.iter().map(|x| x * x).sum();
            eps * (normal * normal - 0.5 * square)
        };
        let jump = stress(EPS0, s.outside(p)) - stress(80.0 * EPS0, s.inside());
        assert!((s.traction(0.8) / jump - 1.0).abs() < 1e-12);
    }
}
