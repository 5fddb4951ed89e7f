//! Which bodies are electrodes, and which way current crosses them.

use crate::assemble::Faults;
use crate::assemble::layout::Layout;
use crate::case::{Edges, PotentialCase, PotentialEdge};
use crate::heat::{Electrode, Emission, Evaporation, Role, Surfaces};
use crate::material::REFERENCE_K;
use crate::scene::{self, Body, ElectrodeAt, Film, Scene};

/// Electrodes by material, the gas being 0.
pub(crate) struct Electrodes {
    /// The electrode of each material.
    pub(crate) of: Vec<Option<Electrode>>,
    /// Material of the base metal: the lowest electrode on the axis.
    pub(crate) base: Option<usize>,
}

impl Electrodes {
    /// All electrodes of the scene in their roles.
    pub(crate) fn new(
        layout: &Layout,
        bodies: &[(&String, &Body)],
        potential: Option<&PotentialCase>,
        faults: &mut Faults,
    ) -> Self {
        let polarity = potential.and_then(|p| Polarity::new(layout, p));
        let mut of = vec![None];
        for (n, (name, body)) in bodies.iter().enumerate() {
            let positive = polarity.map(|p| p.is_anode(n + 1));
            of.push(electrode(name, body, positive, faults));
        }
        let base = layout.lowest(|m| of[m].is_some());
        if let Some(one) = base.and_then(|m| of[m].as_mut()) {
            one.absorbs = true;
        }
        let roles = Self { of, base };
        if let Some(polarity) = polarity.filter(|p| roles.of[p.fed].is_some()) {
            roles.check(bodies, polarity, faults);
        }
        roles
    }

    /// Whether `material` is a cathode.
    pub(crate) fn is_cathode(&self, material: usize) -> bool {
        let role = self.of[material].as_ref().map(|e| e.role);
        matches!(role, Some(Role::Cathode { .. }))
    }

    /// Roles that bodies were given must be those that the current gives them.
    fn check(&self, bodies: &[(&String, &Body)], polarity: Polarity, faults: &mut Faults) {
        for (n, (name, _)) in bodies.iter().enumerate() {
            if self.of[n + 1].is_none() || self.is_cathode(n + 1) != polarity.is_anode(n + 1) {
                continue;
            }
            let (is, fits) = if self.is_cathode(n + 1) {
                ("a cathode", "an anode")
            } else {
                ("an anode", "a cathode")
            };
            let what = format!("is {is}, but the sign of total_current_a makes it {fits}");
            faults.add(&format!("/bodies/{name}"), what);
        }
    }
}

/// Which way the driven current goes.
#[derive(Debug, Clone, Copy)]
struct Polarity {
    /// Material under the driven faces.
    fed: usize,
    /// Whether current enters through them.
    enters: bool,
}

impl Polarity {
    fn new(layout: &Layout, potential: &PotentialCase) -> Option<Self> {
        let current = potential.driven?;
        Some(Self {
            fed: layout.material[fed_cell(layout, &potential.edges)?],
            enters: current > 0.0,
        })
    }

    fn is_anode(self, material: usize) -> bool {
        (material == self.fed) == self.enters
    }
}

/// A cell under a driven face.
fn fed_cell(layout: &Layout, edges: &Edges<PotentialEdge>) -> Option<usize> {
    let grid = &layout.grid;
    let on = |side: &[PotentialEdge]| side.iter().position(|e| *e == PotentialEdge::Driven);
    let top = on(&edges.top).map(|i| grid.cell(i, grid.nz - 1));
    let bottom = || on(&edges.bottom).map(|i| grid.cell(i, 0));
    let outer = || on(&edges.outer).map(|j| grid.cell(grid.nr - 1, j));
    let inner = || on(&edges.inner).map(|j| grid.cell(0, j));
    top.or_else(bottom).or_else(outer).or_else(inner)
}

fn vapour(evaporation: Option<&scene::Evaporation>) -> Option<Evaporation> {
    evaporation.map(|e| Evaporation {
        boiling: e.boiling_k,
        latent_heat: e.latent_heat_j_kg,
        molar_mass: e.molar_mass_kg_mol,
    })
}

