//! The points of a cloud about a plane.

use super::{MARGIN, Window, dot};
use crate::draw::axes::{Scale, legend};
use crate::draw::canvas::Canvas;
use crate::draw::colour::{FAINT, Map, Rgb, WHITE, hex, mix};
use crate::field::plane::View;
use crate::field::{Kind, Points};
use crate::picture::bar_beside;

/// Room for a legend above the area \[px\].
const LEGEND: f64 = 44.0;
/// Radius of a point as part of the distance of points, and its least and greatest \[px\].
const DOT: (f64, f64, f64) = (0.38, 1.2, 9.0);
/// Colours of points in bodies, on interfaces, on walls.
const BODY: Rgb = hex(0x00_72b2);
const INTERFACE: Rgb = hex(0xd5_5e00);
const WALL: Rgb = hex(0x00_9e73);

/// Points about a plane, by what they are.
pub(crate) fn kinds(points: &Points, view: &View) -> Canvas {
    let window = Window::new(points, view, MARGIN[2] + LEGEND);
    let mut canvas = window.canvas();
    let colour = |n: usize| match (points.kind[n], points.medium[n]) {
        (Kind::Interface, _) => INTERFACE,
        (Kind::Wall, _) => WALL,
        (Kind::Inside, 0) => mix(FAINT, WHITE, 0.25),
        (Kind::Inside, m) => mix(BODY, WHITE, 0.30 * (f32::from(m) - 1.0).min(2.0)),
    };
    scatter(&mut canvas, &window, points, colour);
    let mut entries = vec![(INTERFACE, "interface"), (WALL, "wall")];
    let seen = |kind: Kind| {
        let mut own = (0..points.kind.len()).filter(|n| points.kind[*n] == kind);
        own.any(|n| shown(points, view, n).is_some())
    };
    entries.retain(|(c, _)| match *c == WALL {
        true => seen(Kind::Wall),
        false => seen(Kind::Interface),
    });
    let media: Vec<u8> = (0..=points.scene.bodies.len().min(3) as u8).collect();
    for m in media {
        let tone = match m {
            0 => mix(FAINT, WHITE, 0.25),
            m => mix(BODY, WHITE, 0.30 * (f32::from(m) - 1.0).min(2.0)),
        };
        entries.push((tone, points.scene.name(m)));
    }
    legend(&mut canvas, [MARGIN[0], MARGIN[2]], &entries);
    window.coils(&mut canvas, points);
    window.finish(&mut canvas);
    canvas
}

/// Points about a plane, by the distance of their neighbours.
pub(crate) fn spacings(points: &Points, view: &View) -> Canvas {
    let window = Window::new(points, view, MARGIN[2]);
    let mut canvas = window.canvas();
    let seen = |n: &usize| shown(points, view, *n).is_some();
    let each = (0..points.position.len())
        .filter(seen)
        .map(|n| points.spacing[n]);
    let range = each.fold([f64::INFINITY, 0.0_f64], |[l, h], s| [l.min(s), h.max(s)]);
    let (unit, factor) = super::unit(5.0 * range[1]);
    let scale = Scale {
        map: Map::Viridis,
        range: [factor * range[0], factor * range[1].max(1.001 * range[0])],
        title: format!("distance of points [{unit}]"),
    };
    let place = |n: usize| scale.colour(factor * points.spacing[n]);
    scatter(&mut canvas, &window, points, place);
    window.coils(&mut canvas, points);
    window.finish(&mut canvas);
    bar_beside(&mut canvas, &scale, window.axes.area);
    canvas
}

/// Where a point of the plane is shown; `None` for those off it.
fn shown(points: &Points, view: &View, n: usize) -> Option<[f64; 3]> {
    let at = view.project(points.position[n]);
    let half = 0.5 * points.spacing[n];
    (at[2] > -half && at[2] <= half && view.holds(at, 0.0)).then_some(at)
}

fn scatter(
    canvas: &mut Canvas,
    window: &Window<'_>,
    points: &Points,
    colour: impl Fn(usize) -> Rgb,
) {
    let scale = window.axes.area.w / (window.axes.x[1] - window.axes.x[0]) * window.factor;
    let (part, least, most) = DOT;
    let place = |n: usize| Some((n, shown(points, window.view, n)?));
    let mut all: Vec<(usize, [f64; 3])> = (0..points.position.len()).filter_map(place).collect();
    all.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
    // Interfaces are drawn last: they must be seen.
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by_key(|k| points.kind[all[*k].0] == Kind::Interface);
    for k in order {
        let (n, at) = all[k];
        let radius = part * nearest(&all, k, points.spacing[n]) * scale;
        let pixel = window.pixel([at[0], at[1]]);
        dot(canvas, pixel, radius.clamp(least, most), colour(n));
    }
}

/// Distance of the nearest of points sorted to the right, at most `far` \[m\]: layers lie closer than the points along
/// them.
fn nearest(all: &[(usize, [f64; 3])], k: usize, far: f64) -> f64 {
    let own = all[k].1;
    let near = |q: &&(usize, [f64; 3])| (q.1[0] - own[0]).abs() < far;
    let (before, after) = (all[..k].iter().rev(), all[k + 1..].iter());
    let others = before.take_while(near).chain(after.take_while(near));
    let distance = |q: &(usize, [f64; 3])| {
        let d = [0, 1, 2].map(|m| q.1[m] - own[m]);
        (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
    };
    others.map(distance).fold(far, f64::min)
}
