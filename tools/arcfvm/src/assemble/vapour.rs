//! Iron vapour of the scene.

use crate::assemble::edges::{paint, values};
use crate::assemble::electrodes::Electrodes;
use crate::assemble::gas_file::GasFile;
use crate::assemble::layout::Layout;
use crate::assemble::{Faults, PLACE, cell_source, value};
use crate::case::{Edges, FlowCase, Ionisation, VapourCase, VapourEdge};
use crate::grid::Grid;
use crate::material::REFERENCE_K;
use crate::mixture::Molar;
use crate::scene::{Amount, Body, Evaporation, Gas, Returns, Scene, Vapour, VapourMass};
use crate::vapour::evaporation::Evaporating;

/// Molar mass of iron \[kg/mol\], where neither table nor metal tell that of the vapour.
const IRON: f64 = 0.055_845;
/// Difference of molar masses that is none.
const ALIKE: f64 = 1e-3;
/// Pressure where neither table nor scene tell it \[Pa\].
const ATMOSPHERE: f64 = 101_325.0;

/// The vapour, where the scene asks for it.
pub(crate) fn vapour(
    scene: &Scene,
    gas: Option<&GasFile>,
    layout: &Layout,
    electrodes: &Electrodes,
    flow: Option<&FlowCase>,
    faults: &mut Faults,
) -> Option<VapourCase> {
    let bodies = Layout::bodies(scene);
    let Some(given) = scene.vapour.as_ref() else {
        refuse_saturation(&bodies, faults);
        return None;
    };
    let adds = given.mass == VapourMass::Added;
    if adds && flow.is_none_or(|f| f.closed) {
        let what = "added vapour wants flow with an open edge through which gas can leave";
        faults.add("/vapour/mass", what);
    }
    if given.ionisation_voltage_v.is_some()
        && !(0..electrodes.of.len()).any(|m| electrodes.is_cathode(m))
    {
        faults.add(
            "/vapour/ionisation_voltage_v",
            "is for a cathode; there is none",
        );
    }
    if given.ionisation_by == Amount::Mass && given.ionisation_voltage_v.is_none() {
        let what = "wants ionisation_voltage_v, which goes with it";
        faults.add("/vapour/ionisation_by", what);
    }
    let source = cell_source(
        &layout.grid,
        given.source_kg_m3_s.as_ref(),
        "/vapour/source_kg_m3_s",
        faults,
    );
    let (molar, pressure) = mixture(scene, gas, &bodies, faults)?;
    of_one_kind(&bodies, molar.iron, faults);
    Some(VapourCase {
        edges: edges(scene, &layout.grid, faults),
        start: start(given, layout, faults),
        source,
        metals: metals(&bodies, electrodes),
        adds,
        vents: given.mass == VapourMass::Vented,
        molar,
        pressure,
        ionisation: given.ionisation_voltage_v.map(|voltage| Ionisation {
            voltage,
            by_mass: given.ionisation_by == Amount::Mass,
        }),
        returns_hot: given.returns == Returns::Gas,
        wall: wall(&bodies),
    })
}

/// Edges of the vapour.
fn edges(scene: &Scene, grid: &Grid, faults: &mut Faults) -> Edges<VapourEdge> {
    let mut edges = Edges::uniform(grid, VapourEdge::Sealed);
    let Some(vapour) = &scene.vapour else {
        return edges;
    };
    paint(
        &vapour.edges,
        grid,
        "/vapour/edges",
        &mut edges,
        |at, c, faces| {
            let at = format!("{at}/iron_mass_fraction");
            let found = values(&c.iron_mass_fraction, c.over_m, faces, &at, faults);
            if found.iter().flatten().any(|y| !(0.0..=1.0).contains(y)) {
                faults.add(&at, "is not from 0 to 1 everywhere");
            }
            found
                .into_iter()
                .map(|y| y.map(VapourEdge::Fraction))
                .collect()
        },
    );
    edges
}

/// The granular body, where slag takes iron up.
fn wall(bodies: &[(&String, &Body)]) -> Option<(usize, f64)> {
    let mut all = bodies.iter().enumerate();
    all.find_map(|(n, (_, body))| Some((n + 1, body.granular.as_ref()?.iron_mass_fraction?)))
}

