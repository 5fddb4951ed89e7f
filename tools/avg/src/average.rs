//! From particle frames to ensembles: one frame in memory at a time.

use std::collections::BTreeSet;

use artefact::{Precision, Reader, Values};
use thiserror::Error;

use crate::cloud::Cloud;
use crate::ensemble::Ensemble;
use crate::frames::{self, Plate};
use crate::grid::Section;
use crate::mean::{self, Cells, Smoothing};
use crate::parts::Parts;
use crate::phase::{self, Source};
use crate::profile::{self, Profile, Rings};
use crate::scene::Scene;

/// Most grid points of all sections and phases: some 5 GB.
const POINTS_MOST: f64 = 2e7;

/// Why there are no averages.
#[derive(Debug, Error)]
pub enum AverageError {
    /// A file that cannot be read or lacks something.
    #[error(transparent)]
    Artefact(#[from] artefact::Error),
    /// The frames do not tell the particle diameter and the scene does not either.
    #[error(
        "the frames have no channel '/plate' that tells the spacing: name 'spacing_m' in the scene"
    )]
    NoSpacing,
    /// No frame lies in the span of the scene.
    #[error(
        "no frame of '{channel}' lies between {from_s} s and {to_s} s; it has {count} frames from {first_s} s to {last_s} s"
    )]
    NoFrames {
        /// The channel.
        channel: String,
        /// First moment asked for \[s\].
        from_s: f64,
        /// Last moment asked for \[s\].
        to_s: f64,
        /// Frames that there are.
        count: usize,
        /// Their first moment \[s\].
        first_s: f64,
        /// Their last moment \[s\].
        last_s: f64,
    },
    /// More grid points than a machine holds.
    #[error(
        "asks for {points:.1e} grid points with {spacing_m} m between them, in {phases} phases; at most {POINTS_MOST:.0e} in all"
    )]
    TooMany {
        /// Index of the section.
        section: usize,
        /// Grid points of the section.
        points: f64,
        /// Their spacing \[m\].
        spacing_m: f64,
        /// Phases.
        phases: usize,
    },
    /// A profile of no ring, or of more places than a machine holds.
    #[error(
        "{radius_m} m of rings {spacing_m} m wide: wanted is one ring at least, and at most {POINTS_MOST:.0e} places"
    )]
    Rings {
        /// Radius of the profile \[m\].
        radius_m: f64,
        /// Width of a ring \[m\].
        spacing_m: f64,
    },
    /// A frame at a moment for which the source has no place.
    #[error(
        "channel '{channel}' does not tell where the source is at {time_s} s, the time of a frame"
    )]
    NoSource {
        /// The channel of the source.
        channel: String,
        /// Time of the frame \[s\].
        time_s: f64,
    },
}

/// What is known before the first frame is read.
#[derive(Debug)]
pub struct Plan {
    /// Indices of the frames that count, in the order of time.
    pub frames: Vec<usize>,
    /// Grid and kernel.
    pub smoothing: Smoothing,
    /// The sections.
    pub sections: Vec<Section>,
    /// The rings of the profile, where the scene asks for one.
    pub rings: Option<Rings>,
    /// The source over time; empty at rest.
    pub track: Vec<Source>,
    /// Number of phases; 1 without.
    pub phases: usize,
    /// The independent part of each frame that counts.
    pub parts: Parts,
    /// Length of the droplet period \[s\], where there is one.
    pub period: Option<f64>,
    /// Particles in the first frame that counts.
    pub particles: usize,
    /// Whether the frames carry a temperature.
    pub temperature: bool,
    /// How wide the positions of the frames are, and the means with them.
    pub precision: Precision,
}

impl Plan {
    /// Plans the averages of a scene over an artefact.
    ///
    /// # Errors
    /// When a channel is absent, the spacing is not told, or no frame counts.
    pub fn new(scene: &Scene, reader: &Reader) -> Result<Self, AverageError> {
        let times = reader.times(&scene.channel)?;
        let (from_s, to_s) = match scene.time {
            Some(span) => (span.from_s, span.to_s.unwrap_or(f64::INFINITY)),
            None => (0.0, f64::INFINITY),
        };
        // Half a nanosecond: the ends belong to the span.
        let counts = |t: f64| t >= from_s - 5e-10 && t <= to_s + 5e-10;
        let frames: Vec<usize> = (0..times.len()).filter(|i| counts(times[*i])).collect();
        let Some(first) = frames.first() else {
            return Err(AverageError::NoFrames {
                channel: scene.channel.clone(),
                from_s,
                to_s,
                count: times.len(),
                first_s: times.first().copied().unwrap_or(0.0),
                last_s: times.last().copied().unwrap_or(0.0),
            });
        };
        let first = reader.frame(&scene.channel, *first)?;
        let plate = Plate::read(reader)?;
        let diameter = plate.map(|p| p.spacing_m);
        let spacing = scene
            .spacing_m
            .or(diameter)
            .ok_or(AverageError::NoSpacing)?;
        let phases = scene.phases.map_or(1, |p| p.count as usize);
        fits(scene, spacing, phases)?;
        let smoothing = Smoothing {
            length: scene.smoothing_length_m.unwrap_or(spacing),
            spacing,
            volume: plate.map_or(spacing.powi(3), |p| p.volume()),
        };
        let track = match &scene.follow {
            Some(follow) => frames::track(reader, &follow.channel)?,
            None => Vec::new(),
        };
        let moments: Vec<f64> = frames.iter().map(|i| times[*i]).collect();
        let counted: Vec<Source> = track.iter().copied().filter(|s| counts(s.time)).collect();
        Ok(Self {
            smoothing,
            sections: scene.sections(spacing),
            rings: rings(scene, spacing)?,
            parts: parts(&track, &moments),
            phases,
            period: scene.phases.and_then(|_| phase::period(&counted)),
            track,
            particles: first.len(),
            temperature: first.has("temperature"),
            precision: match &first.get("x")?.values {
                Values::F64(_) => Precision::F64,
                _ => Precision::F32,
            },
            frames,
        })
    }

