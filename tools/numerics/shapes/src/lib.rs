//! Shapes: boxes, cylinders, balls, ellipsoids, closed surfaces of triangles and what is composed of them.
//!
//! - [`shape`] is how a scene writes them, [`check`] what its types cannot tell;
//! - [`body`] knows how far a place is from the surface, with sign, and which way the surface looks;
//! - [`edges`] knows the same beside the edges of what is composed, where that is a bound only;
//! - [`ellipsoid`] finds the nearest place of an ellipsoid, [`mesh`] that of a closed surface of triangles;
//! - [`surface`] divides the surface into pieces with area and normal, [`rule`] knows places and weights of integrals
//!   over it;
//! - [`frame`] holds the little vector algebra that all of them need;
//! - [`jitter`] shakes places.

pub mod body;
pub mod check;
pub mod edges;
pub mod ellipsoid;
mod face;
pub mod frame;
pub mod jitter;
pub mod mesh;
pub mod rule;
pub mod shape;
pub mod surface;

pub use body::{Body, Kind, Primitive};
pub use ellipsoid::Ellipsoid;
pub use mesh::Mesh;
pub use shape::{Axis, Face, Shape};
