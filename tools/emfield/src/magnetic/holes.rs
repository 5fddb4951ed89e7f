//! Holes in conductors, in a plane with a field along z.
//!
//! Where nothing conducts `H_z` has no slope. In what reaches a wall it is the field applied; in a hole that conductors
//! enclose it is one unknown H, by the law of induction around the hole, with the normal out of it:
//!
//! ```text
//! contour integral of (1/sigma) dH/dn ds = mu A dH/dt,    A = 1/2 contour integral of x . n ds
//! ```

use wls::Stencils;

use crate::stencils::region::{Face, Kind, Region};
use crate::stencils::sides::{Sides, along_normal, share_along};

/// A hole: points where nothing conducts, on its rim as well, that all have one field.
#[derive(Debug, Clone, PartialEq)]
pub struct Hole {
    /// The point whose row is the law of induction.
    pub first: u32,
    /// Points of interfaces: of its rim, and of media within it.
    faces: Vec<u32>,
}

/// Holes, and which of them each point belongs to.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Holes {
    all: Vec<Hole>,
    /// By point; empty where there are no holes.
    of: Vec<Option<u32>>,
}

/// Parts of what does not conduct: each point follows one that stands for its part.
struct Parts(Vec<u32>);

impl Parts {
    fn root(&mut self, mut i: usize) -> usize {
        while self.0[i] as usize != i {
            self.0[i] = self.0[self.0[i] as usize];
            i = self.0[i] as usize;
        }
        i
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b) as u32;
    }
}

impl Holes {
    /// Holes of a region, with what `conducts` by medium.
    #[must_use]
    pub fn of<const D: usize>(
        region: &Region<D>,
        sides: &Sides<D>,
        conducts: impl Fn(u16) -> bool,
    ) -> Self {
        let empty = |i: usize| match region.kinds[i] {
            Kind::Inside(m) | Kind::Wall { medium: m, .. } => !conducts(m),
            Kind::Interface(face) => {
                let face = &region.faces[face as usize];
                !(conducts(face.inner) && conducts(face.outer))
            }
        };
        // A part goes on through its inside, not along its rim.
        let inside = |i: &usize| matches!(region.kinds[*i], Kind::Inside(m) if !conducts(m));
        let mut parts = Parts((0..region.len() as u32).collect());
        for i in (0..region.len()).filter(inside) {
            for (j, _) in sides.own.laplacian(i).iter() {
                if empty(j) {
                    parts.join(i, j);
                }
            }
        }
        let roots: Vec<usize> = (0..region.len()).map(|i| parts.root(i)).collect();
        let mut reaches = vec![false; region.len()];
        for (i, root) in roots.iter().enumerate() {
            reaches[*root] |= matches!(region.kinds[i], Kind::Wall { .. });
        }
        let mut holes = Self::default();
        let mut number = vec![None; region.len()];
        for i in (0..region.len()).filter(|i| empty(*i) && !reaches[roots[*i]]) {
            let own = *number[roots[i]].get_or_insert_with(|| {
                holes.all.push(Hole {
                    first: i as u32,
                    faces: Vec::new(),
                });
                holes.all.len() as u32 - 1
            });
            holes.of.resize(region.len(), None);
            holes.of[i] = Some(own);
            if let Kind::Interface(face) = region.kinds[i] {
                holes.all[own as usize].faces.push(face);
            }
        }
        holes
    }

    /// The hole that point `i` belongs to.
    #[must_use]
    pub fn at(&self, i: usize) -> Option<&Hole> {
        let own = self.of.get(i).copied().flatten()?;
        Some(&self.all[own as usize])
    }
}

/// What the law of induction needs of media.
#[derive(Debug, Clone, Copy)]
pub struct Media<'a> {
    /// `mu sigma` \[s/m2\]; 0 where nothing conducts.
    pub mu_sigma: &'a [f64],
    /// Resistivity over the greatest of all conductors.
    pub resistivity: &'a [f64],
    /// `mu` over the greatest resistivity \[s/m2\].
    pub mu: &'a [f64],
}

