//! The water of a scene: its set, its stage, nozzles and outlets.

use std::f64::consts::SQRT_2;

use kernels::{CubicSpline, Kernel, Wendland};
use particles::{Matter, POSITION, Set};
use run::Fault;
use run::property::Arguments;
use shapes::Body;

use super::beside::{bodies, skin};
use super::pouring::Pouring;
use super::solid::Made;
use super::{plain_walls, vector};
use crate::matter::meeting::sight::Sight;
use crate::matter::meeting::skin::Skin;
use crate::matter::water::friction::Artificial;
use crate::matter::water::near::LISTED;
use crate::matter::water::nozzle::{Feed, LED, Nozzle};
use crate::matter::water::outlet::Outlet;
use crate::matter::water::tait::{Tait, Tension};
use crate::matter::water::{DivergenceFree, Flow, Liquid, Shore, Water};
use crate::scene::{KernelScene, Method, NozzleScene, OutletScene, Scene, WaterScene};
use crate::stage::{Stage, place_text};
use crate::state::{ACCELERATION, DENSITY, MASS, State, VELOCITY};

/// c over V of (18).
const SOUND: f64 = 10.0;
/// Parts of the run in each of which the speed of a nozzle is bounded for V.
const PARTS: usize = 200;
/// Part of B by which the pressure of a formula may miss what it stands for.
const ROUNDING: f64 = 1e-9;

/// The water of a scene.
pub(super) struct Flowing {
    /// Its stage.
    pub(super) stage: Box<dyn Stage>,
    /// Its equation of state.
    pub(super) law: Tait,
    /// Stages that must come after all others.
    pub(super) last: Vec<Box<dyn Stage>>,
    /// What a person should know of how it was filled.
    pub(super) notes: Vec<String>,
}

/// Puts the water of a scene into the state.
pub(super) fn water(
    scene: &Scene,
    of: &WaterScene,
    solids: &[Made],
    state: &mut State,
) -> Result<Flowing, Fault> {
    let dimensions = scene.dimensions;
    let place = state.sets.len();
    let mut set = empty_set(of);
    let walls = plain_walls(&scene.walls, dimensions);
    let nozzles = nozzles(scene, of, place)?;
    let mut filling = Pouring::new(scene, of, &nozzles);
    for (k, body) in of.bodies.iter().enumerate() {
        let filled = filling.fill(body, &mut set, state);
        filled.map_err(|fault| fault.within(&format!("/bodies/{k}")))?;
    }
    let (pressures, notes) = (filling.pressures, filling.notes);
    let fastest = nozzles.iter().map(Nozzle::most).fold(speed(&set), f64::max);
    let law = Tait {
        density: of.density_kg_m3,
        sound_speed: if of.method == Method::DivergenceFree {
            0.0
        } else {
            sound(of, fastest)?
        },
        exponent: of.exponent,
        tension: of.tension,
    };
    condense(of, &law, pressures, &mut set)?;
    state.sets.push(set);
    let last = ways(of, nozzles, law, place, state)?;
    let h = of.smoothing * of.spacing_m;
    let kind = (dimensions, of.kernel);
    let stage = if of.method == Method::DivergenceFree {
        let liquid = Liquid {
            set: place,
            density: of.density_kg_m3,
            spacing: of.spacing_m,
            smoothing_length: h,
            walls,
            pulls: of.tension == Tension::Full,
        };
        let skins = solids.iter().map(|solid| skin(of, solid, state)).collect();
        soundless(scene, liquid, kind, skins)
    } else {
        let artificial = of.artificial_viscosity;
        let water = Water {
            set: place,
            law,
            smoothing_length: h,
            artificial: artificial.map(|a| Artificial::new(&a, law.density, law.sound_speed, h)),
            viscosity: of.viscosity_pa_s,
            diffusion: of.density_diffusion,
            walls,
        };
        sounding(water, kind)
    };
    Ok(Flowing {
        stage,
        law,
        last,
        notes,
    })
}

/// The greatest speed of what stands there \[m/s\].
fn speed(set: &Set) -> f64 {
    let all = set.column(&VELOCITY).iter();
    all.map(|u| u[0].hypot(u[1]).hypot(u[2]))
        .fold(0.0, f64::max)
}

/// The stage of water with sound.
fn sounding(water: Water, kind: (usize, KernelScene)) -> Box<dyn Stage> {
    let h = water.smoothing_length;
    match kind {
        (2, KernelScene::Spline) => Box::new(Flow::<2, _>::new(water, CubicSpline::<2>::new(h))),
        (2, KernelScene::Wendland) => Box::new(Flow::<2, _>::new(water, Wendland::<2>::new(h))),
        (_, KernelScene::Spline) => Box::new(Flow::<3, _>::new(water, CubicSpline::<3>::new(h))),
        (_, KernelScene::Wendland) => Box::new(Flow::<3, _>::new(water, Wendland::<3>::new(h))),
    }
}

