//! The gas that a table makes.

use std::sync::Arc;

use props::{Integral, Surface, Table};

use super::gas_file::GasFile;
use crate::diffusion::{Pure, diffusion};
use crate::error::Error;
use crate::material::{Enthalpy, Law, Material, TableRange};
use crate::mixture::{Mixed, Molar};
use crate::scene::{BeyondTable, Diffusion};

/// Temperature to which a table is extended at least \[K\].
const EXTENDED_K: f64 = 60_000.0;
/// Rows of the extension.
const EXTENDED_ROWS: usize = 40;
/// Part by which the rise of the enthalpy may differ from what the specific heat says.
const HEAT_SLACK: f64 = 0.05;

impl GasFile {
    /// As [`GasFile::table`], with more rows beyond the end where the table is to go on.
    fn row(&self, name: &str, iron: usize, beyond: BeyondTable) -> Result<Table, Error> {
        let table = self.table(name, iron)?;
        if beyond != BeyondTable::Extend {
            return Ok(table);
        }
        let (mut t, mut y) = (table.nodes().to_vec(), table.values().to_vec());
        let (t_end, y_end) = (t[t.len() - 1], y[y.len() - 1]);
        let slope = table.slope(t_end);
        let last = EXTENDED_K.max(2.0 * t_end);
        // Enough rows for the curve of the density.
        for k in 1..=EXTENDED_ROWS {
            let next = t_end + (last - t_end) * k as f64 / EXTENDED_ROWS as f64;
            t.push(next);
            y.push(match name {
                "density_kg_m3" => y_end * t_end / next,
                "viscosity_pa_s" => y_end,
                _ => (y_end + slope * (next - t_end)).max(0.5 * y_end),
            });
        }
        Table::new(t, y).map_err(|e| Error::GasTable(format!("{name}: {e}")))
    }

    /// The gas without iron as a material.
    ///
    /// # Errors
    /// When a column is missing or is not a table.
    pub fn material(&self, beyond: BeyondTable) -> Result<Material, Error> {
        let law = |name: &str| self.row(name, 0, beyond).map(Law::Table);
        let specific_heat = self.row("specific_heat_j_kg_k", 0, beyond)?;
        let bad = |e: props::Error| Error::GasTable(format!("specific_heat_j_kg_k: {e}"));
        let enthalpy = Enthalpy::new(&specific_heat, None).map_err(bad)?;
        self.made_of(beyond, enthalpy, &law)
    }

    /// The gas with iron vapour as a material, which diffuses as `rule` says.
    ///
    /// # Errors
    /// When the table does not hold every fraction of iron, a column is missing or not a table, or
    /// the enthalpy does not rise as the specific heat says.
    pub fn mixture(&self, beyond: BeyondTable, rule: Diffusion) -> Result<Material, Error> {
        let (Some(molar), true) = (self.molar, self.holds_all_iron()) else {
            let what = "holds no iron: vapour wants rows from iron_mole_fraction 0 to 1";
            return Err(Error::GasTable(what.to_owned()));
        };
        let law = |name: &str| {
            let table = Arc::new(self.surface(name, &self.fractions, beyond)?);
            Ok(Law::Mixed(Mixed { table, molar }))
        };
        // An enthalpy per mass is linear in the mass fraction.
        let masses: Vec<f64> = self.fractions.iter().map(|x| molar.mass(*x)).collect();
        let enthalpy = self.surface("enthalpy_j_kg", &masses, beyond)?;
        self.check_heat(&enthalpy)?;
        let mut gas = self.made_of(beyond, Enthalpy::Mixed(Arc::new(enthalpy)), &law)?;
        gas.iron_diffusion = Some(match rule {
            Diffusion::Given => law("iron_diffusion_m2_s")?,
            Diffusion::Viscosity => self.by_viscosity(beyond, molar)?,
        });
        Ok(gas)
    }

    fn holds_all_iron(&self) -> bool {
        let last = self.fractions.last().copied().unwrap_or_default();
        self.fractions.first() == Some(&0.0) && (last - 1.0).abs() < 1e-9
    }

