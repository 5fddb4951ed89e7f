//! Velocities, pressure and mass fluxes on the staggered grid.

use crate::case::{Case, FlowCase, FlowEdge, HeatEdge, VapourEdge};
use crate::grid::Grid;
use crate::material::GAS;

/// Whether a face velocity is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Face {
    /// Known, at a wall or inlet \[m/s\].
    Fixed(f64),
    /// Between two gas cells, or an open edge.
    Solved,
}

/// Velocities, pressure and mass fluxes.
#[derive(Debug, Clone)]
pub struct Flow {
    /// Radial velocity at radial faces \[m/s\].
    pub radial: Vec<f64>,
    /// Axial velocity at axial faces \[m/s\].
    pub axial: Vec<f64>,
    /// Pressure above that of the gas at rest \[Pa\], `[nr nz]`.
    pub pressure: Vec<f64>,
    /// Mass flux through radial faces, outward \[kg/s\].
    pub mass_radial: Vec<f64>,
    /// Mass flux through axial faces, upward \[kg/s\].
    pub mass_axial: Vec<f64>,
    /// Mass that comes into each cell with vapour \[kg/s\]; empty where none does.
    pub mass_source: Vec<f64>,
    /// What each radial face is.
    pub radial_kind: Vec<Face>,
    /// What each axial face is.
    pub axial_kind: Vec<Face>,
    /// Density at edge faces where gas of a known temperature enters \[kg/m3\].
    inlet_density: Inlets,
}

/// Density of gas entering at the outer, bottom and top edges, if its temperature is given.
#[derive(Debug, Clone, Default)]
struct Inlets {
    outer: Vec<Option<f64>>,
    bottom: Vec<Option<f64>>,
    top: Vec<Option<f64>>,
}

impl Flow {
    /// Gas at rest, but for the fixed velocities.
    #[must_use]
    pub fn new(case: &Case, setup: &FlowCase) -> Self {
        let grid = &case.grid;
        let [radial_kind, axial_kind] = kinds(case, setup);
        let adds = case.vapour.as_ref().is_some_and(|v| v.adds);
        let start = |kinds: &[Face]| {
            kinds
                .iter()
                .map(|k| if let Face::Fixed(v) = k { *v } else { 0.0 })
                .collect::<Vec<_>>()
        };
        Self {
            radial: start(&radial_kind),
            axial: start(&axial_kind),
            pressure: vec![0.0; grid.len()],
            mass_radial: vec![0.0; grid.radial_faces()],
            mass_axial: vec![0.0; grid.axial_faces()],
            mass_source: vec![0.0; if adds { grid.len() } else { 0 }],
            radial_kind,
            axial_kind,
            inlet_density: inlets(case),
        }
    }

    /// Takes the gas cells of `case` anew: faces that are walls now have their velocity, and cells that
    /// were none before have the pressure of their neighbours.
    pub(crate) fn reshape(
        &mut self,
        case: &Case,
        setup: &FlowCase,
        was_gas: impl Fn(usize) -> bool,
    ) {
        let [radial_kind, axial_kind] = kinds(case, setup);
        hold(&radial_kind, &mut self.radial);
        hold(&axial_kind, &mut self.axial);
        (self.radial_kind, self.axial_kind) = (radial_kind, axial_kind);
        let grid = &case.grid;
        for k in (0..grid.len()).filter(|k| case.material[*k] == GAS && !was_gas(*k)) {
            self.pressure[k] = self.around(case, k, &was_gas);
        }
    }

