//! Flat faces of a box beside which the liquid goes on, as images of itself.
//!
//! Beyond a face stand images of what lies within a support of it, so that every sum over neighbours is that of a cloud
//! that has no end there:
//!
//! ```text
//! periodic   x' = x +- P e          u' = u                         T' = T
//! mirror     x' = x - 2 (x - f).e e  u' = u - 2 (u.e) e             T' = T            slip, insulated
//! lid        as a mirror, and it is the free surface
//! wall       as a mirror             u' = 2 U - u for viscosity     T' = 2 T_w - T    where T_w is held, else T
//! ```
//!
//! The wall, its velocity U and its temperature T_w are those of the plane itself: a linear profile between two planes is
//! exact. For the pressure a wall is a mirror, so that nothing flows through it. A moving wall moves along itself. Beside
//! an edge the images of images complete the corner; a box is at least a support wide, so that no image is
//! needed twice.
//!
//! A free surface with tension meets mirrors and walls at a contact angle theta, a right one unless the scene says otherwise. Its
//! places and normals, and these alone, have images that stand as the surface would go on beyond the face, evenly curved:
//!
//! ```text
//! x' = mirror of x + 2 s cot(theta) t      n' ~ mirror of n + 2 |n_t| cot(theta) e      s distance of x, t along the face and n
//! ```

mod images;
mod parameters;
mod planes;

pub use images::{Image, Images};
pub use parameters::{ContactAngle, Parameters, WallParameters};
pub use planes::{Faces, TiltedFace, Turn};

#[cfg(test)]
mod tests;
