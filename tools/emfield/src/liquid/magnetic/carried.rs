//! What a field is at points of the liquid, from what it is at its own.
//!
//! The mean force density of currents is `f = Re(J x B*) = T - grad p_m`: of the magnetic pressure `p_m = |B|^2/(2 mu0)` and of the
//! pull along field lines `T = Re((B*.grad) B)/mu0`. Of the pull, too, all that lifts and bends acts as a pressure: `T = g - grad phi`,
//! where g stirs alone ([`super::super::stirred`]). On the surface both are a traction, however thin the skin is,
//!
//! ```text
//! t_n = -(p_m + phi),      - surface int (p_m + phi) dh/dn dS = int f . grad h dV
//! ```
//!
//! for every harmonic h, by Green's identity: phi is the sum of spherical harmonics that obeys this for the solid ones of its degrees,
//! with integrals over the points of the field, which resolve the skin. Its mean is free.

use nalgebra::{DMatrix, DVector};
use neighbours::Tree;
use num_complex::Complex;
use rayon::prelude::*;
use run::Failure;

use super::mould::within;
use crate::liquid::air::Place;
use crate::liquid::effort::failed;
use crate::liquid::matter::Way;
use crate::liquid::outline::{Outline, harmonics};
use crate::liquid::renew::valued;
use crate::liquid::surface::tangents;
use crate::liquid::vector::{along, difference, direction, dot, length};
use crate::magnetic::source::MU0;
use crate::stencils::region::Region;
use crate::stencils::sides::Sides;

type C = Complex<f64>;

/// Degree of the fit of values on the surface, and the radius of its support over the spacing.
const DEGREE: i32 = 4;
const RADIUS: f64 = 3.4;
/// A support grows by this factor, so often at most, until it has twice as many points as the fit has terms.
const GROWTH: f64 = 1.2;
const GROWTHS: usize = 12;

/// Highest degree of phi.
const HIGHEST: usize = 8;
/// Step of difference quotients of solid harmonics over the radius.
const STEP: f64 = 1e-4;

/// What acts on the liquid.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Act {
    /// Magnetic pressure, by point \[Pa\].
    pub pressure: Vec<f64>,
    /// What of the pull is a pressure, on points of the surface \[Pa\].
    pub phi: Vec<f64>,
    /// The pull along field lines, by point \[N/m3\].
    pub pull: Vec<[f64; 3]>,
    /// Power of currents, by point \[W\]; nothing where it is not asked for.
    pub heat: Vec<f64>,
}

/// A flux density on points, with slopes inside the ball.
pub(super) struct Flux<'a> {
    pub(super) region: &'a Region<3>,
    pub(super) sides: &'a Sides<3>,
    pub(super) flux: &'a [[C; 3]],
    /// Mean force density \[N/m3\], and what each point stands for \[m3\].
    pub(super) force: (&'a [[f64; 3]], &'a [f64]),
    /// Heat of currents \[W/m3\]; none where it is not asked for.
    pub(super) heat: Option<&'a [f64]>,
    /// The drop.
    pub(super) outline: &'a Outline,
    /// `j w mu sigma` of the ball: B obeys `lap B = j w mu sigma B`.
    pub(super) rate: C,
}

/// Magnetic pressure and pull at a point, with the slopes of the pressure.
#[derive(Debug, Clone, Copy, Default)]
struct Local {
    pressure: f64,
    slope: [f64; 3],
    pull: [f64; 3],
}

