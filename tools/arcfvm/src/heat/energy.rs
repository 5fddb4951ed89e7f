//! Temperature from the balance of enthalpy (Komen 2019, eqs 3.6, 5.8, 5.9).
//!
//! The flux through a face is `F h_P + A (h_P - h_E)` with A the hybrid coefficient of the mass flux
//! and of `g = G (T_P - T_E) / (h_P - h_E)`, G being the conductance in W/K. Written in temperature,
//! the equation holds across materials whose enthalpies differ, and its sum over all cells is that of
//! the edges: no heat is lost between cells. At the surface of an electrode the gas conducts at film
//! temperature (eqs 5.17, 5.18).

use relax::{Coefficients, FivePoint};

use crate::bed::clear::{Slopes, to_the_bend};
use crate::case::{Case, HeatEdge};
use crate::edges::Side;
use crate::equation::faces::{Beyond, Carriers, FaceOf};
use crate::equation::transport::{dirichlet, hybrid, kept};
use crate::equation::{Solver, Unsolved};
use crate::grid::FaceIndex;
use crate::heat::electrons::{Carried, Drift, Nothing};
use crate::heat::reads::Around;
use crate::heat::{Contact, Skin};
use crate::material::GAS;
use crate::residual::Unbalanced;
use crate::vapour::mixing::Mixing;

/// Factor on the relaxation of a cell whose changes alternate.
const CALMER: f64 = 0.7;
/// Alternating changes in a row that are no chance.
const IN_CIRCLES: u8 = 3;
/// Factor on that of all others.
const BOLDER: f64 = 1.02;
/// Least factor: where flux begins to melt, what it conducts may answer twenty times as far as its
/// temperature goes.
const CALMEST: f64 = 0.01;
/// Part of its temperature that a cell may lose in one iteration.
const MOST_FALL: f64 = 0.8;

/// Temperatures and everything that the balance is made of.
#[derive(Debug, Clone)]
pub struct Energy {
    /// Temperature \[K\], `[nr nz]`.
    pub temperature: Vec<f64>,
    /// Conductance of radial faces \[W/K\].
    pub radial: Vec<f64>,
    /// Conductance of axial faces \[W/K\].
    pub axial: Vec<f64>,
    /// Heat into each cell \[W\] and its slope with the temperature \[W/K\]: Joule heat, radiation,
    /// surfaces, plate, given sources.
    pub source: Vec<[f64; 2]>,
    /// Mixing with vapour, where there is any.
    mixing: Option<Mixing>,
    /// How heat in and around a clear bed changes with temperatures, where there is one.
    pub(crate) slopes: Option<Slopes>,
    /// Surfaces of electrodes, where they have temperatures of their own.
    pub(crate) skins: Vec<Skin>,
    /// Calmness of each cell, times the under-relaxation: falls where changes alternate.
    pub(crate) calm: Vec<f64>,
    /// Last change of each temperature \[K\].
    pub(crate) last: Vec<f64>,
    /// Alternating changes of each temperature in a row.
    pub(crate) alternations: Vec<u8>,
    equation: FivePoint,
    scratch: Vec<f64>,
    pub(crate) solver: Solver,
}

/// How one solve of the energy went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyResidual {
    /// Unbalanced heat before the solve \[W\].
    pub heat: Unbalanced,
    /// Largest change of temperature \[K\].
    pub change: f64,
    /// Cells whose change was limited.
    pub limited: usize,
}

/// Relaxation of the temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Under-relaxation of the gas, in (0, 1].
    pub relaxation: f64,
    /// Largest change of a cell in one iteration \[K\].
    pub limit: f64,
}

/// What a cell or an edge holds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct State {
    /// Temperature \[K\].
    pub(crate) temperature: f64,
    /// Enthalpy \[J/kg\].
    pub(crate) enthalpy: f64,
}

impl State {
    /// Specific heat between this and another state; `slope` is that of this one.
    fn capacity(self, there: Self, slope: impl Fn() -> f64) -> f64 {
        let dt = self.temperature - there.temperature;
        let dh = self.enthalpy - there.enthalpy;
        if dt.abs() > 1e-3 { dh / dt } else { slope() }
    }
}

