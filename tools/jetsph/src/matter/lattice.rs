//! Places of particles in a body.

use shapes::frame::Frame;
use shapes::jitter::signed;
use shapes::{Body, Kind};

/// Most particles of a body.
const MOST: f64 = 1e7;
/// Cells of a box may differ by this part from the spacing that was asked for.
const FIT: f64 = 0.26;

/// How a body is filled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filling {
    /// Spacing asked for \[m\].
    pub spacing: f64,
    /// Angle of the lattice about z \[rad\]; a box that stands along its own lattice where it is 0.
    pub turned: f64,
    /// Places are shaken by up to this part of the spacing.
    pub jitter: f64,
    /// 2 or 3.
    pub dimensions: usize,
}

/// A body filled with cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    /// Axes of the lattice.
    pub frame: Frame,
    /// Size of a cell along them \[m\]; 1 across the plane.
    pub cell: [f64; 3],
    /// Corner where the cells begin, along them \[m\].
    pub low: [f64; 3],
    /// Whether the cells end where the body does.
    pub fits: bool,
    /// Places of the particles, the middles of cells \[m\].
    pub places: Vec<[f64; 3]>,
    /// Number of the cell of each along the axes.
    pub cells: Vec<[u32; 3]>,
}

impl Lattice {
    /// Fills a body: a box by cells that fit it exactly, any other body by the cells whose middles it holds.
    ///
    /// # Errors
    /// Says why it cannot be filled.
    pub fn fill(body: &Body, filling: &Filling) -> Result<Self, String> {
        let spacing = filling.spacing;
        let free = |k: usize| k < filling.dimensions;
        let boxed = boxed(body, filling);
        let (frame, half) = boxed.unwrap_or_else(|| around(body, filling));
        let count = |k: usize| (2.0 * half[k] / spacing).round().max(1.0);
        let counts = [0, 1, 2].map(|k| if free(k) { count(k) } else { 1.0 });
        let number: f64 = counts.iter().product();
        if number.is_nan() || number > MOST {
            return Err(format!(
                "{number:.1e} cells of {spacing} m; at most {MOST:.0e}"
            ));
        }
        let cell = [0, 1, 2].map(|k| {
            if free(k) {
                2.0 * half[k] / counts[k]
            } else {
                1.0
            }
        });
        let fits = |k: &usize| (cell[*k] / spacing - 1.0).abs() <= FIT;
        if let Some(k) = (0..filling.dimensions).find(|k| !fits(k)) {
            let (side, count, size) = (2.0 * half[k], counts[k], cell[k]);
            let what = format!(
                "{spacing} m does not fit a side of {side} m: {count} cells of {size} m would"
            );
            return Err(what);
        }
        let counts = counts.map(|n| n as usize);
        let mut lattice = Self {
            frame,
            cell,
            low: half.map(|half| -half),
            fits: boxed.is_some(),
            places: Vec::new(),
            cells: Vec::new(),
        };
        lattice.place(body, filling, counts, half, boxed.is_some());
        Ok(lattice)
    }

    fn place(
        &mut self,
        body: &Body,
        filling: &Filling,
        counts: [usize; 3],
        half: [f64; 3],
        boxed: bool,
    ) {
        for k in 0..counts[2] {
            for j in 0..counts[1] {
                for i in 0..counts[0] {
                    let at = [i, j, k];
                    let own = [0, 1, 2].map(|axis| {
                        if axis < filling.dimensions {
                            (at[axis] as f64 + 0.5) * self.cell[axis] - half[axis]
                        } else {
                            0.0
                        }
                    });
                    let place = self.frame.place(own);
                    if boxed || body.holds(place) {
                        let number = self.places.len();
                        let shaken = |axis: usize| {
                            let free = axis < filling.dimensions && filling.jitter > 0.0;
                            let part = if free {
                                signed(0, (3 * number + axis) as u64)
                            } else {
                                0.0
                            };
                            own[axis] + filling.jitter * self.cell[axis] * part
                        };
                        self.places.push(self.frame.place([0, 1, 2].map(shaken)));
                        self.cells.push(at.map(|i| i as u32));
                    }
                }
            }
        }
    }

    /// Middles of the cells, where no particle is shaken, along the axes of the lattice \[m\].
    #[must_use]
    pub fn middles(&self, dimensions: usize) -> Vec<[f64; 3]> {
        let middle = |at: &[u32; 3]| {
            [0, 1, 2].map(|k| {
                if k < dimensions {
                    (f64::from(at[k]) + 0.5) * self.cell[k] + self.low[k]
                } else {
                    0.0
                }
            })
        };
        self.cells.iter().map(middle).collect()
    }

    /// A place along the axes of the lattice \[m\].
    #[must_use]
    pub fn own(&self, place: [f64; 3]) -> [f64; 3] {
        self.frame.own(place)
    }
}

