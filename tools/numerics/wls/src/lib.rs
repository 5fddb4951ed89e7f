//! Weighted least squares stencils on scattered points.
