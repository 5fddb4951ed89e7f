//! Bodies that points do not resolve: what to say of each.

use shapes::Kind;

use super::layout::{Layout, Solid};

/// Width of a body over its spacing below which fields in it are told to be unresolved: with 3 they err by half.
const GRAIN: f64 = 4.0;
/// Radius of a bend over the spacing below which fields at it are told to be unresolved: a conducting needle's errs by 6 % with
/// 3, by 18 % with 2.
const BEND: f64 = 3.0;

impl Layout {
    /// Bodies with too few points across for the field in them: what to say of each.
    pub(crate) fn grains(&self) -> Vec<String> {
        let told = |solid: &Solid| {
            let widest = solid.widths(self.dimensions).fold(0.0, f64::max);
            (widest < GRAIN).then(|| {
                format!(
                    "unresolved: {} is {widest:.1} spacings of {} m wide; fields in it take at least {GRAIN}",
                    solid.name, solid.spacing
                )
            })
        };
        self.solids.iter().filter_map(told).collect()
    }

    /// The least number of spacings that a body is wide; of the domain where there is none.
    pub(crate) fn narrowest(&self) -> f64 {
        let widest = |solid: &Solid| solid.widths(self.dimensions).fold(0.0, f64::max);
        let bodies = self.solids.iter().map(widest);
        bodies.fold(f64::INFINITY, f64::min).min(self.across())
    }

    /// Ellipsoids whose ends bend more sharply than points along them can follow: what to say of each.
    pub(crate) fn bends(&self) -> Vec<String> {
        let told = |k: usize| {
            let primitive = self.solids[k].body.single()?;
            let Kind::Ellipsoid(ellipsoid) = primitive.kind else {
                return None;
            };
            let end = primitive.frame.place(ellipsoid.end());
            let radius = ellipsoid.sharpest();
            let spacing = self.beside(end, k);
            (radius < BEND * spacing).then(|| {
                format!(
                    "{} bends with a radius of {radius:.2e} m at its ends, {:.2} spacings: fields there take at least {BEND}; refine them",
                    self.solids[k].name,
                    radius / spacing
                )
            })
        };
        (0..self.solids.len()).filter_map(told).collect()
    }
}
