//! Sums that a free face cuts off, completed for the heat that flows along it.
//!
//! Nothing flows across a free face, as nothing is beyond it. Along it a cut sum conducts less than the inside does: with h = d a flat
//! face lacks 0.13 of a layer. What a particle lacks stands opposite to what it has. Its sum is complete where for each neighbour at r
//! another particle stands at -r, or where that place lies beyond a named face, which completes it in its own way. At edges both may lack:
//! a particle takes the complete sum of that neighbour which has most. Pairs at rest weigh
//!
//! ```text
//! W_ab (1 + (f_a + f_b)/2),    f_a = c_a (e . t_a)^8 + d_a (e . u_a)^8
//! ```
//!
//! with e the direction of the pair. t_a and u_a stand across n_a, the direction of the sum of r W over what has nothing opposite: they are those in
//! which most and least lacks, at an edge around it and along it. c_a and d_a, which are not below 0, make sum W (r . t)^2 and sum W (r .
//! u)^2 those of the complete sum. Pairs along n_a keep their weight. What a gains b still loses to the last bit. No sum of weights rises by
//! more than 5 % above the complete one, so the limit of the step holds.

use std::cell::LazyCell;
use std::f64::consts::FRAC_1_SQRT_2;

use shapes::frame::{Vector, cross, difference, dot, squared, unit};

use super::Link;
use super::standing::{Lacks, Standing, Whole};

/// Sum of the weights of a particle, over that of the inside, up to which it may rise: below what the limit of the step allows for.
const ALLOWED: f64 = 1.05;
/// Rounds of the coupled equations, their damping, the change that ends them, and the greatest c and d.
const ROUNDS: u32 = 60;
const DAMPING: f64 = 0.4;
const SETTLED: f64 = 1e-6;
const MOST: f64 = 4.0;

/// Part of what two directions lack by which they differ, and lack alike.
const ALIKE: f64 = 1e-6;

/// A particle whose sum is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cut {
    particle: u32,
    /// t and u.
    flat: [Vector; 2],
    /// c and d.
    more: [f64; 2],
}

impl Cut {
    /// (e . t)^8 and (e . u)^8 for a direction of any length.
    fn along(&self, way: Vector) -> [f64; 2] {
        let size = squared(way).max(f64::MIN_POSITIVE);
        self.flat.map(|t| {
            let square = dot(way, t) * dot(way, t) / size;
            square.powi(4)
        })
    }

    /// f for a direction of any length.
    fn more(&self, way: Vector) -> f64 {
        dot_of_two(self.more, self.along(way))
    }
}

fn dot_of_two(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The two directions across n in which a sum lacks most and least, by what its moments lack.
fn across(normal: Vector, lacks: [f64; 6]) -> [Vector; 2] {
    // Any direction that is not n serves to begin with: the first of those farthest from it, whatever their rounding.
    let least = normal
        .iter()
        .fold(f64::INFINITY, |least, x| least.min(x.abs()));
    let first = normal.iter().position(|x| x.abs() <= least + ALIKE);
    let mut axis = [0.0; 3];
    axis[first.unwrap_or(0)] = 1.0;
    let t = unit(cross(normal, axis)).unwrap_or(axis);
    let u = cross(normal, t);
    // Principal directions of a symmetric matrix of two rows.
    let both = std::array::from_fn(|k| (t[k] + u[k]) * FRAC_1_SQRT_2);
    let [a, b] = [along_both(lacks, t), along_both(lacks, u)];
    let mixed = along_both(lacks, both) - 0.5 * (a + b);
    // Where both lack alike, as on a flat face, rounding would turn them.
    if (2.0 * mixed).hypot(a - b) <= ALIKE * (a.abs() + b.abs()) {
        return [t, u];
    }
    let (sin, cos) = (0.5 * (2.0 * mixed).atan2(a - b)).sin_cos();
    [
        std::array::from_fn(|k| cos * t[k] + sin * u[k]),
        std::array::from_fn(|k| cos * u[k] - sin * t[k]),
    ]
}

/// All particles whose sums are cut, ascending.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Cuts {
    all: Vec<Cut>,
}

/// A pair of a cut particle.
struct Pair {
    weight: f64,
    /// (r . t)^2 and (r . u)^2, (e . t)^8 and (e . u)^8 of the particle.
    square: [f64; 2],
    along: [f64; 2],
    /// The other one among the cut particles, and the same of it; 0 where it is not cut.
    other: usize,
    along_of_other: [f64; 2],
}

