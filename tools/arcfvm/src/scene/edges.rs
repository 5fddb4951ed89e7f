//! What the fields meet at the four sides of the domain.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Conditions of the four sides; of several that cover a face the last counts.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "Sides_{T}")]
pub struct Sides<T> {
    /// Smallest radius.
    pub inner: Vec<T>,
    /// Largest radius.
    pub outer: Vec<T>,
    /// Lowest height.
    pub bottom: Vec<T>,
    /// Greatest height.
    pub top: Vec<T>,
}

impl<T> Default for Sides<T> {
    fn default() -> Self {
        Self {
            inner: Vec::new(),
            outer: Vec::new(),
            bottom: Vec::new(),
            top: Vec::new(),
        }
    }
}