    /// Mean pressure of the cells next to `k` that were gas before.
    fn around(&self, case: &Case, k: usize, was_gas: impl Fn(usize) -> bool) -> f64 {
        let grid = &case.grid;
        let (i, j) = (k % grid.nr, k / grid.nr);
        let sides = [
            (i + 1 < grid.nr).then(|| k + 1),
            (i > 0).then(|| k - 1),
            (j + 1 < grid.nz).then(|| k + grid.nr),
            (j > 0).then(|| k - grid.nr),
        ];
        let known = sides.into_iter().flatten().filter(|n| was_gas(*n));
        let (sum, count) = known.fold((0.0, 0.0), |(s, c), n| (s + self.pressure[n], c + 1.0));
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// Density carried through radial face `i` of row `j` \[kg/m3\]: that of the edge where it is known
    /// and the gas comes from there or its velocity is given, else that of the cell.
    pub(crate) fn radial_density(&self, grid: &Grid, density: &[f64], i: usize, j: usize) -> f64 {
        if i == grid.nr {
            let own = density[grid.cell(i - 1, j)];
            let face = grid.radial_face(i, j);
            let known = self.radial[face] < 0.0 || self.radial_kind[face] != Face::Solved;
            return self.inlet_density.outer[j].filter(|_| known).unwrap_or(own);
        }
        if i == 0 {
            return density[grid.cell(0, j)];
        }
        0.5 * (density[grid.cell(i - 1, j)] + density[grid.cell(i, j)])
    }

    /// Density carried through axial face `j` of column `i` \[kg/m3\].
    pub(crate) fn axial_density(&self, grid: &Grid, density: &[f64], i: usize, j: usize) -> f64 {
        let speed = self.axial[grid.axial_face(i, j)];
        let fixed = self.axial_kind[grid.axial_face(i, j)] != Face::Solved;
        if j == 0 {
            let own = density[grid.cell(i, 0)];
            return self.inlet_density.bottom[i]
                .filter(|_| fixed || speed > 0.0)
                .unwrap_or(own);
        }
        if j == grid.nz {
            let own = density[grid.cell(i, j - 1)];
            return self.inlet_density.top[i]
                .filter(|_| fixed || speed < 0.0)
                .unwrap_or(own);
        }
        0.5 * (density[grid.cell(i, j - 1)] + density[grid.cell(i, j)])
    }

    /// Mass that leaves cell `(i, j)` more than enters it \[kg/s\].
    #[must_use]
    pub fn imbalance(&self, grid: &Grid, i: usize, j: usize) -> f64 {
        let (r, z) = (grid.radial_face(i, j), grid.axial_face(i, j));
        let out = self.mass_radial[r + 1] - self.mass_radial[r] + self.mass_axial[z + grid.nr]
            - self.mass_axial[z];
        match self.mass_source.get(grid.cell(i, j)) {
            Some(source) => out - source,
            None => out,
        }
    }

    /// Mean mass flow through a section \[kg/s\], for scale: that found, or that which the range of
    /// pressure could drive.
    #[must_use]
    pub fn throughput(&self, case: &Case, density: &[f64]) -> f64 {
        let grid = &case.grid;
        let sum = |fluxes: &[f64]| fluxes.iter().map(|m| m.abs()).sum::<f64>();
        let found = sum(&self.mass_radial) / (grid.nr + 1) as f64
            + sum(&self.mass_axial) / (grid.nz + 1) as f64;
        let gas = |k: &usize| case.material[*k] == GAS;
        let range = |values: &[f64]| {
            let cells = (0..grid.len()).filter(gas).map(|k| values[k]);
            cells.fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)))
        };
        let (low, high) = range(&self.pressure);
        let (_, densest) = range(density);
        let section: f64 = grid.ring.iter().sum();
        found + section * ((high - low).max(0.0) * densest.max(0.0)).sqrt()
    }

    /// Sum of the volume forces \[N\], for scale.
    #[must_use]
    pub fn forces(
        &self,
        case: &Case,
        setup: &FlowCase,
        lorentz: Option<[&[f64]; 2]>,
        density: &[f64],
    ) -> f64 {
        let grid = &case.grid;
        let given = setup
            .force
            .as_ref()
            .map(|f| [f[0].as_slice(), f[1].as_slice()]);
        let mut sum = 0.0;
        if let Some(g) = setup.gravity {
            for k in (0..grid.len()).filter(|k| case.material[*k] == GAS) {
                let volume = grid.volume(k % grid.nr, k / grid.nr);
                sum += g.acceleration * (density[k] - g.reference_density).abs() * volume;
            }
        }
        for [radial, axial] in [lorentz, given].into_iter().flatten() {
            for (k, force) in radial.iter().enumerate() {
                if self.radial_kind[k] == Face::Solved {
                    let (i, j) = (k % (grid.nr + 1), k / (grid.nr + 1));
                    sum += force.abs() * grid.volume(i.min(grid.nr - 1), j);
                }
            }
            for (k, force) in axial.iter().enumerate() {
                if self.axial_kind[k] == Face::Solved {
                    let (i, j) = (k % grid.nr, k / grid.nr);
                    sum += force.abs() * grid.volume(i, j.min(grid.nz - 1));
                }
            }
        }
        sum
    }

    /// Takes what is solved from a function of which (radial, axial velocity, pressure) and place.
    pub(crate) fn take(
        &mut self,
        grid: &Grid,
        density: &[f64],
        value: &dyn Fn(usize, f64, f64) -> f64,
    ) {
        for (face, u) in self.radial.iter_mut().enumerate() {
            if self.radial_kind[face] == Face::Solved {
                let (i, j) = (face % (grid.nr + 1), face / (grid.nr + 1));
                *u = value(0, grid.rf[i], grid.zc[j]);
            }
        }
        for (face, w) in self.axial.iter_mut().enumerate() {
            if self.axial_kind[face] == Face::Solved {
                *w = value(1, grid.rc[face % grid.nr], grid.zf[face / grid.nr]);
            }
        }
        for (k, p) in self.pressure.iter_mut().enumerate() {
            *p = value(2, grid.rc[k % grid.nr], grid.zc[k / grid.nr]);
        }
        self.carry(grid, density);
    }

    /// True if no speed is above `most` \[m/s\] and each is a number.
    pub(crate) fn within(&self, most: f64) -> bool {
        let mut speeds = self.radial.iter().chain(&self.axial);
        speeds.all(|u| u.abs() <= most)
    }

    /// Slows what is solved as a whole, so that no speed is above `most` \[m/s\]; fluxes that balance do so still.
    pub(crate) fn slow(&mut self, most: f64) {
        let speeds = self.radial.iter().chain(&self.axial);
        let part = most / speeds.fold(most, |fastest, u| fastest.max(u.abs()));
        for (kinds, velocity, mass) in [
            (&self.radial_kind, &mut self.radial, &mut self.mass_radial),
            (&self.axial_kind, &mut self.axial, &mut self.mass_axial),
        ] {
            let faces = kinds.iter().zip(velocity).zip(mass);
            for ((_, u), m) in faces.filter(|((kind, _), _)| **kind == Face::Solved) {
                (*u, *m) = (part * *u, part * *m);
            }
        }
    }

    /// Face mass fluxes from velocities and density.
    pub(crate) fn carry(&mut self, grid: &Grid, density: &[f64]) {
        for j in 0..grid.nz {
            for i in 0..=grid.nr {
                let face = grid.radial_face(i, j);
                let rho = self.radial_density(grid, density, i, j);
                self.mass_radial[face] = rho * grid.area(i, j) * self.radial[face];
            }
        }
        for j in 0..=grid.nz {
            for i in 0..grid.nr {
                let face = grid.axial_face(i, j);
                let rho = self.axial_density(grid, density, i, j);
                self.mass_axial[face] = rho * grid.ring[i] * self.axial[face];
            }
        }
    }
}

