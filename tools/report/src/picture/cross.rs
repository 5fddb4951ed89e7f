//! Sections through the weld: what has been fused, the fusion line, and its measures.

use super::bead::Paint;
use super::{WIDTH, bar_beside, scale_bar};
use crate::draw::axes::{Axes, legend};
use crate::draw::canvas::Canvas;
use crate::draw::colour::{FAINT, FROZEN, INK, PLATE, Rgb, hex};
use crate::draw::contour::Grid;
use crate::draw::letters::{Hand, Stand, write};
use crate::measure::bead::Bead;
use crate::measure::section::{Plane, Section};
use crate::weld::Weld;

const FUSION: Rgb = hex(0x00_9e73);
const GAUGE: Rgb = hex(0x00_3f7d);
const MEASURED: Rgb = hex(0xd6_2828);
/// Half of the length of a line of what was measured \[mm\].
const MARK: f64 = 1.5;
/// What is higher above the plate is not shown \[mm\].
const CEILING: f64 = 12.0;
/// What is smaller gets no gauge \[m\].
const SHOWN: f64 = 0.2e-3;

fn millimetres(values: &[f64]) -> Vec<f64> {
    values.iter().map(|v| 1e3 * v).collect()
}

/// A window over the metal of a section.
struct View {
    canvas: Canvas,
    axes: Axes,
    scale: f64,
    across: Vec<f64>,
    up: Vec<f64>,
}

fn view(section: &Section, window: [f64; 2], up: [f64; 2], sides: [f64; 2]) -> View {
    let scale = (WIDTH as f64 - sides[0] - sides[1]) / (window[1] - window[0]);
    let axes = Axes::equal([sides[0], 40.0], scale, window, up);
    let height = (axes.area.h + 40.0 + 140.0).max(330.0);
    View {
        canvas: Canvas::new(WIDTH, height as usize),
        axes,
        scale,
        across: millimetres(&section.across),
        up: millimetres(&section.up),
    }
}

/// A section that was measured, as far as it is known \[m\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Published {
    /// Depth of the fusion line below the plate's surface.
    pub(crate) depth: Option<f64>,
    /// Half of the width.
    pub(crate) half_width: Option<f64>,
    /// Height above the plate's surface.
    pub(crate) height: Option<f64>,
}

impl Published {
    /// Lines of its depth, its ends and its height around a centre \[mm\].
    fn lines(&self, centre: f64) -> Vec<[[f64; 2]; 2]> {
        let level = |z: f64| [[centre - MARK, 1e3 * z], [centre + MARK, 1e3 * z]];
        let end = |x: f64| [[centre + 1e3 * x, -MARK], [centre + 1e3 * x, MARK]];
        let levels = [self.depth.map(|d| -d), self.height];
        let ends = self.half_width.into_iter().flat_map(|half| [-half, half]);
        let levels = levels.into_iter().flatten().map(level);
        levels.chain(ends.map(end)).collect()
    }
}

/// The section across the weld with penetration, width and height marked, and those of one that was measured; nothing without metal.
pub(crate) fn across(
    weld: &Weld,
    section: &Section,
    bead: &Bead,
    published: Published,
) -> Option<Canvas> {
    let (across, up) = (extent(section, true)?, extent(section, false)?);
    let centre = 1e3 * weld.middle();
    let measured = published.half_width.map_or(0.0, |half| 1e3 * half + 1.0);
    let half = (0.75 * 1e3 * bead.bead_width.max(bead.fused_width)).max(9.0);
    let half = half.max(measured);
    let window = [across[0].max(centre - half), across[1].min(centre + half)];
    let mut v = view(section, window, [up[0], up[1] + 1.6], [120.0, 120.0]);
    let (metal, fused) = (section.metal.as_slice(), section.fused_fraction());
    let (metal, fused) = (
        Grid {
            first: &v.across,
            second: &v.up,
            values: metal,
        },
        Grid {
            first: &v.across,
            second: &v.up,
            values: &fused,
        },
    );
    v.axes.paint(&mut v.canvas, |p| {
        let here = metal.sample(p[0], p[1])? >= 0.5;
        let weld = fused.sample(p[0], p[1]).is_some_and(|f| f >= 0.5);
        here.then_some(if weld { FROZEN } else { PLATE })
    });
    v.axes
        .segments(&mut v.canvas, &metal.contour(0.5), (INK, 3.0));
    v.axes
        .segments(&mut v.canvas, &inside(&metal, &fused), (FUSION, 5.0));
    let (a, b) = (
        v.axes.pixel([window[0], 0.0]),
        v.axes.pixel([window[1], 0.0]),
    );
    v.canvas.dashes(a, b, FAINT, 2.0);
    let lines = published.lines(centre);
    for [a, b] in &lines {
        let [a, b] = [a, b].map(|at| v.axes.pixel(*at));
        v.canvas.dashes(a, b, MEASURED, 4.0);
    }
    gauges(&mut v.canvas, &v.axes, bead, centre);
    v.axes.draw(
        &mut v.canvas,
        &weld.titled("across the weld", "x"),
        &weld.height(),
    );
    let below = v.axes.area.y + v.axes.area.h + 100.0;
    let mut names = vec![
        (PLATE, "plate"),
        (FROZEN, "fused metal"),
        (FUSION, "fusion line"),
        (FAINT, "original surface"),
    ];
    if !lines.is_empty() {
        names.push((MEASURED, "measured"));
    }
    legend(&mut v.canvas, [120.0, below], &names);
    scale_bar(&mut v.canvas, [WIDTH as f64 - 440.0, below], v.scale);
    Some(v.canvas)
}

