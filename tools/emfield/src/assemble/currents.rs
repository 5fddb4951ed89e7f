//! Eddy currents of a scene: its equations, their solution, fields, forces and heat.

use krylov::{Rows, Scalar, System};
use num_complex::Complex;
use run::{Failure, Session};

use super::bars::bars;
use super::broken::unsolvable;
use super::charge::Charges;
use super::drive::{source, unknown};
use super::enclosed::enclosed;
use super::magnetic::Driven;
use super::region::region;
use super::setting::{Setting, laws, media};
use super::unfit::no_stencil;
use super::winding::windings;
use crate::cloud::region::vector;
use crate::cloud::{Cell, Class, Cloud};
use crate::magnetic::diffusion::{self, Axial, Conductors};
use crate::magnetic::driven::bar::Bar;
use crate::magnetic::driven::right::Drive;
use crate::magnetic::driven::winding::Windings;
use crate::magnetic::fields::{Solution, steady_change};
use crate::magnetic::holes::Holes;
use crate::magnetic::medium::interface::Permeable;
use crate::magnetic::medium::law::Law;
use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::saturation::places::level;
use crate::magnetic::source::{MU0, Origin, Source};
use crate::magnetic::unknown::Unknown;
use crate::magnetic::waves::rows::{Ground, Waving};
use crate::magnetic::waves::weights::Waves;
use crate::output::Found;
use crate::scene::currents::OuterReaction;
use crate::scene::{Coil, EddyCurrents, Scene};
use crate::stencils::quadrature::{self, Moments};
use crate::stencils::region::Region;
use crate::stencils::sides::{Form, Sides};

type C = Complex<f64>;

/// Solves the sinusoidal eddy currents of a scene in `D` coordinates with `K` unknowns a point: 3 in space, else 1.
///
/// # Errors
/// Where a stencil cannot be made or the solve breaks down.
pub fn eddy_currents<const D: usize, const K: usize>(
    scene: &Scene,
    currents: &EddyCurrents,
    cloud: &Cloud,
    session: &mut Session,
) -> Result<Found, Failure> {
    let setting: Setting<'_, D> = Setting::new(scene, currents, cloud, session)?;
    setting.warn(session);
    let drive = session.timed("source", || setting.drive::<K>());
    let charges = setting.charges(session)?;
    let (found, phi) = match &charges {
        None => (setting.solve(&drive, session)?, Vec::new()),
        Some(charges) => setting.coupled(charges, &drive, session)?,
    };
    let mut change = steady_change(drive.omega, &found, &drive.source);
    let mut carried = drive.source.clone();
    let along = setting.applied((drive.omega, &found), &mut change, &mut carried);
    let charged = charges.filter(Charges::charged).map(|charges| {
        let rate = C::new(0.0, drive.omega);
        let voltage: Vec<C> = phi.iter().map(|phi| rate * phi).collect();
        setting.charged(&charges.stencils, (&voltage, &voltage), &mut change)
    });
    setting.tell(setting.lack(&change, 0.0), session);
    let solution = Solution {
        found: &found,
        source: &drive.source,
        change: &change,
        waves: setting
            .waves
            .as_ref()
            .map(|waves| (waves, carried.as_slice())),
    };
    Ok(session.timed("fields", || {
        let flux = setting.source.flux(&cloud.position);
        let driven = Driven {
            source: &setting.source,
            flux: &flux,
            windings: setting.windings.as_ref(),
        };
        let mut found = setting.found(solution, charged.as_ref(), driven);
        found.join(along);
        found
    }))
}

/// A cell in as many coordinates as the equations have.
fn moments<const D: usize>(cell: &Cell) -> Moments<D> {
    Moments {
        volume: cell.volume,
        first: std::array::from_fn(|a| cell.first[a]),
        second: std::array::from_fn(|a| std::array::from_fn(|b| cell.second[a][b])),
    }
}

