//! Stencils that keep to one side of an interface.

use wls::{Error, Plan, Reach, Report, Search, Stencils, Wants};

use crate::stencils::mirror::Mirror;
use crate::stencils::region::{Harmonic, Kind, Own, Part, Region, Side};

/// Radius of the support of cubics over the spacing, for potentials.
const CUBIC_REACH: f64 = 3.0;

/// Radius of the support of quartics over the spacing, for potentials: about 180 points in space.
const QUARTIC_REACH: f64 = 3.5;

/// Radius of the support of harmonic cubics and quartics over the spacing, in a plane and in space: 4 to 5 points for
/// each coefficient.
const HARMONIC_REACH: [f64; 2] = [3.0, 2.75];

/// How stencils are made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Form {
    /// Degree of the polynomials, 1 to 4; second derivatives are those of quadratics at least.
    pub order: u8,
    /// Radius of the support over the spacing; as the order needs it where it is absent.
    pub support: Option<f64>,
    /// Weights of the Laplacian of other points are not negative where that is possible.
    pub positive: bool,
    /// The field has no Laplacian on either side of an interface, and so have the polynomials there: never about an axis,
    /// where the equation has first derivatives.
    pub harmonic: bool,
    /// How many times `1/r d/dr` the equation has about an axis: 1 of a potential, 3 of `A_phi / r`.
    pub around: f64,
}

impl Default for Form {
    fn default() -> Self {
        Self {
            order: 2,
            support: None,
            positive: false,
            harmonic: false,
            around: 1.0,
        }
    }
}

impl Form {
    /// For potentials, where a shift does not help the Laplacian: the fewest points that cubics and quartics can do with
    /// give it eigenvalues of the wrong sign.
    #[must_use]
    pub fn for_potentials(self) -> Self {
        let reach = match self.order {
            ..3 => None,
            3 => Some(CUBIC_REACH),
            _ => Some(QUARTIC_REACH),
        };
        Self {
            support: self.support.or(reach),
            ..self
        }
    }

    /// For potentials that have no Laplacian inside any medium: of order 3 and 4 the polynomials themselves are harmonic,
    /// 16 and 25 coefficients in space instead of 20 and 35. Quadratics keep their Laplacian.
    #[must_use]
    pub fn for_harmonics(self, dimensions: usize) -> Self {
        let reach = (self.order > 2).then(|| HARMONIC_REACH[dimensions - 2]);
        Self {
            support: self.support.or(reach),
            harmonic: true,
            ..self
        }
    }

    /// Whether equations inside media compare values with polynomials, which are harmonic.
    #[must_use]
    pub fn compares(&self) -> bool {
        self.harmonic && self.order > 2
    }

    /// A plan for places between the points: the polynomial passes through no value. Where harmonic ones compare a fine
    /// lattice with a coarse one, neither leads for its mere number of points.
    pub(crate) fn between<const D: usize>(&self, wants: Wants) -> Plan {
        Plan {
            interpolating: false,
            by_room: self.compares(),
            ..self.plan::<D>(wants)
        }
    }

    pub(crate) fn plan<const D: usize>(&self, wants: Wants) -> Plan {
        let order = if wants.laplacian {
            self.order.max(2)
        } else {
            self.order
        };
        let mut plan = Plan::new::<D>(order, wants);
        if let Some(radius) = self.support {
            plan.reach = Reach::Radius(radius);
        }
        // With the own point exact the Laplacian of a lattice has no positive eigenvalue; with the own point as one among
        // others it has.
        plan.interpolating = true;
        plan.positive = self.positive && wants.laplacian;
        plan
    }
}

/// Stencils of all points.
#[derive(Debug, Clone)]
pub struct Sides<const D: usize> {
    /// Gradient and Laplacian inside media, gradient on walls; where polynomials are harmonic, gradient and value inside
    /// media.
    pub own: Stencils<D>,
    /// Gradient on walls, where polynomials are harmonic.
    pub wall: Option<Stencils<D>>,
    /// Gradient at interfaces from the side that the normal leaves.
    pub inner: Stencils<D>,
    /// Gradient at interfaces from the other side.
    pub outer: Stencils<D>,
}

impl<const D: usize> Sides<D> {
    /// Makes them.
    ///
    /// # Errors
    /// Where points are alone, coincide or lie in a plane.
    pub fn new(region: &Region<D>, form: &Form) -> Result<Self, Error> {
        Self::some(region, form, &|_| true)
    }

