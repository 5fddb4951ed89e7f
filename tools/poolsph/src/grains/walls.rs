//! Walls: faces that grains touch, at rest or moving.

use contact::{Grain, Meeting, Normal};
use rayon::prelude::*;
use run::Fault;
use run::property::{Arguments, Curve, OutOfRange, Property};
use shapes::frame::{Vector, along, difference, length};

use super::Mirrors;
use super::depth::{Depth, Reckoned};
use super::faces::Face;
use super::law::Laws;
use super::light::Light;
use super::memory::Memory;
use super::near::{AT_LEAST, Near};
use super::pressure::Pressed;
use super::wall_parameters::WallScene;

/// A face that may move.
#[derive(Debug, Clone)]
pub(super) struct Wall {
    pub(super) face: Face,
    /// Velocity \[m/s\], if it moves.
    driven: Option<[Curve; 3]>,
    /// Velocity of its surface along itself \[m/s\], if that goes.
    slides: Option<[Curve; 3]>,
    sliding: Vector,
    pub(super) pressed: Option<Pressed>,
    light: Option<Light>,
    friction: Option<f64>,
    /// Whether grains meet their own images in it.
    mirror: bool,
    velocity: Vector,
    /// How far it has moved since the start \[m\], and where that was when neighbours were listed.
    pub(super) moved: Vector,
    pub(super) listed: Vector,
    /// Grains near it: first those whose contacts are reckoned, so many, then those that stay as they are; each by rows.
    pub(super) near: Vec<Near>,
    pub(super) reckoned: usize,
    /// Greatest overlap of those that stay \[m\].
    pub(super) deepest: f64,
    /// How far each chunk of rows was from being listed \[m\], and where the wall was then.
    pub(super) far: Vec<Option<(f64, Vector)>>,
}

/// All walls.
#[derive(Debug, Clone, Default)]
pub struct Walls {
    pub(super) walls: Vec<Wall>,
}

/// Velocity by formulas in t.
///
/// # Errors
/// Where a formula has no value.
pub fn velocity(curves: &[Curve; 3], time: f64) -> Result<Vector, OutOfRange> {
    let at = Arguments::at([0.0; 3], time);
    let [u, v, w] = curves;
    Ok([u.value(&at)?, v.value(&at)?, w.value(&at)?])
}

impl Walls {
    /// The walls of a scene, for grains whose least and greatest radius \[m\] are `radii`.
    ///
    /// # Errors
    /// A formula that cannot be read.
    pub fn new(scene: &[WallScene], radii: [f64; 2]) -> Result<Self, Fault> {
        let mut walls: Vec<Wall> = Vec::new();
        let mirrors = Mirrors::of(scene);
        for (i, wall) in scene.iter().enumerate() {
            let by = |velocity: &Option<[Property; 3]>, key: &str| {
                let at = format!("/walls/{i}/{key}");
                velocity.as_ref().map(|v| curves(v, &at)).transpose()
            };
            let driven = by(&wall.velocity_m_s, "velocity_m_s")?;
            let slides = by(&wall.surface_m_s, "surface_m_s")?;
            let faces = if wall.hollow {
                Face::inside(&wall.shape)
            } else {
                Face::outside(&wall.shape)
            };
            let before = walls.len();
            walls.extend(faces.into_iter().map(|face| Wall {
                face,
                driven: driven.clone(),
                slides: slides.clone(),
                sliding: [0.0; 3],
                pressed: None,
                light: None,
                friction: wall.friction,
                mirror: wall.mirror,
                velocity: [0.0; 3],
                moved: [0.0; 3],
                listed: [0.0; 3],
                near: Vec::new(),
                reckoned: 0,
                deepest: 0.0,
                far: Vec::new(),
            }));
            // All faces of a wall are one surface.
            let light = wall.light.as_ref();
            let light = light.map(|l| l.light(&format!("/walls/{i}/light")));
            let borne = wall.pressure_pa.or(light.is_some().then_some(0.0));
            if let (Some(pressure), Some(first)) = (borne, walls.get_mut(before)) {
                first.pressed = Some(Pressed::new(&wall.shape, pressure, radii, &mirrors));
                first.light = light.transpose()?;
            }
        }
        Ok(Self { walls })
    }

    /// Sets the velocities of the start.
    ///
    /// # Errors
    /// Where a formula has no value.
    pub fn begin(&mut self, time: f64) -> Result<(), OutOfRange> {
        self.drift(time, 0.0)
    }

