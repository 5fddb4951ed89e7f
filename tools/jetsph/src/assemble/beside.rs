//! Solids beside water: how the water sees them, and where both meet.

use kernels::{CubicSpline, Kernel, Wendland};
use shapes::Body;

use super::plain_walls;
use super::solid::Made;
use crate::matter::meeting::faces::{BEND_RATE, DEFORMATION_RATE, WARP_RATE};
use crate::matter::meeting::sight::Sight;
use crate::matter::meeting::skin::{DEFORMATION, Skin};
use crate::matter::meeting::wet::Wet;
use crate::matter::water::friction::{Artificial, ArtificialViscosity};
use crate::matter::water::tait::Tait;
use crate::scene::{KernelScene, Scene, WaterScene};
use crate::stage::Stage;
use crate::state::State;

/// Plain walls.
pub(super) fn bodies(scene: &Scene) -> Vec<Body> {
    let walls = plain_walls(&scene.walls, scene.dimensions);
    walls.into_iter().map(|(_, body)| body).collect()
}

/// A solid as the water sees it.
pub(super) fn skin(of: &WaterScene, solid: &Made, state: &mut State) -> Skin {
    let dimensions = state.dimensions;
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
    Skin::new(solid.set, solid.size, solid.cells.clone(), part, dimensions)
}

/// The stage of a solid and the water, which was put into the state last.
pub(super) fn meet(
    scene: &Scene,
    of: &WaterScene,
    law: Tait,
    solid: &Made,
    state: &mut State,
) -> Box<dyn Stage> {
    let walls = bodies(scene);
    let (water, dimensions) = (state.sets.len() - 1, state.dimensions);
    let skin = skin(of, solid, state);
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
            Sight::new(water, skin, CubicSpline::<2>::new(h), walls),
        ),
        (2, KernelScene::Wendland) => wet(
            law,
            friction,
            Sight::new(water, skin, Wendland::<2>::new(h), walls),
        ),
        (_, KernelScene::Spline) => wet(
            law,
            friction,
            Sight::new(water, skin, CubicSpline::<3>::new(h), walls),
        ),
        (_, KernelScene::Wendland) => wet(
            law,
            friction,
            Sight::new(water, skin, Wendland::<3>::new(h), walls),
        ),
    }
}

/// The stage of a solid and the water with a kernel.
fn wet<K: Kernel + 'static>(law: Tait, friction: Artificial, sight: Sight<K>) -> Box<dyn Stage> {
    Box::new(Wet::new(law, friction, sight))
}