impl Hole {
    /// Its interfaces.
    fn faces<'a, const D: usize>(
        &'a self,
        region: &'a Region<D>,
    ) -> impl Iterator<Item = &'a Face<D>> {
        self.faces.iter().map(|f| &region.faces[*f as usize])
    }

    /// Length of its rim.
    fn length<const D: usize>(&self, region: &Region<D>, media: Media<'_>) -> f64 {
        let rim = |face: &&Face<D>| {
            let both = [face.inner, face.outer].map(|m| media.mu_sigma[m as usize]);
            both[0] > 0.0 || both[1] > 0.0
        };
        self.faces(region).filter(rim).map(|f| f.area).sum()
    }

    /// Each point of the rim with its part of the contour, the conductor there, and the normal out of the hole.
    pub(crate) fn rim<'a, const D: usize>(
        &'a self,
        region: &'a Region<D>,
        media: Media<'a>,
    ) -> impl Iterator<Item = (&'a Face<D>, f64, u16, [f64; D])> {
        let length = self.length(region, media);
        self.faces(region).filter_map(move |face| {
            let part = face.area / length;
            let conducts = |m: u16| media.mu_sigma[m as usize] > 0.0;
            if conducts(face.outer) {
                Some((face, part, face.outer, face.normal))
            } else if conducts(face.inner) {
                Some((face, part, face.inner, face.normal.map(|n| -n)))
            } else {
                None
            }
        })
    }

    /// The rim with the stencils of the conductor.
    fn contour<'a, const D: usize>(
        &'a self,
        region: &'a Region<D>,
        sides: &'a Sides<D>,
        media: Media<'a>,
    ) -> impl Iterator<Item = (&'a Face<D>, f64, u16, &'a Stencils<D>, [f64; D])> {
        let stencils = |(face, part, medium, normal): (&'a Face<D>, f64, u16, [f64; D])| {
            let inner = medium != face.outer;
            let stencils = if inner { &sides.inner } else { &sides.outer };
            (face, part, medium, stencils, normal)
        };
        self.rim(region, media).map(stencils)
    }

    /// The mean of `resistivity dH/dn` along the rim.
    pub fn row<const D: usize>(
        &self,
        region: &Region<D>,
        sides: &Sides<D>,
        media: Media<'_>,
        mut push: impl FnMut(usize, f64),
    ) {
        for (face, part, medium, stencils, normal) in self.contour(region, sides, media) {
            let weight = part * media.resistivity[medium as usize];
            along_normal(stencils, face.point as usize, normal, weight, &mut push);
        }
    }

    /// What stands before `dH/dt` in that row: the flux through the hole, less the shares of the Laplacians around it in
    /// the slopes.
    #[must_use]
    pub fn rate<const D: usize>(
        &self,
        region: &Region<D>,
        sides: &Sides<D>,
        media: Media<'_>,
    ) -> f64 {
        let shares = |(face, part, medium, stencils, normal): (&Face<D>, f64, u16, _, _)| {
            let m = medium as usize;
            let share = share_along(stencils, face.point as usize, normal);
            part * media.resistivity[m] * media.mu_sigma[m] * share
        };
        let slopes: f64 = self.contour(region, sides, media).map(shares).sum();
        self.through(region, media) - slopes
    }

    /// The flux through the hole over the length of its rim, where `H` is 1.
    pub(crate) fn through<const D: usize>(&self, region: &Region<D>, media: Media<'_>) -> f64 {
        // Out of each medium of the hole: mu A is the sum over its own contours.
        let flux = |face: &Face<D>| {
            let place = &region.places[face.point as usize];
            let out: f64 = (0..D).map(|a| place[a] * face.normal[a]).sum();
            let mu = |m: u16| {
                let empty = media.mu_sigma[m as usize] == 0.0;
                if empty { media.mu[m as usize] } else { 0.0 }
            };
            0.5 * out * face.area * (mu(face.inner) - mu(face.outer))
        };
        let through: f64 = self.faces(region).map(flux).sum();
        through / self.length(region, media)
    }
}
