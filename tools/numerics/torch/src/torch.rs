//! A torch: what it gives to each point at a time.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shapes::frame::{Vector, along, cross, dot, length, unit};

use crate::misfit::Misfit;
use crate::path::Path;
use crate::shape::Shape;
use crate::waveform::Waveform;

/// What becomes of the part of the distribution that lies outside the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "TorchBeyond")]
pub enum Beyond {
    /// It is given to what lies inside: the body takes the whole power.
    #[default]
    Inside,
    /// It is lost, and reported. Beside a mirror plane along the path it is the half behind the mirror. Where metal lies behind the
    /// torch too, the body takes the whole power, and no more.
    Lost,
}

/// A heat source that moves along a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Torch {
    /// P \[W\].
    #[schemars(extend("x-unit" = "W", "exclusiveMinimum" = 0.0))]
    pub power_w: f64,
    /// eta: part of the power that is given to the body.
    #[serde(default = "whole")]
    #[schemars(range(max = 1.0), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub efficiency: f64,
    /// Factor on its power over time, repeated every period; always 1 if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waveform: Option<Waveform>,
    /// Where it goes, and when it burns.
    pub path: Path,
    /// Where it points: into the body. Any length; down, (0, 0, -1), if absent.
    #[serde(default = "down")]
    #[schemars(extend("x-unit" = "1"))]
    pub points_to: [f64; 3],
    /// How its heat is distributed.
    pub shape: Shape,
    /// What happens to the part of the heat that falls outside the body.
    #[serde(default)]
    pub beyond: Beyond,
}

fn whole() -> f64 {
    1.0
}

fn down() -> [f64; 3] {
    [0.0, 0.0, -1.0]
}

/// Part of the greatest heat of a shape below which it is told that points widen it: a Gaussian of 0.87 spacings has it.
const SHOWN: f64 = 0.6;

/// Where a torch stands: its place and its own axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stand {
    /// On its path, with the weave \[m\].
    pub place: Vector,
    /// Ahead, across, and into the body.
    pub axes: [Vector; 3],
}

impl Torch {
    /// What a schema cannot tell of it.
    #[must_use]
    pub fn misfits(&self) -> Vec<Misfit> {
        let mut found = Vec::new();
        let mut add = |path: &str, what: String| {
            let path = path.to_owned();
            found.push(Misfit { path, what });
        };
        let path = &self.path;
        if path.points_m.len() > 1 && path.speed_m_s.is_none() {
            add(
                "/path",
                "needs the key 'speed_m_s' in m/s, as it has more than one corner".to_owned(),
            );
        }
        if path.points_m.len() > 1 && path.length() <= 0.0 {
            add(
                "/path/points_m",
                "has no length: all corners are one".to_owned(),
            );
        }
        if let Some(end) = path.end_s.filter(|end| *end <= path.start_s) {
            let what = format!("{end} s is not after the start at {} s", path.start_s);
            add("/path/end_s", what);
        }
        if let Some(misfit) = self.waveform.as_ref().and_then(Waveform::misfit) {
            add(&format!("/waveform{}", misfit.path), misfit.what);
        }
        let Some(into) = unit(self.points_to) else {
            add(
                "/points_to",
                "has no direction: all components are zero".to_owned(),
            );
            return found;
        };
        let steep = path.points_m.windows(2).position(|leg| {
            unit(along(leg[1], -1.0, leg[0])).is_some_and(|way| dot(way, into).abs() > 0.999)
        });
        if let Some(leg) = steep {
            let what = format!(
                "leg {leg} of the path goes where the torch points, so that nothing is ahead or across"
            );
            add("/path/points_m", what);
        }
        found
    }

    /// Power that it gives at a time \[W\].
    #[must_use]
    pub fn power(&self, time: f64) -> f64 {
        let [from, to] = self.path.burns();
        if time >= from && time < to {
            let level = self.waveform.as_ref().map_or(1.0, |wave| wave.at(time));
            level * self.efficiency * self.power_w
        } else {
            0.0
        }
    }