impl<'a, const D: usize> Setting<'a, D> {
    /// Stencils and sources of a scene.
    ///
    /// # Errors
    /// Where a stencil cannot be made.
    pub(super) fn new(
        scene: &'a Scene,
        currents: &'a EddyCurrents,
        cloud: &'a Cloud,
        session: &mut Session,
    ) -> Result<Self, Failure> {
        let region: Region<D> = region(scene, cloud, &|_| false);
        let unknown = unknown(scene, currents);
        let form = Form {
            around: unknown.around(),
            ..super::form(scene)
        };
        let made = session.timed("weights", || {
            let cells: Vec<Moments<D>> = cloud.cells.iter().map(moments).collect();
            let weights = quadrature::weights(&region, &cells, &form)?;
            Ok((Sides::new(&region, &form)?, weights))
        });
        let failed = |error: wls::Error| no_stencil("eddy currents", &error, (scene, cloud));
        let (sides, mut weights) = made.map_err(failed)?;
        super::supports("vector_potential", &sides.report(), session);
        let laws = laws(scene)?;
        let conductors = conductors((scene, &laws), (&region, &sides), unknown);
        let mut given = source(scene, currents);
        if D == 2 && unknown == Unknown::Potential {
            centre(&mut given, &region, &weights, &conductors);
        }
        let coils = windings(scene, currents, cloud)?;
        let bars = bars((scene, currents), (cloud, &region), &weights)?;
        let wound = || Windings::new(&region, &coils, &mut weights);
        let omega = currents.angular_frequency();
        Ok(Self {
            waves: omega.and_then(|omega| waves((scene, currents), (&conductors, &region), omega)),
            omega,
            windings: (!coils.is_empty()).then(wound),
            bars,
            enclosed: enclosed(scene, cloud, (&region, &form), session)?,
            sides,
            weights,
            unknown,
            source: given,
            conductors,
            laws,
            region,
            scene,
            cloud,
            currents,
        })
    }

    /// Conductivity times volume by point, up to a factor: what the square of a rate is weighted with in the heat.
    pub(super) fn heating(&self) -> Vec<f64> {
        let weight =
            |(i, w): (usize, &f64)| w.max(0.0) * self.conductors.current(self.region.medium(i));
        self.weights.iter().enumerate().map(weight).collect()
    }

    /// Says where a conductor touches a wall that stands for the space beyond it.
    pub(super) fn warn_walls(&self, session: &mut Session) {
        if self.currents.outer != OuterReaction::Multipole {
            return;
        }
        let conducts = |m: u8| self.conductors.mu_sigma[m as usize] > 0.0;
        for (class, [x, y, z]) in self.cloud.class.iter().zip(&self.cloud.position) {
            if let Class::Outer { medium, face } = class
                && conducts(*medium)
            {
                let wall = self.scene.domain.walls(self.scene.geometry)[*face as usize];
                let name = self.scene.medium_name(*medium as usize);
                session.warn(format!(
                    "{name} touches the wall {wall} at ({x:.3e}, {y:.3e}, {z:.3e}) m: no current passes there, and the multipoles of \"outer\" hold only where currents are farther away; leave room, or take \"zero\" where the wall screens"
                ));
                return;
            }
        }
    }

    pub(super) fn solve<const K: usize>(
        &self,
        drive: &Drive<K>,
        session: &mut Session,
    ) -> Result<Vec<[C; K]>, Failure> {
        let (region, sides) = (&self.region, &self.sides);
        let (rates, rows) = session.timed("assemble", || {
            let rates = self.conductors.rates(region, sides, self.unknown);
            (rates, self.conductors.rows(region, sides, self.unknown))
        });
        let Some(waves) = &self.waves else {
            let right = drive.right(&self.conductors, (region, self.unknown), &rates);
            let bars = self.columns(drive, &rows);
            return self.solved(drive, (rows, &rates), (right, bars), session);
        };
        let ground = Ground {
            conductors: &self.conductors,
            region,
            sides,
            unknown: self.unknown,
        };
        let made = || ground.rows(waves, (&rows, rates), &drive.source);
        let Waving {
            rows,
            rates,
            source,
        } = session.timed("assemble", made);
        let mut right = drive.right(&self.conductors, (region, self.unknown), &rates);
        for (right, source) in right.iter_mut().zip(source) {
            *right = std::array::from_fn(|k| right[k] - source[k]);
        }
        let bars = self.columns(drive, &rows);
        self.solved(drive, (rows, &rates), (right, bars), session)
    }

