//! A solution beyond the range of the tables that it was made with.
//!
//! Temperatures: gas is hot from half of its table's end on, where arcs are made. Beyond the table its columns are held or
//! extended; that is a guess, and it matters where more than a hundredth of the hot cells, or any cell beside an electrode,
//! live by it. Gas colder than the table begins matters where it is colder by more than a twentieth.
//! Pressure: properties are those of the table's pressure. Density goes with it, degrees of ionisation with its root, so that
//! a pressure that differs by a twentieth is about the error of the table itself (3 %), and more matters.
//! Tables of a scene that do not say how they are extrapolated are not.

use crate::error::Error;
use crate::material::{GAS, Law, Material, Strict, TableRange};
use crate::residual::part;
use crate::solver::Arc;

/// Hot cells beyond the table that matter, as a part of all hot cells.
const MOST_HOT: f64 = 0.01;
/// Part of its first temperature below which gas is too cold for a table.
const COLD: f64 = 0.95;
/// Part of the pressure of a table by which that of the gas may differ.
const MOST_PRESSURE: f64 = 0.05;
/// Part of the temperature that rounding may take a cell beyond a table.
const ROUNDING: f64 = 1e-6;

/// What is to be told of a range that a solution leaves.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Told {
    /// Whether the result can be wrong by it.
    pub matters: bool,
    /// In words.
    pub text: String,
}

impl Arc {
    /// Everything in which the solution lies beyond its tables.
    ///
    /// # Errors
    /// [`Error::BeyondTable`] where the scene does not let a table go on, [`Error::Unlawful`] where a formula is no property.
    pub fn beyond(&self) -> Result<Vec<Told>, Error> {
        self.lawful()?;
        for (index, material) in self.case.materials.iter().enumerate() {
            for range in &material.strict {
                self.keep(index, range)?;
            }
        }
        let Some(table) = &self.case.materials[GAS].table else {
            return Ok(Vec::new());
        };
        let all = [
            self.heat_beyond(table)?,
            self.cold(table),
            self.pressed(table),
        ];
        Ok(all.into_iter().flatten().collect())
    }

    /// The cells of a material.
    fn cells_of(&self, material: usize) -> impl Iterator<Item = usize> + Clone {
        let materials = self.case.material.iter().enumerate();
        materials
            .filter(move |(_, m)| **m == material)
            .map(|(k, _)| k)
    }

    /// Refuses temperatures of a material beyond a table that ends.
    fn keep(&self, material: usize, range: &Strict) -> Result<(), Error> {
        let (t, [from, to]) = (self.temperature(), range.temperature);
        let outside = |k: &usize| t[*k] < from * (1.0 - ROUNDING) || t[*k] > to * (1.0 + ROUNDING);
        let how_far = |k: usize| (from - t[k]).max(t[k] - to);
        let outside = self.cells_of(material).filter(outside);
        let farthest = outside.max_by(|a, b| how_far(*a).total_cmp(&how_far(*b)));
        farthest.map_or(Ok(()), |k| {
            Err(Error::BeyondTable {
                place: self.case.place(k),
                found: t[k],
                table: range.path.clone(),
                from,
                to,
                advice: "\"extrapolate\": \"constant\" keeps the value at the end".to_owned(),
            })
        })
    }

    /// Gas hotter than its table goes.
    fn heat_beyond(&self, table: &TableRange) -> Result<Option<Told>, Error> {
        let (t, [from, to]) = (self.temperature(), table.temperature);
        let gas = self.cells_of(GAS);
        let beyond = gas.clone().filter(|k| t[*k] > to * (1.0 + ROUNDING));
        let Some(hottest) = beyond.clone().max_by(|a, b| t[*a].total_cmp(&t[*b])) else {
            return Ok(None);
        };
        if table.is_error {
            return Err(Error::BeyondTable {
                place: self.case.place(hottest),
                found: t[hottest],
                table: table.column(),
                from,
                to,
                advice: "set gas.table.beyond_table to \"extend\" or \"hold\" to go on".to_owned(),
            });
        }
        let hot = gas.filter(|k| t[*k] > 0.5 * to).count();
        let (found, beside) = (beyond.count(), self.beside_electrodes(to));
        let share = part(found as f64, hot as f64);
        Ok(Some(Told {
            matters: share > MOST_HOT || beside[0] > 0,
            text: format!(
                "{} ends at {to:.0} K: {found} of {hot} hot gas cells (hotter than {:.0} K) and {} of {} beside \
                 electrodes are hotter, up to {:.0} K at {}; {}; a table to {:.0} K would hold it",
                table.column(),
                0.5 * to,
                beside[0],
                beside[1],
                t[hottest],
                self.case.place(hottest),
                self.guessed(hottest, to),
                500.0 * (t[hottest] / 500.0).ceil(),
            ),
        }))
    }