    /// Makes those of some points; the others have none.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn some(
        region: &Region<D>,
        form: &Form,
        wanted: &(dyn Fn(usize) -> bool + Sync),
    ) -> Result<Self, Error> {
        let mirror = Mirror::new(region);
        let search = Search::new(mirror.cloud())?;
        let gradient = Wants {
            gradient: true,
            ..Wants::default()
        };
        let both = Wants {
            laplacian: true,
            hessian: region.axial || !region.bent.is_empty(),
            ..gradient
        };
        let harmonic = |walls: bool| Harmonic { region, walls };
        let (own, wall) = if form.compares() {
            let plan = form.between::<D>(Wants {
                value: true,
                ..gradient
            });
            let some = |walls| Part {
                rules: harmonic(walls),
                wanted,
            };
            let own = mirror.stencils(&search, &plan, &some(false))?;
            let wall = form.plan::<D>(gradient);
            let wall = mirror.stencils(&search, &wall, &some(true))?;
            (own, Some(wall))
        } else {
            let rules = Part {
                rules: Own(region),
                wanted,
            };
            let own = mirror.stencils(&search, &form.plan::<D>(both), &rules)?;
            (own, None)
        };
        let side = |inner: bool| {
            let rules = Side {
                region,
                inner,
                harmonic: form.harmonic,
                still: form.order > 2,
                around: form.around,
            };
            let rules = Part { rules, wanted };
            mirror.stencils(&search, &form.plan::<D>(gradient), &rules)
        };
        Ok(Self {
            own,
            wall,
            inner: side(true)?,
            outer: side(false)?,
        })
    }

    /// Slopes and second derivatives inside media and on walls of some points: fits that points take with them when they move
    /// ([`wls::Moved`]). Not for forms that compare harmonic polynomials.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn bearing(
        region: &Region<D>,
        form: &Form,
        wanted: &(dyn Fn(usize) -> bool + Sync),
    ) -> Result<Stencils<D>, Error> {
        let mirror = Mirror::new(region);
        let search = Search::new(mirror.cloud())?;
        let all = Wants {
            gradient: true,
            hessian: true,
            laplacian: true,
            ..Wants::default()
        };
        let rules = Part {
            rules: Own(region),
            wanted,
        };
        mirror.stencils(&search, &form.plan::<D>(all), &rules)
    }

    /// What became of the rows of all of them.
    #[must_use]
    pub fn report(&self) -> Report {
        let one_sided = self.inner.report().with(self.outer.report());
        let all = self.own.report().with(&one_sided);
        self.wall
            .as_ref()
            .map_or(all, |wall| all.with(wall.report()))
    }

    /// Gradient on walls.
    #[must_use]
    pub fn at_walls(&self) -> &Stencils<D> {
        self.wall.as_ref().unwrap_or(&self.own)
    }

    /// Gradient of a field without a Laplacian at every point: on interfaces from the inner, or from
    /// the outer side.
    #[must_use]
    pub fn gradients<T>(&self, region: &Region<D>, field: &[T], inner: bool) -> Vec<[T; D]>
    where
        T: wls::Field + Send + Sync,
    {
        use rayon::prelude::*;
        let side = if inner { &self.inner } else { &self.outer };
        (0..region.len())
            .into_par_iter()
            .map(|i| match region.kinds[i] {
                Kind::Interface(_) => side.gradient_of(field, i),
                Kind::Wall { .. } => self.at_walls().gradient_of(field, i),
                Kind::Inside(_) => self.own.gradient_of(field, i),
            })
            .collect()
    }
}

/// Adds `factor` times the derivative along `normal` at point `i` to a row.
pub(crate) fn along_normal<const D: usize>(
    stencils: &Stencils<D>,
    i: usize,
    normal: [f64; D],
    factor: f64,
    mut add: impl FnMut(usize, f64),
) {
    for (axis, n) in normal.iter().enumerate() {
        for (j, w) in stencils.derivative(i, axis).iter() {
            add(j, factor * n * w);
        }
    }
}

/// What a Laplacian of 1 at the interface point `i` adds to the derivative along `normal`.
pub(crate) fn share_along<const D: usize>(
    stencils: &Stencils<D>,
    i: usize,
    normal: [f64; D],
) -> f64 {
    let share = |axis: usize| stencils.derivative(i, axis).conditions().sum::<f64>();
    (0..D).map(|axis| normal[axis] * share(axis)).sum()
}
