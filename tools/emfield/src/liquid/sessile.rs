//! A drop that stands on a wall: its outline from Young and Laplace's equation, without a march.
//!
//! Lengths in R of the sphere of the same volume, stresses in gamma/R; `Bo = rho g R^2/gamma`. With the depth z below the apex and the
//! angle phi of the outline against the wall, the sum of the curvatures is the pressure, which rises with the depth:
//!
//! ```text
//! dr/dphi = cos phi/k,   dz/dphi = sin phi/k,   k = 2/b + Bo z - sin phi/r,   k = 1/b at the apex
//! ```
//!
//! from 0 to the contact angle, by Runge and Kutta's method of fourth order; the radius b of the apex gives the volume and is found by
//! halving. A drop with `Bo < 0` hangs: its volume then has a greatest value, beyond which none is at rest.

use std::f64::consts::PI;

/// Steps from the apex to the wall.
const STEPS: usize = 2000;
/// The series of the apex, where `sin phi/r` is 0/0, ends where b sqrt(Bo) phi or phi is this.
const SERIES: f64 = 1e-2;
/// Longest step over phi: a wide puddle turns within little of its apex.
const GROWTH: f64 = 0.01;
/// Halvings.
const ROUNDS: usize = 200;
/// Radii of the apex that are tried, over R, and how many of them.
const RADII: [f64; 2] = [1e-2, 1e9];
const TRIED: i32 = 600;

/// A place on the outline, from the apex down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Distance from the axis.
    pub r: f64,
    /// Depth below the apex.
    pub z: f64,
    /// Sum of the principal curvatures.
    pub curvature: f64,
}

/// A drop on a wall.
#[derive(Debug, Clone, PartialEq)]
pub struct Sessile {
    /// Its outline from the apex to the wall.
    pub places: Vec<Place>,
    /// Pressure at the apex less that of the gas.
    pub pressure: f64,
    /// Volume.
    pub volume: f64,
}

impl Sessile {
    /// Height over the wall.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.places.last().map_or(0.0, |p| p.z)
    }

    /// Radius of the wetted disc.
    #[must_use]
    pub fn base(&self) -> f64 {
        self.places.last().map_or(0.0, |p| p.r)
    }

    /// Largest distance from the axis.
    #[must_use]
    pub fn widest(&self) -> f64 {
        self.places.iter().map(|p| p.r).fold(0.0, f64::max)
    }
}

/// The outline whose apex has the radius `b`; none where it turns back before it reaches the wall.
fn outline(b: f64, angle: f64, bond: f64) -> Option<Sessile> {
    let bent = |z: f64| 2.0 / b + bond * z;
    let slope = |phi: f64, [r, z, _]: [f64; 3]| -> Option<[f64; 3]> {
        let k = bent(z) - phi.sin() / r;
        (k > 0.0).then(|| {
            let (sine, cosine) = phi.sin_cos();
            [cosine / k, sine / k, PI * r * r * sine / k]
        })
    };
    // The series to the next order beside the sphere.
    let first = (SERIES / (b * bond.abs().sqrt()).max(1.0)).min(0.5 * angle);
    let (sine, rise) = (first.sin(), 2.0 * (0.5 * first).sin().powi(2));
    let bow = bond * b * b * rise;
    let cap = PI * b.powi(3) * rise * rise * (3.0 - rise) / 3.0;
    let mut state = [
        b * sine * (1.0 - 0.25 * bow),
        b * rise * (1.0 - 0.375 * bow),
        cap,
    ];
    let place = |[r, z, _]: [f64; 3]| Place {
        r,
        z,
        curvature: bent(z),
    };
    let mut places = vec![place([0.0; 3]), place(state)];
    let ahead = |x: [f64; 3], by: f64, d: [f64; 3]| std::array::from_fn(|k| x[k] + by * d[k]);
    let mut phi = first;
    while phi < angle {
        let step = (angle / STEPS as f64).min(GROWTH * phi).min(angle - phi);
        let a = slope(phi, state)?;
        let b = slope(phi + 0.5 * step, ahead(state, 0.5 * step, a))?;
        let c = slope(phi + 0.5 * step, ahead(state, 0.5 * step, b))?;
        let d = slope(phi + step, ahead(state, step, c))?;
        let mean = std::array::from_fn(|m| (a[m] + 2.0 * (b[m] + c[m]) + d[m]) / 6.0);
        state = ahead(state, step, mean);
        places.push(place(state));
        phi += step;
    }
    Some(Sessile {
        places,
        pressure: 2.0 / b,
        volume: state[2],
    })
}

