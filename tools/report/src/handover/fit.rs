//! The double ellipsoid whose heat, by conduction alone, warms the metal around the pool of a weld as the weld does.
//!
//! Its four half axes are those of the least squares of
//!
//! ```text
//! r_k = (T_0 + P g(x_k, t_k) - T_k)/(T_m - T_0)
//! ```
//!
//! over the solid metal around the pool that is not far below its melting point. g is exact in a plate of constant properties
//! (`torch::Plate`): means of the metal's own from the start up to the melting point. The heat of melting goes along with a pool that
//! moves, and counts for nothing. Solved by Levenberg and Marquardt (1963) in the logarithms of the half axes.

use artefact::Reader;
use run::Failure;
use run::property::Property;
use serde::Deserialize;
use torch::{DoubleEllipsoid, Plate, Shape};

use super::pool::Pool;
use crate::mirror::Mirror;
use crate::weld::Weld;

/// Part of the rise to the melting point above which solid metal is near the pool.
pub(super) const NEAR: f64 = 0.6;
/// Particles of a frame that are compared, and frames.
const SAMPLES: usize = 120;
pub(super) const FRAMES: usize = 3;
/// Half axes are sought within this factor of the reach of the pool.
const WITHIN: f64 = 20.0;
/// Places of the mean of a property over temperature.
const PLACES: u32 = 64;
/// Rounds of the search, and the change of the logarithms that ends it.
const ROUNDS: u32 = 60;
const MET: f64 = 1e-5;
/// Greatest change of the logarithm of a half axis in a round, and that of its difference quotient.
const STRIDE: f64 = 0.5;
const NUDGE: f64 = 1e-3;
/// Root mean square of r above which it is told.
const TOLD: f64 = 0.05;

/// The plate of a weld as heat is conducted in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Metal {
    plate: Plate,
    /// Temperature of the start, and melting point \[K\].
    pub(super) start_k: f64,
    pub(super) melts_k: f64,
}

/// What the scene of a weld says of its metal.
#[derive(Deserialize)]
struct Told {
    density_kg_m3: f64,
    heat: Heat,
}

#[derive(Deserialize)]
struct Heat {
    thermal_conductivity_w_m_k: Property,
    specific_heat_j_kg_k: Property,
    #[serde(default)]
    faces: Faces,
}

#[derive(Default, Deserialize)]
struct Faces {
    #[serde(default)]
    open: Vec<String>,
}

impl Metal {
    /// That of a weld, from its first frame; the path starts at `start`.
    pub(super) fn of(reader: &Reader, first: &Weld, start: [f64; 2]) -> Result<Self, Failure> {
        let scene = &reader.header().scene;
        let told =
            Told::deserialize(scene).map_err(|_| unknown("density and heat of its metal"))?;
        let hot = first.temperature.as_deref().filter(|t| !t.is_empty());
        let hot = hot.ok_or_else(|| unknown("temperatures"))?;
        let start_k = hot.iter().sum::<f64>() / hot.len() as f64;
        let melts_k = first.plate.melting_point_k;
        let melts_k = melts_k.ok_or_else(|| unknown("melting point"))?;
        let mean = |property: &Property, key: &str| {
            let curve = property.compile(&format!("/heat/{key}"), &["T"]);
            let curve = curve.map_err(|_| unknown(key))?;
            let at =
                |k: u32| start_k + (melts_k - start_k) * (f64::from(k) + 0.5) / f64::from(PLACES);
            let sum: Result<f64, _> = (0..PLACES).map(|k| curve.at_temperature(at(k))).sum();
            sum.map(|sum| sum / f64::from(PLACES))
                .map_err(|_| unknown(key))
        };
        let conductivity = mean(
            &told.heat.thermal_conductivity_w_m_k,
            "thermal_conductivity_w_m_k",
        )?;
        let heat = mean(&told.heat.specific_heat_j_kg_k, "specific_heat_j_kg_k")?;
        let closed = |face: &str| !told.heat.faces.open.iter().any(|open| open == face);
        let plate = Plate {
            conductivity_w_m_k: conductivity,
            capacity_j_m3_k: told.density_kg_m3 * heat,
            ends_m: ends(first, start, Mirror::read(reader)?.is_some(), &closed),
            thickness_m: first.plate.thickness().filter(|_| closed("z-")),
        };
        Ok(Self {
            plate,
            start_k,
            melts_k,
        })
    }

    /// In words.
    pub(super) fn words(&self) -> String {
        format!(
            "{:.1} W/(m K) and {:.3e} J/(m3 K), means from {:.0} to {:.0} K",
            self.plate.conductivity_w_m_k, self.plate.capacity_j_m3_k, self.start_k, self.melts_k
        )
    }
}

