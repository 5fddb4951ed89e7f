//! `arc-surface`: what the base metal gets of an arc, on three grids.

use std::path::Path;

use artefact::{Reader, Table};
use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::plasma::Plasma;

/// The case.
pub(super) struct ArcSurface;

/// Column and name of what the pool reads of the surface.
const READ: [(&str, &str); 4] = [
    ("heat_flux_total_w_m2", "heat"),
    ("arc_pressure_pa", "pressure"),
    ("gas_radial_velocity_m_s", "gas_velocity"),
    ("current_density_a_m2", "current"),
];
/// Size of the coarsest cells \[m\].
const COARSEST_M: f64 = 4e-4;
/// Gas of the arc.
const GAS: &str = "pipelines/gases/argon-1atm.json";

fn spacing(level: u32) -> f64 {
    COARSEST_M / f64::from(1 << (level - 1))
}

fn run(lab: &Lab, level: u32, method: &str, label: &str) -> Result<Finished, LabError> {
    let size = spacing(level);
    let patch = json!({"grid": {"r": size, "z": size}, "iterate": {"solver": method}});
    let gas = lab.root.join(GAS);
    let label = format!("{method}-{label}{level}");
    let inputs: [(&str, &Path); 1] = [("gas", &gas)];
    lab.run_with("arcfvm", "arc-surface", &label, &patch, &inputs)
}

fn surface(run: &Finished) -> Result<Table, LabError> {
    Ok(Reader::open_kind(&run.artefact, "arc-source", 1)?.table("/surface")?)
}

/// Means of `fine` over the rings of cells twice as wide, `radius` being those of the fine cells.
fn over_pairs(radius: &[f64], fine: &[f64]) -> Vec<f64> {
    let pairs = radius.chunks_exact(2).zip(fine.chunks_exact(2));
    pairs
        .map(|(r, f)| (r[0] * f[0] + r[1] * f[1]) / (r[0] + r[1]))
        .collect()
}

/// Root of the area mean of the square of `of`, by rings.
fn norm(radius: &[f64], of: impl Fn(usize) -> f64) -> f64 {
    let weight: f64 = radius.iter().sum();
    let sum: f64 = radius
        .iter()
        .enumerate()
        .map(|(k, r)| r * of(k).powi(2))
        .sum();
    (sum / weight).sqrt()
}

/// Difference between a grid and one of half its cells, over the values of the latter.
fn difference(coarse: &Table, fine: &Table, column: &str) -> Result<f64, LabError> {
    let (radius, finer) = (coarse.values("radius_m")?, fine.values("radius_m")?);
    let there = over_pairs(finer, fine.values(column)?);
    let here = coarse.values(column)?;
    let (rings, n) = (radius, here.len().min(there.len()));
    let size = norm(&rings[..n], |k| there[k]);
    Ok(norm(&rings[..n], |k| here[k] - there[k]) / size)
}

impl Case for ArcSurface {
    fn name(&self) -> &'static str {
        "arc-surface"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "the same arc on cells of half the size, ring by ring; three grids give two differences and their order \
         p, and d/(2^p - 1) is what the finest still lacks (Richardson 1911)"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["multigrid", "sor"]
    }

    /// A third difference would take a fourth grid.
    fn levels(&self, _: &str, asked: &[u32]) -> Vec<u32> {
        asked.iter().copied().filter(|level| *level <= 2).collect()
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("heat", 0.08),
            Target::order("heat", 1.0),
            Target::error("pressure", 0.05),
            Target::order("pressure", 1.0),
            Target::error("current", 0.09),
            Target::order("current", 1.0),
            // Gas that has yet to reach its speed within the first cell: no order on these grids.
            Target::error("gas_velocity", 0.13),
            Target::error("voltage", 0.01),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let own = run(lab, level, method, "grid")?;
        let finer = run(lab, level + 1, method, "beside")?;
        let (coarse, fine) = (surface(&own)?, surface(&finer)?);
        let mut errors = Errors::new();
        for (column, name) in READ {
            errors.insert(name.to_owned(), difference(&coarse, &fine, column)?);
        }
        let voltage = |run: &Finished| -> Result<f64, LabError> {
            let balance = Reader::open_kind(&run.artefact, "arc-source", 1)?.record("/balance")?;
            Ok(balance.get("voltage_v")?)
        };
        let (here, there) = (voltage(&own)?, voltage(&finer)?);
        errors.insert("voltage".to_owned(), (here / there - 1.0).abs());
        let cells = Plasma::read(&own)?.cells();
        Ok(Measurement::of(own, cells, spacing(level), errors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(n: usize, value: impl Fn(f64) -> f64) -> Table {
        let size = 1.0 / n as f64;
        let radius: Vec<f64> = (0..n).map(|k| (k as f64 + 0.5) * size).collect();
        let values: Vec<f64> = radius.iter().map(|r| value(*r)).collect();
        Table::new(n)
            .column("radius_m", "m", radius)
            .column("heat", "W/m2", values)
    }

    #[test]
    fn rings_of_two_widths_hold_the_same_sum() {
        let fine = [0.5, 1.5, 2.5, 3.5];
        let means = over_pairs(&fine, &[8.0, 4.0, 2.0, 6.0]);
        let sum = |r: &[f64], f: &[f64]| r.iter().zip(f).map(|(r, f)| r * f).sum::<f64>();
        let wide = sum(&[1.0, 3.0], &means) * 2.0;
        assert!((wide - sum(&fine, &[8.0, 4.0, 2.0, 6.0])).abs() < 1e-12);
    }

    #[test]
    fn differences_of_a_first_order_error_halve() {
        let at = |n: usize| table(n, |r| 2.0 + r * r + 0.3 / n as f64);
        let (a, b, c) = (at(40), at(80), at(160));
        let (first, second) = (
            difference(&a, &b, "heat").unwrap(),
            difference(&b, &c, "heat").unwrap(),
        );
        assert!((first / second - 2.0).abs() < 0.1, "{first} {second}");
    }
}
