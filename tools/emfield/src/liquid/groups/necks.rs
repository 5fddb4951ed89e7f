//! Where a liquid is too thin to hang together.
//!
//! Places deep beneath the surface hold it together: those that are near each other, with liquid between them, are one piece. A neck
//! thinner than twice that depth has none of them, nor has a sharp edge or a thin film. What is far from all of them is no longer resolved: it
//! flies on in handfuls that have no shape.

use neighbours::Tree;

use super::level::Level;
use crate::liquid::points::Liquid;
use crate::liquid::vector::{along, difference, dot, length};

/// Deep places nearer than so many spacings hang together.
pub(super) const LINK: f64 = 1.6;
/// Points farther from any deep one than so many spacings are between the pieces.
const BETWEEN: f64 = 1.6;
/// Where any is farther than so many, a drop is too thin there.
const THIN: f64 = 1.9;
/// Cores nearer than so many spacings have a neck between them, and about each end of it so many tell how the liquid moves.
const ACROSS: f64 = 5.0;
const NECK: f64 = 2.0;
/// Depths, in spacings, at which a deep place is looked for beneath a point of the surface.
const PROBES: [f64; 5] = [0.8, 1.0, 1.25, 1.5, 1.8];
/// Points between pieces nearer than so many spacings fly on together.
const TOGETHER: f64 = 1.5;

/// The pieces of a liquid.
pub(super) struct Pieces {
    /// Deep places of each, with a tree of their places.
    pub(super) cores: Vec<Tree>,
    places: Vec<Vec<[f64; 3]>>,
    /// Points that belong to none, by what flies on together.
    pub(super) between: Vec<Vec<usize>>,
}

impl Pieces {
    /// How far a place is from the deep places of a piece, and from those of all others \[m\].
    pub(super) fn far(&self, piece: usize, x: &[f64; 3]) -> [f64; 2] {
        let mut far = [f64::INFINITY; 2];
        for (k, (core, places)) in self.cores.iter().zip(&self.places).enumerate() {
            let Some(nearest) = core.nearest(*x) else {
                continue;
            };
            let away = length(&difference(x, &places[nearest]));
            let side = usize::from(k != piece);
            far[side] = far[side].min(away);
        }
        far
    }

    /// The points of a liquid that are nearest to a piece and belong to it.
    pub(super) fn about(&self, piece: usize, liquid: &Liquid<3>) -> Vec<usize> {
        let strewn: Vec<usize> = self.between.concat();
        let own = |i: &usize| {
            let [own, others] = self.far(piece, &liquid.position[*i]);
            own <= others && !strewn.contains(i)
        };
        (0..liquid.position.len()).filter(own).collect()
    }
}

/// Places that lie so many spacings or more beneath the surface of a liquid: of its points inside, and one beneath each point of the
/// surface where there is any within reach.
fn deep(liquid: &Liquid<3>, level: &Level<'_>, depth: f64, spacing: f64) -> Vec<[f64; 3]> {
    let surface = liquid.surface();
    let is = |x: &[f64; 3]| level.height(x) < -depth * spacing;
    let inside = liquid.position[surface..].iter().copied().filter(is);
    let skin = liquid.position[..surface].iter().zip(&liquid.normal);
    let beneath = skin.filter_map(|(x, n)| {
        let places = PROBES.map(|s| along(x, -s * spacing, n));
        places.into_iter().find(is)
    });
    inside.chain(beneath).collect()
}

