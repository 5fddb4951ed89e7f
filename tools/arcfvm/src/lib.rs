//! Axisymmetric finite-volume arc plasma between a wire and a base metal.