    /// Energy that it gives between two times \[J\], and the middle of the time in which it burns; none where it does not.
    #[must_use]
    pub fn energy(&self, from: f64, to: f64) -> Option<(f64, f64)> {
        let burns = self.path.burns();
        let (from, to) = (from.max(burns[0]), to.min(burns[1]));
        if to <= from {
            return None;
        }
        let level = (self.waveform.as_ref()).map_or(1.0, |wave| wave.mean(from, to));
        let energy = level * self.efficiency * self.power_w * (to - from);
        (energy > 0.0).then_some((energy, 0.5 * (from + to)))
    }

    /// What is to be told of points of the spacing `d` \[m\] that show too little of its peak; `key` is that of the spacing.
    #[must_use]
    pub fn blunt(&self, d: f64, key: &str) -> Option<String> {
        let peak = self.shape.peak(d);
        (peak < SHOWN).then(|| {
            format!(
                "points {d:.3e} m apart widen it: its greatest heat is {:.3} % of what its shape asks for, its power is exact; \
                 its least half axis is {:.3e} m, and \"{key}\" of about that shows it",
                100.0 * peak,
                self.shape.least()
            )
        })
    }

    /// Greatest power at any time \[W\].
    #[must_use]
    pub fn most(&self) -> f64 {
        let level = self.waveform.as_ref().map_or(1.0, Waveform::most);
        level * self.efficiency * self.power_w
    }

    /// Where it stands at a time.
    #[must_use]
    pub fn stand(&self, time: f64) -> Stand {
        let into = unit(self.points_to).unwrap_or([0.0, 0.0, -1.0]);
        let level = |way: Vector| unit(along(way, -dot(way, into), into));
        let (place, way) = self.path.on(time);
        // A torch that stands looks along y, or along x where it points along y.
        let ahead = way.and_then(level).or_else(|| level([0.0, 1.0, 0.0]));
        let ahead = ahead
            .filter(|_| way.is_some() || into[1].abs() < 0.999)
            .or_else(|| level([1.0, 0.0, 0.0]))
            .unwrap_or([1.0, 0.0, 0.0]);
        let across = cross(into, ahead);
        Stand {
            place: along(place, self.path.aside(time), across),
            axes: [ahead, across, into],
        }
    }

    /// Whether it heats the volume, and not the surface.
    #[must_use]
    pub fn is_deep(&self) -> bool {
        matches!(self.shape, Shape::DoubleEllipsoid(_))
    }

    /// q over P at a place, as the mean over a cell or patch of the size `d` \[m\]: \[1/m3\] in the volume, \[1/m2\] across the torch.
    #[must_use]
    pub fn density(&self, stand: &Stand, place: Vector, d: f64) -> f64 {
        let away = along(place, -1.0, stand.place);
        let own = stand.axes.map(|axis| dot(away, axis));
        match &self.shape {
            Shape::DoubleEllipsoid(of) => of.density(own, d),
            Shape::Gaussian(of) => of.density(own[0].hypot(own[1]), d),
        }
    }

    /// Whether a place may get something, by its distance from the torch, or from its axis on a surface.
    #[must_use]
    pub fn reaches(&self, stand: &Stand, place: Vector, d: f64) -> bool {
        let away = along(place, -1.0, stand.place);
        let aside = match self.shape {
            Shape::DoubleEllipsoid(_) => away,
            Shape::Gaussian(_) => along(away, -dot(away, stand.axes[2]), stand.axes[2]),
        };
        length(aside) <= self.shape.reach(d)
    }

    /// Area across the torch of a patch of surface \[m2\]; none where it faces away.
    #[must_use]
    pub fn faced(&self, stand: &Stand, normal: Vector, area: f64) -> f64 {
        (area * -dot(normal, stand.axes[2])).max(0.0)
    }

