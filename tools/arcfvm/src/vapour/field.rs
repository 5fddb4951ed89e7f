//! Iron vapour in the gas (Komen 2019, eqs 5.23 to 5.25).
//!
//! The flux of iron through a face is `F Y_P + A (Y_P - Y_E)` with the mass flux F of the gas, A the hybrid
//! coefficient of F and of `D = rho Gamma area / distance` in series. The mass that leaves a cell
//! is that which evaporates into it (or nothing, where vapour takes the place of gas), so that
//!
//! ```text
//! sum A (Y_P - Y_E) = area J (1 - Y_P)   where the vapour adds to the gas,
//! sum A (Y_P - Y_E) = area J             where it takes the place of as much gas (eq. 5.23),
//! ```
//!
//! J being the flux of [`super::evaporation::Evaporating::pass`] (eq. 5.24). What J brings in is written as
//! `c (Y_eq - Y_P)` with `c >= 0` and `Y_eq` saturation: values stay between those of edges, metals and 1.

use relax::{Coefficients, FivePoint};

use crate::case::{Case, VapourCase, VapourEdge};
use crate::equation::faces::{Beyond, Carriers, FaceOf};
use crate::equation::transport::{dirichlet, hybrid};
use crate::equation::{Solver, Unsolved};
use crate::flow::field::Flow;
use crate::heat::{Contact, Skin};
use crate::material::GAS;
use crate::properties::Properties;
use crate::vapour::evaporation::{Evaporated, Film};

/// Iron vapour and what its equation is made of.
#[derive(Debug, Clone)]
pub struct Vapour {
    /// Mass fraction of iron, `[nr nz]`; 0 in bodies.
    pub iron: Vec<f64>,
    /// Diffusive conductance of radial faces \[kg/s\].
    pub radial: Vec<f64>,
    /// Diffusive conductance of axial faces \[kg/s\].
    pub axial: Vec<f64>,
    /// What passes each contact.
    pub passed: Vec<Evaporated>,
    /// What evaporates into each cell over the distance from equilibrium \[kg/s\], and that times
    /// equilibrium.
    gathers: Vec<[f64; 2]>,
    equation: FivePoint,
    scratch: Vec<f64>,
    solver: Solver,
}

impl Vapour {
    /// Starts as the case says.
    #[must_use]
    pub fn new(case: &Case, setup: &VapourCase, solver: Solver) -> Self {
        let grid = &case.grid;
        Self {
            iron: setup.start.clone(),
            radial: vec![0.0; grid.radial_faces()],
            axial: vec![0.0; grid.axial_faces()],
            passed: vec![Evaporated::default(); case.contacts().len()],
            gathers: vec![[0.0; 2]; grid.len()],
            equation: FivePoint::new(grid.nr, grid.nz),
            scratch: vec![0.0; grid.len()],
            solver,
        }
    }

    /// Conductances at the present state.
    pub fn conduct(&mut self, case: &Case, setup: &VapourCase, properties: &Properties) {
        let (grid, product) = (&case.grid, &properties.iron_diffusion);
        let half = |width: f64, k: usize| match case.material[k] {
            GAS => 0.5 * width / product[k],
            // Gas meets a wall that takes iron up at its own surface.
            other if setup.at_wall(other).is_some() => 0.0,
            _ => f64::INFINITY,
        };
        for j in 0..grid.nz {
            for i in 0..=grid.nr {
                let side = |c: usize| half(grid.dr[c], grid.cell(c, j));
                let west = if i > 0 { side(i - 1) } else { 0.0 };
                let east = if i < grid.nr { side(i) } else { 0.0 };
                self.radial[grid.radial_face(i, j)] = grid.area(i, j) / (west + east);
            }
        }
        for j in 0..=grid.nz {
            for i in 0..grid.nr {
                let side = |c: usize| half(grid.dz[c], grid.cell(i, c));
                let south = if j > 0 { side(j - 1) } else { 0.0 };
                let north = if j < grid.nz { side(j) } else { 0.0 };
                self.axial[grid.axial_face(i, j)] = grid.ring[i] / (south + north);
            }
        }
    }

    /// What evaporates at each contact, the surfaces being `skins`, at `temperature` \[K\].
    pub fn evaporate(
        &mut self,
        case: &Case,
        setup: &VapourCase,
        skins: &[Skin],
        temperature: &[f64],
    ) {
        self.passed.clear();
        self.gathers.fill([0.0; 2]);
        for (n, contact) in case.contacts().iter().enumerate() {
            let surface = Skin::of(skins, n, contact, temperature).temperature;
            let passed = self.pass(case, setup, contact, surface, temperature);
            self.passed.push(passed);
            let gathers = &mut self.gathers[contact.gas];
            gathers[0] += contact.area * passed.coefficient;
            gathers[1] += contact.area * passed.coefficient * passed.equilibrium;
        }
    }

    /// What passes one contact with its surface at `surface` \[K\]; nothing where its metal does not evaporate: the gas
    /// there is that of the cell.
    pub(crate) fn pass(
        &self,
        case: &Case,
        setup: &VapourCase,
        contact: &Contact,
        surface: f64,
        temperature: &[f64],
    ) -> Evaporated {
        let iron = self.iron[contact.gas];
        let Some(metal) = &setup.metals[contact.electrode] else {
            return Evaporated {
                surface: iron,
                ..Evaporated::default()
            };
        };
        let at = [surface, temperature[contact.gas]];
        metal.pass(surface, film(case, setup, contact, at, iron))
    }

