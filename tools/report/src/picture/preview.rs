//! What would be there before a run: sections and the view from above, coloured by material or by condition, with marks.

use run::preview::{Coordinates, Mark, Marked};

use super::WIDTH;
use crate::draw::axes::{Axes, legend};
use crate::draw::canvas::{Canvas, Rect};
use crate::draw::colour::{INK, Rgb, WHITE, hex, mix};
use crate::draw::letters::Hand;
use crate::preview::Preview;

/// Room left of, right of and below the window \[px\].
const MARGIN: [f64; 3] = [150.0, 40.0, 100.0];
/// Greatest height of a window \[px\].
const TALLEST: f64 = 1000.0;
/// Height of a line of the legend \[px\].
const LINE: f64 = 34.0;
/// Part of its size within which a point is cut by a section; a little more than half, for rounding.
const CUT: f64 = 0.51;
/// Points of fewer pixels have no rim.
const RIM: f64 = 7.0;

/// Colours of materials.
const MATERIALS: [Rgb; 10] = [
    hex(0x9a_a5b1),
    hex(0x5b_8db8),
    hex(0xd9_a441),
    hex(0x7f_b069),
    hex(0xb0_7aa1),
    hex(0xc9_7b63),
    hex(0x6f_c2c2),
    hex(0xb7_9f78),
    hex(0x8e_8ed6),
    hex(0x5f_6b73),
];
/// Colours of conditions.
const CONDITIONS: [Rgb; 8] = [
    hex(0xd6_2728),
    hex(0x1f_77b4),
    hex(0x2c_a02c),
    hex(0xff_7f0e),
    hex(0x94_67bd),
    hex(0x17_a2b8),
    hex(0xe3_77c2),
    hex(0x8c_564b),
];
/// A point without the condition that is shown.
const PALE: Rgb = hex(0xd9_dde1);

/// What colours say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum By {
    /// The material.
    Material,
    /// The condition.
    Condition,
}

/// A view: which axes point right and up, and along which one looks; a section cuts there \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View {
    right: usize,
    up: usize,
    along: usize,
    cut: Option<f64>,
}

impl View {
    /// The views of a look.
    pub(crate) fn of(preview: &Preview) -> Vec<Self> {
        let flat = |right, up, along| Self {
            right,
            up,
            along,
            cut: None,
        };
        let middle = preview.middle();
        let cut = |right, up, along: usize| Self {
            cut: Some(middle[along]),
            ..flat(right, up, along)
        };
        match preview.look.coordinates {
            Coordinates::Plane => vec![flat(0, 1, 2)],
            Coordinates::Axisymmetric => vec![flat(0, 2, 1)],
            Coordinates::Space => vec![cut(0, 2, 1), cut(1, 2, 0), flat(0, 1, 2)],
        }
    }

    /// What it shows, in words.
    pub(crate) fn words(self, coordinates: Coordinates) -> String {
        let name = |axis: usize| ["x", "y", "z"][axis];
        match (self.cut, coordinates) {
            (Some(at), _) => format!(
                "A section at {} = {} mm.",
                name(self.along),
                crate::draw::axes::number((1e6 * at).round() * 1e-3)
            ),
            (None, Coordinates::Space) => "Seen from above.".to_owned(),
            (None, Coordinates::Plane) => "The plane of the scene.".to_owned(),
            (None, Coordinates::Axisymmetric) => {
                "The half plane of the scene, the axis on the left.".to_owned()
            }
        }
    }

    /// Points that are seen, the ones to be drawn first ahead.
    fn seen(self, preview: &Preview) -> Vec<usize> {
        let depth = |i: usize| preview.place[i][self.along];
        let size = |i: usize| preview.size[i][self.right] * preview.size[i][self.up];
        let cut = |i: &usize| match self.cut {
            Some(at) => (depth(*i) - at).abs() <= CUT * preview.size[*i][self.along],
            None => true,
        };
        let mut seen: Vec<usize> = (0..preview.place.len()).filter(cut).collect();
        // What is above hides what is below; in a section the small lies upon the large.
        match (self.cut, preview.look.coordinates) {
            (None, Coordinates::Space) => seen.sort_by(|a, b| depth(*a).total_cmp(&depth(*b))),
            _ => seen.sort_by(|a, b| size(*b).total_cmp(&size(*a))),
        }
        seen
    }

    /// A face that is seen from its edge, and any other mark.
    fn shows(self, mark: &Mark, line: &[[f64; 3]]) -> bool {
        let wide = |axis: usize| {
            let at = || line.iter().map(|place| place[axis]);
            at().fold(f64::NEG_INFINITY, f64::max) - at().fold(f64::INFINITY, f64::min) > 0.0
        };
        mark.kind != Marked::Condition || !(wide(self.right) && wide(self.up))
    }
}