fn unknown(what: &str) -> Failure {
    Failure::Usage(format!(
        "no heat source can be fitted: the file tells no {what}. With --melt the half axes are those of the pool itself"
    ))
}

/// Closed faces of the plate along the weld and across it, from the start on; a weld that is turned in its scene has none.
fn ends(
    weld: &Weld,
    start: [f64; 2],
    half: bool,
    closed: &dyn Fn(&str) -> bool,
) -> [[Option<f64>; 2]; 2] {
    let (Some(low), Some(high)) = (weld.plate.min_m, weld.plate.max_m) else {
        return [[None; 2]; 2];
    };
    if !weld.way.is_y() {
        return [[None; 2]; 2];
    }
    let at = |face: &str, place: f64| Some(place).filter(|_| closed(face));
    let along = [at("y-", low[1] - start[1]), at("y+", high[1] - start[1])];
    // The side behind the mirror is the image of the other one.
    let far = if half { ["x+", "x+"] } else { ["x-", "x+"] };
    [
        along,
        [
            at(far[0], low[0] - start[0]),
            at(far[1], high[0] - start[0]),
        ],
    ]
}

/// Metal near the pool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    /// Ahead of the start of the source, across its path and below the surface \[m\].
    place: [f64; 3],
    /// Since the start \[s\].
    seconds: f64,
    kelvin: f64,
}

/// The solid metal of a frame near the pool; the source started at `start`, `seconds` ago.
pub(super) fn samples(weld: &Weld, metal: &Metal, start: [f64; 2], seconds: f64) -> Vec<Sample> {
    let Some(temperature) = &weld.temperature else {
        return Vec::new();
    };
    let least = metal.start_k + NEAR * (metal.melts_k - metal.start_k);
    let near = |a: &usize| {
        let solid = !weld.liquid[*a] && weld.belongs(*a) && weld.position[*a][2] < 0.0;
        solid && (least..metal.melts_k).contains(&temperature[*a])
    };
    let all: Vec<usize> = (0..weld.position.len()).filter(near).collect();
    let (across, along) = (weld.way.across(start), weld.way.along(start));
    let some = all.iter().step_by(all.len().div_ceil(SAMPLES).max(1));
    some.map(|a| {
        let [x, y, z] = weld.position[*a];
        Sample {
            place: [y - along, x - across, -z],
            seconds,
            kelvin: temperature[*a],
        }
    })
    .collect()
}

/// A source on its way in a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Going {
    pub(super) metal: Metal,
    pub(super) power_w: f64,
    pub(super) speed_m_s: f64,
}

impl Going {
    /// The half axes of the least squares, from those of the pool, and the root mean square that is left.
    pub(super) fn fit(&self, pool: Pool, samples: &[Sample]) -> (Pool, f64) {
        let start = pool.reaches().map(f64::ln);
        let misfit = |log: &[f64; 4]| self.misfit(samples, log);
        let (mut log, mut own, mut damping) = (start, misfit(&start), 1e-2);
        for _ in 0..ROUNDS {
            let slopes: [Vec<f64>; 4] = std::array::from_fn(|j| {
                let mut near = log;
                near[j] += NUDGE;
                let moved = misfit(&near);
                moved
                    .iter()
                    .zip(&own)
                    .map(|(b, a)| (b - a) / NUDGE)
                    .collect()
            });
            let change = damped(&slopes, &own, damping);
            let next: [f64; 4] = std::array::from_fn(|j| {
                let to = log[j] + change[j].clamp(-STRIDE, STRIDE);
                to.clamp(start[j] - WITHIN.ln(), start[j] + WITHIN.ln())
            });
            let found = misfit(&next);
            let gone = log.iter().zip(&next).map(|(a, b)| (a - b).abs());
            let met = gone.fold(0.0, f64::max) < MET;
            if dot(&found, &found) < dot(&own, &own) {
                (log, own, damping) = (next, found, damping / 5.0);
            } else {
                damping *= 4.0;
            }
            if met {
                break;
            }
        }
        let left = (dot(&own, &own) / samples.len() as f64).sqrt();
        (Pool::from_reaches(log.map(f64::exp)), left)
    }

