//! A few steps taken to tell how long a run will last.

use std::f64::consts::PI;
use std::time::{Duration, Instant};

use particles::POSITION;
use run::{Estimate, Failure, duration};
use shapes::frame::{difference, squared};

use crate::assemble::Assembled;
use crate::march::March;
use crate::scene::{Scene, StartState};
use crate::state::{ENTHALPY, State, TEMPERATURE};

/// Steps ahead of those that are timed: they fill the lists.
const WARM: u64 = 2;
/// The timed steps end with this number or after this time.
const MOST: u64 = 50;
const LONGEST: Duration = Duration::from_millis(500);
/// Part of the heat that melts metal, about: the rest warms what stays solid.
const MELTS: f64 = 0.35;
/// Temperature of the pool over the melting point.
const ABOVE: f64 = 1.1;

/// Time of the whole run, if every step lasts as long as the first ones; where a pool is still to melt, as long as those with
/// a pool do.
///
/// # Errors
/// What a step reports.
pub(crate) fn estimate(scene: &Scene, run: Assembled) -> Result<Estimate, Failure> {
    let Assembled {
        mut march,
        mut state,
        ..
    } = run;
    let total = scene.steps();
    let mut timed = timed(&mut march, &mut state, total)?;
    let mut basis = if scene.has_metal() {
        let liquid = state.liquid();
        format!("with the {liquid} liquid particles of the start")
    } else {
        String::new()
    };
    let pool = Pool::of(scene, &state, &march).filter(|_| melts(scene));
    if let Some(pool) = pool {
        pool.melt(&mut state);
        timed = self::timed(&mut march, &mut state, total)?;
        basis = format!("with a pool of some {} particles", pool.particles);
    }
    let each = short(timed.each);
    Ok(Estimate {
        seconds: timed.whole * total as f64,
        basis: match basis.as_str() {
            "" => format!("{each} a step"),
            with => format!("{each} a step, {with}"),
        },
        memory: Vec::new(),
    })
}

/// What steps took \[s\]: one of those taken, and one of the scene's length.
#[derive(Debug, Clone, Copy)]
struct Timed {
    each: f64,
    whole: f64,
}

/// Takes a few steps of at most `total`.
fn timed(march: &mut March, state: &mut State, total: u64) -> Result<Timed, Failure> {
    let mut step = || {
        let done = march.step(state, u64::MAX, |_, work| work());
        done.map_err(|e| Failure::Other(e.to_string()))
    };
    for _ in 0..WARM.min(total) {
        step()?;
    }
    let began = Instant::now();
    let (mut taken, mut passed) = (0, 0);
    while taken < MOST && (taken == 0 || began.elapsed() < LONGEST) {
        passed += step()?.stride;
        taken += 1;
    }
    let spent = began.elapsed().as_secs_f64();
    Ok(Timed {
        each: spent / taken as f64,
        whole: spent / passed as f64,
    })
}

/// A pool as large as the heat of a run melts.
struct Pool {
    particles: usize,
    centre: [f64; 3],
    /// Of its metal: \[K\] and \[J/kg\].
    temperature: f64,
    enthalpy: f64,
}

impl Pool {
    /// The half sphere that the heat melts while its source goes as far as it is large, or until the end:
    ///
    /// ```text
    /// V = f P t / (rho dh),   t = min(end, L/v),   V = 2/3 pi L^3
    /// ```
    ///
    /// A guess within a factor of two or so; nothing where no heat has a place.
    fn of(scene: &Scene, state: &State, march: &March) -> Option<Self> {
        let caloric = scene.heat.as_ref()?.caloric().ok()?;
        let melting = caloric.melting_point()?;
        let torch = scene.torches.first();
        let stand = torch.map(|torch| torch.stand(torch.path.burns()[0]).place);
        let centre = state.source.map(|source| source.position).or(stand)?;
        let put = |name: &str| name.starts_with("energy_in_") && name != "energy_in_droplets_j";
        let figures = march.figures().into_iter().map(|(_, figure)| figure);
        let figures = figures.filter(|figure| put(figure.name));
        let heated = figures.map(|figure| figure.value).sum::<f64>() / state.time;
        let droplets = scene.wires().filter_map(|wire| {
            let kelvin = wire.droplets.temperature_k.filter(|t| caloric.covers(*t))?;
            let volume = 4.0 / 3.0 * PI * wire.droplets.radius_m.powi(3);
            let mass = scene.density_kg_m3 * volume;
            Some(mass * caloric.enthalpy(kelvin) / scene.droplet_period(&wire)?)
        });
        let power = heated + droplets.sum::<f64>();
        // Not a number at time 0 too.
        if power.is_nan() || power <= 0.0 {
            return None;
        }
        let temperature = (ABOVE * melting).min(caloric.range().1);
        let enthalpy = caloric.enthalpy(temperature);
        let melted = MELTS * power / (scene.density_kg_m3 * caloric.halfway(1.0));
        let along = scene
            .source
            .map(|source| squared(source.velocity_m_s).sqrt());
        let speed = along.or_else(|| torch?.path.speed_m_s).unwrap_or(0.0);
        let length = (1.5 * melted / (PI * speed)).sqrt();
        let volume = melted * (length / speed).min(scene.time.end_s);
        let particles = volume / state.metal.matter.volume();
        Some(Self {
            particles: (particles as usize).clamp(1, state.len()),
            centre,
            temperature,
            enthalpy,
        })
    }

