//! `arc-cells`: what pools consume of the arcs of two studies, on three grids.

use std::path::Path;

use artefact::{Reader, Table};
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError, Subject};
use crate::plasma::Plasma;

/// The case.
pub(super) struct ArcCells;

/// Column of the surface and name of what the pool reads: heat, pressure, and the gas that drags it, at the height where
/// it reads the shear.
const READ: [(&str, &str); 3] = [
    ("heat_flux_total_w_m2", "heat"),
    ("arc_pressure_pa", "pressure"),
    ("gas_radial_velocity_m_s", "gas_velocity"),
];
/// Items of the balance that are compared.
const TOTALS: [(&str, &str); 4] = [
    ("voltage_v", "voltage"),
    ("base_input_w", "all_heat"),
    ("base_ion_w", "ions"),
    ("wire_total_w", "wire"),
];
/// Radius within which the pool is heated and pressed \[m\].
const WITHIN_M: f64 = 4e-3;

/// Heights of the grid of `gmaw-300a`, and the size of its cells there \[m\]: fine at the plate, where the gas slows down, and
/// along the side of the wire, where the arc ends.
const HEIGHTS: [[f64; 2]; 12] = [
    [-0.005, 5e-4],
    [-0.001, 1e-4],
    [-0.0002, 5e-5],
    [0.0, PLATE],
    [0.0001, PLATE],
    [0.0006, 1e-4],
    [0.0045, 1e-4],
    [0.0049, WIRE],
    [0.0057, WIRE],
    [0.0061, 1e-4],
    [0.010, 2e-4],
    [0.020, 7e-4],
];
/// Rows at the plate \[m\].
const PLATE: f64 = 1.25e-5;
/// Rows along the side of the wire \[m\].
const WIRE: f64 = 2.5e-5;

/// Those heights, with cells of another size.
fn rows(size: impl Fn(f64) -> f64) -> Value {
    json!({
        "at_m": HEIGHTS.map(|[at, _]| at),
        "spacing_m": HEIGHTS.map(|[_, spacing]| size(spacing)),
    })
}

/// An arc of a study.
struct Study {
    scene: &'static str,
    gas: &'static str,
    /// How much smaller the cells of each grid are than those of the one before.
    finer: f64,
    /// Cells of the third grid over those of the study.
    finest: f64,
    /// Grid of cells so many times as wide as those of the study.
    grid: fn(f64) -> Value,
    /// What the run beside it begins with, in place of a finer grid.
    start: Option<Value>,
}

impl Study {
    fn of(method: &str) -> Self {
        match method {
            // Cells of 0.4 mm leave a cavity of 136, and no room for its film of 0.05 mm.
            "submerged" => Self {
                scene: "pipelines/saw-600a-arc/arc.json",
                gas: "pipelines/gases/co-iron.json",
                finer: 1.5,
                finest: 1.0 / 1.5,
                grid: |times| json!({"r": 1e-4 * times, "z": 1e-4 * times}),
                start: None,
            },
            // Rows at the plate alone.
            "argon-wall" => Self {
                grid: |times| json!({"z": rows(|size| if size < 2.0 * PLATE { size * times } else { size })}),
                ..Self::of("argon")
            },
            // Rows along the wire alone, on one grid from two starts.
            "argon-starts" => Self {
                grid: |times| {
                    let wire = |size: f64| (size - WIRE).abs() < 0.1 * WIRE;
                    json!({"z": rows(|size| if wire(size) { size * times } else { size })})
                },
                start: Some(json!({"channel": {"radius_m": 0.005, "temperature_k": 16_000}})),
                ..Self::of("argon")
            },
            _ => Self {
                scene: "pipelines/gmaw-300a/arc.json",
                gas: "pipelines/gases/argon.json",
                finer: 2.0,
                finest: 1.0,
                grid: |times| {
                    let columns = [1e-4, 1e-4, 8e-4].map(|size| size * times);
                    json!({
                        "r": {"at_m": [0, 0.004, 0.025], "spacing_m": columns},
                        "z": rows(|size| size * times)
                    })
                },
                start: None,
            },
        }
    }

    /// The arc on cells `times` as wide, from the start of the study or another.
    fn run(
        &self,
        lab: &Lab,
        times: f64,
        start: Option<&Value>,
        method: &str,
        label: &str,
    ) -> Result<Finished, LabError> {
        let table = Path::new(self.gas);
        let name = table.file_stem().unwrap_or_default().to_string_lossy();
        let of = Subject::new("gasprop", ArcCells.name(), table);
        let gas = lab.run_scene(of, &name, &json!({}), &[])?;
        let mut patch = json!({"grid": (self.grid)(times), "heat": {"electrode_at": "surface"}});
        if let Some(start) = start {
            patch["start"] = start.clone();
        }
        let of = Subject::new("arcfvm", ArcCells.name(), Path::new(self.scene));
        let inputs: [(&str, &Path); 1] = [("gas", &gas.artefact)];
        lab.run_scene(of, &format!("{method}-{label}"), &patch, &inputs)
    }
}

/// Values of a column of `table` at `radius` \[m\], linear in between.
fn at(table: &Table, column: &str, radius: f64) -> Result<f64, LabError> {
    let (r, values) = (table.values("radius_m")?, table.values(column)?);
    let after = r.partition_point(|own| *own < radius).clamp(1, r.len() - 1);
    let share = (radius - r[after - 1]) / (r[after] - r[after - 1]);
    Ok(values[after - 1] + share * (values[after] - values[after - 1]))
}