/// Gives fixed faces their velocity.
fn hold(kinds: &[Face], velocity: &mut [f64]) {
    for (kind, v) in kinds.iter().zip(velocity) {
        if let Face::Fixed(fixed) = kind {
            *v = *fixed;
        }
    }
}

/// What each radial and each axial face is.
fn kinds(case: &Case, setup: &FlowCase) -> [Vec<Face>; 2] {
    let grid = &case.grid;
    let fixed = |edge: FlowEdge, axis: usize| match edge {
        FlowEdge::Velocity(v) => Face::Fixed(v[axis]),
        FlowEdge::Open(_) => Face::Solved,
        FlowEdge::Slip => Face::Fixed(0.0),
    };
    let mut radial_kind = vec![Face::Fixed(0.0); grid.radial_faces()];
    for j in 0..grid.nz {
        for i in 1..grid.nr {
            if case.is_gas(i - 1, j) && case.is_gas(i, j) {
                radial_kind[grid.radial_face(i, j)] = Face::Solved;
            }
        }
        if case.is_gas(grid.nr - 1, j) {
            radial_kind[grid.radial_face(grid.nr, j)] = fixed(setup.edges.outer[j], 0);
        }
        if case.is_gas(0, j) && grid.rf[0] > 0.0 {
            radial_kind[grid.radial_face(0, j)] = fixed(setup.edges.inner[j], 0);
        }
    }
    let mut axial_kind = vec![Face::Fixed(0.0); grid.axial_faces()];
    for i in 0..grid.nr {
        for j in 1..grid.nz {
            if case.is_gas(i, j - 1) && case.is_gas(i, j) {
                axial_kind[grid.axial_face(i, j)] = Face::Solved;
            }
        }
        if case.is_gas(i, 0) {
            axial_kind[grid.axial_face(i, 0)] = fixed(setup.edges.bottom[i], 1);
        }
        if case.is_gas(i, grid.nz - 1) {
            axial_kind[grid.axial_face(i, grid.nz)] = fixed(setup.edges.top[i], 1);
        }
    }
    [radial_kind, axial_kind]
}

