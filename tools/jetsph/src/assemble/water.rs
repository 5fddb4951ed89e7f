//! The water of a scene: its set, its stage, nozzles and outlets.

use std::f64::consts::SQRT_2;

use kernels::{CubicSpline, Kernel, Wendland};
use particles::{Matter, POSITION, Set};
use run::Fault;
use run::property::{Arguments, Curve, Property};
use shapes::Body;

use super::solid::Made;
use super::{plain_walls, vector};
use crate::matter::lattice::{Filling, Lattice};
use crate::matter::meeting::faces::{BEND_RATE, DEFORMATION_RATE, WARP_RATE};
use crate::matter::meeting::sight::Sight;
use crate::matter::meeting::skin::{DEFORMATION, Skin};
use crate::matter::meeting::wet::Wet;
use crate::matter::shares::shares;
use crate::matter::water::friction::{Artificial, ArtificialViscosity};
use crate::matter::water::near::LISTED;
use crate::matter::water::nozzle::{Feed, LED, Nozzle};
use crate::matter::water::outlet::Outlet;
use crate::matter::water::tait::Tait;
use crate::matter::water::{DivergenceFree, Flow, Liquid, Water};
use crate::scene::{KernelScene, Method, NozzleScene, OutletScene, Scene, WaterBody, WaterScene};
use crate::stage::Stage;
use crate::state::{ACCELERATION, DENSITY, MASS, State, VELOCITY};

/// c over V of (18).
const SOUND: f64 = 10.0;
/// Parts of the run in each of which the speed of a nozzle is bounded for V.
const PARTS: usize = 200;

/// The stage of the water, its law, and the stages that must come after all others.
type Stages = (Box<dyn Stage>, Tait, Vec<Box<dyn Stage>>);

