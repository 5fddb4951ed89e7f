//! A layered disc cooled from above and on its rim, insulated below: Rong and Kisu (2010), section 3.
//!
//! Finite volumes in r and z, borders on the layers' borders; between cells the resistances of both
//! halves add up, each with its own conductivity at its own temperature; the film stands in series
//! with the half cell at the surface. Time by [`super::sdirk`]; the equations of a stage are solved
//! with the matrix of the first guess, factored once (Cholesky, banded). Two grids, one of half the
//! spacing, give a value without the error of second order (Richardson).

use super::formula::At;
use super::property::Property;
use super::sdirk::{March, Stiff, march};

/// A layer, from its lower border up.
#[derive(Debug, Clone)]
pub struct Layer {
    /// \[m\].
    pub thickness: f64,
    /// k, which may depend on place and temperature.
    pub conductivity: Property,
    /// rho c \[J/(m3 K)\].
    pub capacity: f64,
}

/// The disc.
#[derive(Debug, Clone)]
pub struct Disc {
    /// R \[m\].
    pub radius: f64,
    /// z of the lower face \[m\].
    pub bottom: f64,
    /// From below.
    pub layers: Vec<Layer>,
    /// Heat transfer coefficient on the upper face and on the rim, a function of place.
    pub film: [Property; 2],
    /// \[K\].
    pub ambient: f64,
    /// At the start \[K\].
    pub start: f64,
}

/// How finely it is solved.
#[derive(Debug, Clone, Copy)]
pub struct Fineness {
    /// Cells along the radius.
    pub radial: usize,
    /// Cells in each layer.
    pub layer: usize,
    /// Tolerance of a step \[K\].
    pub tolerance: f64,
}

impl Fineness {
    /// Fine enough for the disc of the paper: its error is below 1.5e-4 of the drop from 1 s on.
    pub const FINE: Self = Self {
        radial: 30,
        layer: 2,
        tolerance: 1e-3,
    };
}

/// Temperatures \[K\] at each of the times `at` \[s\] and each place `[r, z]` \[m\], extrapolated
/// from grids of `fineness` and twice that; `None` when the march fails.
#[must_use]
pub fn temperatures(
    disc: &Disc,
    at: &[f64],
    places: &[[f64; 2]],
    fineness: Fineness,
) -> Option<Vec<Vec<f64>>> {
    let coarse = solve(disc, at, places, fineness)?;
    let fine = Fineness {
        radial: 2 * fineness.radial,
        layer: 2 * fineness.layer,
        ..fineness
    };
    let fine = solve(disc, at, places, fine)?;
    let better =
        |(c, f): (&Vec<f64>, &Vec<f64>)| c.iter().zip(f).map(|(c, f)| f + (f - c) / 3.0).collect();
    Some(coarse.iter().zip(&fine).map(better).collect())
}

fn solve(
    disc: &Disc,
    at: &[f64],
    places: &[[f64; 2]],
    fineness: Fineness,
) -> Option<Vec<Vec<f64>>> {
    let grid = Grid::new(disc, fineness);
    let start = vec![disc.start; grid.columns() * grid.rows()];
    let how = March {
        tolerance: fineness.tolerance,
        first_s: 1e-4 * at.first()?,
    };
    let states = march(&grid, &start, at, how)?;
    let values = |state: &Vec<f64>| {
        let slopes = grid.slopes(state);
        let value = |p: &[f64; 2]| grid.value(state, &slopes, *p);
        places.iter().map(value).collect()
    };
    Some(states.iter().map(values).collect())
}

/// Cells in columns: index `i * rows + j`, i along r and j along z.
struct Grid<'a> {
    disc: &'a Disc,
    /// Borders \[m\].
    r: Vec<f64>,
    z: Vec<f64>,
    /// Layer of each row.
    layer: Vec<usize>,
    /// Heat transfer coefficients above each column and beside each row.
    top: Vec<f64>,
    rim: Vec<f64>,
}

