//! The alternating field about a liquid that conducts, and the mean force of its currents: a function of where the surface is.
//!
//! `lap A = 0` in the air and `lap A = j w mu sigma (A + A_s)` inside (2.64, 2.65 and 2.69, Matsuzawa 2017), A_s of the coils
//! exact, multipoles of the currents on the wall far away. The field has points of its own, finer than those of the liquid
//! beside the surface, where currents flow within the skin depth: those about a ball, moved into the outline of the drop
//! (see [`mould`]). Charges that a current through the surface would bring are left out: `out` says how large it is.

mod carried;
mod fitted;
pub mod mould;
mod state;

use krylov::{Ending, Grids, Method, Options, Rule, System};
use num_complex::Complex;
use run::Failure;

pub use carried::Act;
use carried::Flux;
pub use fitted::Fitted;
use mould::within;
pub use mould::{Ball, Mould};
use state::State;

use super::air::{Place, Skin};
use super::effort::{Effort, failed};
use super::outline::Outline;
use super::surface::tangents;
use super::vector::{along, difference, direction, length};
use crate::magnetic::diffusion::Conductors;
use crate::magnetic::driven::right::Drive;
use crate::magnetic::fields::{Fields, Media, Solution, steady_change};
use crate::magnetic::medium::interface::Acting;
use crate::magnetic::medium::law::Law;
use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::source::{MU0, Source};
use crate::magnetic::totals::Totals;
use crate::magnetic::unknown::Unknown;
use crate::stencils::region::Region;
use crate::stencils::sides::{Form, Sides};

type C = Complex<f64>;

/// Factors that need so many times the products that they needed at first are made anew.
const WORN: u64 = 3;
/// Fewer than these at first count as these.
const LEAST: u64 = 8;

/// Places on a coil at which it is asked whether the drop is there.
const PIECES: usize = 64;

/// What acts on the liquid, and what it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Applied {
    /// Coils.
    pub source: Source,
    /// Angular frequency \[rad/s\].
    pub omega: f64,
    /// Conductivity \[S/m\].
    pub conductivity: f64,
}

/// Points of the field where the liquid is.
pub struct Stood {
    region: Region<3>,
    weights: Vec<f64>,
    outline: Outline,
    /// The place about which the outline was sought \[m\].
    sought: [f64; 3],
}

/// The field, with what it keeps from one place of the liquid to the next.
pub struct Magnetic {
    applied: Applied,
    ball: Ball,
    form: Form,
    conductors: Conductors,
    system: Option<System<f64, C>>,
    state: State,
    /// Force and heat.
    pub totals: Totals,
    /// Greatest current through the surface over the greatest along it.
    pub out: f64,
    /// Whether its heat is asked for at points of the liquid.
    pub warms: bool,
}

impl Magnetic {
    /// A field that knows no liquid yet, on points about a ball.
    #[must_use]
    pub fn new(applied: Applied, ball: Ball, form: Form) -> Self {
        Self {
            conductors: Conductors {
                mu_sigma: vec![0.0, MU0 * applied.conductivity],
                axial: None,
                permeable: None,
            },
            applied,
            ball,
            form,
            system: None,
            state: State::default(),
            totals: Totals::default(),
            out: 0.0,
            warms: false,
        }
    }

