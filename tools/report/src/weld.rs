//! The weld as its last frame shows it: particles, plate, source, and the stretch that has frozen.

mod stretch;
mod way;

use artefact::{Frame, Reader};
use serde::Deserialize;

pub(crate) use self::stretch::Stretch;
pub(crate) use self::way::{Source, Way};
use crate::measure::bead::{self, Bead};
use crate::measure::section::{Metal, Plane, SUPPORT, Section};
use crate::measure::spatter;
use crate::mirror::Mirror;

/// Channel of all particles.
pub(crate) const PARTICLES: &str = "/particles";
/// What lies closer to the start of the weld than this is run-in, not bead \[m\].
const RUN_IN: f64 = 8e-3;
/// Greatest distance between neighbours in a bead, in spacings.
const LINK: f64 = 1.5;
/// Metal shown before and behind what has been fused \[m\].
const ROOM: f64 = 6e-3;
/// Least length shown along the weld \[m\].
const LEAST_SHOWN: f64 = 40e-3;
/// Distance from liquid metal at which a section counts as frozen \[m\].
const CLEAR: f64 = 1e-3;

/// What the pool tells once of the plate.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Plate {
    /// Particle spacing \[m\].
    pub(crate) spacing_m: f64,
    /// Lower corner of the base metal \[m\].
    #[serde(default)]
    pub(crate) min_m: Option<[f64; 3]>,
    /// Upper corner of the base metal \[m\].
    #[serde(default)]
    pub(crate) max_m: Option<[f64; 3]>,
    /// Melting point \[K\].
    #[serde(default)]
    pub(crate) melting_point_k: Option<f64>,
    /// Direction of welding.
    #[serde(default)]
    direction: Option<[f64; 3]>,
}

impl Plate {
    /// How thick the base metal is \[m\].
    pub(crate) fn thickness(&self) -> Option<f64> {
        Some(self.max_m?[2] - self.min_m?[2])
    }
}

/// The particles of one frame with what is known of them.
#[derive(Debug, Clone)]
pub(crate) struct Weld {
    /// Simulated time \[s\].
    pub(crate) time: f64,
    /// Positions across the weld, along it, and up from the original surface \[m\].
    pub(crate) position: Vec<[f64; 3]>,
    /// Number of each particle in its frame; an image has that of its original.
    pub(crate) row: Vec<usize>,
    /// Temperatures \[K\], where the run computed them.
    pub(crate) temperature: Option<Vec<f64>>,
    /// Liquid now.
    pub(crate) liquid: Vec<bool>,
    /// Slag, by particles of the frame; empty where all is metal.
    slag: Vec<bool>,
    /// Greatest part of its latent heat that each has ever held.
    pub(crate) fused: Vec<f64>,
    /// Belongs to what is measured: the plate and the fused metal joined to the bead. Spatter and
    /// drops in flight do not.
    joined: Vec<bool>,
    /// Plate.
    pub(crate) plate: Plate,
    /// Source at this moment, if there is one.
    pub(crate) source: Option<Source>,
    /// Particles that have left the plate over its edges; they are not among the others.
    pub(crate) lost: usize,
    /// The mirror beside which half of it was computed; its image is among the particles.
    pub(crate) mirror: Option<Mirror>,
    /// What across, along and up are in the scene.
    pub(crate) way: Way,
}

impl Weld {
    /// The last frame of the artefact; `None` when it has none.
    ///
    /// # Errors
    /// When a message cannot be read or a column is absent.
    pub(crate) fn last(reader: &Reader) -> artefact::Result<Option<Self>> {
        match reader.count(PARTICLES) {
            0 => Ok(None),
            n => Self::read(reader, n - 1).map(Some),
        }
    }

    /// The frame with an index.
    ///
    /// # Errors
    /// When a message cannot be read or a column is absent.
    pub(crate) fn read(reader: &Reader, index: usize) -> artefact::Result<Self> {
        let frame = reader.frame(PARTICLES, index)?;
        let plate: Plate = reader.json_at("/plate", 0)?;
        let position = frame.position_vectors()?;
        let mut weld = Self {
            time: frame.time_s,
            row: (0..position.len()).collect(),
            position,
            temperature: if frame.has("temperature") {
                Some(frame.f64("temperature")?)
            } else {
                None
            },
            liquid: flags(&frame, "molten")?,
            slag: if frame.has("slag") {
                flags(&frame, "slag")?
            } else {
                Vec::new()
            },
            fused: frame.f64(if frame.has("fused") {
                "fused"
            } else {
                "molten"
            })?,
            way: Way::of(reader, &plate)?,
            plate,
            source: Source::at(reader, frame.time_s)?,
            joined: Vec::new(),
            lost: 0,
            mirror: Mirror::read(reader)?,
        };
        if frame.has("wall") {
            let metal: Vec<bool> = frame.u8("wall")?.iter().map(|w| *w == 0).collect();
            weld.retain(&metal);
        }
        weld.leave_out_lost();
        if let Some(mirror) = weld.mirror {
            weld.complete(mirror);
        }
        weld.position.iter_mut().for_each(|p| weld.way.turn(p));
        let link = LINK * weld.plate.spacing_m;
        let fused: Vec<bool> = (0..weld.position.len())
            .map(|i| weld.was_liquid(i))
            .collect();
        let bead = spatter::largest(&weld.position, &fused, link);
        weld.joined = bead.iter().zip(&fused).map(|(b, f)| *b || !f).collect();
        Ok(weld)
    }