/// The picture of a view; none where there is nothing.
pub(crate) fn picture(preview: &Preview, view: View, by: By) -> Option<Canvas> {
    let [low, high] = preview.bounds()?.map(|corner| corner.map(|x| 1e3 * x));
    let extent = |k: usize| high[k] - low[k];
    let room = 0.02 * extent(view.right).max(extent(view.up));
    let range = |k: usize| [low[k] - room, high[k] + room];
    let (x, y) = (range(view.right), range(view.up));
    let wide = WIDTH as f64 - MARGIN[0] - MARGIN[1];
    let scale = (wide / (x[1] - x[0])).min(TALLEST / (y[1] - y[0]));
    if !(scale.is_finite() && scale > 0.0) {
        return None;
    }
    let seen = view.seen(preview);
    let names = entries(preview, view, &seen, by);
    let rows = wrapped(&names, WIDTH as f64 - 2.0 * MARGIN[1]);
    let top = LINE * rows.len() as f64 + 24.0;
    let axes = Axes::equal([MARGIN[0], top], scale, x, y);
    let mut canvas = Canvas::new(WIDTH, (top + axes.area.h + MARGIN[2]) as usize);
    canvas.within(axes.area, |canvas| {
        for i in &seen {
            point(canvas, &axes, preview, view, by, *i);
        }
        marks(canvas, &axes, preview, view);
    });
    let name = |axis: usize| match (preview.look.coordinates, axis) {
        (Coordinates::Axisymmetric, 0) => "r [mm]",
        _ => ["x [mm]", "y [mm]", "z [mm]"][axis],
    };
    axes.draw(&mut canvas, name(view.right), name(view.up));
    for (row, names) in rows.iter().enumerate() {
        legend(&mut canvas, [MARGIN[1], 20.0 + LINE * row as f64], names);
    }
    Some(canvas)
}

/// A point as a rectangle of its size.
fn point(canvas: &mut Canvas, axes: &Axes, preview: &Preview, view: View, by: By, i: usize) {
    let (place, size) = (preview.place[i], preview.size[i]);
    let at = axes.pixel([1e3 * place[view.right], 1e3 * place[view.up]]);
    let scale = axes.area.w / (axes.x[1] - axes.x[0]) * 1e3;
    let [w, h] = [view.right, view.up].map(|k| (scale * size[k]).max(1.0));
    let rect = Rect {
        x: at[0] - 0.5 * w,
        y: at[1] - 0.5 * h,
        w,
        h,
    };
    let colour = match (by, preview.condition[i]) {
        (By::Material, _) => material(preview.material[i] as usize),
        (By::Condition, 0) => PALE,
        (By::Condition, number) => condition(number as usize - 1),
    };
    canvas.fill(rect, colour);
    if w.min(h) >= RIM {
        canvas.border(rect, mix(colour, WHITE, 0.35), 1.0);
    }
}

fn material(number: usize) -> Rgb {
    MATERIALS[number % MATERIALS.len()]
}

fn condition(number: usize) -> Rgb {
    CONDITIONS[number % CONDITIONS.len()]
}

/// Colour of mark `number` of its kind, and the width of its lines \[px\].
fn pen(kind: Marked, number: usize) -> (Rgb, f64) {
    match kind {
        Marked::Axis => (INK, 3.0),
        Marked::Path => (hex(0x7b_1fa2), 5.0),
        Marked::Droplets => (hex(0x00_6d8f), 7.0),
        // Faces that lie on each other are seen beside each other.
        Marked::Condition => (condition(number), (13.0 - 4.0 * number as f64).max(4.0)),
        Marked::Wall => (hex(0x6d_4c41), 3.0),
        Marked::Coil => (hex(0xb3_5900), 5.0),
        Marked::Probe => (hex(0x00_0000), 11.0),
    }
}

/// Marks with their numbers among those of their kind.
fn numbered(preview: &Preview) -> impl Iterator<Item = (usize, &Mark)> {
    let kinds = [
        Marked::Condition,
        Marked::Wall,
        Marked::Droplets,
        Marked::Axis,
        Marked::Path,
        Marked::Coil,
        Marked::Probe,
    ];
    kinds
        .into_iter()
        .flat_map(|kind| preview.marks(kind).enumerate())
}

