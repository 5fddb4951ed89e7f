//! What is wrong with what a scene says of a torch.

/// What is wrong, and at which key of a torch or of its waveform.
#[derive(Debug, Clone, PartialEq)]
pub struct Misfit {
    /// JSON pointer from what it belongs to.
    pub path: String,
    /// What is wrong.
    pub what: String,
}
