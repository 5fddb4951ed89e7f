//! Points that no stencil can be made of: which, where, in which body, and what helps.

use run::Fault;
use wls::Error;

use crate::cloud::{Class, Cloud};
use crate::solve::broken::point;

/// The fault of a scene whose points allow no stencil: of the further point that does it, where it is one.
pub(crate) fn no_stencil(name: &str, error: &Error, cloud: &Cloud) -> Fault {
    let points = match error {
        // An image beyond the axis has a number beyond those of the points.
        Error::Coincident { a, b, .. } => [Some(*a), Some(*b).filter(|b| *b < cloud.len())],
        Error::Lone { point, .. }
        | Error::Flat { point, .. }
        | Error::NotFinite { point, .. }
        | Error::BadSpacing { point, .. } => [Some(*point), None],
        Error::BadCloud { .. } | Error::BadPlan { .. } => [None, None],
    };
    let points: Vec<usize> = points.into_iter().flatten().collect();
    let further = points.iter().rev().find_map(|i| further(cloud, *i));
    let path = further.map_or("/points".to_owned(), |k| format!("/points/extra_m/{k}"));
    let stand = |i: &usize| format!("point {i} is {}", stands(cloud, *i));
    let stand: Vec<String> = points.iter().map(stand).collect();
    let what = match (error, points.as_slice()) {
        (
            Error::Coincident {
                distance, least, ..
            },
            [a],
        ) => {
            let off = 0.5 * distance;
            format!(
                "{} is {off:.3e} m off the axis and coincides with its own image beyond it: put it on the axis, or more than {:.3e} m off",
                point(cloud, *a),
                0.5 * least
            )
        }
        (Error::Coincident { .. }, _) => {
            format!("{error}; move or remove one, of \"extra_m\" or of two surfaces")
        }
        (Error::Lone { .. } | Error::Flat { .. }, _) => format!(
            "{error}; points there follow a body, a gap or a film too narrow for them: take a smaller spacing, of the body or of \"refinements\", or another shape"
        ),
        _ => error.to_string(),
    };
    let mut all = vec![format!("{name}: {what}")];
    all.extend(stand);
    Fault::at(&path, all.join("; "))
}

/// The number of a point in `extra_m`, if it is one: they come last.
fn further(cloud: &Cloud, i: usize) -> Option<usize> {
    (i + cloud.further).checked_sub(cloud.len())
}

/// Where a point stands.
fn stands(cloud: &Cloud, i: usize) -> String {
    let name = |m: u16| &cloud.media[m as usize];
    let place = match cloud.class[i] {
        Class::Inside(m) => format!("inside {}", name(m)),
        Class::Interface { inner, outer } => {
            format!("on the surface of {} in {}", name(inner), name(outer))
        }
        Class::Outer { medium, face } => {
            let wall = cloud.faces[face as usize];
            format!("on the wall {wall} in {}", name(medium))
        }
    };
    match further(cloud, i) {
        Some(_) => format!("a further one, {place}"),
        None => place,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::solve::setup::numerics;
    use crate::stencils::setup::region;
    use crate::stencils::sides::Sides;
    use serde_json::{Value, json};

    /// What a scene with these bodies and points is told, of `D` coordinates.
    fn told<const D: usize>(scene: &Value) -> String {
        let scene: Scene = serde_json::from_value(scene.clone()).unwrap();
        let cloud = crate::cloud::setup::cloud(&scene).unwrap();
        let region = region::<D>(&scene, &cloud, &|_| false);
        let form = numerics(&scene).form;
        let error = Sides::new(&region, &form).unwrap_err();
        no_stencil("potential", &error, &cloud).to_string()
    }

    fn scene(geometry: &str, shape: Value, extra: Value) -> Value {
        let (low, high) = match geometry {
            "space" => (json!([-1, -1, -1]), json!([1, 1, 1])),
            "axisymmetric" => (json!([0, -1]), json!([1, 1])),
            _ => (json!([-1, -1]), json!([1, 1])),
        };
        json!({"geometry": geometry, "domain": {"box": {"min_m": low, "max_m": high}},
            "bodies": [{"name": "thing", "shape": shape}],
            "electrostatics": {"outer": [{"potential_v": 1}]},
            "points": {"spacing_m": 0.2, "extra_m": extra}})
    }

    #[test]
    fn points_alone_name_their_wall_and_medium() {
        for (geometry, radius) in [("plane", 1.386), ("axisymmetric", 1.386)] {
            let disc = json!({"disc": {"centre_m": [0, 0], "radius_m": radius}});
            let said = told::<2>(&scene(geometry, disc, json!([])));
            assert!(said.contains("1.0] m is alone: 1 points"), "{said}");
            assert!(said.contains(" is on the wall "), "{said}");
        }
        let ball = json!({"sphere": {"centre_m": [0, 0, 0], "radius_m": 1.7}});
        let said = told::<3>(&scene("space", ball, json!([])));
        assert!(
            said.contains("[-1.0, -1.0, -1.0] m is alone: 1 points"),
            "{said}"
        );
        assert!(said.contains("on the wall x- in surroundings"), "{said}");
        assert!(said.contains("take a smaller spacing"), "{said}");
    }

    #[test]
    fn points_in_a_plane_name_the_body() {
        let film = json!({"box": {"min_m": [-0.5, -0.5, -1e-4], "max_m": [0.5, 0.5, 1e-4]}});
        let said = told::<3>(&scene("space", film, json!([])));
        assert!(said.contains("lie so (in a plane"), "{said}");
        assert!(
            said.contains("on the surface of thing in surroundings"),
            "{said}"
        );
    }

    #[test]
    fn points_that_coincide_name_the_one_of_the_scene() {
        let ball = || json!({"sphere": {"centre_m": [0, 0, 0], "radius_m": 0.5}});
        let twice = json!([[0.7, 0.1, 0], [-0.7, 0.7, 0.7], [0.7, 0.1, 0]]);
        let said = told::<3>(&scene("space", ball(), twice));
        assert!(
            said.contains("/points/extra_m/2: potential: points "),
            "{said}"
        );
        assert_eq!(
            said.matches("a further one, inside surroundings").count(),
            2,
            "{said}"
        );
        let within = told::<3>(&scene("space", ball(), json!([[0, 0, 0]])));
        assert!(within.contains("/points/extra_m/0: "), "{within}");
        assert!(within.contains("is inside thing; "), "{within}");
    }

    #[test]
    fn a_point_beside_the_axis_coincides_with_its_image() {
        let disc = json!({"disc": {"centre_m": [0, 0], "radius_m": 0.5}});
        let said = told::<2>(&scene("axisymmetric", disc.clone(), json!([[1e-12, 0.71]])));
        assert!(said.contains("/points/extra_m/0: "), "{said}");
        assert!(said.contains("1.000e-12 m off the axis"), "{said}");
        assert!(said.contains("put it on the axis"), "{said}");
        let scene: Scene =
            serde_json::from_value(scene("axisymmetric", disc, json!([[0, 0.71]]))).unwrap();
        let cloud = crate::cloud::setup::cloud(&scene).unwrap();
        let region = region::<2>(&scene, &cloud, &|_| false);
        let form = numerics(&scene).form;
        assert!(Sides::new(&region, &form).is_ok());
    }
}
