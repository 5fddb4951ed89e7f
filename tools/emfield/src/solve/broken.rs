//! Solves that fail, with the place.

use krylov::{Breakdown, Error, Solved};
use run::{Failure, Fault};

use crate::cloud::Cloud;

/// Equations that have no solution: `row` is the number of a point.
pub(crate) fn unsolvable(name: &str, error: &Error, cloud: &Cloud) -> Failure {
    let row = match error {
        Error::NotFinite { index, .. }
        | Error::NotPositive { index, .. }
        | Error::Singular { index } => Some(*index),
        _ => None,
    };
    match row.filter(|row| *row < cloud.len()) {
        Some(row) => {
            let what = format!("{name}: {error}; it is of {}", point(cloud, row));
            Fault::at("/points", what).into()
        }
        None => Failure::Other(format!("{name}: {error}")),
    }
}

/// A solve that broke down, at the point where the solution is no number or largest.
pub(crate) fn broken_down(
    name: &str,
    unit: &str,
    solved: &Solved,
    why: Breakdown,
    cloud: &Cloud,
    size: impl Fn(usize) -> f64,
) -> Failure {
    let size = |i: usize| {
        let size = size(i);
        if size.is_nan() { f64::INFINITY } else { size }
    };
    let worst = (0..cloud.len()).max_by(|a, b| size(*a).total_cmp(&size(*b)));
    Failure::Diverged {
        step: solved.products as u64,
        time_s: 0.0,
        place: worst.map_or_else(|| "nowhere".to_owned(), |i| point(cloud, i)),
        quantity: format!("{name}, {unit}"),
        what: format!(
            "the solve broke down: {why}; points there do not suit the shapes: take other spacings or a lower order"
        ),
    }
}

pub(crate) fn point(cloud: &Cloud, i: usize) -> String {
    let [x, y, z] = cloud.position[i];
    format!("point {i} at ({x:.3e}, {y:.3e}, {z:.3e}) m")
}

#[cfg(test)]
mod tests {
    use super::*;
    use krylov::Ending;

    fn cloud() -> Cloud {
        let scene = r#"{"geometry": "plane", "domain": {"box": {"min_m": [0, 0], "max_m": [1, 1]}},
            "points": {"spacing_m": 0.25}, "electrostatics": {"outer": [{"potential_v": 1}]}}"#;
        crate::cloud::setup::cloud(&serde_json::from_str(scene).unwrap()).unwrap()
    }

    #[test]
    fn what_fails_names_its_point() {
        let cloud = cloud();
        let [x, ..] = cloud.position[7];
        let said = unsolvable("potential", &Error::Singular { index: 7 }, &cloud).to_string();
        assert!(said.contains(&format!("point 7 at ({x:.3e}")), "{said}");
        let said = unsolvable("potential", &Error::Memory, &cloud);
        assert_eq!(said.exit_code(), 1);
        let solved = Solved {
            ending: Ending::BrokenDown(Breakdown::NotFinite),
            products: 12,
            steps: 0,
            first: 0.0,
            last: 0.0,
            history: Vec::new(),
        };
        let size = |i: usize| if i == 7 { f64::NAN } else { 1e300 };
        let failure = broken_down(
            "potential",
            "V",
            &solved,
            Breakdown::NotFinite,
            &cloud,
            size,
        );
        assert_eq!(failure.outcome(), "diverged");
        assert!(failure.to_string().contains("point 7 at"), "{failure}");
    }
}
