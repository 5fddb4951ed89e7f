//! Torches: heat sources that move along paths, in the volume or on the surface (crate `torch`).
//!
//! ```text
//! m dh_a/dt = eta P w_a / sum_b w_b,     w_a = q_a V_a in the volume, q_a dA_a on the surface
//! ```
//!
//! The power is exact at every instant, whatever the particles. Of a torch upon a mirror half is here. The sum is the share of the distribution that lies in the metal.
//! A surface takes heat by its area across the torch, as far as the torch sees it ([`shade`](super::shade)); from above that is what
//! is seen of it. A step in which a torch would move by
//! more than a part of its least half axis is divided.

use particles::{Matter, POSITION};
use run::Fault;
use steps::Figure;
use torch::{Beyond, Stand, Torch};

use super::bounds::outside;
use super::chunks::Chunks;
use super::ledger::Sum;
use super::received::{self, FROM_TORCHES};
use super::shade::Shade;
use super::skin::Skin;
use super::substances::{Substance, Substances};
use crate::patch;
use crate::stage::{Stage, StageError};
use crate::state::slag::SLAG;
use crate::state::{ENTHALPY, State, TEMPERATURE};

/// Part of the least half axis by which a torch moves between two looks.
const PART: f64 = 0.25;
/// Nearer to a mirror than this, in spacings, a torch is upon it.
const UPON: f64 = 1e-3;
/// Shares below this are none.
const NONE: f64 = 1e-12;
/// Share of a distribution below which it is told how little lies in the metal.
const LITTLE: f64 = 0.95;
/// Part of its energy that a torch may lose untold.
const LOST: f64 = 0.01;
/// Share above which it is told that the whole of a distribution would be given more than once.
const MUCH: f64 = 1.05;
/// Down, within rounding.
const DOWN: f64 = -1.0 + 1e-12;

/// A torch and what became of its heat.
#[derive(Debug, Clone)]
struct Lit {
    torch: Torch,
    put: Sum,
    lost: Sum,
    /// Least share of its distribution that lay in the metal.
    least: f64,
    /// Greatest share.
    most: f64,
}

impl Lit {
    /// What is told where too little of its distribution lay in the metal, or too much of its energy was lost.
    fn little(&self) -> Option<String> {
        let [put, lost] = [self.put.value(), self.lost.value()];
        let all = put + lost;
        let at = format!(
            "as little as {:.1} % of its heat lies in the metal",
            100.0 * self.least
        );
        match self.torch.beyond {
            _ if lost <= LOST * all && self.least >= LITTLE => None,
            Beyond::Inside if lost <= LOST * all => {
                Some(format!("{at}; what lies outside is given to it too"))
            }
            _ => Some(format!(
                "{at}; of {all:.4e} J the metal takes {put:.4e} J, and {lost:.4e} J are lost"
            )),
        }
    }
}

/// Torches as a stage.
pub struct Torches {
    made: Substances,
    metal: Matter,
    torches: Vec<Lit>,
    /// All particles, of which a torch in the volume may heat any.
    all: Vec<u32>,
    weighed: Chunks<(u32, f64)>,
    own: Vec<(u32, f64)>,
    power: f64,
    parts: u64,
}

impl Torches {
    /// The torches of a scene.
    ///
    /// # Errors
    /// A fault at the key of a torch that is wrong.
    pub fn new(torches: &[Torch], made: Substances, metal: Matter) -> Result<Self, Vec<Fault>> {
        let misfits = torches.iter().enumerate().flat_map(|(number, torch)| {
            let at =
                move |m: torch::Misfit| Fault::at(&format!("/torches/{number}{}", m.path), m.what);
            torch.misfits().into_iter().map(at)
        });
        let faults: Vec<Fault> = misfits.collect();
        if !faults.is_empty() {
            return Err(faults);
        }
        let lit = |torch: &Torch| Lit {
            torch: torch.clone(),
            put: Sum::default(),
            lost: Sum::default(),
            least: 1.0,
            most: 0.0,
        };
        Ok(Self {
            made,
            metal,
            torches: torches.iter().map(lit).collect(),
            all: Vec::new(),
            weighed: Chunks::default(),
            own: Vec::new(),
            power: 0.0,
            parts: 1,
        })
    }

    /// Weights of all particles under a torch, and their sum.
    fn weigh(&mut self, state: &State, torch: &Torch, stand: &Stand) -> f64 {
        let (d, volume) = (self.metal.spacing, self.metal.volume());
        self.own.clear();
        let skin = Skin::of(&state.metal);
        let surface = skin.surface;
        if torch.is_deep() {
            self.weighed.fill(&self.all, |a| {
                let x = skin.position[a];
                let takes = skin.takes(a) && torch.reaches(stand, x, d);
                takes.then(|| (a as u32, torch.density(stand, x, d) * volume))
            });
        } else {
            let shade = (stand.axes[2][2] >= DOWN).then(|| {
                let places = state.exposed.iter().map(|a| skin.position[*a as usize]);
                let under = places.filter(|x| torch.reaches(stand, *x, d));
                Shade::of(under, stand, d)
            });
            self.weighed.fill(&state.exposed, |a| {
                let x = skin.position[a];
                let area = shade.as_ref().map_or(surface.seen[a], |shade| {
                    let faced = torch.faced(stand, surface.normal[a], surface.area[a]);
                    if faced > 0.0 {
                        faced * shade.seen(x, surface.normal[a])
                    } else {
                        0.0
                    }
                });
                let takes = area > 0.0 && skin.takes(a) && torch.reaches(stand, x, d);
                takes.then(|| (a as u32, torch.density(stand, x, d) * area))
            });
        }
        self.own.extend(self.weighed.drain());
        self.own.iter().map(|(_, weight)| weight).sum()
    }

