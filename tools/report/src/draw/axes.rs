//! Axes with ticks, units and equal scales; colour bars; legends.

use super::canvas::{Canvas, Rect};
use super::colour::{FAINT, INK, Map, Rgb};
use super::letters::{Hand, Stand, write, write_upwards};

/// A window of the plane shown in a rectangle of pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axes {
    /// Where it is shown.
    pub(crate) area: Rect,
    /// Range to the right, in the unit shown.
    pub(crate) x: [f64; 2],
    /// Range upwards, in the unit shown.
    pub(crate) y: [f64; 2],
}

impl Axes {
    /// A window shown with `scale` pixels per unit in both directions, its upper left corner at
    /// `corner`.
    pub(crate) fn equal(corner: [f64; 2], scale: f64, x: [f64; 2], y: [f64; 2]) -> Self {
        let area = Rect {
            x: corner[0],
            y: corner[1],
            w: (scale * (x[1] - x[0])).round(),
            h: (scale * (y[1] - y[0])).round(),
        };
        Self { area, x, y }
    }

    /// Pixel of a point.
    pub(crate) fn pixel(&self, at: [f64; 2]) -> [f64; 2] {
        let u = (at[0] - self.x[0]) / (self.x[1] - self.x[0]);
        let v = (at[1] - self.y[0]) / (self.y[1] - self.y[0]);
        [
            self.area.x + u * self.area.w,
            self.area.y + (1.0 - v) * self.area.h,
        ]
    }

    /// Point shown at the middle of a pixel.
    pub(crate) fn point(&self, column: i64, row: i64) -> [f64; 2] {
        let u = (column as f64 + 0.5 - self.area.x) / self.area.w;
        let v = 1.0 - (row as f64 + 0.5 - self.area.y) / self.area.h;
        [
            self.x[0] + u * (self.x[1] - self.x[0]),
            self.y[0] + v * (self.y[1] - self.y[0]),
        ]
    }

    /// Whether a point lies in the window.
    pub(crate) fn holds(&self, at: [f64; 2]) -> bool {
        at[0] >= self.x[0] && at[0] <= self.x[1] && at[1] >= self.y[0] && at[1] <= self.y[1]
    }

    /// Draws border, ticks, numbers and titles.
    pub(crate) fn draw(&self, canvas: &mut Canvas, x_title: &str, y_title: &str) {
        canvas.border(self.area, INK, 2.0);
        let bottom = self.area.y + self.area.h;
        let across = ticks(self.x, (self.area.w / 150.0).min(10.0));
        for (tick, text) in across.iter().zip(labels(&across)) {
            let at = self.pixel([*tick, self.y[0]]);
            canvas.line(at, [at[0], at[1] + 8.0], INK, 2.0);
            write(
                canvas,
                [at[0], bottom + 26.0],
                &text,
                Hand::Small,
                (Stand::Middle, INK),
            );
        }
        let mut widest = 0.0_f64;
        let upwards = ticks(self.y, (self.area.h / 80.0).min(10.0));
        for (tick, text) in upwards.iter().zip(labels(&upwards)) {
            let at = self.pixel([self.x[0], *tick]);
            widest = widest.max(Hand::Small.width(&text));
            canvas.line(at, [at[0] - 8.0, at[1]], INK, 2.0);
            write(
                canvas,
                [at[0] - 14.0, at[1]],
                &text,
                Hand::Small,
                (Stand::Right, INK),
            );
        }
        let middle = self.area.x + self.area.w / 2.0;
        write(
            canvas,
            [middle, bottom + 60.0],
            x_title,
            Hand::Plain,
            (Stand::Middle, INK),
        );
        let left = self.area.x - 36.0 - widest;
        let height = self.area.y + self.area.h / 2.0;
        write_upwards(canvas, [left, height], y_title, Hand::Plain, INK);
    }