fn marks(canvas: &mut Canvas, axes: &Axes, preview: &Preview, view: View) {
    let pixel = |place: &[f64; 3]| axes.pixel([1e3 * place[view.right], 1e3 * place[view.up]]);
    for (number, mark) in numbered(preview) {
        let (colour, width) = pen(mark.kind, number);
        for line in mark.lines_m.iter().filter(|line| view.shows(mark, line)) {
            match line.as_slice() {
                [place] => canvas.line(pixel(place), pixel(place), colour, width.max(9.0)),
                corners => {
                    for pair in corners.windows(2) {
                        let [from, to] = [pixel(&pair[0]), pixel(&pair[1])];
                        let far = (to[0] - from[0]).hypot(to[1] - from[1]);
                        match mark.kind {
                            Marked::Droplets if far > 12.0 => {
                                canvas.arrow(from, to, colour, width);
                            }
                            Marked::Axis if far > 12.0 => canvas.dashes(from, to, colour, width),
                            // Along the view: a place.
                            _ => canvas.line(
                                from,
                                to,
                                colour,
                                width.max(if far < 1.0 { 11.0 } else { 0.0 }),
                            ),
                        }
                    }
                }
            }
        }
    }
}

/// What the legend of a view names: materials or conditions that are seen, and marks.
fn entries<'a>(preview: &'a Preview, view: View, seen: &[usize], by: By) -> Vec<(Rgb, &'a str)> {
    let numbers = |column: &[u32]| {
        let all: std::collections::BTreeSet<u32> = seen.iter().map(|i| column[*i]).collect();
        all.into_iter().collect::<Vec<_>>()
    };
    let mut all: Vec<(Rgb, &str)> = match by {
        By::Material => {
            let numbers = numbers(&preview.material).into_iter();
            let entry = |m: u32| (material(m as usize), preview.material_name(m));
            numbers.map(entry).collect()
        }
        By::Condition => {
            let numbers = numbers(&preview.condition).into_iter().filter(|c| *c > 0);
            let entry = |c: u32| (condition(c as usize - 1), preview.condition_name(c));
            numbers.map(entry).collect()
        }
    };
    let shown = |mark: &Mark| mark.lines_m.iter().any(|line| view.shows(mark, line));
    let marks = numbered(preview).filter(|(_, mark)| shown(mark));
    all.extend(marks.map(|(number, mark)| (pen(mark.kind, number).0, mark.name.as_str())));
    all
}

/// Entries of a legend in lines that are no wider than `room` \[px\].
fn wrapped<'a>(entries: &[(Rgb, &'a str)], room: f64) -> Vec<Vec<(Rgb, &'a str)>> {
    let mut rows: Vec<Vec<(Rgb, &str)>> = Vec::new();
    let mut used = f64::INFINITY;
    for entry in entries {
        let width = 56.0 + Hand::Small.width(entry.1);
        if used + width > room {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += width;
        if let Some(row) = rows.last_mut() {
            row.push(*entry);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use run::preview::Look;

    /// A plate of two materials, 4 by 2 by 2 points, with a mirror below.
    fn plate() -> Preview {
        let mut preview = Preview {
            title: None,
            tool: "poolsph".to_owned(),
            look: Look {
                materials: vec!["a".to_owned(), "b".to_owned()],
                conditions: vec!["held".to_owned()],
                ..Look::default()
            },
            place: Vec::new(),
            size: Vec::new(),
            material: Vec::new(),
            condition: Vec::new(),
        };
        for i in 0..16_u32 {
            let at = [i % 4, i / 4 % 2, i / 8];
            preview.place.push(at.map(|n| 1e-3 * (f64::from(n) + 0.5)));
            preview.size.push([1e-3; 3]);
            preview.material.push(at[0] / 2);
            preview.condition.push(u32::from(at[2] == 1));
        }
        preview.look.marks.push(Mark {
            name: "mirror".to_owned(),
            kind: Marked::Condition,
            lines_m: run::preview::face([[0.0; 3], [4e-3, 2e-3, 2e-3]], 2, false),
        });
        preview
    }

    #[test]
    fn sections_cut_and_colours_say_what_there_is() {
        let preview = plate();
        let views = View::of(&preview);
        assert_eq!(views.len(), 3);
        // Both layers touch the middle plane; all is seen from above.
        let seen: Vec<usize> = views.iter().map(|v| v.seen(&preview).len()).collect();
        assert_eq!(seen, [16, 8, 16]);
        let canvas = picture(&preview, views[0], By::Material).unwrap();
        let found = |colour: Rgb| {
            (0..canvas.height as i64)
                .any(|y| (0..canvas.width as i64).any(|x| canvas.get(x, y) == Some(colour)))
        };
        assert!(found(material(0)) && found(material(1)) && !found(material(2)));
        assert!(found(condition(0)), "the mirror below");
        // Seen from above the mirror is no line.
        let above = entries(&preview, views[2], &[0], By::Condition);
        assert!(above.is_empty(), "{above:?}");
    }

    #[test]
    fn a_long_legend_has_several_lines() {
        let names = vec![(INK, "a name of some length"); 12];
        let rows = wrapped(&names, 1000.0);
        assert!(rows.len() > 2);
        assert_eq!(rows.iter().map(Vec::len).sum::<usize>(), 12);
        assert!(wrapped(&[], 1000.0).is_empty());
    }
}
