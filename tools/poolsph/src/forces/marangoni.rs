//! The Marangoni effect (Komen 2019, eq. 4.1, first term): the surface pulls towards where its
//! tension is greater.
//!
//! ```text
//! F = (d gamma/d T) (dA/dV) (grad T - n (n . grad T))
//! ```
//!
//! The slope is a number, a table or a formula of the temperature, or follows from what the iron has of sulphur and oxygen
//! ([`super::solute`]): with them its sign turns. The gradient of the temperature is that of the neighbours with the kernel
//! gradient corrected to be exact for a linear field, at the surface as well as inside.

use run::Fault;
use run::property::{Curve, OutOfRange, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shapes::frame::{along, difference, dot};

use super::solute::{IRON, Solute};
use crate::near::{Near, Role, Row};
use crate::patch::{self, AREA, Patches};
use crate::stage::{Stage, StageError};
use crate::state::{State, TEMPERATURE};

/// Dependence of the surface tension on the temperature (key `marangoni`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Marangoni")]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Slope d gamma/dT of the surface tension, a number or a function of the temperature T; positive: the surface is pulled towards
    /// hotter places.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "N/(m K)"))]
    pub slope_n_m_k: Option<Property>,
    /// In place of the slope: sulphur that liquid iron has at its surface, in per cent by weight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "%"))]
    pub sulphur_percent: Option<f64>,
    /// In place of the slope: oxygen that liquid iron has at its surface, in per cent by weight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "%"))]
    pub oxygen_percent: Option<f64>,
}

/// d gamma/d T.
enum Slope {
    Given(Curve),
    /// That of iron with what is dissolved in it.
    Iron(Vec<Solute>),
}

impl Slope {
    /// The slope that the scene says.
    fn of(parameters: &Parameters) -> Result<Self, Fault> {
        let sulphur = parameters.sulphur_percent.map(Solute::sulphur);
        let oxygen = parameters.oxygen_percent.map(Solute::oxygen);
        let solutes: Vec<Solute> = sulphur.into_iter().chain(oxygen).collect();
        match (&parameters.slope_n_m_k, solutes.is_empty()) {
            (Some(slope), true) => Ok(Self::Given(slope.compile("/slope_n_m_k", &["T"])?)),
            (None, false) => Ok(Self::Iron(solutes)),
            (Some(_), false) => Err(Fault::at(
                "/slope_n_m_k",
                "is given beside what is dissolved, which gives it: leave one of them",
            )),
            (None, true) => Err(Fault::at(
                "",
                "wants 'slope_n_m_k', or 'sulphur_percent' or 'oxygen_percent' of iron",
            )),
        }
    }

    /// Its value where it is the same at any temperature.
    fn constant(&self) -> Option<f64> {
        match self {
            Self::Given(curve) => curve.constant(),
            Self::Iron(_) => None,
        }
    }

    /// Its value at the temperature `kelvin`.
    fn at(&self, kelvin: f64) -> Result<f64, OutOfRange> {
        match self {
            Self::Given(curve) => curve.at_temperature(kelvin),
            Self::Iron(solutes) => {
                let each = solutes.iter().map(|solute| solute.slope(kelvin));
                Ok(each.sum::<f64>() - IRON)
            }
        }
    }
}

/// Largest size of d gamma/d T \[N/(m K)\].
const STEEPEST: f64 = 0.1;

/// The stage that drags the surface along.
pub struct Marangoni {
    slope: Slope,
    temperature: Vec<f64>,
    /// d gamma/d T of each particle \[N/(m K)\], `[m]`; zero off the surface.
    each: Vec<f64>,
}

