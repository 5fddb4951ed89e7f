//! Bodies in the current: which way it crosses them, and what follows from that.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod feed;
mod held;
mod supply;

use arcfvm::assemble::assemble;
use arcfvm::case::Case;
use arcfvm::scene::Scene;
use arcfvm::settings::Settings;
use arcfvm::solver::Arc;
use run::scene::{Expected, parse};
use serde_json::{Value, json};

fn read(scene: &Value) -> Scene {
    let expected = Expected {
        kind: "arcfvm.scene",
        version: 1,
        migrations: &[],
    };
    parse::<Scene>(&scene.to_string(), expected).unwrap().scene
}

fn case(scene: &Value) -> Result<Case, String> {
    assemble(&read(scene), None).map_err(|e| e.to_string())
}

fn solve(scene: &Value) -> Arc {
    let scene = read(scene);
    let mut arc = Arc::new(
        assemble(&scene, None).unwrap(),
        Settings::from(&scene.iterate),
    );
    for _ in 0..scene.iterate.most {
        let found = arc.iterate(&mut ()).unwrap();
        if found.within(scene.iterate.tolerance) && arc.iteration > 2 {
            return arc;
        }
    }
    panic!("not converged");
}

fn plate(z: [f64; 2]) -> Value {
    json!({
        "shape": {"ring": {"r_m": [0, 0.01], "z_m": z}},
        "material": {
            "density_kg_m3": 7800, "specific_heat_j_kg_k": 600,
            "thermal_conductivity_w_m_k": 30, "electric_conductivity_s_m": 1e6
        },
        "electrode": {
            "work_function_v": 4.5, "ionisation_voltage_v": 7.9, "richardson_a_m2_k2": 1.2e6,
            "emissivity": 0.4
        }
    })
}

/// Two plates, mirror images of each other, with gas between them.
fn mirror(current: f64) -> Value {
    json!({
        "kind": "arcfvm.scene", "version": 1, "title": "two plates",
        "domain": {"r_m": [0, 0.01], "z_m": [0, 0.02]}, "grid": {"r": 0.002, "z": 0.001},
        "gas": {"given": {
            "thermal_conductivity_w_m_k": {"expr": "0.5 + 1e-4*T"}, "specific_heat_j_kg_k": 1000,
            "electric_conductivity_s_m": {"expr": "200 + 0.1*T"}
        }},
        "bodies": {"lower": plate([0.0, 0.004]), "upper": plate([0.016, 0.02])},
        "current": {"edges": {
            "bottom": [{"voltage_v": 0}], "top": [{"total_current_a": current}]
        }},
        "heat": {"edges": {"bottom": [{"temperature_k": 300}], "top": [{"temperature_k": 300}]}},
        "iterate": {"tolerance": 1e-10, "most": 3000}
    })
}

#[test]
fn the_other_polarity_is_the_mirror_image() {
    let (positive, mut negative) = (solve(&mirror(80.0)), solve(&mirror(-80.0)));
    let grid = &positive.case.grid;
    let (a, b) = (positive.temperature(), negative.temperature());
    for j in 0..grid.nz {
        let mirrored = b[grid.cell(2, grid.nz - 1 - j)];
        let here = a[grid.cell(2, j)];
        assert!(
            (here - mirrored).abs() < 1e-5 * here,
            "{j} {here} {mirrored}"
        );
    }
    let drives = [&positive, &negative].map(|arc| arc.electric.as_ref().unwrap().potential.drive);
    assert!((drives[0] + drives[1]).abs() < 1e-6 * drives[0]);
    let balance = negative.settle().unwrap();
    assert!(balance.closure().abs() < 1e-6 * balance.joule);
    // The lower plate is the anode now: it takes up its work function, the upper one ions.
    assert!((balance.electrodes[0].electron - 80.0 * 4.5).abs() < 1e-6 * 360.0);
    assert!(balance.electrodes[1].ion > 600.0 && balance.electrodes[0].ion.abs() < 1e-12);
}

