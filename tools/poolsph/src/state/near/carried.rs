//! What particles of the copy carry along: kernel means over the liquid, and temperatures beyond walls.

use run::property::OutOfRange;

use super::{Near, Role};
use crate::faces::Faces;
#[cfg(doc)]
use crate::state::State;
use crate::sweep::summed_double;

impl Near {
    /// What each particle of [`State`] has in `column`, for liquid ones of the copy as the kernel mean over the liquid
    /// around (Komen 2019, eq. 4.8).
    #[must_use]
    pub fn liquid_mean(&self, column: &[f64]) -> Vec<f64> {
        let own = self.kernel.value(0.0);
        let carried: Vec<[f64; 2]> = self
            .id
            .iter()
            .zip(&self.role)
            .map(|(id, role)| match role {
                Role::Liquid | Role::Image => [column[*id as usize], 1.0],
                Role::Wet | Role::Backing => [0.0; 2],
            })
            .collect();
        let mut mean = vec![0.0; self.len()];
        self.each_row(&mut mean, |a, row, out| {
            let [sum, weight] = summed_double(row.index, row.value, &carried);
            *out = (own * carried[a][0] + sum) / (own + weight);
        });
        let mut means = column.to_vec();
        for ((id, role), mean) in self.id.iter().zip(&self.role).zip(mean) {
            if *role == Role::Liquid {
                means[*id as usize] = mean;
            }
        }
        means
    }

    /// Temperatures \[K\] of the copy, of images as the walls that they stand behind hold them; `temperature` is that of
    /// [`State`].
    ///
    /// # Errors
    /// When the formula of a wall fails.
    pub(crate) fn temperatures(
        &self,
        faces: &Faces,
        time: f64,
        temperature: &[f64],
        out: &mut Vec<f64>,
    ) -> Result<(), OutOfRange> {
        out.clear();
        out.extend(self.id.iter().map(|id| temperature[*id as usize]));
        if !faces.holds_heat() {
            return Ok(());
        }
        let images = self.images.list().iter().zip(&mut out[self.len..]);
        for (k, (image, kelvin)) in images.enumerate() {
            let turn = self.images.turn(self.len + k).filter(|turn| turn.is_held());
            if let Some(turn) = turn {
                let x = self.position[image.of as usize];
                *kelvin = faces.temperature(turn, x, time, *kelvin)?;
            }
        }
        Ok(())
    }
}
