//! The arc in its plane of symmetry, and the Lorentz force that it sets up in the base metal.

use artefact::Table;

use super::{WIDTH, quantile, scale_bar};
use crate::draw::axes::{Axes, Scale};
use crate::draw::canvas::{Canvas, Rect};
use crate::draw::colour::{Map, PLATE, Rgb, WHITE, hex};
use crate::draw::contour::Grid;

const WIRE: Rgb = hex(0xb0_8d5b);
/// Any other body, such as flux.
const BED: Rgb = hex(0xd9_d2c3);
/// Isotherms \[K\].
const ISOTHERMS: [f64; 5] = [5_000.0, 10_000.0, 15_000.0, 20_000.0, 25_000.0];
/// Gas hotter than this is worth seeing \[K\].
const HOT: f64 = 4_000.0;

/// Temperature, flow and current on the (radius, height) grid of an arc.
#[derive(Debug, Clone)]
pub(crate) struct Plasma {
    radius: Vec<f64>,
    height: Vec<f64>,
    temperature: Option<Vec<f64>>,
    flow: Option<[Vec<f64>; 2]>,
    material: Vec<f64>,
}

impl Plasma {
    /// Reads `/plasma`; `None` when it has neither temperature nor flow.
    ///
    /// # Errors
    /// When an axis is absent.
    pub(crate) fn read(table: &Table) -> artefact::Result<Option<Self>> {
        let mm = |values: &[f64]| values.iter().map(|v| 1e3 * v).collect();
        let column = |name: &str| table.values(name).ok().map(<[f64]>::to_vec);
        let flow = column("radial_velocity_m_s").zip(column("axial_velocity_m_s"));
        let plasma = Self {
            radius: mm(table.axis("radius_m")?),
            height: mm(table.axis("height_m")?),
            temperature: column("temperature_k"),
            flow: flow.map(|(u, v)| [u, v]),
            material: column("material").unwrap_or_else(|| vec![0.0; table.len()]),
        };
        let something = plasma.temperature.is_some() || plasma.flow.is_some();
        Ok(something.then_some(plasma))
    }

    fn gas(&self, n: usize) -> bool {
        self.material[n].abs() < 0.5
    }

    /// Highest temperature of the gas \[K\].
    pub(crate) fn hottest(&self) -> Option<f64> {
        let temperature = self.temperature.as_ref()?;
        let gas = temperature.iter().enumerate().filter(|(n, _)| self.gas(*n));
        gas.map(|(_, t)| *t).reduce(f64::max)
    }

    /// Highest speed of the gas \[m/s\].
    pub(crate) fn fastest(&self) -> Option<f64> {
        let [u, v] = self.flow.as_ref()?;
        (0..u.len())
            .filter(|n| self.gas(*n))
            .map(|n| u[n].hypot(v[n]))
            .reduce(f64::max)
    }

    /// Radius and height up to which there is hot gas \[mm\], with room; all without temperature.
    fn reach(&self) -> [f64; 2] {
        let rows = self.height.len();
        let last = |axis: &[f64]| axis.last().copied().unwrap_or(1.0);
        let all = [last(&self.radius), last(&self.height)];
        let Some(temperature) = &self.temperature else {
            return all;
        };
        let hot = (0..temperature.len()).filter(|n| self.gas(*n) && temperature[*n] > HOT);
        let ends = hot.fold([0.0_f64; 2], |[wide, high], n| {
            let at = [self.radius[n / rows], self.height[n % rows]];
            [wide.max(at[0]), high.max(at[1])]
        });
        let room = |k: usize, factor: f64| {
            if ends[k] > 0.0 {
                (factor * ends[k]).min(all[k])
            } else {
                all[k]
            }
        };
        [room(0, 1.1), room(1, 1.6)]
    }

    fn grid<'a>(&'a self, values: &'a [f64]) -> Grid<'a> {
        Grid {
            first: &self.radius,
            second: &self.height,
            values,
        }
    }

    /// A point of the picture as radius and height inside the grid.
    fn place(&self, p: [f64; 2]) -> [f64; 2] {
        let clip = |v: f64, axis: &[f64]| match (axis.first(), axis.last()) {
            (Some(a), Some(b)) => v.clamp(*a, *b),
            _ => v,
        };
        [clip(p[0].abs(), &self.radius), clip(p[1], &self.height)]
    }