#[test]
fn a_cathode_of_given_fall_takes_no_more_than_the_supply_gives() {
    for current in [80.0, -80.0] {
        let mut scene = mirror(current);
        for name in ["lower", "upper"] {
            let electrode = scene["bodies"][name]["electrode"].as_object_mut().unwrap();
            electrode.remove("richardson_a_m2_k2");
            electrode.insert("fall_v".to_owned(), json!(15.0));
            electrode.insert("emissivity".to_owned(), json!(0.0));
        }
        let mut arc = solve(&scene);
        let balance = arc.settle().unwrap();
        let voltage = arc.electric.as_ref().unwrap().potential.drive.abs() + 15.0;
        // Both work functions are the same: all that leaves through the edges is voltage times current.
        assert!((80.0 * voltage + balance.edges).abs() < 1e-6 * 80.0 * voltage);
        assert!(balance.closure().abs() < 1e-6 * 80.0 * voltage);
    }
}

#[test]
fn a_sheath_at_the_cathode_changes_sides_with_the_current() {
    for (current, row) in [(80.0, 4), (-80.0, 15)] {
        let mut scene = mirror(current);
        scene["current"]["sheath_m"] = json!(1e-3);
        scene["current"]["sheath_at"] = json!("cathode");
        let case = case(&scene).unwrap();
        let potential = case.potential.as_ref().unwrap();
        let sheath = &potential.sheath.as_ref().unwrap().from;
        let moved: Vec<usize> = (0..sheath.len()).filter(|k| sheath[*k] != *k).collect();
        let rows: Vec<usize> = moved.iter().map(|k| k / case.grid.nr).collect();
        assert_eq!(rows, vec![row; case.grid.nr]);
    }
}

#[test]
fn an_anode_that_current_enters_from_the_gas_is_refused() {
    let mut scene = mirror(-80.0);
    let upper = scene["bodies"]["upper"].as_object_mut().unwrap();
    upper.remove("electrode");
    upper.insert(
        "anode".to_owned(),
        json!({"work_function_v": 4.5, "emissivity": 0.4}),
    );
    let told = case(&scene).unwrap_err();
    assert!(told.contains("/bodies/upper"), "{told}");
    scene["current"]["edges"]["top"][0]["total_current_a"] = json!(80.0);
    assert!(case(&scene).is_ok());
}

/// A column of flux on a cold plate, heated from above through gas.
fn bed() -> Value {
    json!({
        "kind": "arcfvm.scene", "version": 1, "title": "boiling bed",
        "domain": {"r_m": [0, 0.002], "z_m": [0, 0.01]}, "grid": {"r": 0.001, "z": 5e-5},
        "gas": {"given": {"thermal_conductivity_w_m_k": 1, "specific_heat_j_kg_k": 1000}},
        "bodies": {"flux": {
            "shape": {"ring": {"r_m": [0, 0.002], "z_m": [0, 0.0095]}},
            "material": {
                "density_kg_m3": 3000, "specific_heat_j_kg_k": 1000, "thermal_conductivity_w_m_k": 1,
                "melting": {"point_k": 2500, "half_range_k": 1, "latent_heat_j_kg": 5e5}
            },
            "granular": {"slag_conductivity_ratio": 3, "boiling_k": 3100}
        }},
        "heat": {"edges": {"bottom": [{"temperature_k": 300}], "top": [{"flux_w_m2": 5e5}]}},
        "iterate": {"tolerance": 1e-9, "most": 3000}
    })
}