/// An edge face that gas may enter through.
struct Entrance {
    cell: usize,
    place: [f64; 2],
    heat: Option<HeatEdge>,
    iron: Option<VapourEdge>,
}

impl Entrance {
    /// Density of the gas that enters, where its temperature and its iron are known \[kg/m3\].
    fn density(&self, case: &Case) -> Option<f64> {
        let t = match (self.heat, self.iron) {
            (Some(HeatEdge::Temperature(t)), _) => t,
            // Vapour at temperatures that are not solved.
            (None, Some(_)) => case.start[self.cell],
            _ => return None,
        };
        let y = match self.iron {
            None => 0.0,
            Some(VapourEdge::Fraction(y)) => y,
            Some(VapourEdge::Sealed) => return None,
        };
        let ([r, z], law) = (self.place, case.materials[GAS].density.as_ref());
        law.map(|l| l.within(r, z, t, y))
    }
}

/// Densities of the gas at edges where its state is given.
fn inlets(case: &Case) -> Inlets {
    let grid = &case.grid;
    let heat = case.heat.as_ref().map(|h| &h.edges);
    let iron = case.vapour.as_ref().map(|v| &v.edges);
    let outer = |j: usize| Entrance {
        cell: grid.cell(grid.nr - 1, j),
        place: [grid.rf[grid.nr], grid.zc[j]],
        heat: heat.map(|e| e.outer[j]),
        iron: iron.map(|e| e.outer[j]),
    };
    let bottom = |i: usize| Entrance {
        cell: grid.cell(i, 0),
        place: [grid.rc[i], grid.zf[0]],
        heat: heat.map(|e| e.bottom[i]),
        iron: iron.map(|e| e.bottom[i]),
    };
    let top = |i: usize| Entrance {
        cell: grid.cell(i, grid.nz - 1),
        place: [grid.rc[i], grid.zf[grid.nz]],
        heat: heat.map(|e| e.top[i]),
        iron: iron.map(|e| e.top[i]),
    };
    Inlets {
        outer: (0..grid.nz).map(|j| outer(j).density(case)).collect(),
        bottom: (0..grid.nr).map(|i| bottom(i).density(case)).collect(),
        top: (0..grid.nr).map(|i| top(i).density(case)).collect(),
    }
}
