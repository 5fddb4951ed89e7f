//! From the scene to the problem: the only place that asks what the scene contains.

mod edges;
mod electrodes;
mod gas;
mod gas_file;
mod granular;
mod inlets;
mod layout;
mod matter;
pub(crate) mod pool;
mod preview;
mod vapour;
mod wire;

use run::property::{Arguments, Curve, Property};
use run::{Failure, Fault};

use crate::case::{
    Case, Edges, Faces, FlowCase, Gravity, HeatCase, HeatEdge, Inlets, MovingPlate, PotentialCase,
    Wire,
};
use crate::current::sheath::Sheath;
use crate::grid::Grid;
use crate::heat::Surfaces;
use crate::material::{GAS, Material, REFERENCE_K};
use crate::scene::{
    self, Body, Current, ElectrodeAt, Film, Heat, Moving, Scene, SheathAt, SheathKeeps,
};
use electrodes::Electrodes;
pub use gas_file::GasFile;
use layout::Layout;
pub use preview::preview;

/// How far a hot channel reaches up the wire, in its radius: an arc spreads over the wire's side.
const CLIMB: f64 = 0.5;
/// Names that given values may use: edges, sources, forces, the start.
const PLACE: [&str; 2] = ["r", "z"];

/// Collects faults, so that all are told at once.
#[derive(Debug, Default)]
pub(crate) struct Faults(Vec<Fault>);

impl Faults {
    pub(crate) fn add(&mut self, at: &str, what: impl Into<String>) {
        self.0.push(Fault::at(at, what));
    }

    /// The value, or nothing with the fault kept.
    pub(crate) fn keep<T>(&mut self, result: Result<T, Fault>) -> Option<T> {
        result.map_err(|fault| self.0.push(fault)).ok()
    }

    /// An empty collection, or all faults so far.
    fn none(self) -> Result<Self, Failure> {
        if self.0.is_empty() {
            Ok(self)
        } else {
            Err(Failure::Scene(self.0))
        }
    }
}

/// The whole problem; `gas` is the gas table where the scene names one.
///
/// # Errors
/// Every contradiction in the scene.
pub fn assemble(scene: &Scene, gas: Option<&GasFile>) -> Result<Case, Failure> {
    let mut faults = Faults::default();
    let layout = Layout::new(scene, &mut faults);
    // What follows relies on bodies within the grid.
    let mut faults = faults.none()?;
    let Some(layout) = layout else {
        return Err(Failure::Other("the scene has no grid".to_owned()));
    };
    let materials = matter::materials(scene, gas, &mut faults);
    let (grid, bodies) = (&layout.grid, Layout::bodies(scene));
    let wire = wire::wire(&layout, &bodies, &materials, &mut faults);
    let start = start(scene, &layout, wire.as_ref(), &mut faults);
    let mut potential = scene.current.as_ref().map(|current| PotentialCase {
        edges: edges::current(scene, grid, &mut faults),
        driven: edges::driven(scene),
        source: cell_source(
            grid,
            current.source_a_m3.as_ref(),
            "/current/source_a_m3",
            &mut faults,
        ),
        sheath: None,
    });
    let electrodes = Electrodes::new(&layout, &bodies, potential.as_ref(), &mut faults);
    if let (Some(potential), Some(current)) = (&mut potential, &scene.current) {
        potential.sheath = sheath(current, &layout, &electrodes);
        electrons(current, &materials[GAS], &mut faults);
    }
    let flow = scene
        .flow
        .as_ref()
        .map(|_| flow(scene, &layout, &materials, &mut faults));
    let heat_edges = edges::heat(scene, grid, &mut faults);
    let given = "/heat/source_w_m3";
    let heat = scene.heat.as_ref().map(|heat| HeatCase {
        plates: plates(&bodies, &heat_edges),
        edges: heat_edges,
        granular: granular::granular(scene, &layout, &bodies, &mut faults),
        source: cell_source(grid, heat.source_w_m3.as_ref(), given, &mut faults),
        electrons: carriers(scene, heat, &mut faults),
        conduction: heat.conduction,
    });
    let flows = flow.as_ref();
    let vapour = vapour::vapour(scene, gas, &layout, &electrodes, flows, &mut faults);
    faults.none()?;
    let surfaces = surfaces(scene, &layout, &electrodes);
    let base = electrodes.base.and_then(|m| layout.base(m, &bodies));
    let mut case = Case {
        material: layout.material,
        materials,
        start,
        potential,
        flow,
        heat,
        vapour,
        surfaces,
        wire,
        base,
        grid: layout.grid,
    };
    let inlets = inlets::inlets(&case);
    if let Some(flow) = &mut case.flow {
        flow.inlets = inlets;
    }
    Ok(case)
}

