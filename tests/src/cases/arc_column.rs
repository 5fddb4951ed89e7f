//! `arc-column`: a column that its radiation cools.

use std::f64::consts::PI;

use artefact::Reader;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::plasma::{self, Plasma};
use crate::special::{J0_ZERO, bessel_j};

/// The case.
pub(super) struct ArcColumn;

/// The exact column.
struct Column {
    /// Radius and length \[m\].
    radius: f64,
    length: f64,
    /// Temperature of the wall \[K\].
    wall: f64,
    /// Excess of the axis over the wall \[K\].
    excess: f64,
    /// Field strength \[V/m\].
    field: f64,
    /// Slope of the net emission against temperature \[W/(m3 K)\].
    emission: f64,
}

impl Column {
    fn of(run: &Finished) -> Result<Self, LabError> {
        let radius = plasma::number(run, "/domain/r_m/1")?;
        let conduction = plasma::number(run, "/gas/given/thermal_conductivity_w_m_k")?;
        let current = plasma::number(run, "/current/edges/top/0/total_current_a")?;
        let curvature = conduction * (J0_ZERO / radius).powi(2);
        let wall = plasma::number(run, "/heat/edges/outer/0/temperature_k")?;
        let conductivity = plasma::slope(run, "/gas/given/electric_conductivity_s_m", wall)?;
        let emission = plasma::slope(run, "/gas/given/net_emission_w_m3", wall)?;
        let field = ((curvature + emission) / conductivity).sqrt();
        let per_kelvin = conductivity * field * area(radius);
        Ok(Self {
            radius,
            length: plasma::number(run, "/domain/z_m/1")?,
            wall,
            excess: current / per_kelvin,
            field,
            emission,
        })
    }

    fn temperature(&self, r: f64) -> f64 {
        self.wall + self.excess * bessel_j(0, J0_ZERO * r / self.radius)
    }

    /// What the whole column radiates \[W\].
    fn radiation(&self) -> f64 {
        self.emission * self.excess * area(self.radius) * self.length
    }
}

/// Integral of J0(2.405 r/R) over the section \[m2\].
fn area(radius: f64) -> f64 {
    2.0 * PI * radius.powi(2) * bessel_j(1, J0_ZERO) / J0_ZERO
}

impl Case for ArcColumn {
    fn name(&self) -> &'static str {
        "arc-column"
    }

    fn tool(&self) -> &'static str {
        "arcfvm"
    }

    fn reference(&self) -> &'static str {
        "k lap T + sigma E^2 - U = 0 with sigma = a (T - Tw), U = b (T - Tw): \
         T = Tw + (T0 - Tw) J0(2.405 r/R), E^2 = (k (2.405/R)^2 + b)/a"
    }

    fn targets(&self) -> Vec<Target> {
        plasma::targets(&["temperature_linf", "field", "radiation"], 5e-3, 1.9)
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing = 5e-4 / f64::from(1 << (level - 1));
        let grid = serde_json::json!({"grid": {"r": spacing}});
        let run = lab.run("arcfvm", self.name(), &format!("level{level}"), &grid)?;
        let exact = Column::of(&run)?;
        let fields = Plasma::read(&run)?;
        let temperature = fields.compare("temperature_k", |r, _| exact.temperature(r))?;
        let potential = fields.field("potential_v")?;
        let last = fields.height.len() - 1;
        let rise = potential[fields.at(0, last)] - potential[fields.at(0, 0)];
        let field = rise / (fields.height[last] - fields.height[0]);
        let balance = Reader::open_kind(&run.artefact, "arc-source", 1)?.record("/balance")?;
        let radiated = -balance.get("heat_radiation_w")?;
        let errors = Errors::from([
            ("temperature_l2".to_owned(), temperature.0),
            ("temperature_linf".to_owned(), temperature.1),
            ("field".to_owned(), (field / exact.field - 1.0).abs()),
            (
                "radiation".to_owned(),
                (radiated / exact.radiation() - 1.0).abs(),
            ),
        ]);
        Ok(plasma::measurement(run, &fields, spacing, errors))
    }
}