/// The stage of water without sound.
fn soundless(
    scene: &Scene,
    liquid: Liquid,
    kind: (usize, KernelScene),
    skins: Vec<Skin>,
) -> Box<dyn Stage> {
    let h = liquid.smoothing_length;
    match kind {
        (2, KernelScene::Spline) => free::<2, _>(scene, liquid, CubicSpline::<2>::new(h), skins),
        (2, KernelScene::Wendland) => free::<2, _>(scene, liquid, Wendland::<2>::new(h), skins),
        (_, KernelScene::Spline) => free::<3, _>(scene, liquid, CubicSpline::<3>::new(h), skins),
        (_, KernelScene::Wendland) => free::<3, _>(scene, liquid, Wendland::<3>::new(h), skins),
    }
}

/// The stage of water without sound with a kernel.
fn free<const D: usize, K: Kernel + Clone + 'static>(
    scene: &Scene,
    liquid: Liquid,
    kernel: K,
    skins: Vec<Skin>,
) -> Box<dyn Stage> {
    let shore = |skin| Shore {
        sight: Sight::new(liquid.set, skin, kernel.clone(), bodies(scene)),
    };
    let shores = skins.into_iter().map(shore).collect();
    Box::new(DivergenceFree::<D, K>::new(liquid, kernel, shores))
}

/// The set without particles.
fn empty_set(of: &WaterScene) -> Set {
    let matter = Matter {
        density: of.density_kg_m3,
        spacing: of.spacing_m,
        smoothing_length: of.smoothing * of.spacing_m,
    };
    let mut set = Set::new("water", matter);
    set.declare(&VELOCITY);
    set.declare(&ACCELERATION);
    set.declare(&MASS);
    set.declare(&DENSITY);
    set.declare(&LISTED);
    if !of.nozzles.is_empty() {
        set.declare(&LED);
    }
    set
}

/// All nozzles.
fn nozzles(scene: &Scene, of: &WaterScene, set: usize) -> Result<Vec<Nozzle>, Fault> {
    let each = of.nozzles.iter().enumerate();
    each.map(|(k, nozzle)| {
        let made = self::nozzle(nozzle, of, scene.dimensions, set, k);
        let mut made = made.map_err(|fault| fault.within(&format!("/nozzles/{k}")))?;
        made.fastest = fastest_of(&made, scene.time.end_s);
        Ok(made)
    })
    .collect()
}

/// Greatest mean speed of the water of a nozzle until the end \[m/s\], however short its pulses are; where a part of the run has
/// no bound, that at its ends.
fn fastest_of(nozzle: &Nozzle, end: f64) -> f64 {
    let (from, to) = (nozzle.runs.0.min(end), nozzle.runs.1.min(end));
    let at = |k: usize| Arguments::at([0.0; 3], from + (to - from) * k as f64 / PARTS as f64);
    let most = |k: usize| {
        let (low, high) = (at(k), at(k + 1));
        let bound = nozzle.speed.bounds(&low, &high).high;
        if bound.is_finite() {
            return bound;
        }
        let ends = [low, high].map(|at| nozzle.speed.value(&at).unwrap_or(0.0));
        ends[0].max(ends[1])
    };
    (0..PARTS).map(most).fold(0.0, f64::max)
}

/// Nozzles and outlets, which come after all other stages.
fn ways(
    of: &WaterScene,
    nozzles: Vec<Nozzle>,
    law: Tait,
    set: usize,
    state: &mut State,
) -> Result<Vec<Box<dyn Stage>>, Fault> {
    let mut last: Vec<Box<dyn Stage>> = Vec::new();
    for (k, nozzle) in nozzles.iter().enumerate() {
        let feed = Feed::new(nozzle.clone());
        let mut feed = feed.map_err(|what| Fault::at(&format!("/nozzles/{k}/profile"), what))?;
        let within = |other: &&Nozzle| feed.places().iter().any(|place| other.holds(*place));
        if let Some(other) = nozzles[..k].iter().find(within) {
            let what = format!(
                "its water would stand in that of nozzle \"{}\", {:.3e} m long before its exit: move or turn one of them",
                other.name,
                other.led()
            );
            return Err(Fault::at(&format!("/nozzles/{k}/exit_m"), what));
        }
        let filled = feed.fill(state);
        filled.map_err(|what| Fault::at(&format!("/nozzles/{k}/speed_m_s"), what.to_string()))?;
        last.push(Box::new(feed));
    }
    for outlet in &of.outlets {
        if let Some(outlet) = self::outlet(outlet, law, set, state.dimensions) {
            last.push(Box::new(outlet));
        }
    }
    Ok(last)
}