    /// r of every sample for half axes of these logarithms.
    fn misfit(&self, samples: &[Sample], log: &[f64; 4]) -> Vec<f64> {
        let [half_width_m, depth_m, front_m, rear_m] = log.map(f64::exp);
        let shape = Shape::DoubleEllipsoid(DoubleEllipsoid {
            half_width_m,
            depth_m,
            front_m,
            rear_m,
            front_fraction: None,
        });
        let Metal {
            plate,
            start_k,
            melts_k,
        } = self.metal;
        let each = samples.iter().map(|sample| {
            let rise = plate.rise_per_watt(&shape, self.speed_m_s, sample.place, sample.seconds);
            (start_k + self.power_w * rise - sample.kelvin) / (melts_k - start_k)
        });
        each.collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The change of a damped Gauss-Newton round: `(J^T J + damping diag) change = -J^T r`, with the columns of J in `slopes`.
fn damped(slopes: &[Vec<f64>; 4], misfit: &[f64], damping: f64) -> [f64; 4] {
    let mut rows: [[f64; 5]; 4] = std::array::from_fn(|i| {
        std::array::from_fn(|j| match j {
            4 => -dot(&slopes[i], misfit),
            _ if i == j => dot(&slopes[i], &slopes[i]) * (1.0 + damping) + 1e-12,
            _ => dot(&slopes[i], &slopes[j]),
        })
    });
    // The matrix is symmetric and positive: no rows are exchanged.
    for k in 0..4 {
        let pivot = rows[k];
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row[k] / pivot[k];
            row.iter_mut()
                .zip(pivot)
                .for_each(|(x, p)| *x -= factor * p);
        }
    }
    std::array::from_fn(|i| rows[i][4] / rows[i][i])
}

/// What is to be said of a fit that leaves so much.
pub(super) fn missed(metal: &Metal, left: f64) -> Option<String> {
    let close = left <= TOLD;
    (!close).then(|| {
        format!(
            "conduction from no double ellipsoid warms the metal around this pool as the weld does: {:.0} K are left in the mean square, \
             of {:.0} K up to the melting point. Metal that flows carries heat where conduction does not, and a pool that still grows \
             takes heat to melt",
            left * (metal.melts_k - metal.start_k),
            metal.melts_k - metal.start_k
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 4 kW in a plate of steel of 8 mm, its sides and ends far away.
    fn going(power_w: f64) -> Going {
        let plate = Plate {
            conductivity_w_m_k: 35.0,
            capacity_j_m3_k: 5e6,
            ends_m: [[Some(-5e-3), None], [Some(-20e-3), Some(20e-3)]],
            thickness_m: Some(8e-3),
        };
        Going {
            metal: Metal {
                plate,
                start_k: 300.0,
                melts_k: 1750.0,
            },
            power_w,
            speed_m_s: 5e-3,
        }
    }

    /// Places around a pool of some millimetres, as warm as this source makes them.
    fn warmed(going: &Going, source: Pool) -> Vec<Sample> {
        let mut all = Vec::new();
        for (ahead, across, below) in (0..6).flat_map(|i| {
            (0..4).flat_map(move |j| {
                (0..4).map(move |k| {
                    (
                        3e-3 * f64::from(i),
                        2e-3 * f64::from(j),
                        1.5e-3 * f64::from(k),
                    )
                })
            })
        }) {
            let seconds = 6.0;
            let place = [going.speed_m_s * seconds - 11e-3 + ahead, across, below];
            let sample = Sample {
                place,
                seconds,
                kelvin: going.metal.start_k,
            };
            let log = source.reaches().map(f64::ln);
            let rise = going.misfit(&[sample], &log)[0] * 1450.0;
            all.push(Sample {
                kelvin: going.metal.start_k + rise,
                ..sample
            });
        }
        all
    }

    const GUESS: Pool = Pool {
        across: 5e-3,
        depth: 4e-3,
        ahead: 2e-3,
        behind: 11e-3,
    };

    #[test]
    fn the_source_of_a_conducted_weld_is_found_again() {
        let going = going(4e3);
        for axes in [
            [4e-3, 3e-3, 3e-3, 7e-3],
            [3e-3, 1e-3, 5e-3, 4e-3],
            [2e-3, 6e-3, 2e-3, 12e-3],
        ] {
            let source = Pool::from_reaches(axes);
            let (found, left) = going.fit(GUESS, &warmed(&going, source));
            for (axis, own) in found.reaches().iter().zip(axes) {
                assert!((axis / own - 1.0).abs() < 1e-3, "{found:?} {axes:?}");
            }
            assert!(missed(&going.metal, left).is_none(), "{left}");
        }
    }

    #[test]
    fn what_no_such_source_warms_is_told() {
        let strong = going(4e3);
        let weak = going(400.0);
        let all = warmed(&strong, GUESS);
        let (_, left) = weak.fit(GUESS, &all);
        assert!(missed(&weak.metal, left).is_some_and(|said| said.contains("no double ellipsoid")));
    }
}
