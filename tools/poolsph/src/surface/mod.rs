//! The surface of the metal: normals that point outwards, and the area that each particle has.
//!
//! 1. Colour and its gradient (Komen 2019, eqs. 4.4 to 4.6): C = V sum W, grad C = V sum grad W,
//!    which points into the metal; the outward normal is -grad C / |grad C|, smoothed once by the
//!    kernel.
//! 2. Depth: the colour of a half-space and its gradient tell how far the surface is (`depth`).
//!    Depths are averaged over neighbours too; the surface near a particle is the plane across its
//!    normal.
//! 3. Area: of this plane each particle owns what is nearer to itself than to any other. Since
//!    every place on the surface belongs to one particle, areas add up to the true area however
//!    the particles lie, and a particle in the inside owns nothing. Eq. 4.1 counts pi d^2/4 for
//!    each particle that eq. 4.3 flags, 78.5 % of a flat face.
//! 4. Area as seen from above: the plan is shared among the particles in view (`columns`).
//!
//! Particles far from the flow are measured once; those within reach of it in every step.

mod area;
mod band;
mod columns;
pub mod curvature;
mod depth;
mod edges;
mod flat;

use kernels::CubicSpline;
use neighbours::{Grid, Lists, ROWS};
use particles::{Column, Matter, POSITION};
use rayon::prelude::*;
use shapes::frame::{along, cross, difference, squared};
use steps::Figure;

use self::band::Band;
use self::depth::Depth;
use self::flat::Flat;
use crate::faces::Images;
use crate::near::Role;
use crate::patch::{self, AREA, Patch, Patches};
use crate::stage::{Stage, StageError};
use crate::state::{PHASE, State, phase};

/// A particle that owns this part of d^2 of the surface counts as surface.
const EXPOSED: f64 = 0.1;
/// Whether a particle counts as surface.
const SURFACE: Column<bool> = Column::new("surface", "1", false).shown();

/// The surface as a stage.
pub struct Surface {
    metal: Matter,
    kernel: CubicSpline<3>,
    depth: Depth,
    band: Band,
    /// What the surface in a lid is measured by; empty without lids.
    flat: Flat,
    coloured: Vec<Patch>,
    /// Which particles have an area.
    exposed: Vec<bool>,
    /// Particles that did not fly at the last look at all of them.
    resting: usize,
    total: f64,
}

/// Places and their neighbours; images beyond the faces have places, and no rows.
struct Cloud<'a> {
    places: &'a [[f64; 3]],
    images: &'a Images,
    lists: &'a Lists,
}

impl Cloud<'_> {
    fn row(&self, k: usize) -> &[u32] {
        self.lists.row(k)
    }
}

impl Surface {
    /// The surface of the metal of a scene.
    #[must_use]
    pub fn new(metal: Matter) -> Self {
        let kernel = CubicSpline::new(metal.smoothing_length);
        Self {
            metal,
            kernel,
            depth: Depth::new(kernel),
            band: Band::of([metal.spacing; 2]),
            flat: Flat::default(),
            coloured: Vec::new(),
            exposed: Vec::new(),
            resting: 0,
            total: 0.0,
        }
    }

    /// The same where bodies were filled with cells of such sides along the axes \[m\].
    #[must_use]
    pub fn of_cells(self, [x, y, _]: [f64; 3]) -> Self {
        let band = Band::of([x, y]);
        Self { band, ..self }
    }

    /// Measures all particles.
    fn whole(&mut self, state: &mut State) {
        let (all, phases) = (state.metal.column(&POSITION), state.metal.column(&PHASE));
        let grounded = |a: &usize| phases[*a] != phase::FLYING;
        let ids: Vec<usize> = (0..all.len()).filter(grounded).collect();
        let mut places: Vec<[f64; 3]> = ids.iter().map(|a| all[*a]).collect();
        let (mut grid, mut lists) = (Grid::new(self.metal.support()), Lists::new());
        let (support, mut images) = (self.metal.support(), Images::default());
        let open = state.faces.without_lids();
        images.place(open.as_ref().unwrap_or(&state.faces), support, &mut places);
        grid.bin(&places);
        let points = &places[..ids.len()];
        lists.build(grid.search(points, support), |_| true, |_, _| true);
        let cloud = Cloud {
            places: &places,
            images: &images,
            lists: &lists,
        };
        let mut coloured: Vec<Patch> = (0..ids.len())
            .into_par_iter()
            .with_min_len(ROWS)
            .map(|k| self.colour(&cloud, k))
            .collect();
        self.band.complete(
            &cloud,
            self.kernel,
            self.metal.spacing,
            &mut coloured,
            |_| false,
        );
        let none = (0..state.len()).map(|a| (a, Patch::default()));
        patch::put(&mut state.metal, none);
        patch::put(&mut state.metal, ids.into_iter().zip(coloured));
        self.exposed.clear();
    }

