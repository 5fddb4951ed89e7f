//! What several tests of transport share.

use serde_json::Value;

use super::Uncertain;
use super::collision::Particle;
use crate::mixture::Library;

/// The data file.
pub(crate) fn data() -> Value {
    Library::embedded().unwrap().data().clone()
}

/// A species of the library as a particle.
pub(crate) fn particle(name: &str) -> Particle {
    Particle::new(
        Library::embedded().unwrap().get(name).unwrap(),
        &Uncertain::default(),
    )
}