#[test]
fn slag_is_as_thick_as_it_conducts_from_boiling_to_melting() {
    let arc = solve(&bed());
    let grid = &arc.case.grid;
    let gas = |j: &usize| arc.case.material[grid.cell(0, *j)] == 0;
    let front = grid.zf[(0..grid.nz).find(gas).unwrap()];
    // k (Tm - T0) / q of flux and 3 k (Tb - Tm) / q of slag.
    let (flux, slag) = (2200.0 / 5e5, 3.0 * 600.0 / 5e5);
    assert!((front - flux - slag).abs() < 2.0 * 5e-5, "{front}");
    let t = arc.temperature();
    let molten = (0..grid.nz).find(|j| t[grid.cell(0, *j)] > 2500.0).unwrap();
    assert!((grid.zf[molten] - flux).abs() < 1.5 * 5e-5);
    let bed = arcfvm::bed::figures::measure(&arc).unwrap();
    let area = std::f64::consts::PI * 4e-6;
    assert!((bed.slag_volume - slag * area).abs() < 3.0 * 5e-5 * area);
    assert!((bed.wall - area).abs() < 1e-12 && (bed.convection - 5e5 * area).abs() < 1e-6);
}

#[test]
fn flux_that_never_boils_stays_and_costs_nothing_else() {
    let mut scene = bed();
    scene["heat"]["edges"]["top"][0]["flux_w_m2"] = json!(1e5);
    let bed = solve(&scene);
    let plain = scene["bodies"]["flux"].as_object_mut().unwrap();
    plain.remove("granular");
    let plain = solve(&scene);
    assert_eq!(bed.case.material, plain.case.material);
    assert_eq!(bed.temperature(), plain.temperature());
}

#[test]
fn slag_takes_up_what_iron_diffuses_to_it() {
    let mut scene = bed();
    scene["heat"]["edges"]["top"][0] = json!({"temperature_k": 900});
    let gas = scene["gas"]["given"].as_object_mut().unwrap();
    gas.insert("density_kg_m3".to_owned(), json!(0.2));
    gas.insert("iron_diffusion_m2_s".to_owned(), json!(1e-3));
    gas.insert("molar_mass_kg_mol".to_owned(), json!(0.028));
    scene["vapour"] = json!({"edges": {"top": [{"iron_mass_fraction": 0.3}]}});
    scene["bodies"]["flux"]["granular"]["iron_mass_fraction"] = json!(0.1);
    let mut arc = solve(&scene);
    // Half a millimetre of gas between both: rho Gamma area (0.3 - 0.1) / distance.
    let want = 0.2 * 1e-3 * std::f64::consts::PI * 4e-6 * 0.2 / 5e-4;
    let iron = arc.iron_balance().unwrap();
    assert!((iron.edges - want).abs() < 1e-6 * want, "{iron:?}");
    assert!((iron.wall + want).abs() < 1e-6 * want);
    let balance = arc.settle().unwrap();
    assert!(
        balance.closure().abs() < 1e-6 * balance.edges.abs().max(1e-3),
        "{balance:?}"
    );
    // Without the key the wall takes none.
    let granular = scene["bodies"]["flux"]["granular"].as_object_mut().unwrap();
    granular.remove("iron_mass_fraction");
    assert_eq!(case(&scene).unwrap().vapour.unwrap().wall, None);
}

#[test]
fn a_bed_that_cannot_melt_is_refused() {
    let mut scene = bed();
    let material = scene["bodies"]["flux"]["material"].as_object_mut().unwrap();
    material.remove("melting");
    let told = case(&scene).unwrap_err();
    assert!(told.contains("/bodies/flux/granular"), "{told}");
}

/// The two plates with gas that flows, the lower one below a curved surface.
fn pressed(top: &Value) -> Value {
    let mut scene = mirror(80.0);
    scene["grid"] = json!({"r": 5e-4, "z": 5e-4});
    let gas = scene["gas"]["given"].as_object_mut().unwrap();
    gas.insert("density_kg_m3".to_owned(), json!({"expr": "480/T"}));
    gas.insert("viscosity_pa_s".to_owned(), json!(1e-3));
    scene["flow"] = json!({});
    scene["bodies"]["lower"]["shape"] = json!({"profile": {
        "r_m": [0, 0.01], "bottom_m": 0, "top": top
    }});
    scene["iterate"] = json!({"tolerance": 1e-7, "most": 3000});
    scene
}

