//! The bead from above and from the side, particle by particle.

use super::{WIDTH, bar_beside, heat_scale, quantile, scale_bar};
use crate::draw::axes::{Axes, Scale, legend};
use crate::draw::canvas::Canvas;
use crate::draw::colour::{FROZEN, INK, PLATE, Rgb, SLAG, hex, mix};
use crate::draw::discs::{Disc, draw};
use crate::draw::letters::{Hand, Stand, write};
use crate::weld::Weld;

/// Solid metal close to its melting point.
const EMBER: Rgb = hex(0x5c_1a12);
/// Liquid metal of unknown temperature.
const LIQUID: Rgb = hex(0xed_6925);
/// What flies higher above the plate is not shown \[m\].
const CEILING: f64 = 12e-3;
/// Pixels left and right of the window.
const SIDES: [f64; 2] = [110.0, 190.0];

/// Colours of the particles of a weld.
#[derive(Debug, Clone)]
pub(crate) struct Paint {
    melting: f64,
    scale: Option<Scale>,
    slag: bool,
}

impl Paint {
    /// Colours that suit all of `welds`.
    pub(crate) fn of(welds: &[&Weld]) -> Self {
        let melting = welds
            .iter()
            .find_map(|w| w.plate.melting_point_k)
            .unwrap_or(1750.0);
        let hot = welds.iter().flat_map(|w| {
            let temperature = w.temperature.as_deref().unwrap_or_default();
            let liquid = temperature.iter().zip(&w.liquid).filter(|(_, l)| **l);
            liquid.map(|(t, _)| *t)
        });
        let scale = quantile(hot, 0.998).map(|hottest| heat_scale(melting, hottest));
        let slag = welds.iter().any(|weld| weld.has_slag());
        Self {
            melting,
            scale,
            slag,
        }
    }

    /// Colour of particle `i`.
    pub(crate) fn colour(&self, weld: &Weld, i: usize) -> Rgb {
        let temperature = weld.temperature.as_ref().map(|t| t[i]);
        if weld.is_slag(i) {
            return SLAG;
        }
        if weld.liquid[i] {
            return match (temperature, &self.scale) {
                (Some(t), Some(scale)) => scale.colour(t),
                _ => LIQUID,
            };
        }
        let cold = if weld.was_liquid(i) { FROZEN } else { PLATE };
        let warm = temperature.map_or(0.0, |t| (t - 300.0) / (self.melting - 300.0));
        mix(cold, EMBER, (0.9 * warm.clamp(0.0, 1.0).powf(1.3)) as f32)
    }

    /// The colour bar for liquid metal, if temperatures are known.
    pub(crate) fn scale(&self) -> Option<&Scale> {
        self.scale.as_ref()
    }

    /// Names of the colours of solid metal.
    pub(crate) fn legend(&self, canvas: &mut Canvas, at: [f64; 2]) {
        let mut entries = vec![
            (PLATE, "plate, never molten"),
            (FROZEN, "frozen weld metal"),
        ];
        if self.scale.is_some() {
            entries.push((EMBER, "solid close to melting"));
        } else {
            entries.push((LIQUID, "liquid"));
        }
        if self.slag {
            entries.push((SLAG, "slag"));
        }
        legend(canvas, at, &entries);
    }
}

/// From where the weld is seen. The welding direction runs to the right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum View {
    /// From above.
    Above,
    /// From the side, across the weld.
    Side,
}

impl View {
    /// Right, up and toward the viewer.
    fn turn(self, p: [f64; 3]) -> [f64; 3] {
        match self {
            View::Above => [p[1], -p[0], p[2]],
            View::Side => [p[1], p[2], -p[0]],
        }
        .map(|v| 1e3 * v)
    }
}

/// Draws the weld as seen from `view`; nothing without particles.
pub(crate) fn picture(weld: &Weld, paint: &Paint, view: View) -> Option<Canvas> {
    within(weld, paint, view, seen(weld, paint, view)?)
}

/// What a picture of the weld shows: along its width and its height \[mm\].
pub(crate) fn seen(weld: &Weld, paint: &Paint, view: View) -> Option<[[f64; 2]; 2]> {
    let discs = discs(weld, paint, view, weld.window()?);
    let radius = radius(weld);
    Some([range(&discs, 0, radius)?, range(&discs, 1, radius)?])
}

fn radius(weld: &Weld) -> f64 {
    0.56e3 * weld.plate.spacing_m
}

fn discs(weld: &Weld, paint: &Paint, view: View, [from, to]: [f64; 2]) -> Vec<Disc> {
    let shown = |i: &usize| {
        let p = weld.position[*i];
        (from..=to).contains(&p[1]) && p[2] < CEILING
    };
    (0..weld.position.len())
        .filter(shown)
        .map(|i| Disc {
            at: view.turn(weld.position[i]),
            colour: paint.colour(weld, i),
        })
        .collect()
}

/// Draws what of the weld lies in a range of width and height \[mm\].
pub(crate) fn within(
    weld: &Weld,
    paint: &Paint,
    view: View,
    [x, y]: [[f64; 2]; 2],
) -> Option<Canvas> {
    let radius = radius(weld);
    let discs = discs(weld, paint, view, x.map(|end| 1e-3 * end));
    let scale = (WIDTH as f64 - SIDES[0] - SIDES[1]) / (x[1] - x[0]);
    let axes = Axes::equal([SIDES[0], 56.0], scale, x, y);
    let height = (axes.area.h + 56.0 + 140.0).max(330.0);
    let mut canvas = Canvas::new(WIDTH, height as usize);
    draw(&mut canvas, &axes, &discs, radius);
    let up = match view {
        View::Above => weld.titled("across,", "-x"),
        View::Side => weld.height(),
    };
    axes.draw(&mut canvas, &weld.titled("along the weld", "y"), &up);
    if let Some(source) = weld.source_along() {
        let at = axes.pixel([1e3 * source, y[1]]);
        let arrow = [at[0], at[1] - 4.0];
        canvas.arrow([at[0], at[1] - 34.0], arrow, INK, 4.0);
        let words = "arc, moving to the right";
        let (stand, shift) = if at[0] > 0.7 * WIDTH as f64 {
            (Stand::Right, -14.0)
        } else {
            (Stand::Left, 14.0)
        };
        write(
            &mut canvas,
            [at[0] + shift, at[1] - 24.0],
            words,
            Hand::Small,
            (stand, INK),
        );
    }
    if let Some(scale) = paint.scale() {
        bar_beside(&mut canvas, scale, axes.area);
    }
    let below = axes.area.y + axes.area.h + 100.0;
    paint.legend(&mut canvas, [SIDES[0], below]);
    scale_bar(&mut canvas, [WIDTH as f64 - SIDES[1] - 320.0, below], scale);
    Some(canvas)
}

fn range(discs: &[Disc], k: usize, radius: f64) -> Option<[f64; 2]> {
    let values = discs.iter().map(|d| d.at[k]).filter(|v| v.is_finite());
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    (low <= high).then_some([low - 1.3 * radius, high + 1.3 * radius])
}