    /// Moves the walls to `time` \[s\], a step of `step` \[s\] after the last.
    ///
    /// # Errors
    /// Where a formula has no value.
    pub fn drift(&mut self, time: f64, step: f64) -> Result<(), OutOfRange> {
        for wall in &mut self.walls {
            if let Some(curves) = &wall.driven {
                let now = velocity(curves, time)?;
                for (k, moved) in wall.moved.iter_mut().enumerate() {
                    *moved += 0.5 * step * (wall.velocity[k] + now[k]);
                }
                wall.velocity = now;
            }
            if let Some(curves) = &wall.slides {
                wall.sliding = velocity(curves, time)?;
            }
        }
        Ok(())
    }

    /// The farthest that a wall has moved since neighbours were listed \[m\].
    #[must_use]
    pub fn strayed(&self) -> f64 {
        let walls = self.walls.iter();
        let far = walls.map(|w| length(difference(w.moved, w.listed)));
        far.fold(0.0, f64::max)
    }

    /// The fastest wall \[m/s\].
    #[must_use]
    pub fn fastest(&self) -> f64 {
        let speeds = self.walls.iter().map(|w| length(w.velocity));
        speeds.fold(0.0, f64::max)
    }

    /// Whether the face of a number is there, and nearer to a place at the start than a distance \[m\].
    #[must_use]
    pub fn reaches(&self, wall: usize, place: Vector, within: f64) -> bool {
        let wall = self.walls.get(wall);
        wall.is_some_and(|wall| wall.face.distance(place) < within)
    }

    /// Contacts that touch, by walls and rows.
    pub fn memories(&self, memories: &mut Vec<Memory>) {
        memories.clear();
        for (w, wall) in self.walls.iter().enumerate() {
            memories.extend(wall.near.iter().filter_map(|near| near.memory(w as u32)));
        }
        memories.sort_unstable_by_key(|memory| (memory.other, memory.row));
    }

    /// Reckons all contacts but those of grains that sleep deep, after a step of `step` \[s\]; gives the greatest overlap \[m\].
    pub fn act<N: Normal + Copy + Sync>(
        &mut self,
        seen: Reckoned<'_>,
        laws: Laws<'_, N>,
        step: f64,
    ) -> f64 {
        let Reckoned { grains, depth } = seen;
        let Laws { contact, rolling } = laws;
        let mut deepest = 0.0_f64;
        for wall in &mut self.walls {
            let mut own = *contact;
            if let Some(coefficient) = wall.friction {
                own.friction = Some(contact::Friction { coefficient });
            }
            let (face, moved, mirror) = (&wall.face, wall.moved, wall.mirror);
            let velocity = along(wall.velocity, 1.0, wall.sliding);
            let near = wall.near[..wall.reckoned]
                .par_iter_mut()
                .with_min_len(AT_LEAST);
            near.for_each(|near| {
                if depth.kept(near.row as usize) {
                    return;
                }
                let grain = &grains[near.row as usize];
                let (distance, normal) = face.at(difference(grain.position, moved), grain.radius);
                let meeting = if mirror {
                    Meeting::with_image(grain, distance, normal)
                } else {
                    Meeting::beside_wall(grain, distance, normal, velocity)
                };
                near.meet(meeting, &own, rolling, step);
            });
            let overlaps = wall.reckoned().iter().map(|near| near.overlap);
            deepest = overlaps.fold(deepest.max(wall.deepest), f64::max);
        }
        deepest
    }

    /// Puts the contacts first that are reckoned where cells sleep by `depth`.
    pub fn rest(&mut self, depth: &[u8]) {
        let depth = Depth::of(depth, true);
        self.walls.iter_mut().for_each(|wall| wall.rest(depth));
    }

    /// Adds force \[N\] and moment \[N m\] of the walls.
    pub fn add(&self, [force, moment]: [&mut [Vector]; 2], depth: Depth<'_>) {
        for pressed in self.walls.iter().filter_map(|wall| wall.pressed.as_ref()) {
            pressed.add(force, depth);
        }
        for near in self.walls.iter().flat_map(Wall::reckoned) {
            let row = near.row as usize;
            if let Some(reply) = near.reply.filter(|_| !depth.kept(row)) {
                force[row] = along(force[row], 1.0, reply.force);
                moment[row] = along(moment[row], 1.0, reply.moment);
            }
        }
    }

    /// Calls `meet` with the row of each grain that is awake and touches a wall, and the normal out of that.
    pub fn touching(
        &self,
        grains: &[Grain],
        depth: Depth<'_>,
        mut meet: impl FnMut(usize, Vector),
    ) {
        for wall in &self.walls {
            let normal = |row: usize| {
                let place = difference(grains[row].position, wall.moved);
                (row, wall.face.at(place, grains[row].radius).1)
            };
            let rows: Vec<usize> = wall.touching(depth).collect();
            let met = rows.into_par_iter().with_min_len(AT_LEAST).map(normal);
            let met: Vec<(usize, Vector)> = met.collect();
            met.into_iter().for_each(|(row, normal)| meet(row, normal));
        }
    }

