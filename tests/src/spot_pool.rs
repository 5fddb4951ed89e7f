//! Depth, width and speed of the pool of a spot weld about the z axis, with its surface at z = 0, from particles.
//!
//! Metal that never melted stands on its lattice, and its temperature is smooth. So the front of melting is where the
//! temperature of the solid, continued, is that of melting: a part of a particle.

use std::collections::BTreeMap;

use crate::norms::Worst;
use crate::particles::Frames;

/// Where the depth is measured: within this distance from the axis \[m\].
const CENTRE: f64 = 1.25e-3;
/// Width of the rings of the surface \[m\].
const RING: f64 = 5e-4;
/// Layers from which the speed at the surface is continued, and rows of solid from which the edge is.
const LAYERS: f64 = 3.0;
const ROWS: f64 = 3.5;
/// Fewest particles of all frames that tell a mean.
const FEWEST: usize = 12;

/// What is seen of a pool.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Seen {
    /// On the axis, of a parabola through the front around it \[m\].
    pub(crate) depth: f64,
    /// At the surface \[m\].
    pub(crate) half_width: f64,
    /// Greatest, of rings of the surface \[m/s\].
    pub(crate) speed: f64,
}

/// How a pool is looked at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pool {
    /// d \[m\].
    pub(crate) spacing: f64,
    /// Melting point \[K\].
    pub(crate) melting: f64,
}

/// A particle by its distance from the axis, height and temperature.
#[derive(Debug, Clone, Copy)]
struct Point {
    r: f64,
    z: f64,
    kelvin: f64,
}

impl Pool {
    /// The pool at the end: lines through the last quarter of the frames, and the mean of the speed in it.
    pub(crate) fn at_end(self, frames: &Frames) -> Option<Seen> {
        let end = *frames.time.last()?;
        let late: Vec<usize> = (0..frames.time.len())
            .filter(|k| frames.time[*k] > 0.75 * end)
            .collect();
        let (mut deep, mut wide) = (Vec::new(), Vec::new());
        let mut rings: BTreeMap<u64, Vec<[f64; 2]>> = BTreeMap::new();
        for &k in &late {
            let after = frames.time[k] - end;
            deep.push([after, self.depth(frames, k)?]);
            wide.push([after, self.half_width(frames, k)?]);
            self.surface(frames, k, &mut rings);
        }
        let rings = rings.values().filter(|ring| ring.len() >= FEWEST);
        let speeds = rings.filter_map(|ring| Some(fitted::<3>(ring)?[0].abs()));
        Some(Seen {
            depth: fitted::<2>(&deep)?[0],
            half_width: fitted::<2>(&wide)?[0],
            speed: speeds.worst(),
        })
    }

    /// All particles that are solid through and through.
    fn solid<'a>(
        self,
        frames: &'a Frames,
        k: usize,
    ) -> impl Iterator<Item = ([f64; 3], Point)> + 'a {
        let all = frames.position[k].iter().zip(&frames.scalar[k]);
        let solid = all.filter(move |(_, kelvin)| **kelvin < self.melting);
        solid.map(|(x, kelvin)| {
            let point = Point {
                r: x[0].hypot(x[1]),
                z: x[2],
                kelvin: *kelvin,
            };
            (*x, point)
        })
    }

    /// Depth of the front below the axis \[m\]: in each column of the lattice the three highest solid particles tell it.
    fn depth(self, frames: &Frames, k: usize) -> Option<f64> {
        let mut columns: BTreeMap<[i64; 2], Vec<Point>> = BTreeMap::new();
        for (x, point) in self.solid(frames, k).filter(|(_, point)| point.r < CENTRE) {
            let column = [x[0], x[1]].map(|x| (x / self.spacing).floor() as i64);
            columns.entry(column).or_default().push(point);
        }
        let front = columns.into_values().filter_map(|mut column| {
            column.sort_by(|a, b| b.z.total_cmp(&a.z));
            let three = column.first_chunk::<3>()?;
            let melts = three.map(|point| [point.kelvin - self.melting, -point.z]);
            Some([three[0].r.powi(2), fitted::<3>(&melts)?[0]])
        });
        let front: Vec<[f64; 2]> = front.collect();
        Some(fitted::<2>(&front)?[0])
    }

    /// Distance of the front from the axis at the surface \[m\], continued from the two upper layers.
    fn half_width(self, frames: &Frames, k: usize) -> Option<f64> {
        let layer = |number: u64| {
            let within = |point: &Point| (-point.z / self.spacing) as u64 == number;
            let all: Vec<Point> = self
                .solid(frames, k)
                .map(|(_, point)| point)
                .filter(within)
                .collect();
            let first = all
                .iter()
                .map(|point| point.r)
                .fold(f64::INFINITY, f64::min);
            let rows = all
                .iter()
                .filter(|point| point.r < first + ROWS * self.spacing);
            let melts: Vec<[f64; 2]> = rows
                .map(|point| [point.kelvin - self.melting, point.r])
                .collect();
            Some(fitted::<3>(&melts)?[0])
        };
        Some(1.5 * layer(0)? - 0.5 * layer(1)?)
    }

    /// Adds heights and speeds outwards of the liquid near the surface to the rings in which it is.
    fn surface(self, frames: &Frames, k: usize, rings: &mut BTreeMap<u64, Vec<[f64; 2]>>) {
        let all = frames.position[k]
            .iter()
            .zip(&frames.velocity[k])
            .zip(&frames.scalar[k]);
        for ((x, u), _) in all.filter(|(_, kelvin)| **kelvin > self.melting) {
            if x[2] > -LAYERS * self.spacing {
                let r = x[0].hypot(x[1]);
                let outwards = (u[0] * x[0] + u[1] * x[1]) / r.max(f64::MIN_POSITIVE);
                let ring = rings.entry((r / RING) as u64).or_default();
                ring.push([x[2], outwards]);
            }
        }
    }
}

