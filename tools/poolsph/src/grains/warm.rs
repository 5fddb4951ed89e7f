//! Temperatures of grains at the start.

use particles::{POSITION, Set};
use run::Fault;
use run::property::Arguments;

use super::columns::{ENTHALPY, HELD, STATE, TEMPERATURE};
use super::heat::Heat;
use super::parameters::Parameters;

/// Gives the grains of a scene the columns of heat and their first temperatures.
///
/// # Errors
/// A body without a temperature, or one that the properties do not hold.
pub fn warm(scene: &Parameters, heat: &Heat, set: &mut Set, counts: &[usize]) -> Result<(), Fault> {
    for column in [&TEMPERATURE, &ENTHALPY] {
        set.declare(column);
    }
    set.declare(&STATE);
    if heat.held.iter().any(Option::is_some) {
        set.declare(&HELD);
    }
    let mut row = 0;
    for (i, (body, count)) in scene.bodies.iter().zip(counts).enumerate() {
        let at = format!("/bodies/{i}");
        let first = match (&body.temperature_k, &heat.held[i]) {
            (Some(property), _) => {
                property.compile(&format!("{at}/temperature_k"), &["x", "y", "z", "r"])?
            }
            (None, Some(held)) => held.clone(),
            (None, None) => {
                return Err(Fault::at(
                    &at,
                    "has no key 'temperature_k' in K, which grains with heat need",
                ));
            }
        };
        for _ in 0..*count {
            let place = set.column(&POSITION)[row];
            let value = first.value(&Arguments::at(place, 0.0));
            let value = value
                .map_err(|what| Fault::at(&format!("{at}/temperature_k"), what.to_string()))?;
            if !heat.caloric.covers(value) {
                let (low, high) = heat.caloric.range();
                let what = format!("gives {value} K; the properties hold from {low} to {high} K");
                return Err(Fault::at(&format!("{at}/temperature_k"), what));
            }
            set.column_mut(&TEMPERATURE)[row] = value;
            let enthalpy = heat.caloric.enthalpy(value);
            set.column_mut(&ENTHALPY)[row] = enthalpy;
            if heat.held[i].is_some() {
                set.column_mut(&HELD)[row] = i as u8 + 1;
            }
            row += 1;
        }
    }
    heat.change(set);
    Ok(())
}