impl Flux<'_> {
    fn at(&self, i: usize) -> Local {
        let on = self.region.on_interface(i);
        let rows = if on {
            &self.sides.inner
        } else {
            &self.sides.own
        };
        let b = self.flux[i];
        // By component and axis.
        let slopes: [[C; 3]; 3] = std::array::from_fn(|k| {
            std::array::from_fn(|axis| {
                let row = rows.derivative(i, axis);
                let share: f64 = row.conditions().sum();
                let known = if on {
                    self.rate * b[k] * share
                } else {
                    C::default()
                };
                row.apply_with(|j| self.flux[j][k]) + known
            })
        });
        let over = |value: f64| value / MU0;
        Local {
            pressure: over(0.5 * b.iter().map(C::norm_sqr).sum::<f64>()),
            slope: std::array::from_fn(|axis| {
                over((0..3).map(|k| (b[k].conj() * slopes[k][axis]).re).sum())
            }),
            pull: std::array::from_fn(|k| {
                over(
                    (0..3)
                        .map(|axis| (b[axis].conj() * slopes[k][axis]).re)
                        .sum(),
                )
            }),
        }
    }

    /// What acts on a liquid whose points are here.
    ///
    /// # Errors
    /// Where the heat of its points has no fit.
    pub(super) fn act(&self, place: Place<'_>) -> Result<Act, Failure> {
        let [on, inside] = within(self.region);
        let mut local = vec![Local::default(); self.region.len()];
        let all: Vec<usize> = on.iter().chain(&inside).copied().collect();
        let found: Vec<Local> = all.par_iter().map(|i| self.at(*i)).collect();
        for (i, found) in all.iter().zip(found) {
            local[*i] = found;
        }
        let skin = Skin::new(self.region, &on);
        let carried: Vec<[f64; 4]> = (0..place.skin.place.len())
            .into_par_iter()
            .map(|s| {
                let weights = skin.weights(&place.skin.place[s], &place.skin.normal[s]);
                weights.iter().fold([0.0; 4], |sum, (i, w)| {
                    let Local { pressure, pull, .. } = local[*i];
                    along(&sum, *w, &[pressure, pull[0], pull[1], pull[2]])
                })
            })
            .collect();
        let deep = self.deep(&inside, &local, place.inside);
        let both = carried.iter().chain(&deep);
        let terms = self.phi(&all, &skin, &local);
        let phi = |x: &[f64; 3]| -> f64 {
            let n = direction(&difference(x, &self.outline.origin));
            let values = harmonics(self.degree(), &n);
            terms.iter().zip(&values[1..]).map(|(c, y)| c * y).sum()
        };
        Ok(Act {
            phi: place.skin.place.iter().map(phi).collect(),
            pressure: both.clone().map(|c| c[0]).collect(),
            pull: both.map(|c| [c[1], c[2], c[3]]).collect(),
            heat: match self.heat {
                Some(heat) => self.warms(&all, heat, place)?,
                None => Vec::new(),
            },
        })
    }

    /// Power of points of the liquid \[W\]: that of the points of the field, which resolve the skin, goes to those about them by
    /// the weights of linear fits. So its sum stays, and so does its depth: a surface point does not take it all.
    fn warms(&self, all: &[usize], heat: &[f64], place: Place<'_>) -> Result<Vec<f64>, Failure> {
        let points = [place.skin.place, place.inside].concat();
        let stand: Vec<[f64; 3]> = all.iter().map(|i| self.region.places[*i]).collect();
        let way = Way {
            spacing: place.skin.spacing,
            order: 1,
            tolerance: 0.0,
            products: 0,
        };
        let rows = valued(&points, &stand, &way).map_err(|e| failed(&e))?;
        let (_, volumes) = self.force;
        let mut power = vec![0.0; points.len()];
        for (k, &i) in all.iter().enumerate() {
            for (j, weight) in rows.value(k).iter() {
                power[j] += weight * heat[i] * volumes[i];
            }
        }
        Ok(power)
    }

    fn degree(&self) -> usize {
        self.outline.degree.min(HIGHEST)
    }

    /// Gradients of the solid harmonics `q^l Y_lm` from l = 1 on, q over the radius of the drop, at a place \[1/m\].
    fn gradients(&self, x: &[f64; 3], radius: f64) -> Vec<[f64; 3]> {
        let degree = self.degree();
        let solid = |x: &[f64; 3]| {
            let way = difference(x, &self.outline.origin).map(|c| c / radius);
            let q = length(&way);
            let mut values = harmonics(degree, &direction(&way));
            for (k, y) in values.iter_mut().enumerate() {
                *y *= q.powi(k.isqrt() as i32);
            }
            values
        };
        let slopes = [0, 1, 2].map(|k| {
            let [ahead, behind] = [STEP, -STEP].map(|step| {
                let mut moved = *x;
                moved[k] += step * radius;
                solid(&moved)
            });
            let both = ahead.iter().zip(&behind);
            let slope = both.map(|(a, b)| (a - b) / (2.0 * STEP * radius));
            slope.collect::<Vec<f64>>()
        });
        let each = 1..(degree + 1) * (degree + 1);
        each.map(|k| [slopes[0][k], slopes[1][k], slopes[2][k]])
            .collect()
    }

    /// Coefficients of phi from degree 1 on.
    fn phi(&self, all: &[usize], skin: &Skin, local: &[Local]) -> Vec<f64> {
        let (force, weights) = self.force;
        let outline = self.outline;
        let radius = (0.75 * outline.volume().0 / std::f64::consts::PI).cbrt();
        let many = (self.degree() + 1) * (self.degree() + 1) - 1;
        let works: Vec<Vec<f64>> = (all.par_iter())
            .map(|i| {
                let slopes = self.gradients(&self.region.places[*i], radius);
                let work = |s: &[f64; 3]| weights[*i] * dot(&force[*i], s);
                slopes.iter().map(work).collect()
            })
            .collect();
        let mut right = DVector::zeros(many);
        for work in &works {
            right -= DVector::from_column_slice(work);
        }
        let nodes: Vec<(Vec<f64>, Vec<f64>, f64)> = (outline.nodes().par_iter())
            .map(|node| {
                let (n, r) = (&node.direction, outline.radius(&node.direction));
                let (x, normal) = (along(&outline.origin, r, n), outline.normal(n));
                let area = node.weight * r * r / dot(&normal, n);
                let slopes = self.gradients(&x, radius);
                let out = slopes.iter().map(|s| area * dot(s, &normal)).collect();
                let near = skin.weights(&x, &normal);
                let pressure = near.iter().map(|(i, w)| w * local[*i].pressure).sum();
                (out, harmonics(self.degree(), n)[1..].to_vec(), pressure)
            })
            .collect();
        let mut matrix = DMatrix::zeros(many, many);
        for (out, values, pressure) in &nodes {
            let out = DVector::from_column_slice(out);
            right -= *pressure * &out;
            matrix += &out * DVector::from_column_slice(values).transpose();
        }
        let found = matrix.lu().solve(&right);
        found.map_or_else(|| vec![0.0; many], |c| c.as_slice().to_vec())
    }

    /// Pressure and pull at places inside, linear about the nearest point of the field.
    fn deep(&self, inside: &[usize], local: &[Local], places: &[[f64; 3]]) -> Vec<[f64; 4]> {
        let stand: Vec<[f64; 3]> = inside.iter().map(|i| self.region.places[*i]).collect();
        let tree = Tree::new(&stand);
        let each = places.par_iter().map(|x| {
            let Some(i) = tree.nearest(*x).map(|k| inside[k]) else {
                return [0.0; 4];
            };
            let way = difference(x, &self.region.places[i]);
            let near = &local[i];
            let pull = |k: usize| {
                let slope = |axis| {
                    let row = self.sides.own.derivative(i, axis);
                    row.apply_with(|j| local[j].pull[k])
                };
                near.pull[k] + dot(&[0, 1, 2].map(slope), &way)
            };
            let pressure = near.pressure + dot(&near.slope, &way);
            [pressure, pull(0), pull(1), pull(2)]
        });
        each.collect()
    }
}

