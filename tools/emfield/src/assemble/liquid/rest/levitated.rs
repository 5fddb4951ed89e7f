//! A drop at rest in an alternating field, held against its weight: from a scene to its shape, without a march.
//!
//! At rest no point of the surface is accelerated along its normal: with the pressure of the liquid as it stands, by the same
//! equations as a march has, `a_n = n . (g + (T - grad p)/rho) = 0`. A harmonic of degree l and amplitude c swings back with
//! `-omega_l^2 c`, `omega_l^2 = gamma l (l - 1) (l + 2)/(rho R^3)` (Rayleigh 1879), so that from a shape with accelerations
//! `a_l` the next one has `c + a_l/omega_l^2`: Newton's method but for what the field changes with the shape. The centre stays;
//! what moves it is told.

use run::{Failure, Session};

use crate::assemble::liquid::matter::{matter, way};
use crate::assemble::liquid::{filled, start};
use crate::liquid::air::Place;
use crate::liquid::effort::Effort;
use crate::liquid::magnetic::{Mould, not_round, outline};
use crate::liquid::outline::Outline;
use crate::liquid::step::{Liquid, Step};
use crate::liquid::told::{self, Totals};
use crate::liquid::vector::{difference, direction, dot};
use crate::march::liquid::acting::Acting;
use crate::scene::{Liquid as Part, Scene};

/// Rounds at most.
const ROUNDS: usize = 25;
/// Greatest move of a harmonic over the radius that ends them.
const SETTLED: f64 = 1e-6;

/// Finds the shape and writes it.
///
/// # Errors
/// Where the field does not hold the drop, no shape is found, or the disk refuses.
pub(crate) fn levitated(scene: &Scene, part: &Part, session: &mut Session) -> Result<(), Failure> {
    let mut liquid = start(part, filled(scene, part)?)?;
    let (matter, way, mut effort) = (matter(part), way(scene, part), Effort::default());
    let ball = liquid.clone();
    let skin = Place::of(&ball.position, &ball.normal, way.spacing).skin;
    let mut shape = outline(skin, ball.middle())?;
    let middle = shape.origin;
    let radius = (0.75 * shape.volume().0 / std::f64::consts::PI).cbrt();
    let mut acting = Acting::new(scene, part, &liquid, session)?;
    let stiff = matter.tension / (matter.density * radius.powi(3));
    let mut moved = f64::INFINITY;
    let (mut rounds, mut left) = (0, [0.0; 3]);
    while rounds < ROUNDS && moved > SETTLED * radius {
        rounds += 1;
        follow(&mut liquid, &ball, &shape, radius);
        let step = Step { way: &way, dt: 0.0 };
        acting.pull(&mut liquid, step, middle, &mut effort, session)?;
        acting.hold(part, &matter, &mut liquid, &way, middle)?;
        let solved = session.timed("pressure", || liquid.balance(&matter, &way, &mut effort));
        let patches = solved?;
        let surface = &liquid.position[..patches.len()];
        let rises: Vec<f64> = (surface.iter().zip(&patches).zip(&liquid.rate))
            .map(|((x, patch), rate)| {
                let ray = direction(&difference(x, &middle));
                dot(rate, &patch.normal) / dot(&ray, &patch.normal)
            })
            .collect();
        let found = shape.fitted(surface, &rises).ok_or_else(not_round)?;
        let slack = |l: usize| match l {
            0 | 1 => 0.0,
            l => ((l * (l - 1) * (l + 2)) as f64 * stiff).recip(),
        };
        let steps = found.iter().enumerate().map(|(k, a)| a * slack(k.isqrt()));
        moved = steps.fold(0.0, |most: f64, step| most.max(step.abs()));
        let mass = matter.density * shape.volume().0;
        left = std::array::from_fn(|k| acting.force()[k] + mass * matter.gravity[k]);
        session.history("move", "m", rounds as f64, moved);
        shape = shape.moved(&found, slack);
    }
    if moved > SETTLED * radius {
        session.warn(format!(
            "not converged: after {rounds} rounds the shape still moves by {moved:.2e} m"
        ));
    }
    let weight = matter.density * shape.volume().0 * dot(&matter.gravity, &matter.gravity).sqrt();
    let lack = dot(&left, &left).sqrt();
    if lack > 1e-3 * weight {
        session.note(format!(
            "the shape is that of a drop whose centre is held: force and weight leave {lack:.3e} N of {weight:.3e} N; with \"balanced\" the currents are found that leave none along gravity"
        ));
    }
    write(scene, part, &liquid, &shape, &acting, session)?;
    session.closing("rounds", "1", rounds as f64);
    session.closing("move", "m", moved);
    acting.close(&effort, session);
    Ok(())
}

/// Takes the points of a liquid to where those of the ball lie in a shape.
fn follow(liquid: &mut Liquid<3>, ball: &Liquid<3>, shape: &Outline, radius: f64) {
    let mould = Mould {
        centre: shape.origin,
        radius,
        outline: shape,
    };
    for (x, own) in liquid.position.iter_mut().zip(&ball.position) {
        *x = mould.place(own).0;
    }
    for (n, own) in liquid.normal.iter_mut().zip(&ball.position) {
        *n = shape.normal(&direction(&difference(own, &shape.origin)));
    }
}

fn write(
    scene: &Scene,
    part: &Part,
    liquid: &Liquid<3>,
    shape: &Outline,
    acting: &Acting,
    session: &mut Session,
) -> Result<(), Failure> {
    let matter = matter(part);
    let precision = scene.output.precision.into();
    let totals = Totals::new(liquid, &matter, shape).ok_or_else(not_round)?;
    let row = acting.row(totals.row(&matter, shape));
    session.record("/liquid", 0.0, &row)?;
    let points = told::points(liquid, &matter, &acting.pressure, precision);
    session.frame("/points", 0.0, &points)?;
    let surface = &liquid.position[..liquid.surface()];
    let patches = crate::liquid::surface::patches(surface, &liquid.normal, scene.points.spacing_m);
    let patches = patches.map_err(|e| Failure::Other(format!("liquid: {e}")))?;
    session.frame("/surface", 0.0, &told::surface(liquid, &patches, precision))
}
