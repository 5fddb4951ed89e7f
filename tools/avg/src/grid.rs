//! Sections of the moving frame, as grids of points.

/// How a section is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cut {
    /// The plane where coordinate `axis` (0 x, 1 y, 2 z) has the value `at` \[m\]; particles within
    /// `half_thickness` \[m\] of it count.
    Plane {
        /// Axis of the normal.
        axis: usize,
        /// Where the plane stands \[m\].
        at: f64,
        /// Half of the thickness \[m\].
        half_thickness: f64,
    },
    /// The topmost metal; particles within `layer` \[m\] below the top of their column count.
    Surface {
        /// Thickness of the layer \[m\].
        layer: f64,
    },
}

/// A section with its two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Name, which becomes the channel.
    pub name: String,
    /// How it is cut.
    pub cut: Cut,
    /// Which coordinates the axes are.
    pub axes: [usize; 2],
    /// Grid points of the first axis \[m\], `[n0]`.
    pub first: Vec<f64>,
    /// Grid points of the second axis \[m\], `[n1]`.
    pub second: Vec<f64>,
}

impl Section {
    /// A section whose axes run over `first` and `second` \[m\] with `spacing` \[m\]; grid points lie
    /// at whole multiples of the spacing.
    #[must_use]
    pub fn new(name: &str, cut: Cut, ranges: [[f64; 2]; 2], spacing: f64) -> Self {
        let axes = match cut {
            Cut::Plane { axis: 0, .. } => [1, 2],
            Cut::Plane { axis: 1, .. } => [0, 2],
            _ => [0, 1],
        };
        let [first, second] = ranges.map(|range| points(range, spacing));
        Self {
            name: name.to_owned(),
            cut,
            axes,
            first,
            second,
        }
    }

    /// Number of grid points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.first.len() * self.second.len()
    }

    /// True without grid points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Position of grid point `i` \[m\], row-major with the second axis fastest. On the surface the
    /// height is 0.
    #[must_use]
    pub fn point(&self, i: usize) -> [f64; 3] {
        let mut at = [0.0; 3];
        if let Cut::Plane {
            axis, at: place, ..
        } = self.cut
        {
            at[axis] = place;
        }
        at[self.axes[0]] = self.first[i / self.second.len()];
        at[self.axes[1]] = self.second[i % self.second.len()];
        at
    }
}

/// How many grid points a section over `ranges` \[m\] would have, before any is made.
#[must_use]
pub fn wanted(ranges: [[f64; 2]; 2], spacing: f64) -> f64 {
    let along = ranges.map(|range| (range[1] - range[0]) / spacing + 1.0);
    along[0] * along[1]
}

fn points(range: [f64; 2], spacing: f64) -> Vec<f64> {
    // A millionth of a spacing keeps an end that is meant to be on the grid.
    let first = (range[0] / spacing - 1e-6).ceil() as i64;
    let last = (range[1] / spacing + 1e-6).floor() as i64;
    (first..=last).map(|i| i as f64 * spacing).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grid_points_run_with_the_second_axis_fastest() {
        let cut = Cut::Plane {
            axis: 0,
            at: 0.1,
            half_thickness: 0.5,
        };
        let section = Section::new("x", cut, [[-1.0, 1.0], [0.0, 1.5]], 0.5);
        assert_eq!((section.first.len(), section.second.len()), (5, 4));
        assert!((wanted([[-1.0, 1.0], [0.0, 1.5]], 0.5) - 20.0).abs() < 1e-12);
        assert_eq!(section.point(0).to_vec(), [0.1, -1.0, 0.0]);
        assert_eq!(section.point(6).to_vec(), [0.1, -0.5, 1.0]);
    }

    #[test]
    fn an_end_on_the_grid_belongs_to_it() {
        assert_eq!(points([-0.0015, 0.001], 0.0005).len(), 6);
    }
}
