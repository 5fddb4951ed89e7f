//! The pressure of the arc on the surface: F = -p dA/dV n, with the outward normal n.
//!
//! Of the vertical part, dA n_z is the area that the particle has as seen from above: the force on the
//! pool is that of the arc's table however torn the surface is, and nothing presses on what lies
//! hidden below an overhang. Sideways, walls are pressed and undersides are not: a slab with both its faces free would
//! else feel no sideways force at all, however it is inclined. What a particle has of the plan lies around it, and
//! takes the pressure there; its wall lies before it on the surface.
//!
//! Komen (2019, section 4.4.1) takes the pressure from the gas speed by Bernoulli's law and finds it
//! too small; here it is the arc's own, at the same distance from the axis.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::near::Role;
use crate::source::arc::Radial;
use crate::stage::{Figure, Stage, StageError};
use crate::state::{Column, Metal, State};
use crate::vector::plus;

/// The pressure of the arc (key `arc_pressure`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {}

/// The stage that presses on the surface.
pub struct ArcPressure {
    pressure: Radial,
    volume: f64,
    pressed: f64,
}

impl ArcPressure {
    /// The pressure \[Pa\] over the distance from the axis.
    #[must_use]
    pub fn new(pressure: Radial, metal: Metal) -> Self {
        Self {
            pressure,
            volume: metal.volume(),
            pressed: 0.0,
        }
    }
}

impl Stage for ArcPressure {
    fn name(&self) -> &'static str {
        "arc_pressure"
    }

    fn needs(&self) -> &'static [Column] {
        &[Column::Surface]
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        self.pressed = 0.0;
        let Some(axis) = state.source else {
            return Ok(());
        };
        let (near, surface) = (&mut state.near, &state.surface);
        for k in 0..near.len() {
            let patch = &surface[near.id[k] as usize];
            if near.role[k] != Role::Liquid || patch.area.max(patch.seen) <= 0.0 {
                continue;
            }
            let x = near.position[k];
            let [above, beside] = [x, patch.foot(x)].map(|x| self.pressure.at(axis.around(x).0));
            let side = beside * patch.reached() * patch.area;
            let down = above * patch.seen;
            let [nx, ny, _] = patch.normal;
            near.force[k] = plus(
                near.force[k],
                -1.0 / self.volume,
                [side * nx, side * ny, down],
            );
            self.pressed += down;
        }
        Ok(())
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
    use crate::forces::tests::{on_top, pool};
    use crate::patch::Patch;

    fn pressed(shape: impl Fn(&mut Patch)) -> ([f64; 3], f64) {
        let mut state = pool(|_| 1800.0);
        let d = state.metal.spacing;
        on_top(&mut state, d * d);
        state.surface.iter_mut().for_each(shape);
        let pressure = Radial::new(vec![0.0, 1.0], vec![500.0, 500.0]);
        let mut stage = ArcPressure::new(pressure, state.metal);
        stage.advance(&mut state, 1e-4).unwrap();
        let volume = state.metal.volume();
        let total = |i: usize| -> f64 { state.near.force.iter().map(|f| f[i] * volume).sum() };
        let force = [total(0), total(1), total(2)];
        assert!((stage.figures()[0].value + force[2]).abs() < 1e-12);
        let area: f64 = state.surface.iter().map(|p| p.area).sum();
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
}