    /// Everything but the enthalpy and the diffusion of iron.
    fn made_of(
        &self,
        beyond: BeyondTable,
        enthalpy: Enthalpy,
        law: &dyn Fn(&str) -> Result<Law, Error>,
    ) -> Result<Material, Error> {
        let electrons = "electron_density_1_m3";
        let tells_electrons = self.columns.iter().any(|c| c.name == electrons);
        Ok(Material {
            name: "gas".to_owned(),
            density: Some(law("density_kg_m3")?),
            viscosity: Some(law("viscosity_pa_s")?),
            thermal_conductivity: Some(law("thermal_conductivity_w_m_k")?),
            electric_conductivity: Some(law("electric_conductivity_s_m")?),
            net_emission: Some(law("net_emission_w_m3")?),
            electron_density: tells_electrons.then(|| law(electrons)).transpose()?,
            iron_diffusion: None,
            melting: None,
            table: self.range(beyond),
            strict: Vec::new(),
            enthalpy: Some(enthalpy),
        })
    }

    fn range(&self, beyond: BeyondTable) -> Option<TableRange> {
        Some(TableRange {
            name: self.name.clone(),
            temperature: [*self.temperatures.first()?, *self.temperatures.last()?],
            pressure: self.pressure,
            is_error: beyond == BeyondTable::Error,
        })
    }

    /// A column over `nodes` (one for each fraction of iron) and temperature.
    fn surface(&self, name: &str, nodes: &[f64], beyond: BeyondTable) -> Result<Surface, Error> {
        let rows = (0..self.fractions.len()).map(|iron| self.row(name, iron, beyond));
        let rows = rows.collect::<Result<Vec<_>, _>>()?;
        Surface::new(nodes.to_vec(), rows).map_err(|e| Error::GasTable(format!("{name}: {e}")))
    }

    /// The enthalpy rises with temperature, in all as much as the specific heat says.
    fn check_heat(&self, enthalpy: &Surface) -> Result<(), Error> {
        for (iron, row) in enthalpy.rows().iter().enumerate() {
            let at = format!("enthalpy_j_kg at iron {}", self.fractions[iron]);
            if let Some(k) = row.values().windows(2).position(|h| h[1] <= h[0]) {
                let t = row.nodes()[k + 1];
                return Err(Error::GasTable(format!("{at}: does not rise at {t} K")));
            }
            let specific = self.table("specific_heat_j_kg_k", iron)?;
            let specific = Integral::new(&specific)
                .map_err(|e| Error::GasTable(format!("specific_heat_j_kg_k: {e}")))?;
            let (first, last) = (
                self.temperatures[0],
                row.nodes()[self.temperatures.len() - 1],
            );
            let (found, wanted) = (row.held(last) - row.held(first), specific.value(last));
            if (found - wanted).abs() > HEAT_SLACK * wanted {
                return Err(Error::GasTable(format!(
                    "{at}: rises by {found:.4e} J/kg from {first} K to {last} K; \
                     specific_heat_j_kg_k says {wanted:.4e} J/kg"
                )));
            }
        }
        Ok(())
    }

