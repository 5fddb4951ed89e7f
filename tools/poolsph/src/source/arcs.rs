//! Arcs upon one source: one alone, one that pulses or alternates, or several that burn side by side.
//!
//! ```text
//! q(x, t) = sum_i w_i(t) q_i(|x - x_s(t) - o_i|)
//! ```
//!
//! q stands for all that the tables of an arc hold: heat, pressure, shear by the gas, and Lorentz force. Each arc is that of its
//! input above a flat plate, at an offset o_i from the axis x_s of the source and with a level w_i over time. A pulsed arc is
//! two such arcs, of the peak and of the base, of which one burns at a time; so is an alternating current. What the
//! currents of arcs that burn at once do to one another is left out. A level is that of the mean over a step.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use torch::Waveform;

use super::Place;
use crate::domain::droplet;
use crate::heat::ArcParameters;

/// The input that an arc is read from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ArcInput {
    /// `--input arc=FILE`.
    #[default]
    Arc,
    /// `--input arc2=FILE`.
    Arc2,
}

impl ArcInput {
    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Arc => "arc",
            Self::Arc2 => "arc2",
        }
    }
}

/// One of several arcs, or of the states of one (key `arcs`).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OneArc {
    /// The input that holds its tables.
    #[serde(default)]
    pub input: ArcInput,
    /// Its axis, relative to that of the source \[m\].
    #[serde(default)]
    #[schemars(extend("x-unit" = "m"))]
    pub offset_m: [f64; 3],
    /// Its level over time, repeated every period: 1 means the values of its tables. Always 1 if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waveform: Option<Waveform>,
    /// Its heat, in place of the key `arc` of the scene; for example where the plate is cathode and anode in turn. Absent: as the key
    /// `arc` says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heat: Option<ArcParameters>,
    /// Droplets of its own wire, besides those of the scene; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub droplets: Option<droplet::Parameters>,
}

impl OneArc {
    /// Where and how it burns.
    #[must_use]
    pub fn burning(&self) -> Burning {
        Burning {
            offset: self.offset_m,
            waveform: self.waveform.clone(),
        }
    }
}

/// Where an arc burns beside the axis of the source, and how strongly. By default: there, and as its tables say.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Burning {
    offset: [f64; 3],
    waveform: Option<Waveform>,
}

impl Burning {
    /// Its axis where that of the source is given \[m\].
    #[must_use]
    pub fn axis(&self, source: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| source[k] + self.offset[k])
    }

    /// Its place beside that of the source.
    #[must_use]
    pub fn place(&self, source: Place) -> Place {
        Place {
            position: self.axis(source.position),
            ..source
        }
    }

    /// Its mean level from `time` on over `dt` \[s\].
    #[must_use]
    pub fn level(&self, time: f64, dt: f64) -> f64 {
        let waveform = self.waveform.as_ref();
        waveform.map_or(1.0, |wave| wave.mean(time, time + dt))
    }

    /// The period of its waveform \[s\], if it has one.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        self.waveform.as_ref().map(|wave| wave.period_s)
    }

    /// Its greatest level.
    #[must_use]
    pub fn most(&self) -> f64 {
        self.waveform.as_ref().map_or(1.0, Waveform::most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: [f64; 3], exact: [f64; 3]) {
        for (found, exact) in found.iter().zip(exact) {
            assert!((found - exact).abs() < 1e-15, "{found} {exact}");
        }
    }

    #[test]
    fn an_arc_alone_burns_upon_the_axis_as_its_tables_say() {
        let alone = OneArc::default().burning();
        assert_eq!(alone, Burning::default());
        near(alone.axis([1.0, -2.0, 3.0]), [1.0, -2.0, 3.0]);
        assert!((alone.level(0.3, 1e-4) - 1.0).abs() <= 0.0 && (alone.most() - 1.0).abs() <= 0.0);
    }

    #[test]
    fn peak_and_base_burn_in_turn_beside_the_axis() {
        let arcs: Vec<OneArc> = serde_json::from_str(
            r#"[{"waveform": {"period_s": 0.01, "times_s": [0, 0.004, 0.004], "levels": [1, 1, 0]}},
                {"input": "arc2", "offset_m": [0, -0.01, 0],
                 "waveform": {"period_s": 0.01, "times_s": [0, 0.004, 0.004], "levels": [0, 0, 1]}}]"#,
        )
        .unwrap();
        let [peak, base] = [0, 1].map(|k: usize| arcs[k].burning());
        for time in [0.0, 0.003, 0.004, 0.0095, 3.21] {
            let both = peak.level(time, 7e-4) + base.level(time, 7e-4);
            assert!((both - 1.0).abs() < 1e-9, "{both}");
        }
        assert!((peak.level(0.0, 1.0) - 0.4).abs() < 1e-12);
        near(base.axis([0.0, 0.5, 0.0]), [0.0, 0.49, 0.0]);
        assert_eq!(arcs[1].input.name(), "arc2");
    }
}
