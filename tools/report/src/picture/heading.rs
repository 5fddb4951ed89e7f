//! Which way a weld runs in what was averaged over it.

use artefact::Table;

/// Part of a direction that counts as none.
const NONE: f64 = 1e-9;

/// The level direction of a weld, a unit vector; `None` along +y, of which tables say nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Heading(Option<[f64; 2]>);

impl Heading {
    /// Of a table of `avg`.
    pub(crate) fn of(table: &Table) -> Self {
        let part = |name: &str| table.scalar(name).ok();
        Self(part("along_x").zip(part("along_y")).map(|(x, y)| [x, y]))
    }

    /// Whether x is the axis across the weld.
    pub(crate) fn is_along_y(self) -> bool {
        self.0.is_none_or(|[x, _]| x.abs() < NONE)
    }

    /// What an axis of the scene is to the weld, as in "across x".
    pub(crate) fn axis(self, axis: char, follows: bool) -> String {
        let from = if follows {
            "along, from the arc"
        } else {
            "along"
        };
        let mark = if follows { "'" } else { "" };
        let is_along_x = self.0.is_some_and(|[_, y]| y.abs() < NONE);
        match (axis, self.is_along_y(), is_along_x) {
            ('x', true, _) | ('y', _, true) => format!("across {axis}"),
            ('y', true, _) | ('x', _, true) => format!("{from} {axis}{mark}"),
            ('x' | 'y', ..) => axis.to_string(),
            _ => format!("height {axis}"),
        }
    }

    /// A sentence on a view from above whose right is +y and whose top is -x.
    pub(crate) fn seen_from_above(self) -> String {
        let Some([x, y]) = self.0 else {
            return "The weld runs to the right.".to_owned();
        };
        match [x.abs() < NONE, y.abs() < NONE] {
            [true, _] => "The weld runs to the left.".to_owned(),
            [_, true] if x > 0.0 => "The weld runs downwards.".to_owned(),
            [_, true] => "The weld runs upwards.".to_owned(),
            _ => format!("The weld runs along x = {x:.2}, y = {y:.2}."),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weld_runs_where_its_means_say() {
        let of = |x: f64, y: f64| {
            let table = Table::new(1).attribute("along_x", "1", x);
            Heading::of(&table.attribute("along_y", "1", y))
        };
        let usual = Heading::of(&Table::new(1));
        assert_eq!(usual.seen_from_above(), "The weld runs to the right.");
        assert_eq!(usual.axis('y', true), "along, from the arc y'");
        assert_eq!(of(1.0, 0.0).seen_from_above(), "The weld runs downwards.");
        assert_eq!(of(1.0, 0.0).axis('y', true), "across y");
        assert_eq!(of(1.0, 0.0).axis('x', true), "along, from the arc x'");
        assert_eq!(
            of(0.0, -1.0).seen_from_above(),
            "The weld runs to the left."
        );
        assert_eq!(of(0.6, 0.8).axis('x', true), "x");
        assert!(
            of(0.6, 0.8)
                .seen_from_above()
                .contains("x = 0.60, y = 0.80")
        );
    }
}
