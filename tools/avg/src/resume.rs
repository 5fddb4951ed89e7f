//! Checkpoint of the averages so far, bit for bit.

use artefact::{Checkpoint, Error, Result};

use crate::average::Averaging;
use crate::ensemble::{Ensemble, Moments, Point};
use crate::profile::Profile;

/// Moments of a point.
const MOMENTS: usize = 6;

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
        checkpoint.put_u64(&entry(place, "frames"), &frames);
        checkpoint.put_u64(&entry(place, "counts"), &counts);
        checkpoint.put_f64(&entry(place, "sums"), &sums);
    }
    if let Some(profile) = &averaging.averages.profile {
        let parts = || profile.places.iter().chain(&profile.rings);
        let counts: Vec<u64> = parts().map(|m| u64::from(m.count)).collect();
        let sums: Vec<f64> = parts().flat_map(|m| [m.mean, m.squares]).collect();
        checkpoint.put_u64("profile.frames", &[u64::from(profile.frames)]);
        checkpoint.put_u64("profile.counts", &counts);
        checkpoint.put_f64("profile.sums", &sums);
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
        let moments = MOMENTS * ensemble.points().count();
        let found = (frames.len(), counts.len(), sums.len());
        let expected = (ensemble.frames.len(), moments, 2 * moments);
        if found != expected {
            return Err(Error::Damaged {
                path: "checkpoint".into(),
                place: entry(place, "counts"),
                what: format!("lengths are {found:?}, of the averages {expected:?}"),
            });
        }
        fill(ensemble, &frames, &counts, &sums);
    }
    if let Some(profile) = &mut averaging.averages.profile {
        restore_profile(checkpoint, profile)?;
    }
    let done = checkpoint.u64("done")?;
    Ok(done.first().map_or(0, |n| narrow(*n) as usize))
}

fn fill(ensemble: &mut Ensemble, frames: &[u64], counts: &[u64], sums: &[f64]) {
    for (own, n) in ensemble.frames.iter_mut().zip(frames) {
        *own = narrow(*n);
    }
    let mut kept = kept(counts, sums);
    for point in ensemble.points_mut() {
        for moments in point.moments_mut() {
            *moments = kept.next().unwrap_or_default();
        }
    }
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
