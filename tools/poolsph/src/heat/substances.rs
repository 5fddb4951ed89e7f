//! What particles are made of, as heat knows it: metal, and slag where it stands beside.

use std::sync::Arc;

use particles::{Matter, Set};

use super::bounds::moments;
use super::caloric::Caloric;
use crate::state::marked;
use crate::state::slag::SLAG;

/// Crowding of a liquid over the lattice that the step limit allows for.
const CROWDING: f64 = 1.1;

/// A substance.
#[derive(Debug, Clone)]
pub struct Substance {
    /// Its thermal properties.
    pub caloric: Arc<Caloric>,
    /// Mass of a particle \[kg\].
    pub mass: f64,
}

/// Metal, and slag beside it.
#[derive(Debug, Clone)]
pub struct Substances {
    metal: Substance,
    slag: Option<Substance>,
}

impl Substances {
    /// Metal alone.
    #[must_use]
    pub fn of(metal: Arc<Caloric>, matter: Matter) -> Self {
        let metal = Substance {
            caloric: metal,
            mass: matter.mass(),
        };
        Self { metal, slag: None }
    }

    /// The same with slag, of a particle `mass` \[kg\] beside it.
    #[must_use]
    pub fn beside(self, slag: Arc<Caloric>, mass: f64) -> Self {
        let slag = Some(Substance {
            caloric: slag,
            mass,
        });
        Self { slag, ..self }
    }

    /// The metal.
    #[must_use]
    pub fn metal(&self) -> &Arc<Caloric> {
        &self.metal.caloric
    }

    /// Metal or slag.
    #[must_use]
    pub fn which(&self, slag: bool) -> &Substance {
        match &self.slag {
            Some(own) if slag => own,
            _ => &self.metal,
        }
    }

    /// That of particle `a`, of the marks of slag of all.
    #[must_use]
    #[inline]
    pub fn at(&self, marks: &[bool], a: usize) -> &Substance {
        self.which(marked(marks, a))
    }

    /// The marks of slag in a set, none where metal is alone.
    #[must_use]
    pub fn marks(set: &Set) -> &[bool] {
        set.column(&SLAG)
    }

    /// The largest step of explicit conduction \[s\]. A particle loses to a neighbour of another substance by the harmonic mean of both
    /// conductivities:
    ///
    /// ```text
    /// dt <= m sum(r^2 W) / (6 V max(k/c) sum W)      k_ab = 2 k_a k_b/(k_a + k_b)
    /// ```
    #[must_use]
    pub fn limit(&self, matter: Matter) -> f64 {
        let (second, zeroth) = moments(matter);
        let step =
            |density: f64, fastest: f64| density * second / (6.0 * CROWDING * fastest * zeroth);
        let alone = step(matter.density, self.metal.caloric.fastest());
        let Some(slag) = &self.slag else { return alone };
        let between = |own: &Substance, other: &Substance| {
            let [k, others] = [own, other].map(|one| one.caloric.most_conductive());
            let both = 2.0 * k * others / (k + others) / own.caloric.least_heat();
            step(own.mass / matter.volume(), both.max(own.caloric.fastest()))
        };
        between(&self.metal, slag).min(between(slag, &self.metal))
    }
}
