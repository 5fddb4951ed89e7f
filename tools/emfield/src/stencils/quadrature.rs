//! Integrals over conductors as weighted sums over their points.
//!
//! Each point stands for a cell of which the volume and the first and second moments about the point are known. In a
//! cell a density is its polynomial fit to the points of the conductor,
//! `f = f_i + d . grad f + d . H . d / 2`, so that
//! `int f dV = sum_i (V_i f_i + M_i . grad_i f + M2_i : H_i f / 2) = sum_j W_j f_j`:
//! of third order in the spacing, on the surface as inside, where the sum of `V_i f_i` is of first order.

use wls::{Error, Plan, Rules, Search, Wants};

use crate::cloud::Cell;
use crate::stencils::mirror::Mirror;
use crate::stencils::region::Region;
use crate::stencils::sides::Form;

/// Volume with its moments about a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments<const D: usize> {
    /// Volume \[m3; m2 in a plane\]; 0 where the point stands for nothing.
    pub volume: f64,
    /// First moments \[m4\].
    pub first: [f64; D],
    /// Second moments \[m5\].
    pub second: [[f64; D]; D],
}

impl<const D: usize> Moments<D> {
    /// Those of a cell, in as many coordinates as the equations have.
    #[must_use]
    pub fn of(cell: &Cell) -> Self {
        Self {
            volume: cell.volume,
            first: std::array::from_fn(|a| cell.first[a]),
            second: std::array::from_fn(|a| std::array::from_fn(|b| cell.second[a][b])),
        }
    }
}

/// Fits to points counted in the own medium, where a point stands for a volume: on an interface densities are those of
/// the inner side.
struct Within<'a, const D: usize> {
    region: &'a Region<D>,
    cells: &'a [Moments<D>],
}

impl<const D: usize> Rules<D> for Within<'_, D> {
    fn wanted(&self, i: usize) -> bool {
        self.cells[i].volume > 0.0
    }

    fn allowed(&self, i: usize, j: usize) -> bool {
        self.region.medium(i) == self.region.medium(j)
    }
}

/// Weight of each point in integrals over all conductors \[m3; m2 in a plane\]; 0 at points of no conductor.
///
/// # Errors
/// Where points are alone, coincide or lie in a plane.
pub fn weights<const D: usize>(
    region: &Region<D>,
    cells: &[Moments<D>],
    form: &Form,
) -> Result<Vec<f64>, Error> {
    let mut weights = vec![0.0; region.len()];
    if cells.is_empty() {
        return Ok(weights);
    }
    let wants = Wants {
        gradient: true,
        hessian: true,
        ..Wants::default()
    };
    let mut plan = Plan::new::<D>(form.order.max(2), wants);
    plan.interpolating = true;
    // About an axis all that is integrated is even in the distance from it.
    let mirror = Mirror::new(region);
    let search = Search::new(mirror.cloud())?;
    let fits = mirror.stencils(&search, &plan, &Within { region, cells })?;
    for (i, cell) in cells.iter().enumerate().filter(|(_, c)| c.volume > 0.0) {
        weights[i] += cell.volume;
        for a in 0..D {
            for (j, w) in fits.derivative(i, a).iter() {
                weights[j] += cell.first[a] * w;
            }
            for b in a..D {
                let half = if a == b { 0.5 } else { 1.0 };
                for (j, w) in fits.second(i, a, b).iter() {
                    weights[j] += half * cell.second[a][b] * w;
                }
            }
        }
    }
    Ok(weights)
}
