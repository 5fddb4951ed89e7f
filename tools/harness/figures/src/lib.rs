//! Figures of a run: where they stand in what it wrote, and how they are read.
//!
//! Sweeps, sensitivities and certificates name their figures in the same words ([`From`]). A figure stands in an artefact, or in the run
//! record beside it; measures of a bead alone are left to the program that measures beads.
//!
//! ```
//! let from: figures::From = serde_json::from_str(r#"{"period": {"channel": "/liquid", "value": "mode_2"}}"#).unwrap();
//! assert_eq!(from.place(), ("/liquid", "mode_2"));
//! ```

mod course;
mod from;
mod read;

pub use course::Course;
pub use from::From;
pub use read::{Error, Reading};