    /// Rows of the grains that touch walls and are awake, by walls, and whether that is a mirror.
    pub(super) fn rows_touching(&self, depth: Depth<'_>) -> impl Iterator<Item = (usize, bool)> {
        let walls = self.walls.iter();
        walls.flat_map(move |wall| wall.touching(depth).map(move |row| (row, wall.mirror)))
    }

    /// Adds the rows of the grains near walls that move, are fed or press.
    pub fn stirred(&self, rows: &mut Vec<u32>) {
        let moves = |u: Vector| u.iter().any(|u| u.abs() > 0.0);
        for wall in &self.walls {
            if moves(wall.velocity) || moves(wall.sliding) {
                rows.extend(wall.near.iter().map(|near| near.row));
            }
            if let Some(pressed) = &wall.pressed {
                rows.extend(&pressed.rows);
            }
        }
    }

    /// Finds the grains that bear pressure.
    pub fn spread(&mut self, grains: &[Grain]) {
        for wall in &mut self.walls {
            if let Some(pressed) = &mut wall.pressed {
                pressed.spread(grains, wall.moved);
            }
        }
    }

    /// Walls in the light.
    pub(super) fn lit(&self) -> impl Iterator<Item = (&Light, &Pressed)> {
        let walls = self.walls.iter();
        walls.filter_map(|wall| wall.light.as_ref().zip(wall.pressed.as_ref()))
    }

    /// Where the walls are, as numbers for a checkpoint.
    #[must_use]
    pub fn save(&self) -> Vec<f64> {
        let places = self.walls.iter();
        places
            .flat_map(|w| [w.moved, w.listed, w.velocity].into_iter().flatten())
            .collect()
    }

    /// Takes back what [`Walls::save`] gave; neighbours are to be listed where walls were then: gives back where they are.
    pub fn restore(&mut self, saved: &[f64]) -> Vec<Vector> {
        let (places, _) = saved.as_chunks::<9>();
        let mut moved = Vec::new();
        for (wall, [a, b, c, d, e, f, u, v, w]) in self.walls.iter_mut().zip(places) {
            moved.push([*a, *b, *c]);
            wall.moved = [*d, *e, *f];
            wall.velocity = [*u, *v, *w];
        }
        moved
    }

    /// Puts the walls where they are.
    pub fn place(&mut self, moved: &[Vector]) {
        for (wall, moved) in self.walls.iter_mut().zip(moved) {
            wall.moved = *moved;
        }
    }

    /// Numbers of a checkpoint that belong to the walls.
    #[must_use]
    pub fn saved_numbers(&self) -> usize {
        9 * self.walls.len()
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let near = self.walls.iter().map(|wall| wall.near.capacity());
        size_of::<Near>() * near.sum::<usize>()
    }
}

impl Wall {
    /// Contacts that are reckoned.
    fn reckoned(&self) -> &[Near] {
        &self.near[..self.reckoned]
    }

    /// Rows of the grains that touch it and are awake.
    fn touching(&self, depth: Depth<'_>) -> impl Iterator<Item = usize> {
        let touching = self.reckoned().iter().filter(|near| near.touching);
        let rows = touching.map(|near| near.row as usize);
        rows.filter(move |row| !depth.asleep(*row))
    }

    /// Puts the contacts first that are reckoned.
    fn rest(&mut self, depth: Depth<'_>) {
        let stays = |near: &Near| depth.kept(near.row as usize);
        let (first, rest) = self.near.split_at(self.reckoned);
        if first.iter().any(stays) || !rest.iter().all(stays) {
            self.near
                .sort_unstable_by_key(|near| (stays(near), near.row));
        }
        self.reckoned = self.near.partition_point(|near| !stays(near));
        let stay = self.near[self.reckoned..].iter().map(|near| near.overlap);
        self.deepest = stay.fold(0.0, f64::max);
    }
}

/// Formulas in t of a velocity at a JSON pointer.
///
/// # Errors
/// One that cannot be read.
pub fn curves(velocity: &[Property; 3], at: &str) -> Result<[Curve; 3], Fault> {
    let [u, v, w] = velocity;
    let curve = |k: usize, p: &Property| p.compile(&format!("{at}/{k}"), &["t"]);
    Ok([curve(0, u)?, curve(1, v)?, curve(2, w)?])
}
