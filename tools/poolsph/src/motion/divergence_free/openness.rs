//! How sure it is that a particle lies at the free surface. A liquid in which none does has no surface.
//!
//! A particle of a plane surface lacks 0.22 of the neighbours that the lattice has, all on one side, and so do its neighbours in
//! the surface, on the same side. In liquid in disorder a particle may lack as many, but not on one side, or it is alone
//! in it; counted as one of the surface it would bear all that the volume of a closed box is in error. Nor is it one of
//! the surface where another stands before it, across a gap of less than a particle (the cone of Marrone et al. 2010). What
//! lacks a third and more is open all around: drops of few particles, films and jets.

use kernels::moments::within;
use shapes::frame::{difference, dot, squared};

use super::filled::Filled;
use crate::near::{Near, Row};

/// Lack of neighbours, in parts of the lattice's, from which on a particle may lie at the surface, and at which it does so
/// wholly.
const LACKS: [f64; 2] = [0.10, 0.20];
/// The same for what lies open all around.
const LACKS_AROUND: [f64; 2] = [0.30, 0.40];
/// The same for what it lacks on one side, in parts of what a particle of a plane surface lacks there; in disorder a tenth.
const ONE_SIDED: [f64; 2] = [0.25, 0.50];
/// The same for neighbours in the surface, in parts of those of a plane one.
const COMPANY: [f64; 2] = [0.15, 0.35];
/// Cosine between the way outwards and that to a neighbour from which on it stands before a particle, and does so wholly.
const BEFORE: [f64; 2] = [0.6, 0.8];
/// How near, in spacings: wholly and not any more.
const NEAR: [f64; 2] = [1.6, 2.0];

/// How far the particle `a` lies at the surface, 0 to 1.
#[inline]
pub(super) fn open(near: &Near, filled: Filled, a: usize, row: Row<'_>) -> f64 {
    let lack = lack(near, filled, a);
    if lack <= LACKS[0] {
        return 0.0;
    }
    let around = within(lack, LACKS_AROUND);
    let inwards = near.gradient[a];
    let size = squared(inwards).sqrt();
    let one_sided = within(size / (filled.side * filled.spacing), ONE_SIDED);
    if around >= 1.0 || one_sided <= 0.0 {
        return around;
    }
    let (mut company, mut covered) = (0.0, 0.0_f64);
    for (b, slope) in row.slopes() {
        let way = difference(near.position[b], near.position[a]);
        let far = squared(way).sqrt();
        let before = within(
            -dot(way, inwards) / (far * size).max(f64::MIN_POSITIVE),
            BEFORE,
        );
        covered = covered.max(before * (1.0 - within(far / filled.spacing, NEAR)));
        let original = near.images().original(b);
        let part = within(self::lack(near, filled, original), LACKS);
        if part > 0.0 {
            let turn = near.images().turn(b);
            let theirs = near.gradient[original];
            let theirs = turn.map_or(theirs, |turn| turn.vector(theirs));
            let cosine =
                dot(inwards, theirs) / (size * squared(theirs).sqrt()).max(f64::MIN_POSITIVE);
            company -= slope * part * cosine.max(0.0);
        }
    }
    let company = within(company / filled.level, COMPANY);
    around.max(within(lack, LACKS) * one_sided * company * (1.0 - covered))
}

/// Part of the lattice's neighbours that a particle lacks.
#[inline]
pub(super) fn lack(near: &Near, filled: Filled, a: usize) -> f64 {
    let own = near.kernel.value(0.0);
    1.0 - (near.number[a] - own) / (filled.number - own)
}
