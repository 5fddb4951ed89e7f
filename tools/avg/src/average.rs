//! From particle frames to ensembles: one frame in memory at a time.

use std::collections::BTreeSet;

use artefact::Reader;

use crate::assemble::{AverageError, Plan};
use crate::cloud::Cloud;
use crate::ensemble::Ensemble;
use crate::frames;
use crate::heat_map::{HeatMaps, Told};
use crate::mean::{self, Cells};
use crate::phase;
use crate::profile::{self, Profile};
use crate::received::Received;

/// A frame in the frame of reference of the averages.
#[derive(Debug)]
pub struct Seen {
    /// Its particles.
    pub cloud: Cloud,
    /// Heat that they have got, where maps of it are made.
    pub received: Option<Received>,
    /// Its time \[s\].
    pub time: f64,
    /// Index of its phase.
    pub phase: usize,
    /// Its independent part.
    pub part: u32,
}

/// The averages of all sections.
#[derive(Debug)]
pub struct Averages {
    /// One per section of the plan.
    pub ensembles: Vec<Ensemble>,
    /// The surface over the distance from the axis, where the scene asks for it.
    pub profile: Option<Profile>,
    /// Number of different droplet periods in each phase, and in all.
    pub drops: (Vec<usize>, usize),
}

impl Averages {
    /// Names of the sections, and of the profile, in which no frame had metal.
    #[must_use]
    pub fn empty<'a>(&self, plan: &'a Plan) -> Vec<&'a str> {
        let sections = plan.sections.iter().zip(&self.ensembles);
        let empty = sections.filter(|(_, ensemble)| ensemble.is_empty());
        let mut names: Vec<&str> = empty.map(|(section, _)| section.name.as_str()).collect();
        if self.profile.as_ref().is_some_and(Profile::is_empty) {
            names.push(profile::PROFILE);
        }
        names
    }
}

/// Averages, fed one frame at a time in the order of time.
#[derive(Debug)]
pub struct Averaging<'a> {
    plan: &'a Plan,
    pub(crate) averages: Averages,
    /// Droplet periods in each phase.
    pub(crate) seen: Vec<BTreeSet<i64>>,
    /// The maps of heat, where the scene asks for some.
    pub maps: Option<HeatMaps>,
}

impl<'a> Averaging<'a> {
    /// Nothing averaged yet.
    #[must_use]
    pub fn new(plan: &'a Plan) -> Self {
        let averages = Averages {
            ensembles: plan
                .sections
                .iter()
                .map(|s| Ensemble::new(plan.phases, s.len()))
                .collect(),
            profile: plan.rings.as_ref().map(Profile::new),
            drops: (vec![0; plan.phases], 0),
        };
        Self {
            plan,
            averages,
            seen: vec![BTreeSet::new(); plan.phases],
            maps: plan.heat_maps.clone(),
        }
    }

    /// Reads a frame of the plan, by its place there, into the frame of reference of the averages.
    ///
    /// # Errors
    /// When the frame cannot be read, lacks a column, or the source has no place at its time.
    pub fn read(&mut self, reader: &Reader, place: usize) -> Result<Seen, AverageError> {
        let frame = reader.frame(&self.plan.channel, self.plan.frames[place])?;
        let mut cloud = frames::cloud(&frame, self.plan.states.as_deref())?;
        if let Some(x) = self.plan.mirror {
            cloud.complete(x);
        }
        let time = frame.time_s;
        let (mut phase, mut origin) = (0, [0.0; 2]);
        if let Some(follow) = &self.plan.follow {
            let at = frames::entry(&self.plan.track, time).ok_or(AverageError::NoSource {
                channel: follow.clone(),
                time_s: time,
            })?;
            let source = self.plan.track[at];
            let velocity = phase::velocity(&self.plan.track, at);
            origin = [source.position[0], source.position[1]];
            cloud.follow(origin, velocity);
            if let Some(first) = self.plan.origin {
                phase = phase::bin(source.phase, first, self.plan.phases);
                self.seen[phase].insert(source.droplet);
            }
        }
        let maps = self.plan.heat_maps.as_ref();
        let mirror = self.plan.mirror;
        let received = maps.map(|maps| Received::read(&frame, maps.ways(), origin, mirror));
        if let Some(link) = self.plan.landed {
            cloud.land(link);
        }
        let part = self.plan.parts.of(place);
        Ok(Seen {
            cloud,
            received: received.transpose()?,
            time,
            phase,
            part,
        })
    }

    /// Takes the kernel means of a frame into the ensembles, and its heat into the maps; gives a map that is complete.
    pub fn take(&mut self, seen: &Seen) -> Option<Told> {
        let smoothing = &self.plan.smoothing;
        let reach = (2.0 * smoothing.length).max(smoothing.spacing);
        let cells = Cells::new(&seen.cloud, reach);
        for (section, ensemble) in self.plan.sections.iter().zip(&mut self.averages.ensembles) {
            let samples = mean::section(&seen.cloud, &cells, section, smoothing);
            ensemble.add(seen.phase, seen.part, &samples);
        }
        if let (Some(rings), Some(profile)) = (&self.plan.rings, &mut self.averages.profile) {
            profile.add(rings, &seen.cloud, &cells, smoothing);
        }
        let (maps, received) = (self.maps.as_mut()?, seen.received.as_ref()?);
        maps.take(received, seen.time)
    }

    /// The averages of all frames taken in.
    #[must_use]
    pub fn finish(mut self) -> Averages {
        let all: BTreeSet<&i64> = self.seen.iter().flatten().collect();
        self.averages.drops = (self.seen.iter().map(BTreeSet::len).collect(), all.len());
        self.averages
    }
}
