//! Properties of every cell at its temperature: only the columns that the solved fields read.

use rayon::prelude::*;

use crate::case::Case;
use crate::material::{GAS, Law, Material};

/// Smallest electric conductivity \[S/m\]: far below any gas, so that the potential is defined
/// everywhere.
const LEAST_CONDUCTIVITY: f64 = 1e-9;

/// Columns of cell properties, `[nr nz]` where solved, empty where not.
#[derive(Debug, Clone, Default)]
pub struct Properties {
    /// Density \[kg/m3\].
    pub density: Vec<f64>,
    /// Viscosity \[Pa s\].
    pub viscosity: Vec<f64>,
    /// Electric conductivity \[S/m\].
    pub electric: Vec<f64>,
    /// Thermal conductivity \[W/(m K)\].
    pub thermal: Vec<f64>,
    /// Enthalpy \[J/kg\].
    pub enthalpy: Vec<f64>,
    /// Net emission \[W/m3\].
    pub emission: Vec<f64>,
    /// Mass fraction of iron that the others were taken at; empty without vapour.
    pub iron: Vec<f64>,
    /// Density times diffusion coefficient of iron \[kg/(m s)\]; empty without vapour.
    pub iron_diffusion: Vec<f64>,
    /// Electric conductivity before that of the sheath is set; empty without one.
    before: Vec<f64>,
}

impl Properties {
    /// The columns that `case` needs.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let n = case.grid.len();
        let column = |needed: bool| vec![0.0; if needed { n } else { 0 }];
        let heat = case.heat.is_some();
        let emits = case.materials[GAS].net_emission.is_some();
        let vapour = case.vapour.is_some();
        Self {
            density: column(case.flow.is_some() || vapour),
            viscosity: column(case.flow.is_some()),
            electric: column(case.potential.is_some()),
            thermal: column(heat),
            enthalpy: column(heat),
            emission: column(heat && emits),
            iron: column(vapour),
            iron_diffusion: column(vapour),
            before: Vec::new(),
        }
    }

    /// Mass fraction of iron in cell `k`; none without vapour.
    #[must_use]
    #[inline]
    pub fn iron_at(&self, k: usize) -> f64 {
        self.iron.get(k).copied().unwrap_or(0.0)
    }

    /// Takes them at `temperature` \[K, per cell\] and the mass fraction `iron`, where there is vapour.
    pub fn update(&mut self, case: &Case, temperature: &[f64], iron: Option<&[f64]>) {
        if let Some(iron) = iron {
            self.iron.copy_from_slice(iron);
        }
        let at = Places {
            case,
            temperature,
            iron,
        };
        let gas_only = |law: fn(&Material) -> &Option<Law>, floor: f64| {
            move |k: usize, p: Place| {
                let gas = case.material[k] == GAS;
                let law = law(case.of(k)).as_ref().filter(|_| gas);
                law.map_or(floor, |l| l.within(p.r, p.z, p.t, p.y))
            }
        };
        // Metals do not flow: any positive density and viscosity serves their cells.
        at.fill(&mut self.density, gas_only(|m| &m.density, 1.0));
        at.fill(&mut self.viscosity, gas_only(|m| &m.viscosity, 1.0));
        at.fill(&mut self.emission, gas_only(|m| &m.net_emission, 0.0));
        at.fill(
            &mut self.iron_diffusion,
            gas_only(|m| &m.iron_diffusion, 0.0),
        );
        for (product, density) in self.iron_diffusion.iter_mut().zip(&self.density) {
            *product *= density;
        }
        let all = |law: fn(&Material) -> &Option<Law>| {
            move |k: usize, p: Place| {
                law(case.of(k))
                    .as_ref()
                    .map_or(0.0, |l| l.within(p.r, p.z, p.t, p.y))
            }
        };
        let electric = all(|m| &m.electric_conductivity);
        at.fill(&mut self.electric, |k, p| {
            electric(k, p).max(LEAST_CONDUCTIVITY)
        });
        at.fill(&mut self.thermal, all(|m| &m.thermal_conductivity));
        at.fill(&mut self.enthalpy, |k, p| {
            let law = case.of(k).enthalpy.as_ref();
            law.map_or(0.0, |h| h.within(p.t, p.y))
        });
        self.sheath(case, temperature, iron);
    }

    /// Gas in the sheath of an electrode conducts as the gas beyond it does, or as gas with as many electrons
    /// (Komen 2019, section 5.2.3).
    fn sheath(&mut self, case: &Case, temperature: &[f64], iron: Option<&[f64]>) {
        let Some(sheath) = case.potential.as_ref().and_then(|p| p.sheath.as_ref()) else {
            return;
        };
        let (electric, before) = (&mut self.electric, &mut self.before);
        before.clone_from(electric);
        let state = |k: usize| [temperature[k], iron.map_or(0.0, |iron| iron[k])];
        for (k, value) in electric.iter_mut().enumerate() {
            *value = sheath.conductivity(&case.materials[GAS], before, state, k);
        }
    }
}

/// Radius, height, temperature and mass fraction of iron of a cell.
#[derive(Clone, Copy)]
struct Place {
    r: f64,
    z: f64,
    t: f64,
    y: f64,
}

/// Where every cell is, how warm it is and how much iron it holds.
#[derive(Clone, Copy)]
struct Places<'a> {
    case: &'a Case,
    temperature: &'a [f64],
    iron: Option<&'a [f64]>,
}

impl Places<'_> {
    /// Fills a column, if it is not absent.
    fn fill(&self, column: &mut [f64], value: impl Fn(usize, Place) -> f64 + Sync) {
        let grid = &self.case.grid;
        if column.is_empty() {
            return;
        }
        column
            .par_chunks_mut(grid.nr)
            .enumerate()
            .for_each(|(j, row)| {
                for (i, out) in row.iter_mut().enumerate() {
                    let k = grid.cell(i, j);
                    let place = Place {
                        r: grid.rc[i],
                        z: grid.zc[j],
                        t: self.temperature[k],
                        y: self.iron.map_or(0.0, |iron| iron[k]),
                    };
                    *out = value(k, place);
                }
            });
    }
}