/// A property in r, z, T at one place.
pub(crate) fn value(curve: &Curve, r: f64, z: f64, t: f64) -> Result<f64, String> {
    let at = Arguments {
        x: r,
        r,
        z,
        temperature: t,
        ..Arguments::default()
    };
    curve.value(&at).map_err(|e| e.to_string())
}

/// A given source of every cell, times its volume.
fn cell_source(
    grid: &Grid,
    property: Option<&Property>,
    at: &str,
    faults: &mut Faults,
) -> Option<Vec<f64>> {
    let curve = faults.keep(property?.compile(at, &PLACE))?;
    let mut all = Vec::with_capacity(grid.len());
    for j in 0..grid.nz {
        for i in 0..grid.nr {
            match value(&curve, grid.rc[i], grid.zc[j], REFERENCE_K) {
                Ok(v) => all.push(v * grid.volume(i, j)),
                Err(what) => {
                    faults.add(at, what);
                    return None;
                }
            }
        }
    }
    Some(all)
}

fn face_force(
    grid: &Grid,
    property: Option<&Property>,
    at: &str,
    radial: bool,
    faults: &mut Faults,
) -> Vec<f64> {
    let faces = if radial {
        grid.radial_faces()
    } else {
        grid.axial_faces()
    };
    let mut all = vec![0.0; faces];
    let Some(curve) = property.and_then(|p| faults.keep(p.compile(at, &PLACE))) else {
        return all;
    };
    let wide = if radial { grid.nr + 1 } else { grid.nr };
    for (k, out) in all.iter_mut().enumerate() {
        let (i, j) = (k % wide, k / wide);
        let (r, z) = if radial {
            (grid.rf[i], grid.zc[j])
        } else {
            (grid.rc[i], grid.zf[j])
        };
        match value(&curve, r, z, REFERENCE_K) {
            Ok(v) => *out = v,
            Err(what) => {
                faults.add(at, what);
                break;
            }
        }
    }
    all
}

fn flow(
    scene: &Scene,
    layout: &Layout,
    materials: &[crate::material::Material],
    faults: &mut Faults,
) -> FlowCase {
    let grid = &layout.grid;
    let (edges, closed) = edges::flow(scene, layout, faults);
    let given = scene.flow.as_ref();
    let radial = given.and_then(|f| f.force_radial_n_m3.as_ref());
    let axial = given.and_then(|f| f.force_axial_n_m3.as_ref());
    let force = (radial.is_some() || axial.is_some()).then(|| {
        [
            face_force(grid, radial, "/flow/force_radial_n_m3", true, faults),
            face_force(grid, axial, "/flow/force_axial_n_m3", false, faults),
        ]
    });
    let density = materials.first().and_then(|m| m.density.as_ref());
    let gravity = given
        .and_then(|f| f.gravity_m_s2)
        .map(|acceleration| Gravity {
            acceleration,
            reference_density: density.map_or(0.0, |d| d.at(grid.rc[0], grid.zc[0], REFERENCE_K)),
        });
    FlowCase {
        faces: Faces::new(grid, &layout.material, &edges),
        inlets: Inlets::default(),
        edges,
        gravity,
        force,
        closed,
    }
}

