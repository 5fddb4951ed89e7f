//! How the equations are iterated.

use crate::residual::Stop;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The outer iteration.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Iterate {
    /// Most iterations.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub most: usize,
    /// The iteration has converged when every residual is below this part of its scale: of force, mass flow, power, current. What
    /// ends above 1e-3 is told as not converged.
    #[schemars(range(min = 1e-14, max = 0.1))]
    pub tolerance: f64,
    /// Limits of single equations in their own units, in place of the tolerance.
    pub stop: Stop,
    /// Currents for which the arc is computed first, on the way to that of the scene; absent: the current of the scene from the start.
    pub continuation: Option<Continuation>,
    /// Under-relaxation of the velocities; absent: 0.95, with SIMPLE 0.9.
    #[schemars(range(min = 0.01, max = 0.99))]
    pub velocity_relaxation: Option<f64>,
    /// Under-relaxation of the pressure; absent: 1, with SIMPLE 1 less that of the velocities.
    #[schemars(range(min = 0.01, max = 1.0))]
    pub pressure_relaxation: Option<f64>,
    /// Under-relaxation of the temperature.
    #[schemars(range(min = 0.01, max = 1.0))]
    pub temperature_relaxation: f64,
    /// Largest change of a temperature in one iteration.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub temperature_step_k: f64,
    /// Coupling of velocity and pressure.
    pub coupling: Coupling,
    /// Solver of the equation of each field.
    pub solver: LinearSolver,
}

impl Default for Iterate {
    fn default() -> Self {
        Self {
            most: 5000,
            tolerance: 1e-6,
            stop: Stop::default(),
            continuation: None,
            velocity_relaxation: None,
            pressure_relaxation: None,
            temperature_relaxation: 0.99,
            temperature_step_k: 2000.0,
            coupling: Coupling::Simplec,
            solver: LinearSolver::Multigrid,
        }
    }
}

impl Iterate {
    /// Under-relaxation of the velocities. SIMPLE leaves out what neighbours answer to a change of pressure: with the 0.95
    /// of SIMPLEC it diverges (Patankar 1980, section 6.7). With 0.7 an iteration goes so little further than the gas does that
    /// the jet along the plate casts off vortices, which carry heat through the domain instead of settling.
    #[must_use]
    pub fn velocity(&self) -> f64 {
        self.velocity_relaxation.unwrap_or(match self.coupling {
            Coupling::Simple => 0.9,
            Coupling::Simplec => 0.95,
        })
    }

    /// Under-relaxation of the pressure; with SIMPLE the two make 1 (Ferziger and Peric 2002, section 7.3.4).
    #[must_use]
    pub fn pressure(&self) -> f64 {
        self.pressure_relaxation.unwrap_or(match self.coupling {
            Coupling::Simple => 1.0 - self.velocity(),
            Coupling::Simplec => 1.0,
        })
    }
}

/// Currents on the way to that of the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Continuation {
    /// From 200 A by factors of 1.5 at most.
    Automatic,
    /// These, in order \[A\].
    #[serde(rename = "currents_a")]
    Currents(Vec<f64>),
}

/// How velocity corrections follow the pressure correction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Coupling {
    /// Komen (2019), eqs 3.74, 3.76.
    Simple,
    /// Van Doormaal and Raithby (1984).
    Simplec,
}

/// Solver of the equation of each field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LinearSolver {
    /// Red-black successive over-relaxation (Komen 2019, eqs 3.62, 3.63).
    Sor,
    /// Krylov methods preconditioned by incomplete factors.
    Incomplete,
    /// Krylov methods preconditioned by algebraic multigrid.
    Multigrid,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relaxation_follows_the_coupling_unless_it_is_given() {
        let read = |text: &str| serde_json::from_str::<Iterate>(text).unwrap();
        let is = |text: &str, [velocity, pressure]: [f64; 2]| {
            let scene = read(text);
            let near = |a: f64, b: f64| (a - b).abs() < 1e-15;
            assert!(
                near(scene.velocity(), velocity) && near(scene.pressure(), pressure),
                "{text}"
            );
        };
        is("{}", [0.95, 1.0]);
        is(r#"{"coupling": "simple"}"#, [0.9, 0.1]);
        is(
            r#"{"coupling": "simple", "velocity_relaxation": 0.5, "pressure_relaxation": 0.8}"#,
            [0.5, 0.8],
        );
    }
}