    /// Corners of its way until `end` \[m\], with the weave.
    #[must_use]
    pub fn way(&self, end: f64) -> Vec<Vector> {
        /// Corners in a turn of the weave.
        const CORNERS: f64 = 16.0;
        /// Most corners.
        const MOST: f64 = 20_000.0;
        let [from, to] = self.path.burns();
        let to = to.min(end).max(from);
        let mut times: Vec<f64> = self.path.times().into_iter().filter(|t| *t < to).collect();
        if let Some(weave) = self.path.weave {
            let count = (CORNERS * weave.frequency_hz * (to - from))
                .ceil()
                .min(MOST);
            times.extend((0..count as u64).map(|k| from + k as f64 / count * (to - from)));
        }
        times.push(to);
        times.sort_by(f64::total_cmp);
        times.into_iter().map(|t| self.stand(t).place).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn torch(more: &str) -> Torch {
        let text = format!(
            r#"{{"power_w": 1000, "efficiency": 0.8, "path": {{"points_m": [[0, 0, 0], [0, 10, 0]], "speed_m_s": 1, "end_s": 4}},
            "shape": {{"double_ellipsoid": {{"half_width_m": 1, "depth_m": 0.5, "front_m": 0.8, "rear_m": 2}}}}{more}}}"#
        );
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn energy_is_that_of_the_time_in_which_it_burns() {
        let torch = torch("");
        assert_eq!(torch.energy(5.0, 6.0), None);
        assert_eq!(torch.energy(3.5, 4.5), Some((400.0, 3.75)));
        assert!((torch.power(1.0) - 800.0).abs() < 1e-12 && torch.power(4.0).abs() < 1e-12);
    }

    #[test]
    fn a_waveform_divides_the_power_over_time() {
        let wave =
            r#", "waveform": {"period_s": 0.5, "times_s": [0, 0.2, 0.2], "levels": [1, 1, 0.25]}"#;
        let torch = torch(wave);
        assert!((torch.power(1.1) - 800.0).abs() < 1e-9 && (torch.power(1.3) - 200.0).abs() < 1e-9);
        // 0.55 of the power over whole periods.
        let (energy, middle) = torch.energy(1.0, 3.0).unwrap();
        assert!((energy / (0.55 * 1600.0) - 1.0).abs() < 1e-12 && (middle - 2.0).abs() < 1e-12);
        assert!((torch.most() - 800.0).abs() < 1e-12);
        assert!(torch.misfits().is_empty());
    }

    #[test]
    fn turning_and_shifting_everything_changes_nothing() {
        let plain = torch("");
        // Turned by a right angle about x, and by an odd one about z, and shifted.
        let (sine, cosine) = 0.7_f64.sin_cos();
        let turn = |[x, y, z]: Vector| {
            let [x, y, z] = [x, -z, y];
            [cosine * x - sine * y, sine * x + cosine * y, z]
        };
        let shift = |x: Vector| along(turn(x), 1.0, [3.0, -2.0, 5.0]);
        let mut turned = plain.clone();
        turned.path.points_m = plain.path.points_m.iter().map(|x| shift(*x)).collect();
        turned.points_to = turn(plain.points_to);
        for place in [[0.3, 1.4, -0.2], [-0.5, 0.2, -0.1], [0.0, 2.0, 0.3]] {
            let [a, b] = [(&plain, place), (&turned, shift(place))].map(|(torch, x)| {
                let stand = torch.stand(1.2);
                torch.density(&stand, x, 0.4)
            });
            assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        }
    }

    #[test]
    fn what_is_wrong_is_told_at_its_key() {
        let found = |change: &dyn Fn(&mut Torch)| {
            let mut torch = torch("");
            change(&mut torch);
            torch
                .misfits()
                .into_iter()
                .map(|m| m.path)
                .collect::<Vec<_>>()
        };
        assert!(found(&|_| ()).is_empty());
        assert_eq!(found(&|t| t.path.speed_m_s = None), ["/path"]);
        assert_eq!(found(&|t| t.points_to = [0.0; 3]), ["/points_to"]);
        assert_eq!(
            found(&|t| t.points_to = [0.0, 1.0, 0.0]),
            ["/path/points_m"]
        );
        assert_eq!(found(&|t| t.path.end_s = Some(0.0)), ["/path/end_s"]);
    }

    #[test]
    fn points_that_are_too_coarse_for_a_shape_are_told() {
        let torch = torch("");
        assert_eq!(torch.blunt(0.3, "spacing_m"), None);
        let told = torch.blunt(5.0, "spacing_m").unwrap();
        assert!(
            told.contains("5.000e-1 m") && told.contains("spacing_m"),
            "{told}"
        );
    }

    #[test]
    fn a_surface_that_faces_away_gets_nothing() {
        let torch = torch("");
        let stand = torch.stand(0.0);
        assert!((torch.faced(&stand, [0.0, 0.6, 0.8], 2.0) - 1.6).abs() < 1e-15);
        assert!(torch.faced(&stand, [0.0, 0.0, -1.0], 2.0).abs() <= 0.0);
    }
}
