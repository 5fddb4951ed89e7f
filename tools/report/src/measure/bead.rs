//! Penetration, widths and reinforcement of one cross-section.
//!
//! Definitions, with the plate's original surface at height 0 and lines of one half as in
//! [`super::section`]:
//! - penetration: greatest depth of the fusion line (fused share of the metal = 1/2);
//! - fused width: greatest distance between its left and right end over all depths of at least
//!   half a spacing below the original surface;
//! - fused half-width: greatest distance of the fusion line from the weld's centre plane over the
//!   same depths;
//! - reinforcement: greatest height of the metal's surface (share of metal = 1/2), followed upwards
//!   from the plate without a gap, so that a drop in flight does not count;
//! - toe angle: that of the plate's surface and the line from each end of the bead, where the metal stands half a spacing
//!   high, to where it first stands half as high as its top, in the mean of both sides \[degrees\];
//! - bead width: greatest horizontal extent of the metal that stands higher than half a spacing;
//! - areas of fused metal below and of metal above the original surface, of the grid cells whose
//!   share is at least 1/2; dilution: the fused area below over the sum of both.

use super::section::Section;

/// Measures of a cross-section, in metres.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Bead {
    /// Greatest depth of the fusion line below the original surface \[m\].
    pub(crate) penetration: f64,
    /// Greatest width of the fused metal below the original surface \[m\].
    pub(crate) fused_width: f64,
    /// Greatest distance of fused metal from the centre plane below the original surface \[m\].
    pub(crate) fused_half_width: f64,
    /// Height of the top above the original surface \[m\].
    pub(crate) reinforcement: f64,
    /// Width of the metal above the original surface \[m\].
    pub(crate) bead_width: f64,
    /// Angle of the bead's foot \[degrees\]; 0 where the bead is no spacing high.
    pub(crate) toe_angle: f64,
    /// Area of metal above the original surface \[m2\].
    pub(crate) area_above: f64,
    /// Area of fused metal below the original surface \[m2\].
    pub(crate) area_below: f64,
}

impl Bead {
    /// Share of the fused plate in the whole bead.
    pub(crate) fn dilution(&self) -> f64 {
        let whole = self.area_above + self.area_below;
        if whole > 0.0 {
            self.area_below / whole
        } else {
            0.0
        }
    }
}

/// A measure as targets name it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Named {
    /// Its name.
    pub(crate) name: &'static str,
    /// Its unit.
    pub(crate) unit: &'static str,
    value: fn(&Bead) -> f64,
}

impl Named {
    /// Its value of a bead, in its unit.
    pub(crate) fn of(self, bead: &Bead) -> f64 {
        (self.value)(bead)
    }
}

/// Every measure of a bead.
pub(crate) const MEASURES: [Named; 9] = [
    named("penetration", "m", |b| b.penetration),
    named("fused_width", "m", |b| b.fused_width),
    named("fused_half_width", "m", |b| b.fused_half_width),
    named("reinforcement", "m", |b| b.reinforcement),
    named("bead_width", "m", |b| b.bead_width),
    named("toe_angle", "deg", |b| b.toe_angle),
    named("area_above", "m2", |b| b.area_above),
    named("area_below", "m2", |b| b.area_below),
    named("dilution", "1", Bead::dilution),
];

const fn named(name: &'static str, unit: &'static str, value: fn(&Bead) -> f64) -> Named {
    Named { name, unit, value }
}

/// The measure of that name.
pub(crate) fn measure_of(name: &str) -> Option<Named> {
    MEASURES.into_iter().find(|measure| measure.name == name)
}

/// Measures a section; `centre` is the weld's centre plane and `spacing` the particle spacing \[m\].
pub(crate) fn measure(section: &Section, centre: f64, spacing: f64) -> Bead {
    let rows = section.up.len();
    if rows < 2 || section.across.len() < 2 {
        return Bead::default();
    }
    let fraction = section.fused_fraction();
    let step = section.up[1] - section.up[0];
    let mut bead = Bead::default();
    let top: Vec<f64> = (0..section.across.len())
        .map(|i| surface(&section.up, &section.metal[i * rows..(i + 1) * rows]))
        .collect();
    for (i, height) in top.iter().enumerate() {
        let column = &fraction[i * rows..(i + 1) * rows];
        bead.penetration = bead.penetration.max(depth(&section.up, column));
        bead.reinforcement = bead.reinforcement.max(*height);
        for (k, z) in section.up.iter().enumerate() {
            let cell = step * step;
            if *z > 0.0 && *z < *height {
                bead.area_above += cell;
            } else if *z <= 0.0 && column[k] >= 0.5 && section.metal[i * rows + k] >= 0.5 {
                bead.area_below += cell;
            }
        }
    }
    if let Some((left, right)) = extent(&section.across, &top, spacing / 2.0) {
        bead.bead_width = right - left;
        if let Some((inner, far)) = extent(&section.across, &top, bead.reinforcement / 2.0)
            && bead.reinforcement > spacing
        {
            let rise = (bead.reinforcement - spacing) / 2.0;
            let angles = [inner - left, right - far].map(|run| rise.atan2(run).to_degrees());
            bead.toe_angle = 0.5 * (angles[0] + angles[1]);
        }
    }
    for k in (0..rows).filter(|k| section.up[*k] <= -0.5 * spacing + 1e-3 * step) {
        let row: Vec<f64> = (0..section.across.len())
            .map(|i| fraction[i * rows + k])
            .collect();
        if let Some((left, right)) = extent(&section.across, &row, 0.5) {
            bead.fused_width = bead.fused_width.max(right - left);
            let half = (right - centre).abs().max((left - centre).abs());
            bead.fused_half_width = bead.fused_half_width.max(half);
        }
    }
    bead
}