impl<'a> Grid<'a> {
    fn new(disc: &'a Disc, fineness: Fineness) -> Self {
        let n = fineness.radial;
        let r: Vec<f64> = (0..=n).map(|i| disc.radius * i as f64 / n as f64).collect();
        let mut z = vec![disc.bottom];
        let mut layer = Vec::new();
        for (number, one) in disc.layers.iter().enumerate() {
            let from = z[z.len() - 1];
            for j in 1..=fineness.layer {
                z.push(from + one.thickness * j as f64 / fineness.layer as f64);
                layer.push(number);
            }
        }
        let film = |which: usize, r: f64, z: f64| disc.film[which].value(&At::place([r, 0.0, z]));
        let above = z[z.len() - 1];
        Self {
            top: centres(&r).map(|r| film(0, r, above)).collect(),
            rim: centres(&z).map(|z| film(1, disc.radius, z)).collect(),
            disc,
            r,
            z,
            layer,
        }
    }

    fn columns(&self) -> usize {
        self.r.len() - 1
    }

    fn rows(&self) -> usize {
        self.z.len() - 1
    }

    fn conductivity(&self, i: usize, j: usize, temperature: f64) -> f64 {
        let place = [
            0.5 * (self.r[i] + self.r[i + 1]),
            0.0,
            0.5 * (self.z[j] + self.z[j + 1]),
        ];
        self.disc.layers[self.layer[j]].conductivity.value(&At {
            temperature,
            ..At::place(place)
        })
    }

    /// Conductances \[W/K\] per radian: of each cell to the next along r and along z, and to the
    /// surroundings.
    fn conductances(&self, t: &[f64]) -> Conductances {
        let (columns, rows) = (self.columns(), self.rows());
        let k: Vec<f64> = (0..columns * rows)
            .map(|c| self.conductivity(c / rows, c % rows, t[c]))
            .collect();
        let mut found = Conductances {
            outward: vec![0.0; k.len()],
            upward: vec![0.0; k.len()],
            film: vec![0.0; k.len()],
        };
        for c in 0..k.len() {
            let (i, j) = (c / rows, c % rows);
            let (dr, dz) = (self.r[i + 1] - self.r[i], self.z[j + 1] - self.z[j]);
            let side = self.r[i + 1] * dz;
            let face = 0.5 * (self.r[i + 1].powi(2) - self.r[i].powi(2));
            if i + 1 < columns {
                found.outward[c] = 2.0 * side / (dr / k[c] + dr / k[c + rows]);
            } else if self.rim[j] > 0.0 {
                found.film[c] += side / (0.5 * dr / k[c] + 1.0 / self.rim[j]);
            }
            if j + 1 < rows {
                let next = self.z[j + 2] - self.z[j + 1];
                found.upward[c] = 2.0 * face / (dz / k[c] + next / k[c + 1]);
            } else if self.top[i] > 0.0 {
                found.film[c] += face / (0.5 * dz / k[c] + 1.0 / self.top[i]);
            }
        }
        found
    }

    /// Heat capacity of a cell \[J/K\] per radian.
    fn capacity(&self, c: usize) -> f64 {
        let (i, j) = (c / self.rows(), c % self.rows());
        let face = 0.5 * (self.r[i + 1].powi(2) - self.r[i].powi(2));
        self.disc.layers[self.layer[j]].capacity * face * (self.z[j + 1] - self.z[j])
    }

    /// Slopes \[K/m\] in each cell at its inner, outer, lower and upper border, as the heat that
    /// passes them asks for.
    fn slopes(&self, t: &[f64]) -> Vec<[f64; 4]> {
        let (columns, rows) = (self.columns(), self.rows());
        let g = self.conductances(t);
        let slopes = |c: usize| {
            let (i, j) = (c / rows, c % rows);
            let (dr, dz) = (self.r[i + 1] - self.r[i], self.z[j + 1] - self.z[j]);
            let face = 0.5 * (self.r[i + 1].powi(2) - self.r[i].powi(2));
            let k = self.conductivity(i, j, t[c]);
            // A film of no coefficient lets nothing pass.
            let film = |h: f64, half: f64| (self.disc.ambient - t[c]) / (half + k / h);
            [
                if i > 0 {
                    g.outward[c - rows] * (t[c] - t[c - rows]) / (self.r[i] * dz * k)
                } else {
                    0.0
                },
                if i + 1 < columns {
                    g.outward[c] * (t[c + rows] - t[c]) / (self.r[i + 1] * dz * k)
                } else {
                    film(self.rim[j], 0.5 * dr)
                },
                if j > 0 {
                    g.upward[c - 1] * (t[c] - t[c - 1]) / (face * k)
                } else {
                    0.0
                },
                if j + 1 < rows {
                    g.upward[c] * (t[c + 1] - t[c]) / (face * k)
                } else {
                    film(self.top[i], 0.5 * dz)
                },
            ]
        };
        (0..t.len()).map(slopes).collect()
    }