/// Gives particles the density of their pressures \[Pa\] in their bodies, and mass for volume.
fn condense(
    of: &WaterScene,
    law: &Tait,
    pressures: Vec<(usize, f64)>,
    set: &mut Set,
) -> Result<(), Fault> {
    for (row, (body, pressure)) in pressures.into_iter().enumerate() {
        let density = match of.method {
            Method::WeaklyCompressible => {
                let density = borne(law, pressure, set.column(&POSITION)[row]);
                density.map_err(|what| Fault::at(&format!("/bodies/{body}/pressure_pa"), what))?
            }
            Method::DivergenceFree => of.density_kg_m3,
        };
        set.column_mut(&DENSITY)[row] = density;
        set.column_mut(&MASS)[row] *= density;
    }
    Ok(())
}

/// The density at a pressure \[Pa\] of the start; says why there is none.
fn borne(law: &Tait, pressure: f64, place: [f64; 3]) -> Result<f64, String> {
    let stiffness = law.stiffness();
    let least = match law.tension {
        // A pressure of 0 that a formula misses by rounding.
        Tension::None => -ROUNDING * stiffness,
        Tension::Full => -stiffness * (1.0 - ROUNDING),
    };
    if pressure >= least {
        return Ok(law.density_at(pressure));
    }
    let at = place_text(place);
    Err(match law.tension {
        Tension::None => format!(
            "is {pressure} Pa at {at}; water that does not pull has no pressure below 0: take at least 0, or \"tension\": \"full\""
        ),
        Tension::Full => format!(
            "is {pressure} Pa at {at}; the equation of state ends at {:.3e} Pa: take more, or a greater 'sound_speed_m_s'",
            -stiffness
        ),
    })
}

/// c: told, or ten times what is told or found to be the speed.
fn sound(of: &WaterScene, fastest: f64) -> Result<f64, Fault> {
    let speed = of.reference_speed_m_s.unwrap_or(fastest);
    let sound = of.sound_speed_m_s.unwrap_or(SOUND * speed);
    if sound > 0.0 {
        return Ok(sound);
    }
    let what = "nothing moves at the start: water wants 'reference_speed_m_s' or 'sound_speed_m_s'";
    Err(Fault::at("", what))
}

fn nozzle(
    of: &NozzleScene,
    water: &WaterScene,
    dimensions: usize,
    set: usize,
    number: usize,
) -> Result<Nozzle, Fault> {
    let given = vector(Some(&of.direction));
    let length = given[0].hypot(given[1]).hypot(given[2]);
    if length <= 0.0 {
        return Err(Fault::at("/direction", "points nowhere"));
    }
    let direction = given.map(|x| x / length);
    let [x, y, z] = direction;
    let first = if dimensions == 2 || z.abs() < 0.5 * SQRT_2 {
        let across = x.hypot(y);
        [-y / across, x / across, 0.0]
    } else {
        let across = y.hypot(z);
        [0.0, -z / across, y / across]
    };
    let second = [
        y * first[2] - z * first[1],
        z * first[0] - x * first[2],
        x * first[1] - y * first[0],
    ];
    Ok(Nozzle {
        name: of.name.clone(),
        set,
        mark: number as u8 + 1,
        exit: vector(Some(&of.exit_m)),
        direction,
        across: [first, second],
        width: of.width_m,
        speed: of.speed_m_s.compile("/speed_m_s", &["t"])?,
        fastest: 0.0,
        profile: of
            .profile
            .as_ref()
            .map(|profile| profile.compile("/profile", &["r"]))
            .transpose()?,
        traverse: vector(of.traverse_m_s.as_deref()),
        runs: (of.start_s, of.end_s.unwrap_or(f64::INFINITY)),
        matter: (
            water.density_kg_m3,
            water.spacing_m,
            2.0 * water.smoothing * water.spacing_m,
        ),
        dimensions,
        has_sound: water.method == Method::WeaklyCompressible,
    })
}

/// None without a shape, which a scene is refused for.
fn outlet(of: &OutletScene, law: Tait, set: usize, dimensions: usize) -> Option<Outlet> {
    let shape = of.within.as_ref().or(of.beyond.as_ref())?;
    let (body, beyond) = (Body::new(shape, dimensions), of.within.is_none());
    let moving = of.moving_m_s.as_deref().map(|u| vector(Some(u)));
    Some(Outlet::new(of.name.clone(), set, body, beyond, moving, law))
}
