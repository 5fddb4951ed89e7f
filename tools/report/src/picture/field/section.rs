//! A field in a plane: its colours, lines of equal value, arrows.

use super::{MARGIN, Shown, Window};
use crate::draw::axes::{Scale, ticks};
use crate::draw::canvas::{Canvas, Rect};
use crate::draw::colour::{INK, Map, Rgb, WHITE};
use crate::field::Points;
use crate::field::columns::{Part, Quantity, prefixed};
use crate::field::plane::{Field, Plane};
use crate::picture::{bar_beside, quantile};

/// Distance of arrows \[px\].
const APART: f64 = 36.0;
/// Arrows are left out where a field is weaker than that part of the strongest.
const WEAK: f64 = 0.03;
/// Least part of a vector in the plane for an arrow.
const LEVEL: f64 = 0.15;
/// Part of the nodes whose values the colours cover: edges, and the more so wires, may stand out far above all others.
const COVERED: [f64; 2] = [0.998, 0.96];
/// Lines of equal potential, about.
const LINES: f64 = 16.0;

/// What a picture of a field shows beside its colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Over {
    /// Lines of equal value.
    Lines,
    /// Arrows in the direction of one part of a vector.
    Arrows(Part),
    /// Nothing.
    Nothing,
}

/// A quantity in a plane; `None` where it is absent or without a value there.
pub(crate) fn section(
    points: &Points,
    plane: &Plane,
    quantity: &Quantity,
    map: Map,
    over: Over,
) -> Option<Shown> {
    let field = plane.field(points, quantity)?;
    let window = Window::new(points, &plane.view, MARGIN[2]);
    let sized = points.columns.is_size(quantity);
    let (scale, factor, above) = colours(points, quantity, &field, map, sized)?;
    let drawing = Drawing {
        points,
        window: &window,
        field: &field,
        scale: &scale,
        factor,
    };
    let mut canvas = window.canvas();
    let media = drawing.media();
    drawing.paint(&mut canvas, &media);
    let mut step = None;
    let mut arrows = false;
    match over {
        Over::Lines => step = drawing.lines(&mut canvas),
        Over::Arrows(part) => {
            if let Some(vectors) = plane.arrows(points, quantity, part) {
                arrows = drawing.arrows(&mut canvas, &vectors);
            }
        }
        Over::Nothing => {}
    }
    drawing.edges(&mut canvas, &media);
    window.coils(&mut canvas, points);
    window.finish(&mut canvas);
    bar_beside(&mut canvas, &scale, window.axes.area);
    let unit = scale.title.rsplit('[').next().unwrap_or_default();
    let unit = unit.trim_end_matches(']').to_owned();
    Some(Shown {
        canvas,
        step: step.map(|s| (s, unit)),
        arrows,
        above,
    })
}

/// Colours from zero, or from the least of what has a sign; with the factor to the unit shown.
fn colours(
    points: &Points,
    quantity: &Quantity,
    field: &Field,
    map: Map,
    sized: bool,
) -> Option<(Scale, f64, bool)> {
    let all = || field.media.iter().flat_map(|(_, v)| v.iter().copied());
    let wired = !points.scene.loops.is_empty() && !quantity.conductors;
    let covered = if sized {
        COVERED[usize::from(wired)]
    } else {
        1.0
    };
    let high = quantile(all(), covered)?;
    let most = all().filter(|v| v.is_finite()).fold(high, f64::max);
    let low = match sized || quantity.stem == "joule_heat" {
        true => 0.0,
        false => quantile(all(), 0.0)?,
    };
    let unit = points.columns.unit(quantity).unwrap_or("1");
    let (unit, factor) = prefixed(unit, high.abs().max(low.abs()));
    let bars = if sized {
        format!("|{}|", symbol(quantity))
    } else {
        quantity.title.to_owned()
    };
    let mut range = [factor * low, factor * high];
    if range[1] - range[0] <= 1e-12 * range[1].abs() {
        range[1] = range[0] + range[0].abs().max(1e-300);
    }
    let scale = Scale {
        map,
        range,
        title: format!("{bars} [{unit}]"),
    };
    Some((scale, factor, most > high * 1.02))
}

/// The letter of a quantity, or its name where it has none.
pub(crate) fn symbol(quantity: &Quantity) -> &'static str {
    match quantity.stem {
        "electric_field" => "E",
        "vector_potential" => "A",
        "magnetic_field" => "H",
        "magnetic_flux_density" => "B",
        "current_density" => "J",
        "force_density" => "f",
        _ => quantity.title,
    }
}

struct Drawing<'a> {
    points: &'a Points,
    window: &'a Window<'a>,
    field: &'a Field,
    scale: &'a Scale,
    factor: f64,
}