    /// Memory of the ensembles \[byte\].
    #[must_use]
    pub fn ensemble_bytes(&self) -> u64 {
        let points: usize = self.sections.iter().map(Section::len).sum();
        let kinds = self.phases + 1;
        let rings = self.rings.as_ref().map_or(0, |r| r.places.len() + r.len());
        let moments = rings * size_of::<crate::ensemble::Moments>();
        (points * kinds * size_of::<crate::ensemble::Point>() + moments) as u64
    }

    /// Memory of one frame: columns, cells and copies \[byte\].
    #[must_use]
    pub fn frame_bytes(&self) -> u64 {
        (self.particles * 2 * (7 * 8 + 4 * 8)) as u64
    }
}

/// Independent parts of the frames at `moments` \[s\]: by droplets, where the track tells more than one.
fn parts(track: &[Source], moments: &[f64]) -> Parts {
    let droplet = |t: &f64| frames::entry(track, *t).map(|at| track[at].droplet);
    let told: Option<Vec<i64>> = moments.iter().map(droplet).collect();
    match told {
        Some(droplets) if droplets.first() != droplets.last() => Parts::by_droplets(&droplets),
        _ => Parts::by_spans(moments.len()),
    }
}

/// Refuses sections that a machine does not hold, before they are made.
fn fits(scene: &Scene, spacing: f64, phases: usize) -> Result<(), AverageError> {
    let mut total = 0.0;
    for (section, cutting) in scene.sections.iter().enumerate() {
        let points = crate::grid::wanted([cutting.first_m, cutting.second_m], spacing);
        total += points * (phases + 1) as f64;
        if total > POINTS_MOST {
            return Err(AverageError::TooMany {
                section,
                points,
                spacing_m: spacing,
                phases,
            });
        }
    }
    Ok(())
}

/// The rings that the scene asks for.
fn rings(scene: &Scene, spacing_m: f64) -> Result<Option<Rings>, AverageError> {
    let Some(radius_m) = scene.profile.map(|p| p.radius_m) else {
        return Ok(None);
    };
    let refused = AverageError::Rings {
        radius_m,
        spacing_m,
    };
    if profile::wanted(radius_m, spacing_m) > POINTS_MOST {
        return Err(refused);
    }
    let rings = Rings::new(radius_m, spacing_m);
    if rings.is_empty() {
        return Err(refused);
    }
    Ok(Some(rings))
}

/// A frame in the frame of reference of the averages.
#[derive(Debug)]
pub struct Seen {
    /// Its particles.
    pub cloud: Cloud,
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
    scene: &'a Scene,
    plan: &'a Plan,
    pub(crate) averages: Averages,
    /// Droplet periods in each phase.
    pub(crate) seen: Vec<BTreeSet<i64>>,
}

impl<'a> Averaging<'a> {
    /// Nothing averaged yet.
    #[must_use]
    pub fn new(scene: &'a Scene, plan: &'a Plan) -> Self {
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
            scene,
            plan,
            averages,
            seen: vec![BTreeSet::new(); plan.phases],
        }
    }

    /// Reads a frame of the plan, by its place there, into the frame of reference of the averages.
    ///
    /// # Errors
    /// When the frame cannot be read, lacks a column, or the source has no place at its time.
    pub fn read(&mut self, reader: &Reader, place: usize) -> Result<Seen, AverageError> {
        let frame = reader.frame(&self.scene.channel, self.plan.frames[place])?;
        let mut cloud = frames::cloud(&frame)?;
        let time = frame.time_s;
        drop(frame);
        let mut phase = 0;
        if let Some(follow) = &self.scene.follow {
            let at = frames::entry(&self.plan.track, time).ok_or(AverageError::NoSource {
                channel: follow.channel.clone(),
                time_s: time,
            })?;
            let source = self.plan.track[at];
            let velocity = phase::velocity(&self.plan.track, at);
            cloud.follow([source.position[0], source.position[1]], velocity);
            if let Some(phases) = self.scene.phases {
                phase = phase::bin(source.phase, phases.origin, self.plan.phases);
                self.seen[phase].insert(source.droplet);
            }
        }
        if let Some(landed) = self.scene.landed {
            cloud.land(landed.link_m);
        }
        let part = self.plan.parts.of(place);
        Ok(Seen {
            cloud,
            time,
            phase,
            part,
        })
    }

    /// Takes the kernel means of a frame into the ensembles.
    pub fn take(&mut self, seen: &Seen) {
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
    }

    /// The averages of all frames taken in.
    #[must_use]
    pub fn finish(mut self) -> Averages {
        let all: BTreeSet<&i64> = self.seen.iter().flatten().collect();
        self.averages.drops = (self.seen.iter().map(BTreeSet::len).collect(), all.len());
        self.averages
    }
}