    fn nearest(&self, [r, z]: [f64; 2]) -> usize {
        let near = |axis: &[f64], v: f64| {
            let after = axis.partition_point(|a| *a < v).min(axis.len() - 1);
            let before = after.saturating_sub(1);
            if (v - axis[before]).abs() < (axis[after] - v).abs() {
                before
            } else {
                after
            }
        };
        near(&self.radius, r) * self.height.len() + near(&self.height, z)
    }

    /// The arc, mirrored at its axis: temperature on the right, speed on the left.
    pub(crate) fn picture(&self) -> Option<Canvas> {
        let [reach, high] = self.reach();
        let low = *self.height.first()?;
        let low = low.max(-0.12 * high);
        let scale = ((WIDTH as f64 - 560.0) / (2.0 * reach)).min(980.0 / (high - low));
        let left = 0.5 * (WIDTH as f64 - 2.0 * reach * scale);
        let axes = Axes::equal([left, 60.0], scale, [-reach, reach], [low, high]);
        let height = axes.area.h + 60.0 + 130.0;
        let mut canvas = Canvas::new(WIDTH, height as usize);
        let hot = self.hottest().map(|t| Scale {
            map: Map::Inferno,
            range: [300.0, (t / 1000.0).ceil() * 1000.0],
            title: "gas temperature [K]".to_owned(),
        });
        let fast = self.fastest().map(|u| Scale {
            map: Map::Viridis,
            range: [0.0, u.max(1e-9)],
            title: "gas speed [m/s]".to_owned(),
        });
        self.paint(&mut canvas, &axes, (hot.as_ref(), fast.as_ref()));
        if hot.is_some() {
            self.isotherms(&mut canvas, &axes);
        }
        self.streams(&mut canvas, &axes);
        axes.draw(
            &mut canvas,
            "radius r [mm]",
            "height above the base metal z [mm]",
        );
        let bar = |x: f64| Rect {
            x,
            y: axes.area.y,
            w: 26.0,
            h: axes.area.h.max(200.0),
        };
        if let Some(scale) = &hot {
            scale.bar(&mut canvas, bar(axes.area.x + axes.area.w + 30.0));
        }
        if let Some(scale) = &fast {
            scale.bar(&mut canvas, bar((axes.area.x - 300.0).max(14.0)));
        }
        scale_bar(&mut canvas, [axes.area.x, height - 30.0], scale);
        Some(canvas)
    }

    fn paint(&self, canvas: &mut Canvas, axes: &Axes, scales: (Option<&Scale>, Option<&Scale>)) {
        let speed: Option<Vec<f64>> = self
            .flow
            .as_ref()
            .map(|[u, v]| u.iter().zip(v).map(|(a, b)| a.hypot(*b)).collect());
        axes.paint(canvas, |p| {
            let [r, z] = self.place(p);
            let material = self.material[self.nearest([r, z])];
            if material > 0.5 {
                return Some(match material {
                    m if m < 1.5 => WIRE,
                    m if m < 2.5 => PLATE,
                    _ => BED,
                });
            }
            let right = p[0] >= 0.0;
            let both = (
                self.temperature.as_ref().zip(scales.0),
                speed.as_ref().zip(scales.1),
            );
            let (values, scale) = match both {
                (Some(t), _) if right => t,
                (_, Some(u)) if !right => u,
                (Some(one), None) | (None, Some(one)) => one,
                _ => return None,
            };
            Some(scale.colour(self.grid(values).sample(r, z)?))
        });
    }

    fn isotherms(&self, canvas: &mut Canvas, axes: &Axes) {
        let Some(temperature) = &self.temperature else {
            return;
        };
        let grid = self.grid(temperature);
        for level in ISOTHERMS {
            let mut lines = grid.contour(level);
            lines.retain(|[a, b]| self.gas(self.nearest(*a)) && self.gas(self.nearest(*b)));
            axes.segments(canvas, &lines, (WHITE, 2.0));
        }
    }

