//! `liquid-split`: two drops that run into each other, become one, and part again where they met off their centres.

use serde_json::json;

use super::liquid_stretched::back;
use crate::case::{Case, Errors, Measurement, Target};
use crate::drop::{Series, points};
use crate::em::frames::planned;
use crate::lab::{Lab, LabError};

/// The case.
pub(super) struct LiquidSplit;

/// Spacings in the radius, by level.
const PARTS: [f64; 3] = [5.0, 6.0, 7.5];
/// Half the distance of the centres at the start, over the radius.
const APART: f64 = 1.1;

/// How two drops meet.
struct Meeting {
    name: &'static str,
    /// rho (2 R) U^2/gamma, with the closing speed U.
    weber: f64,
    /// Distance of their ways over the diameter.
    aside: f64,
    /// mu/sqrt(rho gamma R).
    ohnesorge: f64,
    /// End, over sqrt(rho R^3/gamma).
    end: f64,
    /// Drops at the end.
    drops: f64,
}

/// Slow ones become one that swings. At 50 they spread and come together again; off their centres they turn about each other, and the
/// bridge between them breaks (Ashgriz and Poo 1990: stretching separation). At 500 they spread into a sheet.
const MEETINGS: [Meeting; 4] = [
    Meeting {
        name: "0.1",
        weber: 0.1,
        aside: 0.0,
        ohnesorge: 0.1,
        end: 3.0,
        drops: 1.0,
    },
    Meeting {
        name: "50",
        weber: 50.0,
        aside: 0.0,
        ohnesorge: 0.1,
        end: 1.5,
        drops: 1.0,
    },
    Meeting {
        name: "50-aside",
        weber: 50.0,
        aside: 0.65,
        ohnesorge: 0.05,
        end: 2.5,
        drops: 2.0,
    },
    Meeting {
        name: "500",
        weber: 500.0,
        aside: 0.0,
        ohnesorge: 0.1,
        end: 0.5,
        drops: 1.0,
    },
];

impl Case for LiquidSplit {
    fn name(&self) -> &'static str {
        "liquid-split"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Volume, momentum and the sum of the energies; how many drops there are at the end"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["0.1", "50", "50-aside", "500"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = self.methods().iter().flat_map(|method| {
            [
                Target::error("mass", 1e-3).of(*method),
                Target::error("momentum", 1e-8).of(*method),
                Target::error("energy_back", 1e-9).of(*method),
                Target::error("drops", 0.0).of(*method),
                Target::error("time_left", 1e-6).of(*method),
            ]
        });
        // At 500 the sheet is thinner than any spacing here.
        let held = ["0.1", "50", "50-aside"];
        let strewn = held.map(|method| Target::error("strewn", 0.05).of(method));
        each.chain(strewn).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = PARTS[level.clamp(1, 3) as usize - 1];
        let meeting = MEETINGS.iter().find(|m| m.name == method);
        let meeting = meeting.unwrap_or(&MEETINGS[0]);
        let scene = planned(lab, self.name(), &json!({}))?;
        let number = |pointer: &str| {
            let found = scene.pointer(pointer).and_then(serde_json::Value::as_f64);
            found.unwrap_or(f64::NAN)
        };
        let radius = number("/liquid/shape/union/0/sphere/radius_m");
        let density = number("/liquid/density_kg_m3");
        let tension = number("/liquid/surface_tension_n_m");
        let closing = (meeting.weber * tension / (density * 2.0 * radius)).sqrt();
        let end = meeting.end * (density * radius.powi(3) / tension).sqrt();
        let ball = |side: f64| {
            let centre = [side * meeting.aside * radius, 0.0, side * APART * radius];
            json!({"sphere": {"centre_m": centre, "radius_m": radius}})
        };
        let patch = json!({
            "points": {"spacing_m": radius / parts},
            "liquid": {
                "shape": {"union": [ball(-1.0), ball(1.0)]},
                "viscosity_pa_s": meeting.ohnesorge * (density * tension * radius).sqrt(),
                "velocity_m_s": [0, 0, {"expr": format!("if(z, {:e}, {:e})", -0.5 * closing, 0.5 * closing)}],
                "march": {"end_s": end}
            }
        });
        let run = lab.run(
            self.tool(),
            self.name(),
            &format!("level{level}-{method}"),
            &patch,
        )?;
        let column = |name: &str| Series::read(&run, name);
        let kinetic = column("kinetic_energy")?;
        let energy = sum(&kinetic.value, &column("surface_energy")?.value);
        let volume = column("volume")?.value;
        let lost = volume.iter().map(|v| v / volume[0] - 1.0);
        let mut moved = 0.0_f64;
        for axis in ["x", "y", "z"] {
            let speeds = column(&format!("velocity_{axis}"))?.value;
            moved = greatest([
                moved,
                greatest(speeds.iter().map(|u| u - speeds[0])) / closing,
            ]);
        }
        let last = |series: &[f64]| series.last().copied().unwrap_or(f64::NAN);
        let drops = last(&column("drops")?.value);
        let strewn = last(&column("volume_parcels")?.value) / volume[0];
        let errors = Errors::from([
            ("energy_back".to_owned(), back(&energy)),
            ("mass".to_owned(), greatest(lost)),
            ("momentum".to_owned(), moved),
            ("drops".to_owned(), (drops - meeting.drops).abs()),
            ("strewn".to_owned(), strewn),
            ("time_left".to_owned(), 1.0 - last(&kinetic.time) / end),
        ]);
        let count = points(&run)?;
        let taken = run.closing("energy_taken");
        let costs = [("points", count as f64), ("energy_taken", taken)];
        Ok(Measurement::of(run, count, radius / parts, errors).at_costs(costs))
    }
}

/// Sum of two series.
fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

/// Greatest absolute value; NaN where one is.
fn greatest(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut most = 0.0_f64;
    for value in values {
        if value.is_nan() {
            return value;
        }
        most = most.max(value.abs());
    }
    most
}
