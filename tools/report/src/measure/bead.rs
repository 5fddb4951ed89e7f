//! Penetration, widths and reinforcement of one cross-section.
//!
//! Definitions, with the plate's original surface at height 0 and lines of one half as in
//! [`super::section`]:
//! - penetration: greatest depth of the fusion line (fused share of the metal = 1/2, where there is metal); the thickness of the plate
//!   where it is fused through, however far metal hangs below it;
//! - fused width: greatest distance between its left and right end over all depths of at least
//!   half a spacing below the original surface;
//! - fused half-width: greatest distance of the fusion line from the weld's centre plane over the
//!   same depths; half of the fused width where nothing says where that plane is;
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
    /// Whether the plate is fused through.
    pub(crate) through: bool,
}

/// What a section is measured by.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Base {
    /// The weld's centre plane, where it is known \[m\].
    pub(crate) centre: Option<f64>,
    /// Thickness of the plate, where it is known \[m\].
    pub(crate) thickness: Option<f64>,
    /// Particle spacing \[m\].
    pub(crate) spacing: f64,
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

/// Measures a section.
pub(crate) fn measure(section: &Section, base: Base) -> Bead {
    let spacing = base.spacing;
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
        bead.deepen(
            &section.up,
            column,
            &section.metal[i * rows..(i + 1) * rows],
            base,
        );
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
    bead.widen(section, &fraction, base);
    bead
}

impl Bead {
    /// Takes the depth of the fusion line in a column of the fused share and of the metal, and whether that is the plate's lower side.
    fn deepen(&mut self, up: &[f64], fused: &[f64], metal: &[f64], base: Base) {
        let Some((depth, lowest)) = depth(up, fused, metal) else {
            return;
        };
        let thickness = base
            .thickness
            .filter(|t| lowest && depth > t - base.spacing);
        self.through |= thickness.is_some();
        let depth = thickness.map_or(depth, |t| depth.min(t));
        self.penetration = self.penetration.max(depth);
    }

    /// Takes the widths of the fused metal below the original surface, and above the lower side of a plate that is fused through.
    fn widen(&mut self, section: &Section, fraction: &[f64], base: Base) {
        let (rows, spacing) = (section.up.len(), base.spacing);
        let step = section.up[1] - section.up[0];
        let lower = base.thickness.filter(|_| self.through);
        let counts = |z: f64| z <= -0.5 * spacing + 1e-3 * step && lower.is_none_or(|t| z >= -t);
        for k in (0..rows).filter(|k| counts(section.up[*k])) {
            let row: Vec<f64> = (k..fraction.len())
                .step_by(rows)
                .map(|n| fraction[n].min(section.metal[n]))
                .collect();
            if let Some((left, right)) = extent(&section.across, &row, 0.5) {
                self.fused_width = self.fused_width.max(right - left);
                let half = base.centre.map_or(0.5 * (right - left), |centre| {
                    (right - centre).abs().max((left - centre).abs())
                });
                self.fused_half_width = self.fused_half_width.max(half);
            }
        }
    }
}

/// Greatest depth at which the fused share, from below, reaches one half in metal, and whether no metal is below it; none if it never
/// does.
fn depth(up: &[f64], fused: &[f64], metal: &[f64]) -> Option<(f64, bool)> {
    let share = |k: usize| fused[k].min(metal[k]);
    for k in 0..up.len() - 1 {
        if up[k] > 0.0 {
            break;
        }
        if share(k + 1) >= 0.5 {
            let at = crossing([up[k], up[k + 1]], [share(k), share(k + 1)], 0.5);
            return Some(((-at).max(0.0), metal[k] < 0.5));
        }
    }
    None
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
mod tests;
