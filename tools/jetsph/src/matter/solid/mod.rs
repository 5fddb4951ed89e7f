//! An elastic solid by total Lagrangian particles.
//!
//! The deformation is a function of the places at rest; its derivatives are those of quadratics ([`quadratic`]) that are
//! fitted (`fit`) to the neighbours at rest ([`links`], seen from both `sides`, with weights that particles share in
//! `stencils`). `forces` has the loops over them, and `shown` tells the water what moves
//! and `giving` how easily. The energy is that of cells whose
//! strain varies across them ([`cell`]), and forces are the slopes of that energy, so that they keep momentum, angular
//! momentum and energy, and a solid at rest stays so. Faces are the true ones: rows of particles stand half a cell inside
//! them, free faces need nothing, held and loaded ones are [`bound`] where they are. Where a scene has it break,
//! [`fracture`] says when, over what length `nonlocal`, [`cracks`] what is left, [`breaking`] does it.
//! [`updated`] is the form of Shinohara et al. (2004), for comparison.

pub mod body;
pub mod bound;
mod break_up;
pub mod breaking;
pub mod cell;
pub mod cracks;
pub mod elastic;
mod fit;
mod flowing;
mod forces;
pub mod fracture;
mod giving;
pub mod law;
pub mod links;
mod nonlocal;
mod outside;
pub mod plastic;
pub mod quadratic;
pub mod release;
mod relief;
pub mod shocks;
mod shown;
mod sides;
mod sound;
mod stencils;
mod stiffness;
pub mod tensor;
pub mod trial;
pub mod updated;
mod yielding;

pub use body::Body;
pub use elastic::Elastic;