impl Drawing<'_> {
    fn area(&self) -> (i64, i64, i64, i64) {
        let Rect { x, y, w, h } = self.window.axes.area;
        (x as i64, y as i64, w as i64, h as i64)
    }

    /// The medium of each pixel, row by row; `None` outside the domain.
    fn media(&self) -> Vec<Option<u8>> {
        let (x0, y0, w, h) = self.area();
        let one = |n: i64| {
            let p = self.window.point(x0 + n % w, y0 + n / w);
            let place = self.window.view.place(p);
            let inside = self.points.scene.within(place);
            inside.then(|| self.points.scene.medium(place))
        };
        (0..w * h).map(one).collect()
    }

    /// The value shown at a place of the plane, in the unit shown.
    fn value(&self, medium: u8, p: [f64; 2]) -> Option<f64> {
        let window = self.window.view.window;
        let p = [0, 1].map(|k| p[k].clamp(window[k][0], window[k][1]));
        self.field.sample(medium, p).map(|v| self.factor * v)
    }

    fn paint(&self, canvas: &mut Canvas, media: &[Option<u8>]) {
        let (x0, y0, w, _) = self.area();
        for (n, medium) in media.iter().enumerate() {
            let Some(medium) = medium else { continue };
            let (x, y) = (x0 + n as i64 % w, y0 + n as i64 / w);
            if let Some(value) = self.value(*medium, self.window.point(x, y)) {
                canvas.blend(x, y, self.scale.colour(value), 1.0);
            }
        }
    }

    /// Draws where one medium meets another.
    fn edges(&self, canvas: &mut Canvas, media: &[Option<u8>]) {
        let (x0, y0, w, _) = self.area();
        for (n, medium) in media.iter().enumerate() {
            let (x, y) = (n as i64 % w, n as i64 / w);
            let right = if x + 1 < w { media.get(n + 1) } else { None };
            for other in [right, media.get(n + w as usize)].into_iter().flatten() {
                if other != medium {
                    let at = [(x0 + x) as f64 + 0.5, (y0 + y) as f64 + 0.5];
                    canvas.line(at, at, INK, 2.4);
                }
            }
        }
    }

    fn lines(&self, canvas: &mut Canvas) -> Option<f64> {
        let levels = ticks(self.scale.range, LINES);
        for level in &levels {
            let pen = contrast(self.scale.colour(*level));
            for (medium, _) in &self.field.media {
                let Some(grid) = self.field.grid(*medium) else {
                    continue;
                };
                let mut cut = grid.contour(level / self.factor);
                cut.retain(|[a, b]| {
                    let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
                    self.points.scene.medium(self.window.view.place(middle)) == *medium
                });
                let scaled = |s: [[f64; 2]; 2]| s.map(|p| p.map(|v| self.window.factor * v));
                let cut: Vec<_> = cut.into_iter().map(scaled).collect();
                self.window.axes.segments(canvas, &cut, (pen, 1.6));
            }
        }
        levels.windows(2).next().map(|pair| pair[1] - pair[0])
    }

    /// Whether a pixel lies in a medium that has the field, and in the area.
    fn known(&self, at: [f64; 2]) -> bool {
        let p = self.window.point(at[0] as i64, at[1] as i64);
        let medium = self.points.scene.medium(self.window.view.place(p));
        self.window.axes.holds(p.map(|v| self.window.factor * v))
            && self.field.media.iter().any(|(m, _)| *m == medium)
    }

    /// Arrows of one length on a square lattice, where the field is not weak.
    fn arrows(&self, canvas: &mut Canvas, vectors: &[Field; 2]) -> bool {
        let (x0, y0, w, h) = self.area();
        let strongest = self.scale.range[1];
        let count = |size: i64| (size as f64 / APART).floor().max(1.0) as i64;
        let mut drawn = false;
        for i in 0..count(w) {
            for k in 0..count(h) {
                let middle =
                    |size: i64, n: i64| (n as f64 + 0.5) * size as f64 / count(size) as f64;
                let at = [x0 as f64 + middle(w, i), y0 as f64 + middle(h, k)];
                let p = self.window.point(at[0] as i64, at[1] as i64);
                let medium = self.points.scene.medium(self.window.view.place(p));
                let Some(value) = self.value(medium, p).filter(|v| *v > WEAK * strongest) else {
                    continue;
                };
                let part = |field: &Field| field.sample(medium, p).unwrap_or(0.0);
                let d = [part(&vectors[0]), -part(&vectors[1])];
                let size = d[0].hypot(d[1]);
                if size * self.factor < LEVEL * value {
                    continue;
                }
                let half = d.map(|v| 0.40 * APART * v / size);
                let ends = [-1.0, 1.0].map(|s| [at[0] + s * half[0], at[1] + s * half[1]]);
                if !ends.iter().all(|end| self.known(*end)) {
                    continue;
                }
                let pen = contrast(self.scale.colour(value));
                canvas.arrow(ends[0], ends[1], pen, 2.0);
                drawn = true;
            }
        }
        drawn
    }
}

/// White on dark colours, ink on light ones.
fn contrast(colour: Rgb) -> Rgb {
    let light = 0.30 * colour[0] + 0.59 * colour[1] + 0.11 * colour[2];
    if light > 0.5 { INK } else { WHITE }
}
