//! Versioned, deterministic artefacts: the files that join the stages.
