//! Water: weakly compressible, or without sound ([`divergence_free`]).
//!
//! ```text
//! d(rho_i)/dt = rho_i sum_j V_j (u_i - u_j) . grad W_ij                                        (22), by volumes
//! du_i/dt     = -1/m_i sum_j V_i V_j (p_i + p_j + q_ij) grad W_ij                              (26)
//! p           = B ((rho/rho0)^n - 1),   B = c^2 rho0/n                                         (15), (17)
//! ```
//!
//! (Shinohara, Okabe and Nakayama 2004; V = m/rho, q the friction of [`friction`].) The printed sums count masses, which
//! is wrong where particles of different mass meet; volumes are right there, and the pressure's work is to the last bit
//! what the densities store. Water bears no tension unless the scene says so: below its density at rest it is a spray
//! without pressure, and nothing clumps.
//!
//! - [`tait`] is the equation of state, [`friction`] artificial and true viscosity, [`diffusion`] that of density;
//! - [`divergence_free`] is the other stage, of water without sound;
//! - [`near`] keeps neighbours, `pairs` sums over them, [`images`] are plain walls, [`flow`] is the stage, `sums`
//!   what it sums, `compression` whether the water stays nearly incompressible;
//! - [`nozzle`] brings water in, [`outlet`] takes it away.

mod around;
mod compression;
pub mod diffusion;
pub mod divergence_free;
mod exchange;
pub mod flow;
pub mod friction;
pub mod images;
pub mod near;
pub mod nozzle;
pub mod outlet;
mod pairs;
mod seen;
mod sums;
pub mod tait;
mod walls;

pub use divergence_free::{DivergenceFree, Liquid, Shore};
pub use flow::{Flow, Water};
