//! Grains: spheres that push, rub and roll on each other and on walls (discrete elements).
//!
//! ```text
//! m du/dt = sum F_ab + sum F_wall + m g         I dw/dt = sum M        (Komen 2019, eqs 3.104 to 3.118, 5.31)
//! ```
//!
//! Forces and moments of a contact are those of the crate `contact`. A step of the run is divided into steps that the
//! contacts allow ([`bounds`]); each is one of velocity Verlet, whose dashpots feel the velocities that the last forces
//! lead on: to the end of the step for a grain with one contact, l = 1, to its middle in a crowd, l = 1/2:
//!
//! ```text
//! x += dt u + dt^2/2 a,  u += l dt a            predict
//! a' = forces(x, u) / m + g                     act
//! u += dt (a'/2 + (1/2 - l) a)                  correct
//! ```
//!
//! Each contact is reckoned once, for the grain of the lower row, and added to both of its grains in the order of the list.
//! So the bits do not depend on threads, momentum and angular momentum are kept to round-off, and what is far away
//! adds nothing.

pub mod again;
mod around;
pub mod block;
pub mod bounds;
mod buried;
pub mod columns;
mod conductances;
mod conducting;
pub mod cover;
mod crowd;
pub mod depth;
pub mod displaced;
mod doubts;
pub mod faces;
pub mod fill;
mod glued;
pub mod gone;
mod greater;
pub mod heat;
pub mod heat_parameters;
pub mod laid;
pub mod law;
pub mod light;
mod limits;
mod listing;
pub mod lists;
pub mod memory;
pub mod metal;
mod metal_heat;
mod metal_list;
mod metal_pair;
pub mod metal_parameters;
mod mirrors;
pub mod motion;
pub mod moving;
mod near;
mod neighbours;
pub mod order;
mod overlap;
pub mod pairs;
pub mod parameters;
pub mod pressure;
mod resistance;
mod saved;
pub mod sleep;
pub mod slow;
mod sums;
pub mod totals;
pub mod vapour;
mod verlet;
pub mod wall_list;
mod wall_parameters;
pub mod walls;
mod warm;
mod watched;

use particles::Column;

pub use buried::buried;
pub use heat::Heat;
pub use metal::Metal;
pub use metal_heat::Exchange;
pub use mirrors::Mirrors;
pub use motion::Motion;
pub use overlap::overlaps;
pub use parameters::Parameters;
pub use warm::warm;

/// u \[m/s\].
pub const VELOCITY: Column<[f64; 3]> = Column::new("velocity", "m/s", [0.0; 3]).saved().shown();
/// Angular velocity w \[rad/s\].
pub const SPIN: Column<[f64; 3]> = Column::new("spin", "rad/s", [0.0; 3]).saved().shown();
/// Radius \[m\].
pub const RADIUS: Column<f64> = Column::new("radius", "m", 0.0).saved().shown();
/// Mass \[kg\].
pub const MASS: Column<f64> = Column::new("mass", "kg", 0.0).saved();
/// Force of all contacts \[N\].
pub const FORCE: Column<[f64; 3]> = Column::new("force", "N", [0.0; 3]).saved().shown();
/// Moment of all contacts \[N m\].
pub const MOMENT: Column<[f64; 3]> = Column::new("moment", "N m", [0.0; 3]).saved();
/// Where the grain was when neighbours were last listed \[m\].
pub const LISTED: Column<[f64; 3]> = Column::new("listed", "m", [0.0; 3]).saved();
/// Where the grain was when it was last asked whether it rests \[m\].
pub const WATCHED: Column<[f64; 3]> = Column::new("watched", "m", [0.0; 3]).saved();
/// How far it has turned since \[rad\].
pub const TURNED: Column<[f64; 3]> = Column::new("turned", "rad", [0.0; 3]).saved();
/// Number of the body that it is glued into, plus one; 0 for a free grain.
pub const GLUED: Column<u8> = Column::new("glued", "1", 0).saved();
/// Where it was in that body at the start, seen from the centre of mass \[m\].
pub const GLUED_AT: Column<[f64; 3]> = Column::new("glued_at", "m", [0.0; 3]).saved();
/// Number of the body that drives it, plus one; 0 for a free grain.
pub const DRIVEN: Column<u8> = Column::new("driven", "1", 0).saved();