    /// Diffusion of iron by eq. 5.25, from the pure gases.
    fn by_viscosity(&self, beyond: BeyondTable, molar: Molar) -> Result<Law, Error> {
        let pure = |iron: usize, molar: f64| {
            Ok::<_, Error>(Pure {
                density: Law::Table(self.row("density_kg_m3", iron, beyond)?),
                viscosity: Law::Table(self.row("viscosity_pa_s", iron, beyond)?),
                molar,
            })
        };
        let gas = pure(0, molar.gas)?;
        let iron = pure(self.fractions.len() - 1, molar.iron)?;
        Ok(Law::formula(move |_, _, t, _| diffusion(&iron, &gas, t)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::gas_file::tests::{file, mixed};
    use super::*;

    #[test]
    fn an_extended_table_goes_on_and_a_held_one_does_not() {
        let extended = file().material(BeyondTable::Extend).unwrap();
        let at = |law: &Option<Law>, t: f64| law.as_ref().unwrap().at(0.0, 0.0, t);
        assert!((at(&extended.density, 40_000.0) - 0.005).abs() < 1e-5);
        assert!((at(&extended.net_emission, 25_000.0) - 4.45e10).abs() < 1.0);
        assert!((at(&extended.viscosity, 50_000.0) - 1e-4).abs() < 1e-15);
        let held = file().material(BeyondTable::Hold).unwrap();
        assert!((at(&held.net_emission, 25_000.0) - 3e10).abs() < 1.0);
        let strict = file().material(BeyondTable::Error).unwrap();
        let range = |gas: &Material| gas.table.clone().unwrap();
        assert!(range(&strict).is_error && !range(&held).is_error && !range(&extended).is_error);
        for gas in [&strict, &held, &extended] {
            let [from, to] = range(gas).temperature;
            assert!((from - 300.0).abs() < 1e-9 && (to - 20_000.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_table_with_iron_is_linear_in_moles_and_its_heat_in_mass() {
        let file = GasFile::from_table(&mixed()).unwrap();
        assert!((file.pressure - 2e5).abs() < 1e-9);
        let gas = file.mixture(BeyondTable::Hold, Diffusion::Given).unwrap();
        let y = 0.06 / 0.1; // half of the moles
        let at = |law: &Option<Law>, t: f64, y: f64| law.as_ref().unwrap().within(0.0, 0.0, t, y);
        assert!((at(&gas.density, 10_000.0, y) - 0.06).abs() < 1e-15);
        assert!((at(&gas.electron_density, 10_000.0, y) - 1.5e22).abs() < 1e8);
        assert!((at(&gas.iron_diffusion, 20_000.0, 1.0) - 6e-2).abs() < 1e-15);
        let heat = gas.enthalpy.as_ref().unwrap();
        let pure = heat.within(10_000.0, 0.0);
        assert!((heat.within(10_000.0, y) / pure - 1.6).abs() < 1e-12);
        // Without vapour the first row is the gas, whose heat is the integral of its specific heat.
        let cold = file.material(BeyondTable::Hold).unwrap();
        assert!((at(&cold.density, 10_000.0, y) - 0.04).abs() < 1e-15);
        let mut alike = cold.enthalpy.as_ref().unwrap().at(10_000.0);
        alike = alike / pure - 1.0;
        assert!(alike.abs() < 1e-12, "{alike}");
    }

    #[test]
    fn diffusion_by_viscosity_takes_the_pure_gases() {
        let file = GasFile::from_table(&mixed()).unwrap();
        let gas = file
            .mixture(BeyondTable::Hold, Diffusion::Viscosity)
            .unwrap();
        let law = gas.iron_diffusion.unwrap();
        // Both gases have the same mu/rho = 5e-3 at 10,000 K; only the masses differ.
        let (a, b) = (0.04_f64.powf(-0.25), 0.06_f64.powf(-0.25));
        let masses = (1.0 / 0.04 + 1.0 / 0.06_f64).sqrt();
        let want = 2.0 * 2.0_f64.sqrt() * masses * 1.385 * 5e-3 / (a + b).powi(2);
        assert!((law.within(0.0, 0.0, 10_000.0, 0.3) / want - 1.0).abs() < 1e-12);
    }

    #[test]
    fn tables_that_hold_no_iron_or_wrong_heat_are_refused() {
        let told = |file: &GasFile| {
            let gas = file.mixture(BeyondTable::Hold, Diffusion::Given);
            gas.unwrap_err().to_string()
        };
        assert!(told(&file()).contains("holds no iron"));
        let mut wrong = GasFile::from_table(&mixed()).unwrap();
        let heat = wrong
            .columns
            .iter_mut()
            .find(|c| c.name == "enthalpy_j_kg")
            .unwrap();
        heat.values[5] *= 1.2;
        assert!(told(&wrong).contains("enthalpy_j_kg at iron 1: rises by"));
        let heat = wrong
            .columns
            .iter_mut()
            .find(|c| c.name == "enthalpy_j_kg")
            .unwrap();
        heat.values[1] = -1.0;
        assert!(told(&wrong).contains("iron 0: does not rise at 10000 K"));
    }
}