#[test]
fn a_level_profile_is_a_ring() {
    let level = pressed(&json!({"r_m": [0.005], "z_m": [0.004]}));
    let mut ring = level.clone();
    ring["bodies"]["lower"]["shape"] = json!({"ring": {"r_m": [0, 0.01], "z_m": [0, 0.004]}});
    let (level, ring) = (case(&level).unwrap(), case(&ring).unwrap());
    assert_eq!(level.grid, ring.grid);
    assert_eq!(level.material, ring.material);
    assert_eq!(level.base, ring.base);
    assert!(!level.base.unwrap().is_deformed());
}

#[test]
fn a_pit_takes_up_in_its_columns_what_its_walls_take_up() {
    let scene = pressed(&json!({"r_m": [0, 0.004], "z_m": [0.002, 0.004]}));
    let mut arc = solve(&scene);
    let balance = arc.settle().unwrap();
    let scale = balance.joule;
    assert!(balance.closure().abs() < 1e-6 * scale);
    let base = arc.case.base.clone().unwrap();
    let grid = &arc.case.grid;
    // Half of the first cell lies above 2 mm, where the pit is deepest.
    assert!((grid.zf[base.above[0].unwrap()] - 0.002).abs() < 1e-12);
    assert!(base.is_deformed() && (grid.zf[base.top()] - 0.004).abs() < 1e-12);
    let table = arcfvm::surface::table(&arc, &read(&scene).sample).unwrap();
    let sum = |name: &str| {
        let values = table.values(name).unwrap();
        let rings = values.iter().zip(&grid.ring);
        rings.map(|(q, ring)| q * ring).sum::<f64>()
    };
    let lower = balance.electrodes[0];
    let heat = lower.sum() - lower.joule;
    assert!((sum("heat_flux_total_w_m2") - heat).abs() < 1e-9 * heat.abs());
    assert!((sum("heat_flux_ion_w_m2") - lower.ion).abs() < 1e-9 * lower.ion);
    // All current crosses the surface of the pit.
    assert!((sum("current_density_a_m2") - 80.0).abs() < 1e-6 * 80.0);
    assert!(table.values("surface_height_m").is_ok());
}

#[test]
fn gas_over_a_slope_is_sampled_along_its_normal() {
    let (slope, height): (f64, f64) = (0.4, 9e-4);
    let mut scene = pressed(&json!({"r_m": [0, 0.01], "z_m": [0.002, 0.002 + 0.01 * slope]}));
    scene["start"] = json!({"temperature_k": {"expr": "1000 + 2e5*z - 3e4*r"}});
    scene["sample"] = json!({"temperature_height_m": height, "velocity_height_m": height});
    let settings = Settings::from(&read(&scene).iterate);
    let mut arc = Arc::new(case(&scene).unwrap(), settings);
    let flow = &mut arc.flowing.as_mut().unwrap().flow;
    flow.radial.fill(3.0);
    flow.axial.fill(4.0);
    arc.settle();
    let table = arcfvm::surface::table(&arc, &read(&scene).sample).unwrap();
    let length = slope.hypot(1.0);
    let radius = table.values("radius_m").unwrap();
    let found = table.values("gas_temperature_k").unwrap();
    let speed = table.values("gas_radial_velocity_m_s").unwrap();
    // Beyond the middle of the first and the last cell the field is level.
    for k in 1..radius.len() - 1 {
        let r = radius[k] - height * slope / length;
        let z = 0.002 + slope * radius[k] + height / length;
        let exact = 1000.0 + 2e5 * z - 3e4 * r;
        assert!((found[k] - exact).abs() < 1e-6, "{} for {exact}", found[k]);
        assert!((speed[k] - (3.0 + 4.0 * slope) / length).abs() < 1e-12);
    }
    assert!(radius.len() > 15);
}

