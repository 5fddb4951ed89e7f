//! Slag that boils, and what becomes of its vapour.
//!
//! ```text
//! e_a = m_a (h_a - h_b),  h_a = h_b           where h_a is above h_b, the enthalpy at which slag boils
//! m_c h_c += sum over boiling a of e_a / N_a  for each of the N_a grains c that a touches
//! ```
//!
//! The heat e leaves with the vapour, or the vapour goes on through the pores of the bed and condenses on the first grains that are
//! cooler: a grain that boils itself passes it on in the next step. It goes one grain farther in a step, which is much faster than
//! heat is supplied, so that where it condenses does not hang on the step. The mass of the vapour is neglected. What touches no
//! other grain loses its vapour to the cavity.

use schemars::JsonSchema;
use serde::Deserialize;
use steps::Figure;

use super::lists::{Lists, ROWS};

/// What becomes of the vapour of slag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum VapourScene {
    /// It leaves with its heat.
    #[default]
    Leaves,
    /// It condenses on the grains behind, which get its heat.
    Condenses,
}

/// Slag that boils.
#[derive(Debug, Clone)]
pub(super) struct Vapour {
    /// h_b \[J/kg\].
    boiling: f64,
    condenses: bool,
    /// Heat that has left, and that has condensed on grains that did not boil \[J\].
    pub(super) sums: [f64; 2],
    /// e of each grain \[J\], the grains it goes to, and what each gets \[J\]; empty where nothing condenses.
    excess: Vec<f64>,
    ways: Vec<f64>,
    gained: Vec<f64>,
}

impl Vapour {
    pub(super) fn new(boiling: f64, fate: VapourScene) -> Self {
        Self {
            boiling,
            condenses: fate == VapourScene::Condenses,
            sums: [0.0; 2],
            excess: Vec::new(),
            ways: Vec::new(),
            gained: Vec::new(),
        }
    }

    /// The enthalpy that sets the temperature of a grain \[J/kg\]: no more than that at which it boils.
    pub(super) fn sensible(&self, enthalpy: f64) -> f64 {
        enthalpy.min(self.boiling)
    }

    /// Whether a grain boils or vapour has condensed on it in this step.
    pub(super) fn changes(&self, row: usize, enthalpy: f64) -> bool {
        enthalpy >= self.boiling || self.gained.get(row).is_some_and(|gained| *gained > 0.0)
    }

    /// Lets the grains of the chunks that `get` heat boil, of the masses `mass` \[kg\].
    pub(super) fn rise(&mut self, lists: &Lists, get: &[bool], mass: &[f64], enthalpy: &mut [f64]) {
        self.gained.clear();
        let boiling = self.boiling;
        let chunks = enthalpy.chunks(ROWS).zip(get).enumerate();
        let hot: Vec<usize> = chunks
            .filter(|(_, (_, gets))| **gets)
            .flat_map(|(c, (chunk, _))| {
                let rows = chunk.iter().enumerate();
                let rows = rows.filter(|(_, h)| **h > boiling);
                rows.map(move |(row, _)| c * ROWS + row)
            })
            .collect();
        if hot.is_empty() {
            return;
        }
        self.excess.clear();
        self.excess
            .resize(if self.condenses { mass.len() } else { 0 }, 0.0);
        for a in &hot {
            let e = mass[*a] * (enthalpy[*a] - boiling);
            enthalpy[*a] = boiling;
            match self.excess.get_mut(*a) {
                Some(excess) => *excess = e,
                None => self.sums[0] += e,
            }
        }
        if self.condenses {
            self.pass_on(lists, get, &hot);
            for ((h, gained), mass) in enthalpy.iter_mut().zip(&self.gained).zip(mass) {
                if *h < boiling {
                    self.sums[1] += gained;
                }
                *h += gained / mass;
            }
        }
    }

    /// Finds what each grain gets of the vapour of the `hot` ones.
    fn pass_on(&mut self, lists: &Lists, get: &[bool], hot: &[usize]) {
        let touches = |chunk: usize, place: usize| {
            let pair = &lists.chunks[chunk].pairs[place];
            let reached = get[chunk] && get[pair.other as usize / ROWS] && pair.touches();
            f64::from(u8::from(reached))
        };
        self.ways.resize(self.excess.len(), 0.0);
        self.gained.resize(self.excess.len(), 0.0);
        lists.sum(get, &mut self.ways, touches, |_, _| 1.0);
        let (excess, ways) = (&self.excess, &self.ways);
        lists.sum(get, &mut self.gained, touches, |_, a| {
            if excess[a] > 0.0 {
                excess[a] / ways[a]
            } else {
                0.0
            }
        });
        let free = hot.iter().filter(|a| ways[**a] <= 0.0);
        self.sums[0] += free.map(|a| excess[*a]).sum::<f64>();
    }

    /// Sums over the run.
    pub(super) fn figures(&self) -> impl Iterator<Item = Figure> {
        let figure = |name, value| Figure {
            name,
            unit: "J",
            value,
        };
        let condensed = figure("grain_vapour_condensed_j", self.sums[1]);
        let condensed = self.condenses.then_some(condensed);
        [figure("grain_vapour_j", self.sums[0])]
            .into_iter()
            .chain(condensed)
    }
}