impl Marangoni {
    /// The effect with these parameters.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn new(parameters: &Parameters) -> Result<Self, Fault> {
        let slope = Slope::of(parameters)?;
        if let Some(value) = slope.constant()
            && (value.is_nan() || value.abs() > STEEPEST)
        {
            let what =
                format!("{value} N/(m K) is out of range: -{STEEPEST} to {STEEPEST} N/(m K)");
            return Err(Fault::at("/slope_n_m_k", what));
        }
        Ok(Self {
            slope,
            temperature: Vec::new(),
            each: Vec::new(),
        })
    }

    /// d gamma/d T at the temperature `kelvin` \[N/(m K)\].
    fn at(&self, kelvin: f64) -> Result<f64, StageError> {
        let slope = self.slope.at(kelvin);
        let slope = slope
            .map_err(|fault| StageError::Data(format!("slope of the surface tension: {fault}")))?;
        if slope.abs() <= STEEPEST {
            return Ok(slope);
        }
        Err(StageError::Data(format!(
            "slope of the surface tension: {slope} N/(m K) at {kelvin} K is out of range: -{STEEPEST} to {STEEPEST} N/(m K)"
        )))
    }

    /// The slope at each particle of the surface.
    fn read(&mut self, state: &State) -> Result<(), StageError> {
        self.each.clear();
        let (near, area) = (&state.near, state.metal.column(&AREA));
        for a in 0..near.len() {
            let there = near.role[a] == Role::Liquid && area[near.id[a] as usize] > 0.0;
            let slope = if there {
                self.at(self.temperature[a])?
            } else {
                0.0
            };
            self.each.push(slope);
        }
        Ok(())
    }
}

/// grad T at particle `a`, exact for linear fields; zero where the neighbours span no space.
fn gradient(near: &Near, temperature: &[f64], a: usize, row: Row<'_>) -> [f64; 3] {
    let mut moment = [[0.0; 3]; 3];
    let mut sum = [0.0; 3];
    for (b, slope) in row.slopes() {
        let dx = difference(near.position[b], near.position[a]);
        // The kernel falls with distance: -slope is the weight.
        let weight = -slope;
        sum = along(sum, weight * (temperature[b] - temperature[a]), dx);
        for (line, x) in moment.iter_mut().zip(dx) {
            *line = along(*line, weight * x, dx);
        }
    }
    solve(moment, sum).unwrap_or_default()
}

