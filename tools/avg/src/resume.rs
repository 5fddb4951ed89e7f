//! Checkpoint of the averages so far, bit for bit.

use artefact::{Checkpoint, Error, Result};

use crate::average::Averaging;
use crate::ensemble::{Ensemble, Moments, Point};
use crate::heat_map::Sums;
use crate::parts::Estimate;
use crate::profile::Profile;

/// Means of a point without and with errors.
const MOMENTS: usize = 2;
const ESTIMATES: usize = 4;
/// Counts and sums of a mean with an error.
const COUNTS: usize = 4;
const SUMS: usize = 5;

/// Puts all that the averages depend on into a checkpoint: `done` frames are taken in.
///
/// # Errors
/// When a value does not serialise.
pub fn save(checkpoint: &mut Checkpoint, averaging: &Averaging<'_>, done: usize) -> Result<()> {
    checkpoint.put_u64("done", &[done as u64]);
    checkpoint.put_json("droplets", &averaging.seen)?;
    for (place, ensemble) in averaging.averages.ensembles.iter().enumerate() {
        let frames: Vec<u64> = ensemble.frames.iter().map(|n| u64::from(*n)).collect();
        let parts = || ensemble.points().flat_map(Point::moments);
        let counts: Vec<u64> = parts().map(|m| u64::from(m.count)).collect();
        let sums: Vec<f64> = parts().flat_map(|m| [m.mean, m.squares]).collect();
        let errors = || ensemble.points().flat_map(Point::estimates);
        let parted: Vec<u64> = errors().flat_map(|e| counts_of(&e)).collect();
        let weighed: Vec<f64> = errors().flat_map(|e| sums_of(&e)).collect();
        checkpoint.put_u64(&entry(place, "frames"), &frames);
        checkpoint.put_u64(&entry(place, "counts"), &counts);
        checkpoint.put_f64(&entry(place, "sums"), &sums);
        checkpoint.put_u64(&entry(place, "part_counts"), &parted);
        checkpoint.put_f64(&entry(place, "part_sums"), &weighed);
    }
    if let Some(profile) = &averaging.averages.profile {
        let parts = || profile.places.iter().chain(&profile.rings);
        let counts: Vec<u64> = parts().map(|m| u64::from(m.count)).collect();
        let sums: Vec<f64> = parts().flat_map(|m| [m.mean, m.squares]).collect();
        checkpoint.put_u64("profile.frames", &[u64::from(profile.frames)]);
        checkpoint.put_u64("profile.counts", &counts);
        checkpoint.put_f64("profile.sums", &sums);
    }
    if let Some(maps) = &averaging.maps {
        let sums = &maps.sums;
        let ids: Vec<u64> = sums.ids.iter().map(|id| u64::from(*id)).collect();
        checkpoint.put_u64("heat.ids", &ids);
        checkpoint.put_u64("heat.shown", &sums.shown);
        checkpoint.put_u64("heat.frames", &[sums.frames]);
        checkpoint.put_f64("heat.times", &sums.times);
        checkpoint.put_f64("heat.last", &sums.last.concat());
        checkpoint.put_f64("heat.cells", &sums.cells.concat());
        checkpoint.put_f64("heat.whole", &sums.whole.concat());
        checkpoint.put_f64("heat.beyond", &sums.beyond);
    }
    Ok(())
}

/// Takes back what [`save`] put; gives the number of frames that are taken in.
///
/// # Errors
/// When the checkpoint lacks a part, or a part is not as long as the averages.
pub fn restore(checkpoint: &mut Checkpoint, averaging: &mut Averaging<'_>) -> Result<usize> {
    averaging.seen = checkpoint.json("droplets")?;
    for (place, ensemble) in averaging.averages.ensembles.iter_mut().enumerate() {
        let frames = checkpoint.u64(&entry(place, "frames"))?;
        let counts = checkpoint.u64(&entry(place, "counts"))?;
        let sums = checkpoint.f64(&entry(place, "sums"))?;
        let parted = checkpoint.u64(&entry(place, "part_counts"))?;
        let weighed = checkpoint.f64(&entry(place, "part_sums"))?;
        let points = ensemble.points().count();
        let (moments, estimates) = (MOMENTS * points, ESTIMATES * points);
        let found = [
            frames.len(),
            counts.len(),
            sums.len(),
            parted.len(),
            weighed.len(),
        ];
        let expected = [
            ensemble.frames.len(),
            moments,
            2 * moments,
            COUNTS * estimates,
            SUMS * estimates,
        ];
        if found != expected {
            return Err(Error::Damaged {
                path: "checkpoint".into(),
                place: entry(place, "counts"),
                what: format!("lengths are {found:?}, of the averages {expected:?}"),
            });
        }
        fill(ensemble, &frames, kept(&counts, &sums));
        fill_errors(ensemble, &parted, &weighed);
    }
    if let Some(profile) = &mut averaging.averages.profile {
        restore_profile(checkpoint, profile)?;
    }
    if let Some(maps) = &mut averaging.maps {
        let sums = restore_heat(checkpoint, &maps.sums)?;
        maps.go_on(sums);
    }
    let done = checkpoint.u64("done")?;
    Ok(done.first().map_or(0, |n| narrow(*n) as usize))
}

