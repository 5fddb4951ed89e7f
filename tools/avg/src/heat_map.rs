//! Maps of the heat flux into metal, as seen from above (Komen 2019, figs 5.28 and 5.29).
//!
//! ```text
//! q(cell) = 1/(A (t_2 - t_1)) sum_a w_a (Q_a(t_2) - Q_a(t_1)),      sum over cells of w_a = 1
//! ```
//!
//! Q_a is the heat that particle a has got since the start, by one way. So the flux of a cell is exact in time however far
//! apart frames are, and a map loses nothing but what lies beyond it. w shares a particle between the cells around it
//! ([`Layout`]). Of an even flux on a lattice as fine as the cells each cell gets its own; one that is coarser by a twentieth
//! shows no more than half a per cent, but for the cells at the end. Metal that flows is counted where it lies at the later frame.
//!
//! Particles are known by their numbers. One that was in no frame before counts from zero if it came from the wire, and
//! else from the first frame that shows it: what it has got out of sight is not known.

use std::collections::HashMap;

use artefact::{Record, Table};

use crate::layout::Layout;
use crate::received::Received;

/// Channel of the maps; that of their mean over time has `/time_mean` behind it.
pub const HEAT_MAP: &str = "heat_map";

/// Maps of one interval after the other.
#[derive(Debug, Clone)]
pub struct HeatMaps {
    layout: Layout,
    /// Columns of the frames.
    ways: Vec<String>,
    pub(crate) sums: Sums,
    /// Row of each particle among the sums, by its number.
    rows: HashMap<u32, usize>,
}

/// What maps go on from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sums {
    /// Numbers of the particles, in the order in which they were first seen, `[n]`.
    pub(crate) ids: Vec<u32>,
    /// Number of the frame, from 1 on, that showed each last, `[n]`.
    pub(crate) shown: Vec<u64>,
    /// Frames taken in.
    pub(crate) frames: u64,
    /// Heat of each then \[J\], `[ways][n]`.
    pub(crate) last: Vec<Vec<f64>>,
    /// Heat of each cell in this interval, and since the first frame \[J\], `[ways][cells]`.
    pub(crate) cells: Vec<Vec<f64>>,
    pub(crate) whole: Vec<Vec<f64>>,
    /// Heat that came to metal beyond the map since the first frame \[J\], `[ways]`.
    pub(crate) beyond: Vec<f64>,
    /// Where this interval and the first one begin, and the time of the last frame \[s\].
    pub(crate) times: [f64; 3],
}

/// A map with its log time \[s\], and what is told of its places: channel and record.
pub type Told = (f64, Table, Vec<(String, Record)>);

impl HeatMaps {
    /// No frame taken in; `ways` are columns of the frames.
    #[must_use]
    pub fn new(layout: Layout, ways: Vec<String>) -> Self {
        let none = vec![vec![0.0; layout.len()]; ways.len()];
        let sums = Sums {
            last: vec![Vec::new(); ways.len()],
            beyond: vec![0.0; ways.len()],
            cells: none.clone(),
            whole: none,
            ..Sums::default()
        };
        Self {
            layout,
            ways,
            sums,
            rows: HashMap::new(),
        }
    }

    /// Goes on from `sums` of an earlier run.
    pub(crate) fn go_on(&mut self, sums: Sums) {
        self.rows = sums.ids.iter().copied().zip(0..).collect();
        self.sums = sums;
    }

    /// Takes in a frame at `time` \[s\]; gives the map of the interval that ends there, if one does.
    pub fn take(&mut self, seen: &Received, time: f64) -> Option<Told> {
        self.gather(seen);
        self.sums.frames += 1;
        if self.sums.frames == 1 {
            self.sums.times = [time; 3];
            return None;
        }
        self.sums.times[2] = time;
        // Half a nanosecond: times of frames are whole ones.
        (time - self.sums.times[0] >= self.layout.interval - 5e-10).then(|| self.told())
    }

    /// The map of the interval that has begun and is not full, if there is one.
    pub fn rest(&mut self) -> Option<Told> {
        let [from, _, last] = self.sums.times;
        (last > from).then(|| self.told())
    }

