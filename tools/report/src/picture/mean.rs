//! Averaged flow: arrows over temperature, per phase and over time.

use super::{WIDTH, bar_beside, heat_scale, quantile, scale_bar};
use crate::draw::axes::{Axes, Scale, number};
use crate::draw::canvas::{Canvas, Rect};
use crate::draw::colour::{INK, Map, PLATE, Rgb, WHITE, hex};
use crate::draw::contour::Grid;
use crate::draw::letters::{Hand, Stand, write};

mod field;

pub(crate) use field::Field;

/// Colours and the arrow scale that all pictures of a series share.
#[derive(Debug, Clone)]
pub(crate) struct Style {
    scale: Scale,
    heat: bool,
    /// All flows, as grains do, whatever their temperature.
    whole: bool,
    /// Speed of the reference arrow \[m/s\].
    reference: f64,
}

/// Least distance between arrows \[px\].
const APART: f64 = 34.0;
/// Length of the arrow of the reference speed, in distances between arrows.
const ARROW: f64 = 1.9;

/// How arrows are laid out in a picture.
#[derive(Debug, Clone, Copy)]
struct Lattice {
    /// Arrows stand at every so many grid points.
    every: usize,
    /// Pixels per m/s.
    scale: f64,
    /// Length of the reference arrow \[px\].
    reference: f64,
}

impl Lattice {
    /// For a grid spacing of `spacing` pixels.
    fn new(spacing: f64, style: &Style) -> Self {
        let every = (APART / spacing.max(1.0)).ceil().max(1.0);
        let reference = ARROW * every * spacing;
        Self {
            every: every as usize,
            scale: reference / style.reference,
            reference,
        }
    }
}