/// The polynomial of `N` coefficients through `[x, y]`, by least squares; none where the points do not tell one.
fn fitted<const N: usize>(points: &[[f64; 2]]) -> Option<[f64; N]> {
    let scale = points
        .iter()
        .fold(0.0, |most: f64, [x, _]| most.max(x.abs()));
    if points.len() < N || scale <= 0.0 {
        return None;
    }
    let (mut matrix, mut right) = ([[0.0; N]; N], [0.0; N]);
    for [x, y] in points {
        let powers: [f64; N] = std::array::from_fn(|i| (x / scale).powi(i as i32));
        for i in 0..N {
            for j in 0..N {
                matrix[i][j] += powers[i] * powers[j];
            }
            right[i] += powers[i] * y;
        }
    }
    for i in 0..N {
        let (pivot, value) = (matrix[i], right[i]);
        for (line, own) in matrix.iter_mut().zip(&mut right).skip(i + 1) {
            let part = line[i] / pivot[i];
            for (entry, above) in line.iter_mut().zip(pivot) {
                *entry -= part * above;
            }
            *own -= part * value;
        }
    }
    let mut found = [0.0; N];
    for i in (0..N).rev() {
        let beyond: f64 = (i + 1..N).map(|j| matrix[i][j] * found[j]).sum();
        found[i] = (right[i] - beyond) / matrix[i][i];
    }
    let sized: [f64; N] = std::array::from_fn(|i| found[i] / scale.powi(i as i32));
    sized.iter().all(|c| c.is_finite()).then_some(sized)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lattice whose temperature falls from the axis on, with a pool that grows: depth 2 mm, half-width 5 mm at the end.
    fn pool(spacing: f64) -> Frames {
        let melting = 1700.0;
        let mut frames = Frames {
            time: vec![0.0, 1.6, 1.8, 2.0],
            position: Vec::new(),
            velocity: Vec::new(),
            scalar: Vec::new(),
            liquid: Vec::new(),
            volume: spacing.powi(3),
        };
        for time in frames.time.clone() {
            let (mut places, mut speeds, mut kelvins) = (Vec::new(), Vec::new(), Vec::new());
            let n = (8e-3 / spacing) as i32;
            for i in 0..n.pow(3) {
                let x = [i % n, i / n % n, -1 - i / n / n].map(|k| (f64::from(k) + 0.5) * spacing);
                let r = x[0].hypot(x[1]);
                let size = ((r / 5e-3).powi(2) + (x[2] / 2e-3).powi(2)).sqrt()
                    * (1.0 + 0.1 * (2.0 - time));
                let kelvin = melting - 500.0 * (size - 1.0);
                let outwards = if kelvin > melting {
                    0.02 * (1.0 + 500.0 * x[2]) * r / 5e-3
                } else {
                    0.0
                };
                places.push(x);
                speeds.push([outwards * x[0] / r, outwards * x[1] / r, 0.0]);
                kelvins.push(kelvin);
            }
            frames.position.push(places);
            frames.velocity.push(speeds);
            frames.scalar.push(kelvins);
        }
        frames
    }

    #[test]
    fn a_pool_of_known_size_is_measured() {
        let (spacing, melting) = (2.5e-4, 1700.0);
        let seen = (Pool { spacing, melting }).at_end(&pool(spacing)).unwrap();
        assert!((seen.depth / 2e-3 - 1.0).abs() < 0.01, "{seen:?}");
        assert!((seen.half_width / 5e-3 - 1.0).abs() < 0.01, "{seen:?}");
        // The outermost ring that is liquid ends within half a millimetre of the edge.
        assert!((seen.speed / 0.02 - 0.95).abs() < 0.06, "{seen:?}");
    }

    #[test]
    fn without_a_pool_nothing_is_measured() {
        let (spacing, melting) = (5e-4, 1e4);
        let seen = (Pool { spacing, melting }).at_end(&pool(spacing));
        assert!(seen.is_none_or(|seen| seen.speed.is_nan()), "{seen:?}");
    }

    #[test]
    fn polynomials_are_found_again() {
        let points: Vec<[f64; 2]> = (0..5)
            .map(f64::from)
            .map(|x| [1e-3 * x, 2.0 - 3e3 * x * 1e-3 + 5e6 * (x * 1e-3).powi(2)])
            .collect();
        let [a, b, c] = fitted::<3>(&points).unwrap();
        assert!((a - 2.0).abs() < 1e-9 && (b + 3e3).abs() < 1e-6 && (c - 5e6).abs() < 1e-2);
        assert!(fitted::<3>(&points[..2]).is_none());
    }
}
