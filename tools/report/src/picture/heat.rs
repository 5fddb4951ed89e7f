//! The temperature in a plane of a body, with isotherms and the interfaces of its materials.

use super::{WIDTH, bar_beside};
use crate::draw::axes::{Axes, Scale, number, ticks};
use crate::draw::canvas::{Canvas, Rect};
use crate::draw::colour::{INK, Map, Rgb, WHITE};
use crate::draw::contour::Grid;
use crate::draw::letters::{Hand, Stand, write};
use crate::heat::Points;
use crate::heat::field::{Cut, Field};

/// Left, right, top, bottom of the area \[px\].
const MARGIN: [f64; 4] = [150.0, 210.0, 44.0, 90.0];
/// Least and greatest height of the area \[px\].
const HEIGHT: [f64; 2] = [200.0, 900.0];
/// Part of the greater extent that stays free around the body.
const ROOM: f64 = 0.02;
/// Isotherms, about.
const LINES: f64 = 12.0;
/// Temperatures that differ by less, as part of themselves, are the same.
const SAME: f64 = 1e-6;
/// Half of the scale of a body of one temperature, as part of it.
const ALIKE: f64 = 5e-4;
/// Length of a dash of an interface and of what follows it \[px\].
const DASH: i64 = 14;

/// A picture with what its caption has to tell.
#[derive(Debug, Clone)]
pub(crate) struct Shown {
    pub(crate) canvas: Canvas,
    /// Difference between isotherms \[K\]; `None` where there are none.
    pub(crate) step: Option<f64>,
    /// How much larger heights are shown than widths.
    pub(crate) stretch: f64,
    /// Whether there is more than one material in the plane.
    pub(crate) layers: bool,
}

/// The unit of lengths for a body of an extent \[m\]: its name and what one metre is in it.
fn unit(extent: f64) -> (&'static str, f64) {
    match extent {
        e if e > 0.5 => ("m", 1.0),
        e if e > 0.5e-3 => ("mm", 1e3),
        _ => ("um", 1e6),
    }
}

/// Titles of the axes.
fn titles(field: &Field, unit: &str) -> [String; 2] {
    let mut names = match field.cut {
        Cut::Plane | Cut::Middle(2) => ["x", "y"],
        Cut::Half(0) => ["r", "x"],
        Cut::Half(1) => ["r", "y"],
        Cut::Half(_) => ["r", "z"],
        Cut::Middle(0) => ["y", "z"],
        Cut::Middle(_) => ["x", "z"],
    };
    if field.lying {
        names.reverse();
    }
    names.map(|n| format!("{n} [{unit}]"))
}

/// The window in which a body is shown, and its stretch.
fn frame(field: &Field, factor: f64) -> (Axes, f64) {
    let body = field.window.map(|range| range.map(|v| factor * v));
    let size = body.map(|[a, b]| b - a);
    let room = ROOM * size[0].max(size[1]);
    let range = |k: usize, room: f64| match field.radial() {
        Some(radius) if radius == k => [body[k][0].max(0.0), body[k][1] + room],
        _ => [body[k][0] - room, body[k][1] + room],
    };
    let (x, mut y) = (range(0, room), range(1, room));
    let most = WIDTH as f64 - MARGIN[0] - MARGIN[1];
    let scale = (most / (x[1] - x[0])).min(HEIGHT[1] / (y[1] - y[0]));
    let mut stretch = 1.0;
    let flat = scale * (y[1] - y[0]);
    if flat < HEIGHT[0] {
        // The room around the body is not stretched with it.
        let own = scale * size[1];
        stretch = ((HEIGHT[0] - (flat - own)) / own).ceil().max(2.0);
        y = range(1, room / stretch);
    }
    let w = (scale * (x[1] - x[0])).round();
    let h = (stretch * scale * (y[1] - y[0])).max(60.0).round();
    let high = h.max(220.0);
    let area = Rect {
        x: MARGIN[0] + (0.5 * (most - w)).round(),
        y: (MARGIN[2] + 0.5 * (high - h)).round(),
        w,
        h,
    };
    (Axes { area, x, y }, stretch)
}

