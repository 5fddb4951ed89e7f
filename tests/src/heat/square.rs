//! Steady conduction in a rectangle whose conductivity is any smooth function of place, two opposite
//! sides held and the other two insulated.
//!
//! Spectral elements (Patera 1984, J. Comput. Phys. 54): products of Legendre polynomials on
//! Gauss-Lobatto nodes, elements that shrink toward the sides because the solution is not smooth in
//! the corners, conjugate gradients. The insulated sides are natural boundaries. The heat that flows
//! is the energy of the solution over the difference of the held temperatures.

use super::formula::At;
use super::property::Property;

/// The problem.
#[derive(Debug, Clone)]
pub struct Square {
    /// Corners \[m\].
    pub corners: [[f64; 2]; 2],
    /// k.
    pub conductivity: Property,
    /// Temperatures of the sides x- and x+ \[K\].
    pub held: [f64; 2],
}

/// Share of the side that the elements nearest to it take, twice in a row.
const SHRINK: [f64; 6] = [0.0, 0.03, 0.15, 0.5, 0.85, 0.97];

/// The solution.
#[derive(Debug, Clone)]
pub struct Solution {
    degree: usize,
    /// Reference nodes and barycentric weights.
    nodes: Vec<[f64; 2]>,
    /// Element borders in x and in y \[m\].
    borders: [Vec<f64>; 2],
    /// Node values, row by row of the whole grid \[K\].
    values: Vec<f64>,
    /// Heat flow along +x per metre of depth \[W/m\].
    pub flow: f64,
}

/// Solves with polynomials of `degree`; `None` when the iteration does not converge.
#[must_use]
pub fn solve(problem: &Square, degree: usize) -> Option<Solution> {
    let rule = Rule::new(degree);
    let mut breaks: Vec<f64> = SHRINK.to_vec();
    breaks.push(1.0);
    let borders = [0, 1].map(|axis| {
        let (from, to) = (problem.corners[0][axis], problem.corners[1][axis]);
        let place = |s: &f64| from + (to - from) * s;
        breaks.iter().map(place).collect::<Vec<f64>>()
    });
    let elements = breaks.len() - 1;
    let width = elements * degree + 1;
    let mesh = Mesh {
        rule: &rule,
        elements,
        width,
        weight: weights(problem, &rule, &borders),
    };
    let mut values = vec![0.0; width * width];
    for row in values.chunks_mut(width) {
        row[0] = problem.held[0];
        row[width - 1] = problem.held[1];
    }
    conjugate_gradients(&mesh, &mut values)?;
    let mut energy = vec![0.0; values.len()];
    mesh.apply(&values, &mut energy);
    let energy: f64 = energy.iter().zip(&values).map(|(a, b)| a * b).sum();
    let drop = problem.held[0] - problem.held[1];
    Some(Solution {
        degree,
        nodes: rule
            .nodes
            .iter()
            .zip(rule.barycentric())
            .map(|(x, w)| [*x, w])
            .collect(),
        borders,
        values,
        flow: energy / drop,
    })
}

impl Solution {
    /// The temperature at a place inside \[K\].
    #[must_use]
    pub fn temperature(&self, x: f64, y: f64) -> f64 {
        let n = self.degree + 1;
        let (column, along) = self.basis(0, x);
        let (row, up) = self.basis(1, y);
        let width = (self.borders[0].len() - 1) * self.degree + 1;
        let mut sum = 0.0;
        for (j, weight) in up.iter().enumerate() {
            let first = (row * self.degree + j) * width + column * self.degree;
            let line = &self.values[first..first + n];
            sum += weight * line.iter().zip(&along).map(|(v, w)| v * w).sum::<f64>();
        }
        sum
    }

    /// The element of a coordinate and the values of its polynomials there (barycentric form).
    fn basis(&self, axis: usize, place: f64) -> (usize, Vec<f64>) {
        let borders = &self.borders[axis];
        let element = borders.partition_point(|b| *b <= place);
        let element = element.clamp(1, borders.len() - 1) - 1;
        let (from, to) = (borders[element], borders[element + 1]);
        let s = 2.0 * (place - from) / (to - from) - 1.0;
        if let Some(hit) = self.nodes.iter().position(|[x, _]| (x - s).abs() < 1e-14) {
            let one = |i| if i == hit { 1.0 } else { 0.0 };
            return (element, (0..self.nodes.len()).map(one).collect());
        }
        let mut values: Vec<f64> = self.nodes.iter().map(|[x, w]| w / (s - x)).collect();
        let sum: f64 = values.iter().sum();
        values.iter_mut().for_each(|v| *v /= sum);
        (element, values)
    }
}

