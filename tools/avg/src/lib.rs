//! Droplet-phase and time averages of particle frames on a grid that moves with the source.
//!
//! Particles jitter about the flow; what is the same in every droplet period is the flow. For each
//! frame the velocity relative to the source and the temperature are taken to the points of a grid
//! with the kernel mean of Komen (2019), eq. 4.8 ([`mean`]); frames of equal phase of the droplet
//! period are then averaged arithmetically ([`ensemble`]), as in section 4.5 there. The grid moves
//! with the source, its spacing is one particle diameter. Sections are planes, with the particles
//! within a given distance, and the topmost layer of metal as seen from above ([`grid`]).
//!
//! The mean of a linear field is exact at points about which the particles lie symmetrically; at
//! random particles its error is of the order of the jitter over the root of the number of independent frames,
//! which the standard errors in the output tell ([`parts`]). Near a surface the kernel is cut off, and the mean
//! is that of the metal inside: half a spacing below the surface, about.
//!
//! Heat that metal has got by each way becomes maps of fluxes, interval by interval ([`heat_map`]).
//!
//! Grains of flux are averaged in the same way (Komen 2019, figs 5.33 to 5.38): all that lie in a state that counts, powder, slag or
//! slag that has set, with the room that loose grains take in place of the volume of a particle.

pub mod assemble;
pub mod average;
pub mod cloud;
pub mod ensemble;
pub mod fields;
pub mod frames;
pub mod grid;
pub mod heat_map;
pub mod layout;
pub mod mean;
pub mod parts;
pub mod phase;
pub mod profile;
pub mod program;
pub mod received;
pub mod resume;
pub mod scene;
pub mod surface;