/// What a cut particle has, and its sums of W (r . t)^2 and W (r . u)^2 when complete.
struct Sums {
    pairs: Vec<Pair>,
    whole: [f64; 2],
}

impl Cuts {
    /// Those of the rows of particles at rest.
    pub(super) fn of(rows: &[Vec<Link>], standing: &Standing<'_>) -> Self {
        let cells = LazyCell::new(|| standing.cells());
        let (mut wholes, mut normals) = (Vec::with_capacity(rows.len()), Vec::new());
        for (a, row) in rows.iter().enumerate() {
            let lacks = standing.lacks(a, row, &cells);
            wholes.push(standing.whole(a, row, &lacks));
            normals.extend(standing.normal(a, row, &lacks).map(|normal| (a, normal)));
        }
        let mut found = Self::default();
        let mut complete = Vec::with_capacity(normals.len());
        for (a, normal) in normals {
            let most = most(a, &rows[a], &wholes);
            let has = standing.whole(a, &rows[a], &Lacks::default());
            let lacks = std::array::from_fn(|k| most.moment[k] - has.moment[k]);
            let flat = across(normal, lacks);
            let [t, u] = flat.map(|t| along_both(most.moment, t));
            complete.push([t, u]);
            found.all.push(Cut {
                particle: a as u32,
                flat,
                more: [0.0; 2],
            });
        }
        let sums = found.all.iter().zip(complete).map(|(cut, whole)| Sums {
            pairs: found.pairs(cut, &rows[cut.particle as usize], standing.places),
            whole,
        });
        let sums: Vec<Sums> = sums.collect();
        found.settle(&sums);
        if !found.is_empty() {
            found.limit(rows, standing.places, &wholes);
        }
        found
    }

    /// Factor on the weight of the pair of `a` and `b`, at a distance `way` from each other.
    pub(super) fn factor(&self, a: usize, b: usize, way: Vector) -> f64 {
        let more = |a| self.get(a).map_or(0.0, |cut| cut.more(way));
        1.0 + 0.5 * (more(a) + more(b))
    }

    /// Whether no sum is cut.
    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Cut>() * self.all.capacity()
    }

    /// As numbers, for a checkpoint.
    pub(super) fn save(&self) -> impl Iterator<Item = f64> {
        let each = self.all.iter();
        each.flat_map(|cut| {
            let [[x, y, z], [u, v, w]] = cut.flat;
            let [c, d] = cut.more;
            [f64::from(cut.particle), x, y, z, u, v, w, c, d]
        })
    }

    /// What [`Cuts::save`] gave.
    pub(super) fn restored(saved: &[f64]) -> Self {
        let each = saved.as_chunks::<9>().0.iter();
        let all = each.map(|[particle, x, y, z, u, v, w, c, d]| Cut {
            particle: *particle as u32,
            flat: [[*x, *y, *z], [*u, *v, *w]],
            more: [*c, *d],
        });
        Self { all: all.collect() }
    }

    fn place(&self, a: usize) -> Option<usize> {
        let found = self
            .all
            .binary_search_by_key(&(a as u32), |cut| cut.particle);
        found.ok()
    }

    fn get(&self, a: usize) -> Option<&Cut> {
        self.place(a).map(|place| &self.all[place])
    }

    fn pairs(&self, cut: &Cut, row: &[Link], places: &[Vector]) -> Vec<Pair> {
        let at = places[cut.particle as usize];
        let each = row.iter().map(|link| {
            let way = difference(places[link.to as usize], at);
            let (other, along_of_other) = match self.place(link.to as usize) {
                Some(other) => (other, self.all[other].along(way)),
                None => (0, [0.0; 2]),
            };
            Pair {
                weight: link.weight,
                square: cut.flat.map(|t| dot(way, t) * dot(way, t)),
                along: cut.along(way),
                other,
                along_of_other,
            }
        });
        each.collect()
    }

    /// Makes the sums complete by Jacobi's iteration.
    fn settle(&mut self, sums: &[Sums]) {
        for _ in 0..ROUNDS {
            let each = self.all.iter().zip(sums);
            let next: Vec<[f64; 2]> = each.map(|(cut, own)| self.next(cut.more, own)).collect();
            let mut change = 0.0_f64;
            for (cut, next) in self.all.iter_mut().zip(next) {
                for (more, next) in cut.more.iter_mut().zip(next) {
                    change = change.max((next - *more).abs());
                    *more = next;
                }
            }
            if change < SETTLED {
                break;
            }
        }
    }

    /// c and d of the next round.
    fn next(&self, more: [f64; 2], own: &Sums) -> [f64; 2] {
        let (mut has, mut slope) = ([0.0; 2], [0.0; 2]);
        for pair in &own.pairs {
            let other = dot_of_two(self.all[pair.other].more, pair.along_of_other);
            let factor = 1.0 + 0.5 * (dot_of_two(more, pair.along) + other);
            for k in 0..2 {
                has[k] += pair.weight * pair.square[k] * factor;
                slope[k] += 0.5 * pair.weight * pair.square[k] * pair.along[k];
            }
        }
        let wanted = |k: usize| match slope[k] > 0.0 {
            true => DAMPING * (own.whole[k] - has[k]) / slope[k],
            false => 0.0,
        };
        [0, 1].map(|k| (more[k] + wanted(k)).clamp(0.0, MOST))
    }

    /// Lowers c and d so far that no sum of W rises above what the limit of the step allows: each by the least factor that it, or
    /// a neighbour, needs.
    fn limit(&mut self, rows: &[Vec<Link>], places: &[Vector], wholes: &[Whole]) {
        let factor = |(a, row): (usize, &Vec<Link>)| {
            let (mut has, mut more) = (0.0, 0.0);
            for link in row {
                let b = link.to as usize;
                has += link.weight;
                more += link.weight * (self.factor(a, b, difference(places[a], places[b])) - 1.0);
            }
            let room = ALLOWED * most(a, row, wholes).sum - has;
            if more > room {
                (room / more).max(0.0)
            } else {
                1.0
            }
        };
        let factors: Vec<f64> = rows.iter().enumerate().map(factor).collect();
        for cut in &mut self.all {
            let a = cut.particle as usize;
            let beside = rows[a].iter().map(|link| factors[link.to as usize]);
            let least = beside.fold(factors[a], f64::min);
            cut.more = cut.more.map(|more| more * least);
        }
    }
}

