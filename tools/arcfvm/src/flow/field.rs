//! Velocities, pressure and mass fluxes on the staggered grid.

use crate::case::{Case, Face, Faces, FlowCase};
use crate::grid::{FaceIndex, Grid};
use crate::material::GAS;

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
}

/// The gas that velocities carry.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Carried<'a> {
    pub(crate) grid: &'a Grid,
    pub(crate) setup: &'a FlowCase,
    /// Density of each cell \[kg/m3\].
    pub(crate) density: &'a [f64],
}

impl Flow {
    /// Gas at rest, but for the fixed velocities.
    #[must_use]
    pub fn new(case: &Case, setup: &FlowCase) -> Self {
        let grid = &case.grid;
        let adds = case.vapour.as_ref().is_some_and(|v| v.adds);
        let mut flow = Self {
            radial: vec![0.0; grid.radial_faces()],
            axial: vec![0.0; grid.axial_faces()],
            pressure: vec![0.0; grid.len()],
            mass_radial: vec![0.0; grid.radial_faces()],
            mass_axial: vec![0.0; grid.axial_faces()],
            mass_source: vec![0.0; if adds { grid.len() } else { 0 }],
        };
        flow.hold(setup);
        flow
    }

    /// Gives fixed faces their velocity.
    fn hold(&mut self, setup: &FlowCase) {
        let Faces { radial, axial } = &setup.faces;
        for (faces, velocity) in [(radial, &mut self.radial), (axial, &mut self.axial)] {
            for (face, v) in faces.iter().zip(velocity) {
                if let Face::Fixed(fixed) = face {
                    *v = *fixed;
                }
            }
        }
    }

    /// Follows the gas cells of `case`: faces that are walls now have their velocity, and cells that
    /// were none before have the pressure of their neighbours.
    pub(crate) fn follow(
        &mut self,
        case: &Case,
        setup: &FlowCase,
        was_gas: impl Fn(usize) -> bool,
    ) {
        self.hold(setup);
        let grid = &case.grid;
        for k in (0..grid.len()).filter(|k| case.material[*k] == GAS && !was_gas(*k)) {
            self.pressure[k] = self.around(case, k, &was_gas);
        }
    }

    /// Mean pressure of the cells next to `k` that were gas before.
    fn around(&self, case: &Case, k: usize, was_gas: impl Fn(usize) -> bool) -> f64 {
        let known = case.grid.beside(k).filter(|n| was_gas(*n));
        let (sum, count) = known.fold((0.0, 0.0), |(s, c), n| (s + self.pressure[n], c + 1.0));
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// Density carried through radial face `i` of row `j` \[kg/m3\]: that of the edge where it is known
    /// and the gas comes from there or its velocity is given, else that of the cell.
    pub(crate) fn radial_density(&self, gas: Carried<'_>, i: usize, j: usize) -> f64 {
        let Carried {
            grid,
            setup,
            density,
        } = gas;
        if i == grid.nr {
            let own = density[grid.cell(i - 1, j)];
            let face = grid.radial_face(i, j);
            let known = self.radial[face] < 0.0 || setup.faces.radial[face] != Face::Solved;
            return setup.inlets.outer[j].filter(|_| known).unwrap_or(own);
        }
        if i == 0 {
            return density[grid.cell(0, j)];
        }
        0.5 * (density[grid.cell(i - 1, j)] + density[grid.cell(i, j)])
    }

    /// Density carried through axial face `j` of column `i` \[kg/m3\].
    pub(crate) fn axial_density(&self, gas: Carried<'_>, i: usize, j: usize) -> f64 {
        let Carried {
            grid,
            setup,
            density,
        } = gas;
        let face = grid.axial_face(i, j);
        let speed = self.axial[face];
        let fixed = setup.faces.axial[face] != Face::Solved;
        if j == 0 {
            let own = density[grid.cell(i, 0)];
            return setup.inlets.bottom[i]
                .filter(|_| fixed || speed > 0.0)
                .unwrap_or(own);
        }
        if j == grid.nz {
            let own = density[grid.cell(i, j - 1)];
            return setup.inlets.top[i]
                .filter(|_| fixed || speed < 0.0)
                .unwrap_or(own);
        }
        0.5 * (density[grid.cell(i, j - 1)] + density[grid.cell(i, j)])
    }

    /// Mass flux through a face, outward or upward \[kg/s\].
    #[inline]
    pub(crate) fn mass(&self, face: FaceIndex) -> f64 {
        match face {
            FaceIndex::Radial(at) => self.mass_radial[at],
            FaceIndex::Axial(at) => self.mass_axial[at],
        }
    }

    /// Takes what is solved from a function of which (radial, axial velocity, pressure) and place.
    pub(crate) fn take(&mut self, gas: Carried<'_>, value: &dyn Fn(usize, f64, f64) -> f64) {
        let (grid, faces) = (gas.grid, &gas.setup.faces);
        for (face, u) in self.radial.iter_mut().enumerate() {
            if faces.radial[face] == Face::Solved {
                let (i, j) = (face % (grid.nr + 1), face / (grid.nr + 1));
                *u = value(0, grid.rf[i], grid.zc[j]);
            }
        }
        for (face, w) in self.axial.iter_mut().enumerate() {
            if faces.axial[face] == Face::Solved {
                *w = value(1, grid.rc[face % grid.nr], grid.zf[face / grid.nr]);
            }
        }
        for (k, p) in self.pressure.iter_mut().enumerate() {
            *p = value(2, grid.rc[k % grid.nr], grid.zc[k / grid.nr]);
        }
        self.carry(gas);
    }

    /// True if no speed is above `most` \[m/s\] and each is a number.
    pub(crate) fn within(&self, most: f64) -> bool {
        let mut speeds = self.radial.iter().chain(&self.axial);
        speeds.all(|u| u.abs() <= most)
    }

    /// Slows what is solved as a whole, so that no speed is above `most` \[m/s\]; fluxes that balance do so still.
    pub(crate) fn slow(&mut self, setup: &FlowCase, most: f64) {
        let Faces { radial, axial } = &setup.faces;
        let speeds = self.radial.iter().chain(&self.axial);
        let part = most / speeds.fold(most, |fastest, u| fastest.max(u.abs()));
        for (faces, velocity, mass) in [
            (radial, &mut self.radial, &mut self.mass_radial),
            (axial, &mut self.axial, &mut self.mass_axial),
        ] {
            let faces = faces.iter().zip(velocity).zip(mass);
            for ((_, u), m) in faces.filter(|((face, _), _)| **face == Face::Solved) {
                (*u, *m) = (part * *u, part * *m);
            }
        }
    }

    /// Face mass fluxes from velocities and density.
    pub(crate) fn carry(&mut self, gas: Carried<'_>) {
        let grid = gas.grid;
        for j in 0..grid.nz {
            for i in 0..=grid.nr {
                let face = grid.radial_face(i, j);
                let rho = self.radial_density(gas, i, j);
                self.mass_radial[face] = rho * grid.area(i, j) * self.radial[face];
            }
        }
        for j in 0..=grid.nz {
            for i in 0..grid.nr {
                let face = grid.axial_face(i, j);
                let rho = self.axial_density(gas, i, j);
                self.mass_axial[face] = rho * grid.ring[i] * self.axial[face];
            }
        }
    }
}
