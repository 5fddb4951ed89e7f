//! Axes of a plot: ticks, what stands at them, and pixels.

use super::{Run, text};
use crate::draw::axes::{labels, number, ticks};
use crate::html::escape;

/// Where a plot is drawn, and the ranges that it shows.
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
    pub(super) run: [Run; 2],
}

impl Frame {
    pub(super) fn pixel(&self, point: [f64; 2]) -> [f64; 2] {
        let u = share(point[0], self.x, self.run[0]);
        let v = share(point[1], self.y, self.run[1]);
        [
            self.left + u * (self.right - self.left),
            self.bottom - v * (self.bottom - self.top),
        ]
    }

    /// Ticks of an axis and what stands at them.
    fn named(&self, axis: usize, wanted: f64) -> Vec<(f64, String)> {
        let (range, run) = ([self.x, self.y][axis], self.run[axis]);
        let at = marks(range, run, wanted);
        let names = match run {
            Run::Even => labels(&at)
                .iter()
                .map(|l| l.replace('-', "\u{2212}"))
                .collect(),
            Run::Log => at.iter().map(|v| decade(*v)).collect::<Vec<_>>(),
        };
        at.into_iter().zip(names).collect()
    }

    pub(super) fn grid(&self, x_title: &str, y_title: &str) -> String {
        let mut out = String::new();
        let faint = "stroke=\"currentColor\" stroke-opacity=\"0.14\" fill=\"none\"";
        for (tick, name) in self.named(0, 7.0) {
            let [x, _] = self.pixel([tick, self.y[0]]);
            out += &format!(
                "<path {faint} d=\"M{x:.1} {:.1}V{:.1}\"/>",
                self.top, self.bottom
            );
            out += &text([x, self.bottom + 18.0], "middle", &name);
        }
        for (tick, name) in self.named(1, 6.0) {
            let [_, y] = self.pixel([self.x[0], tick]);
            out += &format!(
                "<path {faint} d=\"M{:.1} {y:.1}H{:.1}\"/>",
                self.left, self.right
            );
            out += &text([self.left - 8.0, y + 4.5], "end", &name);
        }
        out += &format!(
            "<path stroke=\"currentColor\" stroke-opacity=\"0.55\" fill=\"none\" d=\"M{:.1} {:.1}V{:.1}H{:.1}\"/>\n",
            self.left, self.top, self.bottom, self.right
        );
        let middle = 0.5 * (self.left + self.right);
        out += &text([middle, self.bottom + 40.0], "middle", x_title);
        let (x, y) = (14.0, 0.5 * (self.top + self.bottom));
        out += &format!(
            "<text transform=\"translate({x} {y:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            escape(y_title)
        );
        out
    }
}

fn share(value: f64, range: [f64; 2], run: Run) -> f64 {
    match run {
        Run::Even => (value - range[0]) / (range[1] - range[0]),
        Run::Log => (value / range[0]).ln() / (range[1] / range[0]).ln(),
    }
}

/// Where ticks stand: round numbers, or powers of ten with 2 and 5 between where there are few.
fn marks(range: [f64; 2], run: Run, wanted: f64) -> Vec<f64> {
    if run == Run::Even {
        return ticks(range, wanted);
    }
    // Beyond these powers there are no numbers.
    let power = |v: f64| v.log10().clamp(-308.0, 308.0);
    let (low, high) = (
        power(range[0]).floor() as i32,
        power(range[1]).ceil() as i32,
    );
    let inside = |v: &f64| *v >= range[0] && *v <= range[1];
    let decades: Vec<f64> = (low..=high).map(|e| 10.0_f64.powi(e)).collect();
    let tens: Vec<f64> = decades.iter().copied().filter(inside).collect();
    match tens.len() {
        0..=2 => decades
            .iter()
            .flat_map(|d| [*d, 2.0 * d, 5.0 * d])
            .filter(inside)
            .collect(),
        3..=8 => tens,
        n => tens.into_iter().step_by(n.div_ceil(7)).collect(),
    }
}

/// What stands at a tick of a logarithmic axis.
fn decade(value: f64) -> String {
    if (0.01..=9999.0).contains(&value) {
        return number(value);
    }
    let power = value.log10().floor() as i32;
    let lead = (value / 10.0_f64.powi(power)).round();
    let raised = power.to_string().replace('-', "\u{2212}");
    let sup = format!("10\u{200a}^{raised}");
    if lead > 1.5 {
        format!("{lead}\u{b7}{sup}")
    } else {
        sup
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_a_straight_line_on_logarithmic_axes() {
        let frame = Frame {
            left: 0.0,
            right: 300.0,
            top: 0.0,
            bottom: 300.0,
            x: [1.0, 1000.0],
            y: [1e-6, 1.0],
            run: [Run::Log, Run::Log],
        };
        let at: Vec<[f64; 2]> = [1.0, 10.0, 100.0, 1000.0]
            .iter()
            .map(|x: &f64| frame.pixel([*x, x.powi(-2)]))
            .collect();
        for pair in at.windows(2) {
            assert!((pair[1][0] - pair[0][0] - 100.0).abs() < 1e-9);
            assert!((pair[1][1] - pair[0][1] - 100.0).abs() < 1e-9);
        }
    }

    /// They took 16 GiB.
    #[test]
    fn ticks_of_ranges_without_end_are_few() {
        for range in [
            [0.0, 1.0],
            [1.0, f64::INFINITY],
            [f64::NAN, 1.0],
            [1e-310, f64::MAX],
        ] {
            assert!(marks(range, Run::Log, 5.0).len() < 100, "{range:?}");
        }
    }

    #[test]
    fn ticks_of_a_decade_have_steps_between() {
        assert_eq!(marks([1.0, 9.0], Run::Log, 5.0), [1.0, 2.0, 5.0]);
        assert_eq!(
            marks([0.5, 2000.0], Run::Log, 5.0),
            [1.0, 10.0, 100.0, 1000.0]
        );
        assert_eq!(decade(1e-3), "10\u{200a}^\u{2212}3");
    }
}