    /// Points of the field.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.ball.region.len() as u64
    }

    /// How often factors were made.
    #[must_use]
    pub fn renewed(&self) -> u64 {
        self.state.renewed
    }

    /// Force on the liquid as a whole \[N\]: the opposite of that on the coils.
    #[must_use]
    pub fn force(&self) -> [f64; 3] {
        self.totals.force_coil
    }

    /// Takes currents of the coils so many times as strong.
    pub fn strengthen(&mut self, factor: f64) {
        self.applied.source = self.applied.source.times(factor);
        for a in self.state.found.iter_mut().flatten() {
            *a *= factor;
        }
        self.totals = self.totals.times(factor * factor);
    }

    /// Points of the field about an outline that was sought from a place within \[m\].
    #[must_use]
    pub fn stand(&self, outline: &Outline, sought: [f64; 3]) -> Stood {
        let mould = Mould {
            centre: self.ball.centre,
            radius: self.ball.radius,
            outline,
        };
        let (region, weights) = mould.region(&self.ball);
        Stood {
            region,
            weights,
            outline: outline.clone(),
            sought,
        }
    }

    /// Fits about those that do not stay.
    ///
    /// # Errors
    /// Where fits cannot be made.
    pub fn fit(&self, stood: &Stood) -> Result<Fitted, Failure> {
        Fitted::new(&self.ball, &stood.region, &self.form).map_err(|e| failed(&e))
    }

    /// What acts on the liquid.
    ///
    /// # Errors
    /// Where the equations have no solution.
    pub fn act(
        &mut self,
        stood: &Stood,
        fitted: &Fitted,
        place: Place<'_>,
        how: Rule<'_>,
        effort: &mut Effort,
    ) -> Result<Act, Failure> {
        let sides = &fitted.sides;
        let Stood {
            region,
            weights,
            outline,
            sought,
        } = stood;
        if let Some([x, y, z]) = self.touched(outline) {
            let what = format!(
                "the drop touches a coil at ({x:.3e}, {y:.3e}, {z:.3e}) m: it has no exact field there"
            );
            return Err(failed(&what));
        }
        let source = self.sources(region, Source::potential);
        let drive = Drive {
            omega: self.applied.omega,
            source,
            held: [C::default(); 3],
        };
        if self.state.worn || self.system.is_none() {
            self.system = Some(self.made(region, fitted)?);
            self.state.begin(place, *sought, region.len());
        } else if let Some(system) = &mut self.system {
            let omega = drive.omega;
            let (rows, shift) = fitted.rows(&self.conductors, &self.ball, region, omega);
            system.renew_shifted(rows, &shift).map_err(|e| failed(&e))?;
        }
        self.solve(stood, sides, &drive, how, effort)?;
        let flux = self.sources(region, Source::flux);
        let fields = self.fields(region, sides, &drive.source, &flux);
        let acts = Acting {
            acts: &[false, true],
            laws: &[Law::Constant(MU0), Law::Constant(MU0)],
            permeable: None,
        };
        let source = &self.applied.source;
        self.totals = Totals::of(region, &fields, weights, source, None, acts);
        self.out = through(region, &fields);
        let flux = Flux {
            region,
            sides,
            flux: &fields.flux,
            force: (&fields.force, weights),
            heat: self.warms.then_some(fields.heat.as_slice()),
            outline,
            rate: C::new(0.0, drive.omega * self.conductors.mu_sigma[1]),
        };
        flux.act(place)
    }

    /// A place where the outline holds a wire of a coil.
    fn touched(&self, outline: &Outline) -> Option<[f64; 3]> {
        let source = &self.applied.source;
        let round = source.loops.iter().flat_map(|l| {
            let axes = tangents(&l.axis);
            (0..PIECES).map(move |k| {
                let (sine, cosine) = (std::f64::consts::TAU * k as f64 / PIECES as f64).sin_cos();
                let way = along(&axes[0].map(|a| a * cosine), sine, &axes[1]);
                (along(&l.centre, l.radius, &way), l.wire_radius)
            })
        });
        let straight = source.segments.iter().flat_map(|s| {
            (0..=PIECES).map(move |k| {
                let share = k as f64 / PIECES as f64;
                let place = along(&s.from, share, &difference(&s.to, &s.from));
                (place, s.wire_radius)
            })
        });
        let holds = |(x, thick): &([f64; 3], f64)| {
            let way = difference(x, &outline.origin);
            length(&way) < outline.radius(&direction(&way)) + thick
        };
        round.chain(straight).find(holds).map(|(x, _)| x)
    }

    /// What coils give at points of the liquid; nothing elsewhere, where nothing asks for it.
    fn sources(
        &self,
        region: &Region<3>,
        give: impl Fn(&Source, &[[f64; 3]]) -> Vec<[C; 3]>,
    ) -> Vec<[C; 3]> {
        let all = within(region).concat();
        let places: Vec<[f64; 3]> = all.iter().map(|i| region.places[*i]).collect();
        let mut found = vec![[C::default(); 3]; region.len()];
        for (i, a) in all.iter().zip(give(&self.applied.source, &places)) {
            found[*i] = a;
        }
        found
    }

    /// The equations with factors of their own.
    fn made(&self, region: &Region<3>, fitted: &Fitted) -> Result<System<f64, C>, Failure> {
        let omega = self.applied.omega;
        let (rows, shift) = fitted.rows(&self.conductors, &self.ball, region, omega);
        let options = Options {
            method: Method::Multigrid(Grids::default()),
            ..Options::default()
        };
        System::new(rows, shift, options).map_err(|e| failed(&e))
    }

    /// Solves from the last solution.
    fn solve(
        &mut self,
        stood: &Stood,
        sides: &Sides<3>,
        drive: &Drive<3>,
        how: Rule<'_>,
        effort: &mut Effort,
    ) -> Result<(), Failure> {
        let (region, weights) = (&stood.region, &stood.weights);
        let unknown = Unknown::Potential;
        let rates = self.conductors.rates(region, sides, unknown);
        let mut right = drive.right(&self.conductors, region, unknown, &rates);
        let multipoles = Multipoles::new(region, weights);
        let pairs = drive.pairs(&self.conductors, region, unknown, &multipoles, &mut right);
        let Some(system) = &mut self.system else {
            return Ok(());
        };
        let solved = system.solve_with(&pairs, &right, &mut self.state.found, how);
        effort.field_products += solved.products as u64;
        effort.field_residual = effort.field_residual.max(solved.worst());
        match solved.ending {
            Ending::Converged => {}
            Ending::BrokenDown(why) => return Err(failed(&format!("magnetic field: {why}"))),
            _ => effort.field_unsolved += 1,
        }
        self.state.judge(solved.products as u64);
        Ok(())
    }

    fn fields(
        &self,
        region: &Region<3>,
        sides: &Sides<3>,
        source: &[[C; 3]],
        flux: &[[C; 3]],
    ) -> Fields {
        let change = steady_change(self.applied.omega, &self.state.found, source);
        let solution = Solution {
            found: &self.state.found,
            source,
            change: &change,
            waves: None,
        };
        let media = Media {
            conductivity: &[0.0, self.applied.conductivity],
            laws: &[Law::Constant(MU0), Law::Constant(MU0)],
            flux,
        };
        Fields::new(region, sides, Unknown::Potential, solution, &media)
    }
}

