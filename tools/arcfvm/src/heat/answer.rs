//! The balance of every surface (see [`skin`](crate::heat::skin)).

use crate::heat::reads::Reads;
use crate::heat::sources::current;
use crate::heat::{Contact, Skin, Surfaces};

impl Reads<'_> {
    /// Finds the temperatures of all surfaces, the heat that they absorb \[W/m2\] and the conductance between the
    /// middles on both sides \[W/(m2 K)\] being known.
    pub(crate) fn settle(
        &self,
        surfaces: &Surfaces,
        absorbed: &[f64],
        through: impl Fn(&Contact) -> f64,
        skins: &mut [Skin],
    ) {
        for (n, skin) in skins.iter_mut().enumerate() {
            let contact = &surfaces.contacts[n];
            let middles = [contact.metal, contact.gas].map(|k| self.temperature[k]);
            let absorbed = absorbed.get(n).copied().unwrap_or_default();
            let heat = self.taken_up(surfaces, n, skin.edge, absorbed);
            skin.settle(middles, through(contact), heat);
        }
    }

    /// What the surface of contact `n` takes up at a temperature, and its slope; `edge` is the temperature of the gas
    /// at the edge of its film, where that is known.
    fn taken_up<'s>(
        &'s self,
        surfaces: &'s Surfaces,
        n: usize,
        edge: Option<f64>,
        absorbed: f64,
    ) -> impl Fn(f64) -> [f64; 2] + 's {
        let contact = &surfaces.contacts[n];
        let electrode = self.electrode(surfaces, n);
        let current = self.around.potential.map_or(0.0, |p| current(p, contact));
        move |t| {
            let gas = edge.unwrap_or_else(|| self.gas_beside(surfaces, n, t));
            let [vapour, steeper] = self.vapour_at(contact, t);
            [
                electrode.heat(current, t, gas).sum() + absorbed + vapour,
                electrode.slope(current, t, gas) - steeper,
            ]
        }
    }

    /// Temperature of the gas beside contact `n`, where its surface is at `t` \[K\]: at the edge of the film, if
    /// that has a thickness.
    pub(crate) fn gas_beside(&self, surfaces: &Surfaces, n: usize, t: f64) -> f64 {
        let own = self.temperature[surfaces.contacts[n].gas];
        let layer = surfaces.layers.get(n);
        layer.map_or(own, |layer| layer.at(t, self.temperature))
    }

    /// Heat that vapour brings a surface at `t` \[K\], and how it falls with t.
    fn vapour_at(&self, contact: &Contact, t: f64) -> [f64; 2] {
        let Some(of) = self.around.vapour else {
            return [0.0; 2];
        };
        let passed = of
            .vapour
            .pass(self.around.case, of.setup, contact, t, self.temperature);
        let carried = self.carried(of, contact, &passed, t);
        let slope = of
            .vapour
            .slope(self.around.case, of.setup, contact, t, self.temperature);
        [carried.map_or(0.0, |c| c.metal), slope]
    }
}
