//! The plane in which the temperature of a body is shown, and the temperature in it.
//!
//! A plane body is shown as it is. A body whose shape and temperature are the same all around an
//! axis is shown over radius and height, every point of it in its place. Any other is cut through
//! its middle, across the axis along which its temperature changes least.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::Points;
use super::fit::{Fit, Sample};

/// Points whose radius and height differ by less than this part of the spacing are averaged.
const SAME: f64 = 0.25;
/// Greatest deviation (root mean square) from an axisymmetric field, as part of its range.
const EVEN: f64 = 0.02;
/// Part of another axis's change of temperature that is clearly less, whatever the edges of the body add.
const LESS: f64 = 0.8;
/// Part of all change of temperature that is none.
const NOISE: f64 = 1e-6;
/// A body that many times higher than wide is laid down.
const HIGH: f64 = 2.5;
/// Half of the slab whose points tell of a section, in spacings.
const SLAB: f64 = 2.0;
/// Nodes of the field along an axis.
const NODES: [f64; 2] = [24.0, 320.0];
/// A place farther from every point, in spacings, is outside a body whose shape is unknown.
const NEAR: f64 = 0.75;
/// Places along an axis at which the extent of the body is sought.
const SOUGHT: usize = 400;

/// How the plane lies in the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Cut {
    /// The body is plane.
    Plane,
    /// Radius and height about an axis (0, 1, 2 for x, y, z).
    Half(usize),
    /// Through the middle, across an axis.
    Middle(usize),
}

/// The temperature in a plane of the body.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    /// How the plane lies.
    pub(crate) cut: Cut,
    /// Whether what would point upwards points to the right, because the body is long that way.
    pub(crate) lying: bool,
    /// Coordinate of the section \[m\], where it is one through the middle.
    pub(crate) depth: f64,
    /// Range to the right and upwards that the body fills \[m\].
    pub(crate) window: [[f64; 2]; 2],
    /// Nodes to the right \[m\].
    pub(crate) across: Vec<f64>,
    /// Nodes upwards \[m\].
    pub(crate) up: Vec<f64>,
    /// Temperatures at the nodes \[K\]: one set, or one for each material where they jump.
    pub(crate) values: Vec<Vec<f64>>,
    /// Places of the middle of the body \[m\].
    centre: [f64; 3],
    /// What is inside where no shape tells it.
    near: Fit,
    reach: f64,
}