    /// Gives an energy \[J\] to the particles that were weighed, a part of it for each unit of weight.
    fn give(&self, state: &mut State, energy: f64) -> Result<(), StageError> {
        let columns = (&POSITION, &ENTHALPY, &TEMPERATURE, &FROM_TORCHES, &SLAG);
        let (places, enthalpies, temperatures, told, slag) = state.metal.columns_mut(columns);
        for (a, weight) in &self.own {
            let a = *a as usize;
            let Substance { caloric, mass } = self.made.at(slag, a);
            enthalpies[a] += energy * weight / mass;
            received::add(told, a, energy * weight);
            let kelvin = caloric.temperature(enthalpies[a]);
            temperatures[a] = kelvin;
            if !caloric.covers(kelvin) {
                return Err(outside(state.step, a, places[a], kelvin, caloric));
            }
        }
        Ok(())
    }
}

impl Stage for Torches {
    fn name(&self) -> &'static str {
        "torches"
    }

    fn declare(&self, state: &mut State) {
        state.metal.declare(&TEMPERATURE);
        state.metal.declare(&ENTHALPY);
        if !self.torches.iter().all(|lit| lit.torch.is_deep()) {
            patch::declare(&mut state.metal);
        }
    }

    fn parts(&self) -> u64 {
        self.parts
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let known = self.all.len();
        self.all.extend((known..state.len()).map(|a| a as u32));
        let mut gain = 0.0;
        self.parts = 1;
        for number in 0..self.torches.len() {
            let torch = self.torches[number].torch.clone();
            let moves = torch.path.fastest() * dt / (PART * torch.shape.least());
            let parts = moves.ceil().max(1.0) as u64;
            self.parts = self.parts.max(parts);
            let step = dt / parts as f64;
            for part in 0..parts {
                let from = state.time + part as f64 * step;
                let Some((energy, middle)) = torch.energy(from, from + step) else {
                    continue;
                };
                let stand = torch.stand(middle);
                // A torch that weaves across a mirror is upon it as long as its path is.
                let (path, near) = (torch.path.on(middle).0, UPON * self.metal.spacing);
                let here = state.faces.part_here(path, stand.axes[2], near);
                let energy = here * energy;
                let inside = self.weigh(state, &torch, &stand);
                let share = inside / here;
                let each = match torch.beyond {
                    // Metal behind the torch takes part, but no more than the whole is given.
                    Beyond::Lost => energy / here / share.max(1.0),
                    Beyond::Inside if share > NONE => energy / inside,
                    Beyond::Inside => 0.0,
                };
                self.give(state, each)?;
                let lit = &mut self.torches[number];
                lit.least = lit.least.min(share);
                lit.most = lit.most.max(share);
                lit.put.add(each * inside);
                lit.lost.add(energy - each * inside);
                gain += each * inside;
            }
        }
        self.power = gain / dt;
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        let sum = |of: fn(&Lit) -> f64| self.torches.iter().map(of).sum();
        let least = self.torches.iter().map(|lit| lit.least);
        let figure = |name, unit, value| Figure { name, unit, value };
        vec![
            figure("torch_power_w", "W", self.power),
            figure("torch_inside_least", "1", least.fold(1.0, f64::min)),
            figure("energy_in_torches_j", "J", sum(|lit| lit.put.value())),
            figure("energy_lost_of_torches_j", "J", sum(|lit| lit.lost.value())),
        ]
    }

    fn warnings(&self) -> Vec<String> {
        let dark = self.torches.iter().enumerate();
        let dark = dark.filter(|(_, lit)| lit.put.value() + lit.lost.value() <= 0.0);
        let dark = dark.map(|(number, lit)| {
            let from = lit.torch.path.burns()[0];
            format!("torches/{number}: gave no heat at all; it burns from {from} s on")
        });
        let little = self.torches.iter().enumerate();
        let told =
            little.filter_map(|(number, lit)| Some(format!("torches/{number}: {}", lit.little()?)));
        let much = self.torches.iter().enumerate();
        let much = much.filter(|(_, lit)| lit.torch.beyond == Beyond::Lost && lit.most > MUCH);
        let much = much.map(|(number, lit)| {
            format!(
                "torches/{number}: metal lies behind it too, and takes part: {:.1} % of its heat would lie in the metal, which \
                 takes the whole power and no more; a path on the surface has no metal behind it",
                100.0 * lit.most
            )
        });
        let burnt = self.torches.iter().enumerate();
        let burnt = burnt.filter(|(_, lit)| lit.put.value() > 0.0);
        let blunt = burnt.filter_map(|(number, lit)| {
            let told = lit.torch.blunt(self.metal.spacing, "spacing_m")?;
            Some(format!("torches/{number}: {told}"))
        });
        dark.chain(told).chain(much).chain(blunt).collect()
    }

    fn bytes(&self) -> usize {
        4 * self.all.capacity() + size_of::<(u32, f64)>() * self.own.capacity()
    }

    fn save(&self) -> Vec<f64> {
        let of = |lit: &Lit| {
            let ([a, b], [c, d]) = (lit.put.save(), lit.lost.save());
            [a, b, c, d, lit.least, lit.most]
        };
        self.torches.iter().flat_map(of).collect()
    }

    fn restore(&mut self, saved: &[f64]) {
        for (lit, own) in self.torches.iter_mut().zip(saved.chunks_exact(6)) {
            lit.put = Sum::restored(&own[..2]);
            lit.lost = Sum::restored(&own[2..4]);
            [lit.least, lit.most] = [own[4], own[5]];
        }
    }
}

#[cfg(test)]
mod tests;
