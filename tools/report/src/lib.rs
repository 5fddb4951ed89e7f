//! Pictures, tables and error against run time from artefacts and records.
//!
//! `report page` makes one page of a weld, `report heat` one of bodies that conduct heat, `report jet` one of jets that meet solids,
//! `report field` one of electric and magnetic fields, `report gas` one of tables of gases, `report sweep` one of the points of a
//! sweep, `report compare` one of two runs, `report index` one of all evidence; `report validate` compares a weld with published
//! values. Every input is optional: a page shows what there is, and a study without an arc has no section about one. Pages are
//! single files: pictures are embedded, nothing is fetched from anywhere.

mod certified;
pub mod command;
mod csv;
mod draw;
mod field;
mod figures;
mod files;
mod flux;
mod gas;
mod handover;
mod heat;
mod html;
mod index;
mod measure;
mod mirror;
mod moments;
mod page;
mod picture;
mod plot;
mod preview;
mod probes;
mod records;
mod targets;
mod validate;
mod weld;
