//! Versioned, deterministic artefacts: the files that join the stages.
//!
//! An artefact is an [MCAP](https://mcap.dev) file with zstd chunks, checksums and an index. Its
//! bytes are a function of scene, inputs and tool version alone ([`Header`]); see `FORMAT.md`.
//!
//! ```
//! use artefact::{Frame, Header, Precision, Reader, Table, Version, Writer};
//!
//! # fn main() -> artefact::Result<()> {
//! let header = Header {
//!     kind: "particle-frames".to_owned(),
//!     version: Version::new(1, 0),
//!     tool: "poolsph".to_owned(),
//!     tool_version: "0.1.0".to_owned(),
//!     scene: serde_json::json!({"kind": "poolsph.scene", "version": 2}),
//!     inputs: Default::default(),
//! };
//! let path = std::env::temp_dir().join("artefact-example.mcap");
//! let mut writer = Writer::create(&path, &header)?;
//! let frame = Frame::new(Precision::F32)
//!     .positions([[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0]])
//!     .scalar("temperature", "K", [300.0, 1800.0])
//!     .flag("molten", [0, 1]);
//! writer.frame("/particles", 0.5, &frame)?;
//! writer.table("/surface", 0.5, &Table::new(2).column("radius_m", "m", [0.0, 1e-3]))?;
//! writer.finish()?;
//!
//! let reader = Reader::open_kind(&path, "particle-frames", 1)?;
//! for frame in reader.frames("/particles")? {
//!     let frame = frame?;
//!     assert_eq!(frame.f64("temperature")?, [300.0, 1800.0]);
//!     assert_eq!(frame.u8("molten")?, [0, 1]);
//! }
//! # std::fs::remove_file(path).ok();
//! # Ok(())
//! # }
//! ```

mod atomic;
mod checkpoint;
mod cloud;
mod contents;
mod descriptor;
mod error;
mod frame;
mod grid;
mod header;
mod json;
mod key_unit;
mod lattice;
mod lock;
mod message;
mod part;
mod place;
mod reader;
mod record;
mod recover;
mod schema;
mod scrub;
mod shown;
mod store;
mod survey;
mod table;
mod tables;
mod validity;
mod values;
mod version;
mod writer;

pub use atomic::{beside, free_bytes, write_atomically};
pub use checkpoint::Checkpoint;
pub use contents::Channel;
pub use error::{Error, Result};
pub use frame::{Column, Frame};
pub use header::{Header, Identity, KINDS, METADATA, WRITTEN, canonical, sha256, sha256_file};
pub use json::{json_artefact, json_error, json_text};
pub use key_unit::{KEY_UNITS, unit_of_key};
pub use lattice::even_step;
pub use lock::Lock;
pub use message::{GRID, POINT_CLOUD, RECORD, TABLE, one_time};
pub use place::{followed, must_be_nameable, must_be_replaceable, must_not_be_read};
pub use reader::Reader;
pub use recover::{RECOVERED, Saved, recover};
pub use schema::schema_faults;
pub use shown::{Shown, shown};
pub use survey::Lost;
pub use table::{Entry, Quantity, Record, Series, Table};
pub use values::{Precision, Values};
pub use version::Version;
pub use writer::{Position, Writer};