/// x of M x = v by Cramer's rule for symmetric M; `None` where M is nearly singular.
fn solve(m: [[f64; 3]; 3], v: [f64; 3]) -> Option<[f64; 3]> {
    let minor = |i: usize, j: usize| {
        let (r, s) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m[r][c] * m[s][d] - m[r][d] * m[s][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
    let size = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
    if determinant.abs() <= 1e-6 * size.powi(3) || size <= 0.0 {
        return None;
    }
    Some([0, 1, 2].map(|j| (0..3).map(|i| minor(i, j) * v[i]).sum::<f64>() / determinant))
}

impl Stage for Marangoni {
    fn name(&self) -> &'static str {
        "marangoni"
    }

    fn declare(&self, state: &mut State) {
        state.metal.declare(&TEMPERATURE);
        patch::declare(&mut state.metal);
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        let volume = state.metal.matter.volume();
        state
            .near
            .temperatures(
                &state.faces,
                state.time,
                state.metal.column(&TEMPERATURE),
                &mut self.temperature,
            )
            .map_err(|fault| StageError::Data(format!("temperature of a wall: {fault}")))?;
        self.read(state)?;
        let (temperature, each) = (&self.temperature, &self.each);
        let surface = Patches::of(&state.metal);
        let mut force = std::mem::take(&mut state.near.force);
        let near = &state.near;
        near.each_row(&mut force, |a, row, force| {
            let id = near.id[a] as usize;
            let (area, normal) = (surface.area[id], surface.normal[id]);
            if near.role[a] == Role::Liquid && area > 0.0 {
                let gradient = gradient(near, temperature, a, row);
                let tangential = along(gradient, -dot(gradient, normal), normal);
                *force = along(*force, each[a] / volume * area, tangential);
            }
        });
        state.near.force = force;
        Ok(())
    }

    fn bytes(&self) -> usize {
        8 * (self.temperature.capacity() + self.each.capacity())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forces::tests::{on_top, pool};

    #[test]
    fn a_flat_surface_is_pulled_by_slope_times_gradient() {
        // 2e5 K/m along x, and a drop inwards that must not act.
        let mut state = pool(|x| 1800.0 + 2e5 * x[0] + 3e5 * x[2]);
        let d = state.metal.matter.spacing;
        on_top(&mut state, d * d);
        let mut stage = made(r#"{"slope_n_m_k": 1e-4}"#).unwrap();
        stage.advance(&mut state, 1e-4).unwrap();
        let mut pulled = 0;
        for (k, force) in state.near.force.iter().enumerate() {
            let patch = Patches::of(&state.metal).at(state.near.id[k] as usize);
            if state.near.role[k] == Role::Liquid && patch.area > 0.0 {
                // 20 Pa over a layer of d.
                assert!((force[0] * d - 20.0).abs() < 1e-9, "{force:?}");
                assert!(force[1].abs() * d < 1e-9 && force[2].abs() * d < 1e-9);
                pulled += 1;
            } else {
                assert!(force.iter().all(|f| f.abs() < 1e-15));
            }
        }
        assert!(pulled > 20);
    }

    fn made(text: &str) -> Result<Marangoni, Fault> {
        Marangoni::new(&serde_json::from_str(text).unwrap())
    }

    #[test]
    fn the_slope_may_turn_with_the_temperature() {
        // 2e5 K/m along x about 2000 K, where the slope of the table turns.
        let mut state = pool(|x| 2000.0 + 2e5 * x[0]);
        let d = state.metal.matter.spacing;
        on_top(&mut state, d * d);
        let table = r#"{"slope_n_m_k": {"t_k": [1000, 3000], "value": [1e-4, -1e-4]}}"#;
        for text in [table, r#"{"slope_n_m_k": {"expr": "1e-7*(2000 - T)"}}"#] {
            state.near.force.fill([0.0; 3]);
            made(text).unwrap().advance(&mut state, 1e-4).unwrap();
            for (k, force) in state.near.force.iter().enumerate() {
                if state.metal.column(&AREA)[state.near.id[k] as usize] > 0.0 {
                    let stress = -1e-7 * 2e5 * state.near.position[k][0] * 2e5;
                    assert!((force[0] * d - stress).abs() < 1e-9, "{force:?}");
                }
            }
        }
    }

    #[test]
    fn sulphur_turns_the_flow_about() {
        // Towards the hot below some temperature and from it above; the more sulphur, the higher it is.
        let turn = |text: &str| {
            let stage = made(text).unwrap();
            let (mut low, mut high) = (1600.0_f64, 4000.0_f64);
            assert!(stage.at(low).unwrap() > 0.0 && stage.at(high).unwrap() < 0.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if stage.at(middle).unwrap() > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            low
        };
        let [little, much] = [0.004, 0.03].map(|s| turn(&format!(r#"{{"sulphur_percent": {s}}}"#)));
        assert!(little > 1811.0 && much > little + 100.0, "{little} {much}");
        let both = turn(r#"{"sulphur_percent": 0.004, "oxygen_percent": 0.01}"#);
        assert!(both > little, "{both} {little}");
        let pure = made(r#"{"sulphur_percent": 0}"#).unwrap();
        assert!((pure.at(2000.0).unwrap() / -IRON - 1.0).abs() < 1e-12);
    }

    #[test]
    fn one_way_to_say_the_slope_is_wanted() {
        for text in ["{}", r#"{"slope_n_m_k": 1e-4, "sulphur_percent": 0.01}"#] {
            let what = made(text).err().unwrap().to_string();
            assert!(what.contains("slope_n_m_k"), "{what}");
        }
    }

    #[test]
    fn slopes_out_of_range_are_refused() {
        let fault = made(r#"{"slope_n_m_k": 0.2}"#).err().unwrap();
        assert_eq!(fault.path(), "/slope_n_m_k", "{fault}");
        let formula = made(r#"{"slope_n_m_k": {"expr": "T/1000"}}"#).unwrap();
        assert!(formula.at(90.0).is_ok() && formula.at(2000.0).is_err());
    }

    #[test]
    fn too_few_neighbours_give_no_gradient() {
        assert_eq!(
            solve([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]], [1.0; 3]),
            None
        );
        let x = solve(
            [[2.0, 1.0, 0.0], [1.0, 3.0, 0.5], [0.0, 0.5, 1.0]],
            [4.0, 8.5, 4.0],
        )
        .unwrap();
        for (found, expected) in x.iter().zip([1.0, 2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-12);
        }
    }
}
