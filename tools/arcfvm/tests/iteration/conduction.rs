//! Heat between cells by the integral of the conductivity over temperature.

use arcfvm::assemble::assemble;
use arcfvm::march::recombination::Recombination;
use arcfvm::scene::Scene;
use arcfvm::settings::Settings;
use arcfvm::solver::Arc;
use serde_json::{Value, json};

/// Lower and upper temperature \[K\], and the thickness of the layer \[m\].
const LOW: f64 = 1000.0;
const HIGH: f64 = 11_000.0;
const THICK: f64 = 0.01;
/// Nodes and values of a conductivity that jumps tenfold within 2 K at 6000 K.
const NODES: [f64; 4] = [300.0, 5999.0, 6001.0, 20_000.0];
const VALUES: [f64; 4] = [0.2, 0.4, 4.0, 4.0];

/// Integral of the conductivity up to `t` \[W/m\].
fn integral(t: f64) -> f64 {
    let mut sum = 0.0;
    for k in 0..3 {
        let end = t.min(NODES[k + 1]);
        if end > NODES[k] {
            let slope = (VALUES[k + 1] - VALUES[k]) / (NODES[k + 1] - NODES[k]);
            let at_end = VALUES[k] + slope * (end - NODES[k]);
            sum += 0.5 * (VALUES[k] + at_end) * (end - NODES[k]);
        }
    }
    sum
}

/// Temperature at the part `part` of the way through the layer: the integral is linear in it.
fn exact(part: f64) -> f64 {
    let want = integral(LOW) + part * (integral(HIGH) - integral(LOW));
    let (mut low, mut high) = (LOW, HIGH);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if integral(middle) < want {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Greatest error of a layer of `cells` cells, heated from its upper side.
fn error(conduction: &Value, cells: f64) -> f64 {
    let scene = json!({
        "title": "A layer of gas",
        "domain": {"r_m": [0, 0.002], "z_m": [0, THICK]},
        "grid": {"r": 0.001, "z": THICK / cells},
        "gas": {"given": {
            "density_kg_m3": 0.1,
            "specific_heat_j_kg_k": 1000,
            "thermal_conductivity_w_m_k": {"t_k": NODES, "value": VALUES, "extrapolate": "constant"}
        }},
        "heat": {
            "edges": {"bottom": [{"temperature_k": LOW}], "top": [{"temperature_k": HIGH}]},
            "conduction": conduction
        },
        "start": {"temperature_k": 4000}
    });
    let scene: Scene = serde_json::from_value(scene).unwrap();
    let case = assemble(&scene, None).unwrap();
    let mut arc = Arc::new(case, Settings::from(&scene.iterate));
    let mut recombination = Recombination::new(&mut arc);
    for _ in 0..400 {
        let residuals = arc.iterate(&mut ()).unwrap();
        recombination.recombine(&mut arc, &residuals);
    }
    let grid = &arc.case.grid;
    let errors = (0..grid.nz).map(|j| {
        let found = arc.temperature()[grid.cell(0, j)];
        (found - exact(grid.zc[j] / THICK)).abs()
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn a_layer_whose_conductivity_jumps_is_exact_on_any_cells() {
    for cells in [5.0, 20.0] {
        let found = error(&json!("integral"), cells);
        assert!(found < 1e-4 * (HIGH - LOW), "{cells}: {found} K");
    }
}

#[test]
fn halves_that_conduct_as_their_cells_do_miss_the_jump() {
    let found = error(&json!("cells"), 20.0);
    assert!(found > 0.01 * (HIGH - LOW), "{found} K");
}
