//! Torches: heat sources that move along paths, in the volume or on the surface (crate `torch`).
//!
//! Each gives its points `W_i = eta P q_i V_i / sum q_j V_j`, or its patches of surface the same with their areas: its power is exact
//! at every instant, whatever the cloud. Of surfaces one behind the other the first on the way of a torch takes its heat. Steps follow it: none is longer than a torch takes for a part of its least half axis.

use rayon::prelude::*;
use run::Session;
use shapes::Body;
use torch::{Beyond, Torch};

use crate::boundary::shade::shaded;
use crate::cloud::{Cloud, Patch};

/// Points that one task weighs.
const ROWS: usize = 512;
/// Part of the least half axis by which a torch moves in a step at most.
const PART: f64 = 0.25;
/// Times at which what lies inside is looked at for the record.
const LOOKS: usize = 100;
/// Share of a distribution below which it is told how little lies inside.
const LITTLE: f64 = 0.95;
/// Part of its energy that a torch may lose untold.
const LOST: f64 = 0.01;
/// Shares below this are none.
const NONE: f64 = 1e-12;

/// The torches of a scene over a cloud.
#[derive(Debug, Clone, PartialEq)]
pub struct Torches {
    torches: Vec<Torch>,
    /// Volume of each point \[m3\].
    volume: Vec<f64>,
    /// Whether each patch lies in the shade of each torch; none where no patch does.
    shade: Vec<Vec<bool>>,
}

/// Share above which it is told that the whole of a distribution would be given more than once.
const MUCH: f64 = 1.05;

/// What lay inside of a torch's distribution while it burned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inside {
    /// Least share.
    pub least: f64,
    /// Greatest share.
    pub most: f64,
    /// Greatest spacing of the points that took most \[m\].
    pub spacing: f64,
    /// Energy of the torch \[J\].
    pub energy: f64,
    /// Of that not given to the body, about \[J\].
    pub lost: f64,
}

impl Torches {
    /// Torches over points of the given volumes \[m3\].
    #[must_use]
    pub fn new(torches: Vec<Torch>, volume: &[f64]) -> Self {
        Self {
            torches,
            volume: volume.to_vec(),
            shade: Vec::new(),
        }
    }

    /// The same over a body that shades itself.
    #[must_use]
    pub fn over(mut self, body: &Body, cloud: &Cloud) -> Self {
        let of = |torch: &Torch| {
            let into = torch.stand(torch.path.burns()[0]).axes[2];
            let shade = (!torch.is_deep()).then(|| shaded(body, cloud, into));
            shade.filter(|all| all.contains(&true)).unwrap_or_default()
        };
        self.shade = self.torches.iter().map(of).collect();
        self
    }

    /// All torches.
    #[must_use]
    pub fn all(&self) -> &[Torch] {
        &self.torches
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let shade: usize = self.shade.iter().map(Vec::len).sum();
        (8 * self.volume.len() + shade) as u64
    }

    /// Adds the heat of every point at a time \[W\]; gives its sum.
    pub fn add(&self, time: f64, cloud: &Cloud, heat: &mut [f64]) -> f64 {
        let mut sum = 0.0;
        for (number, torch) in self.torches.iter().enumerate() {
            let power = torch.power(time);
            if power > 0.0 {
                let (own, share) = self.weights(number, time, cloud);
                let part = part(torch, share);
                for (i, weight) in own {
                    let given = power * part * weight;
                    heat[i as usize] += given;
                    sum += given;
                }
            }
        }
        sum
    }