    /// Arrows along the flow on an even lattice; length as the root of the speed.
    fn streams(&self, canvas: &mut Canvas, axes: &Axes) {
        let (Some([u, v]), Some(fastest)) = (&self.flow, self.fastest()) else {
            return;
        };
        let pitch = (axes.x[1] - axes.x[0]) / 30.0;
        let pixels = axes.area.w / (axes.x[1] - axes.x[0]);
        let count = |range: [f64; 2]| ((range[1] - range[0]) / pitch) as usize;
        for i in 0..count(axes.x) {
            for k in 0..count(axes.y) {
                let p = [
                    axes.x[0] + (i as f64 + 0.5) * pitch,
                    axes.y[0] + (k as f64 + 0.5) * pitch,
                ];
                let [r, z] = self.place(p);
                if p[0] > 0.0 || !self.gas(self.nearest([r, z])) {
                    continue;
                }
                let (Some(a), Some(b)) = (self.grid(u).sample(r, z), self.grid(v).sample(r, z))
                else {
                    continue;
                };
                let speed = a.hypot(b);
                let length = 0.9 * pitch * pixels * (speed / fastest).sqrt();
                if length < 6.0 {
                    continue;
                }
                let half = [-0.5 * length * a / speed, -0.5 * length * b / speed];
                let at = axes.pixel(p);
                let (tail, tip) = (
                    [at[0] - half[0], at[1] - half[1]],
                    [at[0] + half[0], at[1] + half[1]],
                );
                canvas.arrow(tail, tip, WHITE, 3.0);
            }
        }
    }
}

/// The Lorentz force in the base metal, arrows over its magnitude; nothing if it is nowhere.
pub(crate) fn lorentz(table: &Table) -> artefact::Result<Option<Canvas>> {
    let radial = table.values("lorentz_radial_n_m3")?;
    let axial = table.values("lorentz_axial_n_m3")?;
    let radius: Vec<f64> = table.axis("radius_m")?.iter().map(|v| 1e3 * v).collect();
    let height: Vec<f64> = table.axis("depth_m")?.iter().map(|v| 1e3 * v).collect();
    let size: Vec<f64> = radial.iter().zip(axial).map(|(a, b)| a.hypot(*b)).collect();
    let most = quantile(size.iter().copied(), 0.995).unwrap_or(0.0);
    let (Some(wide), Some(deep)) = (radius.last(), height.last()) else {
        return Ok(None);
    };
    if most <= 0.0 {
        return Ok(None);
    }
    let (wide, deep) = (wide.min(10.0), deep.min(9.0));
    let scale = 1300.0 / wide;
    let axes = Axes::equal([150.0, 40.0], scale, [0.0, wide], [-deep, 0.0]);
    let total = axes.area.h + 40.0 + 130.0;
    let mut canvas = Canvas::new(WIDTH, total as usize);
    let grid = |values| Grid {
        first: &radius,
        second: &height,
        values,
    };
    let inside = |p: [f64; 2]| [p[0].max(radius[0]), (-p[1]).max(height[0])];
    let colours = Scale {
        map: Map::Viridis,
        range: [0.0, most],
        title: "Lorentz force [N/m3]".to_owned(),
    };
    axes.paint(&mut canvas, |p| {
        let [r, d] = inside(p);
        Some(colours.colour(grid(&size).sample(r, d)?))
    });
    let force = |p: [f64; 2]| {
        let [r, d] = inside(p);
        let parts = [grid(radial).sample(r, d)?, grid(axial).sample(r, d)?];
        Some(parts.map(|part| part / most))
    };
    canvas.within(axes.area, |canvas| arrows(canvas, &axes, force));
    axes.draw(&mut canvas, "radius r [mm]", "height z [mm]");
    let bar = Rect {
        x: axes.area.x + axes.area.w + 28.0,
        y: axes.area.y,
        w: 26.0,
        h: axes.area.h,
    };
    colours.bar(&mut canvas, bar);
    scale_bar(&mut canvas, [150.0, total - 30.0], scale);
    Ok(Some(canvas))
}

/// Arrows on an even lattice; a vector of length 1 fills its place, lengths go as the root.
fn arrows(canvas: &mut Canvas, axes: &Axes, vector: impl Fn([f64; 2]) -> Option<[f64; 2]>) {
    let pitch = (axes.x[1] - axes.x[0]) / 24.0;
    let pixels = 0.9 * pitch * axes.area.w / (axes.x[1] - axes.x[0]);
    let rows = ((axes.y[1] - axes.y[0]) / pitch) as usize;
    for place in 0..24 * rows {
        let (i, k) = (place / rows, place % rows);
        let p = [
            axes.x[0] + (i as f64 + 0.5) * pitch,
            axes.y[1] - (k as f64 + 0.5) * pitch,
        ];
        let Some([a, b]) = vector(p) else { continue };
        let size = a.hypot(b);
        let length = pixels * size.min(1.0).sqrt();
        if length > 5.0 {
            let half = [0.5 * length * a / size, -0.5 * length * b / size];
            let at = axes.pixel(p);
            let (tail, tip) = (
                [at[0] - half[0], at[1] - half[1]],
                [at[0] + half[0], at[1] + half[1]],
            );
            canvas.arrow(tail, tip, WHITE, 3.0);
        }
    }
}
