//! The Lorentz force of the arc's current in the metal (Komen 2019, eq. 4.1 and section 4.2.1).
//!
//! The arc, or a formula, gives j x B over the distance from its axis and the depth in a flat plate. The depth of a
//! particle is taken from the surface above it. What looks upwards is shared among the corners of squares of the plan, as
//! wide as the support of the kernel: bilinear by its place on the surface, by as much area as would be seen of it from
//! above. Between the corners the mean height is bilinear. Of evenly spread particles both keep a plane as it is.

use particles::Matter;
use rayon::prelude::*;
use run::Fault;
use run::property::{Arguments, Curve, OutOfRange, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shapes::frame::along;

use crate::near::{Near, Role};
use crate::patch::{self, Patches};
use crate::source::arcs::Burning;
use crate::source::{Place, arc};
use crate::stage::{Stage, StageError};
use crate::state::State;

/// A patch that looks upwards at least this much is surface seen from above.
const UPWARD: f64 = 0.3;
/// Particles per unit of parallel work.
const GRAIN: usize = 1024;

/// The Lorentz force (key `lorentz`): of the arc input, or of formulas.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Lorentz")]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Force density outwards and upwards, each a number or a formula in r, the distance from the axis of the source (m), and z, the
    /// height above the surface (m), below it negative; absent: the arc input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "N/m3"))]
    pub force_n_m3: Option<[Property; 2]>,
}

impl Parameters {
    /// The formulas, if there are any.
    ///
    /// # Errors
    /// A fault at the one that cannot be read.
    pub fn formula(&self) -> Result<Option<Force>, Fault> {
        let Some([outwards, upwards]) = &self.force_n_m3 else {
            return Ok(None);
        };
        let compiled = |part: &Property, k: usize| {
            let at = format!("/force_n_m3/{k}");
            part.compile(&at, &["r", "z"])
        };
        let both = [compiled(outwards, 0)?, compiled(upwards, 1)?];
        Ok(Some(Force::Formula(both)))
    }
}

/// The force over the distance from the axis and the depth.
pub enum Force {
    /// As the arc source has it, zero beyond its ends.
    Table(arc::Lorentz),
    /// In r and z, outwards and upwards \[N/m3\].
    Formula([Curve; 2]),
}

impl Force {
    /// Outwards and upwards, at the distance `r` and the `depth` \[m\] \[N/m3\].
    fn at(&self, r: f64, depth: f64) -> Result<(f64, f64), OutOfRange> {
        match self {
            Self::Table(table) => Ok(table.at(r, depth)),
            Self::Formula([outwards, upwards]) => {
                let at = Arguments {
                    r,
                    z: -depth,
                    ..Arguments::default()
                };
                Ok((outwards.value(&at)?, upwards.value(&at)?))
            }
        }
    }

    /// How far from the axis it acts \[m\]: a formula on all liquid of `near`.
    fn reach(&self, near: &Near, axis: Place) -> f64 {
        match self {
            Self::Table(table) => table.radius(),
            Self::Formula(_) => {
                let liquid = near.position.iter().zip(&near.role);
                let liquid = liquid.filter(|(_, role)| **role == Role::Liquid);
                liquid.fold(0.0, |most, (x, _)| axis.around(*x).0.max(most))
            }
        }
    }
}

/// The stage that lets the current pull.
pub struct Lorentz {
    /// The force of each arc, and where and how strongly it burns.
    arcs: Vec<(Force, Burning)>,
    heights: Heights,
}

impl Lorentz {
    /// The force of arcs in `metal`.
    #[must_use]
    pub fn new(arcs: Vec<(Force, Burning)>, metal: Matter) -> Self {
        Self {
            arcs,
            heights: Heights {
                edge: metal.support(),
                origin: [0.0; 2],
                side: 0,
                corners: Vec::new(),
            },
        }
    }
}

/// Heights of the surface at the corners of squares of the plan, around the axis.
struct Heights {
    edge: f64,
    origin: [f64; 2],
    /// Corners along each side.
    side: usize,
    /// Area and area times height.
    corners: Vec<(f64, f64)>,
}

/// A corner of a square, and the bilinear weight that it has at a place inside.
type Corner = (usize, f64);

impl Heights {
    /// Sums the surface of the copy within `reach` \[m\] of the axis.
    fn measure(&mut self, near: &Near, surface: Patches<'_>, axis: Place, reach: f64) {
        self.side = (2.0 * reach / self.edge) as usize + 2;
        self.origin = [0, 1].map(|k| axis.position[k] - reach);
        self.corners.clear();
        self.corners.resize(self.side * self.side, (0.0, 0.0));
        for (x, &id) in near.position.iter().zip(&near.id) {
            let a = id as usize;
            let (area, up) = (surface.area[a], surface.normal[a][2]);
            if area <= 0.0 || up <= UPWARD {
                continue;
            }
            let foot = surface.at(a).foot(*x);
            for (k, weight) in self.around(foot).into_iter().flatten() {
                let area = weight * up * area;
                self.corners[k].0 += area;
                self.corners[k].1 += area * foot[2];
            }
        }
    }

