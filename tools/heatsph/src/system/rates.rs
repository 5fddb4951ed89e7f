//! Heat into every point at an instant.

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use run::property::OutOfRange;

use super::System;
use super::conduction::{Conduction, Ends, Node, kirchhoff};
use crate::boundary::Passed;
use crate::material::arguments;
use crate::source::Warmth;
use shapes::frame::{Vector, difference};

/// Points that one task gathers.
const ROWS: usize = 256;
/// Temperatures nearer than this part of the greatest have one capacity.
const NEAR: f64 = 1e-9;

/// Heat at an instant.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rates {
    /// Heat into each point \[W\].
    pub heat: Vec<f64>,
    /// Sum of the conductances of each point, and of its films' slopes \[W/K\].
    pub stiffness: Vec<f64>,
    /// Least heat capacity of each cell between its temperature and those of its neighbours \[J/K\], where
    /// capacities depend on temperature.
    pub capacity: Vec<f64>,
    /// Heat through each entry of the surface \[W\]; of prescribed temperatures what their points pass on.
    pub entries: Vec<f64>,
    /// Heat of the source and of torches \[W\].
    pub source: f64,
    /// Whether peaks of a source or flux were too narrow to be found in their cells and patches.
    pub hidden: bool,
    /// Heat of the source at each point \[W\].
    sources: Vec<f64>,
    /// How temperature changes within cells, where the source depends on it.
    within: Vec<(Vector, [f64; 2])>,
    /// The time that this is of \[s\], and whether the source was resolved.
    sourced: Option<(f64, bool)>,
    pub(super) nodes: Vec<Node>,
    /// Mean conductivity of each link through several materials \[W/(m K)\].
    pub(super) means: Vec<f64>,
    pub(super) passed: Vec<Passed>,
}

impl System {
    /// Evaluates conductivities at the points.
    fn nodes(&self, temperature: &[f64], nodes: &mut Vec<Node>) {
        let count = self.materials.conductors.len();
        nodes.clear();
        if count == 0 || self.conduction.is_fixed() {
            return;
        }
        nodes.resize(count * temperature.len(), (0.0, 0.0));
        nodes
            .par_chunks_mut(count)
            .zip(temperature)
            .with_min_len(ROWS)
            .for_each(|(nodes, t)| {
                for (node, conductor) in nodes.iter_mut().zip(&self.materials.conductors) {
                    *node = conductor.value_and_integral(*t);
                }
            });
    }

