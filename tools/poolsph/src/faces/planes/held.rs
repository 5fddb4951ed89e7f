//! Walls that keep a temperature.

use run::property::{Arguments, OutOfRange};

use super::{Faces, Side, Turn};

impl Faces {
    /// True if a wall keeps a temperature.
    #[must_use]
    pub fn holds_heat(&self) -> bool {
        self.turns.iter().any(Turn::is_held)
    }

    /// True if `x` is nearer to a wall that keeps a temperature than `near` \[m\].
    #[must_use]
    pub fn is_beside_held(&self, x: [f64; 3], near: f64) -> bool {
        let at = [self.min, self.max];
        let mut sides = (0..3).flat_map(|axis| [0, 1].map(|side| (axis, side)));
        sides.any(|(axis, side)| {
            let held = matches!(
                &self.sides[axis][side],
                Some(Side::Wall {
                    temperature: Some(_),
                    ..
                })
            );
            held && (x[axis] - at[side][axis]).abs() < near
        })
    }

    /// T of the image of what is at `x` with `temperature` \[K\].
    ///
    /// # Errors
    /// When the formula of a wall fails.
    pub fn temperature(
        &self,
        turn: &Turn,
        x: [f64; 3],
        time: f64,
        temperature: f64,
    ) -> Result<f64, OutOfRange> {
        let mut image = temperature;
        for &(axis, side) in &turn.held {
            if let Some(Side::Wall {
                temperature: Some(wall),
                ..
            }) = &self.sides[axis][side]
            {
                let mut foot = x;
                foot[axis] = [self.min, self.max][side][axis];
                image = 2.0 * wall.value(&Arguments::at(foot, time))? - image;
            }
        }
        Ok(image)
    }
}
