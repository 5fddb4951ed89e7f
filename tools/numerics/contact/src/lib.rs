//! Contact of grains that are spheres: what two of them, or one and a wall, do to each other where they overlap.
//!
//! A [`Meeting`] is the geometry of one contact: the normal n from b to a, the overlap, the arms from both centres to the
//! plane of contact, the speed of approach and the sliding velocity. A [`Normal`] law gives the push along n, [`Friction`] the
//! force in the plane of contact with its [`History`], [`Rolling`] the moment that resists rolling. [`Contact`] puts them
//! together: force and moment on a; b gets the opposite force, and the moment of its own arm.
//!
//! ```text
//! F  = N n + F_t        N = law(overlap, approach) >= 0 where contacts cannot pull
//! F_t = -k_t s - eta_t u_t,   |F_t| <= mu N          s: stretch of the tangential spring
//! M_a = -l_a n x F_t + M_r,   M_b = -l_b n x F_t - M_r
//! ```
//!
//! These are eqs 3.104 to 3.118 of Komen (2019), made right: damping by the effective mass, a stretch that is turned into the
//! plane and kept when the motion reverses, arms from the centres to the plane of contact (printed: half of the overlap).
//! With the two arms l_a + l_b = |x_a - x_b| in the sliding velocity and in the moments, angular momentum is kept and the
//! power of the forces is that of the springs.
//!
//! Swapping a and b negates every force bit by bit, so that each grain can gather its own contacts and momentum still holds.
//!
//! Two laws stand behind the trait: [`Linear`] (spring and dashpot, Cundall and Strack 1979) and [`Hertz`] (Hertz 1881 with the
//! damping of Tsuji, Tanaka and Ishida 1992, tangential stiffness of Mindlin 1949). Neither knows of files, scenes or steps;
//! [`steps`] tells how long an explicit step may be. Heat between touching grains is in [`heat`].

mod couple;
pub mod heat;
mod hertz;
mod linear;
mod meeting;
mod normal;
mod restitution;
mod rolling;
mod slider;
pub mod steps;

pub use couple::{Contact, Reply};
pub use hertz::{Elastic, Hertz};
pub use linear::Linear;
pub use meeting::{Grain, Meeting};
pub use normal::Normal;
pub use restitution::Ending;
pub use rolling::Rolling;
pub use slider::{Friction, History};
