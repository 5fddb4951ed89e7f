//! Half a weld beside its mirror plane, shown whole.

use artefact::Reader;
use serde::Deserialize;

/// The plane x = const beside which half a weld was computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mirror {
    /// Where it stands \[m\].
    at: f64,
}

/// What the plate tells of it.
#[derive(Deserialize)]
struct Told {
    #[serde(default)]
    mirror_x_m: Option<f64>,
}

impl Mirror {
    /// The mirror of the weld in a file; none where the whole was computed.
    ///
    /// # Errors
    /// When the plate cannot be read.
    pub(crate) fn read(reader: &Reader) -> artefact::Result<Option<Self>> {
        if !reader.has("/plate") {
            return Ok(None);
        }
        let told: Told = reader.json_at("/plate", 0)?;
        Ok(told.mirror_x_m.map(|at| Self { at }))
    }

    /// How often what a file tells of its metal counts for the whole weld.
    ///
    /// # Errors
    /// When the plate cannot be read.
    pub(crate) fn times(reader: &Reader) -> artefact::Result<f64> {
        Ok(if Self::read(reader)?.is_some() {
            2.0
        } else {
            1.0
        })
    }

    /// x of the plane \[m\].
    pub(crate) fn at(self) -> f64 {
        self.at
    }

    /// Places with their images behind them.
    pub(crate) fn places(self, half: &mut Vec<[f64; 3]>) {
        let images: Vec<_> = half
            .iter()
            .map(|[x, y, z]| [2.0 * self.at - x, *y, *z])
            .collect();
        half.extend(images);
    }

    /// What images share with their originals.
    pub(crate) fn values<T: Copy>(self, half: &mut Vec<T>) {
        half.extend_from_within(..);
    }

    /// The corners of the whole of a box.
    pub(crate) fn corners(self, low: &mut [f64; 3], high: &mut [f64; 3]) {
        let (near, far) = (2.0 * self.at - high[0], 2.0 * self.at - low[0]);
        (low[0], high[0]) = (low[0].min(near), high[0].max(far));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_stand_behind_with_the_values_of_their_originals() {
        let mirror = Mirror { at: 0.5 };
        let (mut places, mut values) = (vec![[0.75, 1.0, 2.0], [1.5, 0.0, 0.0]], vec![7, 8]);
        mirror.places(&mut places);
        mirror.values(&mut values);
        assert_eq!(places[2..], [[0.25, 1.0, 2.0], [-0.5, 0.0, 0.0]]);
        assert_eq!(values, [7, 8, 7, 8]);
        let (mut low, mut high) = ([0.5, 0.0, -1.0], [2.0, 1.0, 0.0]);
        mirror.corners(&mut low, &mut high);
        assert_eq!((low, high), ([-1.0, 0.0, -1.0], [2.0, 1.0, 0.0]));
    }
}
