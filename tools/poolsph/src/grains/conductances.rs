//! Conductances of the contacts of grains, among each other and with metal.

use contact::Meeting;
use particles::{Set, sweep};
use rayon::prelude::*;
use run::property::OutOfRange;

use super::MASS;
use super::columns::{ENTHALPY, HELD, TEMPERATURE};
use super::conducting::Recent;
use super::heat::Heat;
use super::lists::{AT_ONCE, Lists, ROWS, Touch};
use super::metal::Metal;
use super::slow::Pass;
use crate::state::State;

/// Part of the longest stable step that is taken.
const PART: f64 = 0.5;

impl Heat {
    /// Finds the chunks that take part in a pass.
    fn find_busy(&mut self, set: &Set, lists: &Lists, metal: Option<&Metal>, pass: Pass<'_>) {
        let lit = self.lighting.rows().filter(|_| pass.shines());
        let held = set.column(&HELD).iter().enumerate();
        let held = held
            .filter(|(_, body)| **body > 0)
            .map(|(row, _)| row as u32);
        let beside = metal.map_or(&[][..], |metal| &metal.pairs);
        let beside = beside.iter().map(|pair| pair.near.row);
        let beside = beside.filter(|row| pass.takes_alone(*row as usize));
        self.busy.find(lists, pass, lit.chain(held).chain(beside));
    }

    /// Conductances of all contacts \[W/K\] and the longest step \[s\]; unless `alike`, but of those whose grains have one
    /// temperature: no heat goes through them in a step that nothing divides.
    pub(super) fn conduct(
        &mut self,
        set: &Set,
        state: &State,
        lists: &Lists,
        metal: Option<&mut Metal>,
        pass: Pass<'_>,
    ) -> Result<(), OutOfRange> {
        self.find_busy(set, lists, metal.as_deref(), pass);
        self.between(set, lists, pass)?;
        let mut sum = std::mem::take(&mut self.sum);
        sum.resize(set.len(), 0.0);
        self.gather(lists, &mut sum, |_, _| 1.0);
        let grains = self
            .conductor
            .sees(set, [set.column(&ENTHALPY), set.column(&TEMPERATURE)]);
        let of_metal = match metal.and_then(Metal::exchange) {
            Some((exchange, contacts)) => {
                exchange.conduct(contacts, &grains, pass, state, &mut sum)?
            }
            None => 0.0,
        };
        let least = self.caloric.least_heat();
        let masses = set.column(&MASS);
        let fastest = sweep::greatest(set.len(), |a| sum[a] / (masses[a] * least));
        self.sum = sum;
        let shine = self
            .lighting
            .fastest(set.column(&TEMPERATURE), |a| masses[a] * least);
        let rate = fastest.map_or(of_metal, |(_, rate)| rate.max(of_metal)) + shine;
        self.limit = PART / rate;
        Ok(())
    }

    /// Conductances of the contacts of grains with each other, by chunks.
    fn between(&mut self, set: &Set, lists: &Lists, pass: Pass<'_>) -> Result<(), OutOfRange> {
        let (busy, alike) = (&self.busy, self.alike);
        let mut all = std::mem::take(&mut self.conductance);
        let grains = self
            .conductor
            .sees(set, [set.column(&ENTHALPY), set.column(&TEMPERATURE)]);
        let pair = |recent: &mut Recent, a: usize, b: usize| -> Result<f64, OutOfRange> {
            let Some(meeting) = Meeting::of(&grains.grain(a), &grains.grain(b)) else {
                return Ok(0.0);
            };
            let mean = 0.5 * (grains.temperature[a] + grains.temperature[b]);
            let gas = recent.gas(&grains, mean)?;
            let k = recent.conductivities(&grains, [a, b]);
            Ok(grains.of_contact(&meeting, [a, b], k, gas))
        };
        all.resize_with(lists.chunks.len(), Vec::new);
        let chunks = all.par_iter_mut().zip(&lists.chunks).enumerate();
        let chunks = chunks.with_max_len(AT_ONCE);
        let done: Result<(), OutOfRange> = chunks
            .map(|(c, (conductance, chunk))| {
                conductance.clear();
                if !busy.conduct[c] {
                    return Ok(());
                }
                let mut recent = Recent::default();
                for other in &chunk.pairs {
                    let (a, b) = (c * ROWS + other.own as usize, other.other as usize);
                    let touching = other.state == Touch::Touching;
                    let [t, u] = [a, b].map(|row| grains.temperature[row].to_bits());
                    let h = if touching && (alike || t != u) && pass.takes(a, b) {
                        pair(&mut recent, a, b)?
                    } else {
                        0.0
                    };
                    conductance.push(h);
                }
                Ok(())
            })
            .collect();
        self.conductance = all;
        done
    }
}