/// The complete sum of a cut particle: its own, or that of the neighbour which has most.
fn most(a: usize, row: &[Link], wholes: &[Whole]) -> Whole {
    let mut most = wholes[a];
    if !most.named {
        for other in row.iter().map(|link| wholes[link.to as usize]) {
            if !other.named && other.sum > most.sum {
                most = other;
            }
        }
    }
    most
}

/// t . M t.
fn along_both([xx, yy, zz, yz, zx, xy]: [f64; 6], t: Vector) -> f64 {
    let [x, y, z] = t;
    xx * x * x + yy * y * y + zz * z * z + 2.0 * (yz * y * z + zx * z * x + xy * x * y)
}

#[cfg(test)]
mod tests {
    use kernels::CubicSpline;

    use super::*;
    use crate::rest::Plane;

    /// Rows of a body of cells of 1 m, and the sum of W x^2 of each particle.
    fn rows(places: &[Vector]) -> Vec<Vec<Link>> {
        let kernel = CubicSpline::<3>::new(1.0);
        let row = |a: usize| {
            let others = (0..places.len()).filter(|b| *b != a);
            let links = others.map(|b| Link {
                to: b as u32,
                weight: kernel.value(squared(difference(places[a], places[b])).sqrt()),
            });
            links.filter(|link| link.weight > 0.0).collect()
        };
        (0..places.len()).map(row).collect()
    }

    fn block(inside: impl Fn([i32; 3]) -> bool) -> Vec<Vector> {
        let mut places = Vec::new();
        for k in 0..8 {
            for j in 0..8 {
                for i in 0..8 {
                    if inside([i, j, k]) {
                        places.push([i, j, k].map(f64::from));
                    }
                }
            }
        }
        places
    }

    fn standing<'a>(places: &'a [Vector], faces: &'a [Plane]) -> Standing<'a> {
        Standing {
            places,
            faces,
            reach: 2.0,
            spacing: 1.0,
        }
    }

    /// The particle at a place.
    fn number(places: &[Vector], at: Vector) -> usize {
        let here = |place: &Vector| squared(difference(*place, at)) < 1e-12;
        places.iter().position(here).unwrap()
    }