    /// Adds the image of the half that was computed.
    fn complete(&mut self, mirror: Mirror) {
        self.lost *= 2;
        mirror.places(&mut self.position);
        mirror.values(&mut self.row);
        mirror.values(&mut self.liquid);
        mirror.values(&mut self.fused);
        self.temperature.iter_mut().for_each(|t| mirror.values(t));
        if let (Some(low), Some(high)) = (&mut self.plate.min_m, &mut self.plate.max_m) {
            mirror.corners(low, high);
        }
    }

    /// Leaves out what is beside or below the plate: it is no part of the bead.
    fn leave_out_lost(&mut self) {
        let (Some(low), Some(high)) = (self.plate.min_m, self.plate.max_m) else {
            return;
        };
        let d = self.plate.spacing_m;
        let over = |p: &[f64; 3]| {
            let above = (0..2).all(|k| p[k] >= low[k] && p[k] <= high[k]);
            above && p[2] > low[2] - d
        };
        let kept: Vec<bool> = self.position.iter().map(over).collect();
        self.lost = kept.iter().filter(|k| !**k).count();
        if self.lost > 0 {
            self.retain(&kept);
        }
    }

    fn retain(&mut self, keep: &[bool]) {
        fn only<T: Copy>(values: &mut Vec<T>, keep: &[bool]) {
            let kept = values.iter().zip(keep).filter(|(_, k)| **k);
            *values = kept.map(|(v, _)| *v).collect();
        }
        only(&mut self.position, keep);
        only(&mut self.row, keep);
        only(&mut self.liquid, keep);
        only(&mut self.fused, keep);
        if let Some(temperature) = &mut self.temperature {
            only(temperature, keep);
        }
    }

    /// Whether a particle is of the plate or of the bead, and no spatter.
    pub(crate) fn belongs(&self, i: usize) -> bool {
        self.joined[i]
    }

    /// Whether particle `i` is slag.
    pub(crate) fn is_slag(&self, i: usize) -> bool {
        self.slag.get(self.row[i]).is_some_and(|slag| *slag)
    }

    /// Whether there is slag beside the metal.
    pub(crate) fn has_slag(&self) -> bool {
        !self.slag.is_empty()
    }

    /// Whether particle `i` has ever been liquid: from half of the latent heat on.
    pub(crate) fn was_liquid(&self, i: usize) -> bool {
        self.fused[i] >= 0.5
    }

