//! What grains touch.

use super::lists::Lists;
use super::metal::Metal;
use super::walls::Walls;

/// What grains touch and give heat to.
pub struct Neighbours<'a> {
    /// Each other.
    pub lists: &'a Lists,
    /// Walls, which may shine.
    pub walls: &'a Walls,
    /// Metal, if there is any.
    pub metal: Option<&'a mut Metal>,
    /// How deeply cells sleep.
    pub depth: &'a [u8],
}
