//! Contacts of a bed at rest: what one run hands on to the next, so that grains lie on as they lay.
//!
//! A grain at rest is held by the springs across its contacts as much as by their overlaps. Laid down by places alone it would
//! slip until new springs are stretched. So the last frame of a bed has its contacts beside it, on [`CHANNEL`]: who touches
//! whom, and what the contact remembers. Metal is told by the place of its particle, as the next run numbers it anew.

use std::collections::HashMap;

use artefact::{Frame, Precision, Reader};
use contact::History;
use neighbours::Grid;
use particles::POSITION;
use run::Failure;
use shapes::frame::{Vector, difference, length};

use super::memory::Memory;
use crate::state::State;

/// Channel of the contacts.
pub const CHANNEL: &str = "/contacts";
/// A particle of metal is the one that a grain lay on where it stands within this part of a spacing.
const SAME: f64 = 1e-2;

/// Whom a grain touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum With {
    /// Another grain, by its number.
    Grain,
    /// A face of the walls, by its number.
    Wall,
    /// A particle of metal, by its place.
    Metal,
}

/// A contact of a bed; its rows are numbers of grains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touching {
    /// Whom the grain touches.
    pub with: With,
    /// Where that is \[m\]; of a wall, where the grain is.
    pub place: Vector,
    /// What it remembers.
    pub memory: Memory,
}

/// What the grains of a bed remember of their contacts, by the rows of the run that they go on in.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Laid {
    /// Between grains.
    pub between: Vec<Memory>,
    /// At walls.
    pub at_walls: Vec<Memory>,
    /// With metal, by its indices.
    pub on_metal: Vec<Memory>,
    /// Contacts with metal and with walls that are not there.
    pub lost: usize,
    /// Whether all grains of the run are of the bed, and no contact is lost.
    pub whole: bool,
}

/// Contacts as a frame.
#[must_use]
pub fn frame(contacts: &[Touching]) -> Frame {
    let each = || contacts.iter();
    Frame::new(Precision::F64)
        .positions(each().map(|c| c.place))
        .vector("stretch", "m", each().map(|c| c.memory.history.stretch))
        .scalar(
            "stiffness",
            "N/m",
            each().map(|c| c.memory.history.stiffness),
        )
        .vector("rolled", "m", each().map(|c| c.memory.rolled))
        .flag("with", each().map(|c| c.with as u8))
        .id("grain", each().map(|c| c.memory.row))
        .id("other", each().map(|c| c.memory.other))
}

/// The contacts of a bed whose grains have the numbers `ids` in the order of their last frame: rows are places in that order. None
/// where a file has none.
///
/// # Errors
/// A file that cannot be read, or a contact of a grain that it does not hold.
pub fn read(reader: &Reader, ids: &[u32]) -> Result<Vec<Touching>, Failure> {
    let Some(last) = reader.count(CHANNEL).checked_sub(1) else {
        return Ok(Vec::new());
    };
    let frame = reader.frame(CHANNEL, last)?;
    let (places, stretches) = (frame.position_vectors()?, frame.vectors("stretch")?);
    let (rolled, stiffness) = (frame.vectors("rolled")?, frame.f64("stiffness")?);
    let (with, grain, other) = (frame.u8("with")?, frame.u32("grain")?, frame.u32("other")?);
    let rows: HashMap<u32, u32> = ids.iter().copied().zip(0..).collect();
    let contact = |k: usize| {
        let row = |id: u32| rows.get(&id).copied().ok_or_else(|| contradicts(k, id));
        let with = match with[k] {
            0 => With::Grain,
            1 => With::Wall,
            _ => With::Metal,
        };
        let other = match with {
            With::Grain => row(other[k])?,
            With::Wall | With::Metal => other[k],
        };
        let row = row(grain[k])?;
        let (stretch, stiffness) = (stretches[k], stiffness[k]);
        let memory = Memory {
            row,
            other,
            history: History { stretch, stiffness },
            rolled: rolled[k],
        };
        let place = places[k];
        Ok(Touching {
            with,
            place,
            memory,
        })
    };
    (0..frame.len()).map(contact).collect()
}

/// What is said of a file whose contact `k` is one of a grain that is not in it.
fn contradicts(k: usize, id: u32) -> Failure {
    Failure::Other(format!(
        "the input 'bed' contradicts itself: contact {k} of {CHANNEL} is one of grain {id}, which is not in /grains"
    ))
}

impl Laid {
    /// The contacts of a bed whose first grain has the row `first`, on the metal of `state`.
    #[must_use]
    pub fn of(contacts: &[Touching], first: u32, state: &State) -> Self {
        let (near, spacing) = (
            SAME * state.metal.matter.spacing,
            state.metal.matter.spacing,
        );
        let mut grid = (!state.is_empty()).then(|| Grid::new(spacing));
        if let Some(grid) = &mut grid {
            grid.bin(state.metal.column(&POSITION));
        }
        let index = |place: Vector| {
            let grid = grid.as_ref()?;
            let mut found = None;
            grid.runs(place, near, |run| {
                for (at, id) in grid.sorted()[run.clone()].iter().zip(&grid.order()[run]) {
                    if length(difference(*at, place)) < near {
                        found = Some(*id);
                    }
                }
            });
            found
        };
        let mut laid = Self::default();
        for contact in contacts {
            let mut memory = contact.memory;
            memory.row += first;
            match contact.with {
                With::Grain => {
                    memory.other += first;
                    laid.between.push(memory.in_order());
                }
                With::Wall => laid.at_walls.push(memory),
                With::Metal => match index(contact.place) {
                    Some(id) => laid.on_metal.push(Memory {
                        other: id,
                        ..memory
                    }),
                    None => laid.lost += 1,
                },
            }
        }
        laid.between.sort_unstable_by_key(|m| (m.row, m.other));
        laid
    }

    /// Those of them whose wall is there, as `at_wall` says, and those with metal if grains meet it.
    #[must_use]
    pub fn kept(mut self, at_wall: impl Fn(&Memory) -> bool, meets_metal: bool) -> Self {
        let all = self.at_walls.len() + self.on_metal.len();
        self.at_walls.retain(at_wall);
        self.on_metal.retain(|_| meets_metal);
        self.lost += all - self.at_walls.len() - self.on_metal.len();
        self.whole &= self.lost == 0 && !self.between.is_empty();
        self
    }
}