/// Greatest depth at which the fused share, from below, reaches one half; 0 if it never does.
fn depth(up: &[f64], fraction: &[f64]) -> f64 {
    for k in 0..up.len() - 1 {
        if up[k] > 0.0 {
            break;
        }
        if fraction[k + 1] >= 0.5 {
            return (-crossing([up[k], up[k + 1]], [fraction[k], fraction[k + 1]], 0.5)).max(0.0);
        }
    }
    0.0
}

/// Height at which the share of metal, upwards from the original surface, falls to one half;
/// 0 over the bare plate and beside it.
fn surface(up: &[f64], share: &[f64]) -> f64 {
    let first = up.partition_point(|z| *z <= 0.0);
    for k in first.max(1)..up.len() {
        if share[k] < 0.5 {
            if share[k - 1] < 0.5 {
                return 0.0;
            }
            return crossing([up[k - 1], up[k]], [share[k - 1], share[k]], 0.5).max(0.0);
        }
    }
    up[up.len() - 1].max(0.0)
}

/// Leftmost and rightmost place where the values reach `level`.
fn extent(axis: &[f64], values: &[f64], level: f64) -> Option<(f64, f64)> {
    let first = values.iter().position(|v| *v >= level)?;
    let last = values.iter().rposition(|v| *v >= level)?;
    let left = if first == 0 {
        axis[0]
    } else {
        crossing(
            [axis[first - 1], axis[first]],
            [values[first - 1], values[first]],
            level,
        )
    };
    let right = if last + 1 == axis.len() {
        axis[last]
    } else {
        crossing(
            [axis[last], axis[last + 1]],
            [values[last], values[last + 1]],
            level,
        )
    };
    Some((left, right))
}