    /// Parts of the distribution of a torch at points, and their sum.
    fn weights(&self, number: usize, time: f64, cloud: &Cloud) -> (Vec<(u32, f64)>, f64) {
        let torch = &self.torches[number];
        let stand = &torch.stand(time);
        let own: Vec<(u32, f64)> = if torch.is_deep() {
            let of = |i: usize| {
                let (x, d) = (cloud.position[i], self.volume[i].cbrt());
                let near = torch.reaches(stand, x, d);
                near.then(|| (i as u32, torch.density(stand, x, d) * self.volume[i]))
            };
            let points = (0..self.volume.len()).into_par_iter().with_min_len(ROWS);
            points.filter_map(of).collect()
        } else {
            let shade = self.shade.get(number).map_or(&[][..], Vec::as_slice);
            let of = |(place, patch): (usize, &Patch)| {
                let d = patch.area.sqrt();
                let area = torch.faced(stand, patch.normal, patch.area);
                let lit = !shade.get(place).copied().unwrap_or(false);
                let near = lit && area > 0.0 && torch.reaches(stand, patch.place, d);
                near.then(|| (patch.point, torch.density(stand, patch.place, d) * area))
            };
            let patches = cloud.patches.par_iter().enumerate().with_min_len(ROWS);
            patches.filter_map(of).collect()
        };
        let sum = own.iter().map(|(_, weight)| weight).sum();
        (own, sum)
    }

    /// Instants around each start and end of an arc and each corner of its waveform until `end` \[s\]: the last before, and
    /// the first after.
    pub(crate) fn jumps(&self, end: f64) -> impl Iterator<Item = [f64; 2]> {
        let burns = self.torches.iter().flat_map(|torch| torch.path.burns());
        let within = burns.filter(move |t| *t > 0.0 && *t < end);
        let corners = self.torches.iter().flat_map(move |torch| {
            let [from, to] = torch.path.burns();
            let (from, to) = (from.max(0.0), to.min(end));
            let waveform = torch.waveform.iter();
            waveform.flat_map(move |wave| wave.corners(from, to))
        });
        within.map(|t| [t.next_down(), t]).chain(corners)
    }

    /// Begins of the time in which each torch burns and of that in which it does not, with the longest steps there \[s\].
    pub(crate) fn pieces(&self, end: f64) -> impl Iterator<Item = Vec<[f64; 2]>> {
        let of = move |torch: &Torch| {
            let [from, to] = torch.path.burns();
            let longest = PART * torch.shape.least() / torch.path.fastest();
            let all = [[0.0, f64::INFINITY], [from, longest], [to, f64::INFINITY]];
            let first = usize::from(from <= 0.0);
            let within = all.into_iter().skip(first).filter(|piece| piece[0] < end);
            within.collect::<Vec<_>>()
        };
        self.torches.iter().map(of)
    }

    /// The greatest difference of temperature that torches make between neighbouring points of a conductivity, about \[K\].
    pub(crate) fn range(&self, cloud: &Cloud, conductivity: f64) -> f64 {
        let d = cloud.spacing.iter().fold(f64::INFINITY, |m, s| m.min(*s));
        let of = |torch: &Torch| {
            let time = torch.path.burns()[0];
            let stand = torch.stand(time);
            let density = torch.most() * torch.density(&stand, stand.place, d);
            density * if torch.is_deep() { d * d } else { d } / conductivity
        };
        self.torches.iter().map(of).fold(0.0, f64::max)
    }

    /// What of each torch lay inside until `end` \[s\]; none of one that never burned.
    #[must_use]
    pub fn inside(&self, end: f64, cloud: &Cloud) -> Vec<Option<Inside>> {
        let of = |number: usize| {
            let torch = &self.torches[number];
            let [from, to] = torch.path.burns();
            let span = to.min(end) - from;
            let mut inside = Inside {
                least: 1.0,
                most: 0.0,
                spacing: 0.0,
                energy: 0.0,
                lost: 0.0,
            };
            for look in 0..LOOKS {
                let [begin, end] = [look, look + 1].map(|k| from + span * k as f64 / LOOKS as f64);
                let Some((energy, time)) = torch.energy(begin, end) else {
                    continue;
                };
                let (own, share) = self.weights(number, time, cloud);
                let greatest = own.iter().max_by(|a, b| a.1.total_cmp(&b.1));
                let spacing = greatest.map_or(0.0, |(i, _)| cloud.spacing[*i as usize]);
                inside.spacing = inside.spacing.max(spacing);
                inside.least = inside.least.min(share);
                inside.most = inside.most.max(share);
                inside.energy += energy;
                inside.lost += energy * (1.0 - part(torch, share) * share);
            }
            (span > 0.0).then_some(inside)
        };
        (0..self.torches.len()).map(of).collect()
    }