    /// Fills the window with colours by `colour` of the point; `None` leaves the pixel.
    pub(crate) fn paint(&self, canvas: &mut Canvas, colour: impl Fn([f64; 2]) -> Option<Rgb>) {
        let (x0, y0) = (self.area.x.round() as i64, self.area.y.round() as i64);
        for row in y0..y0 + self.area.h.round() as i64 {
            for column in x0..x0 + self.area.w.round() as i64 {
                if let Some(c) = colour(self.point(column, row)) {
                    canvas.blend(column, row, c, 1.0);
                }
            }
        }
    }

    /// Draws line segments given in the units of the axes, cut off at the border.
    pub(crate) fn segments(&self, canvas: &mut Canvas, lines: &[[[f64; 2]; 2]], pen: (Rgb, f64)) {
        canvas.within(self.area, |canvas| {
            for [a, b] in lines {
                canvas.line(self.pixel(*a), self.pixel(*b), pen.0, pen.1);
            }
        });
    }
}

/// Values and title of a colour bar.
#[derive(Debug, Clone)]
pub(crate) struct Scale {
    /// Colour map.
    pub(crate) map: Map,
    /// Least and greatest value.
    pub(crate) range: [f64; 2],
    /// Quantity and unit.
    pub(crate) title: String,
}

impl Scale {
    /// Colour of a value.
    pub(crate) fn colour(&self, value: f64) -> Rgb {
        let width = (self.range[1] - self.range[0]).max(f64::MIN_POSITIVE);
        self.map.at((value - self.range[0]) / width)
    }

    /// Draws the bar; numbers stand right of it, the title to the right of them.
    pub(crate) fn bar(&self, canvas: &mut Canvas, rect: Rect) {
        let rows = rect.h.round() as i64;
        for row in 0..rows {
            let t = 1.0 - (row as f64 + 0.5) / rows as f64;
            let strip = Rect {
                x: rect.x,
                y: rect.y.round() + row as f64,
                w: rect.w,
                h: 1.0,
            };
            canvas.fill(strip, self.map.at(t));
        }
        canvas.border(rect, INK, 2.0);
        let mut widest = 0.0_f64;
        let ticks = ticks(self.range, (rect.h / 70.0).min(8.0));
        for (tick, text) in ticks.iter().zip(labels(&ticks)) {
            let t = (tick - self.range[0]) / (self.range[1] - self.range[0]);
            let y = rect.y + (1.0 - t) * rect.h;
            widest = widest.max(Hand::Small.width(&text));
            canvas.line([rect.x + rect.w, y], [rect.x + rect.w + 7.0, y], INK, 2.0);
            write(
                canvas,
                [rect.x + rect.w + 12.0, y],
                &text,
                Hand::Small,
                (Stand::Left, INK),
            );
        }
        let x = rect.x + rect.w + 12.0 + widest + 20.0;
        write_upwards(
            canvas,
            [x, rect.y + rect.h / 2.0],
            &self.title,
            Hand::Plain,
            INK,
        );
    }
}

/// Draws coloured squares with names, from left to right.
pub(crate) fn legend(canvas: &mut Canvas, at: [f64; 2], entries: &[(Rgb, &str)]) {
    let mut x = at[0];
    for (colour, name) in entries {
        let square = Rect {
            x,
            y: at[1] - 9.0,
            w: 18.0,
            h: 18.0,
        };
        canvas.fill(square, *colour);
        canvas.border(square, FAINT, 1.0);
        write(
            canvas,
            [x + 26.0, at[1]],
            name,
            Hand::Small,
            (Stand::Left, INK),
        );
        x += 26.0 + Hand::Small.width(name) + 30.0;
    }
}

/// Most ticks of an axis.
const MOST: i64 = 1000;

/// Round numbers inside `range`, about `wanted` of them.
pub(crate) fn ticks(range: [f64; 2], wanted: f64) -> Vec<f64> {
    let width = range[1] - range[0];
    if !(width > 0.0 && width.is_finite()) {
        return Vec::new();
    }
    let rough = width / wanted.max(1.0);
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|m| m * power)
        .find(|s| *s >= rough * 0.999)
        .unwrap_or(10.0 * power);
    let first = (range[0] / step - 1e-6).ceil() as i64;
    let last = (range[1] / step + 1e-6).floor() as i64;
    // Steps that are no normal number tell nothing apart.
    if !step.is_normal() || last.saturating_sub(first) > MOST {
        return Vec::new();
    }
    (first..=last).map(|i| i as f64 * step).collect()
}

