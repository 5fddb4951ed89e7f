//! Points across gaps: between two surfaces that face each other too near for the layers of either.
//!
//! Layers grow from a surface to the middle between it and the next one. Where the first of them would reach the middle,
//! one point or none would stand across the gap, and nodes of a lattice with neighbours much farther apart than that. There
//! points stand at quarters of the gap instead, on the normals of both surfaces: levels that follow both, as far apart
//! along the gap as the points of the surfaces are.

use shapes::frame::{Vector, along, direction, dot};

use super::Builder;
use super::layers::{Column, Gap, Layered, TOO_CLOSE};

/// Parts of a gap, between whose levels points stand.
const PARTS: u32 = 4;
/// Width of a gap over the thickness of the first layers up to which it is narrow.
const NARROW: f64 = 3.0;
/// Least width of a gap with points over that between points along it: no finer one is resolved.
const LEAST: f64 = 0.1;
/// Steps from a surface to the next one along a normal, and the part of a gap by which the last may miss it.
const STEPS: usize = 30;
const MISS: f64 = 1e-6;
/// Two surfaces face each other beyond this cosine of the angle between the normals out of the gap.
const FACING: f64 = 0.5;
/// Farthest first column from an axis over its spacing, beside which a line across a gap stands on the axis.
const BESIDE: f64 = 1.2;

/// A line across a gap, along which points stand.
struct Strand {
    from: Vector,
    way: Vector,
    gap: Gap,
    medium: u16,
    /// Distance to the next one \[m\].
    spacing: f64,
    foot: u32,
}

impl Builder {
    /// Finds the narrow gaps before columns, where layers are to stand.
    pub(crate) fn find_gaps(&self, columns: &mut [Column], plans: &[[Vec<f64>; 2]]) {
        for column in columns {
            let Some(own) = column.solid else { continue };
            let solid = &self.layout.solids[own];
            let scale = (column.seed.spacing / solid.spacing).min(1.0);
            for (side, plan) in plans[own].iter().enumerate() {
                let gap = |first: &f64| {
                    let (from, way) = (column.seed.place, column.way(side));
                    self.gap(column, side, from, way, NARROW * scale * first)
                };
                column.gap[side] = plan.first().and_then(gap);
            }
        }
    }

    /// The gap on one side of a column, along a way from a place, if it is not wider than `most`.
    fn gap(
        &self,
        column: &Column,
        side: usize,
        from: Vector,
        way: Vector,
        most: f64,
    ) -> Option<Gap> {
        let own = column.solid?;
        let (width, other) = self.beyond(own, from, way, most)?;
        // Surfaces that cross leave wedges.
        if width < LEAST * column.seed.spacing || self.cross(from, own, other) {
            return None;
        }
        let beyond = &self.layout.solids[other].body;
        let normal = beyond.normal(along(from, width, way), 1e-4 * column.seed.spacing);
        let facing = dot(normal, way);
        let middle = along(from, 0.5 * width, way);
        let open = self.layout.medium(middle) == column.media[side];
        (open && facing.abs() > FACING).then(|| Gap {
            width,
            back: normal.map(|n| -facing.signum() * n),
        })
    }