/// The picture of a field; `None` where there is nothing to see.
pub(crate) fn picture(points: &Points, field: &Field) -> Option<Shown> {
    let extent = field.window.map(|[a, b]| b - a);
    let (unit, factor) = unit(extent[0].max(extent[1]));
    let (axes, stretch) = frame(field, factor);
    let total =
        axes.area.y + axes.area.h.max(axes.area.h + 0.5 * (220.0 - axes.area.h)) + MARGIN[3];
    let mut canvas = Canvas::new(WIDTH, total as usize);
    let scale = scale(points);
    let view = View {
        points,
        field,
        axes: &axes,
        factor,
    };
    let kinds = view.kinds();
    view.paint(&mut canvas, &scale, &kinds);
    let levels = levels(points, &scale);
    let layers = view.edges(&mut canvas, &scale, &kinds);
    view.isotherms(&mut canvas, &scale, &levels);
    let [x, y] = titles(field, unit);
    axes.draw(&mut canvas, &x, &y);
    bar_beside(&mut canvas, &scale, axes.area);
    Some(Shown {
        canvas,
        step: levels.windows(2).next().map(|pair| pair[1] - pair[0]),
        stretch,
        layers,
    })
}

/// Colours from the coldest to the hottest point.
fn scale(points: &Points) -> Scale {
    let range = points.range();
    let size = range.least.abs().max(range.greatest.abs());
    let more = if range.greatest - range.least > SAME * size {
        0.0
    } else if size > 0.0 {
        ALIKE * size
    } else {
        0.5
    };
    Scale {
        map: Map::Molten,
        range: [range.least - more, range.greatest + more],
        title: "temperature [K]".to_owned(),
    }
}

/// Temperatures of the isotherms \[K\]; none in a body of one temperature.
fn levels(points: &Points, scale: &Scale) -> Vec<f64> {
    let [low, high] = scale.range;
    let range = points.range();
    if range.greatest - range.least <= SAME * range.greatest.abs().max(range.least.abs()) {
        return Vec::new();
    }
    let mut levels = ticks(scale.range, LINES);
    levels.retain(|t| *t > low && *t < high);
    levels
}

/// A temperature that is drawn: its level, its colour, and its pieces.
struct Isotherm {
    level: f64,
    pen: Rgb,
    lines: Vec<[[f64; 2]; 2]>,
}

struct View<'a> {
    points: &'a Points,
    field: &'a Field,
    axes: &'a Axes,
    factor: f64,
}

