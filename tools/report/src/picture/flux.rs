//! Sections of a weld under flux: powder, slag, frozen slag, liquid and solid metal, wire; and temperatures (Komen 2019,
//! figs 5.26 and 5.27).

use super::{WIDTH, bar_beside, heat_scale, quantile, scale_bar};
use crate::draw::axes::{Axes, Scale, legend};
use crate::draw::canvas::{Canvas, Rect};
use crate::draw::colour::{self, FROZEN, INK, PLATE, Rgb, hex};
use crate::draw::discs::{Disc, draw};
use crate::draw::letters::{Hand, Stand, write};
use crate::flux::{Flux, POWDER, SLAG};
use crate::weld::Weld;

const POWDER_COLOUR: Rgb = hex(0xe8_c547);
const FROZEN_SLAG: Rgb = hex(0x8a_5a34);
const LIQUID: Rgb = hex(0x2b_6cb0);
const WIRE: Rgb = hex(0x20_2226);
/// Particles colder than the metal melts.
const COLD: Rgb = hex(0xb4_b8bd);
/// Pixels left and right of the window.
const SIDES: [f64; 2] = [110.0, 190.0];
/// Half of the thickness of what is shown, over the spacing.
const THICK: f64 = 1.0;

/// What colours tell.
#[derive(Debug, Clone)]
pub(crate) enum Tells {
    /// What each particle is.
    States,
    /// How hot it is, from the melting point of the metal on.
    Temperature(Scale),
}

/// The scale of temperatures that suits all of `moments`; none where there are no temperatures.
pub(crate) fn scale(moments: &[Flux]) -> Option<Scale> {
    let melting = moments.iter().find_map(|m| m.weld.plate.melting_point_k)?;
    let metal = moments
        .iter()
        .flat_map(|m| m.weld.temperature.iter().flatten());
    let grains = moments.iter().flat_map(|m| m.temperature.iter().flatten());
    let hot = metal.chain(grains).copied().filter(|t| *t > melting);
    let scale = heat_scale(melting, quantile(hot, 0.998)?);
    Some(Scale {
        title: "temperature [K]".to_owned(),
        ..scale
    })
}

/// Which plane is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Cut {
    /// The centre plane of the weld, seen from its right side.
    Along,
    /// A plane across it at a place \[m\], seen from behind.
    Across(f64),
}

impl Cut {
    /// Right, up and toward the viewer \[mm\], of a place \[m\]; `centre` is that of the weld.
    fn turn(self, [x, y, z]: [f64; 3], centre: f64) -> [f64; 3] {
        match self {
            Self::Along => [y, z, centre - x],
            Self::Across(place) => [x, z, place - y],
        }
        .map(|v| 1e3 * v)
    }

    /// What stands to the right.
    fn title(self, weld: &Weld) -> String {
        match self {
            Self::Along => weld.titled("along the weld", "y"),
            Self::Across(_) => weld.titled("across", "x"),
        }
    }
}

/// Draws a moment; nothing without particles near the plane.
pub(crate) fn section(flux: &Flux, cut: Cut, tells: &Tells) -> Option<Canvas> {
    let weld = &flux.weld;
    let d = weld.plate.spacing_m;
    let discs = discs(flux, cut, tells);
    let radius = 0.5e3 * d;
    let range = |k: usize| {
        let values = discs.iter().map(|disc: &Disc| disc.at[k]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(v), b.max(v))
        });
        (low < high).then_some([low - radius, high + radius])
    };
    let (x, y) = (range(0)?, range(1)?);
    let scale = (WIDTH as f64 - SIDES[0] - SIDES[1]) / (x[1] - x[0]);
    let axes = Axes::equal([SIDES[0], 40.0], scale, x, y);
    let mut canvas = Canvas::new(WIDTH, (axes.area.h + 40.0 + 150.0) as usize);
    draw(&mut canvas, &axes, &discs, radius);
    if cut == Cut::Along {
        wire(&mut canvas, &axes, flux);
    }
    axes.draw(&mut canvas, &cut.title(weld), &weld.height());
    let time = format!("{:.2} s", weld.time);
    write(
        &mut canvas,
        [axes.area.x + 16.0, axes.area.y + 26.0],
        &time,
        Hand::Plain,
        (Stand::Left, INK),
    );
    let below = axes.area.y + axes.area.h + 110.0;
    key(&mut canvas, below, &axes, tells);
    scale_bar(&mut canvas, [WIDTH as f64 - 440.0, below], scale);
    Some(canvas)
}

/// Particles near the plane, as seen from before it.
fn discs(flux: &Flux, cut: Cut, tells: &Tells) -> Vec<Disc> {
    let weld = &flux.weld;
    let (centre, d) = (weld.middle(), weld.plate.spacing_m);
    let at = |x: &[f64; 3]| cut.turn(*x, centre);
    let near = |x: &[f64; 3]| at(x)[2].abs() < 1e3 * THICK * d;
    let mut discs = Vec::new();
    for (i, x) in weld.position.iter().enumerate().filter(|(_, x)| near(x)) {
        let colour = match tells {
            Tells::States if weld.liquid[i] => LIQUID,
            Tells::States if weld.was_liquid(i) => FROZEN,
            Tells::States => PLATE,
            Tells::Temperature(scale) => warm(scale, weld.temperature.as_ref().map(|t| t[i])),
        };
        discs.push(Disc { at: at(x), colour });
    }
    for (i, x) in flux.position.iter().enumerate().filter(|(_, x)| near(x)) {
        let colour = match (tells, flux.state.get(i)) {
            (Tells::States, Some(&SLAG)) => colour::SLAG,
            (Tells::States, None | Some(&POWDER)) => POWDER_COLOUR,
            (Tells::States, Some(_)) => FROZEN_SLAG,
            (Tells::Temperature(scale), _) => warm(scale, flux.temperature.as_ref().map(|t| t[i])),
        };
        discs.push(Disc { at: at(x), colour });
    }
    discs
}

/// Fills the place of the wire.
fn wire(canvas: &mut Canvas, axes: &Axes, flux: &Flux) {
    let (x, y) = (axes.x, axes.y);
    if let Some(wire) = &flux.wire {
        let (left, right) = (wire.y[0].max(x[0]), wire.y[1].min(x[1]));
        let (low, high) = (wire.z[0].max(y[0]), wire.z[1].min(y[1]));
        if left < right && low < high {
            let ([u, v], [w, h]) = (axes.pixel([left, high]), axes.pixel([right, low]));
            let rect = Rect {
                x: u,
                y: v,
                w: w - u,
                h: h - v,
            };
            canvas.fill(rect, WIRE);
        }
    }
}

/// What colours mean.
fn key(canvas: &mut Canvas, below: f64, axes: &Axes, tells: &Tells) {
    match tells {
        Tells::States => {
            let names = [
                (POWDER_COLOUR, "powder"),
                (colour::SLAG, "slag"),
                (FROZEN_SLAG, "frozen slag"),
                (LIQUID, "liquid metal"),
                (FROZEN, "frozen metal"),
                (PLATE, "solid metal"),
                (WIRE, "wire"),
            ];
            legend(canvas, [110.0, below], &names);
        }
        Tells::Temperature(scale) => {
            legend(
                canvas,
                [110.0, below],
                &[(COLD, "colder than the metal melts"), (WIRE, "wire")],
            );
            bar_beside(canvas, scale, axes.area);
        }
    }
}

fn warm(scale: &Scale, temperature: Option<f64>) -> Rgb {
    match temperature {
        Some(t) if t >= scale.range[0] => scale.colour(t),
        _ => COLD,
    }
}