    /// The temperature at `[r, z]`: in each cell a parabola with the value at its centre and the
    /// slopes at its borders.
    fn value(&self, t: &[f64], slopes: &[[f64; 4]], place: [f64; 2]) -> f64 {
        let (i, r, width) = cell(&self.r, place[0]);
        let (j, z, height) = cell(&self.z, place[1]);
        let rows = self.rows();
        let [inner, outer, lower, upper] = slopes[i * rows + j];
        let along = 0.5 * (inner + outer) * r + 0.5 * (outer - inner) / width * r * r;
        let up = 0.5 * (lower + upper) * z + 0.5 * (upper - lower) / height * z * z;
        // How the slope along z changes along r, from the columns beside.
        let (before, after) = (i.saturating_sub(1), (i + 1).min(self.columns() - 1));
        let slope = |i: usize| 0.5 * (slopes[i * rows + j][2] + slopes[i * rows + j][3]);
        let twist = (slope(after) - slope(before)) / ((after - before) as f64 * width);
        t[i * rows + j] + along + up + twist * r * z
    }
}

fn centres(borders: &[f64]) -> impl Iterator<Item = f64> {
    borders.windows(2).map(|w| 0.5 * (w[0] + w[1]))
}

/// The cell that holds a place, how far from its centre the place is, and its width.
fn cell(borders: &[f64], place: f64) -> (usize, f64, f64) {
    let i = borders.partition_point(|b| *b <= place);
    let i = i.clamp(1, borders.len() - 1) - 1;
    let (from, to) = (borders[i], borders[i + 1]);
    (i, place - 0.5 * (from + to), to - from)
}

struct Conductances {
    outward: Vec<f64>,
    upward: Vec<f64>,
    film: Vec<f64>,
}

impl Stiff for Grid<'_> {
    fn implicit(&self, base: &[f64], dt: f64, t: &mut Vec<f64>) -> bool {
        let (n, rows) = (t.len(), self.rows());
        let store: Vec<f64> = (0..n).map(|c| self.capacity(c) / dt).collect();
        let Some(factor) = Factor::new(&store, &self.conductances(t), rows) else {
            return false;
        };
        for _ in 0..40 {
            let g = self.conductances(t);
            let mut residual: Vec<f64> = (0..n)
                .map(|c| store[c] * (base[c] - t[c]) + g.film[c] * (self.disc.ambient - t[c]))
                .collect();
            for c in 0..n {
                for (conductance, other) in [(g.outward[c], c + rows), (g.upward[c], c + 1)] {
                    if conductance > 0.0 {
                        let flow = conductance * (t[other] - t[c]);
                        residual[c] += flow;
                        residual[other] -= flow;
                    }
                }
            }
            factor.solve(&mut residual);
            let mut worst = 0.0_f64;
            for (t, change) in t.iter_mut().zip(&residual) {
                *t += change;
                worst = worst.max(change.abs());
            }
            if worst < 1e-8 {
                return true;
            }
        }
        false
    }
}

/// Cholesky's factor of a banded matrix: row c holds the entries of columns c - band to c.
struct Factor {
    band: usize,
    rows: Vec<f64>,
}

