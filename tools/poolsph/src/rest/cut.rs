//! Sums that a free face cuts off, completed for the heat that flows along it.
//!
//! Nothing flows across a free face, as nothing is beyond it. Along it a cut sum conducts less than the inside does: with h = d a flat
//! face lacks 0.13 of a layer. What a particle lacks stands opposite to what it has. Its sum is complete where for each neighbour at r
//! another particle stands at -r, or where that place lies beyond a named face, which completes it in its own way. At edges both may lack:
//! a particle takes the complete sum of that neighbour which has most. Pairs at rest weigh
//!
//! ```text
//! W_ab (1 + (f_a + f_b)/2),    f_a = c_a (e . t_a)^4 + d_a (e . u_a)^4
//! ```
//!
//! with e the direction of the pair. t_a and u_a stand across n_a, the direction of the sum of r W over what has nothing opposite: they are those in
//! which most and least lacks, at an edge around it and along it. c_a and d_a, which are not below 0, make sum W (r . t)^2 and sum W (r .
//! u)^2 those of the complete sum. Pairs along n_a keep their weight. What a gains b still loses to the last bit. No sum of weights rises above
//! that of the complete sum, so the limit of the step holds.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;

use shapes::frame::{Vector, along, cross, difference, dot, squared, unit};

use super::{Link, Plane, around, cell};

/// Particles by cells as wide as the kernel reaches.
type Cells = BTreeMap<[i32; 3], Vec<u32>>;

/// A particle stands at a place within this part of the reach of the kernel.
const STANDS: f64 = 0.3;
/// Rounds of the coupled equations, their damping, and the change that ends them.
const ROUNDS: u32 = 200;
const DAMPING: f64 = 0.7;
const SETTLED: f64 = 1e-10;

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
    /// (e . t)^4 and (e . u)^4 for a direction of any length.
    fn along(&self, way: Vector) -> [f64; 2] {
        let size = squared(way);
        self.flat.map(|t| {
            let square = dot(way, t) * dot(way, t) / size;
            square * square
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
    // Any direction that is not n serves to begin with.
    let least = (0..3).min_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()));
    let mut axis = [0.0; 3];
    axis[least.unwrap_or(0)] = 1.0;
    let t = unit(cross(normal, axis)).unwrap_or(axis);
    let u = cross(normal, t);
    // Principal directions of a symmetric matrix of two rows.
    let both = std::array::from_fn(|k| (t[k] + u[k]) * FRAC_1_SQRT_2);
    let [a, b] = [along_both(lacks, t), along_both(lacks, u)];
    let mixed = along_both(lacks, both) - 0.5 * (a + b);
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

/// What stands where at the start.
pub(super) struct Standing<'a> {
    pub(super) places: &'a [Vector],
    /// Named faces, beyond which nothing lacks.
    pub(super) faces: &'a [Plane],
    /// Reach of the kernel \[m\].
    pub(super) reach: f64,
}

/// A sum that is complete as far as opposite places tell: what has nothing opposite counts twice.
#[derive(Debug, Clone, Copy)]
struct Whole {
    /// Sum of W, and of W r r along xx, yy, zz, yz, zx, xy.
    sum: f64,
    moment: [f64; 6],
    /// Whether a named face completes it.
    named: bool,
}

/// Neighbours of a particle that have nothing opposite.
#[derive(Default)]
struct Lacks {
    each: Vec<bool>,
    /// Whether a named face makes good for others.
    named: bool,
}

/// A pair of a cut particle.
struct Pair {
    weight: f64,
    /// (r . t)^2 and (r . u)^2, (e . t)^4 and (e . u)^4 of the particle.
    square: [f64; 2],
    along: [f64; 2],
    /// The other one among the cut particles, and the same of it; 0 where it is not cut.
    other: usize,
    along_of_other: [f64; 2],
}

/// What a cut particle has, and its sums of W (r . t)^2, W (r . u)^2 and W when complete.
struct Sums {
    pairs: Vec<Pair>,
    whole: [f64; 3],
}

