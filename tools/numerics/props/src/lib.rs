//! Property tables and piecewise linear interpolation.