    /// The particles as the measures need them.
    pub(crate) fn metal(&self) -> Metal<'_> {
        Metal {
            position: &self.position,
            fused: &self.fused,
            spacing: self.plate.spacing_m,
        }
    }

    /// Where the weld's centre plane is across \[m\]: that of the torches, of the source, or of the mirror; none without any of these.
    pub(crate) fn centre(&self) -> Option<f64> {
        let source = self.source.map(|source| self.way.across(source.place()));
        let mirror = self.mirror.filter(|_| self.way.in_plane());
        let mirror = mirror.map(|mirror| self.way.across([mirror.at(), 0.0]));
        self.way.line().or(source).or(mirror)
    }

    /// The plane that pictures go by \[m\]: the centre plane, or without one the middle of what has been fused.
    pub(crate) fn middle(&self) -> f64 {
        let fused = || self.extent(0, |i| self.was_liquid(i) && self.joined[i]);
        let all = || self.extent(0, |_| true);
        let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
        (self.centre()).unwrap_or_else(|| fused().or_else(all).map_or(0.0, middle))
    }

    /// A quantity of a picture with the coordinate that it is in the scene; without one where the weld is turned in the scene.
    pub(crate) fn titled(&self, words: &str, coordinate: &str) -> String {
        match self.way.is_y() {
            true => format!("{words} {coordinate} [mm]"),
            false => format!("{} [mm]", words.trim_end_matches(',')),
        }
    }

    /// The height as pictures call it.
    pub(crate) fn height(&self) -> String {
        match self.way.top().abs() > 0.0 {
            true => "height above the plate [mm]".to_owned(),
            false => "height z [mm]".to_owned(),
        }
    }

    /// A place along the weld, in words.
    pub(crate) fn placed(&self, place: &str) -> String {
        match self.way.is_y() {
            true => format!("y = {place}"),
            false => format!("a place along it of {place}"),
        }
    }

    /// What is to be said of a torch that leaves the line that sections are cut by; nothing where none does.
    pub(crate) fn strayed(&self) -> Option<String> {
        let off = 1e3 * self.way.strays()?;
        Some(format!(
            "The path of a torch strays {off:.1} mm from the line from its first corner to its last. Sections are cut across that line: \
             where the path runs at an angle to it, widths are too great by 1 over the cosine of that angle. Measure legs in runs of their own."
        ))
    }

    /// Where the source is along the weld \[m\].
    pub(crate) fn source_along(&self) -> Option<f64> {
        self.source.map(|source| self.way.along(source.place()))
    }

    /// The section across the weld at `place` \[m\], with its measures.
    pub(crate) fn section(&self, place: f64) -> (Section, Bead) {
        let near = |i: &usize| {
            self.joined[*i] && (self.position[*i][1] - place).abs() < SUPPORT * self.plate.spacing_m
        };
        let chosen: Vec<usize> = (0..self.position.len()).filter(near).collect();
        let position: Vec<[f64; 3]> = chosen.iter().map(|i| self.position[*i]).collect();
        let fused: Vec<f64> = chosen.iter().map(|i| self.fused[*i]).collect();
        let metal = Metal {
            position: &position,
            fused: &fused,
            spacing: self.plate.spacing_m,
        };
        let section = Section::cut(&metal, Plane::Across, place);
        let plate = bead::Base {
            centre: self.centre(),
            thickness: self.plate.thickness(),
            spacing: self.plate.spacing_m,
        };
        let bead = bead::measure(&section, plate);
        (section, bead)
    }

    /// Least and greatest coordinate `k` of the particles that `counts` names \[m\].
    fn extent(&self, k: usize, counts: impl Fn(usize) -> bool) -> Option<[f64; 2]> {
        let y = self.position.iter().enumerate().filter(|(i, _)| counts(*i));
        y.map(|(_, p)| p[k]).fold(None, |range, y| match range {
            None => Some([y, y]),
            Some([low, high]) => Some([low.min(y), high.max(y)]),
        })
    }

    /// Range along the weld worth showing \[m\]: what has been fused, with room, at least `LEAST_SHOWN`; all
    /// where that is most of the metal or where nothing has been fused.
    pub(crate) fn window(&self) -> Option<[f64; 2]> {
        let all = self.extent(1, |_| true)?;
        let Some([start, end]) = self.extent(1, |i| self.was_liquid(i) && self.joined[i]) else {
            return Some(all);
        };
        let more = (0.5 * (LEAST_SHOWN - (end - start))).max(ROOM);
        let window = [all[0].max(start - more), all[1].min(end + more)];
        let most = window[1] - window[0] > 0.75 * (all[1] - all[0]);
        Some(if most { all } else { window })
    }

    /// Measures of the bead along its frozen stretch; of the whole fused stretch, as far as it has
    /// come, when nothing has frozen.
    pub(crate) fn bead(&self) -> Option<Stretch> {
        let [start, end] = self.extent(1, |i| self.was_liquid(i) && self.joined[i])?;
        let step = 2.0 * self.plate.spacing_m;
        let liquid: Vec<f64> = (0..self.liquid.len())
            .filter(|i| self.liquid[*i] && self.joined[*i])
            .map(|i| self.position[i][1])
            .collect();
        let clear = |y: f64| liquid.iter().all(|l| (l - y).abs() > CLEAR);
        let from = start + RUN_IN;
        let to = end - RUN_IN;
        let count = ((to - from) / step).floor().max(-1.0) as i64;
        let mut places: Vec<f64> = (0..=count).map(|k| from + k as f64 * step).collect();
        let frozen = places.iter().take_while(|y| clear(**y)).count();
        places.truncate(frozen);
        if places.len() >= 3 {
            return Some(self.stretch(&places, true));
        }
        let count = ((end - start) / step).floor() as i64;
        let places: Vec<f64> = (0..=count).map(|k| start + k as f64 * step).collect();
        Some(self.stretch(&places, false))
    }

    fn stretch(&self, places: &[f64], frozen: bool) -> Stretch {
        let beads = places.iter().map(|y| (*y, self.section(*y).1)).collect();
        Stretch { frozen, beads }
    }
}

fn flags(frame: &Frame, name: &str) -> artefact::Result<Vec<bool>> {
    Ok(frame.u8(name)?.iter().map(|flag| *flag != 0).collect())
}
