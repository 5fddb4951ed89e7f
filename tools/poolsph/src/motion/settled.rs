//! Whether the pressure was found: how many solves ended before they met the tolerance of the scene.

/// Share of the solves that may end short: single splashes do.
const FEW: f64 = 0.01;

/// Solves and how they ended.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Settled {
    solves: f64,
    /// Those that ended above the tolerance, or with no number.
    short: f64,
    /// Greatest error of these over the tolerance.
    worst: f64,
}

impl Settled {
    /// Takes note of a solve that ended with an error, where the scene wants `tolerance`.
    pub(super) fn note(&mut self, error: f64, tolerance: f64) {
        self.solves += 1.0;
        let part = error / tolerance;
        if part.is_nan() || part > 1.0 {
            self.short += 1.0;
            self.worst = if part.is_nan() {
                f64::INFINITY
            } else {
                self.worst.max(part)
            };
        }
    }

    /// What a reader of the run must be told, if that is more than a few; `most` is the greatest number of sweeps.
    pub(super) fn warning(&self, most: u32) -> Option<String> {
        (self.short > FEW * self.solves).then(|| {
            format!(
                "flow: {:.0} of {:.0} pressure solves ended above density_tolerance after {most} sweeps, by a factor of up to {:.3}: \
                 the metal is compressed there; a shorter step or more sweeps_max helps",
                self.short, self.solves, self.worst
            )
        })
    }

    pub(super) fn save(&self) -> [f64; 3] {
        [self.solves, self.short, self.worst]
    }

    /// Takes back what [`Self::save`] gave, from the beginning of `saved`; gives the rest.
    pub(super) fn restored(saved: &[f64]) -> (Self, &[f64]) {
        match saved {
            [solves, short, worst, rest @ ..] => (
                Self {
                    solves: *solves,
                    short: *short,
                    worst: *worst,
                },
                rest,
            ),
            _ => (Self::default(), saved),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_ends_above_the_tolerance_is_counted_and_told() {
        let mut settled = Settled::default();
        for _ in 0..995 {
            settled.note(1e-5, 5e-5);
        }
        for _ in 0..5 {
            settled.note(1e-4, 5e-5);
        }
        assert_eq!(settled.warning(100), None);
        for _ in 0..10 {
            settled.note(2e-4, 5e-5);
        }
        let told = settled.warning(100).unwrap();
        assert!(
            told.contains("15 of 1010") && told.contains("up to 4.000"),
            "{told}"
        );
        settled.note(f64::NAN, 5e-5);
        assert!(settled.warning(100).unwrap().contains("16 of 1011"));
        let saved = settled.save();
        let (again, rest) = Settled::restored(&saved);
        assert_eq!((again, rest), (settled, &[][..]));
    }
}
