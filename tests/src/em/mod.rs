//! References for electric and magnetic fields that share nothing with a solver.
//!
//! - [`dielectric`]: a dielectric sphere in a uniform field, Matsuzawa (2017), eqs 3.3 to 3.11.
//! - [`driven`]: a conducting tube that saturates about a wire, along its radius and in time.
//! - [`axes`] in which a solution stands.
//! - [`bar`]: bars along z with net currents.
//! - [`bessel`]: modified Bessel functions of complex argument, scaled against overflow.
//! - [`coaxial`]: a conducting sphere among loops, as a scene tells it.
//! - [`coil`]: rings of current.
//! - [`cylinder`]: a conducting cylinder in an axial alternating field, eqs 3.12 and 3.13;
//!   [`diffusion`]: the same after its field is switched on.
//! - [`ellipsoid`]: a dielectric or conducting ellipsoid in a uniform field.
//! - [`exact`]: fields along the lines of a scene whose solution is known.
//! - [`frames`] reads runs and scenes.
//! - [`open`]: spheres and cylinders in open space.
//! - [`pair`]: two conducting spheres at given potentials.
//! - [`saturation`]: bodies with a curve of magnetisation in static fields.
//! - [`transverse`]: a conducting cylinder in an alternating field across it.
//! - [`sphere`]: a conducting sphere among coaxial loops or in a uniform alternating field;
//!   [`switched`]: the same after a uniform field is switched on.
//! - [`walls`]: which exact potential the walls of a scene hold.

pub mod axes;
pub mod bar;
pub mod bessel;
pub mod coaxial;
pub mod coil;
pub mod cylinder;
pub mod dielectric;
pub mod diffusion;
pub mod driven;
pub mod ellipsoid;
pub mod exact;
pub mod frames;
pub mod open;
pub mod pair;
pub mod saturation;
pub mod sphere;
pub mod switched;
pub mod transverse;
pub mod walls;

use num_complex::Complex;

/// A complex number.
pub type C = Complex<f64>;

/// Permeability of vacuum \[H/m\], `4 pi 1e-7` as the classic ampere had it (CODATA 2018 differs by
/// 5e-10).
pub const MU0: f64 = 4e-7 * std::f64::consts::PI;

/// Permittivity of vacuum \[F/m\].
pub const EPS0: f64 = 8.854_187_812_8e-12;
