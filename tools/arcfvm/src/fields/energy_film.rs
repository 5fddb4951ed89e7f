//! How gas conducts heat at the surface of an electrode (Komen 2019, eqs 5.17, 5.18).

use crate::case::Case;
use crate::fields::energy::Energy;
use crate::heat::{Contact, FaceIndex, Layer, Surfaces};
use crate::properties::Properties;
use crate::scene::Film;

impl Energy {
    /// Conductances at film temperature of the ways from gas to electrodes.
    pub(crate) fn conduct_surfaces(
        &mut self,
        case: &Case,
        surfaces: &Surfaces,
        properties: &Properties,
    ) {
        for (n, contact) in surfaces.contacts.iter().enumerate() {
            if let Some(layer) = surfaces.layers.get(n) {
                self.lay(case, contact, (surfaces.film, layer), properties);
                continue;
            }
            let iron = properties.iron_at(contact.gas);
            let way = (surfaces.film, properties.thermal[contact.metal]);
            let conductance = self.film(case, contact, way, iron);
            self.set(contact.face, conductance);
        }
    }

    fn set(&mut self, face: FaceIndex, conductance: f64) {
        match face {
            FaceIndex::Radial(face) => self.radial[face] = conductance,
            FaceIndex::Axial(face) => self.axial[face] = conductance,
        }
    }

    /// Conductances of the ways through a film of given thickness, at the mean temperature of the metal and of
    /// the gas at its edge. Of the way between the centres, as much again lies before the surface.
    fn lay(
        &mut self,
        case: &Case,
        contact: &Contact,
        (way, layer): (Film, &Layer),
        properties: &Properties,
    ) {
        let kappa = &properties.thermal;
        let metal = self.temperature[contact.metal];
        let film = 0.5 * (metal + layer.at(metal, &self.temperature));
        let iron = if properties.iron.is_empty() {
            0.0
        } else {
            layer.at(properties.iron[contact.gas], &properties.iron)
        };
        let [r, z] = contact.place;
        let law = case.of(contact.gas).thermal_conductivity.as_ref();
        let gas = law.map_or(0.0, |l| l.within(r, z, film, iron));
        let mut before = match way {
            Film::HalfCells => contact.metal_half / kappa[contact.metal],
            Film::Centres => layer.depth / gas,
        };
        for link in &layer.links {
            let [near, far] = [0, 1].map(|n| link.outside[n] / kappa[link.cells[n]]);
            let resistance = before + link.inside / gas + near + far;
            self.set(link.face, link.area / resistance);
            before = 0.0;
        }
    }

    /// Gas at the mean of both temperatures in series with half a metal cell, or all the way between the
    /// centres (eqs 5.17, 5.18).
    fn film(&self, case: &Case, contact: &Contact, (way, metal): (Film, f64), iron: f64) -> f64 {
        let film = 0.5 * (self.temperature[contact.gas] + self.temperature[contact.metal]);
        let [r, z] = contact.place;
        let law = case.of(contact.gas).thermal_conductivity.as_ref();
        let gas = law.map_or(0.0, |l| l.within(r, z, film, iron));
        match way {
            Film::HalfCells => contact.area / (contact.gas_half / gas + contact.metal_half / metal),
            Film::Centres => contact.area * gas / (contact.gas_half + contact.metal_half),
        }
    }
}
