//! Letters from a rasterised font.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use super::canvas::Canvas;
use super::colour::Rgb;

/// Size and weight of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Hand {
    /// Tick labels.
    Small,
    /// Axis titles and legends.
    Plain,
    /// Titles.
    Title,
}

/// Where a text stands in relation to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stand {
    /// Begins at the point.
    Left,
    /// Is centred on the point.
    Middle,
    /// Ends at the point.
    Right,
}

impl Hand {
    fn font(self) -> (FontWeight, RasterHeight) {
        match self {
            Hand::Small => (FontWeight::Regular, RasterHeight::Size24),
            Hand::Plain => (FontWeight::Bold, RasterHeight::Size24),
            Hand::Title => (FontWeight::Bold, RasterHeight::Size24),
        }
    }

    /// Height of a line \[px\].
    pub(crate) fn height(self) -> f64 {
        self.font().1.val() as f64
    }

    /// Width of `text` \[px\].
    pub(crate) fn width(self, text: &str) -> f64 {
        let (weight, size) = self.font();
        (text.chars().count() * get_raster_width(weight, size)) as f64
    }
}

/// Writes `text` with its vertical middle at `at`.
pub(crate) fn write(
    canvas: &mut Canvas,
    at: [f64; 2],
    text: &str,
    hand: Hand,
    stand: (Stand, Rgb),
) {
    let start = at[0] - offset(hand.width(text), stand.0);
    let top = at[1] - hand.height() / 2.0;
    put(text, hand, |x, y, cover| {
        canvas.blend(
            start.round() as i64 + x,
            top.round() as i64 + y,
            stand.1,
            cover,
        );
    });
}

/// Writes `text` from bottom to top with its middle at `at`.
pub(crate) fn write_upwards(
    canvas: &mut Canvas,
    at: [f64; 2],
    text: &str,
    hand: Hand,
    colour: Rgb,
) {
    let start = at[1] + hand.width(text) / 2.0;
    let left = at[0] - hand.height() / 2.0;
    put(text, hand, |x, y, cover| {
        canvas.blend(
            left.round() as i64 + y,
            start.round() as i64 - x,
            colour,
            cover,
        );
    });
}

fn offset(width: f64, stand: Stand) -> f64 {
    match stand {
        Stand::Left => 0.0,
        Stand::Middle => width / 2.0,
        Stand::Right => width,
    }
}

fn put(text: &str, hand: Hand, mut dot: impl FnMut(i64, i64, f32)) {
    let (weight, size) = hand.font();
    let advance = get_raster_width(weight, size) as i64;
    for (place, letter) in text.chars().enumerate() {
        let Some(glyph) =
            get_raster(letter, weight, size).or_else(|| get_raster('?', weight, size))
        else {
            continue;
        };
        for (y, row) in glyph.rows().enumerate() {
            for (x, cover) in row.iter().enumerate() {
                if *cover > 0 {
                    dot(
                        place as i64 * advance + x as i64,
                        y as i64,
                        f32::from(*cover) / 255.0,
                    );
                }
            }
        }
    }
}
