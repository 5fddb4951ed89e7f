//! Whether the metal of a scene ends where its faces are.

use particles::POSITION;
use run::Fault;

use crate::rest::Plane;
use crate::state::State;

/// A first layer that is off its place by more than this part of a spacing does not end at the face.
const OFF: f64 = 0.05;

/// Checks that particles stand within the faces, that mirrors are the edge of what they turn over, and that the layers
/// on both sides of a periodic face are a spacing apart.
///
/// # Errors
/// A fault that names the face.
pub fn fitting(state: &State) -> Result<(), Fault> {
    let (faces, d) = (&state.faces, state.metal.matter.spacing);
    for axis in 0..3 {
        let planes = faces.planes(axis);
        if planes == [None; 2] || state.is_empty() {
            continue;
        }
        let along = || state.metal.column(&POSITION).iter().map(|x| x[axis]);
        let ends = [
            along().fold(f64::INFINITY, f64::min),
            along().fold(f64::NEG_INFINITY, f64::max),
        ];
        let gap = |side: usize| {
            let outward = [-1.0, 1.0][side];
            planes[side].map(|plane| outward * (plane - ends[side]))
        };
        for (side, sign) in ["-", "+"].into_iter().enumerate() {
            let (Some(gap), Some(plane)) = (gap(side), planes[side]) else {
                continue;
            };
            let name = format!("{}{sign}", ["x", "y", "z"][axis]);
            let at = format!("/{}/{axis}", ["min_m", "max_m"][side]);
            if gap < 0.0 {
                let what = format!(
                    "{plane} m of the face '{name}' cuts a body, which reaches to {} m",
                    ends[side]
                );
                return Err(Fault::at(&at, what));
            }
            let edge = ends[side] + [-0.5, 0.5][side] * d;
            if faces.is_mirror(axis, side) && (gap / d - 0.5).abs() > OFF {
                let which = match faces.is_lid(axis, side) {
                    true => "lid",
                    false => "mirror",
                };
                let what = format!(
                    "{plane} m of the {which} '{name}' is not the edge of the bodies, which is at {edge} m"
                );
                return Err(Fault::at(&at, what));
            }
            if !faces.is_periodic(axis) && gap < (0.5 - OFF) * d {
                let what = format!(
                    "{plane} m of the wall '{name}' is nearer to the first particles than half a spacing: their edge \
                     is at {edge} m"
                );
                return Err(Fault::at(&at, what));
            }
        }
        if faces.is_periodic(axis)
            && let (Some(below), Some(above)) = (gap(0), gap(1))
        {
            let between = (below + above) / d;
            // Nothing touches a face that is far from all metal.
            if between < 2.0 && (between - 1.0).abs() > OFF {
                let what = format!(
                    "the layers on both sides of the periodic face are {between:.3} spacings apart, out of range: 1"
                );
                return Err(Fault::at(&format!("/max_m/{axis}"), what));
            }
        }
    }
    Ok(())
}

/// Checks that metal stands along the faces of the plate that heat knows: `planes` with the key that names each.
///
/// # Errors
/// A fault that names the face.
pub fn along_heat_faces(state: &State, planes: &[(&str, Plane)]) -> Result<(), Fault> {
    let d = state.metal.matter.spacing;
    let places = state.metal.column(&POSITION);
    for (key, plane) in planes {
        let depth = |x: &[f64; 3]| plane.outward * (plane.at - x[plane.axis]) / d;
        let beside = |x: &[f64; 3]| (-OFF..=1.0 + OFF).contains(&depth(x));
        if state.is_empty() || places.iter().any(beside) {
            continue;
        }
        let ends = places.iter().map(|x| plane.outward * x[plane.axis]);
        let edge = plane.outward * (ends.fold(f64::NEG_INFINITY, f64::max) + 0.5 * d);
        let what = format!(
            "{} m of the {key} face '{}{}' has no metal beside it: the bodies end at {edge} m",
            plane.at,
            ["x", "y", "z"][plane.axis],
            if plane.outward > 0.0 { '+' } else { '-' }
        );
        let corner = if plane.outward > 0.0 {
            "max_m"
        } else {
            "min_m"
        };
        return Err(Fault::at(&format!("/{corner}/{}", plane.axis), what));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::faces::Parameters;
    use crate::state::{Particle, phase};
    use particles::Matter;

    /// What is said of a cube of 6 cells between faces.
    fn told(faces: &str) -> Option<String> {
        let metal = Matter {
            density: 1000.0,
            spacing: 1.0,
            smoothing_length: 1.0,
        };
        let mut state = State::new(metal);
        for n in 0..216 {
            state.push(Particle {
                position: [n % 6, n / 6 % 6, n / 36].map(|i| f64::from(i) + 0.5),
                velocity: [0.0; 3],
                phase: phase::LIQUID,
                droplet: false,
                wall: false,
                temperature: 0.0,
                enthalpy: 0.0,
            });
        }
        let parameters: Parameters = serde_json::from_str(faces).unwrap();
        state.faces = parameters.faces(2.0, false).unwrap();
        fitting(&state).err().map(|fault| fault.to_string())
    }

    #[test]
    fn bodies_end_where_the_faces_are() {
        let with = |max: [f64; 3], rest: &str| {
            told(&format!(
                r#"{{"min_m": [0, 0, 0], "max_m": {max:?}, {rest}}}"#
            ))
        };
        let all = r#""periodic": ["x"], "mirror": ["y-", "y+"], "wall": [{"face": "z-"}]"#;
        assert_eq!(with([6.0; 3], all), None);
        let off = with([6.0, 6.3, 6.0], r#""mirror": ["y+"]"#).unwrap();
        assert!(
            off.contains("/max_m/1") && off.contains("'y+'") && off.contains("6 m"),
            "{off}"
        );
        let cut = with([6.0, 5.3, 6.0], r#""mirror": ["y+"]"#).unwrap();
        assert!(cut.contains("cuts a body"), "{cut}");
        let near = with([6.0, 6.0, 5.7], r#""wall": [{"face": "z+"}]"#).unwrap();
        assert!(near.contains("half a spacing"), "{near}");
        assert_eq!(with([6.0, 6.0, 9.0], r#""wall": [{"face": "z+"}]"#), None);
        let apart = with([6.5, 6.0, 6.0], r#""periodic": ["x"]"#).unwrap();
        assert!(apart.contains("1.500 spacings"), "{apart}");
    }
}