    /// Gas cells beside electrodes: those hotter than `end` \[K\], and all.
    fn beside_electrodes(&self, end: f64) -> [usize; 2] {
        let mut cells: Vec<usize> = self.case.contacts().iter().map(|c| c.gas).collect();
        cells.sort_unstable();
        cells.dedup();
        let t = self.temperature();
        let beyond = cells.iter().filter(|k| t[**k] > end).count();
        [beyond, cells.len()]
    }

    /// The column that goes farthest from its last value in cell `k`, beyond the end of the table.
    fn guessed(&self, k: usize, end: f64) -> String {
        let (grid, t) = (&self.case.grid, self.temperature()[k]);
        let (r, z) = (grid.rc[k % grid.nr], grid.zc[k / grid.nr]);
        let y = self.properties.iron_at(k);
        let ratio = |law: &Law| law.within(r, z, t, y) / law.within(r, z, end, y);
        let all = columns(&self.case.materials[GAS]);
        let all = all
            .into_iter()
            .filter_map(|(name, law)| Some((name, ratio(law.as_ref()?))));
        let changes = all.filter(|(_, ratio)| ratio.is_finite() && *ratio > 0.0);
        let most = changes.max_by(|a, b| a.1.ln().abs().total_cmp(&b.1.ln().abs()));
        match most.filter(|(_, ratio)| ratio.ln().abs() > ROUNDING) {
            Some((name, ratio)) => {
                format!("{name} is extended there to {ratio:.2} of its last value")
            }
            None => "every column is held there at its last value".to_owned(),
        }
    }

    /// Gas colder than its table begins.
    fn cold(&self, table: &TableRange) -> Option<Told> {
        let (t, [from, to]) = (self.temperature(), table.temperature);
        let gas = self.cells_of(GAS);
        let beyond = gas.clone().filter(|k| t[*k] < from * (1.0 - ROUNDING));
        let coldest = beyond.clone().min_by(|a, b| t[*a].total_cmp(&t[*b]))?;
        let far = gas.clone().filter(|k| t[*k] < COLD * from).count();
        Some(Told {
            matters: part(far as f64, gas.clone().count() as f64) > MOST_HOT,
            text: format!(
                "{} begins at {from:.0} K and goes to {to:.0} K: {} of {} gas cells are colder, down to {:.0} K at {}; \
                 every column is held there at its first value",
                table.column(),
                beyond.count(),
                gas.count(),
                t[coldest],
                self.case.place(coldest),
            ),
        })
    }

    /// Gas whose pressure is not that of its table.
    fn pressed(&self, table: &TableRange) -> Option<Told> {
        let pressure = &self.flowing.as_ref()?.flow.pressure;
        let size = |k: usize| pressure[k].abs();
        let farthest = self
            .cells_of(GAS)
            .max_by(|a, b| size(*a).total_cmp(&size(*b)))?;
        let off = size(farthest) / table.pressure;
        (off > MOST_PRESSURE).then(|| Told {
            matters: true,
            text: format!(
                "{}, column density_kg_m3 and all others hold at {:.0} Pa: the gas stands {:+.0} Pa off that at {}, \
                 {:.1} % where at most {:.0} % go unseen",
                table.name,
                table.pressure,
                pressure[farthest],
                self.case.place(farthest),
                100.0 * off,
                100.0 * MOST_PRESSURE,
            ),
        })
    }
}

impl TableRange {
    /// File and column of the temperatures.
    fn column(&self) -> String {
        format!("gas table {}, column temperature_k", self.name)
    }
}

/// The columns of a gas by name.
fn columns(gas: &Material) -> [(&'static str, &Option<Law>); 6] {
    [
        ("density_kg_m3", &gas.density),
        ("viscosity_pa_s", &gas.viscosity),
        ("thermal_conductivity_w_m_k", &gas.thermal_conductivity),
        ("electric_conductivity_s_m", &gas.electric_conductivity),
        ("net_emission_w_m3", &gas.net_emission),
        ("electron_density_1_m3", &gas.electron_density),
    ]
}
