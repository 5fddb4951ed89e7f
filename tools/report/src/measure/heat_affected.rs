//! The heat-affected zone: metal that has not melted, and was hotter than an isotherm.
//!
//! The greatest temperature of each particle is found over all frames, in a slice across the weld half way along it. On the surface of
//! the plate and on the line below the weld, means over cells of a spacing are followed from the cold metal inwards: the isotherm is
//! where they first reach it, the fusion line where they first reach the melting point, both by linear interpolation. What is hottest
//! between two frames is not seen.

use artefact::Reader;

use crate::weld::{PARTICLES, Weld};

/// Ac1 of mild steel, 727 degrees Celsius \[K\].
pub(crate) const AC1: f64 = 1000.15;
/// Half thickness of the slice, in spacings.
const SLICE: f64 = 2.0;

/// Widths of the zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Zone {
    /// \[K\].
    pub(crate) isotherm: f64,
    /// Where the slice is along the weld \[m\].
    pub(crate) place: f64,
    /// Whether the weld runs along +y, so that the place is y.
    pub(crate) along_y: bool,
    /// On the surface, to the left of the direction of welding (lesser x along +y) \[m\]; none where the isotherm or the fusion
    /// line is not met.
    pub(crate) left: Option<f64>,
    /// To the right of it \[m\].
    pub(crate) right: Option<f64>,
    /// Below the weld \[m\].
    pub(crate) below: Option<f64>,
    /// Time between frames \[s\].
    pub(crate) interval: f64,
}

/// The zone of a weld; none of what is no weld, has one frame, or has not melted.
///
/// # Errors
/// A frame that cannot be read.
pub(crate) fn zone(reader: &Reader, isotherm: f64) -> artefact::Result<Option<Zone>> {
    let count = reader.count(PARTICLES);
    if count < 2 || !reader.has("/plate") {
        return Ok(None);
    }
    let last = reader.frame(PARTICLES, count - 1)?;
    if !(last.has("temperature") && last.has("fused") && last.has("id")) {
        return Ok(None);
    }
    let weld = Weld::read(reader, count - 1)?;
    let (Some(_), Some(melting)) = (weld.plate.max_m, weld.plate.melting_point_k) else {
        return Ok(None);
    };
    let melted = || {
        let own = (0..weld.position.len()).filter(|i| weld.was_liquid(*i) && weld.belongs(*i));
        own.map(|i| weld.position[i])
    };
    let ends = melted().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| {
        [a.min(p[1]), b.max(p[1])]
    });
    if ends[0] > ends[1] {
        return Ok(None);
    }
    let place = 0.5 * (ends[0] + ends[1]);
    let spacing = weld.plate.spacing_m;
    let near = |p: &[f64; 3]| (p[1] - place).abs() < SLICE * spacing && p[2] < 0.0;
    let chosen = (0..weld.position.len()).filter(|i| weld.belongs(*i) && near(&weld.position[*i]));
    let peaks = peaks(reader, count, last.u32("id")?)?;
    let slice: Vec<([f64; 2], f64)> = chosen
        .map(|i| {
            let [across, _, up] = weld.position[i];
            ([across, up], peaks[weld.row[i]])
        })
        .collect();
    let middle = melted().map(|p| p[0]).sum::<f64>() / melted().count() as f64;
    let times = [
        reader.time(PARTICLES, 0)?,
        reader.time(PARTICLES, count - 1)?,
    ];
    let [left, right, below] = widths(&slice, middle, spacing, [isotherm, melting]);
    Ok(Some(Zone {
        isotherm,
        place,
        along_y: weld.way.is_y(),
        left,
        right,
        below,
        interval: (times[1] - times[0]) / (count - 1) as f64,
    }))
}

/// Widths on the surface, towards lesser and greater x, and below the middle of the weld, of particles
/// at (across, up) with their peaks.
fn widths(
    slice: &[([f64; 2], f64)],
    middle: f64,
    spacing: f64,
    temperatures: [f64; 2],
) -> [Option<f64>; 3] {
    let surface = |side: f64| {
        let on = slice
            .iter()
            .filter(|(p, _)| p[1] > -spacing && side * (p[0] - middle) > 0.0);
        let line = on.map(|(p, t)| (side * (p[0] - middle), *t));
        width(line, spacing, temperatures)
    };
    let under = slice
        .iter()
        .filter(|(p, _)| (p[0] - middle).abs() < spacing);
    let line = under.map(|(p, t)| (-p[1], *t));
    [
        surface(-1.0),
        surface(1.0),
        width(line, spacing, temperatures),
    ]
}

/// Greatest temperature of the particles of these numbers over all frames \[K\].
fn peaks(reader: &Reader, count: usize, ids: &[u32]) -> artefact::Result<Vec<f64>> {
    let most = ids.iter().copied().max().map_or(0, |id| id as usize + 1);
    let mut peaks = vec![f64::NEG_INFINITY; most];
    for index in 0..count {
        let frame = reader.frame(PARTICLES, index)?;
        for (id, t) in frame.u32("id")?.iter().zip(frame.f64("temperature")?) {
            if let Some(peak) = peaks.get_mut(*id as usize) {
                *peak = peak.max(t);
            }
        }
    }
    Ok(ids.iter().map(|id| peaks[*id as usize]).collect())
}

/// Distance between the places where the greatest temperatures on a line, given by the distance from its beginning in the weld, first
/// reach the two temperatures from the far end \[m\].
fn width(
    line: impl Iterator<Item = (f64, f64)>,
    spacing: f64,
    [isotherm, melting]: [f64; 2],
) -> Option<f64> {
    let mut cells: Vec<[f64; 3]> = Vec::new();
    for (x, t) in line {
        let cell = (x / spacing).max(0.0) as usize;
        if cells.len() <= cell {
            cells.resize(cell + 1, [0.0; 3]);
        }
        let [n, places, peaks] = &mut cells[cell];
        (*n, *places, *peaks) = (*n + 1.0, *places + x, *peaks + t);
    }
    cells.retain(|[n, ..]| *n > 0.0);
    let means: Vec<[f64; 2]> = cells.iter().map(|[n, x, t]| [x / n, t / n]).collect();
    let reached = |t: f64| {
        let pair = means
            .windows(2)
            .rev()
            .find(|pair| pair[0][1] >= t && pair[1][1] < t)?;
        let [[near, hot], [far, cold]] = [pair[0], pair[1]];
        Some(near + (far - near) * (hot - t) / (hot - cold))
    };
    Some(reached(isotherm)? - reached(melting)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_fall_has_the_width_of_its_isotherms() {
        // From 2000 K at the weld, 200 K less for each 1e-3 m: 1750 K at 1.25e-3 and 1000 K at 5e-3.
        let line = (0..200).map(|k| {
            let x = (f64::from(k) + 0.5) * 5e-5;
            (x, 2000.0 - 2e5 * x)
        });
        let found = width(line, 5e-4, [1000.0, 1750.0]).unwrap();
        assert!((found - 3.75e-3).abs() < 1e-9, "{found}");
    }

    #[test]
    fn what_does_not_melt_has_no_zone() {
        let line = (0..20).map(|k| (f64::from(k), 1500.0 - 100.0 * f64::from(k)));
        assert_eq!(width(line, 1.0, [1000.0, 1750.0]), None);
    }
}
