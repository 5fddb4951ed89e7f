//! Maps of the heat flux into metal, as seen from above (Komen 2019, fig. 5.28).

use artefact::Table;

use super::heading::Heading;
use super::{WIDTH, bar_beside, quantile, scale_bar};
use crate::draw::axes::{Axes, Scale};
use crate::draw::canvas::Canvas;
use crate::draw::colour::{INK, Map};
use crate::draw::letters::{Hand, Stand, write};

/// A way of heat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Way {
    /// Column of the maps.
    pub(crate) column: &'static str,
    /// What it is called.
    pub(crate) words: &'static str,
    /// Of the column, as heat that the metal gets.
    pub(crate) sign: f64,
}

/// Ways of heat in the order shown.
pub(crate) const WAYS: [Way; 5] = [
    way("from_powder_w_m2", "powder", 1.0),
    way("from_slag_w_m2", "slag", 1.0),
    way("from_arc_w_m2", "arc", 1.0),
    way("from_torches_w_m2", "torches", 1.0),
    way("lost_w_m2", "radiation, gas and vapour", -1.0),
];

const fn way(column: &'static str, words: &'static str, sign: f64) -> Way {
    Way {
        column,
        words,
        sign,
    }
}

/// Part of all fluxes that the colours tell apart.
const TOLD: f64 = 0.97;
/// Pixels left of a map, and right of it with its colours.
const SIDES: [f64; 2] = [110.0, 180.0];
/// Most pixels across the weld.
const HIGH: f64 = 900.0;
/// Pixels above and below a map.
const ENDS: [f64; 2] = [56.0, 104.0];

/// The colours that suit all of `maps` of one way: white where nothing flows; none where nothing ever does.
pub(crate) fn scale(maps: &[Table], way: Way) -> Option<Scale> {
    let values = maps.iter().filter_map(|map| map.values(way.column).ok());
    let values = values.flatten();
    let sizes = values.map(|q| q.abs()).filter(|q| *q > 0.0);
    let most = quantile(sizes, TOLD)?;
    let power = 10.0_f64.powf(most.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].into_iter();
    let end = steps.map(|m| m * power).find(|end| *end >= most)?;
    Some(Scale {
        map: Map::BlueRed,
        range: [-1e-6 * end, 1e-6 * end],
        title: "[MW/m2]".to_owned(),
    })
}

/// Cells as a picture has them: the usual weld runs to the right, x downwards, as in other views from above.
struct Cells<'a> {
    values: &'a [f64],
    /// Lower corner of all cells, and their side \[mm\].
    corner: [f64; 2],
    side: f64,
    /// Numbers of cells.
    size: [usize; 2],
}

impl Cells<'_> {
    /// The value of the cell at a place of the picture \[mm\].
    fn at(&self, [right, up]: [f64; 2]) -> f64 {
        let place = [-up, right];
        let [i, j] = [0, 1].map(|k| {
            let cell = (place[k] - self.corner[k]) / self.side;
            (cell.max(0.0) as usize).min(self.size[k] - 1)
        });
        self.values[i * self.size[1] + j]
    }
}

