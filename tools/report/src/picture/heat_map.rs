//! Maps of the heat flux into metal, as seen from above (Komen 2019, fig. 5.28).

use artefact::Table;

use super::{WIDTH, bar_beside, quantile, scale_bar};
use crate::draw::axes::{Axes, Scale};
use crate::draw::canvas::{Canvas, Rect};
use crate::draw::colour::INK;
use crate::draw::colour::Map;
use crate::draw::letters::{Hand, Stand, write};

/// Ways of heat in the order shown, with the words for each.
pub(crate) const WAYS: [(&str, &str); 5] = [
    ("from_powder_w_m2", "powder"),
    ("from_slag_w_m2", "slag"),
    ("from_arc_w_m2", "arc"),
    ("from_torches_w_m2", "torches"),
    ("lost_w_m2", "losses"),
];
/// Part of all fluxes that the colours tell apart.
const TOLD: f64 = 0.995;
/// Pixels left of the first map, between two, and right of the last.
const SIDES: [f64; 3] = [110.0, 100.0, 200.0];

/// The colours that suit all of `maps` of one way: white where nothing flows; none where nothing ever does.
pub(crate) fn scale(maps: &[Table], way: &str) -> Option<Scale> {
    let values = maps.iter().filter_map(|map| map.values(way).ok()).flatten();
    let sizes = values.map(|q| q.abs()).filter(|q| *q > 0.0);
    let most = quantile(sizes, TOLD)?;
    let power = 10.0_f64.powf(most.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].into_iter();
    let end = steps.map(|m| m * power).find(|end| *end >= most)?;
    Some(Scale {
        map: Map::BlueRed,
        range: [-1e-6 * end, 1e-6 * end],
        title: "heat flux into the metal [MW/m2]".to_owned(),
    })
}

/// A moment of several ways side by side, with one scale each; the weld runs upwards. Nothing without cells.
pub(crate) fn beside(map: &Table, shown: &[(&str, &str, Scale)]) -> Option<Canvas> {
    let centres = [map.axis("x_m").ok()?, map.axis("y_m").ok()?];
    let side = match centres[0] {
        [a, b, ..] => b - a,
        _ => return None,
    };
    let ends = centres.map(|c| {
        let (first, last) = (c.first(), c.last());
        first
            .zip(last)
            .map(|(a, b)| [a - 0.5 * side, b + 0.5 * side].map(|x| 1e3 * x))
    });
    let (x, y) = (ends[0]?, ends[1]?);
    let number = shown.len() as f64;
    let room = WIDTH as f64 - SIDES[0] - number * SIDES[2] - (number - 1.0) * SIDES[1];
    let scale = (room / number / (x[1] - x[0])).min(1100.0 / (y[1] - y[0]));
    let [wide, high] = [scale * (x[1] - x[0]), scale * (y[1] - y[0])];
    let each = wide + SIDES[1] + SIDES[2];
    let full = SIDES[0] + number * each - SIDES[1];
    let mut canvas = Canvas::new(full.ceil() as usize, (high + 210.0) as usize);
    for (place, (way, words, colours)) in shown.iter().enumerate() {
        let left = SIDES[0] + place as f64 * each;
        let axes = Axes::equal([left, 64.0], scale, x, y);
        let values = map.values(way).ok()?;
        let row = centres[1].len();
        axes.paint(&mut canvas, |at| {
            let cell = |at: f64, from: f64, count: usize| {
                (((at - from) / (1e3 * side)) as usize).min(count - 1)
            };
            let n = cell(at[0], x[0], centres[0].len()) * row + cell(at[1], y[0], row);
            Some(colours.colour(1e-6 * values[n]))
        });
        axes.draw(
            &mut canvas,
            "across x [mm]",
            if place == 0 { "along y [mm]" } else { "" },
        );
        let title = (Stand::Left, INK);
        write(&mut canvas, [left + 4.0, 36.0], words, Hand::Title, title);
        let area = Rect {
            h: axes.area.h.max(260.0),
            ..axes.area
        };
        bar_beside(&mut canvas, colours, area);
    }
    scale_bar(&mut canvas, [SIDES[0], high + 180.0], scale);
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
        let scale = scale(&maps, "from_powder_w_m2").unwrap();
        assert!((scale.range[1] - 0.5).abs() < 1e-12 && (scale.range[0] + 0.5).abs() < 1e-12);
        let [none, gain, loss] = [0.0, 0.4, -0.4].map(|q| scale.colour(q));
        assert!(none.iter().all(|part| *part > 0.85), "{none:?}");
        assert!(
            gain[0] > gain[2] + 0.3 && loss[2] > loss[0] + 0.3,
            "{gain:?} {loss:?}"
        );
        assert!(super::scale(&maps, "from_slag_w_m2").is_none());
        assert!(super::scale(&[map([0.0; 4])], "from_powder_w_m2").is_none());
    }

    #[test]
    fn cells_stand_where_they_lie() {
        let maps = [map([0.0, 3e5, -3e5, 0.0])];
        let shown = [(
            "from_powder_w_m2",
            "powder",
            scale(&maps, "from_powder_w_m2").unwrap(),
        )];
        let canvas = beside(&maps[0], &shown).unwrap();
        // 550 pixels each: x runs to the right, y upwards, and the second value lies further along.
        let [gain, loss] = [[385, 339], [935, 889]].map(|[x, y]| canvas.get(x, y).unwrap());
        assert!(gain[0] > gain[2] + 0.3, "{gain:?}");
        assert!(loss[2] > loss[0] + 0.3, "{loss:?}");
        assert!(beside(&Table::new(2), &shown).is_none());
    }
}
