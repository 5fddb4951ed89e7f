//! How wide the floats of frames are.

use artefact::Precision;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Width of the floats of frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FloatWidth {
    /// 4 bytes.
    #[default]
    F32,
    /// 8 bytes.
    F64,
}

impl From<FloatWidth> for Precision {
    fn from(width: FloatWidth) -> Self {
        match width {
            FloatWidth::F32 => Self::F32,
            FloatWidth::F64 => Self::F64,
        }
    }
}
