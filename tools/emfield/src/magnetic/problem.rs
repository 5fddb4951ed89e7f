//! What eddy currents are computed with: points, stencils, conductors, and what drives them.

use run::{Failure, Session};

use super::diffusion::{Axial, Conductors, Ground};
use super::driven::bar::Bar;
use super::driven::winding::Windings;
use super::holes::Holes;
use super::medium::interface::{Acting, Permeable};
use super::medium::law::Law;
use super::parameters::Parameters;
use super::saturation::places::level;
use super::source::{C, Origin, Source};
use super::unknown::Unknown;
use super::waves::weights::Waves;
use crate::cloud::Cloud;
use crate::solve::supports;
use crate::stencils::quadrature::{self, Moments};
use crate::stencils::region::Region;
use crate::stencils::sides::{Form, Sides};
use crate::stencils::unfit::no_stencil;
use crate::surface::enclosing::Enclosing;
use crate::surface::fits::{self, Enclosed};

/// What eddy currents are computed with, in `D` coordinates.
pub(crate) struct Problem<'a, const D: usize> {
    pub(crate) parameters: &'a Parameters,
    pub(crate) cloud: &'a Cloud,
    /// What coils and applied fields give, a uniform one counted from the centre of what conducts.
    pub(crate) source: Source,
    pub(crate) region: Region<D>,
    pub(crate) sides: Sides<D>,
    pub(crate) conductors: Conductors,
    /// Whether a magnetic field acts on a medium.
    acts: Vec<bool>,
    /// Weights of points in integrals over conductors.
    pub(crate) weights: Vec<f64>,
    /// What conductors carry in a sinusoidal steady state in a plane; none elsewhere.
    pub(crate) waves: Option<Waves>,
    /// Currents that are given in coils of points, where there are some.
    pub(crate) windings: Option<Windings>,
    /// Bars whose net current is given.
    pub(crate) bars: Vec<Bar>,
    /// Surfaces around bodies.
    pub(crate) enclosed: Vec<Enclosed<D>>,
}

impl<'a, const D: usize> Problem<'a, D> {
    /// Stencils and weights of points; `around` are surfaces through which forces are wanted.
    ///
    /// # Errors
    /// Where a stencil cannot be made.
    pub(crate) fn new(
        parameters: &'a Parameters,
        cloud: &'a Cloud,
        region: Region<D>,
        around: Vec<Enclosing>,
        session: &mut Session,
    ) -> Result<Self, Failure> {
        let unknown = parameters.unknown;
        let form = Form {
            around: unknown.around(),
            ..parameters.numerics.form
        };
        let made = session.timed("weights", || {
            let cells: Vec<Moments<D>> = cloud.cells.iter().map(Moments::of).collect();
            let weights = quadrature::weights(&region, &cells, &form)?;
            Ok((Sides::new(&region, &form)?, weights))
        });
        let failed = |error: wls::Error| no_stencil("eddy currents", &error, cloud);
        let (sides, mut weights) = made.map_err(failed)?;
        supports("vector_potential", &sides.report(), session);
        let conductors = conductors(parameters, &region, &sides);
        let mut source = parameters.source.clone();
        if D == 2 && unknown == Unknown::Potential {
            centre(&mut source, &region, &weights, &conductors);
        }
        let bar = |(medium, current): &(u16, C)| {
            let sigma = parameters.conductivity[*medium as usize];
            Bar::new(&region, &weights, *medium, sigma, *current)
        };
        let bars = parameters.bars.iter().map(bar).collect();
        let conducts = parameters.conductivity.iter().map(|s| *s > 0.0);
        let acts = conducts.zip(&parameters.magnetic).map(|(c, m)| c || *m);
        let coils = &parameters.coils;
        let wound = || Windings::new(&region, coils, &mut weights);
        Ok(Self {
            waves: waves(parameters, &conductors, &region),
            windings: (!coils.is_empty()).then(wound),
            acts: acts.collect(),
            bars,
            enclosed: fits::all(around, &region, &form, session)?,
            sides,
            weights,
            source,
            conductors,
            region,
            cloud,
            parameters,
        })
    }

