//! Properties of plasmas of argon, carbon, oxygen and iron in local thermodynamic equilibrium, from first
//! principles.
//!
//! The way of a scene through the crate:
//!
//! - [`mixture`] holds the species with their energy levels and finds how many of each there are at a temperature,
//!   pressure and iron content, and with them density and enthalpy;
//! - [`transport`] takes collision integrals through the Chapman-Enskog equations: viscosity, conduction of heat and
//!   current, diffusion of iron;
//! - [`radiation`] sums lines and continuum to what the gas loses by light.

pub mod constants;
pub mod mixture;
pub mod radiation;
pub mod transport;
