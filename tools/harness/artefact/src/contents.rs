//! What a file holds: its channels, and where each message is.

use std::collections::BTreeMap;

use crate::error::Result;
use crate::message::time_s;
use crate::store::{ChannelInfo, Index, Store};

/// What a file says of one of its channels.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Name, for example `/particles`.
    pub name: String,
    /// Name of the schema of its messages.
    pub schema: String,
    /// Unit of each column.
    pub units: BTreeMap<String, String>,
    /// Number of messages.
    pub messages: usize,
    /// Simulated time of the first and the last message \[s\].
    pub span_s: Option<(f64, f64)>,
}

/// Where a message is: chunk, place among the channel's messages in it, time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub(crate) chunk: usize,
    pub(crate) within: usize,
    pub(crate) log_time: u64,
}

#[derive(Debug)]
pub(crate) struct Indexed {
    pub(crate) id: u16,
    pub(crate) info: ChannelInfo,
    pub(crate) units: BTreeMap<String, String>,
    pub(crate) places: Vec<Place>,
}

impl Indexed {
    /// The channel as a user sees it.
    pub(crate) fn describe(&self) -> Channel {
        Channel {
            name: self.info.name.clone(),
            schema: self.info.schema.clone(),
            units: self.units.clone(),
            messages: self.places.len(),
            span_s: self
                .places
                .first()
                .zip(self.places.last())
                .map(|(a, b)| (time_s(a.log_time), time_s(b.log_time))),
        }
    }
}

/// All channels of an index by name.
pub(crate) fn contents(store: &Store, index: &Index) -> Result<BTreeMap<String, Indexed>> {
    let mut channels = BTreeMap::new();
    for (&id, info) in &index.channels {
        let units = match info.metadata.get("units") {
            Some(text) => serde_json::from_str(text).map_err(|e| {
                store.damaged(format!("channel '{}'", info.name), format!("units: {e}"))
            })?,
            None => BTreeMap::new(),
        };
        let indexed = Indexed {
            id,
            info: info.clone(),
            units,
            places: places(index, id),
        };
        channels.insert(info.name.clone(), indexed);
    }
    Ok(channels)
}

/// Where the messages of a channel are, in file order.
fn places(index: &Index, id: u16) -> Vec<Place> {
    let mut places = Vec::new();
    for (chunk, place) in index.chunks.iter().enumerate() {
        let times = place.times.get(&id).into_iter().flatten();
        places.extend(times.enumerate().map(|(within, &log_time)| Place {
            chunk,
            within,
            log_time,
        }));
    }
    places
}
