//! Grains that an earlier run has brought to rest.

use std::path::Path;

use artefact::Reader;
use run::Failure;

use crate::grains::fill::Lying;
use crate::grains::laid::{self, Touching};

/// A bed at its end.
#[derive(Debug, Clone, Default)]
pub struct Bed {
    /// Place and radius of each grain \[m\].
    pub grains: Vec<Lying>,
    /// Who touches whom.
    pub contacts: Vec<Touching>,
}

/// The bed that a file holds.
///
/// # Errors
/// A file that is no artefact of particles, or holds no grains.
pub fn read(path: &Path) -> Result<Bed, Failure> {
    let reader = Reader::open_kind(path, "particle-frames", 1)?;
    let frames = reader.count("/grains");
    if frames == 0 {
        let what = format!("{}: the input 'bed' holds no grains", path.display());
        return Err(Failure::Other(what));
    }
    let last = reader.frame("/grains", frames - 1)?;
    let places = last.position_vectors()?;
    Ok(Bed {
        grains: places.into_iter().zip(last.f64("radius")?).collect(),
        contacts: laid::read(&reader, last.u32("id")?)?,
    })
}