    /// Sum of W x_k^2 of the particle at a place.
    fn moment(places: &[Vector], cuts: &Cuts, at: Vector, k: usize) -> f64 {
        let a = number(places, at);
        let row = &rows(places)[a];
        row.iter()
            .map(|link| {
                let way = difference(places[link.to as usize], at);
                link.weight * cuts.factor(a, link.to as usize, way) * way[k] * way[k]
            })
            .sum()
    }

    #[test]
    fn a_flat_face_conducts_along_itself_as_the_inside_does() {
        let places = block(|_| true);
        let cuts = Cuts::of(&rows(&places), &standing(&places, &[]));
        let inside = moment(&places, &cuts, [4.0, 4.0, 4.0], 0);
        let plain = moment(&places, &Cuts::default(), [4.0, 4.0, 0.0], 0);
        let face = moment(&places, &cuts, [4.0, 4.0, 0.0], 0);
        assert!((plain / inside - 1.0).abs() > 0.1, "{plain} {inside}");
        assert!((face / inside - 1.0).abs() < 1e-3, "{face} {inside}");
        // Straight into the metal nothing changes.
        let into = [[4.0, 4.0, 0.0], [4.0, 4.0, 1.0]];
        let [a, b] = into.map(|at| number(&places, at));
        assert_eq!(
            cuts.factor(a, b, [0.0, 0.0, 1.0]).to_bits(),
            1.0_f64.to_bits()
        );
    }

    #[test]
    fn rounding_turns_no_face() {
        // The same body elsewhere and at another scale has the same factors.
        let plain = block(|[_, _, k]| k < 4);
        let of = |places: &[Vector], size: f64| {
            let unit: Vec<Vector> = places.iter().map(|x| x.map(|x| x / size)).collect();
            Cuts::of(&rows(&unit), &standing(&unit, &[]))
        };
        let here = of(&plain, 1.0);
        let there: Vec<Vector> = plain.iter().map(|x| x.map(|x| 0.37e-3 * x + 0.4)).collect();
        let there = of(&there, 0.37e-3);
        assert_eq!(here.all.len(), there.all.len());
        for (a, b) in here.all.iter().zip(&there.all) {
            for way in [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.3, -0.8, 0.2]] {
                assert!((a.more(way) - b.more(way)).abs() < 1e-5, "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn what_named_faces_complete_is_left_alone() {
        let places = block(|_| true);
        let plane = |axis, at, outward| Plane { axis, at, outward };
        let faces: Vec<Plane> = (0..3)
            .flat_map(|axis| [plane(axis, -0.5, -1.0), plane(axis, 7.5, 1.0)])
            .collect();
        assert!(Cuts::of(&rows(&places), &standing(&places, &faces)).is_empty());
        // Of a body beside another nothing lacks between them.
        let upper: Vec<Vector> = places
            .iter()
            .map(|[x, y, z]| [x + 0.3, y + 0.2, z + 8.0])
            .collect();
        let both = [places, upper].concat();
        let cuts = Cuts::of(&rows(&both), &standing(&both, &faces[..4]));
        // Away from the sides, where one stands out over the other.
        let between = |cut: &&Cut| {
            let [x, y, z] = both[cut.particle as usize];
            (6.0..10.0).contains(&z) && [x, y].iter().all(|x| (1.0..6.0).contains(x))
        };
        assert_eq!(cuts.all.iter().filter(between).count(), 0);
    }

    #[test]
    fn no_sum_of_weights_rises_above_that_of_the_inside() {
        // A staircase of two cells to one: every face, edge and corner.
        let places = block(|[i, _, k]| i <= 2 * k);
        let (rows, cuts) = {
            let rows = rows(&places);
            let cuts = Cuts::of(&rows, &standing(&places, &[]));
            (rows, cuts)
        };
        assert!(cuts.all.iter().any(|cut| cut.more[0] > 0.5));
        let sum = |a: usize| -> f64 {
            let each = rows[a].iter().map(|link| {
                let way = difference(places[link.to as usize], places[a]);
                link.weight * cuts.factor(a, link.to as usize, way)
            });
            each.sum()
        };
        let most = (0..places.len()).map(sum).fold(0.0, f64::max);
        let kernel = CubicSpline::<3>::new(1.0);
        let whole: f64 = 6.0 * kernel.value(1.0)
            + 12.0 * kernel.value(2.0_f64.sqrt())
            + 8.0 * kernel.value(3.0_f64.sqrt());
        assert!(most < whole * ALLOWED * (1.0 + 1e-9), "{most} {whole}");
    }
}