/// Integral over the rings of the difference between two surfaces over that of the finer one.
fn difference(coarse: &Table, fine: &Table, column: &str) -> Result<f64, LabError> {
    let radius = coarse.values("radius_m")?;
    let (mut apart, mut whole, mut inner) = (0.0, 0.0, 0.0);
    for r in radius.iter().filter(|r| **r < WITHIN_M) {
        // Cells reach from one face to the next, their middles halfway.
        let outer = 2.0 * r - inner;
        let ring = outer * outer - inner * inner;
        let (here, there) = (at(coarse, column, *r)?, at(fine, column, *r)?);
        apart += ring * (here - there).abs();
        whole += ring * there.abs();
        inner = outer;
    }
    Ok(apart / whole)
}

impl Case for ArcCells {
    fn name(&self) -> &'static str {
        "arc-cells"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "the arc of gmaw-300a on cells of 0.4, 0.2, 0.1 mm, with rows of 50, 25, 12.5 um at the plate, and from another start; that of saw-600a-arc on 0.15, 0.1, 0.067 mm"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["argon", "argon-wall", "argon-starts", "submerged"]
    }

    /// A third difference would take a fourth grid.
    fn levels(&self, _: &str, asked: &[u32]) -> Vec<u32> {
        asked.iter().copied().filter(|level| *level <= 2).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let argon = [
            ("heat", 0.02),
            ("pressure", 0.04),
            ("voltage", 0.002),
            ("all_heat", 0.002),
            ("ions", 0.002),
            ("wire", 0.02),
        ];
        let submerged = [
            ("heat", 0.02),
            ("pressure", 0.02),
            ("voltage", 0.01),
            ("all_heat", 0.01),
            ("ions", 0.015),
            ("wire", 0.03),
        ];
        let mut all = vec![
            Target::order("gas_velocity", 0.9),
            Target::order("wire", 0.9),
        ];
        all.extend(argon.map(|(name, most)| Target::error(name, most)));
        let wall = [("heat", 0.01), ("gas_velocity", 0.08), ("all_heat", 0.005)];
        all.push(Target::order("gas_velocity", 0.5).of("argon-wall"));
        all.extend(wall.map(|(name, most)| Target::error(name, most).of("argon-wall")));
        let starts = ["heat", "pressure", "gas_velocity", "voltage", "all_heat"];
        all.extend(starts.map(|name| Target::error(name, 1e-5).of("argon-starts")));
        all.extend(submerged.map(|(name, most)| Target::error(name, most).of("submerged")));
        all
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let study = Study::of(method);
        // Level 1 is two steps from the finest grid.
        let steps = 3_u32.saturating_sub(level);
        let times = (0..steps).fold(study.finest, |times, _| times * study.finer);
        // From two starts both grids are the same, and the second is the study's.
        let (times, beside) = match study.start {
            Some(_) => (times / study.finer, times / study.finer),
            None => (times, times / study.finer),
        };
        let own = study.run(lab, times, None, method, &format!("grid{level}"))?;
        let finer = study.run(
            lab,
            beside,
            study.start.as_ref(),
            method,
            &format!("beside{level}"),
        )?;
        let open = |run: &Finished| Reader::open_kind(&run.artefact, "arc-source", 1);
        let (coarse, fine) = (open(&own)?, open(&finer)?);
        let mut errors = Errors::new();
        let [here, there] = [&coarse, &fine].map(|reader| reader.table("/surface"));
        let (here, there) = (here?, there?);
        for (column, name) in READ {
            errors.insert(name.to_owned(), difference(&here, &there, column)?);
        }
        let [here, there] = [&coarse, &fine].map(|reader| reader.record("/balance"));
        let (here, there) = (here?, there?);
        for (item, name) in TOTALS {
            errors.insert(
                name.to_owned(),
                (here.get(item)? / there.get(item)? - 1.0).abs(),
            );
        }
        let cells = Plasma::read(&own)?.cells();
        Ok(Measurement::of(own, cells, 1e-4 * times, errors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(n: usize, value: impl Fn(f64) -> f64) -> Table {
        let size = WITHIN_M / n as f64;
        let radius: Vec<f64> = (0..n).map(|k| (k as f64 + 0.5) * size).collect();
        let values: Vec<f64> = radius.iter().map(|r| value(*r)).collect();
        Table::new(n)
            .column("radius_m", "m", radius)
            .column("heat", "W/m2", values)
    }

    #[test]
    fn a_surface_a_tenth_too_hot_differs_by_a_tenth() {
        let fine = surface(80, |r| 1.0 + r);
        let coarse = surface(40, |r| 1.1 * (1.0 + r));
        assert!((difference(&coarse, &fine, "heat").unwrap() - 0.1).abs() < 1e-9);
    }

    #[test]
    fn rings_weigh_by_their_area() {
        // 1 within half of the radius, a quarter of the area; the other 0.
        let step = |r: f64| f64::from(u8::from(r < 0.5 * WITHIN_M));
        let (fine, coarse) = (surface(80, |_| 1.0), surface(40, step));
        assert!((difference(&coarse, &fine, "heat").unwrap() - 0.75).abs() < 1e-9);
    }
}
