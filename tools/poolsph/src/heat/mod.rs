//! Heat in the metal: enthalpy, conduction, melting, the arc and the losses.

mod bounds;
pub mod caloric;
mod conduction;
mod held;
pub mod ledger;
mod parameters;
mod phase;

pub use caloric::Caloric;
pub use conduction::Conduction;
pub use parameters::{Face, Faces, MeltingParameters, Parameters};
pub use phase::{FlowStart, Phase};

#[cfg(test)]
mod tests;
