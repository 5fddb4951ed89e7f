//! Rows of eddy currents in a plane with the weights of [`crate::magnetic::waves::weights`].
//!
//! Inside conductors the row is `sum_j W_j (A + A_s)_j - j w mu sigma (A + A_s)_i = 0`, so that what sources give through the
//! weights stands on the right. Of `H_z` slopes at interfaces and around holes have such weights too, which need no Laplacian
//! of the equation, so that no rate is left of it there. All other rows stay.

use krylov::Rows;
use rayon::prelude::*;

use crate::magnetic::diffusion::{Conductors, Ground};
use crate::magnetic::source::C;
use crate::magnetic::unknown::Unknown;
use crate::magnetic::waves::weights::{Target, Waves};
use crate::stencils::region::{Face, Kind};
use crate::stencils::sides::along_normal;

/// Rows with waves, and what belongs to them.
pub struct WaveRows<const K: usize> {
    /// The rows.
    pub rows: Rows<C>,
    /// What stands before the rate of each, as in [`Conductors::at`].
    pub rates: Vec<f64>,
    /// What sources give through the weights, by point.
    pub source: Vec<[C; K]>,
}

/// One row, and what stands before its rate.
type Waved = (Vec<(u32, C)>, f64);

impl<const D: usize> Ground<'_, D> {
    /// Rows with waves, in place of those without and what stands before their rates.
    #[must_use]
    pub fn rows<const K: usize>(
        &self,
        conductors: &Conductors,
        waves: &Waves,
        plain: &Rows<f64>,
        mut rates: Vec<f64>,
        source: &[[C; K]],
    ) -> WaveRows<K> {
        let all: Vec<Option<Waved>> = (0..plain.len())
            .into_par_iter()
            .map(|i| self.row(conductors, waves, i, plain))
            .collect();
        for (rate, own) in rates.iter_mut().zip(&all) {
            *rate = own.as_ref().map_or(*rate, |own| own.1);
        }
        let given = |row: &Option<Waved>| {
            let mut sum = [C::new(0.0, 0.0); K];
            for (j, w) in row.iter().flat_map(|row| &row.0) {
                sum = std::array::from_fn(|k| sum[k] + w * source[*j as usize][k]);
            }
            sum
        };
        let source = all.iter().map(given).collect();
        let rows = Rows::gathered(plain.len(), C::new(0.0, 0.0), |i, row| match &all[i] {
            Some((own, _)) => row.extend_from_slice(own),
            None => row.extend(plain.pairs(i).map(|(j, w)| (j as u32, C::from(w)))),
        });
        WaveRows {
            rows,
            rates,
            source,
        }
    }

    /// The row of a point; none where it stays.
    fn row(
        &self,
        conductors: &Conductors,
        waves: &Waves,
        i: usize,
        plain: &Rows<f64>,
    ) -> Option<Waved> {
        let region = self.region;
        if conductors.held(region, self.unknown, i) {
            return None;
        }
        if let Some((hole, media)) = conductors.hole(i) {
            if hole.first as usize != i {
                return None;
            }
            let mut row = Vec::new();
            for (face, part, medium, normal) in hole.rim(region, media) {
                let part = part * media.resistivity[medium as usize];
                row.extend(self.slope(waves, face, medium, normal, part)?);
            }
            return Some((row, hole.through(region, media)));
        }
        match region.kinds[i] {
            Kind::Inside(medium) => {
                let base: Vec<(usize, f64)> = plain.pairs(i).collect();
                let row = waves.weights(region, i, medium, &base, Target::Laplacian)?;
                Some((row, conductors.mu_sigma[medium as usize]))
            }
            Kind::Interface(number) if self.unknown == Unknown::Axial => {
                let face = &region.faces[number as usize];
                let mut row = Vec::new();
                for (medium, sign) in [(face.inner, 1.0), (face.outer, -1.0)] {
                    let part = sign * conductors.weight(medium);
                    row.extend(self.slope(waves, face, medium, face.normal, part)?);
                }
                Some((row, 0.0))
            }
            _ => None,
        }
    }

    /// A part of the slope along a direction at a face, from within a medium.
    fn slope(
        &self,
        waves: &Waves,
        face: &Face<D>,
        medium: u16,
        way: [f64; D],
        part: f64,
    ) -> Option<Vec<(u32, C)>> {
        let stencils = match medium == face.inner {
            true => &self.sides.inner,
            false => &self.sides.outer,
        };
        let i = face.point as usize;
        let neighbours = stencils.neighbours(i).iter();
        let mut base: Vec<(usize, f64)> = neighbours.map(|j| (*j as usize, 0.0)).collect();
        let mut next = 0;
        along_normal(stencils, i, way, 1.0, |_, w| {
            // Of all axes the neighbours are the same.
            base[next].1 += w;
            next = (next + 1) % base.len();
        });
        let target = Target::Along([way[0], way[1]]);
        let mut row = waves.weights(self.region, i, medium, &base, target)?;
        row.iter_mut().for_each(|(_, w)| *w *= part);
        Some(row)
    }
}