/// Molar masses and pressure, of the table or given.
fn mixture(
    scene: &Scene,
    gas: Option<&GasFile>,
    bodies: &[(&String, &Body)],
    faults: &mut Faults,
) -> Option<(Molar, f64)> {
    match (&scene.gas, gas) {
        (Gas::Table(_), Some(file)) => Some((file.molar?, file.pressure)),
        (Gas::Table(_), None) => None,
        (Gas::Given(given), _) => {
            let Some(gas) = given.molar_mass_kg_mol else {
                faults.add(
                    "/gas/given/molar_mass_kg_mol",
                    "is missing; vapour needs it",
                );
                return None;
            };
            let metal = bodies.iter().find_map(|(_, body)| evaporation(body));
            let iron = metal.map_or(IRON, |(_, metal)| metal.molar_mass_kg_mol);
            let molar = Molar { gas, iron };
            Some((molar, given.pressure_pa.unwrap_or(ATMOSPHERE)))
        }
    }
}

/// The gas holds one vapour: all metals that evaporate have its molar mass \[kg/mol\].
fn of_one_kind(bodies: &[(&String, &Body)], vapour: f64, faults: &mut Faults) {
    for (name, body) in bodies {
        let Some((electrode, metal)) = evaporation(body) else {
            continue;
        };
        let own = metal.molar_mass_kg_mol;
        if (own / vapour - 1.0).abs() > ALIKE {
            let at = format!("/bodies/{name}/{electrode}/evaporation/molar_mass_kg_mol");
            let what =
                format!("{own} kg/mol is not that of the vapour in the gas, {vapour} kg/mol");
            faults.add(&at, what);
        }
    }
}

/// How a body evaporates, as whichever electrode it is, and the key of that.
pub(super) fn evaporation(body: &Body) -> Option<(&'static str, &Evaporation)> {
    let anode = body.anode.as_ref().and_then(|a| a.evaporation.as_ref());
    let cathode = body.cathode.as_ref().and_then(|c| c.evaporation.as_ref());
    let either = body.electrode.as_ref().and_then(|e| e.evaporation.as_ref());
    let keyed = [
        ("anode", anode),
        ("cathode", cathode),
        ("electrode", either),
    ];
    keyed.into_iter().find_map(|(key, e)| Some((key, e?)))
}

/// A saturation pressure means nothing where vapour leaves into a vacuum.
fn refuse_saturation(bodies: &[(&String, &Body)], faults: &mut Faults) {
    for (name, body) in bodies {
        if evaporation(body).is_some_and(|(_, e)| e.saturation.is_some()) {
            let what = "evaporation/saturation wants vapour in the scene";
            faults.add(&format!("/bodies/{name}"), what);
        }
    }
}

/// How the metal of each electrode evaporates, in the order of the electrodes.
fn metals(bodies: &[(&String, &Body)], electrodes: &Electrodes) -> Vec<Option<Evaporating>> {
    let electrodes = bodies
        .iter()
        .enumerate()
        .filter(|(n, _)| electrodes.of[n + 1].is_some());
    electrodes
        .map(|(_, (_, body))| evaporation(body).map(|(_, e)| evaporating(e)))
        .collect()
}

fn evaporating(given: &Evaporation) -> Evaporating {
    let (heat, molar) = (given.latent_heat_j_kg, given.molar_mass_kg_mol);
    match &given.saturation {
        Some(s) => Evaporating::decimal(s.a, s.b_k, heat, molar),
        None => Evaporating::boiling(given.boiling_k, heat, molar),
    }
}

/// Mass fraction of each cell at the start; none in bodies.
fn start(given: &Vapour, layout: &Layout, faults: &mut Faults) -> Vec<f64> {
    let grid = &layout.grid;
    let at = "/vapour/start";
    let mut all = vec![0.0; grid.len()];
    let Some(curve) = faults.keep(given.start.compile(at, &PLACE)) else {
        return all;
    };
    for k in (0..grid.len()).filter(|k| layout.is_gas(*k)) {
        let (r, z) = (grid.rc[k % grid.nr], grid.zc[k / grid.nr]);
        match value(&curve, r, z, REFERENCE_K) {
            Ok(y) if (0.0..=1.0).contains(&y) => all[k] = y,
            Ok(y) => {
                faults.add(at, format!("{y} is not from 0 to 1 at {}", layout.place(k)));
                return all;
            }
            Err(what) => {
                faults.add(at, what);
                return all;
            }
        }
    }
    all
}