impl Energy {
    /// Starts from `case.start`.
    #[must_use]
    pub fn new(case: &Case, solver: Solver) -> Self {
        let grid = &case.grid;
        Self {
            mixing: case.vapour.as_ref().map(|_| Mixing::new(case)),
            slopes: case.clear_bed().map(|_| Slopes::new(grid)),
            skins: Skin::all(case.surfaces.as_ref(), &[], &case.start),
            calm: vec![1.0; grid.len()],
            last: vec![0.0; grid.len()],
            alternations: vec![0; grid.len()],
            temperature: case.start.clone(),
            radial: vec![0.0; grid.radial_faces()],
            axial: vec![0.0; grid.axial_faces()],
            source: vec![[0.0; 2]; grid.len()],
            equation: FivePoint::new(grid.nr, grid.nz),
            scratch: vec![0.0; grid.len()],
            solver,
        }
    }

    /// Follows the surfaces of `case`: those that were there before keep their temperatures.
    pub(crate) fn follow(&mut self, case: &Case) {
        self.skins = Skin::all(case.surfaces.as_ref(), &self.skins, &self.temperature);
    }

    /// Heat flux between the middles of gas and metal of a contact \[W/m2\].
    #[must_use]
    pub fn convection(&self, contact: &Contact) -> f64 {
        let difference = self.temperature[contact.gas] - self.temperature[contact.metal];
        self.conductance(contact) * difference / contact.area
    }

    /// Conductance between the middles on both sides of a contact \[W/K\].
    #[must_use]
    pub fn conductance(&self, contact: &Contact) -> f64 {
        match contact.face {
            FaceIndex::Radial(face) => self.radial[face],
            FaceIndex::Axial(face) => self.axial[face],
        }
    }

    fn equation(
        &self,
        around: Around<'_>,
        carried: &impl Carried,
        i: usize,
        j: usize,
    ) -> Coefficients {
        let case = around.case;
        let k = case.grid.cell(i, j);
        let here = self.state(around, k);
        let t = here.temperature;
        let specific_heat = || case.of(k).enthalpy.as_ref().map_or(1.0, |e| e.slope(t));
        let mut c = Coefficients::default();
        let faces = self.faces(around, i, j);
        let mut sides = [0.0; 4];
        for (side, face) in sides.iter_mut().zip(faces) {
            match face.beyond {
                Beyond::Cell(n) => {
                    let there = self.state(around, n);
                    *side = self.link(carried, &face, hybrid, || {
                        here.capacity(there, specific_heat)
                    });
                    c.source -= self.mixed(&face, hybrid);
                    if let Some([own, other]) = self.slopes.as_ref().and_then(|s| s.seen(&face)) {
                        c.centre += own - other;
                        let beyond = there.temperature;
                        c.source += own * t - other * beyond - *side * (t - beyond);
                        *side = other;
                    }
                }
                Beyond::Edge(edge) => {
                    let (a, given) = self.edge(around, carried, edge, &face, here);
                    c.centre += a;
                    c.source += a * given - self.mixed(&face, dirichlet);
                    if let HeatEdge::Flux(flux) = *around.heat.edges.at(edge) {
                        c.source += flux * face.area;
                    }
                }
            }
        }
        [c.east, c.west, c.north, c.south] = sides;
        let [value, slope] = self.source[k];
        c.source += value - slope * t;
        c.centre += sides.iter().sum::<f64>() - slope;
        let out: f64 = faces.iter().map(|face| face.mass_out.max(0.0)).sum();
        let with_electrons: f64 = faces.iter().map(|face| carried.out(face).max(0.0)).sum();
        let out = out * here.capacity(here, specific_heat) + with_electrons;
        kept(&mut c, out, t);
        c
    }

    /// Coefficient and temperature of an edge face.
    pub(crate) fn edge(
        &self,
        around: Around<'_>,
        carried: &impl Carried,
        edge: Side,
        face: &FaceOf,
        here: State,
    ) -> (f64, f64) {
        let HeatEdge::Temperature(t) = *around.heat.edges.at(edge) else {
            return (0.0, 0.0);
        };
        let Some(enthalpy) = &around.case.of(face.own).enthalpy else {
            return (0.0, 0.0);
        };
        let there = State {
            temperature: t,
            enthalpy: enthalpy.at(t),
        };
        let slope = || enthalpy.slope(here.temperature);
        let a = self.link(carried, face, dirichlet, || here.capacity(there, slope));
        (a, t)
    }

    /// What cell `k` holds.
    pub(crate) fn state(&self, around: Around<'_>, k: usize) -> State {
        State {
            temperature: self.temperature[k],
            enthalpy: around.properties.enthalpy[k],
        }
    }

    /// The scheme's coefficient of a face in W/K.
    fn link(
        &self,
        carried: &impl Carried,
        face: &FaceOf,
        scheme: fn(f64, f64) -> f64,
        capacity: impl FnOnce() -> f64,
    ) -> f64 {
        carried.link(face, scheme, || match &self.mixing {
            Some(mixing) => mixing.at(face).capacity,
            None => capacity(),
        })
    }

