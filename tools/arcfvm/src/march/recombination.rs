//! The state of an arc, recombined from the last iterations (see [`Anderson`]).
//!
//! Temperatures, iron, velocities, pressure and the speed of the wire are asked what an iteration lacks; potential, mass
//! fluxes and temperatures of surfaces follow with the same coefficients, so that mass fluxes that balance go on doing so.

use artefact::Checkpoint;
use krylov::Anderson;

use crate::residual::Residuals;
use crate::solver::Arc;

/// Differences of iterations that are kept.
const DEPTH: usize = 10;
/// Part of its temperature by which a cell may be moved beyond the result of an iteration.
const FARTHEST: f64 = 0.1;
/// What the greatest residual may grow to, over the smallest before, until what came before is forgotten.
const GROWTH: f64 = 10.0;

/// Recombines the state of an arc.
#[derive(Debug, Clone)]
pub struct Recombination {
    anderson: Anderson,
    /// Of each value that is asked what it lacks.
    weights: Vec<f64>,
    /// The state that the next iteration begins from.
    start: Vec<f64>,
    /// What an iteration makes of it.
    result: Vec<f64>,
    /// What it lacks, weighed.
    lack: Vec<f64>,
    /// What is made of the last results.
    mixed: Vec<f64>,
    /// Smallest of the greatest residuals since the last beginning.
    best: f64,
}

/// One field of the state, and whether it is asked.
type Visit<'a> = &'a mut dyn FnMut(bool, &mut [f64]);

/// Goes through all fields of the state, those that are asked first.
fn fields(arc: &mut Arc, visit: Visit<'_>) {
    let Arc {
        electric,
        flowing,
        heating,
        vapour,
        feed,
        ..
    } = arc;
    if let Some(heating) = heating {
        visit(true, &mut heating.energy.temperature);
    }
    if let Some(vapour) = vapour {
        visit(true, &mut vapour.iron);
    }
    if let Some(flowing) = flowing {
        let flow = &mut flowing.flow;
        for field in [&mut flow.radial, &mut flow.axial, &mut flow.pressure] {
            visit(true, field);
        }
    }
    visit(true, std::slice::from_mut(feed));
    if let Some(flowing) = flowing {
        visit(false, &mut flowing.flow.mass_radial);
        visit(false, &mut flowing.flow.mass_axial);
    }
    if let Some(electric) = electric {
        visit(false, &mut electric.potential.value);
        visit(false, std::slice::from_mut(&mut electric.potential.drive));
    }
    if let Some(heating) = heating {
        for skin in &mut heating.energy.skins {
            visit(false, std::slice::from_mut(&mut skin.temperature));
        }
    }
}

/// Writes the state of `arc` to `out`.
fn gather(arc: &mut Arc, out: &mut Vec<f64>) {
    out.clear();
    fields(arc, &mut |_, field| out.extend_from_slice(field));
}

/// One over the greatest value of each field that is asked: so much of each counts alike.
fn weights(arc: &mut Arc) -> Vec<f64> {
    let mut weights = Vec::new();
    fields(arc, &mut |asked, field| {
        if asked {
            let most = field.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            let weight = if most > 0.0 { 1.0 / most } else { 0.0 };
            weights.extend(std::iter::repeat_n(weight, field.len()));
        }
    });
    weights
}

impl Recombination {
    /// Begins at the present state.
    #[must_use]
    pub fn new(arc: &mut Arc) -> Self {
        let mut start = Vec::new();
        gather(arc, &mut start);
        Self::from(Anderson::new(DEPTH), weights(arc), start)
    }

    fn from(anderson: Anderson, weights: Vec<f64>, start: Vec<f64>) -> Self {
        Self {
            anderson,
            weights,
            start,
            result: Vec::new(),
            lack: Vec::new(),
            mixed: Vec::new(),
            best: f64::INFINITY,
        }
    }

    /// Begins anew at the present state: the iteration is another from here on.
    fn renew(&mut self, arc: &mut Arc) {
        self.anderson.clear();
        self.best = f64::INFINITY;
        gather(arc, &mut self.start);
    }

    /// Gives `arc`, which an iteration has just left with `residuals`, the state that the next one begins from.
    pub fn recombine(&mut self, arc: &mut Arc, residuals: &Residuals) {
        let worst = residuals.worst();
        let reshaped = arc.boiled.is_some_and(|part| part > 0.0);
        if reshaped || worst > GROWTH * self.best {
            self.renew(arc);
            return;
        }
        self.best = self.best.min(worst);
        gather(arc, &mut self.result);
        let values = self.weights.iter().zip(&self.result).zip(&self.start);
        self.lack.clear();
        self.lack.extend(values.map(|((w, g), x)| w * (g - x)));
        self.mixed.clone_from(&self.result);
        self.anderson.next(&mut self.mixed, &self.lack);
        let part = self.part(arc);
        let mut at = 0;
        let mixed = &self.mixed;
        fields(arc, &mut |_, field| {
            for (value, mixed) in field.iter_mut().zip(&mixed[at..]) {
                *value += part * (mixed - *value);
            }
            at += field.len();
        });
        if let Some(vapour) = &mut arc.vapour {
            let iron = vapour.iron.iter_mut();
            iron.for_each(|y| *y = y.clamp(0.0, 1.0));
        }
        gather(arc, &mut self.start);
    }

    /// The part of the way to `mixed` that moves no temperature too far.
    fn part(&self, arc: &Arc) -> f64 {
        let Some(heating) = &arc.heating else {
            return 1.0;
        };
        // Temperatures stand first.
        let moves = heating.energy.temperature.iter().zip(&self.mixed);
        let farthest = moves.fold(0.0_f64, |most, (t, m)| most.max((m - t).abs() / t));
        (FARTHEST / farthest).min(1.0)
    }

    /// Puts what the next iteration needs into a checkpoint.
    ///
    /// # Errors
    /// When a value cannot be stored.
    pub fn keep(&self, c: &mut Checkpoint) -> artefact::Result<()> {
        c.put_f64("recombined", &self.anderson.memory());
        c.put_f64("recombined_weights", &self.weights);
        c.put_f64("recombined_start", &self.start);
        c.put_f64("recombined_best", &[self.best]);
        c.put_json("recombined_kept", &self.anderson.kept())
    }

    /// What a checkpoint holds of it.
    ///
    /// # Errors
    /// When a column is missing or damaged.
    pub fn restored(c: &mut Checkpoint) -> artefact::Result<Self> {
        let weights = c.f64("recombined_weights")?;
        let mut anderson = Anderson::new(DEPTH);
        let memory = c.f64("recombined")?;
        anderson.restore(&memory, c.json("recombined_kept")?, weights.len());
        let best = c.f64("recombined_best")?;
        let mut restored = Self::from(anderson, weights, c.f64("recombined_start")?);
        restored.best = best.first().copied().unwrap_or(f64::INFINITY);
        Ok(restored)
    }
}
