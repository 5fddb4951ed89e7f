//! A grid of means, as a file of `mean-fields` holds it.

use artefact::{Reader, Table};

use crate::picture::heading::Heading;

/// A grid of means, in millimetres, with what the pictures need.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    pub(super) first: Vec<f64>,
    pub(super) second: Vec<f64>,
    pub(super) axes: [char; 2],
    pub(super) velocity: [Vec<f64>; 2],
    pub(super) temperature: Option<Vec<f64>>,
    pub(super) metal: Vec<bool>,
    pub(super) liquid: Vec<bool>,
    interval: Option<Vec<f64>>,
    heading: Heading,
    /// Phase of the droplet period; `None` for a mean over time.
    pub(crate) phase: Option<f64>,
    /// Frames averaged.
    pub(crate) frames: f64,
    /// Droplets averaged.
    pub(crate) drops: f64,
}

impl Field {
    /// Reads a table of `mean-fields`.
    ///
    /// # Errors
    /// When a column is absent.
    pub(crate) fn read(table: &Table) -> artefact::Result<Self> {
        let letter = |k: usize| {
            table
                .axes
                .get(k)
                .and_then(|a| a.name.chars().next())
                .unwrap_or('?')
        };
        let axes = [letter(0), letter(1)];
        let mm = |k: usize| -> Vec<f64> {
            let axis = table.axes.get(k).map(|a| a.values.as_slice());
            axis.unwrap_or_default().iter().map(|v| 1e3 * v).collect()
        };
        let velocity = |k: usize| {
            table
                .values(&format!("velocity_{}_m_s", axes[k]))
                .map(<[f64]>::to_vec)
        };
        let present = |name: &str| -> artefact::Result<Vec<bool>> {
            let counts = table.values(name)?;
            let most = counts.iter().copied().fold(0.0, f64::max);
            // Seen in at least a third of the frames that saw anything: not a chance visitor.
            Ok(counts
                .iter()
                .map(|c| *c > 0.0 && *c >= most / 3.0)
                .collect())
        };
        Ok(Self {
            first: mm(0),
            second: mm(1),
            axes,
            velocity: [velocity(0)?, velocity(1)?],
            temperature: table.values("temperature_k").ok().map(<[f64]>::to_vec),
            metal: present("frames_metal")?,
            liquid: present("frames_liquid")?,
            interval: table
                .values("velocity_interval_m_s")
                .ok()
                .map(<[f64]>::to_vec),
            heading: Heading::of(table),
            phase: table.scalar("phase").ok(),
            frames: table.scalar("frames").unwrap_or(0.0),
            drops: table.scalar("drops").unwrap_or(0.0),
        })
    }

    /// Every table of a channel.
    ///
    /// # Errors
    /// When a table cannot be read.
    pub(crate) fn all(reader: &Reader, channel: &str) -> artefact::Result<Vec<Self>> {
        (0..reader.count(channel))
            .map(|i| Self::read(&reader.table_at(channel, i)?))
            .collect()
    }

    pub(super) fn speed(&self, n: usize) -> f64 {
        self.velocity[0][n].hypot(self.velocity[1][n])
    }

    /// Speeds in the plane where there is liquid \[m/s\].
    pub(crate) fn speeds(&self) -> impl Iterator<Item = f64> {
        (0..self.liquid.len())
            .filter(|n| self.liquid[*n])
            .map(|n| self.speed(n))
    }

    /// Mean speed in the plane over the liquid, weighted by nothing but the grid \[m/s\].
    pub(crate) fn mean_speed(&self) -> Option<f64> {
        let (sum, count) = self.speeds().fold((0.0, 0.0), |(s, c), u| (s + u, c + 1.0));
        (count > 0.0).then(|| sum / count)
    }

    /// Half of the interval that holds the true mean velocity in 95 of 100 cases \[m/s\]: the median over the liquid.
    /// Nothing where the file tells none, or no part of the frames is independent of another.
    pub(crate) fn interval(&self) -> Option<f64> {
        let told = self.interval.as_deref()?.iter().zip(&self.liquid);
        let told = told.filter(|(half, liquid)| **liquid && **half > 0.0);
        let mut halves: Vec<f64> = told.map(|(half, _)| *half).collect();
        halves.sort_by(f64::total_cmp);
        halves.get(halves.len() / 2).copied()
    }

    pub(super) fn hottest(&self) -> impl Iterator<Item = f64> {
        let temperature = self.temperature.as_deref().unwrap_or_default();
        temperature
            .iter()
            .zip(&self.liquid)
            .filter(|(_, l)| **l)
            .map(|(t, _)| *t)
    }

    /// Whether the plane x = const lies along the weld, and y = const across it.
    pub(crate) fn is_usual(&self) -> bool {
        self.heading.is_along_y()
    }

    /// Whether the second axis runs to the right (seen from above, the usual welding direction does).
    pub(super) fn turned(&self) -> bool {
        self.axes == ['x', 'y']
    }

    /// Index and place of each grid point in the picture: right, up.
    pub(super) fn points(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        let rows = self.second.len();
        (0..self.first.len() * rows).map(move |n| {
            let (a, b) = (self.first[n / rows], self.second[n % rows]);
            (n, if self.turned() { [b, -a] } else { [a, b] })
        })
    }

    /// Velocity in the picture: right, up.
    pub(super) fn flow(&self, n: usize) -> [f64; 2] {
        let [u, v] = [self.velocity[0][n], self.velocity[1][n]];
        if self.turned() { [v, -u] } else { [u, v] }
    }

    /// Grid spacing \[mm\].
    pub(super) fn spacing(&self) -> f64 {
        match self.second.as_slice() {
            [a, b, ..] => b - a,
            _ => 1.0,
        }
    }

    pub(super) fn titles(&self) -> [String; 2] {
        let name = |axis: char| format!("{} [mm]", self.heading.axis(axis, true));
        if self.turned() {
            let up = match self.heading.is_along_y() {
                true => "across, -x [mm]",
                false => "-x [mm]",
            };
            [name('y'), up.to_owned()]
        } else {
            [name(self.axes[0]), name(self.axes[1])]
        }
    }

    /// Range to the right and upwards of what holds metal.
    pub(super) fn window(&self) -> Option<[[f64; 2]; 2]> {
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for (n, at) in self.points() {
            if self.metal[n] {
                for (r, v) in range.iter_mut().zip(at) {
                    *r = [r[0].min(v), r[1].max(v)];
                }
            }
        }
        let filled = range.iter().all(|r| r[0] < r[1]);
        filled.then(|| range.map(|r| [r[0] - 0.4, r[1] + 0.4]))
    }
}
