//! Eddy currents: the reaction of bodies to what coils and magnets give (Matsuzawa 2017, eqs 2.64 to 2.69).
//!
//! 1. [`source`]: exact fields of coils and of a uniform field; [`driven`]: what drives currents in the rows;
//! 2. [`unknown`]: what is sought at each point, A or `H_z`;
//! 3. [`diffusion`]: the rows of it in air, conductors and on interfaces, around [`holes`] and with other weights in thin
//!    skins ([`waves`]); [`medium`]: where permeability jumps; [`open`]: walls that truncate nothing;
//! 4. [`charge`]: A in space together with the potential of charges on conductors;
//! 5. [`stage`]: a stage of a march of A alone; [`saturation`]: a stage with media whose permeability depends on the field;
//! 6. [`fields`]: flux density, currents, force and heat by point; [`totals`]: their sums, in several ways.

pub mod charge;
pub mod diffusion;
pub mod driven;
pub mod fields;
pub mod holes;
pub mod medium;
pub mod open;
pub mod saturation;
pub mod source;
pub mod stage;
pub mod totals;
pub mod unknown;
pub mod waves;

#[cfg(test)]
mod tests;
