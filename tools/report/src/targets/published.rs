//! The section that was measured, to be drawn over the computed one.

use super::{Kind, Targets};
use crate::picture::cross::Published;

impl Targets {
    /// The section that was measured, as far as the rows tell it.
    pub(crate) fn published(&self) -> Published {
        let measured = |name: &str| {
            let rows = self.targets.iter().filter(|t| t.kind == Kind::Experiment);
            rows.clone().find(|t| t.measure == name).map(|t| t.value)
        };
        let wide = ["bead_width", "fused_width"].map(measured);
        let half = measured("fused_half_width");
        Published {
            depth: measured("penetration"),
            half_width: half.or(wide[0].or(wide[1]).map(|width| 0.5 * width)),
            height: measured("reinforcement"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::targets::{Bound, Target};

    #[test]
    fn the_section_that_was_measured_is_that_of_experiments() {
        let row = |measure: &str, value: f64, kind: Kind| Target {
            measure: measure.to_owned(),
            title: measure.to_owned(),
            value,
            unit: "m".to_owned(),
            source: "somewhere".to_owned(),
            kind,
            tolerance: None,
            bound: Bound::Within,
        };
        let targets = Targets {
            targets: vec![
                row("penetration", 2e-3, Kind::Simulation),
                row("penetration", 4.8e-3, Kind::Experiment),
                row("bead_width", 26e-3, Kind::Experiment),
            ],
        };
        let published = targets.published();
        assert_eq!(published.depth, Some(4.8e-3));
        assert_eq!(published.half_width, Some(13e-3));
        assert_eq!(published.height, None);
    }
}