    /// Keeps what of each torch lay inside until `end` \[s\], and tells where it was little.
    pub fn close(&self, end: f64, cloud: &Cloud, session: &mut Session) {
        for (number, inside) in self.inside(end, cloud).into_iter().enumerate() {
            let Some(inside) = inside else {
                let from = self.torches[number].path.burns()[0];
                session.warn(format!(
                    "torches/{number}: never burned until the end at {end} s: it burns from {from} s on"
                ));
                continue;
            };
            session.closing(&format!("torch_{number}_inside_least"), "1", inside.least);
            session.closing(&format!("torch_{number}_lost"), "J", inside.lost);
            for told in self.told(number, inside) {
                session.warn(told);
            }
        }
    }

    /// What is to be told where less or more than all of a distribution lay inside, and where points widened it.
    #[must_use]
    pub fn told(&self, number: usize, inside: Inside) -> Vec<String> {
        let torch = &self.torches[number];
        let much = torch.beyond == Beyond::Lost && inside.most > MUCH;
        let much = much.then(|| {
            format!(
                "torches/{number}: metal lies behind it too, and takes part: {:.1} % of its heat would lie in the body, which \
                 takes the whole power and no more; a path on the surface has no metal behind it",
                100.0 * inside.most
            )
        });
        let blunt = torch.blunt(inside.spacing, "points/spacing_m");
        let blunt = blunt.map(|told| format!("torches/{number}: {told}"));
        let all = [self.little(number, inside), much, blunt];
        all.into_iter().flatten().collect()
    }

    /// What is to be told where less than all of a distribution lay inside, or where energy was lost.
    fn little(&self, number: usize, inside: Inside) -> Option<String> {
        let Inside { energy, lost, .. } = inside;
        let at = format!(
            "torches/{number}: as little as {:.1} % of its heat lies in the body",
            100.0 * inside.least
        );
        match self.torches[number].beyond {
            _ if lost <= LOST * energy && inside.least >= LITTLE => None,
            Beyond::Inside if lost <= LOST * energy => {
                Some(format!("{at}; what lies outside is given to it too"))
            }
            _ => Some(format!(
                "{at}; of about {energy:.4e} J the body takes {:.4e} J, and {lost:.4e} J are lost",
                energy - lost
            )),
        }
    }
}

