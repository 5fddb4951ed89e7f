//! Heat in the metal: enthalpy, conduction, melting, the arc and the losses.

mod arc;
mod bounds;
pub mod caloric;
mod cathode;
mod chunks;
mod conduction;
mod contact;
mod film;
mod flux;
mod held;
pub mod ledger;
mod losses;
mod open;
mod parameters;
mod phase;
mod radial;
pub mod received;
mod shade;
mod skin;
mod substances;
mod torches;
mod vapour;

pub use arc::{Arc, ArcParameters, Onto, Part};
pub(crate) use bounds::outside;
pub use caloric::Caloric;
pub use cathode::Cathode;
pub use conduction::Conduction;
pub use film::GasFilm;
pub use losses::{LossParameters, Losses, Where};
pub(crate) use parameters::table;
pub use parameters::{Faces, MeltingParameters, Parameters, Properties};
pub use phase::{FlowStart, Phase};
pub use substances::{Substance, Substances};
pub use torches::Torches;
pub(crate) use vapour::MOLAR_GAS;
pub use vapour::{Evaporation, GasLayer};

#[cfg(test)]
mod surface_tests;
#[cfg(test)]
mod tests;
