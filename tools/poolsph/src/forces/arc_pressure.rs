//! The pressure of the arc on the surface: F = -p dA/dV n, with the outward normal n.
//!
//! Of the vertical part, dA n_z is the area that the particle has as seen from above: the force on the
//! pool is that of the arc's table however torn the surface is, and nothing presses on what lies
//! hidden below an overhang. Sideways, walls are pressed and undersides are not: a slab with both its faces free would
//! else feel no sideways force at all, however it is inclined. What a particle has of the plan lies around it, and
//! takes the pressure there; its wall lies before it on the surface.
//!
//! Where the flow is without divergence ([`crate::motion::divergence_free`]) it is no force but the pressure at the
//! surface, of which one that is the same everywhere moves nothing.
//!
//! Komen (2019, section 4.4.1) takes the pressure from the gas speed by Bernoulli's law and finds it
//! too small; here it is the arc's own, at the same distance from the axis, or that of a formula.

use particles::Matter;
use run::Fault;
use run::property::{Arguments, Curve, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shapes::frame::along;
use steps::Figure;

use crate::mean;
use crate::near::Role;
use crate::patch::{self, Patches};
use crate::source::Place;
use crate::source::arc::Radial;
use crate::source::arcs::Burning;
use crate::stage::{Stage, StageError};
use crate::state::State;

/// The pressure of the arc (key `arc_pressure`): of the arc input, or of a formula.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Pressure in r, the distance from the axis of the source (m), and t; absent: the arc input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "Pa"))]
    pub pressure_pa: Option<Property>,
}

impl Parameters {
    /// The formula, if there is one.
    ///
    /// # Errors
    /// A fault where the formula cannot be read.
    pub fn formula(&self) -> Result<Option<Pressure>, Fault> {
        let Some(property) = &self.pressure_pa else {
            return Ok(None);
        };
        let curve = property.compile("/pressure_pa", &["r", "t"])?;
        Ok(Some(Pressure::Formula(curve)))
    }
}

/// The pressure over the distance from the axis.
pub enum Pressure {
    /// As the arc source has it, zero beyond its last row \[Pa\].
    Table(Radial),
    /// In r and t \[Pa\].
    Formula(Curve),
}

impl Pressure {
    /// The mean pressure at the distance `r` \[m\] \[Pa\], and whether all of it was found.
    fn at(&self, r: f64, time: f64, dt: f64) -> Result<(f64, bool), StageError> {
        match self {
            Self::Table(table) => Ok((table.at(r), true)),
            Self::Formula(curve) => {
                let at = Arguments {
                    r,
                    time,
                    ..Arguments::default()
                };
                let mean = mean::in_time(curve, &at, dt);
                mean.map_err(|fault| StageError::Data(format!("pressure of the arc: {fault}")))
            }
        }
    }
}

/// The stage that presses on the surface.
pub struct ArcPressure {
    /// The pressure of each arc, and where and how strongly it burns.
    arcs: Vec<(Pressure, Burning)>,
    /// Axes of the arcs in a step, and their levels.
    stands: Vec<(Place, f64)>,
    volume: f64,
    /// The pressure is a condition at the surface, not a force.
    bound: bool,
    pressed: f64,
    /// Whether something of a pressure that varies in time may have been missed.
    missed: bool,
}

impl ArcPressure {
    /// The pressure of arcs on `metal`; `bound`: as a condition at the surface, not as a force.
    #[must_use]
    pub fn new(arcs: Vec<(Pressure, Burning)>, metal: Matter, bound: bool) -> Self {
        Self {
            arcs,
            stands: Vec::new(),
            volume: metal.volume(),
            bound,
            pressed: 0.0,
            missed: false,
        }
    }
}

impl ArcPressure {
    /// The pressure of all arcs at a place \[Pa\], and whether all of it was found.
    fn above(&self, x: [f64; 3], time: f64, dt: f64) -> Result<(f64, bool), StageError> {
        let (mut sum, mut all) = (0.0, true);
        for ((pressure, _), (axis, level)) in self.arcs.iter().zip(&self.stands) {
            if *level > 0.0 {
                let (mean, found) = pressure.at(axis.around(x).0, time, dt)?;
                (sum, all) = (sum + level * mean, all && found);
            }
        }
        Ok((sum, all))
    }
}

