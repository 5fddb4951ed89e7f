//! What of an electric field is kept from step to step: the air, rows far from the surface, and factors.

use krylov::{Ending, Grids, Method, Options, Pair, Rule, System};
use run::Failure;

use super::applied::Applied;
use crate::electric::open::rows::Open;
use crate::liquid::air::{ASLEEP, Air, Place};
use crate::liquid::effort::{Effort, failed};
use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::{Form, Sides};
use crate::surface::fits::Enclosed;

/// Factors that need so many times the products that they needed at first are made anew.
const WORN: u64 = 3;
/// Fewer than these at first count as these.
const LEAST: u64 = 8;

/// What was made for one surface and serves as long as it does not move far.
pub(super) struct Kept {
    pub(super) air: Air,
    /// Stencils of the rows that stay.
    still: Sides<3>,
    system: System<f64, f64>,
    /// Products of the first solve.
    pub(super) first: u64,
    pub(super) worn: bool,
}

/// What is made for each place of the liquid.
pub struct Fitted {
    /// Stencils of the rows that do not stay.
    pub(super) sides: Sides<3>,
    /// Multipoles on the wall far away.
    pub(super) open: Open,
    pairs: Vec<Pair<f64>>,
}

impl Fitted {
    /// Fits about the points of a field.
    pub(super) fn new(air: &Air, region: &Region<3>, form: &Form) -> Result<Self, Failure> {
        let moves = |i: usize| awake(region, i) && !air.stays(i, region.len());
        let sides = Sides::some(region, form, &moves).map_err(|e| failed(&e))?;
        let enclosed = Enclosed::new(region, form, air.ball()).map_err(|e| failed(&e))?;
        let far = |i: usize| matches!(region.kinds[i], Kind::Wall { wall: 0, .. });
        let open = Open::of(region, &enclosed, air.centre, far);
        Ok(Self {
            pairs: open.pairs(),
            sides,
            open,
        })
    }
}

impl Kept {
    /// Air, the rows that stay, and factors for where the liquid is.
    pub(super) fn new(applied: &Applied, form: &Form, place: Place<'_>) -> Result<Self, Failure> {
        let air = Air::new(place.skin);
        let standing = air.standing(place.skin);
        let region = standing.region(place, &air, applied.conducts());
        let stays = |i: usize| air.stays(i, region.len());
        let still = Sides::some(&region, form, &stays).map_err(|e| failed(&e))?;
        let sides = Fitted::new(&air, &region, form)?.sides;
        let of = |i: usize| if stays(i) { &still } else { &sides };
        let (rows, _) = applied.problem(&region, &air).rows_of(&region, of);
        let options = Options {
            method: Method::Multigrid(Grids::default()),
            fluxes: true,
            ..Options::default()
        };
        let system = System::new(rows, Vec::new(), options).map_err(|e| failed(&e))?;
        Ok(Self {
            air,
            still,
            system,
            first: 0,
            worn: false,
        })
    }

    /// Takes the rows where the liquid is now; their right sides.
    pub(super) fn renew(
        &mut self,
        applied: &Applied,
        region: &Region<3>,
        sides: &Sides<3>,
    ) -> Result<Vec<[f64; 1]>, Failure> {
        let points = region.len();
        let of = |i: usize| {
            if self.air.stays(i, points) {
                &self.still
            } else {
                sides
            }
        };
        let (rows, right) = applied.problem(region, &self.air).rows_of(region, of);
        self.system.renew(rows).map_err(|e| failed(&e))?;
        Ok(right)
    }

    /// Solves from the last solution; products that it took.
    pub(super) fn solve(
        &mut self,
        fitted: &Fitted,
        right: &[[f64; 1]],
        x: &mut [f64],
        how: Rule<'_>,
        effort: &mut Effort,
    ) -> Result<u64, Failure> {
        let mut unknown: Vec<[f64; 1]> = x.iter().map(|v| [*v]).collect();
        let solved = self
            .system
            .solve_with(&fitted.pairs, right, &mut unknown, how);
        for (x, found) in x.iter_mut().zip(&unknown) {
            *x = found[0];
        }
        effort.field_products += solved.products as u64;
        effort.field_residual = effort.field_residual.max(solved.worst());
        match solved.ending {
            Ending::Converged => {}
            Ending::BrokenDown(why) => return Err(failed(&format!("electric field: {why}"))),
            _ => effort.field_unsolved += 1,
        }
        Ok(solved.products as u64)
    }

    /// Learns how well the factors serve.
    pub(super) fn judge(&mut self, fresh: bool, products: u64) {
        if fresh {
            self.first = products;
        }
        self.worn = !fresh && products > WORN * self.first.max(LEAST);
    }

    /// Rows that stay, and of each the weights that it has and those made anew, by neighbour in the order of their numbers.
    #[cfg(test)]
    pub(super) fn against_fresh(&self, region: &Region<3>, form: &Form) -> Vec<(usize, [Row; 2])> {
        let stays = |i: usize| self.air.stays(i, region.len());
        let Ok(fresh) = Sides::some(region, form, &stays) else {
            return Vec::new();
        };
        let both = |i: usize| {
            [&self.still, &fresh].map(|sides| {
                let mut row: Row = sides.own.value(i).iter().collect();
                row.sort_by_key(|w| w.0);
                row
            })
        };
        let rows = (0..region.len()).filter(|i| stays(*i));
        rows.map(|i| (i, both(i))).collect()
    }
}

/// Neighbours with their weights.
#[cfg(test)]
pub(super) type Row = Vec<(usize, f64)>;

pub(super) fn awake(region: &Region<3>, i: usize) -> bool {
    !matches!(region.kinds[i], Kind::Inside(ASLEEP))
}