    /// Gives each cell the heat that particles have got since the last frame.
    fn gather(&mut self, seen: &Received) {
        let Sums {
            ids,
            shown,
            frames,
            last,
            cells,
            whole,
            beyond,
            ..
        } = &mut self.sums;
        for (n, id) in seen.id.iter().enumerate() {
            let row = *self.rows.entry(*id).or_insert(ids.len());
            let new = row == ids.len();
            if new {
                ids.push(*id);
                shown.push(0);
                last.iter_mut().for_each(|heat| heat.push(0.0));
            }
            let born = new && seen.droplet[n];
            let counts = *frames > 0 && (shown[row] == *frames || born);
            shown[row] = *frames + 1;
            for (way, heat) in seen.heat.iter().enumerate() {
                let gained = heat[n] - last[way][row];
                last[way][row] = heat[n];
                if !counts || gained == 0.0 {
                    continue;
                }
                for place in seen.places(n) {
                    let mut shares = self.layout.shares(place).peekable();
                    if shares.peek().is_none() {
                        beyond[way] += gained;
                    }
                    for (cell, part) in shares {
                        cells[way][cell] += part * gained;
                        whole[way][cell] += part * gained;
                    }
                }
            }
        }
    }

    /// The map of the interval up to now, which ends.
    fn told(&mut self) -> Told {
        let [from, _, to] = self.sums.times;
        let table = self.table(&self.sums.cells, [from, to]);
        let scale = 1.0 / (self.layout.side.powi(2) * (to - from));
        let places = self.layout.places.iter().map(|(name, place)| {
            let mut record = Record::new()
                .with("from_s", "s", from)
                .with("to_s", "s", to);
            for (way, cells) in self.ways.iter().zip(&self.sums.cells) {
                let shares = self.layout.shares(*place);
                let flux = shares.map(|(cell, part)| part * cells[cell]).sum::<f64>();
                record = record.with(&named(way), "W/m2", scale * flux);
            }
            (format!("/{HEAT_MAP}/{name}"), record)
        });
        let places = places.collect();
        self.sums.cells.iter_mut().for_each(|cells| cells.fill(0.0));
        self.sums.times[0] = to;
        (to, table, places)
    }

    /// Heat of cells \[J\] as fluxes over a span \[s\].
    fn table(&self, cells: &[Vec<f64>], [from, to]: [f64; 2]) -> Table {
        let Layout { centres, side, .. } = &self.layout;
        let scale = 1.0 / (side * side * (to - from));
        let axes = [("x_m", "m", &centres[0][..]), ("y_m", "m", &centres[1][..])];
        let mut table = Table::grid(&axes);
        for (way, cells) in self.ways.iter().zip(cells) {
            table = table.column(&named(way), "W/m2", cells.iter().map(|heat| scale * heat));
        }
        table
            .attribute("from_s", "s", from)
            .attribute("to_s", "s", to)
    }

    /// The mean over all intervals; none before two frames were taken in.
    #[must_use]
    pub fn mean(&self) -> Option<Table> {
        let [_, first, last] = self.sums.times;
        (last > first).then(|| self.table(&self.sums.whole, [first, last]))
    }

    /// Each way with the heat that all cells have got \[J\].
    pub fn totals(&self) -> impl Iterator<Item = (&str, f64)> {
        let ways = self.ways.iter().map(String::as_str);
        ways.zip(self.sums.whole.iter().map(|cells| cells.iter().sum()))
    }

    /// Each way with the heat that came to metal beyond the map \[J\], where any did.
    pub fn beyond(&self) -> impl Iterator<Item = (&str, f64)> {
        let ways = self.ways.iter().map(String::as_str);
        let all = ways.zip(self.sums.beyond.iter().copied());
        all.filter(|(_, heat)| *heat != 0.0)
    }

    /// Columns of the frames, one for each way of heat.
    #[must_use]
    pub fn ways(&self) -> &[String] {
        &self.ways
    }

    /// Number of cells, and of places.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.layout.len(), self.layout.places.len()]
    }

    /// Most maps of so many frames.
    #[must_use]
    pub fn most(&self, frames: usize) -> u64 {
        frames.saturating_sub(1) as u64
    }

    /// Memory of cells and of as many particles as given \[byte\].
    #[must_use]
    pub fn bytes(&self, particles: usize) -> u64 {
        let heat = self.ways.len() * (2 * self.layout.len() + particles);
        // Each particle's number, row and frame.
        (8 * heat + 28 * particles) as u64
    }

    /// Bytes of a map before it is compressed, about.
    #[must_use]
    pub fn map_bytes(&self) -> u64 {
        self.table(&self.sums.cells, [0.0, 1.0]).most_bytes() as u64
    }
}

/// Name of the flux of a way of heat.
fn named(way: &str) -> String {
    format!("{}_w_m2", way.strip_prefix("heat_").unwrap_or(way))
}

