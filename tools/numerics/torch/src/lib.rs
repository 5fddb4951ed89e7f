//! Heat sources of welding that move along a path.
//!
//! The words are the same in every tool. A [`Torch`] has a power, an efficiency, a [`path`], a [`shape`] and, where it pulses, a [`Waveform`]: Goldak's double
//! ellipsoid in the volume, or a Gaussian on the surface. It gives each point of a body a part of its heat:
//!
//! ```text
//! W_i = eta P q_i V_i / sum_j q_j V_j        (areas A_i on a surface)
//! ```
//!
//! so that the power is exact on every cloud of points, wherever the body ends. The sum below, with q normalised over the whole half
//! space, is the share of the distribution that lies inside the body; it is told. With `"beyond": "lost"` the rest is lost instead,
//! and where metal behind the torch makes the sum greater than 1 it is divided by it all the same.
//!
//! A point takes the mean of q over its cell, with the cell as a cloud of the variance of a cube, d^2/12 along every axis: it is the
//! same in every direction, and no source is too narrow to be met.

mod conduction;
mod erfc;
mod misfit;
pub mod path;
pub mod shape;
mod torch;
mod waveform;

pub use conduction::Plate;
pub use misfit::Misfit;
pub use path::{Path, Weave};
pub use shape::{DoubleEllipsoid, Gaussian, Shape};
pub use torch::{Beyond, Stand, Torch};
pub use waveform::Waveform;
