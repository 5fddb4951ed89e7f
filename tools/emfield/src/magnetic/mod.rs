//! Eddy currents: the reaction of bodies to what coils and magnets give (Matsuzawa 2017, eqs 2.64 to 2.69).
//!
//! `setup` makes `parameters` of a scene, which nothing else here reads. Of these `problem` holds all that does not change
//! in a run, in this order:
//!
//! 1. [`source`]: exact fields of coils and of a uniform field; [`driven`]: what drives currents in the rows;
//! 2. [`unknown`]: what is sought at each point, A or `H_z`;
//! 3. [`diffusion`]: the rows of it in air, conductors and on interfaces, around [`holes`] and with other weights in thin
//!    skins ([`waves`]; `skin` tells where points do not resolve one); [`medium`]: where permeability jumps; [`open`]: walls
//!    that truncate nothing;
//! 4. [`charge`]: A in space together with the potential of charges on conductors;
//! 5. `harmonic`: the sinusoidal steady state; `transient`: a [`stage`] of a march; `standing`: one without a rate, with
//!    [`saturation`] where the permeability of media depends on the field;
//! 6. [`fields`]: flux density, currents, force and heat by point; [`totals`]: their sums, in several ways; `enclosed`: those
//!    through closed surfaces; `doubts`: where ways disagree; `columns`: what is written.

pub mod charge;
mod columns;
pub mod diffusion;
mod doubts;
pub mod driven;
mod enclosed;
pub mod fields;
mod harmonic;
pub mod holes;
pub mod medium;
pub mod open;
pub(crate) mod parameters;
pub(crate) mod problem;
pub mod saturation;
pub(crate) mod setup;
mod skin;
pub mod source;
pub mod stage;
mod standing;
pub mod totals;
pub(crate) mod transient;
pub mod unknown;
pub mod waves;

#[cfg(test)]
mod tests;