impl Cuts {
    /// Those of the rows of particles at rest.
    pub(super) fn of(rows: &[Vec<Link>], standing: &Standing<'_>) -> Self {
        let mut cells = Cells::new();
        for (a, place) in standing.places.iter().enumerate() {
            let own = cells.entry(cell(*place, standing.reach)).or_default();
            own.push(a as u32);
        }
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
            complete.push([t, u, most.sum]);
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

    /// Makes the sums complete by Jacobi's iteration, as far as the limit of the step allows.
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
        // Of both moments and of W: the sum, and its slopes along c and d.
        let (mut has, mut slopes) = ([0.0; 3], [[0.0; 2]; 3]);
        for pair in &own.pairs {
            let other = dot_of_two(self.all[pair.other].more, pair.along_of_other);
            let factor = 1.0 + 0.5 * (dot_of_two(more, pair.along) + other);
            let [t, u] = pair.square;
            for (k, part) in [t, u, 1.0].into_iter().enumerate() {
                has[k] += pair.weight * part * factor;
                for (slope, along) in slopes[k].iter_mut().zip(pair.along) {
                    *slope += 0.5 * pair.weight * part * along;
                }
            }
        }
        let wanted = |k: usize| match slopes[k][k] > 0.0 {
            true => DAMPING * (own.whole[k] - has[k]) / slopes[k][k],
            false => 0.0,
        };
        let mut change = [wanted(0), wanted(1)];
        let (rise, room) = (dot_of_two(change, slopes[2]), own.whole[2] - has[2]);
        if rise > room && rise > 0.0 {
            change = change.map(|change| change * room / rise);
        }
        [0, 1].map(|k| (more[k] + change[k]).max(0.0))
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

impl Standing<'_> {
    /// Which neighbours of `a` have nothing opposite.
    fn lacks(&self, a: usize, row: &[Link], cells: &Cells) -> Lacks {
        let at = self.places[a];
        let near = (STANDS * self.reach).powi(2);
        let stands =
            |place: Vector, b: u32| squared(difference(self.places[b as usize], place)) < near;
        let mut named = false;
        let mut lacks = |link: &Link| {
            let to = self.places[link.to as usize];
            let place: Vector = std::array::from_fn(|k| 2.0 * at[k] - to[k]);
            // Most are of the row itself.
            if row.iter().any(|link| stands(place, link.to)) {
                return false;
            }
            let beyond = |face: &Plane| face.outward * (place[face.axis] - face.at) > 0.0;
            if self.faces.iter().any(beyond) {
                named = true;
                return false;
            }
            let mut beside = around(cell(place, self.reach)).filter_map(|cell| cells.get(&cell));
            !beside.any(|own| own.iter().any(|b| stands(place, *b)))
        };
        let each = row.iter().map(&mut lacks).collect();
        Lacks { each, named }
    }

    fn whole(&self, a: usize, row: &[Link], lacks: &Lacks) -> Whole {
        let mut whole = Whole {
            sum: 0.0,
            moment: [0.0; 6],
            named: lacks.named,
        };
        for (place, link) in row.iter().enumerate() {
            let lacks = lacks.each.get(place).is_some_and(|lacks| *lacks);
            let weight = if lacks { 2.0 } else { 1.0 } * link.weight;
            let [x, y, z] = difference(self.places[link.to as usize], self.places[a]);
            whole.sum += weight;
            for (sum, product) in
                whole
                    .moment
                    .iter_mut()
                    .zip([x * x, y * y, z * z, y * z, z * x, x * y])
            {
                *sum += weight * product;
            }
        }
        whole
    }

    /// Direction of the sum of r W over what has nothing opposite; none where all has, or where the sum has no direction.
    fn normal(&self, a: usize, row: &[Link], lacks: &Lacks) -> Option<Vector> {
        let mut sum = [0.0; 3];
        for (link, _) in row.iter().zip(&lacks.each).filter(|(_, lacks)| **lacks) {
            let way = difference(self.places[link.to as usize], self.places[a]);
            sum = along(sum, link.weight, way);
        }
        unit(sum)
    }
}

#[cfg(test)]
mod tests {
    use kernels::CubicSpline;

    use super::*;

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
        }
    }

    /// Sum of W x_k^2 of the particle at a place.
    fn moment(places: &[Vector], cuts: &Cuts, at: Vector, k: usize) -> f64 {
        let a = places.iter().position(|x| *x == at).unwrap();
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
        let [a, b] = into.map(|at| places.iter().position(|x| *x == at).unwrap());
        assert_eq!(
            cuts.factor(a, b, [0.0, 0.0, 1.0]).to_bits(),
            1.0_f64.to_bits()
        );
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
        let between = |cut: &&Cut| (6.0..10.0).contains(&both[cut.particle as usize][2]);
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
        assert!(most < whole * (1.0 + 1e-9), "{most} {whole}");
    }
}