/// Gauss-Lobatto nodes, weights and the derivatives of the polynomials through them.
struct Rule {
    nodes: Vec<f64>,
    weights: Vec<f64>,
    /// `derivative[i][j]`: slope of polynomial j at node i.
    derivative: Vec<Vec<f64>>,
}

impl Rule {
    fn new(degree: usize) -> Self {
        use std::f64::consts::PI;
        let p = degree as f64;
        let mut nodes = Vec::new();
        let mut top = Vec::new();
        for i in 0..=degree {
            let mut x = -(PI * i as f64 / p).cos();
            // Newton's method for (1 - x^2) P'(x) = p (P_{p-1} - x P_p), whose slope is
            // -p (p + 1) P_p.
            for _ in 0..60 {
                let (last, before) = legendre(degree, x);
                x -= (x * last - before) / ((p + 1.0) * last);
            }
            top.push(legendre(degree, x).0);
            nodes.push(x);
        }
        let weights = top.iter().map(|l| 2.0 / (p * (p + 1.0) * l * l)).collect();
        let slope = |i: usize, j: usize| {
            if i != j {
                top[i] / (top[j] * (nodes[i] - nodes[j]))
            } else if i == 0 {
                -0.25 * p * (p + 1.0)
            } else if i == degree {
                0.25 * p * (p + 1.0)
            } else {
                0.0
            }
        };
        let derivative = (0..=degree)
            .map(|i| (0..=degree).map(|j| slope(i, j)).collect())
            .collect();
        Self {
            nodes,
            weights,
            derivative,
        }
    }

    fn barycentric(&self) -> Vec<f64> {
        let weight = |i: usize| {
            let others = (0..self.nodes.len()).filter(|j| *j != i);
            1.0 / others
                .map(|j| self.nodes[i] - self.nodes[j])
                .product::<f64>()
        };
        (0..self.nodes.len()).map(weight).collect()
    }
}

/// Legendre polynomials of `degree` and of one less.
fn legendre(degree: usize, x: f64) -> (f64, f64) {
    let (mut before, mut last) = (1.0, x);
    for n in 1..degree {
        let n = n as f64;
        let next = ((2.0 * n + 1.0) * x * last - n * before) / (n + 1.0);
        before = last;
        last = next;
    }
    (last, before)
}

/// k times the quadrature weight over the square of the element's half width, for the slope along
/// x and along y, at every node of every element.
fn weights(problem: &Square, rule: &Rule, borders: &[Vec<f64>; 2]) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    for y in borders[1].windows(2) {
        for x in borders[0].windows(2) {
            let (a, b) = (0.5 * (x[1] - x[0]), 0.5 * (y[1] - y[0]));
            for (v, wv) in rule.nodes.iter().zip(&rule.weights) {
                for (u, wu) in rule.nodes.iter().zip(&rule.weights) {
                    let place = [x[0] + a * (u + 1.0), y[0] + b * (v + 1.0), 0.0];
                    let k = problem.conductivity.value(&At::place(place));
                    found.push([k * wu * wv * b / a, k * wu * wv * a / b]);
                }
            }
        }
    }
    found
}

struct Mesh<'a> {
    rule: &'a Rule,
    elements: usize,
    width: usize,
    weight: Vec<[f64; 2]>,
}