/// Points on the surface of the ball, ready to be fitted to.
struct Skin {
    points: Vec<usize>,
    places: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    spacing: f64,
    tree: Tree,
}

impl Skin {
    fn new(region: &Region<3>, on: &[usize]) -> Self {
        let places: Vec<[f64; 3]> = on.iter().map(|i| region.places[*i]).collect();
        let spacing = on.iter().map(|i| region.metrics[*i].spacing());
        Self {
            tree: Tree::new(&places),
            spacing: spacing.fold(0.0, f64::max),
            points: on.to_vec(),
            normals: region.faces.iter().map(|f| f.normal).collect(),
            places,
        }
    }

    /// Weights of points for the value at a place of the surface: a quartic along it by weighted least squares.
    fn weights(&self, x: &[f64; 3], normal: &[f64; 3]) -> Vec<(usize, f64)> {
        let terms = ((DEGREE + 1) * (DEGREE + 2) / 2) as usize;
        let mut radius = RADIUS * self.spacing;
        let mut near = Vec::new();
        for _ in 0..GROWTHS {
            near.clear();
            self.tree.within(*x, radius, |j, _| {
                if dot(normal, &self.normals[j]) > 0.0 {
                    near.push(j);
                }
            });
            if near.len() >= 2 * terms {
                break;
            }
            radius *= GROWTH;
        }
        near.sort_unstable();
        let axes = tangents(normal);
        let mut basis = DMatrix::<f64>::zeros(terms, near.len());
        let mut weighted = basis.clone();
        for (m, j) in near.iter().enumerate() {
            let away = difference(&self.places[*j], x);
            let [u, v] = axes.map(|axis| dot(&away, &axis) / radius);
            let share = wls::quartic(length(&away) / radius).max(1e-12);
            let powers = (0..=DEGREE).flat_map(|n| (0..=n).map(move |q| (n - q, q)));
            for (k, (p, q)) in powers.enumerate() {
                basis[(k, m)] = u.powi(p) * v.powi(q);
                weighted[(k, m)] = share * basis[(k, m)];
            }
        }
        let gram = &weighted * basis.transpose();
        let mut one = DVector::zeros(terms);
        one[0] = 1.0;
        let solved = gram.clone().cholesky().map(|c| c.solve(&one));
        let solved = solved.or_else(|| gram.pseudo_inverse(1e-12).ok().map(|g| g * &one));
        let Some(coefficients) = solved else {
            return Vec::new();
        };
        let values = weighted.tr_mul(&coefficients);
        let points = near.iter().map(|j| self.points[*j]);
        points.zip(values.iter().copied()).collect()
    }
}
