//! Grains that an earlier run has brought to rest.

use std::path::Path;

use artefact::Reader;
use run::Failure;

/// Place and radius of each grain at the end \[m\].
///
/// # Errors
/// A file that is no artefact of particles, or holds no grains.
pub fn read(path: &Path) -> Result<Vec<([f64; 3], f64)>, Failure> {
    let reader = Reader::open_kind(path, "particle-frames", 1)?;
    let frames = reader.count("/grains");
    if frames == 0 {
        let what = format!("{}: the input 'bed' holds no grains", path.display());
        return Err(Failure::Other(what));
    }
    let last = reader.frame("/grains", frames - 1)?;
    let places = last.position_vectors()?;
    Ok(places.into_iter().zip(last.f64("radius")?).collect())
}