impl Style {
    /// What suits all of `fields`; nothing where no liquid is.
    pub(crate) fn of(fields: &[Field], melting: f64) -> Option<Self> {
        let fast = quantile(fields.iter().flat_map(Field::speeds), 0.98)?;
        let power = 10.0_f64.powf(fast.max(1e-6).log10().floor());
        let reference = [1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .map(|m| m * power)
            .find(|s| *s >= 0.7 * fast);
        let hot = quantile(fields.iter().flat_map(Field::hottest), 0.998);
        let speed = Scale {
            map: Map::Viridis,
            range: [0.0, fast.max(1e-6)],
            title: "speed in the plane [m/s]".to_owned(),
        };
        Some(Self {
            heat: hot.is_some(),
            whole: false,
            scale: hot.map_or(speed, |hot| heat_scale(melting, hot)),
            reference: reference.unwrap_or(power),
        })
    }

    /// What suits all of `fields` whose every place flows: colours from their coldest place on.
    pub(crate) fn of_all(fields: &[Field]) -> Option<Self> {
        let coldest = quantile(fields.iter().flat_map(Field::hottest), 0.0);
        let mut style = Self::of(fields, coldest.unwrap_or(0.0))?;
        style.whole = true;
        if style.heat {
            "temperature [K]".clone_into(&mut style.scale.title);
        }
        Some(style)
    }

    /// Whether every place flows.
    pub(crate) fn whole(&self) -> bool {
        self.whole
    }

    /// The speed that the reference arrow stands for \[m/s\].
    pub(crate) fn reference(&self) -> f64 {
        self.reference
    }

    /// Whether colour is temperature; else it is speed.
    pub(crate) fn heat(&self) -> bool {
        self.heat
    }
}

/// One field over the full width; nothing where no metal is.
pub(crate) fn single(field: &Field, style: &Style) -> Option<Canvas> {
    let [x, y] = field.window()?;
    let scale = (WIDTH as f64 - 330.0) / (x[1] - x[0]);
    let scale = scale.min(900.0 / (y[1] - y[0]));
    let axes = Axes::equal([130.0, 40.0], scale, x, y);
    let height = axes.area.h + 40.0 + 140.0;
    let mut canvas = Canvas::new(WIDTH, height.max(330.0) as usize);
    paint(&mut canvas, &axes, field, style);
    let [right, up] = field.titles();
    axes.draw(&mut canvas, &right, &up);
    bar_beside(&mut canvas, &style.scale, axes.area);
    key(
        &mut canvas,
        [130.0, height - 40.0],
        style,
        scale * field.spacing(),
    );
    scale_bar(
        &mut canvas,
        [130.0 + axes.area.w - 320.0, height - 40.0],
        scale,
    );
    Some(canvas)
}

/// All phases in two columns, with one scale; nothing where no metal is.
pub(crate) fn phases(fields: &[Field], style: &Style) -> Option<Canvas> {
    let windows = fields.iter().filter_map(Field::window);
    let [x, y] =
        windows.reduce(|a, b| [0, 1].map(|k| [a[k][0].min(b[k][0]), a[k][1].max(b[k][1])]))?;
    let spacing = fields.first()?.spacing();
    let (left, gap) = (120.0, 90.0);
    let width = (WIDTH as f64 - left - gap - 190.0) / 2.0;
    let scale = width / (x[1] - x[0]);
    let high = scale * (y[1] - y[0]);
    let rows = fields.len().div_ceil(2);
    let pitch = high + 74.0;
    let height = rows as f64 * pitch + 150.0;
    let mut canvas = Canvas::new(WIDTH, height as usize);
    let mut last = None;
    for (n, field) in fields.iter().enumerate() {
        // Down the first column, then down the second.
        let (column, row) = (n / rows, n % rows);
        let corner = [
            left + column as f64 * (width + gap),
            44.0 + row as f64 * pitch,
        ];
        let axes = Axes::equal(corner, scale, x, y);
        paint(&mut canvas, &axes, field, style);
        let bottom = row + 1 == rows || n + 1 == fields.len();
        let [right, up] = field.titles();
        axes.draw(
            &mut canvas,
            if bottom { &right } else { "" },
            if column == 0 { &up } else { "" },
        );
        let name = format!("phase {:.3}", field.phase.unwrap_or(0.0));
        write(
            &mut canvas,
            [corner[0] + 4.0, corner[1] - 16.0],
            &name,
            Hand::Title,
            (Stand::Left, INK),
        );
        last = Some(axes);
    }
    let area = Rect {
        x: left + width + gap,
        y: 44.0,
        w: width,
        h: last?.area.h.max(260.0),
    };
    bar_beside(&mut canvas, &style.scale, area);
    key(&mut canvas, [left, height - 34.0], style, scale * spacing);
    scale_bar(&mut canvas, [left + width + gap, height - 34.0], scale);
    Some(canvas)
}

fn paint(canvas: &mut Canvas, axes: &Axes, field: &Field, style: &Style) {
    let lattice = Lattice::new(
        field.spacing() * axes.area.w / (axes.x[1] - axes.x[0]),
        style,
    );
    let rows = field.second.len();
    let share =
        |flags: &[bool]| -> Vec<f64> { flags.iter().map(|f| f64::from(u8::from(*f))).collect() };
    let (metal, liquid) = (share(&field.metal), share(&field.liquid));
    let shown: Vec<f64> = match &field.temperature {
        Some(t) if style.heat => t.clone(),
        _ => (0..metal.len()).map(|n| field.speed(n)).collect(),
    };
    let grid = |values| Grid {
        first: &field.first,
        second: &field.second,
        values,
    };
    // Only values of grid points that hold metal enter the colour.
    let product: Vec<f64> = shown.iter().zip(&metal).map(|(v, m)| v * m).collect();
    let (metal, liquid, product) = (grid(&metal), grid(&liquid), grid(&product));
    let place = |p: [f64; 2]| if field.turned() { [-p[1], p[0]] } else { p };
    axes.paint(canvas, |p| {
        let [a, b] = place(p);
        let share = metal.sample(a, b).filter(|share| *share >= 0.5)?;
        let molten = liquid.sample(a, b).is_some_and(|l| l >= 0.5);
        let value = product.sample(a, b)? / share;
        Some(if molten {
            style.scale.colour(value)
        } else {
            PLATE
        })
    });
    canvas.within(axes.area, |canvas| {
        for (n, at) in field.points() {
            let row = [n / rows, n % rows];
            let chosen = row.iter().all(|i| i.is_multiple_of(lattice.every));
            if chosen && field.liquid[n] && axes.holds(at) {
                arrow(canvas, axes.pixel(at), field.flow(n), lattice);
            }
        }
    });
}

fn arrow(canvas: &mut Canvas, at: [f64; 2], u: [f64; 2], lattice: Lattice) {
    let half = [0.5 * u[0] * lattice.scale, -0.5 * u[1] * lattice.scale];
    if half[0].hypot(half[1]) < 2.0 {
        return;
    }
    let tail = [at[0] - half[0], at[1] - half[1]];
    let tip = [at[0] + half[0], at[1] + half[1]];
    canvas.arrow(tail, tip, WHITE, 4.4);
    canvas.arrow(tail, tip, ARROWS, 2.4);
}

/// Near to black, cool: stands out on every colour of hot metal.
const ARROWS: Rgb = hex(0x0a_1a2a);

/// The reference arrow with its speed.
fn key(canvas: &mut Canvas, at: [f64; 2], style: &Style, spacing: f64) {
    let lattice = Lattice::new(spacing, style);
    let end = [at[0] + lattice.reference, at[1]];
    canvas.arrow(at, end, ARROWS, 3.0);
    let words = format!("{} m/s", number(style.reference));
    write(
        canvas,
        [end[0] + 14.0, at[1]],
        &words,
        Hand::Small,
        (Stand::Left, INK),
    );
}
