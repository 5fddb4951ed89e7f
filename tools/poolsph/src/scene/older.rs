//! Scenes of older versions.
//!
//! | version | what it said otherwise |
//! |---|---|
//! | 1 | `half_m` of an ellipsoid, which all programs call `semi_axes_m` |

use run::scene::Migration;
use serde_json::Value;

/// Ways from older versions.
pub const MIGRATIONS: &[Migration] = &[Migration {
    from: 1,
    change: |scene| {
        scene.values_mut().for_each(reword);
        Ok(())
    },
    renames: true,
}];

/// Gives the older word its name in all ellipsoids within a value; what stands under that name already stays.
fn reword(value: &mut Value) {
    match value {
        Value::Object(map) => {
            if let Some(Value::Object(ellipsoid)) = map.get_mut("ellipsoid")
                && let Some(half) = ellipsoid.shift_remove("half_m")
            {
                ellipsoid.entry("semi_axes_m").or_insert(half);
            }
            map.values_mut().for_each(reword);
        }
        Value::Array(list) => list.iter_mut().for_each(reword),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use run::scene::{Expected, parse};
    use shapes::shape::EllipsoidShape;

    use super::*;
    use crate::domain::shape::Shape;
    use crate::scene::{KIND, Scene};

    const POOL: Expected = Expected {
        kind: KIND.0,
        version: KIND.1,
        migrations: MIGRATIONS,
    };

    /// Semi-axes of the ellipsoid of a scene, and the version it had if it was older.
    fn read(version: u32, word: &str) -> (Vec<f64>, Option<u32>) {
        let text = format!(
            r#"{{"kind": "poolsph.scene", "version": {version}, "spacing_m": 0.0005, "density_kg_m3": 1000,
            "time": {{"step_s": 1e-4, "end_s": 1e-3}},
            "bodies": [{{"shape": {{"ellipsoid": {{"centre_m": [0, 0, 0], "{word}": [0.003, 0.004, 0.005]}}}}, "state": "liquid"}}],
            "flow": {{"viscosity_pa_s": 0.01}}, "output": {{"particles_interval_s": 1e-3}}}}"#
        );
        let loaded = parse::<Scene>(&text, POOL).unwrap();
        let Shape::Ellipsoid(EllipsoidShape { semi_axes_m, .. }) = &loaded.scene.bodies[0].shape
        else {
            panic!("no ellipsoid");
        };
        (semi_axes_m.clone(), loaded.migrated)
    }

    #[test]
    fn ellipsoids_of_the_first_version_are_read() {
        let axes = vec![0.003, 0.004, 0.005];
        assert_eq!(read(1, "half_m"), (axes.clone(), Some(1)));
        assert_eq!(read(2, "semi_axes_m"), (axes, None));
    }
}
