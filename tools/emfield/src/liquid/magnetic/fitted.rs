//! Fits about the points of the field where the liquid is.
//!
//! Points inside media take those of the ball with them ([`wls::Moved`]). On the surface one-sided slopes know the Laplacian of where
//! they are: these fits are made anew, as are those where the move strains much.

use krylov::Rows;
use num_complex::Complex;
use wls::{Error, Moved};

use super::mould::Ball;
use crate::magnetic::diffusion::{Conductors, shift};
use crate::magnetic::unknown::Unknown;
use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::{Form, Sides};

/// Fits are made anew where the move strains more than this.
const STRAIN: f64 = 0.2;

/// Fits where the liquid is.
pub struct Fitted {
    /// Of points whose fits are made anew, and of all in the liquid.
    pub(super) sides: Sides<3>,
    /// What the move does about points that take their fits with them.
    moved: Moved<3>,
}

impl Fitted {
    /// Fits of the points of a ball that do not stay, where they have come to lie.
    pub(super) fn new(ball: &Ball, region: &Region<3>, form: &Form) -> Result<Self, Error> {
        Self::within(ball, region, form, STRAIN)
    }

    /// The same with another bound of the strain.
    pub(super) fn within(
        ball: &Ball,
        region: &Region<3>,
        form: &Form,
        strain: f64,
    ) -> Result<Self, Error> {
        let moved = Moved::new(ball.bears(), &region.places).within(strain);
        let borne = |i: usize| moved.strain(i).is_some();
        let anew = |i: usize| !ball.stays(i) && !borne(i);
        let mut sides = Sides::some(region, form, &anew)?;
        let inside = |i: usize| region.kinds[i] == Kind::Inside(1) && borne(i);
        moved.fill(ball.bears(), &mut sides.own, inside);
        Ok(Self { sides, moved })
    }

    /// Rows of the potential about a ball whose points lie in a region now, and what rates add to them.
    pub(super) fn rows(
        &self,
        conductors: &Conductors,
        ball: &Ball,
        region: &Region<3>,
        omega: f64,
    ) -> (Rows<f64>, Vec<Complex<f64>>) {
        let Self { sides, moved } = self;
        let of = |i: usize| if ball.stays(i) { ball.still() } else { sides };
        let inside = |i: usize, row: &mut Vec<(u32, f64)>| {
            if moved.strain(i).is_some() {
                let carried = moved.laplacian(ball.bears(), i);
                row.extend(carried.map(|(j, w)| (j as u32, w)));
            } else {
                let plain = of(i).own.laplacian(i).iter();
                row.extend(plain.map(|(j, w)| (j as u32, w)));
            }
        };
        let rows = conductors.rows_with(region, of, inside, Unknown::Potential);
        let rates = conductors.rates(region, sides, Unknown::Potential);
        (rows, shift(&rates, omega))
    }
}

#[cfg(test)]
impl Fitted {
    /// Points that take their fits with them.
    pub(crate) fn carries(&self) -> usize {
        let all = 0..self.moved.len();
        all.filter(|i| self.moved.strain(*i).is_some()).count()
    }
}
