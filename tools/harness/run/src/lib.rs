//! How every stage is run: command line, scene, clock, progress, record, checkpoint.
