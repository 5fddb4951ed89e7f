//! How gas conducts heat at the surface of an electrode (Komen 2019, eqs 5.17, 5.18).

use crate::grid::FaceIndex;
use crate::heat::energy::Energy;
use crate::heat::reads::Around;
use crate::heat::{Contact, Film, Layer, Surfaces};
use crate::material::Law;
use crate::properties::Properties;

/// Part of its thickness by which a film may miss the middle of a cell.
const ROUNDING: f64 = 1e-9;
/// Halvings that leave nothing but rounding.
const HALVINGS: usize = 50;

impl Energy {
    /// Conductances at film temperature of the ways from gas to electrodes.
    pub(crate) fn conduct_surfaces(&mut self, around: Around<'_>, surfaces: &Surfaces) {
        for (n, contact) in surfaces.contacts.iter().enumerate() {
            if let Some(layer) = surfaces.layers.get(n) {
                self.lay(around, surfaces, n, layer);
                continue;
            }
            let conductance = self.film(around, surfaces.film, n, contact);
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
    fn lay(&mut self, around: Around<'_>, surfaces: &Surfaces, n: usize, layer: &Layer) {
        let (case, properties) = (around.case, around.properties);
        let (contact, way) = (&surfaces.contacts[n], surfaces.film);
        let kappa = &properties.thermal;
        let metal = self.skin(n, contact).temperature;
        let iron = if properties.iron.is_empty() {
            0.0
        } else {
            layer.at(properties.iron[contact.gas], &properties.iron)
        };
        let law = case.of(contact.gas).thermal_conductivity.as_ref();
        let integral = case.integrates_conduction();
        let conducts =
            |a: f64, b: f64| law.map_or(0.0, |l| between(l, integral, contact.place, iron, [a, b]));
        let film = Crossed {
            ways: match way {
                Film::HalfCells => layer.depth,
                Film::Centres => 2.0 * layer.depth,
            },
            rest: contact.gas_half - layer.depth,
        };
        let middle = self.temperature[contact.gas];
        let edge = self.skins.get_mut(n).and_then(|skin| {
            skin.edge =
                (film.rest > ROUNDING * layer.depth).then(|| film.edge(conducts, [metal, middle]));
            skin.edge
        });
        let gas = conducts(
            metal,
            edge.unwrap_or_else(|| layer.at(metal, &self.temperature)),
        );
        let metal_side = self.before(n, contact, properties);
        let mut before = match way {
            Film::HalfCells => metal_side,
            Film::Centres => layer.depth / gas + self.skins.get(n).map_or(0.0, |s| s.resistance),
        };
        for link in &layer.links {
            let [near, far] = [0, 1].map(|n| link.outside[n] / kappa[link.cells[n]]);
            let far = edge.map_or(far, |edge| film.rest / conducts(edge, middle));
            let resistance = before + link.inside / gas + near + far;
            self.set(link.face, link.area / resistance);
            before = 0.0;
        }
    }

    /// Resistance between the surface of contact `n` and the middle of its metal \[m2 K/W\].
    fn before(&self, n: usize, contact: &Contact, properties: &Properties) -> f64 {
        let half = || contact.metal_half / properties.thermal[contact.metal];
        self.skins.get(n).map_or_else(half, |skin| skin.resistance)
    }

    /// Gas at the mean of both temperatures in series with half a metal cell, or all the way between the
    /// centres (eqs 5.17, 5.18); where the surface has a temperature, half of the difference to that over half of the
    /// way, in series with the metal.
    fn film(&self, around: Around<'_>, way: Film, n: usize, contact: &Contact) -> f64 {
        let (case, properties) = (around.case, around.properties);
        let iron = properties.iron_at(contact.gas);
        let metal = self.before(n, contact, properties);
        let ends = [
            self.skin(n, contact).temperature,
            self.temperature[contact.gas],
        ];
        let integral = case.integrates_conduction();
        let law = case.of(contact.gas).thermal_conductivity.as_ref();
        let gas = law.map_or(0.0, |l| between(l, integral, contact.place, iron, ends));
        match way {
            Film::HalfCells => contact.area / (contact.gas_half / gas + metal),
            Film::Centres if !self.skins.is_empty() => {
                contact.area / (2.0 * contact.gas_half / gas + metal)
            }
            Film::Centres => contact.area * gas / (contact.gas_half + contact.metal_half),
        }
    }
}

/// Conductivity of a film by the `law` of its gas between the temperatures of its ends: their mean, or that over all between
/// them.
fn between(law: &Law, integral: bool, place: [f64; 2], iron: f64, ends: [f64; 2]) -> f64 {
    if integral {
        law.mean(place, ends, iron)
    } else {
        law.within(place[0], place[1], 0.5 * (ends[0] + ends[1]), iron)
    }
}

/// The gas between a surface and the middle of its first cell, with a film that ends on the way.
struct Crossed {
    /// Length over which the film conducts \[m\].
    ways: f64,
    /// From its edge to the middle of the cell \[m\].
    rest: f64,
}

impl Crossed {
    /// Temperature of the edge between `surface` and `middle` \[K\] at which both ways pass the same heat, each
    /// conducting as the mean of its ends. Conductivity grows twentyfold within a cell: on a straight line between
    /// both temperatures the edge of a thin film lies thousands of kelvin too low.
    fn edge(&self, conducts: impl Fn(f64, f64) -> f64, [surface, middle]: [f64; 2]) -> f64 {
        let at = |part: f64| surface + part * (middle - surface);
        let too_far = |edge: f64| {
            let inner = conducts(surface, edge) * (edge - surface) / self.ways;
            let outer = conducts(edge, middle) * (middle - edge) / self.rest;
            (inner - outer) * (middle - surface) > 0.0
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let part = 0.5 * (low + high);
            if too_far(at(part)) {
                high = part;
            } else {
                low = part;
            }
        }
        at(0.5 * (low + high))
    }
}

#[cfg(test)]
mod tests {
    use super::Crossed;

    #[test]
    fn the_edge_of_a_film_passes_what_reaches_it() {
        let film = Crossed {
            ways: 1e-4,
            rest: 3e-4,
        };
        // Constant: a quarter of the way. Linear in the temperature: a quarter of the difference of squares.
        let level = film.edge(|_, _| 0.7, [2000.0, 10_000.0]);
        assert!((level - 4000.0).abs() < 1e-6, "{level}");
        for ends in [[2000.0_f64, 10_000.0], [9000.0, 500.0]] {
            let found = film.edge(|a, b| 1e-4 * 0.5 * (a + b), ends);
            let square = ends[0].powi(2) + 0.25 * (ends[1].powi(2) - ends[0].powi(2));
            assert!((found - square.sqrt()).abs() < 1e-6, "{found}");
        }
        assert!((film.edge(|_, _| 1.0, [800.0, 800.0]) - 800.0).abs() < 1e-9);
    }
}
