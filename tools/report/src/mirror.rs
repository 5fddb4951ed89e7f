//! Half a weld beside its mirror plane, shown whole.

use serde_json::Value;

/// The plane x = const beside which half a weld was computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mirror {
    /// Where it stands \[m\].
    at: f64,
}

impl Mirror {
    /// The mirror of a scene across the weld; none where the whole was computed.
    pub(crate) fn of(scene: &Value) -> Option<Self> {
        let faces = scene.get("faces")?;
        let named = |name: &str| {
            let mirrors = faces.get("mirror").and_then(Value::as_array);
            mirrors.is_some_and(|all| all.iter().any(|face| face == name))
        };
        let side = match (named("x-"), named("x+")) {
            (true, false) => "/min_m/0",
            (false, true) => "/max_m/0",
            _ => return None,
        };
        let at = faces.pointer(side).and_then(Value::as_f64)?;
        Some(Self { at })
    }

    /// Places with their images behind them.
    pub(crate) fn places(self, half: &mut Vec<[f64; 3]>) {
        let images: Vec<_> = half
            .iter()
            .map(|[x, y, z]| [2.0 * self.at - x, *y, *z])
            .collect();
        half.extend(images);
    }

    /// What images share with their originals.
    pub(crate) fn values<T: Copy>(self, half: &mut Vec<T>) {
        half.extend_from_within(..);
    }

    /// The corners of the whole of a box.
    pub(crate) fn corners(self, low: &mut [f64; 3], high: &mut [f64; 3]) {
        let (near, far) = (2.0 * self.at - high[0], 2.0 * self.at - low[0]);
        (low[0], high[0]) = (low[0].min(near), high[0].max(far));
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn half_a_weld_has_the_mirror_of_its_scene() {
        let scene = |faces: &[&str]| json!({"faces": {"min_m": [0.5, 0, 0], "max_m": [2, 1, 1], "mirror": faces}});
        assert_eq!(Mirror::of(&scene(&["x-"])), Some(Mirror { at: 0.5 }));
        assert_eq!(Mirror::of(&scene(&["z+", "x+"])), Some(Mirror { at: 2.0 }));
        for whole in [&["y-"][..], &[], &["x-", "x+"]] {
            assert_eq!(Mirror::of(&scene(whole)), None);
        }
        assert_eq!(Mirror::of(&json!({})), None);
    }

    #[test]
    fn images_stand_behind_with_the_values_of_their_originals() {
        let mirror = Mirror { at: 0.5 };
        let (mut places, mut values) = (vec![[0.75, 1.0, 2.0], [1.5, 0.0, 0.0]], vec![7, 8]);
        mirror.places(&mut places);
        mirror.values(&mut values);
        assert_eq!(places[2..], [[0.25, 1.0, 2.0], [-0.5, 0.0, 0.0]]);
        assert_eq!(values, [7, 8, 7, 8]);
        let (mut low, mut high) = ([0.5, 0.0, -1.0], [2.0, 1.0, 0.0]);
        mirror.corners(&mut low, &mut high);
        assert_eq!((low, high), ([-1.0, 0.0, -1.0], [2.0, 1.0, 0.0]));
    }
}
