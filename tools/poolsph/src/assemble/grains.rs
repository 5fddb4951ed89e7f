//! Grains and what they meet.

use particles::{POSITION, Set};
use run::{Failure, Fault, Inputs};

use super::Source;
use crate::grains::cover::Cover;
use crate::grains::displaced::Displaced;
use crate::grains::laid::Laid;
use crate::grains::{self, fill::fill};
use crate::motion::Method;
use crate::source::{self, bed::Bed};
use crate::state::State;

/// Stages of grains: their motion and heat, and what they cover of the metal and take from the room of the liquid.
pub(super) struct Beside {
    pub(super) motion: grains::Motion,
    pub(super) cover: Option<Cover>,
    pub(super) displaced: Option<Displaced>,
    /// What is told of grains that begin deep within others, or beside a mirror that is none for them.
    pub(super) doubts: Vec<String>,
}

impl Source<'_> {
    /// Motion and heat of grains, the grains, and how many each body holds.
    pub(super) fn grains(
        &self,
        scene: &grains::Parameters,
        inputs: &Inputs,
        state: &State,
    ) -> Result<(Beside, Set, Vec<usize>), Failure> {
        let within = |fault: Fault| fault.within("/grains");
        let bed = bed(scene, inputs)?;
        let (mut set, counts) = fill(scene, &bed.grains);
        let buried: Vec<Fault> = grains::buried(&scene.walls, &set)
            .into_iter()
            .map(within)
            .collect();
        if !buried.is_empty() {
            return Err(Failure::Scene(buried));
        }
        let mut laid_rows = Vec::with_capacity(set.len());
        for (body, count) in scene.bodies.iter().zip(&counts) {
            laid_rows.resize(laid_rows.len() + count, body.bed);
        }
        let metal = self.scene.has_metal().then_some(&state.metal);
        let mut doubts = grains::overlaps(&scene.walls, &set, &laid_rows, metal).map_err(within)?;
        doubts.extend(self.unmirrored(scene, &set));
        let heat = scene.heat.as_ref();
        let mut warmed = None;
        if let Some(heat) = heat {
            let interval = scene.sleep.map_or(1, |sleep| sleep.heat_interval_steps);
            let heat = grains::Heat::new(scene, heat)
                .map_err(within)?
                .slowly(interval);
            grains::warm(scene, &heat, &mut set, &counts).map_err(within)?;
            warmed = Some(heat);
        }
        let radii = grains::fill::radii(&set);
        let spacing = self.scene.metal().spacing;
        let metal = self.scene.has_metal().then(|| {
            let of = scene.metal.unwrap_or_default();
            let exchange = heat.zip(self.caloric.as_ref());
            let exchange = exchange.map(|(heat, caloric)| {
                grains::Exchange::new(caloric.clone(), of.modulus(heat.contact.elastic()))
            });
            grains::Metal::new(spacing, radii, of.friction).heated(exchange)
        });
        let cover = metal.is_some().then(|| Cover::new(spacing, radii[1]));
        let flow = self.scene.flow.as_ref().filter(|_| self.scene.has_metal());
        let projected = flow.filter(|flow| flow.method == Method::Projection);
        let displaced = projected.map(|_| {
            Displaced::new(
                self.scene.metal(),
                radii[1],
                grains::Mirrors::of(&scene.walls),
            )
        });
        let motion = grains::Motion::new(scene, &set, warmed).map_err(within)?;
        let motion = motion
            .beside(metal)
            .lying(laid(scene, &bed, &counts, state), &set);
        let beside = Beside {
            motion,
            cover,
            displaced,
            doubts,
        };
        Ok((beside, set, counts))
    }

    /// Mirrors of the flow that grains lie beside and do not have.
    fn unmirrored(&self, scene: &grains::Parameters, set: &Set) -> Vec<String> {
        let mirrors = grains::Mirrors::of(&scene.walls);
        let [_, widest] = grains::fill::radii(set);
        let faces = self.scene.faces.iter();
        let sides =
            faces.flat_map(|faces| faces.mirror.iter().map(move |face| (faces, face.side())));
        let missing = sides.filter_map(|(faces, (axis, upper))| {
            let (point, sign) = if upper {
                (faces.max_m, -1.0)
            } else {
                (faces.min_m, 1.0)
            };
            let mut normal = [0.0; 3];
            normal[axis] = sign;
            let beside = |x: &[f64; 3]| (x[axis] - point[axis]).abs() < 2.0 * widest;
            let lie = set.column(&POSITION).iter().filter(|x| beside(x)).count();
            (lie > 0 && !mirrors.have(point, normal, 0.01 * widest)).then(|| {
                let (name, at) = (["x", "y", "z"][axis], point[axis]);
                format!(
                    "the mirror of the flow at {name} = {at} m is none for grains, of which {lie} lie beside it: give them a wall \
                     with the shape 'half_space' and \"mirror\": true"
                )
            })
        });
        missing.collect()
    }
}

/// What the contacts of the bed remember, if the scene begins with one.
fn laid(scene: &grains::Parameters, bed: &Bed, counts: &[usize], state: &State) -> Option<Laid> {
    let body = scene.bodies.iter().position(|body| body.bed)?;
    let first: usize = counts[..body].iter().sum();
    let whole = scene.bodies.len() == 1;
    let laid = Laid::of(&bed.contacts, first as u32, state);
    Some(Laid { whole, ..laid })
}

/// The input `bed`, if the scene wants it.
fn bed(scene: &grains::Parameters, inputs: &Inputs) -> Result<Bed, Failure> {
    match (scene.bodies.iter().any(|body| body.bed), inputs.get("bed")) {
        (false, _) => Ok(Bed::default()),
        (true, Some(path)) => source::bed::read(path),
        (true, None) => Err(Failure::Usage(
            "this scene needs --input bed=FILE".to_owned(),
        )),
    }
}
