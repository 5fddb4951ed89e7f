//! A picture in memory: rectangles, lines, arrows, and its PNG.

use super::colour::{Rgb, WHITE, mix};
use super::palette;

/// A picture; row 0 is the top.
#[derive(Debug, Clone)]
pub(crate) struct Canvas {
    /// Width \[px\].
    pub(crate) width: usize,
    /// Height \[px\].
    pub(crate) height: usize,
    pixels: Vec<Rgb>,
    /// Columns and rows that can be drawn on: first, and one past the last.
    open: [[usize; 2]; 2],
}

/// A rectangle of pixels: left, top, width, height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rect {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) w: f64,
    pub(crate) h: f64,
}

impl Canvas {
    /// A white picture.
    pub(crate) fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![WHITE; width * height],
            open: [[0, width], [0, height]],
        }
    }

    /// A picture of the given width and height from its pixels by rows, three bytes each; what is missing is white.
    pub(crate) fn of_rgb([width, height]: [usize; 2], rgb: &[u8]) -> Self {
        let mut canvas = Self::new(width, height);
        for (pixel, bytes) in canvas.pixels.iter_mut().zip(rgb.chunks_exact(3)) {
            *pixel = [0, 1, 2].map(|k| f32::from(bytes[k]) / 255.0);
        }
        canvas
    }

    /// Draws with nothing going beyond `rect`.
    pub(crate) fn within(&mut self, rect: Rect, draw: impl FnOnce(&mut Self)) {
        let before = self.open;
        let part = |from: f64, length: f64, [low, high]: [usize; 2]| {
            let at = |v: f64| (v.round().max(0.0) as usize).clamp(low, high);
            [at(from), at(from + length)]
        };
        self.open = [
            part(rect.x, rect.w, before[0]),
            part(rect.y, rect.h, before[1]),
        ];
        draw(self);
        self.open = before;
    }

    /// Colour at column `x`, row `y`, if that is inside.
    #[cfg(test)]
    pub(crate) fn get(&self, x: i64, y: i64) -> Option<Rgb> {
        self.index(x, y).map(|i| self.pixels[i])
    }

    fn index(&self, x: i64, y: i64) -> Option<usize> {
        let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        let open = |at: usize, [from, end]: [usize; 2]| at >= from && at < end;
        (open(x, self.open[0]) && open(y, self.open[1])).then(|| y * self.width + x)
    }

    /// Lays `colour` over a pixel with the given cover (0..1).
    pub(crate) fn blend(&mut self, x: i64, y: i64, colour: Rgb, cover: f32) {
        if let Some(i) = self.index(x, y) {
            self.pixels[i] = mix(self.pixels[i], colour, cover.clamp(0.0, 1.0));
        }
    }

    /// Fills a rectangle, to whole pixels.
    pub(crate) fn fill(&mut self, rect: Rect, colour: Rgb) {
        let (x0, y0) = (rect.x.round() as i64, rect.y.round() as i64);
        let (x1, y1) = (
            (rect.x + rect.w).round() as i64,
            (rect.y + rect.h).round() as i64,
        );
        for y in y0..y1 {
            for x in x0..x1 {
                self.blend(x, y, colour, 1.0);
            }
        }
    }

    /// Draws the border of a rectangle.
    pub(crate) fn border(&mut self, rect: Rect, colour: Rgb, width: f64) {
        let (x1, y1) = (rect.x + rect.w, rect.y + rect.h);
        let corners = [
            [rect.x, rect.y],
            [x1, rect.y],
            [x1, y1],
            [rect.x, y1],
            [rect.x, rect.y],
        ];
        for pair in corners.windows(2) {
            self.line(pair[0], pair[1], colour, width);
        }
    }

    /// Draws a line of `width` pixels with round ends and soft edges.
    pub(crate) fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb, width: f64) {
        if !(from.iter().chain(&to).all(|v| v.is_finite())) {
            return;
        }
        let reach = width / 2.0 + 1.0;
        let (x0, x1) = span(from[0], to[0], reach, self.width);
        let (y0, y1) = span(from[1], to[1], reach, self.height);
        for y in y0..y1 {
            for x in x0..x1 {
                let at = [x as f64 + 0.5, y as f64 + 0.5];
                let cover = width / 2.0 + 0.5 - distance_to_segment(at, from, to);
                if cover > 0.0 {
                    self.blend(x, y, colour, cover.min(1.0) as f32);
                }
            }
        }
    }

    /// Draws a dashed line.
    pub(crate) fn dashes(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb, width: f64) {
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let pieces = (length / (8.0 * width.max(1.0))).ceil().max(1.0) as usize;
        let at = |t: f64| {
            [
                from[0] + (to[0] - from[0]) * t,
                from[1] + (to[1] - from[1]) * t,
            ]
        };
        for piece in 0..pieces {
            let start = piece as f64 / pieces as f64;
            self.line(at(start), at(start + 0.55 / pieces as f64), colour, width);
        }
    }

    /// Fills a triangle with soft edges.
    pub(crate) fn triangle(&mut self, corners: [[f64; 2]; 3], colour: Rgb) {
        if !corners.iter().flatten().all(|v| v.is_finite()) {
            return;
        }
        let xs = corners.map(|c| c[0]);
        let ys = corners.map(|c| c[1]);
        let (x0, x1) = span(least(&xs), most(&xs), 1.0, self.width);
        let (y0, y1) = span(least(&ys), most(&ys), 1.0, self.height);
        let turn = side(corners[2], corners[0], corners[1]).signum();
        for y in y0..y1 {
            for x in x0..x1 {
                let at = [x as f64 + 0.5, y as f64 + 0.5];
                let inside = (0..3)
                    .map(|k| turn * side(at, corners[k], corners[(k + 1) % 3]))
                    .fold(f64::INFINITY, f64::min);
                if inside > -0.5 {
                    self.blend(x, y, colour, (inside + 0.5).min(1.0) as f32);
                }
            }
        }
    }

    /// Draws an arrow whose tail is at `from` and whose tip is at `to`.
    pub(crate) fn arrow(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb, width: f64) {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy);
        if !length.is_finite() || length < 1.0 {
            return;
        }
        let head = (4.0 * width).min(0.6 * length);
        let (ux, uy) = (dx / length, dy / length);
        let neck = [to[0] - ux * head, to[1] - uy * head];
        self.line(from, neck, colour, width);
        let half = 0.42 * head;
        let left = [neck[0] - uy * half, neck[1] + ux * half];
        let right = [neck[0] + uy * half, neck[1] - ux * half];
        self.triangle([to, left, right], colour);
    }

    /// The picture at about the width wanted or below: blocks of whole pixels become their mean. As it is where it is no wider.
    pub(crate) fn smaller(&self, wanted: usize) -> Self {
        let block = self.width.div_ceil(wanted.max(1)).max(1);
        let mut small = Self::new(self.width / block, self.height / block);
        let share = 1.0 / (block * block) as f32;
        for y in 0..small.height {
            for x in 0..small.width {
                let mut mean = [0.0_f32; 3];
                for row in y * block..(y + 1) * block {
                    let from = row * self.width + x * block;
                    for pixel in &self.pixels[from..from + block] {
                        (0..3).for_each(|k| mean[k] += share * pixel[k]);
                    }
                }
                small.pixels[y * small.width + x] = mean;
            }
        }
        small
    }

    /// The pixels by rows, three bytes each.
    pub(crate) fn rgb(&self) -> Vec<u8> {
        let byte = |part: &f32| (255.0 * part.clamp(0.0, 1.0)).round() as u8;
        self.pixels.iter().flatten().map(byte).collect()
    }

    /// The picture as a PNG file of at most so many colours, and of 256.
    pub(crate) fn png(&self, colours: usize) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        let indexed = palette::index(&self.pixels, colours);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(indexed.colours.concat());
        encoder.set_compression(png::Compression::High);
        encoder.set_filter(png::Filter::NoFilter);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&indexed.pixels)?;
        writer.finish()?;
        Ok(bytes)
    }
}