/// Place between two points where the line through two values meets `level`.
fn crossing(at: [f64; 2], value: [f64; 2], level: f64) -> f64 {
    let rise = value[1] - value[0];
    if rise.abs() < f64::MIN_POSITIVE {
        return at[1];
    }
    at[0] + (at[1] - at[0]) * ((level - value[0]) / rise).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::measure::section::{Metal, Plane};

    const D: f64 = 0.5e-3;

    /// Part of the particle at `p` for which `inside` holds.
    fn share(p: [f64; 3], inside: impl Fn([f64; 3]) -> bool) -> f64 {
        const FINE: u32 = 6;
        let part = |n: u32| ((f64::from(n) + 0.5) / f64::from(FINE) - 0.5) * D;
        let cells = FINE.pow(3);
        let counted = (0..cells).filter(|c| {
            let off = [c % FINE, c / FINE % FINE, c / FINE / FINE].map(part);
            inside([p[0] + off[0], p[1] + off[1], p[2] + off[2]])
        });
        counted.count() as f64 / f64::from(cells)
    }

    /// A plate with a half-ellipsoid of fused metal below its surface and a cap above it, filled
    /// with particles whose lattice is shifted by `shift`.
    fn weld(half: f64, deep: f64, high: f64, shift: f64) -> (Vec<[f64; 3]>, Vec<f64>) {
        let mut position = Vec::new();
        let mut fused = Vec::new();
        let inside = |p: [f64; 3], up: f64| {
            (p[0] / half).powi(2) + (p[1] / 8e-3).powi(2) + (p[2] / up).powi(2) < 1.0
        };
        for i in -20..20 {
            for j in -3..3 {
                for k in -10..14 {
                    let place = |n: i32| (f64::from(n) + 0.5) * D;
                    let p = [place(i) + shift, place(j), place(k)];
                    if k < 0 {
                        position.push(p);
                        fused.push(share(p, |p| inside(p, deep)));
                    } else if inside(p, high) {
                        position.push(p);
                        fused.push(1.0);
                    }
                }
            }
        }
        (position, fused)
    }

    fn of(position: &[[f64; 3]], fused: &[f64]) -> Bead {
        let metal = Metal {
            position,
            fused,
            spacing: D,
        };
        measure(&Section::cut(&metal, Plane::Across, 0.0), 0.0, D)
    }

    fn found(half: f64, deep: f64, high: f64, shift: f64) -> Bead {
        let (position, fused) = weld(half, deep, high, shift);
        of(&position, &fused)
    }

    #[test]
    fn a_half_ellipsoid_is_measured_within_a_fraction_of_a_particle() {
        let mut mean = [0.0_f64; 4];
        let count = 24;
        for n in 0..count {
            let part = f64::from(n) / f64::from(count);
            let (half, deep, high) = (5e-3 + part * 1e-3, 2e-3 + part * 1e-3, 3e-3 + part * 1e-3);
            let bead = found(half, deep, high, 0.37 * part * D);
            // The width is defined half a spacing below the surface.
            let wide = 2.0 * half * (1.0 - (0.5 * D / deep).powi(2)).sqrt();
            let top = 2.0 * half * (1.0 - (0.5 * D / high).powi(2)).sqrt();
            let error = [
                bead.penetration - deep,
                bead.fused_width - wide,
                bead.reinforcement - high,
                bead.bead_width - top,
            ];
            // The fusion line is known to a part of a particle. The surface is that of whole
            // particles and may lie half a spacing off on each side of what is measured.
            let allowed = [0.15, 0.3, 0.55, 1.1];
            for ((sum, e), allowed) in mean.iter_mut().zip(error).zip(allowed) {
                assert!(e.abs() < allowed * D, "{error:?} m with half width {half}");
                *sum += e / f64::from(count);
            }
            assert!((bead.fused_half_width - bead.fused_width / 2.0).abs() < 0.15 * D);
        }
        for (mean, allowed) in mean.iter().zip([0.1, 0.2, 0.25, 0.25]) {
            assert!(mean.abs() < allowed * D, "mean error {mean} m");
        }
    }

    #[test]
    fn the_toe_angle_is_that_of_the_foot() {
        // A ridge whose sides rise straight: 3 mm over 6 mm.
        let rise = |half: f64| move |p: [f64; 3]| p[2] < 3e-3 * (1.0 - p[0].abs() / half);
        for half in [6e-3, 9e-3] {
            let (mut position, mut fused) = weld(1e-9, 1e-9, 1e-9, 0.0);
            for i in -20..20 {
                for (j, k) in (-3..3).flat_map(|j| (0..14).map(move |k| (j, k))) {
                    let p = [i, j, k].map(|n: i32| (f64::from(n) + 0.5) * D);
                    if rise(half)(p) {
                        position.push(p);
                        fused.push(1.0);
                    }
                }
            }
            let bead = of(&position, &fused);
            let exact = (3e-3_f64 / half).atan().to_degrees();
            assert!(
                (bead.toe_angle - exact).abs() < 3.0,
                "{} {exact}",
                bead.toe_angle
            );
        }
        assert!(found(1e-9, 1e-9, 1e-9, 0.0).toe_angle.abs() < 1e-12);
    }

    #[test]
    fn areas_and_dilution_are_those_of_the_ellipse() {
        let bead = found(5e-3, 2.5e-3, 3e-3, 0.0);
        let (below, above) = (0.5 * PI * 5e-3 * 2.5e-3, 0.5 * PI * 5e-3 * 3e-3);
        assert!(
            (bead.area_below / below - 1.0).abs() < 0.08,
            "{}",
            bead.area_below / below
        );
        assert!(
            (bead.area_above / above - 1.0).abs() < 0.08,
            "{}",
            bead.area_above / above
        );
        assert!((bead.dilution() - 2.5 / 5.5).abs() < 0.03);
    }

    #[test]
    fn a_bare_plate_has_no_bead_and_a_drop_in_flight_is_none() {
        let (mut position, mut fused) = weld(1e-9, 1e-9, 1e-9, 0.0);
        position.push([0.0, 0.0, 4e-3]);
        fused.push(1.0);
        let bead = of(&position, &fused);
        assert!(
            bead.penetration == 0.0 && bead.fused_width == 0.0,
            "{bead:?}"
        );
        assert!(
            bead.reinforcement < 0.05 * D && bead.bead_width == 0.0,
            "{bead:?}"
        );
    }

    #[test]
    fn nothing_measures_nothing() {
        assert_eq!(of(&[], &[]), Bead::default());
    }
}
