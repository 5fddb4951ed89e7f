//! What the walls of an electrostatic scene prescribe, as multiples of exact potentials.

use serde_json::Value;

use crate::heat::formula::At;
use crate::heat::property::Property;

/// A potential as a function of place \[m\].
pub type Potential<'a> = &'a dyn Fn([f64; 3]) -> f64;

/// What two potentials of unit amount are at a place, and what the wall prescribes there.
type Row = ([f64; 2], f64);

/// Largest part by which walls may miss an exact potential.
const TOLERANCE: f64 = 1e-6;
/// Places along each edge of a wall.
const EDGE: u32 = 7;

/// The amounts of two potentials that add up to what all walls of a scene prescribe by one number or formula.
///
/// # Errors
/// When the walls are no box, differ from each other, or hold anything else than the two.
pub fn amounts(scene: &Value, parts: [Potential<'_>; 2]) -> Result<[f64; 2], String> {
    let outer = scene["electrostatics"]["outer"].as_array();
    let [Value::Object(only)] = outer.map_or(&[][..], Vec::as_slice) else {
        return Err("walls that differ from each other have no exact potential here".to_owned());
    };
    let potential = Property::read(&only["potential_v"])?;
    let corner = |name: &str| -> Option<Vec<f64>> {
        let corner = scene["domain"]["box"][name].as_array()?;
        corner.iter().map(Value::as_f64).collect()
    };
    let (Some(low), Some(high)) = (corner("min_m"), corner("max_m")) else {
        return Err("the domain is no box".to_owned());
    };
    let row = |place| {
        let value = potential.value(&At::place(place));
        ([parts[0](place), parts[1](place)], value)
    };
    let rows: Vec<Row> = places(&low, &high).into_iter().map(row).collect();
    let found = fit(&rows);
    let largest = rows.iter().fold(0.0_f64, |most, (_, v)| most.max(v.abs()));
    let missed = rows.iter().fold(0.0_f64, |most, (part, v)| {
        most.max((found[0] * part[0] + found[1] * part[1] - v).abs())
    });
    if missed <= TOLERANCE * largest {
        Ok(found)
    } else {
        Err(format!(
            "the walls miss the exact potential of their body by {missed:e} V of {largest:e} V"
        ))
    }
}

/// Places on the faces of a box in space, or of one in the half plane (r, z) of an axis.
fn places(low: &[f64], high: &[f64]) -> Vec<[f64; 3]> {
    let space = low.len() == 3;
    let [low, high] = [low, high].map(|c| {
        if space {
            [c[0], c[1], c[2]]
        } else {
            [c[0], 0.0, c[1]]
        }
    });
    let at = |axis: usize, part: u32| {
        low[axis] + (high[axis] - low[axis]) * f64::from(part) / f64::from(EDGE - 1)
    };
    let mut found = Vec::new();
    for cell in 0..EDGE.pow(3) {
        let part = [cell % EDGE, cell / EDGE % EDGE, cell / EDGE / EDGE];
        let ends = |axis: usize| part[axis] == 0 || part[axis] == EDGE - 1;
        let outside = if space {
            (0..3).any(ends)
        } else {
            // The axis itself is no wall.
            part[1] == 0 && (ends(2) || part[0] == EDGE - 1)
        };
        if outside {
            found.push([at(0, part[0]), at(1, part[1]), at(2, part[2])]);
        }
    }
    found
}

/// Least squares of two unknowns.
fn fit(rows: &[Row]) -> [f64; 2] {
    let sum = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).sum::<f64>();
    let (aa, ab, bb) = (
        sum(&|(p, _)| p[0] * p[0]),
        sum(&|(p, _)| p[0] * p[1]),
        sum(&|(p, _)| p[1] * p[1]),
    );
    let (av, bv) = (sum(&|(p, v)| p[0] * v), sum(&|(p, v)| p[1] * v));
    let determinant = aa * bb - ab * ab;
    [
        (av * bb - bv * ab) / determinant,
        (bv * aa - av * ab) / determinant,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_amounts_are_found_from_values_on_the_walls() {
        for (low, high) in [
            (vec![-1.0, -1.0, -2.0], vec![1.0, 1.5, 2.0]),
            (vec![0.0, -1.0], vec![2.0, 3.0]),
        ] {
            let parts = |p: [f64; 3]| [p[2], p[2] * p[2] - 0.5 * (p[0] * p[0] + p[1] * p[1])];
            let rows: Vec<_> = places(&low, &high)
                .into_iter()
                .map(|p| (parts(p), 3.0 * parts(p)[0] - 0.5 * parts(p)[1]))
                .collect();
            let found = fit(&rows);
            assert!((found[0] - 3.0).abs() < 1e-12 && (found[1] + 0.5).abs() < 1e-12);
        }
    }

    #[test]
    fn the_axis_is_no_wall() {
        let found = places(&[0.0, -1.0], &[2.0, 3.0]);
        assert!(found.iter().all(|p| p[0] > 0.0 || p[2].abs() > 0.9));
        assert!(found.iter().any(|p| p[0] > 1.9 && p[2].abs() < 0.9));
    }
}