    /// The corners of the square at `x`; `None` beyond the last.
    fn around(&self, x: [f64; 3]) -> Option<[Corner; 4]> {
        let along = [0, 1].map(|k| (x[k] - self.origin[k]) / self.edge);
        let last = (self.side - 1) as f64;
        if !along.iter().all(|c| *c >= 0.0 && *c < last) {
            return None;
        }
        let [p, q] = along.map(f64::fract);
        let [i, j] = along.map(|c| c as usize);
        let at = j * self.side + i;
        Some([
            (at, (1.0 - p) * (1.0 - q)),
            (at + 1, p * (1.0 - q)),
            (at + self.side, (1.0 - p) * q),
            (at + self.side + 1, p * q),
        ])
    }

    /// Height of the surface above `x` \[m\]: the mean of the corners around by weight and area. `None` where there is no
    /// surface within an edge.
    fn above(&self, x: [f64; 3]) -> Option<f64> {
        let (mut area, mut moment) = (0.0, 0.0);
        for (k, weight) in self.around(x)? {
            area += weight * self.corners[k].0;
            moment += weight * self.corners[k].1;
        }
        (area > 0.0).then(|| moment / area)
    }
}

impl Stage for Lorentz {
    fn name(&self) -> &'static str {
        "lorentz"
    }

    fn declare(&self, state: &mut State) {
        patch::declare(&mut state.metal);
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let Some(source) = state.source else {
            return Ok(());
        };
        let (near, surface) = (&mut state.near, Patches::of(&state.metal));
        for (force, burning) in &self.arcs {
            let (axis, level) = (burning.place(source), burning.level(state.time, dt));
            if level <= 0.0 {
                continue;
            }
            let reach = force.reach(near, axis);
            self.heights.measure(near, surface, axis, reach);
            let heights = &self.heights;
            let pulled = near
                .force
                .par_iter_mut()
                .zip(&near.role)
                .zip(&near.position)
                .with_min_len(GRAIN)
                .filter(|((_, role), _)| **role == Role::Liquid)
                .try_for_each(|((sum, _), &x)| {
                    let (r, [outward_x, outward_y]) = axis.around(x);
                    let top = heights.above(x).unwrap_or(axis.position[2]);
                    let (radial, axial) = force.at(r, (top - x[2]).max(0.0))?;
                    let own = [radial * outward_x, radial * outward_y, axial];
                    *sum = along(*sum, level, own);
                    Ok(())
                });
            pulled
                .map_err(|fault: OutOfRange| StageError::Data(format!("Lorentz force: {fault}")))?;
        }
        Ok(())
    }

    fn bytes(&self) -> usize {
        16 * self.heights.corners.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forces::tests::{on_top, pool};

    /// -1e6 r to the axis and 1e7 z \[N/m3\] on liquid, nothing on all else.
    fn pulls_inwards_and_up(state: &State) {
        let near = &state.near;
        for (k, force) in near.force.iter().enumerate() {
            let x = near.position[k];
            let expected = match near.role[k] {
                Role::Liquid => [-1e6 * x[0], -1e6 * x[1], 1e7 * x[2]],
                _ => [0.0; 3],
            };
            for (found, expected) in force.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-6 * 1e4, "{force:?} at {x:?}");
            }
        }
    }

    #[test]
    fn depth_counts_from_the_surface_above() {
        let mut state = pool(|_| 1800.0);
        let d = state.metal.matter.spacing;
        on_top(&mut state, d * d);
        // Radial force -1e6 r, axial force -1e7 depth: both exact between the rows.
        let axes = [vec![1e-4, 1e-2], vec![0.0, 1e-2]];
        let radial = vec![-1e2, -1e2, -1e4, -1e4];
        let axial = vec![0.0, -1e5, 0.0, -1e5];
        let table = Force::Table(arc::Lorentz::new(axes, radial, axial));
        let arcs = vec![(table, Burning::default())];
        let mut stage = Lorentz::new(arcs, state.metal.matter);
        stage.advance(&mut state, 1e-4).unwrap();
        pulls_inwards_and_up(&state);
    }

    #[test]
    fn a_formula_acts_on_all_liquid_as_its_table_does() {
        let text = r#"{"force_n_m3": [{"expr": "-1e6*r"}, {"expr": "1e7*z"}]}"#;
        let parameters: Parameters = serde_json::from_str(text).unwrap();
        let mut state = pool(|_| 1800.0);
        let d = state.metal.matter.spacing;
        on_top(&mut state, d * d);
        let arcs = vec![(parameters.formula().unwrap().unwrap(), Burning::default())];
        let mut stage = Lorentz::new(arcs, state.metal.matter);
        stage.advance(&mut state, 1e-4).unwrap();
        pulls_inwards_and_up(&state);
    }

    #[test]
    fn a_formula_of_the_temperature_is_refused_by_name() {
        let text = r#"{"force_n_m3": [0, {"expr": "T"}]}"#;
        let parameters: Parameters = serde_json::from_str(text).unwrap();
        let fault = parameters.formula().err().unwrap();
        assert!(fault.path().starts_with("/force_n_m3/1"), "{fault}");
    }
}
