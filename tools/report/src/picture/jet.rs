//! Water, solids and what has broken off, seen from the side.

use crate::draw::axes::Axes;
use crate::draw::canvas::{Canvas, Rect};
use crate::draw::colour::{INK, Rgb};
use crate::draw::letters::{Hand, Stand, write};

/// Colours of the source: water, solid, broken, plate.
const WATER: Rgb = [0.16, 0.62, 0.42];
const SOLID: Rgb = [0.86, 0.34, 0.28];
const BROKEN: Rgb = [0.16, 0.34, 0.78];
const PLATE: Rgb = [0.93, 0.76, 0.25];

/// Pixels of a picture across.
const WIDTH: f64 = 860.0;
/// Tallest picture over its width.
const TALLEST: f64 = 1.1;

/// What a particle is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum What {
    /// Water.
    Water,
    /// Unbroken solid.
    Solid,
    /// Broken solid.
    Broken,
}

/// A particle in the plane of the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dot {
    /// Right and up \[mm\].
    pub(crate) at: [f64; 2],
    /// Half its spacing \[mm\].
    pub(crate) radius: f64,
    /// What it is.
    pub(crate) what: What,
}

/// The window of a picture \[mm\].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    /// Left and right.
    pub(crate) x: [f64; 2],
    /// Low and high.
    pub(crate) y: [f64; 2],
}

/// A picture at a time; `plate` tells whether a place \[mm\] is in a wall.
pub(crate) fn picture(
    window: Window,
    dots: &[Dot],
    plate: impl Fn([f64; 2]) -> bool,
    title: &str,
    up: &str,
) -> Canvas {
    let (w, h) = (window.x[1] - window.x[0], window.y[1] - window.y[0]);
    let scale = (WIDTH / w).min(TALLEST * WIDTH / h);
    let axes = Axes::equal([120.0, 50.0], scale, window.x, window.y);
    let size = (axes.area.w + 150.0, axes.area.h + 140.0);
    let mut canvas = Canvas::new(size.0 as usize, size.1 as usize);
    axes.paint(&mut canvas, |at| plate(at).then_some(PLATE));
    for dot in dots.iter().filter(|dot| axes.holds(dot.at)) {
        let colour = match dot.what {
            What::Water => WATER,
            What::Solid => SOLID,
            What::Broken => BROKEN,
        };
        disc(
            &mut canvas,
            axes.area,
            axes.pixel(dot.at),
            scale * dot.radius,
            colour,
        );
    }
    axes.draw(&mut canvas, "x [mm]", up);
    write(
        &mut canvas,
        [120.0, 24.0],
        title,
        Hand::Plain,
        (Stand::Left, INK),
    );
    canvas
}

/// Fills a disc within an area with soft edges.
fn disc(canvas: &mut Canvas, area: Rect, [u, v]: [f64; 2], radius: f64, colour: Rgb) {
    let radius = radius.max(0.7);
    let reach = radius.ceil() as i64 + 1;
    for y in v as i64 - reach..=v as i64 + reach {
        for x in u as i64 - reach..=u as i64 + reach {
            let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
            let inside = px > area.x && px < area.x + area.w && py > area.y && py < area.y + area.h;
            let cover = radius - (px - u).hypot(py - v) + 0.5;
            if inside && cover > 0.0 {
                canvas.blend(x, y, colour, cover.min(1.0) as f32);
            }
        }
    }
}