#[cfg(test)]
mod tests {
    use super::*;

    const D: f64 = 1e-3;

    fn maps(interval: f64) -> HeatMaps {
        let mut layout = Layout::new([[0.0, 8e-3], [0.0, 6e-3]], D, interval);
        layout.places = vec![("middle".to_owned(), [4.25e-3, 3.1e-3])];
        HeatMaps::new(layout, vec!["heat_from_powder".to_owned()])
    }

    /// Particles `apart` over `reach` \[m\], each with `heat` of its place \[J\].
    fn frame(apart: f64, reach: [f64; 2], heat: impl Fn([f64; 2]) -> f64) -> Received {
        let counts = reach.map(|reach| (reach / apart).round() as usize);
        let place: Vec<[f64; 2]> = (0..counts[0] * counts[1])
            .map(|n| [n / counts[1], n % counts[1]].map(|i| (i as f64 + 0.5) * apart))
            .collect();
        Received {
            mirror: None,
            id: (0..place.len() as u32).collect(),
            droplet: vec![false; place.len()],
            heat: vec![place.iter().map(|place| heat(*place)).collect()],
            place,
        }
    }

    fn column(table: &Table) -> &[f64] {
        table.values("from_powder_w_m2").unwrap()
    }

    #[test]
    fn an_even_flux_is_even_on_lattices_as_fine_and_a_little_coarser() {
        let flux = 3e5;
        for (apart, off) in [
            (D, 1e-12),
            (1.05 * D, 6e-3),
            (0.95 * D, 6e-3),
            (0.5 * D, 1e-12),
        ] {
            let reach = [8e-3, 6e-3].map(|reach| (reach / apart).round() * apart);
            let heat = |time: f64| move |_| flux * apart * apart * time;
            let mut maps = maps(0.0);
            let first = frame(apart, reach, heat(0.1));
            assert!(maps.take(&first, 0.1).is_none());
            let second = frame(apart, reach, heat(0.3));
            let (time, table, places) = maps.take(&second, 0.3).unwrap();
            assert!((time - 0.3).abs() < 1e-15);
            let cells = || column(&table).chunks(6);
            let inner = cells().take(7).skip(1).flat_map(|row| &row[1..5]);
            for value in inner {
                assert!((value / flux - 1.0).abs() < off, "{apart}: {value}");
            }
            // Of lattices that do not fit, what lies at the end counts for the last cell alone.
            let end = if off > 1e-3 { 0.06 } else { off };
            for value in cells().take(7).flat_map(|row| &row[..5]) {
                assert!((value / flux - 1.0).abs() < end, "{apart}: {value}");
            }
            let (channel, told) = &places[0];
            assert_eq!(channel, "/heat_map/middle");
            let value = told.get("from_powder_w_m2").unwrap();
            assert!((value / flux - 1.0).abs() < off, "{apart}: {value}");
        }
    }

    #[test]
    fn no_heat_is_lost_between_cells_whatever_lies_where() {
        let mut maps = maps(0.0);
        let at = |time: f64| {
            let mut seen = frame(0.37 * D, [6.5e-3, 4.5e-3], |[x, y]| {
                time * (1.0 + 4e2 * x - 3e2 * y)
            });
            for place in &mut seen.place {
                *place = place.map(|x| x + 0.6e-3);
            }
            seen
        };
        let all = at(1.0).heat[0].iter().sum::<f64>();
        for n in 0..4 {
            maps.take(&at(0.1 * f64::from(n)), 0.1 * f64::from(n));
        }
        let (_, found) = maps.totals().next().unwrap();
        assert!((found / (0.3 * all) - 1.0).abs() < 1e-12, "{found} {all}");
        let mean = maps.mean().unwrap();
        let sum = column(&mean).iter().sum::<f64>() * D * D * 0.3;
        assert!((sum / found - 1.0).abs() < 1e-12, "{sum} {found}");
    }

    #[test]
    fn heat_beyond_the_map_is_told_and_no_heat_is_lost_with_it() {
        let mut maps = maps(0.0);
        let seen = |heat: f64| Received {
            place: vec![[4.2e-3, 3.1e-3], [-2e-3, 3e-3]],
            id: vec![0, 1],
            droplet: vec![false; 2],
            heat: vec![vec![heat, 3.0 * heat]],
            mirror: None,
        };
        maps.take(&seen(0.0), 0.0);
        assert_eq!(maps.beyond().next(), None);
        maps.take(&seen(2.0), 1.0);
        let (_, within) = maps.totals().next().unwrap();
        let (way, beyond) = maps.beyond().next().unwrap();
        assert_eq!(way, "heat_from_powder");
        assert!((within - 2.0).abs() < 1e-12 && (beyond - 6.0).abs() < 1e-12);
    }

