//! Drops that meet and part, seen from the side: their surfaces, a colour for each drop.

use crate::draw::axes::Axes;
use crate::draw::canvas::Canvas;
use crate::draw::colour::{INK, Rgb, hex};
use crate::draw::discs::{Disc, draw};
use crate::draw::letters::{Hand, Stand, write};

/// Colours of drops, again from the first after the last; the last of all is that of parcels.
const DROPS: [Rgb; 5] = [
    hex(0x56_b4e9),
    hex(0xe6_9f00),
    hex(0x00_9e73),
    hex(0xcc_79a7),
    hex(0xf0_e442),
];
const PARCEL: Rgb = hex(0x99_9999);

/// Pixels of a picture across, and its height over that at most.
const WIDTH: f64 = 520.0;
const TALLEST: f64 = 1.2;

/// A point of a surface, or a parcel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dot {
    /// Place \[mm\].
    pub(crate) at: [f64; 3],
    /// The number of its drop; none for a parcel.
    pub(crate) drop: Option<u32>,
}

/// The window of a picture, along x and along z \[mm\].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    pub(crate) x: [f64; 2],
    pub(crate) z: [f64; 2],
}

/// A picture of dots of a radius \[mm\].
pub(crate) fn picture(window: Window, dots: &[Dot], radius: f64, title: &str) -> Canvas {
    let (w, h) = (window.x[1] - window.x[0], window.z[1] - window.z[0]);
    let scale = (WIDTH / w).min(TALLEST * WIDTH / h);
    let axes = Axes::equal([90.0, 50.0], scale, window.x, window.z);
    let size = [axes.area.w + 120.0, axes.area.h + 130.0];
    let mut canvas = Canvas::new(size[0] as usize, size[1] as usize);
    let discs: Vec<Disc> = dots
        .iter()
        .map(|dot| Disc {
            // Seen against y.
            at: [dot.at[0], dot.at[2], -dot.at[1]],
            colour: dot.drop.map_or(PARCEL, |k| DROPS[k as usize % DROPS.len()]),
        })
        .collect();
    draw(&mut canvas, &axes, &discs, radius);
    axes.draw(&mut canvas, "x [mm]", "z [mm]");
    write(
        &mut canvas,
        [90.0, 24.0],
        title,
        Hand::Plain,
        (Stand::Left, INK),
    );
    canvas
}