/// What stands at ticks of equal steps: as many digits as tell them apart, the same for all, without needless ones.
pub(crate) fn labels(ticks: &[f64]) -> Vec<String> {
    let most = ticks.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
    let step = match ticks {
        [first, second, ..] => (second - first).abs(),
        _ => return ticks.iter().map(|t| number(*t)).collect(),
    };
    // Round steps have one digit, and rounding of the logarithm must not ask for one more.
    let digits = |unit: f64| (-(step / unit).log10().floor()).clamp(0.0, 15.0) as usize;
    if (1e-3..1e6).contains(&most) {
        let digits = digits(1.0 - 1e-9);
        return ticks.iter().map(|t| format!("{t:.digits$}")).collect();
    }
    let power = most.log10().floor();
    let unit = 10.0_f64.powf(power);
    let digits = digits(unit * (1.0 - 1e-9));
    let label = |t: &f64| match *t == 0.0 {
        true => "0".to_owned(),
        false => format!("{:.digits$}e{power}", t / unit),
    };
    ticks.iter().map(label).collect()
}

/// A number without needless digits.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{value:.1e}");
    }
    let digits = if size < 1.0 { 6 } else { 4 };
    let text = format!("{value:.digits$}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks([-0.3, 4.2], 4.0), vec![0.0, 2.0, 4.0]);
        assert_eq!(
            ticks([1750.0, 2500.0], 4.0),
            vec![1800.0, 2000.0, 2200.0, 2400.0]
        );
        assert!(ticks([1.0, 1.0], 4.0).is_empty());
        assert!(ticks([-1e-323, 1e-323], 4.0).is_empty());
        assert!(ticks([f64::MIN, f64::MAX], 4.0).is_empty());
    }

    #[test]
    fn ticks_are_told_apart_and_alike() {
        let told = |range: [f64; 2]| labels(&ticks(range, 4.0)).join(" ");
        assert_eq!(told([0.0, 4.0]), "0 1 2 3 4");
        assert_eq!(told([0.0, 2.0]), "0.0 0.5 1.0 1.5 2.0");
        assert_eq!(told([0.0, 0.3]), "0.0 0.1 0.2 0.3");
        assert_eq!(told([0.0, 4e-15]), "0 1e-15 2e-15 3e-15 4e-15");
        assert_eq!(told([-1e-6, 1e-6]), "-1.0e-6 -0.5e-6 0 0.5e-6 1.0e-6");
        assert_eq!(
            told([300.0, 300.0004]),
            "300.0000 300.0001 300.0002 300.0003 300.0004"
        );
        assert_eq!(told([0.0, 2e7]), "0 0.5e7 1.0e7 1.5e7 2.0e7");
        for scale in -14..14 {
            let range = [-1.3, 2.9].map(|v| v * 10.0_f64.powi(scale));
            let all = labels(&ticks(range, 6.0));
            let different: std::collections::BTreeSet<&String> = all.iter().collect();
            assert_eq!(different.len(), all.len(), "{all:?}");
        }
    }

    #[test]
    fn numbers_are_short() {
        let text: Vec<String> = [0.0, 2.5, -10.0, 1e7, 0.125]
            .into_iter()
            .map(number)
            .collect();
        assert_eq!(text, ["0", "2.5", "-10", "1.0e7", "0.125"]);
    }

    #[test]
    fn scales_are_equal_in_both_directions() {
        let axes = Axes::equal([10.0, 20.0], 30.0, [-1.0, 3.0], [0.0, 2.0]);
        let (a, b) = (axes.pixel([0.0, 0.0]), axes.pixel([1.0, 1.0]));
        assert!((b[0] - a[0] - 30.0).abs() < 1e-9 && (a[1] - b[1] - 30.0).abs() < 1e-9);
        let back = axes.point(39, 79);
        assert!((back[0] + 1.0 / 60.0).abs() < 1e-9 && (back[1] - 1.0 / 60.0).abs() < 1e-9);
    }
}
