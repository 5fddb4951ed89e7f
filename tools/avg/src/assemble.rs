//! From the scene and the frames to the plan of the averages: the only place that asks what the scene contains.

use artefact::{Frame, Precision, Reader, Values};
use thiserror::Error;

use crate::frames::{self, Plate};
use crate::grid::Section;
use crate::heat_map::HeatMaps;
use crate::layout;
use crate::mean::Smoothing;
use crate::parts::Parts;
use crate::phase::{self, Source};
use crate::profile::{self, Rings};
use crate::received;
use crate::scene::{GrainState, Scene};

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
    /// What has landed is asked of grains.
    #[error("the frames are of grains, of which none is in flight: leave 'landed' out")]
    Landed,
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
    /// A heat map of more cells than a machine holds.
    #[error("asks for {cells:.1e} cells of {cell_m} m; at most {POINTS_MOST:.0e}")]
    Cells {
        /// Cells.
        cells: f64,
        /// Side of a cell \[m\].
        cell_m: f64,
    },
    /// A heat map of frames that tell no heat.
    #[error(
        "the frames of '{channel}' do not tell what heat metal has got: maps are made of metal, from '/particles' or '/pool' of poolsph \
         with \"heat_received\": true in its output"
    )]
    Untold {
        /// The channel.
        channel: String,
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
    /// Channel of the frames.
    pub channel: String,
    /// Channel of the source that the averages follow, where they do.
    pub follow: Option<String>,
    /// Phase of the droplet at which the first of the phases stands, where there are some.
    pub origin: Option<f64>,
    /// States of grains that count, where not all do.
    pub states: Option<Vec<GrainState>>,
    /// Greatest distance between neighbours of what has landed \[m\], where only that counts.
    pub landed: Option<f64>,
    /// Indices of the frames that count, in the order of time.
    pub frames: Vec<usize>,
    /// Grid and kernel.
    pub smoothing: Smoothing,
    /// The sections.
    pub sections: Vec<Section>,
    /// The rings of the profile, where the scene asks for one.
    pub rings: Option<Rings>,
    /// The maps of heat before the first frame, where the scene asks for some.
    pub heat_maps: Option<HeatMaps>,
    /// x of the mirror beside which half of a weld was computed \[m\].
    pub mirror: Option<f64>,
    /// Direction of a weld that does not run along +y.
    pub turned: Option<[f64; 2]>,
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
        let [from_s, to_s] = span(scene);
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
        let plate = plate(scene, reader, &first)?;
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
        let metal = Plate::read(reader)?;
        let moments: Vec<f64> = frames.iter().map(|i| times[*i]).collect();
        let counted: Vec<Source> = track.iter().copied().filter(|s| counts(s.time)).collect();
        Ok(Self {
            channel: scene.channel.clone(),
            follow: scene.follow.as_ref().map(|follow| follow.channel.clone()),
            origin: scene.phases.map(|phases| phases.origin),
            states: scene.states.clone(),
            landed: scene.landed.map(|landed| landed.link_m),
            smoothing,
            sections: scene.sections(spacing),
            rings: rings(scene, spacing)?,
            heat_maps: heat_maps(scene, spacing, &first)?,
            mirror: metal.and_then(|plate| plate.mirror_x_m),
            turned: metal.and_then(|plate| plate.turned()),
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
        let maps = self
            .heat_maps
            .as_ref()
            .map_or(0, |maps| maps.bytes(self.particles));
        (points * kinds * size_of::<crate::ensemble::Point>() + moments) as u64 + maps
    }

    /// Memory of one frame: columns, cells and copies \[byte\].
    #[must_use]
    pub fn frame_bytes(&self) -> u64 {
        let sides = if self.mirror.is_some() { 2 } else { 1 };
        (sides * self.particles * 2 * (7 * 8 + 4 * 8)) as u64
    }
}

/// From and to \[s\], of frames that count.
fn span(scene: &Scene) -> [f64; 2] {
    match scene.time {
        Some(span) => [span.from_s, span.to_s.unwrap_or(f64::INFINITY)],
        None => [0.0, f64::INFINITY],
    }
}

/// What the frames say of their particles: metal, or grains, none of which is in flight.
fn plate(scene: &Scene, reader: &Reader, first: &Frame) -> Result<Option<Plate>, AverageError> {
    match frames::grains(first)? {
        Some(_) if scene.landed.is_some() => Err(AverageError::Landed),
        Some(grains) => Ok(Some(grains)),
        None => Ok(Plate::read(reader)?),
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

/// The maps of heat that the scene asks for.
fn heat_maps(scene: &Scene, spacing: f64, first: &Frame) -> Result<Option<HeatMaps>, AverageError> {
    let Some(map) = &scene.heat_map else {
        return Ok(None);
    };
    let cell_m = map.cell_m.unwrap_or(spacing);
    let cells = layout::wanted([map.x_m, map.y_m], cell_m);
    if cells > POINTS_MOST {
        return Err(AverageError::Cells { cells, cell_m });
    }
    let ways = received::ways(first);
    if ways.is_empty() {
        let channel = scene.channel.clone();
        return Err(AverageError::Untold { channel });
    }
    Ok(Some(HeatMaps::new(map.layout(spacing), ways)))
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
