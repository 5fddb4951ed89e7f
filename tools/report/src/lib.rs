//! Pictures, tables and error against run time from artefacts and records.

mod draw;
mod measure;
