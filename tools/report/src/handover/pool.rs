//! How far the pool of a weld reaches around its source.

use crate::weld::Weld;

/// How far the liquid around a source reaches \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pool {
    pub(super) across: f64,
    pub(super) depth: f64,
    pub(super) ahead: f64,
    pub(super) behind: f64,
}

impl Pool {
    /// Half of its width, its depth, and its lengths ahead of the source and behind it \[m\].
    pub(super) fn reaches(self) -> [f64; 4] {
        [self.across, self.depth, self.ahead, self.behind]
    }

    /// What has these reaches.
    pub(super) fn from_reaches([across, depth, ahead, behind]: [f64; 4]) -> Self {
        Self {
            across,
            depth,
            ahead,
            behind,
        }
    }

    /// The liquid of the bead below the surface of the plate, around a source; nothing where there is none.
    pub(super) fn of(weld: &Weld, source: [f64; 2]) -> Option<Self> {
        let half = 0.5 * weld.plate.spacing_m;
        let (across, along) = (weld.way.across(source), weld.way.along(source));
        let liquid = (0..weld.position.len()).filter(|i| weld.liquid[*i] && weld.belongs(*i));
        let mut pool: Option<Self> = None;
        for [x, y, z] in liquid.map(|i| weld.position[i]).filter(|x| x[2] < 0.0) {
            let own = Self {
                across: (x - across).abs() + half,
                depth: half - z,
                ahead: y - along + half,
                behind: along - y + half,
            };
            let so_far = pool.unwrap_or(own);
            pool = Some(Self {
                across: so_far.across.max(own.across),
                depth: so_far.depth.max(own.depth),
                ahead: so_far.ahead.max(own.ahead),
                behind: so_far.behind.max(own.behind),
            });
        }
        pool
    }

    /// The mean of pools.
    pub(super) fn mean(pools: &[Self]) -> Self {
        let mean = |of: fn(&Self) -> f64| pools.iter().map(of).sum::<f64>() / pools.len() as f64;
        Self {
            across: mean(|pool| pool.across),
            depth: mean(|pool| pool.depth),
            ahead: mean(|pool| pool.ahead),
            behind: mean(|pool| pool.behind),
        }
    }

    /// Whether its half axes are those of a body around the source, each at least `least` \[m\].
    pub(super) fn must_be_one(&self, least: f64) -> Result<(), String> {
        for (name, axis, where_) in [
            ("front_m", self.ahead, "behind"),
            ("rear_m", self.behind, "ahead of"),
        ] {
            if axis < least {
                return Err(format!(
                    "the pool lies {where_} its source: {name} would be {axis:.3e} m, and no double ellipsoid around the source has \
                     that. Let the source of the scene go where the heat is given"
                ));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pool_that_does_not_surround_its_source_is_no_ellipsoid() {
        let pool = |ahead, behind| Pool {
            across: 2e-3,
            depth: 1e-3,
            ahead,
            behind,
        };
        assert!(pool(1e-3, 4e-3).must_be_one(1e-4).is_ok());
        let told = pool(-2.1e-3, 6e-3).must_be_one(1e-4).unwrap_err();
        assert!(
            told.contains("front_m") && told.contains("behind its source"),
            "{told}"
        );
        assert!(pool(7.6e-11, 6e-3).must_be_one(1e-4).is_err());
        assert!(
            pool(4e-3, -1e-3)
                .must_be_one(1e-4)
                .unwrap_err()
                .contains("rear_m")
        );
    }
}