fn fill(ensemble: &mut Ensemble, frames: &[u64], mut kept: impl Iterator<Item = Moments>) {
    for (own, n) in ensemble.frames.iter_mut().zip(frames) {
        *own = narrow(*n);
    }
    for point in ensemble.points_mut() {
        for moments in point.moments_mut() {
            *moments = kept.next().unwrap_or_default();
        }
    }
}

fn fill_errors(ensemble: &mut Ensemble, counts: &[u64], sums: &[f64]) {
    let (counts, _) = counts.as_chunks::<COUNTS>();
    let (sums, _) = sums.as_chunks::<SUMS>();
    let mut kept = counts.iter().zip(sums);
    for point in ensemble.points_mut() {
        for estimate in point.estimates_mut() {
            let Some((counts, sums)) = kept.next() else {
                return;
            };
            let [count, part, part_count, closed] = counts.map(narrow);
            let [mean, part_mean, weight, centre, squares] = *sums;
            *estimate = Estimate {
                count,
                mean,
                part,
                part_count,
                part_mean,
                closed,
                weight,
                centre,
                squares,
            };
        }
    }
}

fn counts_of(e: &Estimate) -> [u64; COUNTS] {
    [e.count, e.part, e.part_count, e.closed].map(u64::from)
}

fn sums_of(e: &Estimate) -> [f64; SUMS] {
    [e.mean, e.part_mean, e.weight, e.centre, e.squares]
}

fn restore_profile(checkpoint: &mut Checkpoint, profile: &mut Profile) -> Result<()> {
    let frames = checkpoint.u64("profile.frames")?;
    let counts = checkpoint.u64("profile.counts")?;
    let sums = checkpoint.f64("profile.sums")?;
    let moments = profile.places.len() + profile.rings.len();
    let found = (frames.len(), counts.len(), sums.len());
    let expected = (1, moments, 2 * moments);
    if found != expected {
        return Err(Error::Damaged {
            path: "checkpoint".into(),
            place: "profile.counts".to_owned(),
            what: format!("lengths are {found:?}, of the averages {expected:?}"),
        });
    }
    profile.frames = narrow(frames[0]);
    let own = profile.places.iter_mut().chain(&mut profile.rings);
    for (moments, kept) in own.zip(kept(&counts, &sums)) {
        *moments = kept;
    }
    Ok(())
}

fn restore_heat(checkpoint: &mut Checkpoint, fresh: &Sums) -> Result<Sums> {
    let (ways, cells) = (fresh.cells.len(), fresh.cells.concat().len());
    let ids = checkpoint.u64("heat.ids")?;
    let shown = checkpoint.u64("heat.shown")?;
    let frames = checkpoint.u64("heat.frames")?;
    let times = checkpoint.f64("heat.times")?;
    let last = checkpoint.f64("heat.last")?;
    let own = checkpoint.f64("heat.cells")?;
    let whole = checkpoint.f64("heat.whole")?;
    let beyond = checkpoint.f64("heat.beyond")?;
    let found = [
        shown.len(),
        frames.len(),
        times.len(),
        last.len(),
        own.len(),
        whole.len(),
        beyond.len(),
    ];
    let expected = [ids.len(), 1, 3, ways * ids.len(), cells, cells, ways];
    if found != expected {
        return Err(Error::Damaged {
            path: "checkpoint".into(),
            place: "heat.cells".to_owned(),
            what: format!("lengths are {found:?}, of the maps {expected:?}"),
        });
    }
    let by_way = |all: &[f64]| -> Vec<Vec<f64>> {
        let each = all.len() / ways.max(1);
        (0..ways)
            .map(|way| all[way * each..(way + 1) * each].to_vec())
            .collect()
    };
    Ok(Sums {
        ids: ids.into_iter().map(narrow).collect(),
        shown,
        frames: frames[0],
        last: by_way(&last),
        cells: by_way(&own),
        whole: by_way(&whole),
        beyond,
        times: [times[0], times[1], times[2]],
    })
}

/// Moments from their counts and their pairs of mean and squares.
fn kept<'a>(counts: &'a [u64], sums: &'a [f64]) -> impl Iterator<Item = Moments> + 'a {
    let (pairs, _) = sums.as_chunks();
    let pairs = counts.iter().zip(pairs);
    pairs.map(|(n, [mean, squares])| Moments {
        count: narrow(*n),
        mean: *mean,
        squares: *squares,
    })
}

/// What was a `u32` before.
fn narrow(n: u64) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

fn entry(place: usize, what: &str) -> String {
    format!("section.{place}.{what}")
}