    /// Its points, their stencils and what is sought.
    pub(crate) fn ground(&self) -> Ground<'_, D> {
        Ground {
            region: &self.region,
            sides: &self.sides,
            unknown: self.parameters.unknown,
        }
    }

    /// What fields act on.
    pub(crate) fn acting(&self) -> Acting<'_> {
        Acting {
            acts: &self.acts,
            laws: &self.parameters.laws,
            permeable: self.conductors.permeable.as_ref(),
        }
    }

    /// Conductivity times volume by point, up to a factor: what the square of a rate is weighted with in the heat.
    pub(crate) fn heating(&self) -> Vec<f64> {
        let weight =
            |(i, w): (usize, &f64)| w.max(0.0) * self.conductors.current(self.region.medium(i));
        self.weights.iter().enumerate().map(weight).collect()
    }

    /// A rate than which no currents decay more slowly \[1/s\]: `1/(mu sigma D^2)`, with the greatest extent of all conductors. A ball
    /// of that diameter decays 39 times as fast; what iron and bars far from their return slow down is within that.
    pub(crate) fn slowest(&self) -> f64 {
        let mut reach = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let mut most = 0.0_f64;
        for (i, x) in self.cloud.position.iter().enumerate() {
            let own = self.conductors.mu_sigma[usize::from(self.region.medium(i))];
            if own > 0.0 {
                most = most.max(own);
                for k in 0..3 {
                    reach[0][k] = reach[0][k].min(x[k]);
                    reach[1][k] = reach[1][k].max(x[k]);
                }
            }
        }
        let squares = |sum: f64, k: usize| sum + (reach[1][k] - reach[0][k]).powi(2);
        let extent = (0..3).fold(0.0, squares);
        if extent.is_finite() && most * extent > 0.0 {
            1.0 / (most * extent)
        } else {
            0.0
        }
    }

    /// The points, if they have three coordinates.
    pub(crate) fn in_space(&self) -> Option<&Region<3>> {
        (&self.region as &dyn std::any::Any).downcast_ref()
    }

    /// Their stencils, if they have three coordinates.
    pub(crate) fn sides_in_space(&self) -> Option<&Sides<3>> {
        (&self.sides as &dyn std::any::Any).downcast_ref()
    }
}

/// Counts the potential of a uniform field in a plane from the centre of what conducts, so that no current flows along a
/// conductor as a whole, wherever it is: what carries it back is out of sight.
fn centre<const D: usize>(
    source: &mut Source,
    region: &Region<D>,
    weights: &[f64],
    conductors: &Conductors,
) {
    let mut sums = [0.0; 3];
    let mut whole = 0.0;
    for (i, w) in weights.iter().enumerate() {
        let share = w * conductors.current(region.medium(i));
        whole += share;
        for (sum, x) in sums.iter_mut().zip(region.places[i]) {
            *sum += share * x;
        }
    }
    if whole > 0.0 {
        let place = sums.map(|sum| sum / whole);
        for uniform in &mut source.uniform {
            uniform.origin = Origin::Solenoid(place);
        }
    }
}

/// What conductors carry in a sinusoidal steady state in a plane; those that a wire runs through carry more than that.
fn waves<const D: usize>(
    parameters: &Parameters,
    conductors: &Conductors,
    region: &Region<D>,
) -> Option<Waves> {
    let omega = parameters
        .omega
        .filter(|_| !parameters.numerics.form.positive)?;
    let free = |m| !parameters.run.contains(&m);
    Waves::new(conductors, region, omega, free)
}

/// The conductors.
fn conductors<const D: usize>(
    parameters: &Parameters,
    region: &Region<D>,
    sides: &Sides<D>,
) -> Conductors {
    let Parameters {
        conductivity,
        laws,
        around,
        unknown,
        ..
    } = parameters;
    let permeability = laws.iter().map(|law| match law {
        Law::Constant(mu) => *mu,
        Law::Curve(curve) => around / level(curve, *around),
    });
    let permeability: Vec<f64> = permeability.collect();
    let axial = || {
        let conducting = conductivity.iter().filter(|s| **s > 0.0);
        let least = conducting.fold(f64::INFINITY, |least, s| least.min(*s));
        let over = |s: &f64| if *s > 0.0 { least / s } else { 0.0 };
        Axial {
            resistivity: conductivity.iter().map(over).collect(),
            mu: permeability.iter().map(|mu| mu * least).collect(),
            holes: Holes::of(region, sides, |m| conductivity[m as usize] > 0.0),
        }
    };
    let both = permeability.iter().zip(conductivity);
    let saturates = laws.iter().any(|law| law.constant().is_none());
    let permeable = || match saturates {
        true => Some(Permeable::new(region, &permeability)),
        false => Permeable::of(region, &permeability),
    };
    Conductors {
        mu_sigma: both.map(|(mu, s)| mu * s).collect(),
        axial: (*unknown == Unknown::Axial).then(axial),
        permeable: (*unknown != Unknown::Axial).then(permeable).flatten(),
    }
}