/// A moment of several ways, two beside each other, each with its colours. Nothing without cells.
pub(crate) fn beside(map: &Table, shown: &[(Way, Scale)]) -> Option<Canvas> {
    let centres = [map.axis("x_m").ok()?, map.axis("y_m").ok()?];
    let [[first, ..], [along, ..]] = centres else {
        return None;
    };
    let step = |centres: &[f64]| Some(centres.get(1)? - centres[0]);
    // A map of one cell has no side.
    let side = 1e3 * step(centres[0]).or_else(|| step(centres[1]))?;
    let corner = [first, along].map(|centre| 1e3 * centre - 0.5 * side);
    let size = centres.map(<[f64]>::len);
    let [x, y] = [0, 1].map(|k| [corner[k], corner[k] + size[k] as f64 * side]);
    let columns = shown.len().min(2);
    let wide = WIDTH as f64 / columns as f64 - SIDES[0] - SIDES[1];
    let scale = (wide / (y[1] - y[0])).min(HIGH / (x[1] - x[0]));
    let pitch = scale * (x[1] - x[0]) + ENDS[0] + ENDS[1];
    let rows = shown.len().div_ceil(2);
    let mut canvas = Canvas::new(WIDTH, (rows as f64 * pitch + 60.0) as usize);
    for (place, (way, colours)) in shown.iter().enumerate() {
        let (column, row) = (place % 2, place / 2);
        let left = column as f64 * (wide + SIDES[0] + SIDES[1]) + SIDES[0];
        let top = row as f64 * pitch + ENDS[0];
        let axes = Axes::equal([left, top], scale, y, [-x[1], -x[0]]);
        let cells = Cells {
            values: map.values(way.column).ok()?,
            corner,
            side,
            size,
        };
        axes.paint(&mut canvas, |at| {
            Some(colours.colour(1e-6 * way.sign * cells.at(at)))
        });
        let heading = Heading::of(map);
        let up = match heading.is_along_y() {
            true => "across, -x [mm]",
            false => "-x [mm]",
        };
        axes.draw(
            &mut canvas,
            &format!("{} [mm]", heading.axis('y', false)),
            up,
        );
        let title = (Stand::Left, INK);
        write(
            &mut canvas,
            [left + 4.0, top - 22.0],
            way.words,
            Hand::Title,
            title,
        );
        bar_beside(&mut canvas, colours, axes.area);
    }
    scale_bar(&mut canvas, [SIDES[0], rows as f64 * pitch + 30.0], scale);
    Some(canvas)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(values: [f64; 4]) -> Table {
        Table::grid(&[
            ("x_m", "m", &[0.5e-3, 1.5e-3]),
            ("y_m", "m", &[0.5e-3, 1.5e-3]),
        ])
        .column("from_powder_w_m2", "W/m2", values)
    }

    #[test]
    fn nothing_is_white_gain_is_red_and_loss_is_blue() {
        let maps = [map([0.0, 3e5, -3e5, 1e4])];
        let scale = scale(&maps, WAYS[0]).unwrap();
        assert!((scale.range[1] - 0.5).abs() < 1e-12 && (scale.range[0] + 0.5).abs() < 1e-12);
        let [none, gain, loss] = [0.0, 0.4, -0.4].map(|q| scale.colour(q));
        assert!(none.iter().all(|part| *part > 0.85), "{none:?}");
        assert!(
            gain[0] > gain[2] + 0.3 && loss[2] > loss[0] + 0.3,
            "{gain:?} {loss:?}"
        );
        assert!(super::scale(&maps, WAYS[1]).is_none());
        assert!(super::scale(&[map([0.0; 4])], WAYS[0]).is_none());
    }

    #[test]
    fn cells_stand_where_they_lie() {
        let maps = [map([0.0, 3e5, -3e5, 0.0])];
        let shown = [(WAYS[0], scale(&maps, WAYS[0]).unwrap())];
        let canvas = beside(&maps[0], &shown).unwrap();
        // 450 pixels each: along the weld to the right, x downwards. The second value lies further along, the third further across.
        let [gain, loss] = [[785, 281], [335, 731]].map(|[x, y]| canvas.get(x, y).unwrap());
        assert!(gain[0] > gain[2] + 0.3, "{gain:?}");
        assert!(loss[2] > loss[0] + 0.3, "{loss:?}");
        assert!(beside(&Table::new(2), &shown).is_none());
        let row = Table::grid(&[("x_m", "m", &[0.0]), ("y_m", "m", &[0.5e-3, 1.5e-3])]);
        let row = row.column("from_powder_w_m2", "W/m2", [1e5, 2e5]);
        assert!(beside(&row, &shown).is_some());
    }
}