/// The section along the centre plane, coloured by temperature, with the fusion line.
pub(crate) fn along(weld: &Weld, paint: &Paint) -> Option<Canvas> {
    let section = Section::cut(&weld.metal(), Plane::Along, weld.middle());
    let (all, up) = (extent(&section, true)?, extent(&section, false)?);
    let up = [up[0], up[1].min(CEILING)];
    let [from, to] = weld.window()?.map(|v| 1e3 * v);
    let across = [all[0].max(from - 0.4), all[1].min(to + 0.4)];
    let mut v = view(&section, across, up, [110.0, 190.0]);
    let nearest = nearest(weld, &section);
    let fused = section.fused_fraction();
    let metal = Grid {
        first: &v.across,
        second: &v.up,
        values: &section.metal,
    };
    let fused = Grid {
        first: &v.across,
        second: &v.up,
        values: &fused,
    };
    let step = v.across[1] - v.across[0];
    v.axes.paint(&mut v.canvas, |p| {
        if metal.sample(p[0], p[1])? < 0.5 {
            return None;
        }
        let i = ((p[0] - v.across[0]) / step).round() as usize;
        let k = ((p[1] - v.up[0]) / step).round() as usize;
        let particle = *nearest.get(i * v.up.len() + k)?;
        (particle != usize::MAX).then(|| paint.colour(weld, particle))
    });
    v.axes
        .segments(&mut v.canvas, &metal.contour(0.5), (INK, 2.0));
    v.axes
        .segments(&mut v.canvas, &inside(&metal, &fused), (FUSION, 5.0));
    v.axes.draw(
        &mut v.canvas,
        &weld.titled("along the weld", "y"),
        &weld.height(),
    );
    if let Some(scale) = paint.scale() {
        bar_beside(&mut v.canvas, scale, v.axes.area);
    }
    let below = v.axes.area.y + v.axes.area.h + 100.0;
    legend(
        &mut v.canvas,
        [110.0, below],
        &[
            (PLATE, "plate"),
            (FROZEN, "frozen"),
            (FUSION, "fusion line"),
        ],
    );
    scale_bar(&mut v.canvas, [WIDTH as f64 - 510.0, below], v.scale);
    Some(v.canvas)
}

/// The fusion line, where it runs through metal.
fn inside(metal: &Grid<'_>, fused: &Grid<'_>) -> Vec<[[f64; 2]; 2]> {
    let mut line = fused.contour(0.5);
    line.retain(|[a, _]| metal.sample(a[0], a[1]).is_some_and(|m| m > 0.5));
    line
}

/// Index of the particle nearest to each grid point of the section, within two spacings.
fn nearest(weld: &Weld, section: &Section) -> Vec<usize> {
    let rows = section.up.len();
    let reach = 2.0 * weld.plate.spacing_m;
    let step = section.up[1] - section.up[0];
    let mut found = vec![(f64::INFINITY, usize::MAX); section.across.len() * rows];
    let span = |at: f64, origin: f64, count: usize| {
        let low = ((at - reach - origin) / step).ceil().max(0.0) as usize;
        let high = ((at + reach - origin) / step).floor().max(-1.0) as i64 + 1;
        low..(high.max(0) as usize).min(count)
    };
    for (index, p) in weld.position.iter().enumerate() {
        let off = p[0] - section.place;
        if off.abs() >= reach {
            continue;
        }
        for i in span(p[1], section.across[0], section.across.len()) {
            for k in span(p[2], section.up[0], rows) {
                let (dy, dz) = (section.across[i] - p[1], section.up[k] - p[2]);
                let square = off * off + dy * dy + dz * dz;
                let place = &mut found[i * rows + k];
                if square < place.0 {
                    *place = (square, index);
                }
            }
        }
    }
    found.into_iter().map(|(_, index)| index).collect()
}