/// The outline of a surface about its own centre, sought from a place within.
///
/// # Errors
/// Where a ray from there meets the surface twice.
pub fn outline(skin: Skin<'_>, centre: [f64; 3]) -> Result<Outline, Failure> {
    let about = |place: [f64; 3]| {
        let found = Outline::new(skin.place, skin.normal, place);
        found.ok_or_else(not_round)
    };
    let (_, own) = about(centre)?.volume();
    about(own)
}

/// Why a drop has no field.
#[must_use]
pub fn not_round() -> Failure {
    failed(
        &"the surface is no longer one that every ray from its centre meets once: a magnetic field cannot follow it",
    )
}

/// Greatest current through the surface over the greatest along it.
fn through(region: &Region<3>, fields: &Fields) -> f64 {
    let (mut out, mut whole) = (0.0_f64, 0.0_f64);
    for face in &region.faces {
        let e = fields.electric[face.point as usize];
        let normal: C = e.iter().zip(&face.normal).map(|(e, n)| e * n).sum();
        out = out.max(normal.norm());
        whole = whole.max(e.iter().map(C::norm_sqr).sum::<f64>().sqrt());
    }
    if whole > 0.0 { out / whole } else { 0.0 }
}

#[cfg(test)]
impl Magnetic {
    /// Fits of which all are made anew.
    pub(crate) fn fit_anew(&self, stood: &Stood) -> Result<Fitted, Failure> {
        Fitted::within(&self.ball, &stood.region, &self.form, -1.0).map_err(|e| failed(&e))
    }
}

#[cfg(test)]
impl Stood {
    /// Places on the surface and inside, normals with areas there, and volumes of both.
    #[allow(clippy::type_complexity, reason = "four lists of one test")]
    pub(crate) fn parts(&self) -> (Vec<[f64; 3]>, Vec<[f64; 3]>, Vec<([f64; 3], f64)>, Vec<f64>) {
        let [on, inside] = within(&self.region);
        let places = |of: &[usize]| of.iter().map(|i| self.region.places[*i]).collect();
        let faces = self.region.faces.iter().map(|f| (f.normal, f.area));
        let volumes = on.iter().chain(&inside).map(|i| self.weights[*i]);
        (
            places(&on),
            places(&inside),
            faces.collect(),
            volumes.collect(),
        )
    }
}