    /// How far the surface of another body than `own` is along a way from a place, at most `most`, and its number: no step is longer
    /// than the way to it is anywhere.
    fn beyond(&self, own: usize, from: Vector, way: Vector, most: f64) -> Option<(f64, usize)> {
        let others = (0..self.layout.solids.len()).filter(|k| *k != own);
        let reach = |k: usize| {
            let body = &self.layout.solids[k].body;
            let mut width = 0.0;
            for _ in 0..STEPS {
                let step = body.distance(along(from, width, way)).abs();
                width += step;
                if width > most {
                    return None;
                }
                if step <= MISS * width {
                    return Some((width, k));
                }
            }
            None
        };
        others.filter_map(reach).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Points across the narrow gaps, from the sides to the middle.
    pub(crate) fn gaps(&mut self, columns: &[Column]) {
        let mut strands = Vec::new();
        for column in columns {
            for (side, gap) in column.gap.iter().enumerate() {
                if let Some(gap) = gap {
                    strands.push(Strand {
                        from: column.seed.place,
                        way: column.way(side),
                        gap: *gap,
                        medium: column.media[side],
                        spacing: column.seed.spacing,
                        foot: column.foot,
                    });
                    strands.extend(self.on_the_axis(column, side, gap));
                }
            }
        }
        for level in 1..=PARTS / 2 {
            for strand in &strands {
                self.across(strand, f64::from(level) / f64::from(PARTS));
            }
        }
    }

    /// The line across a gap on an axis of symmetry beside a column, where surfaces have no point.
    fn on_the_axis(&self, column: &Column, side: usize, gap: &Gap) -> Option<Strand> {
        let seed = &column.seed;
        let crosses = seed.normal[1].abs() > FACING;
        if !self.layout.axisymmetric() || !crosses || seed.place[0] > BESIDE * seed.spacing {
            return None;
        }
        let body = &self.layout.solids[column.solid?].body;
        let sign = seed.normal[1].signum();
        let axis = [0.0, sign, 0.0];
        let near = [0.0, seed.place[1], 0.0];
        let from = along(near, -body.distance(near), axis);
        let way = if side == 0 { [0.0, -sign, 0.0] } else { axis };
        Some(Strand {
            from,
            way,
            gap: self.gap(column, side, from, way, 1.5 * gap.width)?,
            medium: column.media[side],
            spacing: seed.spacing,
            foot: column.foot,
        })
    }

    /// A point at a part of the width of a gap, unless another is near.
    fn across(&mut self, strand: &Strand, part: f64) {
        let (gap, flat) = (&strand.gap, strand.spacing);
        let place = along(strand.from, part * gap.width, strand.way);
        let normal = direction(std::array::from_fn(|k| {
            (1.0 - part) * strand.way[k] - part * gap.back[k]
        }));
        let across = gap.width / f64::from(PARTS);
        let crowded = self
            .occupied
            .any(place, TOO_CLOSE * flat, |_, offset, square| {
                let up = dot(offset, normal);
                let level = (square - up * up).max(0.0);
                (up / across).powi(2) + level / (flat * flat) < TOO_CLOSE * TOO_CLOSE
            });
        let beside = place[0] > 0.0 && place[0] < 0.3 * flat;
        if crowded || self.layout.axisymmetric() && beside {
            return;
        }
        self.occupied.push(place);
        self.layered(&Layered {
            place,
            normal,
            medium: strand.medium,
            across,
            along: flat,
            foot: strand.foot,
        });
    }
}

#[cfg(test)]
mod tests {
    use crate::cloud::{Class, Cloud, setup};
    use crate::scene::Scene;

    fn two_balls(apart: f64, points: &str) -> Cloud {
        let z = 1.0 + 0.5 * apart;
        let scene = format!(
            r#"{{"geometry": "space", "domain": {{"sphere": {{"centre_m": [0, 0, 0], "radius_m": 6}}}},
            "bodies": [
              {{"name": "a", "potential_v": 0, "shape": {{"sphere": {{"centre_m": [0, 0, -{z}], "radius_m": 1}}}}}},
              {{"name": "b", "potential_v": 1, "shape": {{"sphere": {{"centre_m": [0, 0, {z}], "radius_m": 1}}}}}}],
            "electrostatics": {{"outer": [{{"potential_v": 0}}]}}, "points": {points}}}"#
        );
        let scene: Scene = serde_json::from_str(&scene).unwrap();
        setup::cloud(&scene).unwrap()
    }

    /// Heights in the gap over its width there, of points between the balls and near their axis.
    fn levels(cloud: &Cloud, apart: f64, reach: f64) -> Vec<f64> {
        let inside = |i: &usize| cloud.class[*i] == Class::Inside(0);
        let level = |i: usize| {
            let [x, y, z] = cloud.position[i];
            let square = x * x + y * y;
            let half = 0.5 * apart + 1.0 - (1.0 - square).sqrt();
            (square < reach * reach && z.abs() < half).then_some(0.5 + 0.5 * z / half)
        };
        (0..cloud.len()).filter(inside).filter_map(level).collect()
    }

    #[test]
    fn points_stand_at_quarters_of_a_narrow_gap() {
        let levels = levels(&two_balls(0.01, r#"{"spacing_m": 0.2}"#), 0.01, 0.3);
        for quarter in [0.25, 0.5, 0.75] {
            let near = levels
                .iter()
                .filter(|l| (*l - quarter).abs() < 0.06)
                .count();
            assert!(near > 100, "{near} at {quarter}");
        }
        let between = |l: &&f64| [0.25, 0.5, 0.75].iter().all(|q| (*l - q).abs() > 0.06);
        assert_eq!(levels.iter().filter(between).count(), 0, "{levels:?}");
    }

    #[test]
    fn gaps_without_layers_stay_empty() {
        let points = r#"{"spacing_m": 0.2, "layers": {"outside": 0}}"#;
        assert!(levels(&two_balls(0.01, points), 0.01, 0.1).is_empty());
    }

    /// Where no gap is narrow the points of each ball are those that it has alone.
    #[test]
    fn balls_far_apart_have_the_points_that_they_have_alone() {
        let points = r#"{"spacing_m": 0.2, "layers": {"outside": 1}}"#;
        let [narrow, near, far] = [0.5, 0.61, 2.0].map(|apart| two_balls(apart, points));
        assert_eq!(near.counts.interface, far.counts.interface);
        assert_eq!(near.counts.layers, far.counts.layers);
        for (near, far) in near.surface.iter().zip(&far.surface) {
            assert_eq!((near.normal, near.area), (far.normal, far.area));
        }
        assert!(narrow.counts.layers != far.counts.layers);
    }
}