    /// What is applied along each bar in the rows of all points.
    fn columns<T: Scalar, const K: usize>(&self, drive: &Drive<K>, rows: &Rows<T>) -> Vec<Vec<C>>
    where
        C: From<T>,
    {
        let at = (&self.region, &self.sides);
        let column = |bar: &Bar| bar.column(&self.conductors, at, (rows, drive.omega));
        self.bars.iter().map(column).collect()
    }

    /// The solution of rows with rates, where rates and weights have given this right side.
    fn solved<T: Scalar, const K: usize>(
        &self,
        drive: &Drive<K>,
        (rows, rates): (Rows<T>, &[f64]),
        (mut right, mut bars): (Vec<[C; K]>, Vec<Vec<C>>),
        session: &mut Session,
    ) -> Result<Vec<[C; K]>, Failure>
    where
        C: krylov::Unknown<T>,
    {
        let at = (&self.region, self.unknown);
        for (right, given) in right.iter_mut().zip(self.given_rows::<K>()) {
            for (right, given) in right.iter_mut().zip(given) {
                *right += given;
            }
        }
        let mut pairs = if self.currents.outer == OuterReaction::Multipole {
            let multipoles = Multipoles::new(&self.region, &self.weights);
            let mut pairs = drive.pairs(&self.conductors, at, &multipoles, &mut right);
            let bound = self.bound(&multipoles, &mut right);
            pairs.extend(drive.bound(&bound, &mut right));
            for (bar, column) in self.bars.iter().zip(&mut bars) {
                bar.far(column, &self.conductors, &self.region, &multipoles);
            }
            pairs
        } else {
            Vec::new()
        };
        for (bar, column) in self.bars.iter().zip(bars) {
            let given = (drive.omega, drive.source.as_slice());
            pairs.push(bar.pair(column, given, &mut right));
        }
        let shift = diffusion::shift(rates, drive.omega);
        let options = super::options(self.scene);
        let made = session.timed("factorise", || System::new(rows, shift, options));
        let failed = |error: krylov::Error| unsolvable("eddy currents", &error, self.cloud);
        let mut system = made.map_err(failed)?;
        let mut x = vec![[C::default(); K]; right.len()];
        let stop = session.interrupt();
        let rule = super::rule(self.scene, &*stop);
        let solved = session.timed("solve", || system.solve_with(&pairs, &right, &mut x, rule));
        let size = |i: usize| x[i].iter().map(C::norm_sqr).sum();
        let at = (self.cloud, size);
        super::report(("vector_potential", "V s/m"), &solved, at, session)?;
        Ok(x)
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
    (scene, currents): (&Scene, &EddyCurrents),
    (conductors, region): (&Conductors, &Region<D>),
    omega: f64,
) -> Option<Waves> {
    if scene.method.positive {
        return None;
    }
    let place = crate::cloud::region::Region::new(scene);
    let wire = |coil: &Coil| match coil {
        Coil::Wire(wire) => Some(place.medium(vector(&wire.place_m))),
        _ => None,
    };
    let run: Vec<u8> = currents.coils.iter().filter_map(wire).collect();
    Waves::new(conductors, region, (omega, |m| !run.contains(&m)))
}

/// The conductors of a scene.
fn conductors<const D: usize>(
    (scene, laws): (&Scene, &[Law]),
    (region, sides): (&Region<D>, &Sides<D>),
    unknown: Unknown,
) -> Conductors {
    let conductivity = media(scene, |m| m.conductivity_s_m);
    let around = MU0 * scene.surroundings.relative_permeability;
    let permeability = laws.iter().map(|law| match law {
        Law::Constant(mu) => *mu,
        Law::Curve(curve) => around / level(curve, around),
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
    let both = permeability.iter().zip(&conductivity);
    let saturates = laws.iter().any(|law| law.constant().is_none());
    let permeable = || match saturates {
        true => Some(Permeable::new(region, &permeability)),
        false => Permeable::of(region, &permeability),
    };
    Conductors {
        mu_sigma: both.map(|(mu, s)| mu * s).collect(),
        axial: (unknown == Unknown::Axial).then(axial),
        permeable: (unknown != Unknown::Axial).then(permeable).flatten(),
    }
}