    /// Heat that leaves through a face with the mixing of gas and vapour \[W\].
    pub(crate) fn mixed(&self, face: &FaceOf, scheme: fn(f64, f64) -> f64) -> f64 {
        self.mixing.as_ref().map_or(0.0, |mixing| {
            let mix = mixing.at(face);
            scheme(face.mass_out, mix.diffusion) * mix.shift
        })
    }

    /// Takes the mixing with vapour at the present temperatures, where there is any.
    pub fn mix(&mut self, around: Around<'_>) {
        if let Some((mixing, vapours)) = self.mixing.as_mut().zip(around.vapour) {
            mixing.update(around, vapours, &self.temperature);
        }
    }

    pub(crate) fn faces(&self, around: Around<'_>, i: usize, j: usize) -> [FaceOf; 4] {
        let carriers = Carriers {
            mass: |face| around.mass(face),
            radial: &self.radial,
            axial: &self.axial,
        };
        carriers.faces(&around.case.grid, i, j)
    }

    /// Under-relaxation of cell `k`. Metal conducts almost linearly: relaxing it would only let its
    /// heat spread slowly, but for a wire that melts as it is fed. Gas on an electrode is relaxed twice as much,
    /// the film's conductance being taken from the iteration before.
    fn relaxation(&self, case: &Case, k: usize, gas: f64) -> f64 {
        if case.material[k] == GAS {
            let film = case.surfaces.as_ref().is_some_and(|s| s.beside[k]);
            return self.calm[k] * if film { 0.5 * gas } else { gas };
        }
        let fed = case
            .wire
            .filter(|w| w.material == case.material[k] && w.feed.is_some());
        let t = self.temperature[k];
        let melting = fed.and(case.of(k).melting);
        let melts = melting.is_some_and(|m| (t - m.point).abs() < 2.0 * m.half_range);
        self.calm[k] * if melts { 0.5 } else { 1.0 }
    }

    /// Notes the change of cell `k` and calms it where changes alternate without falling.
    fn note(&mut self, k: usize, change: f64) {
        let alternates = change * self.last[k] < 0.0 && change.abs() > 0.5 * self.last[k].abs();
        let row = if alternates {
            self.alternations[k].saturating_add(1)
        } else {
            0
        };
        self.alternations[k] = row;
        let factor = if row >= IN_CIRCLES { CALMER } else { BOLDER };
        self.calm[k] = (self.calm[k] * factor).clamp(CALMEST, 1.0);
        self.last[k] = change;
    }

    /// One under-relaxed solve.
    ///
    /// # Errors
    /// When the equation is not usable or temperatures leave the numbers.
    pub fn solve(&mut self, around: Around<'_>, step: Step) -> Result<EnergyResidual, Unsolved> {
        let case = around.case;
        let mut equation = std::mem::replace(&mut self.equation, FivePoint::new(0, 0));
        match Drift::of(around) {
            Some(drift) => equation.fill(|i, j| self.equation(around, &drift, i, j)),
            None => equation.fill(|i, j| self.equation(around, &Nothing, i, j)),
        }
        self.equation = equation;
        self.equation.residual(&self.temperature, &mut self.scratch);
        let unbalanced = Unbalanced::of(&self.scratch, case.grid.nr);
        let mut relaxation = std::mem::take(&mut self.scratch);
        for (k, factor) in relaxation.iter_mut().enumerate() {
            *factor = self.relaxation(case, k, step.relaxation);
        }
        self.equation
            .under_relax_each(&self.temperature, |k| relaxation[k]);
        self.scratch = relaxation;
        self.scratch.copy_from_slice(&self.temperature);
        self.solver.solve(&self.equation, &mut self.temperature)?;
        let (mut change, mut limited) = (0.0_f64, 0);
        for k in 0..self.temperature.len() {
            let old = self.scratch[k];
            let mut wanted = self.temperature[k] - old;
            if self.slopes.is_some() {
                wanted = to_the_bend(case, k, old, wanted);
                self.temperature[k] = old + wanted;
            }
            // An unfinished linear solve can reach below zero in the first iterations.
            let limit = if wanted < 0.0 {
                step.limit.min(MOST_FALL * old)
            } else {
                step.limit
            };
            if wanted.abs() > limit {
                limited += 1;
                self.temperature[k] = old + limit.copysign(wanted);
            }
            let taken = self.temperature[k] - old;
            change = change.max(taken.abs());
            self.note(k, taken);
        }
        Ok(EnergyResidual {
            heat: unbalanced,
            change,
            limited,
        })
    }
}
