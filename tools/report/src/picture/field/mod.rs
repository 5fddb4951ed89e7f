//! Points of a cloud, and electric and magnetic fields in a plane.

mod cloud;
mod section;

pub(crate) use cloud::{kinds, spacings};
pub(crate) use section::{Over, section, symbol};

use crate::draw::axes::Axes;
use crate::draw::canvas::Canvas;
use crate::draw::colour::{INK, Rgb, hex};
use crate::field::Points;
use crate::field::plane::View;
use crate::field::scene::Geometry;

/// Width of a picture, two of which stand beside each other \[px\].
const WIDTH: f64 = 1040.0;
/// Left, right, top, bottom of the area \[px\].
const MARGIN: [f64; 4] = [150.0, 210.0, 24.0, 90.0];
/// Least and greatest height of the area \[px\].
const HEIGHT: [f64; 2] = [220.0, 900.0];

/// A picture with what its caption has to tell.
#[derive(Debug, Clone)]
pub(crate) struct Shown {
    pub(crate) canvas: Canvas,
    /// Difference between lines of equal value with its unit.
    pub(crate) step: Option<(f64, String)>,
    /// Whether arrows were drawn.
    pub(crate) arrows: bool,
    /// Whether some values lie above the colours.
    pub(crate) above: bool,
}

/// The unit of lengths for a window of an extent \[m\]: its name and what one metre is in it.
fn unit(extent: f64) -> (&'static str, f64) {
    match extent {
        e if e > 0.5 => ("m", 1.0),
        e if e > 0.5e-3 => ("mm", 1e3),
        _ => ("\u{b5}m", 1e6),
    }
}

/// A window with its axes in a unit that suits it.
struct Window<'a> {
    view: &'a View,
    axes: Axes,
    factor: f64,
    titles: [String; 2],
}

impl<'a> Window<'a> {
    fn new(points: &Points, view: &'a View, top: f64) -> Self {
        let size = view.window.map(|[a, b]| b - a);
        let (unit, factor) = unit(size[0].max(size[1]));
        let [x, y] = view.window.map(|range| range.map(|v| factor * v));
        let wide = WIDTH - MARGIN[0] - MARGIN[1];
        let scale = (wide / (x[1] - x[0])).min(HEIGHT[1] / (y[1] - y[0]));
        let mut axes = Axes::equal([MARGIN[0], top], scale, x, y);
        axes.area.x += (0.5 * (wide - axes.area.w)).round();
        let name = |k: usize| match (points.scene.geometry, view.axes[k]) {
            (Geometry::Axisymmetric, 0) => "r",
            (_, axis) => ["x", "y", "z"][axis.min(2)],
        };
        Self {
            view,
            axes,
            factor,
            titles: [0, 1].map(|k| format!("{} [{unit}]", name(k))),
        }
    }

    fn canvas(&self) -> Canvas {
        let high = self.axes.area.y + self.axes.area.h.max(HEIGHT[0]) + MARGIN[3];
        Canvas::new(WIDTH as usize, high as usize)
    }

    fn pixel(&self, p: [f64; 2]) -> [f64; 2] {
        self.axes.pixel(p.map(|v| self.factor * v))
    }

    /// Place of the plane shown at a pixel \[m\].
    fn point(&self, x: i64, y: i64) -> [f64; 2] {
        self.axes.point(x, y).map(|v| v / self.factor)
    }

    fn finish(&self, canvas: &mut Canvas) {
        let [x, y] = &self.titles;
        self.axes.draw(canvas, x, y);
    }

    /// Sections of the wires of loops whose axis lies in the plane.
    fn coils(&self, canvas: &mut Canvas, points: &Points) {
        let across = self.view.cut.map_or(1, |c| c.0);
        if across == 2 || points.scene.geometry == Geometry::Plane {
            return;
        }
        for l in points.scene.loops.iter().filter(|l| l.upright) {
            for side in [-1.0, 1.0] {
                let mut at = l.centre;
                at[self.view.axes[0]] += side * l.radius;
                let at = self.view.project(at);
                let scale = self.axes.area.w / (self.axes.x[1] - self.axes.x[0]) * self.factor;
                let radius = (l.wire * scale).max(4.0);
                if self.view.holds(at, -radius / scale) {
                    let centre = self.pixel([at[0], at[1]]);
                    wire(canvas, centre, radius, side < 0.0);
                }
            }
        }
    }
}

/// The section of a wire; its current comes toward the reader or goes away.
fn wire(canvas: &mut Canvas, at: [f64; 2], radius: f64, toward: bool) {
    dot(canvas, at, radius, INK);
    dot(canvas, at, radius - 2.5, hex(0xe9_9a3c));
    if toward {
        dot(canvas, at, 0.22 * radius, INK);
    } else {
        let d = 0.5 * radius;
        canvas.line([at[0] - d, at[1] - d], [at[0] + d, at[1] + d], INK, 2.5);
        canvas.line([at[0] - d, at[1] + d], [at[0] + d, at[1] - d], INK, 2.5);
    }
}

fn dot(canvas: &mut Canvas, at: [f64; 2], radius: f64, colour: Rgb) {
    canvas.line(at, at, colour, 2.0 * radius);
}