/// What is found of a drop.
#[derive(Debug, Clone, PartialEq)]
pub enum Stood {
    /// The drop at rest.
    Rest(Sessile),
    /// There is none: the greatest volume that hangs.
    Falls(f64),
    /// None is found.
    Lost,
}

/// The drop of the volume of the unit sphere, at a contact angle \[rad\] from 0 to pi.
#[must_use]
pub fn stands(angle: f64, bond: f64) -> Stood {
    let wanted = 4.0 / 3.0 * PI;
    let radius = |k: i32| RADII[0] * (RADII[1] / RADII[0]).powf(f64::from(k) / f64::from(TRIED));
    let (mut below, mut most) = (None, 0.0_f64);
    for k in 0..=TRIED {
        let Some(found) = outline(radius(k), angle, bond) else {
            continue;
        };
        most = most.max(found.volume);
        if found.volume < wanted {
            below = Some(radius(k));
        } else if let Some(low) = below {
            return between([low, radius(k)], angle, bond, wanted);
        }
    }
    if bond < 0.0 {
        Stood::Falls(most)
    } else {
        Stood::Lost
    }
}

fn between(radii: [f64; 2], angle: f64, bond: f64, wanted: f64) -> Stood {
    let [mut low, mut high] = radii;
    let mut best = None;
    for _ in 0..ROUNDS {
        let middle = 0.5 * (low + high);
        let Some(found) = outline(middle, angle, bond) else {
            return Stood::Lost;
        };
        if found.volume < wanted {
            low = middle;
        } else {
            high = middle;
        }
        let done = high - low <= 4.0 * f64::EPSILON * high;
        best = Some(found);
        if done {
            break;
        }
    }
    best.map_or(Stood::Lost, Stood::Rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at_rest(degrees: f64, bond: f64) -> Sessile {
        match stands(degrees.to_radians(), bond) {
            Stood::Rest(found) => found,
            other => panic!("no drop at rest: {other:?}"),
        }
    }

    #[test]
    fn without_weight_a_drop_is_the_cap_of_a_sphere() {
        for degrees in [10.0_f64, 60.0, 90.0, 120.0, 170.0] {
            let found = at_rest(degrees, 0.0);
            let cosine = degrees.to_radians().cos();
            let share = (2.0 + cosine) * (1.0 - cosine).powi(2) / 4.0;
            let radius = share.powf(-1.0 / 3.0);
            assert!((found.height() / (radius * (1.0 - cosine)) - 1.0).abs() < 1e-9);
            assert!((found.base() / (radius * degrees.to_radians().sin()) - 1.0).abs() < 1e-8);
            assert!((found.pressure * radius / 2.0 - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn the_wall_bears_the_weight() {
        for (degrees, bond) in [(60.0_f64, 1.0), (120.0, 1.0), (120.0, 9.0), (60.0, -0.2)] {
            let found = at_rest(degrees, bond);
            let r = found.base();
            let pressed = PI * r * r * (found.pressure + bond * found.height());
            let drawn = 2.0 * PI * r * degrees.to_radians().sin();
            let weight = bond * found.volume;
            assert!(
                (pressed - drawn - weight).abs() < 1e-7 * drawn,
                "{degrees} {bond}"
            );
        }
    }

    #[test]
    fn a_large_drop_is_a_puddle_and_a_heavy_one_falls() {
        // Of a wide puddle 2 sin(theta/2) lengths of the capillary; what its rim bends is of the order of that length over the radius.
        let found = at_rest(60.0, 25.0);
        assert!(
            (found.height() * 5.0 - 1.0).abs() < 0.1,
            "{}",
            found.height()
        );
        assert!(matches!(stands(1.0, -30.0), Stood::Falls(most) if most < 4.0));
    }
}
