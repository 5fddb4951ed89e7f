//! Where the source is, how fast it moves, and which phase of the droplet period a frame shows.

/// The source at the time of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// Time t \[s\].
    pub time: f64,
    /// Position x, y, z \[m\].
    pub position: [f64; 3],
    /// Phase t_c/T_c of the droplet period, 0..1.
    pub phase: f64,
    /// Number of the droplet period.
    pub droplet: i64,
}

/// Index of the phase, of `count` equal ones with midpoints k/count, after the origin of phases has
/// been moved to `origin`.
#[must_use]
pub fn bin(phase: f64, origin: f64, count: usize) -> usize {
    let turn = (phase - origin).rem_euclid(1.0);
    ((turn * count as f64 + 0.5).floor() as usize) % count.max(1)
}

/// Velocity of the source at frame `i` \[m/s\]: the secant between its neighbours in time.
#[must_use]
pub fn velocity(track: &[Source], i: usize) -> [f64; 3] {
    let before = track[i.saturating_sub(1)];
    let after = track[(i + 1).min(track.len() - 1)];
    let span = after.time - before.time;
    if span <= 0.0 {
        return [0.0; 3];
    }
    std::array::from_fn(|k| (after.position[k] - before.position[k]) / span)
}

/// Mean length of the droplet period over a track \[s\]; `None` when it spans no whole period.
#[must_use]
pub fn period(track: &[Source]) -> Option<f64> {
    let (first, last) = (track.first()?, track.last()?);
    let turns = (last.droplet - first.droplet) as f64 + last.phase - first.phase;
    (turns >= 1.0).then(|| (last.time - first.time) / turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(speed: f64) -> Vec<Source> {
        (0..21)
            .map(|i| {
                let time = 0.0025 * f64::from(i);
                let turn = time / 0.01 + 0.25;
                Source {
                    time,
                    position: [0.0, speed * time, 0.0],
                    phase: turn.fract(),
                    droplet: turn.floor() as i64,
                }
            })
            .collect()
    }

    #[test]
    fn phases_have_their_midpoints_at_whole_fractions() {
        for k in 0..8 {
            let middle = f64::from(k) / 8.0;
            assert_eq!(bin(middle, 0.0, 8), k as usize);
            assert_eq!(bin(middle + 0.062, 0.0, 8), k as usize);
            assert_eq!(bin(middle - 0.062, 0.0, 8), k as usize);
        }
        assert_eq!(bin(0.99, 0.0, 8), 0);
        assert_eq!(bin(0.25, 0.25, 8), 0);
        assert_eq!(bin(0.125, 0.25, 8), 7);
    }

    #[test]
    fn velocity_and_period_are_exact_for_steady_motion() {
        let track = track(5e-3);
        for i in [0, 7, 20] {
            assert!((velocity(&track, i)[1] - 5e-3).abs() < 1e-15);
        }
        assert!((period(&track).unwrap() - 0.01).abs() < 1e-12);
        assert!(period(&track[..2]).is_none());
    }
}
