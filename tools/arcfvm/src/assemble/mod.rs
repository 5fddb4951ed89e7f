//! From the scene to the problem: the only place that asks what the scene contains.

mod bed;
mod current;
mod edges;
mod electrodes;
mod flow;
mod gas;
mod gas_file;
mod heat;
mod layout;
mod matter;
pub(crate) mod pool;
mod preview;
pub(crate) mod sampled;
mod start;
mod vapour;
mod wire;

use run::property::{Arguments, Curve, Property};
use run::{Failure, Fault};

use crate::case::Case;
use crate::grid::Grid;
use crate::material::{GAS, REFERENCE_K};
use crate::scene::Scene;
use electrodes::Electrodes;
pub use gas_file::GasFile;
use layout::Layout;
pub use preview::preview;

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
    let start = start::start(scene, &layout, wire.as_ref(), &mut faults);
    let mut potential = current::current(scene, grid, &mut faults);
    let electrodes = Electrodes::new(&layout, &bodies, potential.as_ref(), &mut faults);
    if let (Some(potential), Some(current)) = (&mut potential, &scene.current) {
        potential.sheath = current::sheath(current, &layout, &electrodes);
        current::electrons(current, &materials[GAS], &mut faults);
    }
    let flow = flow::flow(scene, &layout, &materials, &mut faults);
    let heat = heat::heat(scene, &layout, &bodies, &start, &mut faults);
    let bed = bed::bed(scene, &layout, &bodies, &mut faults);
    let flows = flow.as_ref();
    let vapour = vapour::vapour(scene, gas, &layout, &electrodes, flows, &mut faults);
    faults.none()?;
    let surfaces = electrodes::surfaces(scene, &layout, &electrodes);
    let base = electrodes.base.and_then(|m| layout.base(m, &bodies));
    let mut case = Case {
        material: layout.material,
        materials,
        start,
        potential,
        flow,
        heat,
        vapour,
        bed,
        surfaces,
        wire,
        base,
        grid: layout.grid,
    };
    let inlets = flow::inlets(&case);
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
