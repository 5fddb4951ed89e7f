//! Red-black successive over-relaxation of five-point equations.