    #[test]
    fn the_ends_of_a_map_lose_nothing_and_places_there_are_told() {
        let mut layout = Layout::new([[0.0, 2.5e-3], [0.0, 2e-3]], D, 0.0);
        assert_eq!(layout.centres.each_ref().map(Vec::len), [3, 2]);
        layout.places = vec![("corner".to_owned(), [0.0, 2e-3])];
        let mut maps = HeatMaps::new(layout, vec!["heat_from_arc".to_owned()]);
        let corner = |heat: f64| Received {
            place: vec![[1e-5, 1.99e-3]],
            id: vec![0],
            droplet: vec![false],
            heat: vec![vec![heat]],
            mirror: None,
        };
        maps.take(&corner(0.0), 0.0);
        let (_, _, places) = maps.take(&corner(2.0), 1.0).unwrap();
        let (_, whole) = maps.totals().next().unwrap();
        assert!((whole - 2.0).abs() < 1e-12, "{whole}");
        let flux = places[0].1.get("from_arc_w_m2").unwrap();
        assert!((flux * D * D / 2.0 - 1.0).abs() < 1e-12, "{flux}");
    }

    #[test]
    fn half_a_weld_has_the_fluxes_of_the_whole() {
        let heat =
            |time: f64| move |[x, y]: [f64; 2]| time * (1.0 + (2e3 * (x - 4e-3)).powi(2) + 1e2 * y);
        let found = |half: bool| {
            let mut maps = maps(0.0);
            for time in [0.0, 0.1] {
                let mut seen = frame(D, [8e-3, 6e-3], heat(time));
                if half {
                    // The first rows are those of the lower half of x.
                    let kept = seen.id.len() / 2;
                    seen.id.truncate(kept);
                    seen.mirror = Some(4e-3);
                }
                if let Some((_, table, _)) = maps.take(&seen, time) {
                    return column(&table).to_vec();
                }
            }
            Vec::new()
        };
        let (half, whole) = (found(true), found(false));
        assert_eq!(half.len(), 48);
        for (half, whole) in half.iter().zip(&whole) {
            assert!((half / whole - 1.0).abs() < 1e-12, "{half} {whole}");
        }
    }

    #[test]
    fn intervals_end_with_the_frame_that_fills_them_and_the_last_with_the_frames() {
        let mut maps = maps(0.25);
        let seen = |time: f64| frame(D, [8e-3, 6e-3], move |_| time);
        let mut ends = Vec::new();
        for n in 0..6 {
            let time = 0.1 * f64::from(n);
            let told = maps.take(&seen(time), time);
            ends.extend(told.map(|(time, table, _)| (time, column(&table)[7])));
        }
        let rest = maps
            .rest()
            .map(|(time, table, _)| (time, column(&table)[7]));
        assert_eq!(ends.len(), 1);
        for ((time, flux), wanted) in ends.into_iter().chain(rest).zip([0.3, 0.5]) {
            assert!((time - wanted).abs() < 1e-12, "{time}");
            assert!((flux * D * D - 1.0).abs() < 1e-12, "{flux}");
        }
        assert!(maps.rest().is_none());
    }

    #[test]
    fn metal_from_the_wire_counts_from_zero_and_what_comes_into_view_from_there_on() {
        let mut maps = maps(0.0);
        let seen = |ids: &[u32], droplets: &[bool], heat: &[f64]| Received {
            place: vec![[4.5e-3, 3.5e-3]; ids.len()],
            mirror: None,
            id: ids.to_vec(),
            droplet: droplets.to_vec(),
            heat: vec![heat.to_vec()],
        };
        maps.take(&seen(&[0], &[false], &[5.0]), 0.0);
        // A drop is born, and metal comes into view.
        maps.take(
            &seen(&[0, 1, 2], &[false, false, true], &[6.0, 7.0, 0.5]),
            1.0,
        );
        // The drop is out of view and comes back.
        maps.take(&seen(&[0, 1], &[false, false], &[6.0, 7.25]), 2.0);
        maps.take(&seen(&[0, 2], &[false, true], &[6.0, 9.0]), 3.0);
        let (_, found) = maps.totals().next().unwrap();
        assert!((found - 1.75).abs() < 1e-12, "{found}");
    }
}