/// Axes and half sides of a body that is a box, where the lattice stands along it.
fn boxed(body: &Body, filling: &Filling) -> Option<(Frame, [f64; 3])> {
    let straight = filling.turned.abs() <= f64::EPSILON;
    let primitive = body.single().filter(|_| straight)?;
    match primitive.kind {
        Kind::Box(half) => Some((primitive.frame, half)),
        _ => None,
    }
}

/// Axes and half sides, whole numbers of cells, of a turned box that holds a body.
fn around(body: &Body, filling: &Filling) -> (Frame, [f64; 3]) {
    let [low, high] = body.bounds();
    let free = |k: usize| k < filling.dimensions;
    let mut half: [f64; 3] = std::array::from_fn(|k| 0.5 * (high[k] - low[k]));
    if filling.turned.abs() > f64::EPSILON {
        let round = half[0].hypot(half[1]);
        half = [round, round, half[2]];
    }
    let mut frame = Frame::turned(2, filling.turned, [0.0; 3]);
    frame.origin = std::array::from_fn(|k| {
        if free(k) {
            0.5 * (high[k] + low[k])
        } else {
            0.0
        }
    });
    (
        frame,
        half.map(|h| filling.spacing * (h / filling.spacing).ceil()),
    )
}

/// Places across a jet, two numbers each \[m\], each in the middle of its share of the section, and the section's area
/// \[m2\], in the plane its width \[m\]. As many as fit the spacing, at least one.
#[must_use]
pub fn cross_section(width: f64, spacing: f64, dimensions: usize) -> (Vec<[f64; 2]>, f64) {
    if dimensions == 2 {
        let count = (width / spacing).round().max(1.0);
        let pitch = width / count;
        let place = |i: usize| [(i as f64 + 0.5) * pitch - 0.5 * width, 0.0];
        return ((0..count as usize).map(place).collect(), width);
    }
    // A square lattice within the circle, stretched so that each place has its share of the area.
    let radius = 0.5 * width;
    let half = (radius / spacing).ceil() as i64 + 1;
    let mut places = Vec::new();
    for j in -half..half {
        for i in -half..half {
            let place = [(i as f64 + 0.5) * spacing, (j as f64 + 0.5) * spacing];
            if place[0].hypot(place[1]) < radius {
                places.push(place);
            }
        }
    }
    if places.is_empty() {
        places.push([0.0; 2]);
    }
    let area = std::f64::consts::PI * radius * radius;
    let stretch = (area / (places.len() as f64 * spacing * spacing)).sqrt();
    let stretched = places.iter().map(|place| place.map(|x| stretch * x));
    (stretched.collect(), area)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLANE: Filling = Filling {
        spacing: 0.25,
        turned: 0.0,
        jitter: 0.0,
        dimensions: 2,
    };

    fn body(text: &str) -> Body {
        Body::new(&serde_json::from_str(text).unwrap(), 2)
    }

    #[test]
    fn a_box_is_filled_to_its_faces() {
        let body = body(r#"{"box": {"min_m": [0, 0], "max_m": [1, 0.55]}}"#);
        let lattice = Lattice::fill(&body, &PLANE).unwrap();
        assert_eq!(lattice.places.len(), 4 * 2);
        assert!((lattice.cell[1] - 0.275).abs() < 1e-15);
        assert!((lattice.places[0][0] - 0.125).abs() < 1e-15);
        assert!((lattice.places[7][1] - 0.4125).abs() < 1e-15);
    }

    #[test]
    fn a_turned_box_takes_its_lattice_along() {
        let body = body(
            r#"{"turned": {"shape": {"box": {"min_m": [0, 0], "max_m": [1, 0.5]}}, "angle_deg": 30}}"#,
        );
        let lattice = Lattice::fill(&body, &PLANE).unwrap();
        assert_eq!(lattice.places.len(), 8);
        assert!(lattice.places.iter().all(|x| body.distance(*x) < -0.12));
    }

    #[test]
    fn a_turned_lattice_fills_a_disc_nearly() {
        let body = body(r#"{"disc": {"centre_m": [3, 1], "radius_m": 2}}"#);
        for turned in [0.0, 0.3] {
            let filling = Filling {
                spacing: 0.05,
                turned,
                ..PLANE
            };
            let lattice = Lattice::fill(&body, &filling).unwrap();
            let area = lattice.places.len() as f64 * 0.05 * 0.05;
            assert!((area / (4.0 * std::f64::consts::PI) - 1.0).abs() < 5e-3);
        }
    }

    #[test]
    fn what_no_cell_fits_is_told() {
        let body = body(r#"{"box": {"min_m": [0, 0], "max_m": [1, 0.1]}}"#);
        assert!(
            Lattice::fill(&body, &PLANE)
                .unwrap_err()
                .contains("does not fit")
        );
    }
}