/// The pieces of a liquid whose places `depth` spacings beneath its surface no longer hang together, or leave thin what is far from
/// them; none where it is whole.
pub(super) fn pieces(
    liquid: &Liquid<3>,
    level: &Level<'_>,
    depth: f64,
    spacing: f64,
) -> Option<Pieces> {
    let deep = deep(liquid, level, depth, spacing);
    let linked = |a: &[f64; 3], b: &[f64; 3]| {
        let middle = along(&a.map(|c| 0.5 * c), 0.5, b);
        level.height(&middle) < 0.0
    };
    let clusters = clusters(&deep, LINK * spacing, linked);
    let clusters = clusters.into_iter();
    let cores = clusters.map(|c| c.into_iter().map(|i| deep[i]).collect());
    let places = leaving(cores.collect(), liquid, spacing);
    let mut pieces = Pieces {
        cores: places.iter().map(|p| Tree::new(p)).collect(),
        places,
        between: Vec::new(),
    };
    let away = |x: &[f64; 3]| {
        let [own, others] = pieces.far(0, x);
        own.min(others)
    };
    let points = liquid.position.iter().zip(0..);
    let far: Vec<[f64; 2]> = points
        .map(|(x, i)| [f64::from(i), away(x)])
        .filter(|[_, far]| *far > BETWEEN * spacing)
        .collect();
    let thin = far.iter().any(|[_, far]| *far > THIN * spacing);
    if pieces.cores.len() < 2 && !thin {
        return None;
    }
    let strewn: Vec<usize> = far.iter().map(|[i, _]| *i as usize).collect();
    pieces.between = handfuls(&liquid.position, strewn, TOGETHER * spacing);
    Some(pieces)
}

/// Cores of a liquid, of which those that are near each other without leaving each other are one: the neck between them grows.
fn leaving(mut cores: Vec<Vec<[f64; 3]>>, liquid: &Liquid<3>, spacing: f64) -> Vec<Vec<[f64; 3]>> {
    let mut k = 1;
    while k < cores.len() {
        let grows = (0..k).find(|&i| {
            let [a, b] = closest(&cores[i], &cores[k]);
            let apart = difference(&b, &a);
            let [u, v] = [a, b].map(|x| velocity(liquid, &x, NECK * spacing));
            length(&apart) < ACROSS * spacing && dot(&difference(&v, &u), &apart) <= 0.0
        });
        match grows {
            Some(i) => {
                let core = cores.remove(k);
                cores[i].extend(core);
                // What was apart from both may be near them together.
                k = 1;
            }
            None => k += 1,
        }
    }
    cores
}

/// The two places of two cores that are nearest to each other.
fn closest(a: &[[f64; 3]], b: &[[f64; 3]]) -> [[f64; 3]; 2] {
    let tree = Tree::new(a);
    let mut best = [a[0], b[0]];
    let mut least = f64::INFINITY;
    for x in b {
        if let Some(near) = tree.nearest(*x) {
            let far = length(&difference(x, &a[near]));
            if far < least {
                (least, best) = (far, [a[near], *x]);
            }
        }
    }
    best
}

/// Mean velocity of the points about a place.
fn velocity(liquid: &Liquid<3>, x: &[f64; 3], reach: f64) -> [f64; 3] {
    let all = liquid.position.iter().zip(&liquid.velocity);
    let near = all.filter(|(y, _)| length(&difference(x, y)) < reach);
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for (_, u) in near {
        sum = along(&sum, 1.0, u);
        count += 1.0;
    }
    sum.map(|c| c / f64::max(count, 1.0))
}

/// Points by the first of them, in order, that is nearer than `reach`.
fn handfuls(places: &[[f64; 3]], mut points: Vec<usize>, reach: f64) -> Vec<Vec<usize>> {
    let mut all = Vec::new();
    while let Some(&first) = points.first() {
        let near = |i: &usize| length(&difference(&places[*i], &places[first])) < reach;
        let (own, others): (Vec<usize>, Vec<usize>) = points.into_iter().partition(near);
        all.push(own);
        points = others;
    }
    all
}

/// Points by what hangs together: each nearer than `reach` to another of its cluster to which it is `linked`; the first point of
/// each in order.
pub(super) fn clusters(
    points: &[[f64; 3]],
    reach: f64,
    linked: impl Fn(&[f64; 3], &[f64; 3]) -> bool,
) -> Vec<Vec<usize>> {
    let tree = Tree::new(points);
    let mut seen = vec![false; points.len()];
    let mut all = Vec::new();
    for first in 0..points.len() {
        if seen[first] {
            continue;
        }
        seen[first] = true;
        let mut cluster = vec![first];
        let mut next = 0;
        while let Some(&i) = cluster.get(next) {
            next += 1;
            let mut near = Vec::new();
            tree.within(points[i], reach, |j, _| near.push(j));
            near.sort_unstable();
            for j in near {
                if !seen[j] && linked(&points[i], &points[j]) {
                    seen[j] = true;
                    cluster.push(j);
                }
            }
        }
        cluster.sort_unstable();
        all.push(cluster);
    }
    all
}