fn span(a: f64, b: f64, reach: f64, size: usize) -> (i64, i64) {
    let low = (a.min(b) - reach).floor().max(0.0) as i64;
    let high = (a.max(b) + reach).ceil().min(size as f64) as i64;
    (low, high)
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn most(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// Signed distance of `at` from the line through `a` and `b`.
fn side(at: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (ex, ey) = (b[0] - a[0], b[1] - a[1]);
    let length = ex.hypot(ey).max(1e-9);
    (ex * (at[1] - a[1]) - ey * (at[0] - a[0])) / length
}

fn distance_to_segment(at: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (ex, ey) = (b[0] - a[0], b[1] - a[1]);
    let (px, py) = (at[0] - a[0], at[1] - a[1]);
    let square = ex * ex + ey * ey;
    let t = if square > 0.0 {
        ((px * ex + py * ey) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (px - t * ex).hypot(py - t * ey)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::colour::INK;

    #[test]
    fn a_line_covers_its_pixels_and_no_others() {
        let mut canvas = Canvas::new(20, 9);
        canvas.line([2.0, 4.5], [18.0, 4.5], INK, 1.0);
        assert_eq!(canvas.get(10, 4), Some(INK));
        assert_eq!(canvas.get(10, 2), Some(WHITE));
        assert_eq!(canvas.get(-1, 4), None);
    }

    #[test]
    fn what_is_drawn_within_a_rectangle_ends_there() {
        let rect = Rect {
            x: 10.0,
            y: 5.0,
            w: 12.0,
            h: 10.0,
        };
        let mut canvas = Canvas::new(40, 20);
        canvas.within(rect, |canvas| {
            canvas.arrow([-30.0, 10.0], [60.0, 10.0], INK, 3.0);
            canvas.line([15.0, -9.0], [15.0, 40.0], INK, 3.0);
            canvas.triangle([[0.0, 0.0], [40.0, 0.0], [20.0, 20.0]], INK);
        });
        let dark = |x, y| canvas.get(x, y) != Some(WHITE);
        let reached = (0..40).flat_map(|x| (0..20).map(move |y| (x, y)));
        let outside = |(x, y): &(i64, i64)| !(10..22).contains(x) || !(5..15).contains(y);
        assert!(dark(10, 10) && dark(21, 10) && dark(15, 5) && dark(15, 14));
        assert_eq!(reached.filter(outside).find(|(x, y)| dark(*x, *y)), None);
        canvas.line([0.0, 1.5], [39.0, 1.5], INK, 1.0);
        assert!(canvas.get(30, 1) != Some(WHITE), "all is open again");
    }

    #[test]
    fn a_smaller_picture_is_the_mean_of_its_blocks() {
        let mut canvas = Canvas::new(5, 4);
        canvas.blend(0, 0, [0.0; 3], 1.0);
        let small = canvas.smaller(3);
        assert_eq!((small.width, small.height), (2, 2));
        assert_eq!(small.get(0, 0), Some([0.75; 3]));
        assert_eq!(small.get(1, 1), Some(WHITE));
        assert_eq!(canvas.smaller(5).width, 5);
    }

    #[test]
    fn a_triangle_is_filled_whichever_way_it_turns() {
        for corners in [
            [[1.0, 1.0], [19.0, 1.0], [10.0, 19.0]],
            [[1.0, 1.0], [10.0, 19.0], [19.0, 1.0]],
        ] {
            let mut canvas = Canvas::new(20, 20);
            canvas.triangle(corners, INK);
            assert_eq!(canvas.get(10, 5), Some(INK));
            assert_eq!(canvas.get(1, 18), Some(WHITE));
        }
    }

    #[test]
    fn a_png_comes_back_as_it_was() {
        let mut canvas = Canvas::new(3, 2);
        canvas.blend(1, 0, [1.0, 0.0, 0.0], 1.0);
        let bytes = canvas.png(palette::MOST).unwrap();
        let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut data).unwrap();
        assert_eq!(&data[..9], &[255, 255, 255, 255, 0, 0, 255, 255, 255]);
    }
}
