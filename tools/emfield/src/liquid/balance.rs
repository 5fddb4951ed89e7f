//! The balance of normal stress on a drop at rest in a uniform field, without a march.
//!
//! Lengths in R of the sphere, stresses in gamma/R, fields in E0, `Ca = eps E0^2 R/gamma`; the field is along z. With normals
//! out of the drop, of permittivity S times that of the gas, or of a conductor (errata to Matsuzawa 2017, eqs 2.40 and 2.62):
//!
//! ```text
//! kappa = p + Ca/2 (S - 1) (S En^2 + Et^2)   (inside),      kappa = p + Ca/2 En^2   (conductor, outside)
//! ```
//!
//! In prolate coordinates `r = c sqrt((xi^2 - 1) (1 - eta^2)), z = c xi eta` of the spheroid that is as long and as wide as the
//! drop, the surface is `xi(eta) = sum s_l P_l(eta)`, l even, and the potential `-z + sum b_l Q_l(xi) P_l(eta)` outside,
//! `sum a_l P_l(xi) P_l(eta)` inside, l odd, joined by least squares at Gauss's nodes. Newton's method finds s, p and Ca for a given
//! height of the pole, so that the branch is followed through its limit.

use nalgebra::{DMatrix, DVector};

use super::spheroidal::{fitted, legendre, nodes, terms_at};

/// Least ratio of the axes of the spheroid that coordinates follow.
const SLENDER: f64 = 1.05;
/// Rounds of Newton's method.
const ROUNDS: usize = 30;
/// Residual that ends them, and a greater one that is no solution.
const EXACT: f64 = 1e-11;
const SOLVED: f64 = 1e-7;
/// Step of difference quotients.
const NUDGE: f64 = 1e-6;
/// What a drop is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A dielectric of this permittivity over that of the gas.
    Dielectric(f64),
    /// A conductor.
    Conductor,
}

/// A drop at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Half the distance of the foci.
    focus: f64,
    /// s_0, s_2, ...
    series: Vec<f64>,
    /// Pressure inside less that of the gas, in gamma/R.
    pub pressure: f64,
    /// Ca.
    pub capillary: f64,
    /// Largest residual of the balance, in gamma/R.
    pub residual: f64,
}

/// A place on the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Distance from the axis.
    pub r: f64,
    /// Height.
    pub z: f64,
    /// Sum of the principal curvatures.
    pub curvature: f64,
    /// Outward electric traction over Ca.
    pub traction: f64,
}

impl Shape {
    pub(super) fn sphere(harmonics: usize) -> Self {
        let wide = SLENDER.powf(-1.0 / 3.0);
        let focus = wide * (SLENDER * SLENDER - 1.0).sqrt();
        let on = |eta: f64| ((1.0 / focus).powi(2) + 1.0 - eta * eta).sqrt();
        Self {
            focus,
            series: fitted(harmonics, &|eta| [eta, on(eta)]),
            pressure: 2.0,
            capillary: 0.0,
            residual: 0.0,
        }
    }

    /// Half the length and half the width.
    #[must_use]
    pub fn axes(&self) -> [f64; 2] {
        let [pole, ..] = self.coordinate(1.0);
        let [waist, ..] = self.coordinate(0.0);
        [self.focus * pole, self.focus * (waist * waist - 1.0).sqrt()]
    }

    /// D = (a - b)/(a + b).
    #[must_use]
    pub fn deformation(&self) -> f64 {
        let [a, b] = self.axes();
        (a - b) / (a + b)
    }

    /// xi and its derivatives over eta.
    fn coordinate(&self, eta: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (k, s) in self.series.iter().enumerate() {
            let [p, first, second] = legendre(2 * k, eta);
            sum = [sum[0] + s * p, sum[1] + s * first, sum[2] + s * second];
        }
        sum
    }

