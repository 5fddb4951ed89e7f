//! The matrix of Newton's method: `shift C - dW/dT`.
//!
//! Where all heat flows under one function of temperature, `W_i = sum_j a_ij (theta_j - theta_i)`, the matrix is
//! `(shift C / k + A) diag(k)`: with the transform theta as the unknown it is symmetric.

use krylov::Sparse;
use run::property::OutOfRange;

use super::conduction::Conduction;
use super::{Rates, System};
use crate::source::Warmth;

impl System {
    /// A matrix of the pattern of the links.
    #[must_use]
    pub fn matrix(&self) -> Sparse {
        Sparse::zeros(self.links.pattern.clone())
    }

    /// Fills the matrix `shift C - dW/dT` at `rates`, which belong to `temperature` and `time`; `shift` is one
    /// over a time \[1/s\]. Rows and columns of held points are those of the unit matrix, scaled.
    ///
    /// # Errors
    /// Where the source has no value.
    pub fn fill(
        &self,
        matrix: &mut Sparse,
        shift: f64,
        time: f64,
        temperature: &[f64],
        rates: &Rates,
    ) -> Result<(), OutOfRange> {
        let heating = self.heating(time, temperature)?;
        let own = |i: usize| {
            let films = &rates.passed[self.films[i] as usize..self.films[i + 1] as usize];
            let slopes: f64 = films.iter().map(|passed| passed.slope).sum();
            shift * self.storage.capacity(i, temperature[i])
                - slopes
                - heating.get(i).copied().unwrap_or(0.0)
        };
        let slopes = {
            let ends =
                |[i, j]: [u32; 2]| self.ends(i as usize, j as usize, temperature, &rates.nodes);
            self.conduction.slopes(ends, &rates.means)
        };
        let weight = &self.links.weight;
        matrix.fill(|i, columns, values| {
            let row = self.links.pattern.row(i);
            match &self.conduction {
                Conduction::Fixed(g) => {
                    let slopes = g[row].iter().map(|g| (*g, *g));
                    self.lay(i, columns, own(i), slopes, values)
                }
                Conduction::Kirchhoff {
                    conductor,
                    fraction,
                } => {
                    let count = self.materials.conductors.len();
                    let k = fraction * rates.nodes[i * count + conductor].0;
                    let slopes = weight[row].iter().map(|a| (*a, *a));
                    self.lay(i, columns, own(i) / k, slopes, values)
                }
                Conduction::Mixture(_) | Conduction::Series(_) => {
                    let edges = self.conduction.edges_of(row.clone());
                    let slope = |((j, edge), a): ((&u32, &u32), &f64)| {
                        let [low, high] = slopes[*edge as usize];
                        if i < *j as usize {
                            (a * low, a * high)
                        } else {
                            (a * high, a * low)
                        }
                    };
                    let slopes = columns.iter().zip(edges).zip(&weight[row]).map(slope);
                    self.lay(i, columns, own(i), slopes, values)
                }
            }
        });
        Ok(())
    }

    /// Lays the links of point `i` into its row; gives the diagonal, `own` and the links' slopes by its temperature.
    #[inline]
    fn lay(
        &self,
        i: usize,
        columns: &[u32],
        own: f64,
        slopes: impl Iterator<Item = (f64, f64)>,
        values: &mut [f64],
    ) -> f64 {
        let mut diagonal = own;
        for ((value, j), (here, there)) in values.iter_mut().zip(columns).zip(slopes) {
            diagonal += here;
            let free = !self.held[i] && !self.held[*j as usize];
            *value = if free { -there } else { 0.0 };
        }
        diagonal
    }

    /// What the solution is to be divided by, point by point; nothing where it is the change of temperature.
    pub fn scale(&self, rates: &Rates, scale: &mut Vec<f64>) {
        scale.clear();
        if let Conduction::Kirchhoff {
            conductor,
            fraction,
        } = &self.conduction
        {
            let count = self.materials.conductors.len();
            let each = rates.nodes.chunks(count);
            scale.extend(each.map(|nodes| fraction * nodes[*conductor].0));
        }
    }

    /// Derivative of the source by temperature, where it cools a point that is too hot \[W/K\].
    fn heating(&self, time: f64, temperature: &[f64]) -> Result<Vec<f64>, OutOfRange> {
        let Some(source) = &self.source else {
            return Ok(Vec::new());
        };
        if !source.depends_on("T") {
            return Ok(Vec::new());
        }
        let mut cells = Vec::new();
        self.within(temperature, &mut cells);
        let warmth = Warmth {
            temperature,
            cells: &cells,
            time,
        };
        let mut slopes = source.slopes(&self.cloud, &self.links.volume, warmth)?;
        // A source that grows with temperature is left to the iteration: the matrix keeps its sign.
        slopes.iter_mut().for_each(|slope| *slope = slope.min(0.0));
        Ok(slopes)
    }
}
