//! Pictures of a weld, of its means and of an arc.

pub(crate) mod arc;
pub(crate) mod bead;
pub(crate) mod cross;
pub(crate) mod drops;
pub(crate) mod field;
pub(crate) mod flux;
pub(crate) mod heading;
pub(crate) mod heat;
pub(crate) mod heat_map;
pub(crate) mod jet;
pub(crate) mod mean;
pub(crate) mod preview;

use crate::draw::axes::{Scale, number};
use crate::draw::canvas::{Canvas, Rect};
use crate::draw::colour::{INK, Map};
use crate::draw::letters::{Hand, Stand, write};

/// Width of a full picture \[px\].
pub(crate) const WIDTH: usize = 1760;

/// A bar of a round length with its number, its left end at `at`; `scale` is pixels per mm.
pub(crate) fn scale_bar(canvas: &mut Canvas, at: [f64; 2], scale: f64) {
    let wanted = 220.0 / scale;
    let length = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]
        .into_iter()
        .rfind(|l| *l <= wanted)
        .unwrap_or(1.0);
    let end = [at[0] + length * scale, at[1]];
    canvas.line(at, end, INK, 4.0);
    for x in [at[0], end[0]] {
        canvas.line([x, at[1] - 8.0], [x, at[1] + 8.0], INK, 3.0);
    }
    let text = format!("{} mm", number(length));
    write(
        canvas,
        [end[0] + 14.0, at[1]],
        &text,
        Hand::Small,
        (Stand::Left, INK),
    );
}

/// The colours of liquid metal: from the melting point to a round number above the hottest.
pub(crate) fn heat_scale(melting: f64, hottest: f64) -> Scale {
    let top = (((hottest - melting) / 100.0).ceil() * 100.0).max(100.0);
    Scale {
        map: Map::Molten,
        range: [melting, melting + top],
        title: "temperature of liquid metal [K]".to_owned(),
    }
}

/// The value below which the share `part` of the values lies.
pub(crate) fn quantile(values: impl Iterator<Item = f64>, part: f64) -> Option<f64> {
    let mut all: Vec<f64> = values.filter(|v| v.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    let place = (part * all.len().saturating_sub(1) as f64).round() as usize;
    all.get(place).copied()
}

/// A colour bar right of `area`, as high as it but at least 200 pixels.
pub(crate) fn bar_beside(canvas: &mut Canvas, scale: &Scale, area: Rect) {
    let h = area.h.max(200.0);
    let bar = Rect {
        x: area.x + area.w + 28.0,
        y: area.y + (area.h - h) / 2.0,
        w: 26.0,
        h,
    };
    scale.bar(canvas, bar);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_values_in_order() {
        let values = [3.0, 1.0, f64::NAN, 2.0, 4.0, 5.0];
        assert_eq!(quantile(values.into_iter(), 0.5), Some(3.0));
        assert_eq!(quantile(values.into_iter(), 1.0), Some(5.0));
        assert_eq!(quantile(std::iter::empty(), 0.5), None);
    }
}
