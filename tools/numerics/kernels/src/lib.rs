//! The cubic spline kernel in one to three dimensions.