#[test]
fn the_volume_of_a_pool_is_met_the_better_the_finer_the_cells() {
    let bowl = |r: f64| 0.002 + 125.0 * r * r;
    let radius: Vec<f64> = (0..=100).map(|i| 4e-5 * f64::from(i)).collect();
    let height: Vec<f64> = radius.iter().map(|r| bowl(*r)).collect();
    let exact = 0.5 * std::f64::consts::PI * 16e-6 * 0.002;
    let mut worst = Vec::new();
    for spacing in [4e-4, 2e-4, 1e-4] {
        let mut scene = pressed(&json!({"r_m": radius, "z_m": height}));
        scene["grid"] = json!({"r": spacing, "z": spacing});
        let case = case(&scene).unwrap();
        let base = case.base.unwrap();
        let rings = base.above.iter().zip(&case.grid.ring);
        let hollow = rings.map(|(row, ring)| ring * (0.004 - case.grid.zf[row.unwrap()]));
        worst.push((hollow.sum::<f64>() / exact - 1.0).abs());
    }
    println!("{worst:?}");
    assert!(
        worst[0] < 0.1 && worst[1] < 0.05 && worst[2] < 0.02,
        "{worst:?}"
    );
}

#[test]
fn a_profile_without_a_surface_asks_for_the_input() {
    let told = case(&pressed(&Value::Null)).unwrap_err();
    assert!(told.contains("--input surface=FILE"), "{told}");
    let told = case(&pressed(&json!({"r_m": [1, 1], "z_m": [0, 0]}))).unwrap_err();
    assert!(told.contains("do not rise"), "{told}");
}

/// Heat flux \[W/m2\] from 5000 K through 6 mm of gas of 0.5 W/(m K) into a plate of 300 K on cells of `size`.
fn through_film(size: f64, film: &Value) -> f64 {
    let mut heat =
        json!({"edges": {"bottom": [{"temperature_k": 300}], "top": [{"temperature_k": 5000}]}});
    let keys = film.as_object().unwrap().clone();
    heat.as_object_mut().unwrap().extend(keys);
    let mut lower = plate([0.0, 0.002]);
    lower["material"]["thermal_conductivity_w_m_k"] = json!(1e6);
    lower.as_object_mut().unwrap().remove("electrode");
    lower["anode"] = json!({"work_function_v": 4.5, "emissivity": 0});
    let mut arc = solve(&json!({
        "kind": "arcfvm.scene", "version": 1, "title": "a film of gas",
        "domain": {"r_m": [0, 0.01], "z_m": [0, 0.008]}, "grid": {"r": 0.005, "z": size},
        "gas": {"given": {"thermal_conductivity_w_m_k": 0.5, "specific_heat_j_kg_k": 1000}},
        "bodies": {"lower": lower},
        "heat": heat,
        "start": {"temperature_k": 1000},
        "iterate": {"tolerance": 1e-8, "most": 3000}
    }));
    arc.settle().unwrap().electrodes[0].convection / (std::f64::consts::PI * 1e-4)
}

/// Half cells: gas is all that is crossed. Centres: as much of the way again as the film is thick.
#[test]
fn a_film_of_given_thickness_lets_the_same_heat_through_on_any_cells() {
    for (way, further) in [("half_cells", 0.0), ("centres", 0.7e-3)] {
        let exact = 0.5 * 4700.0 / (6e-3 + further);
        for size in [2e-3, 1e-3, 5e-4, 2e-4] {
            let found = through_film(size, &json!({"film": way, "film_m": 0.7e-3}));
            let error = (found / exact - 1.0).abs();
            assert!(error < 1e-5, "{way} {size}: {found} {exact}");
        }
    }
    // Without a thickness the film of the source is half a cell.
    for size in [2e-3, 5e-4] {
        let film = through_film(size, &json!({"film": "centres"}));
        let given = through_film(size, &json!({"film": "centres", "film_m": 0.5 * size}));
        assert!((film / given - 1.0).abs() < 1e-9, "{film} {given}");
        let exact = 0.5 * 4700.0 / (6e-3 + 0.5 * size);
        assert!((film / exact - 1.0).abs() < 1e-5, "{film} {exact}");
    }
}
