//! Heaps of grains on a shelf: how steep both sides are.

use serde_json::Value;

/// Columns of a side, each of so many diameters.
const WIDE: f64 = 2.0;

/// Slopes of both sides \[degrees\] of grains of diameter `d` \[m\] at `places` on a shelf that is `half` \[m\] wide to either side of x = 0.
///
/// Each side is a line through the highest grains of its columns.
pub(crate) fn slopes(places: &[[f64; 3]], half: f64, d: f64) -> [f64; 2] {
    [-1.0, 1.0].map(|side| {
        let columns = (half / (WIDE * d)).floor() as usize;
        let mut tops = vec![None::<f64>; columns];
        for [x, _, z] in places {
            let out = side * x;
            let column = (out / (WIDE * d)).floor();
            if out >= 0.0
                && let Some(top) = tops.get_mut(column as usize)
            {
                *top = Some(top.map_or(*z, |top| top.max(*z)));
            }
        }
        let tops = tops.iter().enumerate();
        let found = tops.filter_map(|(k, top)| top.map(|z| ((k as f64 + 0.5) * WIDE * d, z)));
        -slope(&found.collect::<Vec<_>>()).atan().to_degrees()
    })
}

/// Slope of the straight line through points by least squares; none through fewer than two.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (x, z) = points
        .iter()
        .fold((0.0, 0.0), |s, p| (s.0 + p.0 / n, s.1 + p.1 / n));
    let sums = points.iter().fold((0.0, 0.0), |s, p| {
        (s.0 + (p.0 - x) * (p.1 - z), s.1 + (p.0 - x).powi(2))
    });
    if sums.1 > 0.0 { sums.0 / sums.1 } else { 0.0 }
}

/// A scene part whose lengths are `part` times as long: corners of boxes and places of planes.
pub(crate) fn scaled(value: &Value, part: f64) -> Value {
    let mut value = value.clone();
    scale(&mut value, part);
    value
}

fn scale(value: &mut Value, part: f64) {
    match value {
        Value::Object(keys) => {
            for (key, value) in keys {
                if ["min_m", "max_m", "point_m"].contains(&key.as_str()) {
                    for x in value.as_array_mut().into_iter().flatten() {
                        *x = serde_json::json!(part * x.as_f64().unwrap_or(0.0));
                    }
                } else {
                    scale(value, part);
                }
            }
        }
        Value::Array(values) => values.iter_mut().for_each(|value| scale(value, part)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_roof_has_the_slopes_that_it_was_built_with() {
        let (d, half) = (1.0, 40.0);
        let places: Vec<[f64; 3]> = (-400..400)
            .map(|k| {
                let x = 0.1 * (f64::from(k) + 0.5);
                let steep = if x < 0.0 { 0.5 } else { 0.25 };
                [x, 0.0, 20.0 - steep * x.abs()]
            })
            .collect();
        let [left, right] = slopes(&places, half, d);
        assert!((left - 0.5_f64.atan().to_degrees()).abs() < 1e-9, "{left}");
        assert!(
            (right - 0.25_f64.atan().to_degrees()).abs() < 1e-9,
            "{right}"
        );
        assert!(slopes(&[], half, d).iter().all(|slope| slope.abs() < 1e-12));
    }
}
