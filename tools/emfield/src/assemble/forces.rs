//! Forces and fields as a scene has them.

use num_complex::Complex;
use shapes::frame::Vector;

use crate::scene::Geometry;

/// A complex number.
type C = Complex<f64>;

/// The unit of a force of a scene.
pub(super) fn unit(geometry: Geometry) -> &'static str {
    match geometry {
        Geometry::Plane => "N/m",
        Geometry::Axisymmetric | Geometry::Space => "N",
    }
}

/// The components of a force that a scene has: nothing pulls along an endless bar, and those across an axis cancel.
pub(super) fn seen(geometry: Geometry, force: Vector) -> Vector {
    let [x, y, z] = force;
    match geometry {
        Geometry::Plane => [x, y, 0.0],
        Geometry::Axisymmetric => [0.0, 0.0, z],
        Geometry::Space => force,
    }
}

/// The root of the mean square of fields over areas.
pub(super) fn strength(fields: &[[C; 3]], areas: &[f64]) -> f64 {
    let square = |f: &[C; 3]| f.iter().map(C::norm_sqr).sum::<f64>();
    let sum: f64 = fields.iter().zip(areas).map(|(f, a)| a * square(f)).sum();
    (sum / areas.iter().sum::<f64>()).sqrt()
}
