//! Verification, validation, stability and fault tests across the tools.