/// What a part of the distribution is multiplied with: the whole power is given, or less.
fn part(torch: &Torch, share: f64) -> f64 {
    match torch.beyond {
        Beyond::Lost => 1.0 / share.max(1.0),
        Beyond::Inside if share > NONE => 1.0 / share,
        Beyond::Inside => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(spacing: f64, more: &str) -> Cloud {
        let body = r#"{"box": {"min_m": [-0.02, -0.02, -0.01], "max_m": [0.02, 0.02, 0]}}"#;
        let body = Body::new(&serde_json::from_str(body).unwrap(), 3);
        let points = format!(r#"{{"spacing_m": {spacing}{more}}}"#);
        Cloud::fill(&body, &serde_json::from_str(&points).unwrap(), 3).unwrap()
    }

    const DEEP: &str = r#"{"double_ellipsoid": {"half_width_m": 0.003, "depth_m": 0.002, "front_m": 0.002, "rear_m": 0.005}}"#;
    const DISC: &str = r#"{"gaussian": {"radius_m": 0.004}}"#;

    fn torch(shape: &str, start: [f64; 3], more: &str) -> Torch {
        let text = format!(
            r#"{{"power_w": 2000, "efficiency": 0.75, "shape": {shape},
            "path": {{"points_m": [{start:?}, [0.0, 0.02, 0.0]], "speed_m_s": 0.01}}{more}}}"#
        );
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn power_is_exact_on_irregular_points_at_every_spacing() {
        for (spacing, more) in [
            (0.004, ""),
            (0.002, ""),
            (0.002, r#", "jitter": 0.4, "seed": 3"#),
            (0.001, r#", "jitter": 0.3"#),
        ] {
            let cloud = cloud(spacing, more);
            for shape in [DEEP, DISC] {
                let torches = Torches::new(vec![torch(shape, [0.0; 3], "")], &cloud.share);
                for time in [0.0, 0.13, 1.0, 1.99] {
                    let mut heat = vec![0.0; cloud.position.len()];
                    let given = torches.add(time, &cloud, &mut heat);
                    let sum: f64 = heat.iter().sum();
                    assert!(
                        (sum / 1500.0 - 1.0).abs() < 1e-12,
                        "{spacing} {shape} {sum}"
                    );
                    assert!((given / sum - 1.0).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn energy_that_is_lost_by_a_hundredth_is_told_with_both_figures() {
        let torches = Torches::new(vec![torch(DISC, [0.0; 3], r#", "beyond": "lost""#)], &[]);
        let told = |lost: f64| {
            let inside = Inside {
                least: 0.96,
                most: 1.0,
                spacing: 1e-4,
                energy: 300.0,
                lost,
            };
            torches.told(0, inside)
        };
        assert!(told(2.9).is_empty(), "{:?}", told(2.9));
        let said = told(12.0);
        assert!(
            said.len() == 1 && said[0].contains("3.0000e2 J the body takes 2.8800e2 J"),
            "{said:?}"
        );
    }

    #[test]
    fn without_normalising_the_whole_lies_inside_and_half_beside_an_edge() {
        let lost = r#", "beyond": "lost""#;
        for shape in [DEEP, DISC] {
            // Points on the faces have half a cell, whose middle is not where the point is: a lattice inside them.
            let cloud = cloud(0.001, r#", "arrangement": "cut""#);
            let given = |start| {
                let torches = Torches::new(vec![torch(shape, start, lost)], &cloud.share);
                torches.add(0.0, &cloud, &mut vec![0.0; cloud.position.len()])
            };
            let whole = given([0.0; 3]);
            assert!((whole / 1500.0 - 1.0).abs() < 1e-3, "{shape}: {whole}");
            let mut aside = torch(shape, [0.02, 0.0, 0.0], lost);
            aside.path.points_m[1][0] = 0.02;
            let torches = Torches::new(vec![aside], &cloud.share);
            let inside = torches.inside(1e-3, &cloud)[0].unwrap();
            assert!((inside.least - 0.5).abs() < 2e-3, "{shape} {inside:?}");
            assert!(
                (inside.lost / (0.5 * 1500.0 * 1e-3) - 1.0).abs() < 5e-3,
                "{inside:?}"
            );
            assert!(torches.told(0, inside)[0].contains("lost"));
        }
    }

    #[test]
    fn metal_behind_a_torch_takes_no_more_than_the_whole_power() {
        let cloud = cloud(0.001, r#", "arrangement": "cut""#);
        let mut sunk = torch(DEEP, [0.0; 3], r#", "beyond": "lost""#);
        for corner in &mut sunk.path.points_m {
            corner[2] = -0.25 * 0.002;
        }
        let torches = Torches::new(vec![sunk], &cloud.share);
        let mut heat = vec![0.0; cloud.position.len()];
        let given = torches.add(0.0, &cloud, &mut heat);
        assert!((given / 1500.0 - 1.0).abs() < 1e-12, "{given}");
        let inside = torches.inside(1e-3, &cloud)[0].unwrap();
        // 1 + erf(sqrt(3)/4), on cells of half the depth.
        assert!((inside.most - 1.4597).abs() < 0.03, "{inside:?}");
        assert!(inside.lost.abs() < 1e-12, "{inside:?}");
        let told = torches.told(0, inside);
        assert!(told.len() == 1 && told[0].contains("no more"), "{told:?}");
    }

    #[test]
    fn a_plate_shades_the_one_below_it() {
        let body = r#"{"union": [{"box": {"min_m": [-0.02, -0.02, -0.01], "max_m": [0.02, 0.02, -0.006]}},
            {"box": {"min_m": [-0.02, -0.02, -0.004], "max_m": [0.02, 0.02, 0]}}]}"#;
        let body = Body::new(&serde_json::from_str(body).unwrap(), 3);
        let points = r#"{"spacing_m": 0.001, "arrangement": "cut"}"#;
        let cloud = Cloud::fill(&body, &serde_json::from_str(points).unwrap(), 3).unwrap();
        for beyond in ["lost", "inside"] {
            let disc = torch(DISC, [0.0; 3], &format!(r#", "beyond": "{beyond}""#));
            let torches = Torches::new(vec![disc], &cloud.share).over(&body, &cloud);
            let mut heat = vec![0.0; cloud.position.len()];
            torches.add(0.0, &cloud, &mut heat);
            let each = cloud.position.iter().zip(&heat);
            let upper: f64 = each.filter(|(x, _)| x[2] > -0.005).map(|(_, q)| q).sum();
            assert!((upper / 1500.0 - 1.0).abs() < 2e-3, "{beyond}: {upper}");
            let whole: f64 = heat.iter().sum();
            assert!((whole - upper).abs() <= 0.0, "{beyond}: {whole}");
            assert!(
                torches
                    .told(0, torches.inside(1e-3, &cloud)[0].unwrap())
                    .is_empty()
            );
        }
    }

    #[test]
    fn points_that_widen_a_torch_are_told() {
        for (spacing, told) in [(0.002, 0), (0.004, 1)] {
            let cloud = cloud(spacing, r#", "arrangement": "cut""#);
            let torches = Torches::new(vec![torch(DEEP, [0.0; 3], "")], &cloud.share);
            let inside = torches.inside(1e-3, &cloud)[0].unwrap();
            let found = torches.told(0, inside);
            let found = found.iter().filter(|what| what.contains("widen"));
            assert_eq!(found.count(), told, "{spacing}");
        }
    }

    #[test]
    fn steps_end_at_the_corners_of_pulses() {
        let wave =
            r#", "waveform": {"period_s": 0.5, "times_s": [0, 0.2, 0.2], "levels": [1, 1, 0]}"#;
        let torches = Torches::new(vec![torch(DEEP, [0.0; 3], wave)], &[1.0]);
        let mut jumps: Vec<_> = torches.jumps(1.0).collect();
        jumps.sort_by(|a, b| a[0].total_cmp(&b[0]));
        jumps.dedup();
        let middles: Vec<f64> = jumps.iter().map(|[a, b]| 0.5 * (a + b)).collect();
        for (found, asked) in middles.iter().zip([0.2, 0.5, 0.7]) {
            assert!((found - asked).abs() < 1e-12, "{middles:?}");
        }
        assert_eq!(middles.len(), 3);
    }

    #[test]
    fn steps_end_at_start_and_end_of_the_arc_and_follow_the_torch() {
        let mut torch = torch(DEEP, [0.0; 3], "");
        torch.path.start_s = 0.5;
        let torches = Torches::new(vec![torch], &[1.0]);
        let jumps: Vec<_> = torches.jumps(10.0).collect();
        assert_eq!(
            jumps,
            [[0.5_f64.next_down(), 0.5], [2.5_f64.next_down(), 2.5]]
        );
        let pieces = torches.pieces(10.0).next().unwrap();
        assert_eq!(pieces.len(), 3);
        assert!((pieces[1][1] - 0.25 * 0.002 / 0.01).abs() < 1e-12);
    }
}
