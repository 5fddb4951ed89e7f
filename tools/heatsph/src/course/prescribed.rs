//! Heat prescribed by fluxes and sources, integrated over time apart from the march, beside the heat delivered.

use std::sync::atomic::{AtomicBool, Ordering};

use quadrature::THREE;
use rayon::prelude::*;
use run::property::OutOfRange;

use super::Course;
use crate::boundary::Condition;
use crate::march::State;
use crate::source::Warmth;
use crate::system::System;

/// Largest difference of the heat delivered, over the heat prescribed.
pub const TOLERANCE: f64 = 1e-3;
/// Difference of two rules below which a stretch of time is not halved, over the whole integral: a fifth of what is judged.
/// Sources that move have sums over cells that scatter by more than rounding, and finer stretches would follow the scatter.
const EXACT: f64 = 0.2 * TOLERANCE;
/// Most halvings of a stretch.
const HALVINGS: u32 = 12;
/// Films and points that one task sums.
const ROWS: usize = 512;

/// What prescribes heat.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Giver {
    /// An entry of the surface.
    Entry(u32),
    /// The source with torches.
    Source,
}

/// Heat of one flux or source.
#[derive(Debug, Clone, PartialEq)]
pub struct Heat {
    /// Name of the entry, or `source`.
    pub name: String,
    /// Prescribed until the end \[J\].
    pub prescribed: f64,
    /// Delivered by the march \[J\].
    pub delivered: f64,
    /// Prescribed in magnitude, of which a difference is a part \[J\].
    pub gross: f64,
}

impl Heat {
    /// Whether what was delivered is what was prescribed.
    #[must_use]
    pub fn holds(&self) -> bool {
        (self.delivered - self.prescribed).abs() <= TOLERANCE * self.gross
    }
}

impl Course {
    /// Heat prescribed and delivered until the time of a state, of all that prescribes heat whatever the temperature;
    /// nothing once `halt` is set.
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn heat(
        &self,
        system: &System,
        state: &State,
        halt: &AtomicBool,
    ) -> Result<Option<Vec<Heat>>, OutOfRange> {
        if self.is_empty() {
            return Ok(Some(Vec::new()));
        }
        let conditions = system.surface.conditions.iter().enumerate();
        let fluxes = conditions.filter(|(_, c)| matches!(c, Condition::Flux(_)));
        let mut givers: Vec<_> = fluxes.map(|(e, _)| Giver::Entry(e as u32)).collect();
        let blind = |source: &crate::source::Source| !source.depends_on("T");
        let given = system.source.is_some() || system.torches.is_some();
        if given && system.source.as_ref().is_none_or(blind) {
            givers.push(Giver::Source);
        }
        let stretches = self.stretches(state.time);
        let each = givers.into_iter().map(|giver| {
            let (name, delivered) = match giver {
                Giver::Entry(e) => (
                    system.surface.names[e as usize].clone(),
                    state.entries[e as usize],
                ),
                Giver::Source => ("source".to_owned(), state.source),
            };
            let power = |time: f64| match halt.load(Ordering::Relaxed) {
                true => Ok((0.0, 0.0)),
                false => power(system, giver, time),
            };
            let (prescribed, gross) = integral(&power, &stretches)?;
            let heat = Heat {
                name,
                prescribed,
                delivered,
                gross,
            };
            // What was cut off is no integral.
            Ok((!halt.load(Ordering::Relaxed)).then_some(heat))
        });
        each.collect()
    }

    /// Stretches between jumps and begins of pieces, until `end` \[s\].
    fn stretches(&self, end: f64) -> Vec<[f64; 2]> {
        let mut marks: Vec<f64> = vec![0.0, end];
        for pieces in &self.pieces {
            marks.extend(pieces.iter().map(|piece| piece[0]));
        }
        marks.extend(self.jumps.iter().flatten());
        marks.retain(|t| *t <= end);
        marks.sort_by(f64::total_cmp);
        marks.dedup();
        let between = |[a, b]: &[f64; 2]| !self.jumps.contains(&[*a, *b]);
        let each = marks.windows(2).map(|w| [w[0], w[1]]);
        each.filter(between).collect()
    }
}

/// Integral of a power over stretches of time, and of its magnitude \[J\].
fn integral(
    power: &impl Fn(f64) -> Result<(f64, f64), OutOfRange>,
    stretches: &[[f64; 2]],
) -> Result<(f64, f64), OutOfRange> {
    let gauss = |[a, b]: [f64; 2]| -> Result<(f64, f64), OutOfRange> {
        let mut sum = (0.0, 0.0);
        for (s, weight) in THREE {
            let (net, gross) = power(a + s * (b - a))?;
            sum = (
                sum.0 + weight * (b - a) * net,
                sum.1 + weight * (b - a) * gross,
            );
        }
        Ok(sum)
    };
    let mut left = Vec::new();
    for stretch in stretches {
        left.push((*stretch, gauss(*stretch)?, 0));
    }
    let whole: f64 = left.iter().map(|(_, (_, gross), _)| gross).sum();
    let wanted = EXACT * whole / stretches.len().max(1) as f64;
    let mut sum = (0.0, 0.0);
    while let Some(([a, b], (net, gross), depth)) = left.pop() {
        let middle = 0.5 * (a + b);
        let halves = [[a, middle], [middle, b]];
        let [first, second] = [gauss(halves[0])?, gauss(halves[1])?];
        if depth >= HALVINGS || (first.0 + second.0 - net).abs() <= wanted.max(EXACT * gross) {
            sum = (sum.0 + first.0 + second.0, sum.1 + first.1 + second.1);
        } else {
            left.push((halves[1], second, depth + 1));
            left.push((halves[0], first, depth + 1));
        }
    }
    Ok(sum)
}

/// Power of a giver at `time`, and the sum of magnitudes \[W\].
fn power(system: &System, giver: Giver, time: f64) -> Result<(f64, f64), OutOfRange> {
    let sums: Vec<Result<(f64, f64), OutOfRange>> = match giver {
        Giver::Entry(entry) => {
            let Condition::Flux(flux) = &system.surface.conditions[entry as usize] else {
                return Ok((0.0, 0.0));
            };
            let films = system.surface.films.par_chunks(ROWS);
            let of = |films: &[crate::boundary::Film]| {
                let own = films.iter().filter(|f| f.entries.contains(&entry));
                sum(own.map(|f| Ok(f.area * flux.mean(f, time)?.0)))
            };
            films.map(of).collect()
        }
        Giver::Source => {
            let (cold, mut heat) = (vec![0.0; system.len()], vec![0.0; system.len()]);
            let cold = Warmth {
                temperature: &cold,
                cells: &[],
                time,
            };
            if let Some(source) = &system.source {
                source.heat(&system.cloud, &system.links.volume, cold, &mut heat)?;
            }
            if let Some(torches) = &system.torches {
                torches.add(time, &system.cloud, &mut heat);
            }
            vec![sum(heat.into_iter().map(Ok))]
        }
    };
    let mut total = (0.0, 0.0);
    for part in sums {
        let (net, gross) = part?;
        total = (total.0 + net, total.1 + gross);
    }
    Ok(total)
}

fn sum(each: impl Iterator<Item = Result<f64, OutOfRange>>) -> Result<(f64, f64), OutOfRange> {
    let mut total = (0.0, 0.0);
    for value in each {
        let value = value?;
        total = (total.0 + value, total.1 + value.abs());
    }
    Ok(total)
}