impl Factor {
    fn new(store: &[f64], g: &Conductances, band: usize) -> Option<Self> {
        let (n, width) = (store.len(), band + 1);
        let mut rows = vec![0.0; n * width];
        for c in 0..n {
            rows[c * width + band] += store[c] + g.film[c];
            for (conductance, step) in [(g.outward[c], band), (g.upward[c], 1)] {
                if conductance > 0.0 {
                    let other = c + step;
                    rows[c * width + band] += conductance;
                    rows[other * width + band] += conductance;
                    rows[other * width + band - step] -= conductance;
                }
            }
        }
        for c in 0..n {
            for b in c.saturating_sub(band)..=c {
                let from = b.saturating_sub(band).max(c.saturating_sub(band));
                let (own, other) = (c * width + band - c, b * width + band - b);
                let products = (from..b).map(|m| rows[own + m] * rows[other + m]);
                let rest = rows[own + b] - products.sum::<f64>();
                rows[own + b] = if b < c {
                    rest / rows[other + b]
                } else if rest > 0.0 {
                    rest.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(Self { band, rows })
    }

    fn solve(&self, x: &mut [f64]) {
        let (band, width) = (self.band, self.band + 1);
        for c in 0..x.len() {
            let own = c * width + band - c;
            let from = c.saturating_sub(band);
            let known: f64 = (from..c).map(|m| self.rows[own + m] * x[m]).sum();
            x[c] = (x[c] - known) / self.rows[own + c];
        }
        for c in (0..x.len()).rev() {
            let own = c * width + band - c;
            x[c] /= self.rows[own + c];
            for m in c.saturating_sub(band)..c {
                x[m] -= self.rows[own + m] * x[c];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat::robin::Slab;
    use crate::norms::Worst;
    use serde_json::json;

    fn read(value: &serde_json::Value) -> Property {
        Property::read(value).unwrap()
    }

    fn layer(thickness: f64, k: &serde_json::Value, capacity: f64) -> Layer {
        Layer {
            thickness,
            conductivity: read(k),
            capacity,
        }
    }

    #[test]
    fn without_a_rim_it_is_the_slab() {
        let disc = Disc {
            radius: 0.02,
            bottom: 0.0,
            layers: vec![layer(0.04, &json!(20), 2e6), layer(0.06, &json!(20), 2e6)],
            film: [read(&json!(400)), read(&json!(0))],
            ambient: 300.0,
            start: 900.0,
        };
        let fineness = Fineness {
            radial: 4,
            layer: 16,
            tolerance: 1e-3,
        };
        let places = [[0.0, 0.0], [0.013, 0.047], [0.02, 0.1]];
        let found = temperatures(&disc, &[40.0, 200.0], &places, fineness).unwrap();
        let slab = Slab::new(0.1, 20.0, 1e-5, 40.0);
        for (i, t) in [40.0, 200.0].into_iter().enumerate() {
            for (place, value) in places.iter().zip(&found[i]) {
                let wanted = 300.0 + 600.0 * slab.value(place[1], t);
                assert!(
                    (value - wanted).abs() < 0.06,
                    "{t} {place:?}: {value} {wanted}"
                );
            }
        }
    }

    /// The disc of the paper with films of our own.
    fn paper() -> Disc {
        let k = |a: f64| {
            json!({"expr": format!(
                "(5.85 + 26524.4*exp(-0.002*T)/(242.85 + T))*(1 - {a}) + 2.8*{a}")})
        };
        let capacity = |a: f64| 3943.0 * 1165.0 * (1.0 - a) + 6050.0 * 600.0 * a;
        let layers = [0.2, 0.15, 0.1, 0.05, 0.0];
        Disc {
            radius: 0.015,
            bottom: 0.0,
            layers: layers
                .iter()
                .map(|a| layer(5e-4, &k(*a), capacity(*a)))
                .collect(),
            film: ["top", "rim"].map(|_| read(&json!({"expr": "250/(1 + (r/0.009)^2)"}))),
            ambient: 293.0,
            start: 1023.0,
        }
    }

    #[test]
    fn the_papers_disc_is_converged_far_below_its_target() {
        let disc = paper();
        let mut places = Vec::new();
        for i in 0..=15 {
            for j in 0..=10 {
                places.push([0.001 * f64::from(i), 0.00025 * f64::from(j)]);
            }
        }
        let at = [1.0, 22.0];
        let finer = Fineness {
            radial: 45,
            layer: 3,
            tolerance: 3e-4,
        };
        let found = temperatures(&disc, &at, &places, Fineness::FINE).unwrap();
        let wanted = temperatures(&disc, &at, &places, finer).unwrap();
        for (found, wanted) in found.iter().zip(&wanted) {
            let drop = 1023.0 - wanted.iter().copied().fold(f64::INFINITY, f64::min);
            let miss = found.iter().zip(wanted).map(|(c, f)| (c - f).abs());
            let worst = miss.worst();
            // The target is 3e-3 of the drop.
            assert!(drop > 30.0 && worst < 1.5e-4 * drop, "{worst} of {drop}");
        }
    }
}
