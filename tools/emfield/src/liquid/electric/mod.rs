//! The electric field about a liquid, and its traction on the surface: a function of where the surface and the points are.
//!
//! `div(eps grad V) = 0` inside and in the air (2.60, Matsuzawa 2017), V = -E.x and multipoles on a wall far away. Outward along
//! the normal the surface is pulled by, with S the ratio of the permittivities and fields inside (the errata's form of 2.62),
//!
//! ```text
//! eps0 (S - 1)/2 (S En^2 + Et^2),        of a conductor eps0 En^2/2 of the field outside.
//! ```
//!
//! A conductor has the potential that its charge Q asks for: V = V_0 + U V_1, V_1 of unit potential on it and none far away.
//! There is no tangential traction in either case. Several conductors have potentials of their own (`electric/several.rs`).
//!
//! Where charges leak faster than the liquid moves (Taylor 1966, Melcher and Taylor 1969), `div(sigma grad V) = 0` and the charge of the
//! surface is `q = eps0 (E_n - S E_n,in)`: with the ratio R of the conductivities `E_n = R E_n,in`, and the surface is pulled by
//!
//! ```text
//! eps0/2 (E_n^2 - S E_n,in^2 + (S - 1) Et^2)    outward,        q E_t    along it.
//! ```
//!
//! That the flow carries the charge is left out: it does where `eps0 u/(sigma R)` of the air and of the liquid are not small.

mod applied;
mod kept;
mod several;
mod state;

#[cfg(test)]
mod tests;

use krylov::Rule;
use run::Failure;

pub use applied::Applied;
pub use kept::Fitted;
use kept::{Kept, awake};
pub use several::Drops;
use several::outward;
pub use state::State;

use super::air::{Air, Place};
use super::effort::Effort;
use super::vector::dot;
use crate::electric::traction::{EPS0, dielectric, electrode, leaky};
use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::{Form, Sides};

/// The points of a field where the liquid is.
pub struct Stood {
    region: Region<3>,
    /// Its air was made for it.
    fresh: bool,
}

/// The field, with what it keeps from one place of the liquid to the next.
pub struct Electric {
    /// What acts, and on what.
    pub applied: Applied,
    form: Form,
    kept: Option<Kept>,
    /// What a resumed run goes on from.
    state: State,
    /// Potential of each conductor \[V\].
    pub heights: Vec<f64>,
    /// Drops apart from each other; none where all is one.
    pub drops: Option<Drops>,
    /// Traction along the surface \[Pa\]; nothing where nothing leaks.
    pub drag: Vec<[f64; 3]>,
    /// Charge of the surface of a conductor \[C/m2\].
    pub charge: Vec<f64>,
    /// Points that were awake in the last solve.
    pub awake: u64,
}

impl Electric {
    /// A field that knows no liquid yet, by fits of this degree.
    #[must_use]
    pub fn new(applied: Applied, order: u8) -> Self {
        let form = Form {
            order,
            ..Form::default()
        };
        Self {
            applied,
            form: form.for_harmonics(3),
            kept: None,
            state: State::default(),
            heights: Vec::new(),
            drops: None,
            drag: Vec::new(),
            charge: Vec::new(),
            awake: 0,
        }
    }

    /// Force on the liquid as a whole \[N\].
    #[must_use]
    pub fn force(&self) -> [f64; 3] {
        self.applied.field.map(|e| e * self.applied.charge)
    }

    /// How often the air was made.
    #[must_use]
    pub fn renewed(&self) -> u64 {
        self.state.renewed
    }

    /// Points of the field where the liquid is now; the air is made anew where the surface has left it, or its factors no
    /// longer serve.
    ///
    /// # Errors
    /// Where fits or equations cannot be made.
    pub fn stand(&mut self, place: Place<'_>) -> Result<Stood, Failure> {
        let same = self.state.fits(place, self.units());
        let serves = |kept: &Kept| same && !kept.worn && !kept.air.outrun(place.skin);
        let served = self.kept.take().filter(serves);
        let fresh = served.is_none();
        let kept = match served {
            Some(kept) => kept,
            None => Kept::new(&self.applied, &self.form, place)?,
        };
        let standing = kept.air.standing(place.skin);
        let region = standing.region(place, &kept.air, self.applied.conducts());
        if fresh {
            // First guess: the applied field alone.
            let guess = self.applied.potential(&region, &kept.air);
            self.state.begin(place, guess, self.units());
        }
        self.kept = Some(kept);
        Ok(Stood { region, fresh })
    }