    /// Distance from the axis, height, curvature, and the integrand of the volume over eta.
    fn curve(&self, eta: f64) -> [f64; 4] {
        let c = self.focus;
        let [xi, first, second] = self.coordinate(eta);
        let (q, dq, ddq) = (
            xi * xi - 1.0,
            2.0 * xi * first,
            2.0 * (first * first + xi * second),
        );
        let w = 1.0 - eta * eta;
        let square = c * c * q * w;
        let slope = c * c * (dq * w - 2.0 * eta * q);
        let bend = c * c * (ddq * w - 4.0 * eta * dq - 2.0 * q);
        let r = square.sqrt();
        let dr = slope / (2.0 * r);
        let ddr = bend / (2.0 * r) - slope * slope / (4.0 * r * r * r);
        let dz = c * (first * eta + xi);
        let ddz = c * (second * eta + 2.0 * first);
        let speed = dr.hypot(dz);
        let curvature = (dr * ddz - dz * ddr) / speed.powi(3) + dz / (r * speed);
        [
            r,
            c * xi * eta,
            curvature,
            std::f64::consts::PI * square * dz,
        ]
    }

    /// Gauss's nodes of the upper half.
    fn upper(&self) -> Vec<(f64, f64)> {
        let all = nodes(self.series.len() - 1).into_iter();
        all.filter(|(eta, _)| *eta > 0.0).collect()
    }

    /// `|grad V| d/dn` of a potential times a factor that depends on the place alone: value, derivatives over xi and eta.
    fn flux(&self, eta: f64, [_, by_xi, by_eta]: [f64; 3]) -> f64 {
        let [xi, rise, _] = self.coordinate(eta);
        (xi * xi - 1.0) * by_xi - (1.0 - eta * eta) * rise * by_eta
    }

    /// The applied potential -z with its derivatives.
    fn applied(&self, eta: f64) -> [f64; 3] {
        let (c, xi) = (self.focus, self.coordinate(eta)[0]);
        [-c * xi * eta, -c * eta, -c * xi]
    }

    /// Slopes of the potential over xi and eta at nodes: inside a dielectric, outside a conductor.
    fn slopes(&self, kind: Kind, nodes: &[f64]) -> Vec<[f64; 3]> {
        let (terms, many) = (self.series.len() + 2, nodes.len());
        let waist = self.coordinate(0.0)[0];
        let sides = if matches!(kind, Kind::Conductor) {
            1
        } else {
            2
        };
        let mut matrix = DMatrix::zeros(sides * many, sides * terms);
        let mut right = DVector::zeros(sides * many);
        let table: Vec<Vec<[[f64; 3]; 2]>> = nodes
            .iter()
            .map(|&eta| terms_at(terms, self.coordinate(eta)[0], waist, eta))
            .collect();
        for (i, &eta) in nodes.iter().enumerate() {
            right[i] = -self.applied(eta)[0];
            for (k, [inner, outer]) in table[i].iter().enumerate() {
                matrix[(i, k)] = outer[0];
                if let Kind::Dielectric(ratio) = kind {
                    matrix[(i, terms + k)] = -inner[0];
                    matrix[(many + i, k)] = self.flux(eta, *outer);
                    matrix[(many + i, terms + k)] = -ratio * self.flux(eta, *inner);
                    right[many + i] = -self.flux(eta, self.applied(eta));
                }
            }
        }
        let found = matrix.svd(true, true).solve(&right, 1e-13);
        let found = found.unwrap_or_else(|_| DVector::zeros(sides * terms));
        let each = nodes.iter().zip(&table).map(|(&eta, table)| {
            let conducts = matches!(kind, Kind::Conductor);
            let mut slope = if conducts {
                self.applied(eta)
            } else {
                [0.0; 3]
            };
            for (k, [inner, outer]) in table.iter().enumerate() {
                let (term, factor) = if conducts {
                    (outer, found[k])
                } else {
                    (inner, found[terms + k])
                };
                for (s, t) in slope.iter_mut().zip(term) {
                    *s += factor * t;
                }
            }
            slope
        });
        each.collect()
    }