/// Axes to the right and upwards of a plane across an axis.
fn beside(normal: usize) -> [usize; 2] {
    match normal {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}

impl Field {
    /// The field of a frame; `None` without points.
    pub(crate) fn of(points: &Points) -> Option<Self> {
        if points.plane {
            return Self::cut(points, Cut::Plane);
        }
        let round = [2, 0, 1].into_iter().filter(|k| is_round(points, *k));
        for axis in round {
            if let Some(field) = Self::cut(points, Cut::Half(axis))
                && field.deviation(points) <= EVEN
            {
                return Some(field);
            }
        }
        Self::cut(points, Cut::Middle(steadiest(points)))
    }

    fn cut(points: &Points, cut: Cut) -> Option<Self> {
        let centre = points.centre();
        let spacing = points.spacing();
        let size = bounds(&project(points, cut, false, centre))?.map(|[a, b]| b - a);
        let lying = size[1] > HIGH * size[0];
        let samples = project(points, cut, lying, centre);
        let groups = if points.body.jumps {
            points.material.as_ref()
        } else {
            None
        };
        let fits: Vec<Option<Fit>> = match groups {
            None => vec![merged(&samples, |_| true, spacing)],
            Some(material) => {
                let count = material.iter().max().map_or(1, |m| m + 1);
                let one = |m| merged(&samples, |n| material[n] == m, spacing);
                (0..count).map(one).collect()
            }
        };
        let near = merged(&samples, |_| true, spacing)?;
        let mut field = Self {
            cut,
            lying,
            depth: match cut {
                Cut::Middle(k) => centre[k],
                _ => 0.0,
            },
            window: bounds(&samples)?,
            across: Vec::new(),
            up: Vec::new(),
            values: Vec::new(),
            centre,
            near,
            reach: NEAR * spacing,
        };
        field.window = field.extent(points, spacing);
        field.across = nodes(field.window[0], spacing);
        field.up = nodes(field.window[1], spacing);
        field.values = fits
            .iter()
            .map(|fit| field.evaluate(fit.as_ref().unwrap_or(&field.near)))
            .collect();
        Some(field)
    }

    fn evaluate(&self, fit: &Fit) -> Vec<f64> {
        let row = |u: &f64| self.up.iter().map(|v| fit.at([*u, *v])).collect::<Vec<_>>();
        self.across.iter().flat_map(row).collect()
    }

    /// The place in space of a place in the plane \[m\].
    pub(crate) fn place(&self, p: [f64; 2]) -> [f64; 3] {
        let [u, v] = if self.lying { [p[1], p[0]] } else { p };
        let mut at = self.centre;
        match self.cut {
            Cut::Plane => at = [u, v, 0.0],
            Cut::Half(axis) => {
                at[beside(axis)[0]] += u;
                at[axis] = v;
            }
            Cut::Middle(axis) => {
                let [a, b] = beside(axis);
                (at[a], at[b]) = (u, v);
            }
        }
        at
    }

    /// Which direction of the plane is the radius: 0 to the right, 1 upwards.
    pub(crate) fn radial(&self) -> Option<usize> {
        matches!(self.cut, Cut::Half(_)).then_some(usize::from(self.lying))
    }

    /// Whether a place in the plane is inside the body.
    pub(crate) fn holds(&self, points: &Points, p: [f64; 2]) -> bool {
        if self.radial().is_some_and(|k| p[k] < 0.0) {
            return false;
        }
        let known = points.body.holds(self.place(p));
        known.unwrap_or_else(|| self.near.distance(p) <= self.reach)
    }

    /// Material at a place in the plane.
    pub(crate) fn material(&self, points: &Points, p: [f64; 2]) -> usize {
        points.body.material(self.place(p))
    }

    /// The values that hold where a material is.
    pub(crate) fn values_of(&self, material: usize) -> &[f64] {
        &self.values[material.min(self.values.len() - 1)]
    }

    /// What the body fills of the plane \[m\].
    fn extent(&self, points: &Points, spacing: f64) -> [[f64; 2]; 2] {
        let wide = self.window.map(|[a, b]| [a - spacing, b + spacing]);
        let at =
            |k: usize, n: usize| wide[k][0] + (wide[k][1] - wide[k][0]) * n as f64 / SOUGHT as f64;
        let mut found = self.window;
        for i in 0..=SOUGHT {
            for k in 0..=SOUGHT {
                let p = [at(0, i), at(1, k)];
                let new = (0..2).any(|m| p[m] < found[m][0] || p[m] > found[m][1]);
                if new && self.holds(points, p) {
                    for m in 0..2 {
                        found[m] = [found[m][0].min(p[m]), found[m][1].max(p[m])];
                    }
                }
            }
        }
        found
    }

    /// How far the points lie from the field, as part of the range of temperatures.
    fn deviation(&self, points: &Points) -> f64 {
        let range = points.range();
        let width = (range.greatest - range.least).max(1e-6 * range.greatest.abs());
        let samples = project(points, self.cut, self.lying, self.centre);
        let grid = crate::draw::contour::Grid {
            first: &self.across,
            second: &self.up,
            values: &self.values[0],
        };
        let clip = |v: f64, [a, b]: [f64; 2]| v.clamp(a, b);
        let (mut sum, mut count) = (0.0, 0.0);
        for sample in &samples {
            let p = [0, 1].map(|k| clip(sample.at[k], self.window[k]));
            if let Some(value) = grid.sample(p[0], p[1]) {
                sum += ((value - sample.value) / width).powi(2);
                count += 1.0;
            }
        }
        if width > 0.0 && count > 0.0 {
            (sum / count).sqrt()
        } else {
            0.0
        }
    }
}

/// All points that a plane shows, in its coordinates; the others of the section far off it.
fn project(points: &Points, cut: Cut, lying: bool, centre: [f64; 3]) -> Vec<Sample> {
    let each = points.position.iter().zip(&points.temperature);
    let at = |p: &[f64; 3]| match cut {
        Cut::Plane => [p[0], p[1], 0.0],
        Cut::Half(axis) => {
            let [a, b] = beside(axis);
            [(p[a] - centre[a]).hypot(p[b] - centre[b]), p[axis], 0.0]
        }
        Cut::Middle(axis) => {
            let [a, b] = beside(axis);
            [p[a], p[b], p[axis] - centre[axis]]
        }
    };
    each.map(|(p, t)| {
        let [u, v, w] = at(p);
        Sample {
            at: if lying { [v, u, w] } else { [u, v, w] },
            value: *t,
        }
    })
    .collect()
}

/// A fit through the chosen samples near the plane, those of one place averaged.
fn merged(samples: &[Sample], chosen: impl Fn(usize) -> bool, spacing: f64) -> Option<Fit> {
    let mut places: BTreeMap<[i64; 3], (f64, [f64; 4])> = BTreeMap::new();
    for (n, sample) in samples.iter().enumerate() {
        if !chosen(n) || sample.at[2].abs() > SLAB * spacing {
            continue;
        }
        let key = sample.at.map(|x| (x / (SAME * spacing)).round() as i64);
        let (count, sum) = places.entry(key).or_default();
        *count += 1.0;
        let [u, v, w] = sample.at;
        for (sum, part) in sum.iter_mut().zip([u, v, w, sample.value]) {
            *sum += part;
        }
    }
    let mean = |(count, sum): &(f64, [f64; 4])| Sample {
        at: [sum[0] / count, sum[1] / count, sum[2] / count],
        value: sum[3] / count,
    };
    Fit::new(places.values().map(mean).collect())
}

fn bounds(samples: &[Sample]) -> Option<[[f64; 2]; 2]> {
    let first = samples.first()?.at;
    let start = [[first[0]; 2], [first[1]; 2]];
    Some(samples.iter().fold(start, |mut all, sample| {
        for (range, x) in all.iter_mut().zip(sample.at) {
            *range = [range[0].min(x), range[1].max(x)];
        }
        all
    }))
}

fn nodes([low, high]: [f64; 2], spacing: f64) -> Vec<f64> {
    let count = (3.0 * (high - low) / spacing).round();
    let count = count.clamp(NODES[0], NODES[1]) as usize;
    let at = |n: usize| low + (high - low) * n as f64 / count as f64;
    (0..=count).map(at).collect()
}

/// Whether the body has the same shape all around an axis through its middle.
fn is_round(points: &Points, axis: usize) -> bool {
    let centre = points.centre();
    let [a, b] = beside(axis);
    let less = 0.5 * points.spacing();
    let step = (points.position.len() / 4000).max(1);
    points.position.iter().step_by(step).all(|p| {
        let r = ((p[a] - centre[a]).hypot(p[b] - centre[b]) - less).max(0.0);
        (0..12).all(|n| {
            let (sine, cosine) = (TAU * (f64::from(n) + 0.5) / 12.0).sin_cos();
            let mut q = *p;
            q[a] = centre[a] + r * cosine;
            q[b] = centre[b] + r * sine;
            q[axis] += (centre[axis] - q[axis]).clamp(-less, less);
            points.body.holds(q) == Some(true)
        })
    })
}

/// The axis along which the temperature changes least; of those where it changes as little the one along
/// which the body is shortest, and y before x before z.
fn steadiest(points: &Points) -> usize {
    let size = points.spacing();
    let mean = points.range().mean;
    let change = |axis: usize| {
        let [a, b] = beside(axis);
        let mut columns: BTreeMap<[i64; 2], [f64; 3]> = BTreeMap::new();
        for (p, t) in points.position.iter().zip(&points.temperature) {
            let key = [p[a], p[b]].map(|x| (x / size).round() as i64);
            let [count, sum, square] = columns.entry(key).or_default();
            let t = t - mean;
            *count += 1.0;
            *sum += t;
            *square += t * t;
        }
        let own = |[count, sum, square]: &[f64; 3]| square - sum * sum / count;
        columns.values().map(own).sum::<f64>()
    };
    let changes = [1, 0, 2].map(|k| (k, change(k)));
    let least = changes.iter().fold(f64::INFINITY, |m, c| m.min(c.1));
    let whole: f64 = points.temperature.iter().map(|t| (t - mean).powi(2)).sum();
    let long = |k: usize| {
        let along = || points.position.iter().map(|p| p[k]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    let steady = changes
        .iter()
        .filter(|c| LESS * c.1 <= least + NOISE * whole)
        .map(|c| c.0);
    let shortest = steady.reduce(|best, next| {
        if long(next) < 0.99 * long(best) {
            next
        } else {
            best
        }
    });
    shortest.unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat::shape::Body;
    use serde_json::json;

    /// A lattice cut out by a body, with a temperature.
    fn points(scene: &serde_json::Value, f: impl Fn([f64; 3]) -> f64) -> Points {
        let body = Body::of_scene(scene);
        let n = 12_i32;
        let line = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
        let mut position = Vec::new();
        for i in -n..n {
            for k in -n..n {
                for m in -n..n {
                    let p = [line(i), line(k), line(m)];
                    if body.holds(p) == Some(true) {
                        position.push(p);
                    }
                }
            }
        }
        Points {
            time: 0.0,
            temperature: position.iter().map(|p| f(*p)).collect(),
            volume: vec![f64::from(n).powi(-3); position.len()],
            material: Some(position.iter().map(|p| body.material(*p)).collect()),
            plane: false,
            position,
            body,
        }
    }

    fn sample(field: &Field, p: [f64; 2], material: usize) -> f64 {
        let grid = crate::draw::contour::Grid {
            first: &field.across,
            second: &field.up,
            values: field.values_of(material),
        };
        grid.sample(p[0], p[1]).unwrap()
    }

    #[test]
    fn what_is_round_is_shown_over_radius_and_height() {
        let disc =
            json!({"body": {"cylinder": {"centre_m": [0, 0, 0], "radius_m": 1, "length_m": 1}}});
        let f = |r: f64, z: f64| 300.0 + 20.0 * r * r + 10.0 * z;
        let hot = points(&disc, |p| f(p[0].hypot(p[1]), p[2]));
        let field = Field::of(&hot).unwrap();
        assert_eq!(field.cut, Cut::Half(2));
        for p in [[0.1, 0.2], [0.5, -0.4], [0.9, 0.4]] {
            let off = sample(&field, p, 0) - f(p[0], p[1]);
            assert!(off.abs() < 0.3, "{p:?}: {off}");
        }
        assert!((field.window[0][1] - 1.0).abs() < 0.01);
        // The same disc, heated from one side, is not the same all around: it is cut across z.
        let side = points(&disc, |p| 300.0 + 20.0 * p[0]);
        let field = Field::of(&side).unwrap();
        assert_eq!(field.cut, Cut::Middle(2));
        assert!((sample(&field, [-0.5, 0.1], 0) - 290.0).abs() < 0.01);
    }

    #[test]
    fn a_long_body_lies_down() {
        let rod =
            json!({"body": {"cylinder": {"centre_m": [0, 0, 0], "radius_m": 0.25, "length_m": 2}}});
        let hot = points(&rod, |p| 300.0 + 10.0 * p[2]);
        let field = Field::of(&hot).unwrap();
        assert_eq!((field.cut, field.lying), (Cut::Half(2), true));
        assert!((sample(&field, [0.5, 0.1], 0) - 305.0).abs() < 1e-3);
        assert!(field.holds(&hot, [0.9, 0.2]) && !field.holds(&hot, [0.2, 0.9]));
        assert!(!field.holds(&hot, [0.0, -0.1]));
    }

    #[test]
    fn a_plate_is_cut_where_it_shows_most() {
        let plate = json!({"body": {"box": {"min_m": [-1, -1, -0.3], "max_m": [1, 1, 0.3]}}});
        let hot = points(&plate, |p| 500.0 + 50.0 * p[0]);
        assert_eq!(Field::of(&hot).unwrap().cut, Cut::Middle(2));
    }

    #[test]
    fn a_box_is_cut_across_the_axis_of_least_change() {
        let bar = json!({"body": {"box": {"min_m": [-1, -1, -1], "max_m": [1, 1, 1]}}});
        for (axis, cut) in [(0, 1), (1, 0), (2, 1)] {
            let hot = points(&bar, |p| 500.0 + 50.0 * p[axis]);
            assert_eq!(Field::of(&hot).unwrap().cut, Cut::Middle(cut), "{axis}");
        }
    }

    #[test]
    fn a_jump_between_materials_stays_sharp() {
        let slabs = json!({"body": {"box": {"min_m": [-1, -1, -1], "max_m": [1, 1, 1]}},
            "contacts": [{"between": ["a", "b"], "resistance_m2_k_w": 1}],
            "materials": [{"region": {"box": {"min_m": [-2, -2, -2], "max_m": [0, 2, 2]}}}, {}]});
        let hot = points(&slabs, |p| {
            if p[0] < 0.0 {
                400.0
            } else {
                300.0 + 10.0 * p[0]
            }
        });
        let field = Field::of(&hot).unwrap();
        let at = |x: f64| {
            let material = field.material(&hot, [x, 0.3]);
            sample(&field, [x, 0.3], material)
        };
        assert!((at(-0.01) - 400.0).abs() < 1e-6 && (at(0.01) - 300.1).abs() < 1e-3);
    }
}