    /// Measures the particles within reach of the flow.
    fn near(&mut self, state: &mut State) {
        let near = &state.near;
        let own_lists = self.flat.gather(&state.faces, near, self.metal.support());
        let cloud = match own_lists {
            true => self.flat.cloud(),
            false => Cloud {
                places: &near.position,
                images: near.images(),
                lists: &near.lists,
            },
        };
        let (own, before) = (self.kernel.value(0.0), Patches::of(&state.metal));
        let mut coloured = std::mem::take(&mut self.coloured);
        (0..near.len())
            .into_par_iter()
            .with_min_len(ROWS)
            .map(|k| match near.role[k] {
                // Nothing around it has moved.
                Role::Backing => before.at(near.id[k] as usize),
                _ if own_lists => self.colour(&cloud, k),
                _ => self.patch(near.number[k].max(own), near.gradient[k]),
            })
            .collect_into_vec(&mut coloured);
        let rest = |k: usize| k < near.len() && near.role[k] == Role::Backing;
        self.band
            .complete(&cloud, self.kernel, self.metal.spacing, &mut coloured, rest);
        // Images stand behind their originals, under the same numbers, and are no particles of their own.
        let members = near.id.iter().zip(&near.role).zip(&coloured);
        let members = members.take(near.len());
        let moved = members.filter(|((_, role), _)| **role != Role::Backing);
        let moved = moved.map(|((id, _), patch)| (*id as usize, *patch));
        let exposed = &mut self.exposed;
        let told = moved.inspect(|(a, patch)| exposed[*a] = patch.area > 0.0);
        patch::put(&mut state.metal, told);
        self.coloured = coloured;
    }

    /// Colour of a particle of the cloud, and what it tells.
    fn colour(&self, cloud: &Cloud<'_>, k: usize) -> Patch {
        let (mut number, mut gradient) = (self.kernel.value(0.0), [0.0; 3]);
        for &b in cloud.row(k) {
            let dx = difference(cloud.places[k], cloud.places[b as usize]);
            let sample = self.kernel.sample(squared(dx).sqrt());
            number += sample.value;
            gradient = along(gradient, sample.slope, dx);
        }
        self.patch(number, gradient)
    }

    /// Depth and gradient of the colour from the sums of W \[1/m3\] and grad W \[1/m4\].
    fn patch(&self, number: f64, gradient: [f64; 3]) -> Patch {
        let volume = self.metal.volume();
        let gradient = gradient.map(|x| volume * x);
        Patch {
            depth: self.depth.at(volume * number, squared(gradient).sqrt()),
            gradient,
            ..Patch::default()
        }
    }
}

/// Two unit vectors across `normal` and each other.
#[must_use]
pub fn tangents(normal: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let [x, y, z] = normal;
    // The axis least along the normal.
    let axis = if x.abs() <= y.abs() && x.abs() <= z.abs() {
        [1.0, 0.0, 0.0]
    } else if y.abs() <= z.abs() {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let u = cross(normal, axis);
    let length = squared(u).sqrt();
    let u = u.map(|x| x / length);
    (u, cross(normal, u))
}

impl Stage for Surface {
    fn name(&self) -> &'static str {
        "surface"
    }

    fn declare(&self, state: &mut State) {
        patch::declare(&mut state.metal);
        state.metal.declare(&SURFACE);
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        let phases = state.metal.column(&PHASE).iter();
        let resting = phases.filter(|p| **p != phase::FLYING).count();
        // Before the flow starts, only particles that arrive change the surface.
        if self.resting == 0 || (!state.flowing && resting != self.resting) {
            self.whole(state);
        }
        self.resting = resting;
        if self.exposed.is_empty() {
            let areas = state.metal.column(&AREA).iter();
            self.exposed.extend(areas.map(|area| *area > 0.0));
        }
        self.exposed.resize(state.len(), false);
        if !state.near.is_empty() {
            self.near(state);
        }
        state.exposed.clear();
        let exposed = self.exposed.iter().enumerate().filter(|(_, is)| **is);
        state.exposed.extend(exposed.map(|(a, _)| a as u32));
        let areas = state.metal.column(&AREA);
        let exposed = state.exposed.iter();
        self.total = exposed.map(|a| areas[*a as usize]).sum();
        Ok(())
    }

    fn show(&self, state: &mut State) {
        let least = EXPOSED * self.metal.spacing * self.metal.spacing;
        let (shown, areas) = state.metal.columns_mut((&SURFACE, &AREA));
        for (shown, area) in shown.iter_mut().zip(areas) {
            *shown = *area > least;
        }
    }

    fn figures(&self) -> Vec<Figure> {
        vec![Figure {
            name: "surface_area_m2",
            unit: "m2",
            value: self.total,
        }]
    }

    fn bytes(&self) -> usize {
        self.flat.bytes()
    }

    fn save(&self) -> Vec<f64> {
        vec![self.resting as f64]
    }

    fn restore(&mut self, saved: &[f64]) {
        self.resting = saved.first().map_or(0, |n| *n as usize);
    }
}

#[cfg(test)]
mod tests;