/// The electrode that a body is; `positive` tells whether the driven current makes it an anode.
fn electrode(
    name: &str,
    body: &Body,
    positive: Option<bool>,
    faults: &mut Faults,
) -> Option<Electrode> {
    let at = format!("/bodies/{name}");
    let (role, emissivity, evaporation) = match (&body.anode, &body.cathode, &body.electrode) {
        (None, None, None) => return None,
        (Some(a), None, None) => (
            anode(a.work_function_v),
            a.emissivity,
            a.evaporation.as_ref(),
        ),
        (None, Some(c), None) => {
            let role = cathode(c, &format!("{at}/cathode"), faults)?;
            (role, c.emissivity, c.evaporation.as_ref())
        }
        (None, None, Some(e)) => {
            let Some(positive) = positive else {
                let what = "wants a total_current_a, whose sign makes it an anode or a cathode";
                faults.add(&format!("{at}/electrode"), what);
                return None;
            };
            let role = if positive {
                anode(e.work_function_v)
            } else {
                cathode(&as_cathode(e), &format!("{at}/electrode"), faults)?
            };
            (role, e.emissivity, e.evaporation.as_ref())
        }
        _ => {
            faults.add(&at, "has more than one of anode, cathode, electrode");
            return None;
        }
    };
    Some(Electrode {
        name: name.into(),
        absorbs: false,
        role,
        emissivity,
        surroundings: REFERENCE_K,
        evaporation: vapour(evaporation),
    })
}

fn anode(work_function: f64) -> Role {
    Role::Anode { work_function }
}

fn cathode(c: &scene::Cathode, at: &str, faults: &mut Faults) -> Option<Role> {
    let emission = match (c.richardson_a_m2_k2, c.fall_v) {
        (Some(richardson), None) => match c.ions {
            Some(scene::Ions::Net) => Emission::NetIons(richardson),
            Some(scene::Ions::Whole) | None => Emission::Thermionic(richardson),
        },
        (None, Some(_)) if c.ions.is_some() => {
            let what = "belongs to a thermionic cathode: a given fall tells what ions give";
            faults.add(&format!("{at}/ions"), what);
            return None;
        }
        (None, Some(fall)) => Emission::Fall(fall),
        _ => {
            faults.add(at, "wants exactly one of richardson_a_m2_k2 and fall_v");
            return None;
        }
    };
    Some(Role::Cathode {
        work_function: c.work_function_v,
        ionisation_voltage: c.ionisation_voltage_v,
        emission,
    })
}

fn as_cathode(e: &scene::Electrode) -> scene::Cathode {
    scene::Cathode {
        work_function_v: e.emission_work_function_v.unwrap_or(e.work_function_v),
        ionisation_voltage_v: e.ionisation_voltage_v,
        richardson_a_m2_k2: e.richardson_a_m2_k2,
        ions: e.ions,
        fall_v: e.fall_v,
        emissivity: e.emissivity,
        evaporation: e.evaporation.clone(),
    }
}

/// Surfaces of the electrodes, where heat or vapour meets them.
pub(super) fn surfaces(scene: &Scene, layout: &Layout, all: &Electrodes) -> Option<Surfaces> {
    let heat = scene.heat.as_ref();
    if heat.is_none() && scene.vapour.is_none() {
        return None;
    }
    let mut electrodes = Vec::new();
    let mut index = vec![None; all.of.len()];
    for (material, electrode) in all.of.iter().enumerate() {
        if let Some(electrode) = electrode {
            index[material] = Some(electrodes.len());
            let mut electrode = electrode.clone();
            // Where vapour is solved, surfaces do not evaporate into a vacuum.
            electrode.evaporation = electrode.evaporation.filter(|_| scene.vapour.is_none());
            electrodes.push(electrode);
        }
    }
    if electrodes.is_empty() {
        return None;
    }
    let mut surfaces = Surfaces {
        electrodes,
        contacts: Vec::new(),
        beside: Vec::new(),
        absorbed: heat.and_then(|h| h.absorbed_radiation),
        electrode_of: index,
        at: heat.map_or(ElectrodeAt::default(), |h| h.electrode_at),
        film: heat.map_or(Film::default(), |h| h.film),
        film_depth: heat.and_then(|h| h.film_m),
        layers: Vec::new(),
    };
    surfaces.renew(&layout.grid, &layout.material);
    Some(surfaces)
}