    /// Melts the particles that are nearest to its centre.
    fn melt(&self, state: &mut State) {
        let columns = (&POSITION, &ENTHALPY, &TEMPERATURE);
        let (places, enthalpies, temperatures) = state.metal.columns_mut(columns);
        let mut nearest: Vec<(f64, usize)> = (places.iter().enumerate())
            .map(|(a, x)| (squared(difference(*x, self.centre)), a))
            .collect();
        nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, a) in &nearest[..self.particles.min(nearest.len())] {
            enthalpies[*a] = self.enthalpy;
            temperatures[*a] = self.temperature;
        }
    }
}

/// Whether a pool is still to melt.
fn melts(scene: &Scene) -> bool {
    let melts = scene.heat.as_ref().is_some_and(|h| h.melting.is_some()) && scene.flow.is_some();
    let fed = scene.arc.is_some() || !scene.torches.is_empty() || scene.wires().next().is_some();
    let dry = scene.bodies.iter().all(|b| b.state != StartState::Liquid);
    melts && fed && dry
}

/// Why steps become longer than those that are timed: a pool that is still to melt, and no source that says where.
pub(crate) fn grows(scene: &Scene) -> Option<&'static str> {
    let placed = scene.source.is_some() || !scene.torches.is_empty();
    (melts(scene) && !placed).then_some("steps last longer once there is a pool")
}

/// Milliseconds with digits where they are few.
fn short(seconds: f64) -> String {
    if seconds < 0.1 {
        format!("{:.2} ms", 1e3 * seconds)
    } else {
        duration(seconds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assemble::assemble;
    use crate::state::PHASE;
    use run::Inputs;

    /// A torch of 2 kW over a plate that melts at 1500 K: c = 500 J/(kg K), L = 2e5 J/kg, from 300 K.
    fn plate(more: &str) -> Scene {
        let text = format!(
            r#"{{"spacing_m": 5e-4, "time": {{"step_s": 1e-4, "end_s": 10}}, "density_kg_m3": 8000,
            "bodies": [{{"shape": {{"box": {{"min_m": [-0.01, 0, -0.004], "max_m": [0.01, 0.02, 0]}}}}, "state": "solid", "temperature_k": 300}}],
            "flow": {{"viscosity_pa_s": 0.005}}, "flow_start": {{"liquid_particles": 1}},
            "heat": {{"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 500, "melting": {{"point_k": 1500, "latent_heat_j_kg": 2e5}}}},
            "torches": [{{"power_w": 2000, "path": {{"points_m": [[0, 0.01, 0], [0, 0.02, 0]], "speed_m_s": 0.01}},
                "shape": {{"gaussian": {{"radius_m": 0.003}}}}}}]{more},
            "output": {{"particles_interval_s": 1}}}}"#
        );
        serde_json::from_str(&text).unwrap()
    }

    fn assembled(scene: &Scene) -> Assembled {
        assemble(scene, &Inputs::none()).unwrap()
    }

    #[test]
    fn a_pool_is_as_large_as_the_heat_melts_while_the_source_goes_as_far() {
        let scene = plate("");
        let mut run = assembled(&scene);
        timed(&mut run.march, &mut run.state, scene.steps()).unwrap();
        let pool = Pool::of(&scene, &run.state, &run.march).unwrap();
        // Enthalpies count from 0 K: dh = 500 x 1500 + 2e5 J/kg.
        let melted = MELTS * 2000.0 / (8000.0 * 9.5e5);
        let length = (1.5 * melted / (PI * 0.01)).sqrt();
        let exact = 2.0 / 3.0 * PI * length.powi(3) / 5e-4_f64.powi(3);
        let found = pool.particles as f64;
        assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
        pool.melt(&mut run.state);
        run.march
            .step(&mut run.state, u64::MAX, |_, work| work())
            .unwrap();
        let phases = run.state.metal.column(&PHASE);
        let liquid = phases.iter().filter(|p| **p == crate::state::phase::LIQUID);
        assert!((liquid.count() as f64 / found - 1.0).abs() < 0.1);
    }

    #[test]
    fn only_what_is_still_to_melt_is_foretold_with_a_pool() {
        let scene = plate("");
        assert!(melts(&scene) && grows(&scene).is_none());
        let told = estimate(&scene, assembled(&scene)).unwrap();
        assert!(told.basis.contains("with a pool of some"), "{}", told.basis);
        let mut cold = scene;
        cold.torches.clear();
        assert!(!melts(&cold));
        let told = estimate(&cold, assembled(&cold)).unwrap();
        assert!(told.basis.contains("of the start"), "{}", told.basis);
    }
}
