//! An arc whose columns fall off as a Gaussian: an input for pools that need one, made at once.

use std::collections::BTreeMap;
use std::path::Path;

use artefact::{Header, Table, Version, Writer};
use serde::Deserialize;

/// Half width and peaks of the columns.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bell {
    /// Radius at which everything has fallen to 1/e \[m\].
    pub radius_m: f64,
    /// Heat of ions on the axis \[W/m2\]; convection brings 0.6 of it, radiation 0.03, electrons take 0.05.
    pub ion_w_m2: f64,
    /// Current density on the axis \[A/m2\].
    pub current_a_m2: f64,
}

/// An arc of some 2 kW and 100 A.
pub const WELD: Bell = Bell {
    radius_m: 2e-3,
    ion_w_m2: 1e8,
    current_a_m2: 8e6,
};

/// Nodes along the radius and along the depth.
const NODES: [u32; 2] = [40, 10];

impl Bell {
    /// Writes the arc as `arcfvm` would.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, path: &Path) -> artefact::Result<()> {
        let mut writer = Writer::create(path, &header())?;
        writer.table("/surface", 0.0, &self.surface())?;
        writer.table("/lorentz", 0.0, &self.lorentz())?;
        writer.finish()
    }

    /// Radii up to five times the width \[m\].
    fn radii(&self) -> Vec<f64> {
        let step = 5.0 * self.radius_m / f64::from(NODES[0]);
        (0..NODES[0]).map(|i| step * f64::from(i)).collect()
    }

    fn at(&self, r: f64) -> f64 {
        (-(r / self.radius_m).powi(2)).exp()
    }

    fn surface(&self) -> Table {
        let radius = self.radii();
        let column =
            |peak: f64| -> Vec<f64> { radius.iter().map(|r| peak * self.at(*r)).collect() };
        let heat = |part: f64| column(part * self.ion_w_m2);
        let gas_k = column(1.4e4).into_iter().map(|t| 300.0 + t);
        let speed = radius.iter().map(|r| 4e4 * r * self.at(*r));
        Table::new(radius.len())
            .attribute("gas_velocity_height_m", "m", 3e-5)
            .attribute("gas_temperature_height_m", "m", 9e-5)
            .column("radius_m", "m", radius.iter().copied())
            .column("heat_flux_convection_w_m2", "W/m2", heat(0.6))
            .column("heat_flux_radiation_w_m2", "W/m2", heat(0.03))
            .column("heat_flux_electron_w_m2", "W/m2", heat(-0.05))
            .column("heat_flux_ion_w_m2", "W/m2", heat(1.0))
            .column("gas_temperature_k", "K", gas_k)
            .column("gas_radial_velocity_m_s", "m/s", speed)
            .column("arc_pressure_pa", "Pa", column(2000.0))
            .column("current_density_a_m2", "A/m2", column(self.current_a_m2))
            .column("ionisation_voltage_v", "V", radius.iter().map(|_| 15.68))
    }

    fn lorentz(&self) -> Table {
        let radius = self.radii();
        let depth: Vec<f64> = (0..NODES[1]).map(|i| 5e-4 * f64::from(i)).collect();
        let nodes = radius
            .iter()
            .flat_map(|r| depth.iter().map(move |z| (*r, *z)));
        let force: Vec<f64> = nodes
            .map(|(r, z)| -3e7 * r * self.at(r) * (-z / 2e-3).exp())
            .collect();
        let axes: [(&str, &str, &[f64]); 2] =
            [("radius_m", "m", &radius), ("depth_m", "m", &depth)];
        Table::grid(&axes)
            .column("lorentz_radial_n_m3", "N/m3", force.iter().copied())
            .column("lorentz_axial_n_m3", "N/m3", force.iter().map(|f| 0.5 * f))
    }
}

fn header() -> Header {
    Header {
        kind: "arc-source".to_owned(),
        version: Version::new(1, 0),
        tool: "arcfvm".to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene: serde_json::json!({"kind": "arcfvm.scene", "version": 1}),
        inputs: BTreeMap::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arc_that_is_named_a_weld_carries_its_current() {
        // The integral of a Gaussian over the plane.
        let total = std::f64::consts::PI * WELD.radius_m.powi(2) * WELD.current_a_m2;
        assert!((total - 100.0).abs() < 1.0, "{total}");
        let table = WELD.surface();
        let (r, j) = (
            table.values("radius_m").unwrap(),
            table.values("current_density_a_m2").unwrap(),
        );
        let rings = (1..r.len()).map(|i| {
            let middle = 0.5 * (r[i] + r[i - 1]);
            std::f64::consts::PI * middle * (r[i] - r[i - 1]) * (j[i] + j[i - 1])
        });
        assert!((rings.sum::<f64>() / total - 1.0).abs() < 0.01);
    }
}