/// Least and greatest coordinate at which there is metal \[mm\], with a margin.
fn extent(section: &Section, horizontal: bool) -> Option<[f64; 2]> {
    let rows = section.up.len();
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (n, share) in section.metal.iter().enumerate() {
        if *share >= 0.5 {
            let at = if horizontal {
                section.across[n / rows]
            } else {
                section.up[n % rows]
            };
            low = low.min(1e3 * at);
            high = high.max(1e3 * at);
        }
    }
    (low < high).then_some([low - 0.4, high + 0.4])
}

/// Marks penetration, fused width, width and height of the bead with their numbers.
fn gauges(canvas: &mut Canvas, axes: &Axes, bead: &Bead, centre: f64) {
    let mm = |v: f64| 1e3 * v;
    let wide = mm(bead.fused_width.max(bead.bead_width)) / 2.0;
    let label = |name: &str, value: f64| format!("{name} {:.1} mm", mm(value));
    if bead.penetration > SHOWN {
        let x = centre + wide + 0.8;
        upright(
            canvas,
            axes,
            [x, -mm(bead.penetration), 0.0],
            &label("penetration", bead.penetration),
        );
    }
    if bead.reinforcement > SHOWN {
        let x = centre + wide + 0.8;
        upright(
            canvas,
            axes,
            [x, 0.0, mm(bead.reinforcement)],
            &label("height", bead.reinforcement),
        );
    }
    if bead.fused_width > SHOWN {
        let z = -mm(bead.penetration) - 0.7;
        level(
            canvas,
            axes,
            [
                z,
                centre - mm(bead.fused_width) / 2.0,
                centre + mm(bead.fused_width) / 2.0,
            ],
            &label("fused width", bead.fused_width),
        );
    }
    if bead.bead_width > SHOWN {
        let z = mm(bead.reinforcement) + 0.6;
        level(
            canvas,
            axes,
            [
                z,
                centre - mm(bead.bead_width) / 2.0,
                centre + mm(bead.bead_width) / 2.0,
            ],
            &label("bead width", bead.bead_width),
        );
    }
}

/// A gauge at `[x, from, to]` with its words on the right, or left where there is no room.
fn upright(canvas: &mut Canvas, axes: &Axes, [x, from, to]: [f64; 3], words: &str) {
    let (a, b) = (axes.pixel([x, from]), axes.pixel([x, to]));
    both_ways(canvas, a, b);
    for p in [a, b] {
        canvas.line([p[0] - 12.0, p[1]], [p[0] + 12.0, p[1]], GAUGE, 2.0);
    }
    let room = a[0] + 20.0 + Hand::Small.width(words) < axes.area.x + axes.area.w;
    let (stand, shift) = if room {
        (Stand::Left, 18.0)
    } else {
        (Stand::Right, -18.0)
    };
    // The words of a short gauge stand away from the surface, where the other gauge begins.
    let short = (20.0 - 0.5 * (a[1] - b[1]).abs()).max(0.0);
    let away = if from < 0.0 { short } else { -short };
    write(
        canvas,
        [a[0] + shift, 0.5 * (a[1] + b[1]) + away],
        words,
        Hand::Small,
        (stand, GAUGE),
    );
}

/// A gauge at `[z, from, to]` with its words in the middle, above it.
fn level(canvas: &mut Canvas, axes: &Axes, [z, from, to]: [f64; 3], words: &str) {
    let (a, b) = (axes.pixel([from, z]), axes.pixel([to, z]));
    both_ways(canvas, a, b);
    for p in [a, b] {
        canvas.line([p[0], p[1] - 12.0], [p[0], p[1] + 12.0], GAUGE, 2.0);
    }
    write(
        canvas,
        [0.5 * (a[0] + b[0]), a[1] - 16.0],
        words,
        Hand::Small,
        (Stand::Middle, GAUGE),
    );
}

fn both_ways(canvas: &mut Canvas, a: [f64; 2], b: [f64; 2]) {
    let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    canvas.arrow(middle, a, GAUGE, 3.0);
    canvas.arrow(middle, b, GAUGE, 3.0);
}
