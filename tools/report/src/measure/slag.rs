//! How thick slag lies across the weld, some way behind the arc (Komen 2019, section 5.3.8).
//!
//! ```text
//! h(x) = sum of the volumes of the grains in a column / (0.6 A)
//! ```
//!
//! of all grains that are molten or have set, in columns of the area A as wide as a grain, and as long as [`LONG`] along the weld: as thick
//! as they lie, six tenths of the room filled. The height of the topmost of them is not asked: one that is lost in the powder
//! would pass for a thick layer.

use std::f64::consts::PI;

use crate::flux::{Flux, POWDER};

/// Share of the room that grains fill where they lie as they fell.
const FILLED: f64 = 0.6;
/// Length of a column along the weld \[m\].
const LONG: f64 = 4e-3;
/// Half of what counts as the middle, and where what lies beside it ends, from the centre \[m\].
const MIDDLE: f64 = 2e-3;
const BESIDE: f64 = 8e-3;

/// More columns to either side than this are of grains that are none.
const COLUMNS_MOST: f64 = 1e5;

/// Slag in a section across the weld.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Slag {
    /// Distance from the centre, and thickness there \[m\], from one side to the other.
    pub(crate) columns: Vec<[f64; 2]>,
}

/// Distance behind the arc at which slag is looked at \[m\] (Komen 2019, fig. 5.32).
pub(crate) const BEHIND: f64 = 10e-3;

impl Slag {
    /// Of the section [`BEHIND`] the arc; none without arc or slag.
    pub(crate) fn behind(flux: &Flux) -> Option<Self> {
        Self::across(flux, flux.weld.source_along()? - BEHIND)
    }

    /// Of the section at `place` \[m\]; none where no slag lies.
    fn across(flux: &Flux, place: f64) -> Option<Self> {
        let all = flux.position.iter().zip(&flux.radius).zip(&flux.state);
        let slag =
            all.filter(|((at, _), state)| **state != POWDER && (at[1] - place).abs() < 0.5 * LONG);
        let centre = flux.weld.middle();
        let slag: Vec<_> = slag
            .map(|((at, radius), _)| [at[0] - centre, *radius])
            .collect();
        Self::of(&slag)
    }

    /// Of grains by their distance from the centre and their radius \[m\].
    fn of(slag: &[[f64; 2]]) -> Option<Self> {
        let wide = 2.0 * slag.iter().map(|[_, radius]| radius).sum::<f64>() / slag.len() as f64;
        let far = slag.iter().map(|[x, _]| x.abs()).reduce(f64::max)?;
        let half = (far.max(BESIDE) / wide).ceil();
        if half > COLUMNS_MOST {
            return None;
        }
        let half = half as usize;
        let mut columns: Vec<[f64; 2]> = (0..2 * half)
            .map(|k| [(k as f64 + 0.5 - half as f64) * wide, 0.0])
            .collect();
        for [x, radius] in slag {
            let k = ((x / wide + half as f64).max(0.0) as usize).min(columns.len() - 1);
            columns[k][1] += 4.0 / 3.0 * PI * radius.powi(3) / (FILLED * wide * LONG);
        }
        Some(Self { columns })
    }

    /// Mean thickness of the columns whose distance from the centre lies in a range \[m\].
    fn mean(&self, [from, to]: [f64; 2]) -> f64 {
        let within = |column: &&[f64; 2]| (from..to).contains(&column[0].abs());
        let found = self.columns.iter().filter(within);
        let (sum, count) = found.fold((0.0, 0), |(sum, count), column| {
            (sum + column[1], count + 1)
        });
        if count > 0 {
            sum / f64::from(count)
        } else {
            0.0
        }
    }

    /// Mean thickness in the middle, and beside it \[m\].
    pub(crate) fn middle_and_beside(&self) -> [f64; 2] {
        [self.mean([0.0, MIDDLE]), self.mean([MIDDLE, BESIDE])]
    }

    /// Whether it is hollow in the middle, by more than a tenth.
    pub(crate) fn is_hollow(&self) -> bool {
        let [middle, beside] = self.middle_and_beside();
        middle < 0.9 * beside
    }

    /// Greatest thickness \[m\].
    pub(crate) fn greatest(&self) -> f64 {
        self.columns
            .iter()
            .map(|column| column[1])
            .fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Grains of 0.5 mm as they lie in layers whose thickness goes with the distance from the centre \[m\].
    fn layer(thick: impl Fn(f64) -> f64) -> Slag {
        let d: f64 = 0.5e-3;
        let each = PI / 6.0 * d.powi(3) / FILLED;
        let mut slag = Vec::new();
        for k in -20..20 {
            let x = (f64::from(k) + 0.5) * d;
            let number = (thick(x) * d * LONG / each).round() as usize;
            slag.extend(vec![[x, 0.5 * d]; number]);
        }
        Slag::of(&slag).unwrap()
    }

    #[test]
    fn a_layer_is_as_thick_as_its_grains_lie() {
        let even = layer(|_| 3e-3);
        assert_eq!(even.columns.len(), 40);
        assert!(
            even.columns
                .iter()
                .all(|[_, h]| (h / 3e-3 - 1.0).abs() < 0.01)
        );
        let [middle, beside] = even.middle_and_beside();
        assert!((middle / beside - 1.0).abs() < 0.01);
        assert!((even.greatest() / 3e-3 - 1.0).abs() < 0.01);
    }

    #[test]
    fn a_hollow_is_seen_and_without_slag_there_is_no_section() {
        let wide = layer(|x| if x.abs() < 4e-3 { 3e-3 } else { 0.0 });
        let [middle, beside] = wide.middle_and_beside();
        assert!((middle / 3e-3 - 1.0).abs() < 0.01 && (beside / 1e-3 - 1.0).abs() < 0.01);
        assert!(!wide.is_hollow());
        let hollow = layer(|x| if x.abs() < 2e-3 { 1e-3 } else { 2.5e-3 });
        let [middle, beside] = hollow.middle_and_beside();
        assert!((middle / 1e-3 - 1.0).abs() < 0.03 && (beside / 2.5e-3 - 1.0).abs() < 0.03);
        assert!(hollow.is_hollow());
        assert_eq!(Slag::of(&[]), None);
        assert_eq!(Slag::of(&[[1e-3, 0.0]]), None);
    }
}
