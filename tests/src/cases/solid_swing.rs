//! `solid-bar` and `solid-plate`: the first period of a clamped bar in space and of a clamped plate in plane strain.

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::{fault, finer, frames, swing};

/// A body that swings.
pub(super) struct SolidSwing {
    name: &'static str,
    reference: &'static str,
    /// Period by finite elements \[s\].
    period: f64,
    /// Largest errors of the period at levels 2 and 3.
    most: [f64; 2],
}

impl SolidSwing {
    /// The bar in space.
    pub(super) const BAR: Self = Self {
        name: "solid-bar",
        reference: "finite elements of order 3, converged: first period 0.27628 s",
        period: 0.27628,
        most: [0.02, 0.005],
    };
    /// The plate in plane strain.
    pub(super) const PLATE: Self = Self {
        name: "solid-plate",
        reference: "Gray, Monaghan and Swift (2001); finite elements: first period 0.2553 s",
        period: 0.2553,
        most: [0.03, 0.01],
    };
}

impl Case for SolidSwing {
    fn name(&self) -> &'static str {
        self.name
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        self.reference
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("period", self.most[0]).at_level(2),
            Target::error("period", self.most[1]).at_level(3),
            Target::error("amplitude_lost", 0.01).at_level(2),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        // 4, 8 and 16 rows.
        let by = f64::from(1 << (level.clamp(1, 4) - 1));
        let patch = finer(lab, self.name, by)?;
        let run = lab.run("jetsph", self.name, &format!("level{level}"), &patch)?;
        let solid = &run.scene["solids"][0];
        let spacing = solid["spacing_m"].as_f64().unwrap_or(f64::NAN);
        let frames = frames(&run.artefact, solid["name"].as_str().unwrap_or_default())?;
        let points = frames.first().map_or(0, artefact::Frame::len) as u64;
        let swing = swing(&frames)?.ok_or_else(|| fault(&run, "ends before the first period"))?;
        let errors = Errors::from([
            (
                "period".to_owned(),
                (swing.period / self.period - 1.0).abs(),
            ),
            ("amplitude_lost".to_owned(), (1.0 - swing.kept).abs()),
        ]);
        Ok(Measurement::of(run, points, spacing, errors))
    }
}
