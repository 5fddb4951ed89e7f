//! Where matters meet: water and solids, solids and solids, solids and walls.
//!
//! - [`skin`] shows a solid to the water: its cells, divided to the spacing of the water, where they are now;
//! - [`sight`] finds who meets whom, [`faces`] the face through which water presses, [`touch`] also by images in walls;
//! - [`wet`] is the pressure between the two; [`contact`] keeps solids apart.

mod balls;
pub mod contact;
pub mod faces;
pub mod sight;
pub mod skin;
pub mod touch;
pub mod wet;
