//! Water as its particles see it: places, speeds and volumes of neighbours, and their images beyond plain walls.

use kernels::Kernel;
use particles::{POSITION, Rows, Set, sweep};
use rayon::prelude::*;
use shapes::Body;

use super::images::{Plane, image, mirrors};
use super::near::{LISTED, Lists, Near};
use super::seen::Seen;
use crate::state::VELOCITY;

/// Particles per unit of parallel work.
pub(super) const GRAIN: usize = 64;

/// What each particle sees.
pub(super) struct Around<K, L = Rows> {
    pub(super) kernel: K,
    pub(super) near: Near<L>,
    pub(super) seen: Vec<Seen>,
    /// Particles near walls, since neighbours were found.
    pub(super) beside: Vec<u32>,
    /// Plain walls.
    pub(super) bodies: Vec<Body>,
}

impl<K: Kernel, L: Lists> Around<K, L> {
    /// Nothing yet; `h` is the smoothing length of `kernel` \[m\].
    pub(super) fn new(kernel: K, h: f64, bodies: Vec<Body>) -> Self {
        Self {
            kernel,
            near: Near::new(h),
            seen: Vec::new(),
            beside: Vec::new(),
            bodies,
        }
    }

    /// Looks at all particles; `show` gives the volume \[m3\] of each and what it shows beside.
    pub(super) fn look(
        &mut self,
        set: &mut Set,
        exchanges: u64,
        show: impl Fn(usize) -> (f64, f64) + Sync,
    ) {
        let mut listed = set.take(&LISTED);
        let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
        if self.near.refresh(position, &mut listed, exchanges) {
            self.stand_beside(&listed);
        }
        self.seen.resize(position.len(), Seen::default());
        sweep::fill(&mut self.seen, |a| {
            let (volume, value) = show(a);
            Seen {
                x: position[a],
                u: velocity[a],
                volume,
                value,
            }
        });
        set.put(&LISTED, listed);
    }

    /// Notes who stands beside a wall.
    pub(super) fn stand_beside(&mut self, listed: &[[f64; 3]]) {
        let (bodies, reach) = (&self.bodies, self.near.radius());
        let near = |a: &u32| {
            bodies
                .iter()
                .any(|b| b.distance(listed[*a as usize]) < reach)
        };
        self.beside.clear();
        if !bodies.is_empty() {
            let all = (0..listed.len() as u32).into_par_iter().with_min_len(GRAIN);
            self.beside = all.filter(near).collect();
        }
        self.near.stand_beside(&self.beside, listed);
    }

    /// Calls `visit` with the images of the others of particle `a` and its own within the support: the first wall and whose image it
    /// is, the image, the offset from it \[m\], r^2 \[m2\] and grad W = slope . offset.
    pub(super) fn mirrored(
        &self,
        a: usize,
        mut visit: impl FnMut((usize, usize), &Seen, [f64; 3], f64, f64),
    ) {
        let own = &self.seen[a];
        let reach = self.kernel.support();
        let mut each = |mirror: &[Plane], b: usize, other: &Seen| {
            let Some((x, u)) = image(mirror, own.x, other.x, other.u) else {
                return;
            };
            let dx = [0, 1, 2].map(|k| own.x[k] - x[k]);
            let square = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
            if square < reach * reach {
                let slope = self.kernel.slope(square.sqrt());
                visit(
                    (mirror[0].wall, b),
                    &Seen { x, u, ..*other },
                    dx,
                    square,
                    slope,
                );
            }
        };
        for mirror in mirrors(&self.bodies, own.x, reach) {
            each(&mirror, a, own);
            for b in self.near.rows.row(a).iter().map(|b| *b as usize) {
                if b != a {
                    each(&mirror, b, &self.seen[b]);
                }
            }
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.near.bytes() + 64 * self.seen.len()
    }
}

impl<K: Kernel> Around<K> {
    /// Calls `visit` with the others of particle `a` within the support: its number and itself, the offset from it \[m\], r^2 \[m2\] and
    /// grad W = slope . offset.
    #[inline(always)]
    pub(super) fn each(&self, a: usize, mut visit: impl FnMut(usize, &Seen, [f64; 3], f64, f64)) {
        let own = &self.seen[a];
        let limit = self.kernel.support() * self.kernel.support();
        for b in self.near.rows.row(a) {
            let other = &self.seen[*b as usize];
            let dx = [0, 1, 2].map(|k| own.x[k] - other.x[k]);
            let square = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
            if square < limit {
                visit(
                    *b as usize,
                    other,
                    dx,
                    square,
                    self.kernel.slope(square.sqrt()),
                );
            }
        }
    }
}
