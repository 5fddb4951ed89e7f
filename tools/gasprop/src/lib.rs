//! Properties of plasmas of argon, carbon, oxygen and iron in local thermodynamic equilibrium, from first
//! principles.
//!
//! The way of a scene through the crate:
//!
//! - [`mixture`] holds the species with their energy levels and finds how many of each there are at a temperature,
//!   pressure and iron content, and with them density and enthalpy;
//! - [`transport`] takes collision integrals through the Chapman-Enskog equations: viscosity, conduction of heat and
//!   current, diffusion of iron;
//! - [`radiation`] sums lines and continuum to what the gas loses by light;
//! - [`properties`] is all of it for one gas, with the [`columns`] of a table;
//! - [`grid`] places the temperatures and measures what interpolation costs, [`table`] is what is written,
//!   [`program`] the program that reads a [`scene`].

mod assemble;
pub mod columns;
pub mod constants;
pub mod grid;
pub mod mixture;
pub mod program;
pub mod properties;
pub mod radiation;
pub mod scene;
pub mod table;
pub mod transport;