    /// Fits of the rows that do not stay, and of the multipoles.
    ///
    /// # Errors
    /// Where fits cannot be made, and where nothing stands.
    pub fn fit(&self, stood: &Stood) -> Result<Fitted, Failure> {
        let air = &self.kept.as_ref().ok_or_else(unmade)?.air;
        Fitted::new(air, &stood.region, &self.form)
    }

    /// Points of the field of a liquid as it is, the liquid's own among them.
    #[must_use]
    pub fn count(&self, place: Place<'_>) -> u64 {
        let air = Air::new(place.skin);
        let standing = air.standing(place.skin);
        let region = standing.region(place, &air, self.applied.conducts());
        region.len() as u64
    }

    /// Traction on each surface point, outward along its normal \[Pa\].
    ///
    /// # Errors
    /// Where the equations have no solution, and where nothing stands.
    pub fn traction(
        &mut self,
        stood: &Stood,
        fitted: &Fitted,
        how: Rule<'_>,
        effort: &mut Effort,
    ) -> Result<Vec<f64>, Failure> {
        let potential = self.potential(stood, fitted, how, effort)?;
        let (pulls, drag) = self.pulls(&stood.region, &fitted.sides, &potential);
        self.drag = drag;
        if self.applied.conducts() {
            let field = |i| outward(&fitted.sides, &stood.region, &potential, i);
            self.charge = (0..pulls.len()).map(|i| EPS0 * field(i)).collect();
        }
        Ok(pulls)
    }

    /// The potential by point \[V\].
    fn potential(
        &mut self,
        stood: &Stood,
        fitted: &Fitted,
        how: Rule<'_>,
        effort: &mut Effort,
    ) -> Result<Vec<f64>, Failure> {
        let region = &stood.region;
        let units: Vec<_> = (0..self.units()).map(|k| self.unit(region, k)).collect();
        let (kept, last) = (
            self.kept.as_mut().ok_or_else(unmade)?,
            &mut self.state.potential,
        );
        let mut right = kept.renew(&self.applied, region, &fitted.sides)?;
        let without = self.applied.potential(region, &kept.air);
        fitted.open.applied(&without, &mut right);
        self.awake = (0..region.len()).filter(|i| awake(region, *i)).count() as u64;
        let mut products = kept.solve(fitted, &right, &mut last[0], how, effort)?;
        let mut potential = last[0].clone();
        if self.applied.conducts() {
            for (unit, last) in units.iter().zip(&mut last[1..]) {
                products += kept.solve(fitted, unit, last, how, effort)?;
            }
        }
        kept.judge(stood.fresh, products);
        if self.applied.conducts() {
            self.heights = self.heights(stood, fitted, &without)?;
            for (height, unit) in self.heights.iter().zip(&self.state.potential[1..]) {
                for (v, unit) in potential.iter_mut().zip(unit) {
                    *v += height * unit;
                }
            }
        }
        Ok(potential)
    }

    /// Tractions of a potential: outward, and along the surface where charges leak.
    fn pulls(
        &self,
        region: &Region<3>,
        sides: &Sides<3>,
        potential: &[f64],
    ) -> (Vec<f64>, Vec<[f64; 3]>) {
        let field = |of: &wls::Stencils<3>, i: usize| of.gradient_of(potential, i).map(|g| -g);
        let on = |kind: &&Kind| matches!(kind, Kind::Interface(_) | Kind::Wall { wall: 1, .. });
        // Points of the surface come first.
        let surface = region.kinds.iter().take_while(on).count();
        let mut drag = Vec::new();
        let mut pulls = Vec::with_capacity(surface);
        for i in 0..surface {
            let n = region.wall_normals[i];
            let both = || [field(&sides.inner, i), field(&sides.outer, i)];
            pulls.push(match (self.applied.permittivity, self.applied.leak) {
                (Some(s), Some(ratio)) => {
                    let (out, along) = leaky([s, ratio], both(), n);
                    drag.push(along);
                    out
                }
                (Some(s), None) => dot(&dielectric([s, 1.0], both(), n), &n),
                (None, _) => dot(&electrode(1.0, field(sides.at_walls(), i), n), &n),
            });
        }
        (pulls, drag)
    }
}

fn unmade() -> Failure {
    Failure::Other("electric field: no points stand yet".to_owned())
}