fn start(scene: &Scene, layout: &Layout, wire: Option<&Wire>, faults: &mut Faults) -> Vec<f64> {
    let grid = &layout.grid;
    let mut all = vec![REFERENCE_K; grid.len()];
    let at = "/start/temperature_k";
    let Some(curve) = faults.keep(scene.start.temperature_k.compile(at, &PLACE)) else {
        return all;
    };
    let climb = scene
        .start
        .channel
        .as_ref()
        .map_or(0.0, |c| CLIMB * c.radius_m);
    let top = wire.map_or(grid.nz, |w| grid.row_of(grid.zf[w.tip] + climb));
    for j in 0..grid.nz {
        for i in 0..grid.nr {
            let k = grid.cell(i, j);
            match value(&curve, grid.rc[i], grid.zc[j], REFERENCE_K) {
                Ok(t) if t > 0.0 => all[k] = t,
                Ok(t) => {
                    faults.add(at, format!("{t} K is not above 0 K at {}", layout.place(k)));
                    return all;
                }
                Err(what) => {
                    faults.add(at, what);
                    return all;
                }
            }
            let Some(channel) = scene.start.channel.as_ref().filter(|_| layout.is_gas(k)) else {
                continue;
            };
            if grid.rc[i] < channel.radius_m && j < top {
                all[k] = channel.temperature_k;
            }
        }
    }
    all
}

fn sheath(current: &Current, layout: &Layout, electrodes: &Electrodes) -> Option<Sheath> {
    let has = |m: usize| match current.sheath_at {
        SheathAt::Electrodes => electrodes.of[m].is_some(),
        SheathAt::Cathode => electrodes.is_cathode(m),
    };
    let has = (0..electrodes.of.len()).map(has).collect();
    let sheath = Sheath::new(&layout.grid, &layout.material, has, current.sheath_m?);
    Some(match current.sheath_keeps {
        SheathKeeps::Conductivity => sheath,
        SheathKeeps::ElectronDensity => sheath.keeping_electrons(),
    })
}

/// Whether the gas tells the electrons that its sheath is to keep.
fn electrons(current: &Current, gas: &Material, faults: &mut Faults) {
    let wants = current.sheath_keeps == SheathKeeps::ElectronDensity;
    if wants && gas.electron_density.is_none() {
        let what = "electron_density wants a gas table with the column electron_density_1_m3";
        faults.add("/current/sheath_keeps", what);
    }
}

/// What electrons carry, which wants a current.
fn carriers(scene: &Scene, heat: &Heat, faults: &mut Faults) -> Option<scene::Electrons> {
    if heat.electrons.is_some() && scene.current.is_none() {
        faults.add("/heat/electrons", "wants a current that electrons carry");
    }
    heat.electrons
}

fn surfaces(scene: &Scene, layout: &Layout, all: &Electrodes) -> Option<Surfaces> {
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

/// Moving bodies; beyond the edge of the domain they are as warm as the edge is, or as the room.
fn plates(bodies: &[(&String, &Body)], edges: &Edges<HeatEdge>) -> Vec<MovingPlate> {
    let beyond = edges.outer.iter().map(|edge| match edge {
        HeatEdge::Temperature(t) => *t,
        HeatEdge::Insulated | HeatEdge::Flux(_) => REFERENCE_K,
    });
    let beyond: Vec<f64> = beyond.collect();
    let moving = bodies.iter().enumerate();
    let moving = moving.filter_map(|(n, (_, body))| Some((n, body.moving.as_ref()?)));
    let plate = |(n, moving): (usize, &Moving)| MovingPlate {
        speed: moving.speed_m_s,
        ahead: moving.ahead_m,
        swept: moving.swept.widths(),
        material: n + 1,
        beyond: beyond.clone(),
    };
    moving.map(plate).collect()
}
