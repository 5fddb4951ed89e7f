//! Particles as shaded spheres, seen from far away, with a depth buffer.
//!
//! Each sphere hides what lies behind it pixel by pixel. Shading is Lambert's cosine law for one
//! lamp and, for the sense of depth, a darkening of pixels that lie behind their neighbours.
//! Colours say what the legend says; light only scales them.

use super::axes::Axes;
use super::canvas::Canvas;
use super::colour::{Rgb, shade};

/// A particle in the plane of the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Disc {
    /// Right, up, toward the viewer, in the unit of the axes.
    pub(crate) at: [f64; 3],
    /// Its colour.
    pub(crate) colour: Rgb,
}

/// Pixels per pixel, in each direction.
const FINE: usize = 2;
/// Direction to the lamp: from the upper left, before the picture.
const LAMP: [f64; 3] = [-0.36, 0.48, 0.80];

/// What is seen in a fine pixel: depth, light, disc.
#[derive(Debug, Clone, Copy)]
struct Seen {
    depth: f64,
    light: f64,
    disc: usize,
}

/// Draws spheres of `radius` (unit of the axes) into the window of `axes`.
pub(crate) fn draw(canvas: &mut Canvas, axes: &Axes, discs: &[Disc], radius: f64) {
    let width = axes.area.w.round() as usize * FINE;
    let height = axes.area.h.round() as usize * FINE;
    let scale = width as f64 / (axes.x[1] - axes.x[0]);
    let nothing = Seen {
        depth: f64::NEG_INFINITY,
        light: 0.0,
        disc: usize::MAX,
    };
    let mut seen = vec![nothing; width * height];
    for (index, disc) in discs.iter().enumerate() {
        let u = (disc.at[0] - axes.x[0]) * scale;
        let v = (axes.y[1] - disc.at[1]) * scale;
        let ball = Ball {
            u,
            v,
            depth: disc.at[2] * scale,
            radius: radius * scale,
            disc: index,
        };
        ball.stamp(&mut seen, width, height);
    }
    let reach = (0.12 * radius * scale).round().max(1.0) as i64;
    let origin = [axes.area.x.round() as i64, axes.area.y.round() as i64];
    for row in 0..height / FINE {
        for column in 0..width / FINE {
            let mut sum = [0.0_f32; 3];
            let mut hits = 0.0_f32;
            for part in 0..FINE * FINE {
                let (x, y) = (column * FINE + part % FINE, row * FINE + part / FINE);
                let here = seen[y * width + x];
                if here.disc == usize::MAX {
                    continue;
                }
                let dark = behind(&seen, (width, height), (x, y), (reach, radius * scale));
                let lit = shade(
                    discs[here.disc].colour,
                    (here.light * (-1.1 * dark).exp()) as f32,
                );
                sum = [sum[0] + lit[0], sum[1] + lit[1], sum[2] + lit[2]];
                hits += 1.0;
            }
            if hits > 0.0 {
                let (x, y) = (origin[0] + column as i64, origin[1] + row as i64);
                let cover = hits / (FINE * FINE) as f32;
                canvas.blend(x, y, sum.map(|part| part / hits), cover);
            }
        }
    }
}

struct Ball {
    u: f64,
    v: f64,
    depth: f64,
    radius: f64,
    disc: usize,
}

impl Ball {
    fn stamp(&self, seen: &mut [Seen], width: usize, height: usize) {
        let columns = bounds(self.u, self.radius, width);
        for row in bounds(self.v, self.radius, height) {
            for column in columns.clone() {
                let (du, dv) = (column as f64 + 0.5 - self.u, row as f64 + 0.5 - self.v);
                let rest = self.radius * self.radius - du * du - dv * dv;
                if rest <= 0.0 {
                    continue;
                }
                let rise = rest.sqrt();
                let place = &mut seen[row * width + column];
                if self.depth + rise > place.depth {
                    let cosine = (du * LAMP[0] - dv * LAMP[1] + rise * LAMP[2]) / self.radius;
                    *place = Seen {
                        depth: self.depth + rise,
                        light: 0.62 + 0.48 * cosine.max(0.0),
                        disc: self.disc,
                    };
                }
            }
        }
    }
}

fn bounds(middle: f64, radius: f64, size: usize) -> std::ops::Range<usize> {
    let low = (middle - radius).floor().max(0.0) as usize;
    let high = (middle + radius).ceil().clamp(0.0, size as f64) as usize;
    low.min(high)..high
}

/// How far a pixel lies behind its eight neighbours at distance `reach`, in radii, at most 1 each,
/// averaged.
fn behind(seen: &[Seen], size: (usize, usize), at: (usize, usize), depth: (i64, f64)) -> f64 {
    let here = seen[at.1 * size.0 + at.0].depth;
    let reach = 4 * depth.0;
    let mut sum = 0.0;
    for (dx, dy) in [
        (-1, -1),
        (0, -1),
        (1, -1),
        (-1, 0),
        (1, 0),
        (-1, 1),
        (0, 1),
        (1, 1),
    ] {
        let (x, y) = (at.0 as i64 + dx * reach, at.1 as i64 + dy * reach);
        if x < 0 || y < 0 || x >= size.0 as i64 || y >= size.1 as i64 {
            continue;
        }
        let there = seen[y as usize * size.0 + x as usize].depth;
        sum += ((there - here) / depth.1).clamp(0.0, 1.0);
    }
    sum / 8.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::colour::WHITE;

    #[test]
    fn the_nearer_particle_hides_the_farther_one() {
        let red = [1.0, 0.0, 0.0];
        let blue = [0.0, 0.0, 1.0];
        let axes = Axes::equal([0.0, 0.0], 20.0, [-1.0, 1.0], [-1.0, 1.0]);
        for (near, far, expected) in [(1.0, 0.0, red), (0.0, 1.0, blue)] {
            let mut canvas = Canvas::new(40, 40);
            let discs = [
                Disc {
                    at: [0.0, 0.0, near],
                    colour: red,
                },
                Disc {
                    at: [0.0, 0.0, far],
                    colour: blue,
                },
            ];
            draw(&mut canvas, &axes, &discs, 0.5);
            let middle = canvas.get(20, 20).unwrap();
            assert!((middle[0] > 0.5) == (expected[0] > 0.5), "{middle:?}");
            assert_eq!(canvas.get(1, 1), Some(WHITE));
        }
    }

    #[test]
    fn a_particle_outside_the_window_harms_nothing() {
        let axes = Axes::equal([0.0, 0.0], 20.0, [-1.0, 1.0], [-1.0, 1.0]);
        let mut canvas = Canvas::new(40, 40);
        draw(
            &mut canvas,
            &axes,
            &[Disc {
                at: [-9.0, 7.0, 0.0],
                colour: WHITE,
            }],
            0.5,
        );
        assert_eq!(canvas.get(20, 20), Some(WHITE));
    }
}