    /// Electric traction over Ca at nodes of the upper half.
    fn tractions(&self, kind: Kind, nodes: &[f64]) -> Vec<f64> {
        let slopes = self.slopes(kind, nodes);
        let each = nodes.iter().zip(slopes).map(|(&eta, slope)| {
            let [xi, rise, _] = self.coordinate(eta);
            let scale = self.focus * self.focus * (xi * xi - eta * eta);
            let (q, w) = (xi * xi - 1.0, 1.0 - eta * eta);
            let normal = self.flux(eta, slope).powi(2) / ((q + w * rise * rise) * scale);
            let whole = (q * slope[1] * slope[1] + w * slope[2] * slope[2]) / scale;
            match kind {
                Kind::Conductor => 0.5 * normal,
                Kind::Dielectric(s) => 0.5 * (s - 1.0) * (s * normal + (whole - normal)),
            }
        });
        each.collect()
    }

    /// Places along the surface, from the equator to the pole.
    #[must_use]
    pub fn places(&self, kind: Kind) -> Vec<Place> {
        let nodes = self.upper();
        let etas: Vec<f64> = nodes.iter().map(|n| n.0).collect();
        let tractions = self.tractions(kind, &etas);
        let each = etas.iter().zip(tractions).map(|(&eta, traction)| {
            let [r, z, curvature, _] = self.curve(eta);
            Place {
                r,
                z,
                curvature,
                traction,
            }
        });
        let mut places: Vec<Place> = each.collect();
        places.sort_by(|a, b| a.z.total_cmp(&b.z));
        places
    }

    /// What is not balanced: the stress over each even harmonic, the volume, the height.
    fn lack(&self, kind: Kind, height: f64) -> DVector<f64> {
        let nodes = self.upper();
        let etas: Vec<f64> = nodes.iter().map(|n| n.0).collect();
        let tractions = self.tractions(kind, &etas);
        let many = self.series.len();
        let mut lack = DVector::zeros(many + 2);
        for ((eta, weight), traction) in nodes.iter().zip(tractions) {
            let [_, _, curvature, volume] = self.curve(*eta);
            let stress = curvature - self.pressure - self.capillary * traction;
            for k in 0..many {
                lack[k] += weight * stress * legendre(2 * k, *eta)[0];
            }
            lack[many] += 2.0 * weight * volume;
        }
        lack[many] -= 4.0 / 3.0 * std::f64::consts::PI;
        lack[many + 1] = self.axes()[0] - height;
        lack
    }

    fn moved(&self, by: &DVector<f64>) -> Self {
        let many = self.series.len();
        let mut next = self.clone();
        for (s, d) in next.series.iter_mut().zip(by.iter()) {
            *s += d;
        }
        next.pressure += by[many];
        next.capillary += by[many + 1];
        next
    }

    /// The drop whose pole is at this height.
    pub(super) fn taller(&self, kind: Kind, height: f64) -> Option<Self> {
        let mut now = self.clone();
        for _ in 0..ROUNDS {
            let lack = now.lack(kind, height);
            now.residual = lack.amax();
            if !now.residual.is_finite() {
                return None;
            }
            if now.residual < EXACT {
                break;
            }
            let many = lack.len();
            let mut slopes = DMatrix::zeros(many, many);
            for k in 0..many {
                let mut nudge = DVector::zeros(many);
                nudge[k] = NUDGE;
                let ahead = now.moved(&nudge).lack(kind, height);
                let behind = now.moved(&-nudge).lack(kind, height);
                slopes.set_column(k, &((ahead - behind) / (2.0 * NUDGE)));
            }
            let step = slopes.lu().solve(&-lack)?;
            now = now.moved(&step);
        }
        (now.residual < SOLVED).then(|| now.based())
    }

    /// The same in the coordinates of the spheroid that is as long and as wide.
    fn based(self) -> Self {
        let [a, b] = self.axes();
        if a < SLENDER * b {
            return self;
        }
        let focus = (a * a - b * b).sqrt();
        let place = |eta: f64| {
            let [r, z, ..] = self.curve(eta);
            let (near, far) = (r.hypot(z - focus), r.hypot(z + focus));
            [(far - near) / (2.0 * focus), (far + near) / (2.0 * focus)]
        };
        let series = fitted(self.series.len() - 1, &place);
        Self {
            series,
            focus,
            ..self
        }
    }
}
