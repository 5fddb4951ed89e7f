//! What fills the memory that the process was left by what it has done before, so that a trial has to ask for its own.

use crate::machine;

/// Blocks that are held while a trial is watched.
#[derive(Debug)]
pub(crate) struct Ballast {
    blocks: Vec<Vec<u8>>,
}

impl Ballast {
    /// Blocks \[byte\], and how many are asked for between looks at the memory of the process.
    const BLOCK: usize = 1 << 16;
    const AT_ONCE: usize = 16;
    /// Growth of the process that says that nothing is left \[byte\], and the most that is filled.
    const GROWN: u64 = 2 << 20;
    const MOST: usize = 1 << 30;

    /// Fills what is left; nothing where the system does not tell memory.
    pub(crate) fn new() -> Self {
        let mut blocks = Vec::new();
        let Some(start) = machine::memory_bytes() else {
            return Self { blocks };
        };
        while blocks.len() * Self::BLOCK < Self::MOST {
            // Memory is there once it is written to.
            blocks.extend((0..Self::AT_ONCE).map(|_| vec![1; Self::BLOCK]));
            if machine::memory_bytes().is_none_or(|now| now > start + Self::GROWN) {
                break;
            }
        }
        Self { blocks }
    }

    /// Memory of the process without these \[byte\].
    pub(crate) fn without(&self, all: u64) -> u64 {
        all.saturating_sub((self.blocks.len() * Self::BLOCK) as u64)
    }
}
