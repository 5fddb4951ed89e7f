//! Incompressible SPH weld pool and bead under a moving arc source.
