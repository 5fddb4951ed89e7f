//! Properties of every cell at its temperature: only the columns that the solved fields read.

use rayon::prelude::*;

use crate::case::{Case, GAS};
use crate::material::{Law, Material};

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
        Self {
            density: column(case.flow.is_some()),
            viscosity: column(case.flow.is_some()),
            electric: column(case.potential.is_some()),
            thermal: column(heat),
            enthalpy: column(heat),
            emission: column(heat && emits),
            before: Vec::new(),
        }
    }

    /// Takes them at `temperature` \[K, per cell\].
    pub fn update(&mut self, case: &Case, temperature: &[f64]) {
        let gas_only = |law: fn(&Material) -> &Option<Law>, floor: f64| {
            move |k: usize, place: [f64; 3]| {
                let gas = case.material[k] == GAS;
                let law = law(case.of(k)).as_ref().filter(|_| gas);
                law.map_or(floor, |l| l.at(place[0], place[1], place[2]))
            }
        };
        // Metals do not flow: any positive density and viscosity serves their cells.
        fill(
            case,
            temperature,
            &mut self.density,
            gas_only(|m| &m.density, 1.0),
        );
        fill(
            case,
            temperature,
            &mut self.viscosity,
            gas_only(|m| &m.viscosity, 1.0),
        );
        fill(
            case,
            temperature,
            &mut self.emission,
            gas_only(|m| &m.net_emission, 0.0),
        );
        let all = |law: fn(&Material) -> &Option<Law>| {
            move |k: usize, place: [f64; 3]| {
                law(case.of(k))
                    .as_ref()
                    .map_or(0.0, |l| l.at(place[0], place[1], place[2]))
            }
        };
        let electric = all(|m| &m.electric_conductivity);
        fill(case, temperature, &mut self.electric, |k, p| {
            electric(k, p).max(LEAST_CONDUCTIVITY)
        });
        fill(
            case,
            temperature,
            &mut self.thermal,
            all(|m| &m.thermal_conductivity),
        );
        fill(case, temperature, &mut self.enthalpy, |k, p| {
            case.of(k).enthalpy.as_ref().map_or(0.0, |h| h.at(p[2]))
        });
        self.sheath(case);
    }

    /// Gas in the sheath of an electrode conducts as the gas beyond it does (Komen 2019, section
    /// 5.2.3: equal electron density).
    fn sheath(&mut self, case: &Case) {
        let Some(sheath) = case.potential.as_ref().and_then(|p| p.sheath.as_ref()) else {
            return;
        };
        let (electric, before) = (&mut self.electric, &mut self.before);
        before.clone_from(electric);
        for (k, from) in sheath.from.iter().enumerate() {
            electric[k] = before[*from].max(before[k]);
        }
    }
}

fn fill(
    case: &Case,
    temperature: &[f64],
    column: &mut [f64],
    value: impl Fn(usize, [f64; 3]) -> f64 + Sync,
) {
    let grid = &case.grid;
    if column.is_empty() {
        return;
    }
    column
        .par_chunks_mut(grid.nr)
        .enumerate()
        .for_each(|(j, row)| {
            for (i, out) in row.iter_mut().enumerate() {
                let k = grid.cell(i, j);
                *out = value(k, [grid.rc[i], grid.zc[j], temperature[k]]);
            }
        });
}