    /// The two ends of the link from i to j.
    #[inline]
    pub(super) fn ends<'a>(&self, i: usize, j: usize, t: &[f64], nodes: &'a [Node]) -> Ends<'a> {
        let of = |i: usize| {
            let count = self.materials.conductors.len();
            if nodes.is_empty() {
                &[][..]
            } else {
                &nodes[i * count..][..count]
            }
        };
        Ends {
            temperature: [t[i], t[j]],
            nodes: [of(i), of(j)],
            blur: self.blur,
        }
    }

    /// Least capacities: at the own temperature, and as a mean from there to the coldest and warmest neighbour.
    fn capacities(&self, temperature: &[f64], capacity: &mut Vec<f64>) {
        let Some(content) = self.storage.varies() else {
            return;
        };
        let blur = NEAR * temperature.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
        let least = |i: usize| {
            let row = &self.links.pattern.columns()[self.links.pattern.row(i)];
            let near = row.iter().map(|j| temperature[*j as usize]);
            let own = temperature[i];
            let (low, high) = near.fold((own, own), |(low, high), t| (low.min(t), high.max(t)));
            let (slope, heat) = content.at(i, own);
            [low, high].into_iter().fold(slope, |least, to| {
                if (to - own).abs() <= blur {
                    return least;
                }
                least.min((content.at(i, to).1 - heat) / (to - own))
            })
        };
        let points = (0..temperature.len()).into_par_iter().with_min_len(ROWS);
        points.map(least).collect_into_vec(capacity);
    }

    /// Heat at `time` with the given temperatures.
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn rates(
        &self,
        time: f64,
        temperature: &[f64],
        rates: &mut Rates,
    ) -> Result<(), OutOfRange> {
        self.nodes(temperature, &mut rates.nodes);
        self.pass(time, temperature, &mut rates.passed)?;
        rates.heat.resize(self.len(), 0.0);
        rates.stiffness.resize(self.len(), 0.0);
        let nodes = &rates.nodes;
        let ends = |[i, j]: [u32; 2]| self.ends(i as usize, j as usize, temperature, nodes);
        self.conduction.means(ends, &mut rates.means);
        let (nodes, means, passed) = (&rates.nodes, &rates.means, &rates.passed);
        rates
            .heat
            .par_iter_mut()
            .zip(&mut rates.stiffness)
            .enumerate()
            .with_min_len(ROWS)
            .for_each(|(i, (heat, stiffness))| {
                (*heat, *stiffness) = self.links_of(i, temperature, nodes, means);
                for passed in &passed[self.films[i] as usize..self.films[i + 1] as usize] {
                    *heat += passed.heat;
                    *stiffness -= passed.slope;
                }
            });
        self.capacities(temperature, &mut rates.capacity);
        let lost = temperature.iter().any(|t| !t.is_finite());
        // No formula is to blame for temperatures that are no numbers: who took the step finds them.
        if let (Some(i), false) = (rates.heat.iter().position(|heat| heat.is_nan()), lost) {
            return Err(OutOfRange::Formula {
                value: self.conductivity(i, temperature[i]),
                at: arguments(self.cloud.position[i], temperature[i], time),
            });
        }
        rates.source = 0.0;
        rates.hidden = rates.passed.iter().any(|passed| passed.hidden);
        if let Some(source) = &self.source {
            // Iterations at one instant meet the same source, unless it depends on temperature.
            let known = rates
                .sourced
                .filter(|(then, _)| then.to_bits() == time.to_bits());
            let resolved = match known.filter(|_| !source.depends_on("T")) {
                Some((_, resolved)) => resolved,
                None => {
                    rates.within.clear();
                    if source.depends_on("T") {
                        self.within(temperature, &mut rates.within);
                    }
                    let warmth = Warmth {
                        temperature,
                        cells: &rates.within,
                        time,
                    };
                    source.heat(&self.cloud, &self.links.volume, warmth, &mut rates.sources)?
                }
            };
            rates.sourced = Some((time, resolved));
            rates.hidden |= !resolved;
            for (heat, own) in rates.heat.iter_mut().zip(&rates.sources) {
                *heat += own;
                rates.source += own;
            }
        }
        self.torches(time, rates);
        self.entries(time, rates)
    }

    /// Heat of torches.
    fn torches(&self, time: f64, rates: &mut Rates) {
        if let Some(torches) = &self.torches {
            rates.source += torches.add(time, &self.cloud, &mut rates.heat);
        }
    }

    /// The slope of temperature in every cell \[K/m\], by least squares over its links, and the temperatures of the
    /// point and its neighbours, beyond which it does not go \[K\].
    pub(super) fn within(&self, temperature: &[f64], cells: &mut Vec<(Vector, [f64; 2])>) {
        let position = &self.cloud.position;
        let of = |i: usize| {
            let mut moments = Matrix3::<f64>::zeros();
            let mut rises = Vector3::<f64>::zeros();
            let (own, mut low, mut high) = (temperature[i], temperature[i], temperature[i]);
            for j in &self.links.pattern.columns()[self.links.pattern.row(i)] {
                let j = *j as usize;
                let d = Vector3::from(difference(position[j], position[i]));
                let weight = d.norm_squared().recip();
                moments += weight * d * d.transpose();
                rises += weight * (temperature[j] - own) * d;
                (low, high) = (low.min(temperature[j]), high.max(temperature[j]));
            }
            // In a plane nothing changes across it.
            let trace = moments.trace().max(f64::MIN_POSITIVE);
            let flat = Matrix3::from_diagonal_element(1e-12 * trace);
            let slope = (moments + flat)
                .try_inverse()
                .map(|inverse| inverse * rises);
            (slope.map_or([0.0; 3], Into::into), [low, high])
        };
        let points = (0..temperature.len()).into_par_iter().with_min_len(ROWS);
        points.map(of).collect_into_vec(cells);
    }

    /// Heat through films and from the source where the whole body has one temperature \[W\].
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn gained(&self, temperature: f64, rates: &mut Rates) -> Result<f64, OutOfRange> {
        self.rates(0.0, &vec![temperature; self.len()], rates)?;
        let films: f64 = rates.passed.iter().map(|passed| passed.heat).sum();
        Ok(films + rates.source)
    }

    /// Heat through the links of point `i`, and the sum of their conductances.
    #[inline]
    fn links_of(&self, i: usize, temperature: &[f64], nodes: &[Node], means: &[f64]) -> (f64, f64) {
        let row = self.links.pattern.row(i);
        let ends = &self.links.pattern.columns()[row.clone()];
        let weight = &self.links.weight[row.clone()];
        match &self.conduction {
            Conduction::Fixed(g) => gathered(temperature, i, ends, g[row].iter().copied()),
            Conduction::Kirchhoff {
                conductor,
                fraction,
            } => {
                let conductance = |(a, j): (&f64, &u32)| {
                    let ends = self.ends(i, *j as usize, temperature, nodes);
                    a * fraction * kirchhoff(&ends, *conductor)
                };
                gathered(
                    temperature,
                    i,
                    ends,
                    weight.iter().zip(ends).map(conductance),
                )
            }
            Conduction::Mixture(_) | Conduction::Series(_) => {
                let edges = self.conduction.edges_of(row);
                let conductance = |(a, edge): (&f64, &u32)| a * means[*edge as usize];
                gathered(
                    temperature,
                    i,
                    ends,
                    weight.iter().zip(edges).map(conductance),
                )
            }
        }
    }

    /// Heat through every film.
    fn pass(
        &self,
        time: f64,
        temperature: &[f64],
        passed: &mut Vec<Passed>,
    ) -> Result<(), OutOfRange> {
        passed.clear();
        for film in &self.surface.films {
            let i = film.point as usize;
            let k = |a: f64, b: f64| self.mean_conductivity(i, a, b);
            passed.push(self.surface.pass(film, temperature[i], time, k)?);
        }
        Ok(())
    }

    /// Heat through each entry.
    fn entries(&self, time: f64, rates: &mut Rates) -> Result<(), OutOfRange> {
        rates.entries.clear();
        rates.entries.resize(self.surface.conditions.len(), 0.0);
        for (film, passed) in self.surface.films.iter().zip(&rates.passed) {
            match film.entries.as_slice() {
                [entry] => rates.entries[*entry as usize] += passed.heat,
                entries => {
                    for entry in entries {
                        rates.entries[*entry as usize] +=
                            self.surface.part(film, *entry, *passed, time)?;
                    }
                }
            }
        }
        for held in &self.surface.held {
            rates.entries[held.entry as usize] -= rates.heat[held.point as usize];
        }
        Ok(())
    }
}

/// Heat through links of the given conductances from point `i` to the others, and the sum of these.
#[inline]
fn gathered(
    temperature: &[f64],
    i: usize,
    ends: &[u32],
    conductances: impl Iterator<Item = f64>,
) -> (f64, f64) {
    let (mut heat, mut stiffness) = (0.0, 0.0);
    for (j, g) in ends.iter().zip(conductances) {
        heat += g * (temperature[*j as usize] - temperature[i]);
        stiffness += g;
    }
    (heat, stiffness)
}