impl View<'_> {
    /// The material of each pixel of the area, row by row; `None` outside the body.
    fn kinds(&self) -> Vec<Option<usize>> {
        let area = self.axes.area;
        let (x0, y0) = (area.x as i64, area.y as i64);
        let (w, h) = (area.w as i64, area.h as i64);
        let one = |n: i64| {
            let p = self.axes.point(x0 + n % w, y0 + n / w);
            let p = p.map(|v| v / self.factor);
            let inside = self.field.holds(self.points, p);
            inside.then(|| self.field.material(self.points, p))
        };
        (0..w * h).map(one).collect()
    }

    fn grid(&self, material: usize) -> Grid<'_> {
        Grid {
            first: &self.field.across,
            second: &self.field.up,
            values: self.field.values_of(material),
        }
    }

    /// The temperature shown at a pixel \[K\].
    fn value(&self, [x, y]: [i64; 2], material: usize) -> Option<f64> {
        let p = self.axes.point(x, y).map(|v| v / self.factor);
        let window = self.field.window;
        let [u, v] = [0, 1].map(|k| p[k].clamp(window[k][0], window[k][1]));
        self.grid(material).sample(u, v)
    }

    fn paint(&self, canvas: &mut Canvas, scale: &Scale, kinds: &[Option<usize>]) {
        let area = self.axes.area;
        let (x0, y0, w) = (area.x as i64, area.y as i64, area.w as i64);
        for (n, kind) in kinds.iter().enumerate() {
            let Some(material) = kind else { continue };
            let (x, y) = (x0 + n as i64 % w, y0 + n as i64 / w);
            if let Some(value) = self.value([x, y], *material) {
                canvas.blend(x, y, scale.colour(value), 1.0);
            }
        }
    }

    /// Draws the outline of the body and, dashed, what parts its materials; tells whether any does.
    fn edges(&self, canvas: &mut Canvas, scale: &Scale, kinds: &[Option<usize>]) -> bool {
        let area = self.axes.area;
        let (x0, y0, w) = (area.x as i64, area.y as i64, area.w as i64);
        let mut layers = false;
        for (n, kind) in kinds.iter().enumerate() {
            let (x, y) = (n as i64 % w, n as i64 / w);
            let right = if x + 1 < w { kinds.get(n + 1) } else { None };
            let below = kinds.get(n + w as usize);
            for (other, aside) in [(right, [0, 1]), (below, [1, 0])] {
                let Some(other) = other else { continue };
                if other == kind {
                    continue;
                }
                let parts = kind.is_some() && other.is_some();
                layers |= parts;
                let along = if aside == [0, 1] { y } else { x };
                if parts && (along / DASH) % 2 == 1 {
                    continue;
                }
                let at = [x0 + x, y0 + y];
                let value = kind.filter(|_| parts).and_then(|m| self.value(at, m));
                let pen = value.map_or(INK, |v| contrast(scale.colour(v)));
                canvas.blend(at[0], at[1], pen, 1.0);
                canvas.blend(at[0] + aside[1], at[1] + aside[0], pen, 1.0);
            }
        }
        layers
    }

    fn isotherms(&self, canvas: &mut Canvas, scale: &Scale, levels: &[f64]) {
        let materials = self.field.values.len();
        let mut drawn: Vec<Isotherm> = Vec::new();
        for level in levels {
            let pen = contrast(scale.colour(*level));
            let mut lines = Vec::new();
            for material in 0..materials {
                let own =
                    |p: [f64; 2]| materials == 1 || self.field.material(self.points, p) == material;
                let cut = self.grid(material).contour(*level);
                let inside = cut.into_iter().filter(|[a, b]| {
                    let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
                    self.field.holds(self.points, middle) && own(middle)
                });
                lines.extend(inside.map(|s| s.map(|p| p.map(|v| self.factor * v))));
            }
            self.axes.segments(canvas, &lines, (pen, 2.0));
            drawn.push(Isotherm {
                level: *level,
                pen,
                lines,
            });
        }
        let mut labels: Vec<Rect> = Vec::new();
        for isotherm in &drawn {
            self.label(canvas, isotherm, scale, &mut labels);
        }
    }

    /// Writes the temperature of an isotherm upon it, as near to the middle as others leave room.
    fn label(
        &self,
        canvas: &mut Canvas,
        isotherm: &Isotherm,
        scale: &Scale,
        labels: &mut Vec<Rect>,
    ) {
        let level = isotherm.level;
        let text = number(level);
        let (w, h) = (Hand::Small.width(&text) + 8.0, 24.0);
        let area = self.axes.area;
        let middle = [area.x + 0.5 * area.w, area.y + 0.5 * area.h];
        let free = |at: &[f64; 2]| {
            let inside = at[0] - 0.5 * w > area.x + 4.0
                && at[0] + 0.5 * w < area.x + area.w - 4.0
                && at[1] - 0.5 * h > area.y + 4.0
                && at[1] + 0.5 * h < area.y + area.h - 4.0;
            let near = |l: &Rect| {
                (l.x - at[0]).abs() < 0.5 * (l.w + w) + 24.0 && (l.y - at[1]).abs() < h + 6.0
            };
            let corners = [[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]];
            inside
                && !labels.iter().any(near)
                && corners.iter().all(|c| {
                    let pixel = [at[0] + c[0] * w, at[1] + c[1] * h];
                    let p = self.axes.point(pixel[0] as i64, pixel[1] as i64);
                    self.field.holds(self.points, p.map(|v| v / self.factor))
                })
        };
        let far = |at: &[f64; 2]| (at[0] - middle[0]).hypot(4.0 * (at[1] - middle[1]));
        let places = isotherm
            .lines
            .iter()
            .map(|[a, _]| self.axes.pixel(*a))
            .filter(free);
        let Some(at) = places.min_by(|a, b| far(a).total_cmp(&far(b))) else {
            return;
        };
        let back = Rect {
            x: at[0] - 0.5 * w,
            y: at[1] - 0.5 * h,
            w,
            h,
        };
        canvas.fill(back, scale.colour(level));
        write(
            canvas,
            at,
            &text,
            Hand::Small,
            (Stand::Middle, isotherm.pen),
        );
        labels.push(Rect {
            x: at[0],
            y: at[1],
            w,
            h,
        });
    }
}

/// White on dark colours, ink on light ones.
fn contrast(colour: Rgb) -> Rgb {
    let light = 0.30 * colour[0] + 0.59 * colour[1] + 0.11 * colour[2];
    if light > 0.5 { INK } else { WHITE }
}