impl Stage for ArcPressure {
    fn name(&self) -> &'static str {
        "arc_pressure"
    }

    fn declare(&self, state: &mut State) {
        patch::declare(&mut state.metal);
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        self.pressed = 0.0;
        let Some(source) = state.source else {
            return Ok(());
        };
        self.stands.clear();
        let stand = |burning: &Burning| (burning.place(source), burning.level(state.time, dt));
        let stands = self.arcs.iter().map(|(_, burning)| stand(burning));
        self.stands.extend(stands);
        let (near, surface) = (&mut state.near, Patches::of(&state.metal));
        if self.bound {
            near.outer.resize(near.len(), 0.0);
        }
        let mut missed = false;
        for k in 0..near.len() {
            let patch = surface.at(near.id[k] as usize);
            let x = near.position[k];
            let mut pressure = |x| {
                let (mean, found) = self.above(x, state.time, dt)?;
                missed |= !found;
                Ok::<f64, StageError>(mean)
            };
            if self.bound && near.role[k] == Role::Liquid {
                // What lies hidden is reached as far as its surface is; hollows inside have no surface.
                let hidden = patch.area > 0.0 && patch.seen <= 0.0;
                let reached = if hidden { patch.reached() } else { 1.0 };
                let above = pressure(x)?;
                near.outer[k] = reached * above;
                self.pressed += above * patch.seen;
                continue;
            }
            if near.role[k] != Role::Liquid || patch.area.max(patch.seen) <= 0.0 {
                continue;
            }
            let (above, beside) = (pressure(x)?, pressure(patch.foot(x))?);
            let side = beside * patch.reached() * patch.area;
            let down = above * patch.seen;
            let [nx, ny, _] = patch.normal;
            near.force[k] = along(
                near.force[k],
                -1.0 / self.volume,
                [side * nx, side * ny, down],
            );
            self.pressed += down;
        }
        self.missed |= missed;
        Ok(())
    }

    fn warnings(&self) -> Vec<String> {
        let missed = "pressure_pa of the arc changes faster in time than could be followed: impulse may be missed";
        self.missed.then(|| missed.to_owned()).into_iter().collect()
    }

    fn save(&self) -> Vec<f64> {
        vec![f64::from(u8::from(self.missed))]
    }

    fn restore(&mut self, saved: &[f64]) {
        self.missed = saved.first().is_some_and(|missed| *missed > 0.0);
    }

    fn figures(&self) -> Vec<Figure> {
        vec![Figure {
            name: "arc_force",
            unit: "N",
            value: self.pressed,
        }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forces::tests::{change, on_top, pool};
    use crate::patch::Patch;

    fn pressed(shape: impl Fn(&mut Patch)) -> ([f64; 3], f64) {
        let table = Radial::new(vec![0.0, 1.0], vec![500.0, 500.0]);
        pressed_by(Pressure::Table(table), shape)
    }

    fn pressed_by(pressure: Pressure, shape: impl Fn(&mut Patch)) -> ([f64; 3], f64) {
        let mut state = pool(|_| 1800.0);
        let d = state.metal.matter.spacing;
        on_top(&mut state, d * d);
        change(&mut state, shape);
        let arcs = vec![(pressure, Burning::default())];
        let mut stage = ArcPressure::new(arcs, state.metal.matter, false);
        stage.advance(&mut state, 1e-4).unwrap();
        let volume = state.metal.matter.volume();
        let total = |i: usize| -> f64 { state.near.force.iter().map(|f| f[i] * volume).sum() };
        let force = [total(0), total(1), total(2)];
        assert!((stage.figures()[0].value + force[2]).abs() < 1e-12);
        let area = Patches::of(&state.metal).area.iter().sum();
        (force, area)
    }

    #[test]
    fn the_force_is_the_pressure_times_the_area() {
        let (force, area) = pressed(|patch| patch.seen = patch.area);
        assert!((force[2] + 500.0 * area).abs() < 1e-12);
        assert!(force[0].abs() + force[1].abs() < 1e-12);
    }

    #[test]
    fn a_wall_is_pressed_sideways_and_what_is_hidden_not_down() {
        let (force, area) = pressed(|patch| {
            patch.normal = [0.8, 0.0, 0.6];
            patch.seen = 0.0;
        });
        assert!((force[0] + 0.8 * 500.0 * area).abs() < 1e-12);
        assert!(force[2].abs() < 1e-12);
    }

    #[test]
    fn a_formula_presses_as_the_same_table_does() {
        let written = serde_json::json!({"pressure_pa": {"expr": "1000 - 1000 * r"}});
        let parameters: Parameters = serde_json::from_value(written).unwrap();
        let formula = parameters.formula().unwrap().unwrap();
        let table = Pressure::Table(Radial::new(vec![0.0, 1.0], vec![1000.0, 0.0]));
        let flat = |patch: &mut Patch| patch.seen = patch.area;
        let (by_formula, area) = pressed_by(formula, flat);
        let (by_table, _) = pressed_by(table, flat);
        assert!(by_table[2] < -500.0 * area);
        assert!((by_formula[2] - by_table[2]).abs() < 1e-9 * by_table[2].abs());
    }

    #[test]
    fn without_a_formula_there_is_none_and_a_wrong_one_is_refused() {
        assert!(Parameters::default().formula().unwrap().is_none());
        let written = serde_json::json!({"pressure_pa": {"expr": "1000 * x"}});
        let parameters: Parameters = serde_json::from_value(written).unwrap();
        let fault = parameters.formula().err().unwrap();
        assert!(fault.to_string().contains("pressure_pa"), "{fault}");
    }
}
