//! The stages of a scene, group by group, and what it leaves out.

use run::Failure;

use crate::march::Group;
use crate::stage::Stage;

/// Physics that a scene does not have, and what says so.
pub type LeftOut = Vec<(&'static str, String)>;

/// Groups of stages in the order of a step (Komen 2019, fig. 3.16).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Room {
    /// What comes into the domain and leaves it.
    Domain,
    Surface,
    Heat,
    /// They heat metal before it changes its phase, and push it before it flows.
    Grains,
    Melting,
    Forces,
    Flow,
}

/// Stages, group by group.
pub(super) struct Parts {
    pub(super) groups: [Group; 7],
    pub(super) left_out: LeftOut,
}

impl Parts {
    pub(super) fn new() -> Self {
        let names = [
            "domain", "surface", "heat", "grains", "melting", "forces", "flow",
        ];
        let mut groups = names.map(Group::new);
        groups[Room::Surface as usize].gathers = true;
        Self {
            groups,
            left_out: LeftOut::new(),
        }
    }

    pub(super) fn stages(&self) -> impl Iterator<Item = &dyn Stage> {
        let groups = self.groups.iter();
        groups.flat_map(|group| group.stages.iter().map(AsRef::as_ref))
    }

    pub(super) fn leave_out(&mut self, key: &'static str) {
        self.left_out.push((key, format!("no key '{key}'")));
    }

    pub(super) fn take(&mut self, room: Room, stage: Box<dyn Stage>) {
        self.groups[room as usize].stages.push(stage);
    }

    /// Takes a stage if its key is there, and notes it as left out if not.
    pub(super) fn when<P>(
        &mut self,
        room: Room,
        key: &'static str,
        part: Option<P>,
        make: impl FnOnce(P) -> Result<Box<dyn Stage>, Failure>,
    ) -> Result<(), Failure> {
        match part {
            Some(part) => self.take(room, make(part)?),
            None => self.leave_out(key),
        }
        Ok(())
    }
}