impl Mesh<'_> {
    /// `out` = stiffness times `values`, rows of held nodes included.
    fn apply(&self, values: &[f64], out: &mut [f64]) {
        let n = self.rule.nodes.len();
        let d = &self.rule.derivative;
        out.fill(0.0);
        for element in 0..self.elements * self.elements {
            let first = self.first(element);
            let at = |i: usize, j: usize| first + j * self.width + i;
            for j in 0..n {
                for i in 0..n {
                    let weight = self.weight[(element * n + j) * n + i];
                    let mut slope = [0.0; 2];
                    for m in 0..n {
                        slope[0] += d[i][m] * values[at(m, j)];
                        slope[1] += d[j][m] * values[at(i, m)];
                    }
                    for m in 0..n {
                        out[at(m, j)] += d[i][m] * weight[0] * slope[0];
                        out[at(i, m)] += d[j][m] * weight[1] * slope[1];
                    }
                }
            }
        }
    }

    fn first(&self, element: usize) -> usize {
        let step = self.rule.nodes.len() - 1;
        (element / self.elements) * step * self.width + (element % self.elements) * step
    }

    fn diagonal(&self) -> Vec<f64> {
        let n = self.rule.nodes.len();
        let d = &self.rule.derivative;
        let mut found = vec![0.0; self.width * self.width];
        for element in 0..self.elements * self.elements {
            let first = self.first(element);
            for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
                let weight = self.weight[(element * n + j) * n + i];
                for m in 0..n {
                    found[first + j * self.width + m] += d[i][m] * d[i][m] * weight[0];
                    found[first + m * self.width + i] += d[j][m] * d[j][m] * weight[1];
                }
            }
        }
        found
    }

    /// Sets what belongs to held nodes to zero.
    fn free(&self, values: &mut [f64]) {
        for row in values.chunks_mut(self.width) {
            row[0] = 0.0;
            row[self.width - 1] = 0.0;
        }
    }
}

/// Solves for the free nodes, preconditioned by the diagonal.
fn conjugate_gradients(mesh: &Mesh, values: &mut [f64]) -> Option<()> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let inverse: Vec<f64> = mesh.diagonal().iter().map(|d| 1.0 / d).collect();
    let mut image = vec![0.0; values.len()];
    mesh.apply(values, &mut image);
    mesh.free(&mut image);
    let mut residual: Vec<f64> = image.iter().map(|v| -v).collect();
    let scaled = |r: &[f64]| -> Vec<f64> { r.iter().zip(&inverse).map(|(r, d)| r * d).collect() };
    let mut direction = scaled(&residual);
    let mut size = dot(&residual, &direction);
    let goal = 1e-28 * size;
    for _ in 0..20_000 {
        if size <= goal {
            return Some(());
        }
        mesh.apply(&direction, &mut image);
        mesh.free(&mut image);
        let step = size / dot(&direction, &image);
        for i in 0..values.len() {
            values[i] += step * direction[i];
            residual[i] -= step * image[i];
        }
        let next = scaled(&residual);
        let new = dot(&residual, &next);
        for (d, n) in direction.iter_mut().zip(&next) {
            *d = n + new / size * *d;
        }
        size = new;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat::plate::Plate;
    use crate::heat::property::Exponential;
    use serde_json::json;

    fn square(formula: &str) -> Square {
        Square {
            corners: [[0.0, 0.0], [1.0, 1.0]],
            conductivity: Property::read(&json!({"expr": formula})).unwrap(),
            held: [10.0, 0.0],
        }
    }

    #[test]
    fn a_graded_plate_is_solved_to_rounding() {
        let found = solve(&square("2*exp(1.5*x)"), 10).unwrap();
        let plate = Plate {
            conductivity: Exponential {
                scale: 2.0,
                along_x: 1.5,
                with_temperature: 0.0,
            },
            faces: [0.0, 1.0],
            held: [10.0, 0.0],
        };
        assert!((found.flow / plate.flux() - 1.0).abs() < 1e-11);
        for (x, y) in [(0.0, 0.3), (0.013, 0.7), (0.5, 0.5), (0.77, 1.0)] {
            let miss = (found.temperature(x, y) - plate.temperature(x)).abs();
            assert!(miss < 1e-10, "{x} {y}: {miss:e}");
        }
    }

    #[test]
    fn the_papers_case_is_converged_far_below_its_target() {
        let problem = square("1 + 2*sin(pi*x)*sin(pi*y)");
        let (coarse, fine) = (solve(&problem, 9).unwrap(), solve(&problem, 12).unwrap());
        assert!((coarse.flow / fine.flow - 1.0).abs() < 1e-8);
        let mut worst = 0.0_f64;
        for i in 0..=40 {
            for j in 0..=40 {
                let (x, y) = (f64::from(i) / 40.0, f64::from(j) / 40.0);
                let miss = coarse.temperature(x, y) - fine.temperature(x, y);
                worst = worst.max(miss.abs() / 10.0);
            }
        }
        assert!(worst < 1e-8, "{worst:e}");
    }
}
