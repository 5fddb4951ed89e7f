//! The matrix of Newton's method: `shift C - dW/dT`.

use krylov::Sparse;
use run::property::OutOfRange;

use super::{Rates, System};
use crate::material::arguments;

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
        (time, temperature, rates): (f64, &[f64], &Rates),
    ) -> Result<(), OutOfRange> {
        let heating = self.heating(time, temperature)?;
        let weight = &self.links.weight;
        matrix.fill(|i, columns, values| {
            let first = self.links.pattern.row(i).start;
            let mut diagonal = shift * self.capacity[i];
            for (m, (value, j)) in values.iter_mut().zip(columns).enumerate() {
                let (k, j) = (first + m, *j as usize);
                let ends = self.ends((i, j), temperature, &rates.nodes);
                let slopes = self.conduction.slopes(k, weight[k], (&ends, &rates.means));
                diagonal += slopes.own;
                *value = if self.held[i] || self.held[j] {
                    0.0
                } else {
                    -slopes.other
                };
            }
            for passed in &rates.passed[self.films[i] as usize..self.films[i + 1] as usize] {
                diagonal -= passed.slope;
            }
            diagonal - heating.get(i).copied().unwrap_or(0.0)
        });
        Ok(())
    }

    /// Derivative of the source by temperature, where it cools a point that is too hot \[W/K\].
    fn heating(&self, time: f64, temperature: &[f64]) -> Result<Vec<f64>, OutOfRange> {
        let Some(source) = &self.source else {
            return Ok(Vec::new());
        };
        let mut slopes = Vec::with_capacity(self.len());
        for (i, t) in temperature.iter().enumerate() {
            let step = 1e-6 * t.abs().max(1e-3);
            let at = |t: f64| source.value(&arguments(self.cloud.position[i], t, time));
            let slope = (at(t + step)? - at(t - step)?) / (2.0 * step);
            // A source that grows with temperature is left to the iteration: the matrix keeps its sign.
            slopes.push(slope.min(0.0) * self.links.volume[i]);
        }
        Ok(slopes)
    }
}