    /// Slope with the temperature of the surface of the heat that vapour takes off a contact
    /// \[W/(m2 K)\], never negative.
    #[must_use]
    pub fn slope(
        &self,
        case: &Case,
        setup: &VapourCase,
        contact: &Contact,
        surface: f64,
        temperature: &[f64],
    ) -> f64 {
        let Some(metal) = &setup.metals[contact.electrode] else {
            return 0.0;
        };
        let at = [surface, temperature[contact.gas]];
        let film = film(case, setup, contact, at, self.iron[contact.gas]);
        let (t, step) = (surface, 1e-4 * surface);
        let flux = |t: f64| metal.pass(t, film).off();
        let slope = (flux(t + step) - flux(t - step)) / (2.0 * step);
        metal.latent_heat * slope.max(0.0)
    }

    /// Mass that evaporates into each cell more than condenses \[kg/s\].
    pub fn mass_source(&self, contacts: &[Contact], source: &mut [f64]) {
        source.fill(0.0);
        for (contact, passed) in contacts.iter().zip(&self.passed) {
            source[contact.gas] += contact.area * passed.flux;
        }
    }

    /// East, west, north and south of cell `(i, j)`; without a `flow` no mass passes them.
    pub(crate) fn faces(
        &self,
        case: &Case,
        flow: Option<&Flow>,
        i: usize,
        j: usize,
    ) -> [FaceOf; 4] {
        let carriers = Carriers {
            mass: |face| flow.map_or(0.0, |flow| flow.mass(face)),
            radial: &self.radial,
            axial: &self.axial,
        };
        carriers.faces(&case.grid, i, j)
    }

    fn equation(
        &self,
        case: &Case,
        setup: &VapourCase,
        flow: Option<&Flow>,
        i: usize,
        j: usize,
    ) -> Coefficients {
        let k = case.grid.cell(i, j);
        if case.material[k] != GAS {
            return Coefficients::fixed(0.0);
        }
        let mut c = Coefficients::default();
        let mut sides = [0.0; 4];
        for (side, face) in sides.iter_mut().zip(self.faces(case, flow, i, j)) {
            match face.beyond {
                Beyond::Cell(n) if case.material[n] == GAS => {
                    *side = hybrid(face.mass_out, face.conductance);
                }
                Beyond::Cell(n) => {
                    if let Some(y) = setup.at_wall(case.material[n]) {
                        c.centre += face.conductance;
                        c.source += face.conductance * y;
                    }
                }
                Beyond::Edge(edge) => {
                    if let VapourEdge::Fraction(y) = *setup.edges.at(edge) {
                        let a = dirichlet(face.mass_out, face.conductance);
                        c.centre += a;
                        c.source += a * y;
                    }
                }
            }
        }
        [c.east, c.west, c.north, c.south] = sides;
        let [gathers, towards] = self.gathers[k];
        c.centre += sides.iter().sum::<f64>() + gathers;
        c.source += towards + setup.source.as_ref().map_or(0.0, |s| s[k]);
        // A cell that nothing reaches keeps what it holds.
        if c.centre > 0.0 {
            c
        } else {
            Coefficients::fixed(self.iron[k])
        }
    }

    /// One under-relaxed solve; returns the unbalanced iron of all cells before it \[kg/s\].
    ///
    /// # Errors
    /// When the equation is not usable or fractions leave the numbers.
    pub fn solve(
        &mut self,
        case: &Case,
        setup: &VapourCase,
        flow: Option<&Flow>,
        relaxation: f64,
    ) -> Result<f64, Unsolved> {
        let mut equation = std::mem::replace(&mut self.equation, FivePoint::new(0, 0));
        equation.fill(|i, j| self.equation(case, setup, flow, i, j));
        self.equation = equation;
        self.equation.residual(&self.iron, &mut self.scratch);
        let gas = |k: &usize| case.material[*k] == GAS;
        let residual = (0..self.scratch.len()).filter(gas);
        let unbalanced = residual.map(|k| self.scratch[k].abs()).sum();
        self.equation.under_relax(&self.iron, relaxation);
        self.solver.solve(&self.equation, &mut self.iron)?;
        // The solver stops short of its goal by rounding.
        for y in &mut self.iron {
            *y = y.clamp(0.0, 1.0);
        }
        Ok(unbalanced)
    }

    /// Every gas cell at the wall of the cavity, with the iron that the wall gives it \[kg/s\].
    pub(crate) fn walls(&self, case: &Case, setup: &VapourCase, mut visit: impl FnMut(usize, f64)) {
        if setup.wall.is_none() {
            return;
        }
        let grid = &case.grid;
        for k in (0..grid.len()).filter(|k| case.material[*k] == GAS) {
            for face in self.faces(case, None, k % grid.nr, k / grid.nr) {
                if let Beyond::Cell(n) = face.beyond
                    && let Some(y) = setup.at_wall(case.material[n])
                {
                    visit(k, face.conductance * (y - self.iron[k]));
                }
            }
        }
    }
}

/// The gas between the surface of a contact and the middle of its cell, at the mean of both
/// temperatures as in eq. 5.17.
fn film(
    case: &Case,
    setup: &VapourCase,
    contact: &Contact,
    [surface, beside]: [f64; 2],
    iron: f64,
) -> Film {
    let t = 0.5 * (beside + surface);
    let ([r, z], gas) = (contact.place, case.of(contact.gas));
    let at =
        |law: &Option<crate::material::Law>| law.as_ref().map_or(0.0, |l| l.within(r, z, t, iron));
    Film {
        iron,
        conductance: at(&gas.density) * at(&gas.iron_diffusion) / contact.gas_half,
        pressure: setup.pressure,
        molar: setup.molar,
        adds: setup.adds,
        vents: setup.vents,
        returning: setup.returns_hot.then_some(beside),
    }
}
