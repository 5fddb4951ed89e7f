//! The height of a free surface over the face across: a sum of waves that fit into the room, by least squares.
//!
//! Between mirrors `cos(k pi s)`, between periodic faces `cos` and `sin` of `2 pi k s`, with s from 0 to 1.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::{Room, Side};

/// Waves along an axis at most.
const WAVES: usize = 6;
/// Surface points for each term at least.
const ENOUGH: usize = 3;

/// A wave along an axis: its number, and whether it is a sine.
type Wave = (usize, bool);

/// The surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Volume of the liquid \[m3; m2 in a plane\].
    pub volume: f64,
    /// Mean height over the face across \[m\].
    pub height: f64,
    /// Amplitude of the waves along one axis alone: axis, number, between mirrors with its sign \[m\].
    pub waves: Vec<(usize, usize, f64)>,
    /// Root of the mean square of what the waves leave \[m\].
    pub residual: f64,
}

impl Level {
    /// That of the points of the surface; none where there is no free face or points do not tell it.
    #[must_use]
    pub fn new<const D: usize>(room: &Room<D>, points: &[[f64; D]]) -> Option<Self> {
        let (free, up) = room.free()?;
        let axes: Vec<usize> = (0..D).filter(|k| *k != free).collect();
        let most = (points.len() / ENOUGH) as f64;
        let each = most.powf((axes.len() as f64).recip()) as usize;
        let waves: Vec<Vec<Wave>> = axes
            .iter()
            .map(|&k| waves(room.sides[k][0] == Side::Periodic, each))
            .collect();
        // Terms: a wave along each of the axes.
        let mut terms: Vec<Vec<Wave>> = vec![Vec::new()];
        for line in &waves {
            let longer = terms.iter().flat_map(|t| {
                line.iter()
                    .map(move |w| t.iter().copied().chain([*w]).collect())
            });
            terms = longer.collect();
        }
        let value = |x: &[f64; D], term: &[Wave]| -> f64 {
            let factors = term.iter().zip(&axes).map(|((number, sine), &k)| {
                let s = (x[k] - room.min[k]) / room.length(k);
                let periodic = room.sides[k][0] == Side::Periodic;
                let angle = PI * *number as f64 * s * if periodic { 2.0 } else { 1.0 };
                if *sine { angle.sin() } else { angle.cos() }
            });
            factors.product()
        };
        let basis = DMatrix::from_fn(terms.len(), points.len(), |m, i| {
            value(&points[i], &terms[m])
        });
        let height = |x: &[f64; D]| match up {
            true => x[free] - room.min[free],
            false => room.max[free] - x[free],
        };
        let heights = DVector::from_iterator(points.len(), points.iter().map(height));
        let gram = &basis * basis.transpose();
        let found = gram.cholesky()?.solve(&(&basis * &heights));
        let left = heights - basis.tr_mul(&found);
        let base: f64 = axes.iter().map(|&k| room.length(k)).product();
        let mut alone: Vec<(usize, usize, f64)> = Vec::new();
        for (term, c) in terms.iter().zip(found.iter()) {
            let mut moving = term.iter().zip(&axes).filter(|((n, _), _)| *n > 0);
            let (Some(((number, _), &axis)), None) = (moving.next(), moving.next()) else {
                continue;
            };
            match alone.iter_mut().find(|w| w.0 == axis && w.1 == *number) {
                Some(wave) => wave.2 = wave.2.hypot(*c),
                None => alone.push((axis, *number, *c)),
            }
        }
        Some(Self {
            volume: base * found[0],
            height: found[0],
            waves: alone,
            residual: left.norm() / (points.len() as f64).sqrt(),
        })
    }
}

/// Waves along an axis, of which there are at most `most`; the first is even.
fn waves(periodic: bool, most: usize) -> Vec<Wave> {
    let mut waves = vec![(0, false)];
    let each = if periodic { 2 } else { 1 };
    for number in 1..=WAVES {
        if waves.len() + each > most {
            break;
        }
        waves.push((number, false));
        if periodic {
            waves.push((number, true));
        }
    }
    waves
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_between_mirrors_tells_its_amplitude_and_the_volume() {
        let room = Room::<2> {
            min: [1.0, 0.0],
            max: [3.0, 0.5],
            sides: [[Side::Mirror; 2], [Side::Mirror, Side::Open]],
            ..Room::default()
        };
        let each = (0..40).map(|k| 1.0 + 0.05 * (f64::from(k) + 0.3));
        let points: Vec<[f64; 2]> = each
            .map(|x| [x, 0.6 - 0.02 * (PI * (x - 1.0)).cos()])
            .collect();
        let level = Level::new(&room, &points).unwrap();
        assert!((level.volume - 1.2).abs() < 1e-12 && level.residual < 1e-12);
        let second = level.waves.iter().find(|w| w.1 == 2).unwrap();
        assert!((second.2 + 0.02).abs() < 1e-12);
        assert!(Level::new(&Room::<2>::default(), &points).is_none());
    }
}