/// Puts the water of a scene into the state.
pub(super) fn water(scene: &Scene, of: &WaterScene, state: &mut State) -> Result<Stages, Fault> {
    let dimensions = scene.dimensions;
    let place = state.sets.len();
    let mut set = empty_set(of);
    let walls = plain_walls(&scene.walls, dimensions);
    let mut fastest = 0.0_f64;
    let mut pressures = Vec::new();
    for (k, body) in of.bodies.iter().enumerate() {
        let at = format!("/bodies/{k}");
        let filled = fill(body, of, dimensions, &mut set, state);
        pressures.extend(filled.map_err(|fault| fault.within(&at))?);
    }
    for u in set.column(&VELOCITY) {
        fastest = fastest.max(u[0].hypot(u[1]).hypot(u[2]));
    }
    let nozzles = nozzles(scene, of, place)?;
    fastest = nozzles.iter().map(Nozzle::most).fold(fastest, f64::max);
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
    for (row, pressure) in pressures.into_iter().enumerate() {
        let density = match of.method {
            Method::WeaklyCompressible => law.density_at(pressure),
            Method::DivergenceFree => of.density_kg_m3,
        };
        set.column_mut(&DENSITY)[row] = density;
        set.column_mut(&MASS)[row] *= density;
    }
    state.sets.push(set);
    let last = ways(of, nozzles, law, place, state)?;
    let h = of.smoothing * of.spacing_m;
    if of.method == Method::DivergenceFree {
        let liquid = Liquid {
            set: place,
            density: of.density_kg_m3,
            spacing: of.spacing_m,
            smoothing_length: h,
            walls,
        };
        return Ok((soundless(liquid, (dimensions, of.kernel)), law, last));
    }
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
    Ok((sounding(water, (dimensions, of.kernel)), law, last))
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
fn soundless(liquid: Liquid, kind: (usize, KernelScene)) -> Box<dyn Stage> {
    let h = liquid.smoothing_length;
    match kind {
        (2, KernelScene::Spline) => Box::new(DivergenceFree::<2, _>::new(
            liquid,
            CubicSpline::<2>::new(h),
        )),
        (2, KernelScene::Wendland) => {
            Box::new(DivergenceFree::<2, _>::new(liquid, Wendland::<2>::new(h)))
        }
        (_, KernelScene::Spline) => Box::new(DivergenceFree::<3, _>::new(
            liquid,
            CubicSpline::<3>::new(h),
        )),
        (_, KernelScene::Wendland) => {
            Box::new(DivergenceFree::<3, _>::new(liquid, Wendland::<3>::new(h)))
        }
    }
}

/// The stage of a solid and the water, which was put into the state last.
pub(super) fn meet(of: &WaterScene, law: Tait, solid: &Made, state: &mut State) -> Box<dyn Stage> {
    let (water, dimensions) = (state.sets.len() - 1, state.dimensions);
    let set = &mut state.sets[solid.set];
    [DEFORMATION, DEFORMATION_RATE, BEND_RATE, WARP_RATE]
        .iter()
        .for_each(|column| set.declare(column));
    // A cell that is no smaller than what it is divided to is one point: the arrangement of the source (figs 4 and 5).
    let part = if solid.is_updated {
        f64::INFINITY
    } else {
        of.spacing_m
    };
    let skin = Skin::new(solid.set, solid.size, solid.cells.clone(), part, dimensions);
    let h = 0.5 * of.smoothing * (of.spacing_m + skin.spacing);
    let none = ArtificialViscosity {
        linear: 0.0,
        quadratic: 0.0,
        guard: ArtificialViscosity::usual_guard(),
    };
    let artificial = of.artificial_viscosity.unwrap_or(none);
    let friction = Artificial::new(&artificial, law.density, law.sound_speed, h);
    match (dimensions, of.kernel) {
        (2, KernelScene::Spline) => wet(
            law,
            friction,
            Sight::new(water, skin, CubicSpline::<2>::new(h)),
        ),
        (2, KernelScene::Wendland) => wet(
            law,
            friction,
            Sight::new(water, skin, Wendland::<2>::new(h)),
        ),
        (_, KernelScene::Spline) => wet(
            law,
            friction,
            Sight::new(water, skin, CubicSpline::<3>::new(h)),
        ),
        (_, KernelScene::Wendland) => wet(
            law,
            friction,
            Sight::new(water, skin, Wendland::<3>::new(h)),
        ),
    }
}

/// The stage of a solid and the water with a kernel.
fn wet<K: Kernel + 'static>(law: Tait, friction: Artificial, sight: Sight<K>) -> Box<dyn Stage> {
    Box::new(Wet::new(law, friction, sight))
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
    for (k, nozzle) in nozzles.into_iter().enumerate() {
        let feed = Feed::new(nozzle);
        let mut feed = feed.map_err(|what| Fault::at(&format!("/nozzles/{k}/profile"), what))?;
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

/// Fills a body with water whose masses are volumes yet; gives the pressure of each particle \[Pa\].
fn fill(
    of: &WaterBody,
    water: &WaterScene,
    dimensions: usize,
    set: &mut Set,
    state: &mut State,
) -> Result<Vec<f64>, Fault> {
    let filling = Filling {
        spacing: water.spacing_m,
        turned: 0.0,
        jitter: 0.0,
        dimensions,
    };
    let body = Body::new(&of.body, dimensions);
    let lattice = Lattice::fill(&body, &filling).map_err(|what| Fault::at("/body", what))?;
    if lattice.places.is_empty() {
        let what = format!("holds no particle at a spacing of {} m", water.spacing_m);
        return Err(Fault::at("/body", what));
    }
    let volume = volume(&body, &lattice, dimensions);
    let compiled = |property: &Property, at: String| -> Result<(Curve, String), Fault> {
        Ok((property.compile(&at, &["x", "y", "z", "r"])?, at))
    };
    let velocity: Vec<(Curve, String)> = of
        .velocity_m_s
        .iter()
        .flatten()
        .enumerate()
        .map(|(axis, property)| compiled(property, format!("/velocity_m_s/{axis}")))
        .collect::<Result<_, _>>()?;
    let pressure = of
        .pressure_pa
        .as_ref()
        .map(|property| compiled(property, "/pressure_pa".to_owned()))
        .transpose()?;
    let mut pressures = Vec::new();
    for place in &lattice.places {
        let at = Arguments::at(*place, 0.0);
        let value = |(curve, name): &(Curve, String)| {
            let value = curve.value(&at);
            value.map_err(|e| Fault::at(name, e.to_string()))
        };
        let row = set.push(&mut state.ids);
        set.column_mut(&POSITION)[row] = *place;
        set.column_mut(&MASS)[row] = volume;
        for (axis, curve) in velocity.iter().enumerate() {
            set.column_mut(&VELOCITY)[row][axis] = value(curve)?;
        }
        pressures.push(pressure.as_ref().map_or(Ok(0.0), value)?);
    }
    Ok(pressures)
}

/// Volume of each particle of a body, in the plane its area: that of a cell where cells end where the body does, else the same part
/// of what the body has \[m3\].
fn volume(body: &Body, lattice: &Lattice, dimensions: usize) -> f64 {
    let cell: f64 = lattice.cell[..dimensions].iter().product();
    let shares = shares(body, lattice, dimensions);
    if shares.is_empty() {
        return cell;
    }
    cell * shares.iter().sum::<f64>() / shares.len() as f64
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
