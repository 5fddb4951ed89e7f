//! Radiation of the arc that surfaces take up.
//!
//! The gas is thin: every cell shines alike in all directions, nothing is absorbed on the way. The
//! scene gives the part of all radiation that is taken up (Komen 2019, section 5.2.3: 12 %); here it
//! is shared out over the surface as the shining cells are seen from it. Neglected: shadows.

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::grid::Grid;
use crate::heat::Contact;

/// Directions around the axis in which a ring of gas is seen; half of them by symmetry.
const DIRECTIONS: usize = 16;

/// Cosine and sine of the directions.
type Around = [[f64; 2]; DIRECTIONS];

fn around() -> Around {
    std::array::from_fn(|k| {
        let angle = PI * (k as f64 + 0.5) / DIRECTIONS as f64;
        [angle.cos(), angle.sin()]
    })
}

/// How strongly a ring at `(r, z)` shines on a surface at `place` with `normal`: the mean over the
/// ring of `cos / (4 pi d^2)` \[1/m2\].
fn seen(place: [f64; 2], normal: [f64; 2], r: f64, z: f64, around: &Around) -> f64 {
    let mut sum = 0.0;
    for [cosine, sine] in around {
        let (x, y) = (r * cosine - place[0], r * sine);
        let height = z - place[1];
        let along = x * normal[0] + height * normal[1];
        if along > 0.0 {
            let square = x * x + y * y + height * height;
            sum += along / (square * square.sqrt());
        }
    }
    sum / (DIRECTIONS as f64 * 4.0 * PI)
}

/// Heat flux that each of `contacts` takes up \[W/m2\], in all the part `absorbed` of `emission`
/// \[W, per cell\].
#[must_use]
pub fn absorbed(grid: &Grid, contacts: &[&Contact], emission: &[f64], absorbed: f64) -> Vec<f64> {
    let total: f64 = emission.iter().sum();
    // Cells far below the mean add nothing that the scale does not restore.
    let bright = total * 1e-3 / emission.len() as f64;
    let shining: Vec<(f64, f64, f64)> = emission
        .iter()
        .enumerate()
        .filter(|(_, e)| **e > bright)
        .map(|(k, e)| (grid.rc[k % grid.nr], grid.zc[k / grid.nr], *e))
        .collect();
    let around = around();
    let on_one = |contact: &&Contact| {
        let parts = shining
            .iter()
            .map(|(r, z, e)| e * seen(contact.place, contact.normal, *r, *z, &around));
        parts.sum::<f64>()
    };
    let flux: Vec<f64> = contacts.par_iter().map(on_one).collect();
    let caught: f64 = flux.iter().zip(contacts).map(|(f, c)| f * c.area).sum();
    let scale = if caught > 0.0 {
        absorbed * total / caught
    } else {
        0.0
    };
    flux.into_iter().map(|f| f * scale).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Spacing, faces};
    use crate::heat::contacts;
    use crate::material::GAS;

    #[test]
    fn a_point_on_the_axis_lights_a_plane_as_the_cosine_over_the_square() {
        for r in [0.0, 1.0, 3.0] {
            let d = (r * r + 4.0_f64).sqrt();
            let want = 2.0 / (4.0 * PI * d.powi(3));
            assert!((seen([r, 0.0], [0.0, 1.0], 0.0, 2.0, &around()) - want).abs() < 1e-14);
        }
        assert!(seen([0.0, 0.0], [0.0, -1.0], 1.0, 2.0, &around()).abs() < 1e-15);
    }

    #[test]
    fn a_wide_plane_sees_half_and_takes_its_part() {
        let even = Spacing::uniform(0.1);
        let grid = Grid::new(faces(&[0.0, 40.0], &even), faces(&[-0.1, 0.0, 1.0], &even));
        let material: Vec<usize> = (0..grid.len())
            .map(|k| if k / grid.nr == 0 { 1 } else { GAS })
            .collect();
        let all = contacts(&grid, &material, |m| (m == 1).then_some(0));
        let all: Vec<&Contact> = all.iter().collect();
        let mut emission = vec![0.0; grid.len()];
        emission[grid.cell(0, 8)] = 5.0;
        let flux = absorbed(&grid, &all, &emission, 0.12);
        let sum: f64 = flux.iter().zip(&all).map(|(f, c)| f * c.area).sum();
        assert!((sum - 0.6).abs() < 1e-12);
        let z = grid.zc[8];
        let half: f64 = all
            .iter()
            .map(|c| c.area * seen(c.place, c.normal, 0.0, z, &around()))
            .sum();
        assert!((half - 0.5).abs() < 0.02, "{half}");
    }
}
