//! A small rasteriser: shaded particles, fields, arrows, contour lines, axes and letters.

pub(crate) mod axes;
pub(crate) mod canvas;
pub(crate) mod colour;
pub(crate) mod contour;
pub(crate) mod discs;
pub(crate) mod film;
pub(crate) mod letters;
pub(crate) mod palette;
