//! The force on coils in the field of the currents found: by Biot and Savart in space, by coaxial rings about an axis,
//! by parallel lines in a plane.

use std::f64::consts::TAU;

use rayon::prelude::*;
use shapes::frame::{cross, difference};

use crate::magnetic::driven::winding::{self, Windings};
use crate::magnetic::fields::{Fields, cross_mean};
use crate::magnetic::medium::interface::Acting;
use crate::magnetic::source::{C, Loop, Source, Wire};
use crate::stencils::region::Region;

/// Pieces of which a loop is made where its force is summed.
const PIECES: usize = 48;

/// A ring or line of current counts as this thin \[m\]: no coil lies within.
const THIN: f64 = 1e-9;

/// Current of the volume of a point \[A m\], \[A\] in a plane, of a full turn about an axis.
struct Part<const D: usize> {
    place: [f64; D],
    moment: [C; 3],
}

/// Opposite of the force on the coils \[N\], \[N/m\] in a plane; about an axis only that along it.
pub(crate) fn force<const D: usize>(
    region: &Region<D>,
    weights: &[f64],
    fields: &Fields,
    source: &Source,
    windings: Option<&Windings>,
    acting: Acting<'_>,
) -> [f64; 3] {
    let currents = on_coils(region, weights, fields, source, windings);
    let Some(permeable) = acting.permeable else {
        return currents;
    };
    let wound = windings.map(|windings| field(region, wound_parts(region, windings)));
    let flux = |place: [f64; 3]| {
        let own = source.flux_at(place);
        let more = wound
            .as_ref()
            .map_or([C::default(); 3], |wound| wound(place));
        std::array::from_fn(|k| own[k] + more[k])
    };
    let magnets = permeable.pull(region, weights, &fields.flux, acting.laws, &flux);
    std::array::from_fn(|k| currents[k] + magnets[k])
}

/// That of the currents found.
fn on_coils<const D: usize>(
    region: &Region<D>,
    weights: &[f64],
    fields: &Fields,
    source: &Source,
    windings: Option<&Windings>,
) -> [f64; 3] {
    let conducts = |i: &usize| weights[*i] != 0.0 && fields.heat[*i] > 0.0;
    let parts: Vec<Part<D>> = (0..region.len())
        .filter(conducts)
        .map(|i| Part {
            place: region.places[i],
            moment: fields.current[i].map(|j| j * weights[i]),
        })
        .collect();
    let force = if region.axial {
        [0.0, 0.0, coaxial(&parts, source)]
    } else if D == 2 {
        parallel(&parts, source)
    } else {
        in_space(&parts, source)
    };
    let Some(windings) = windings else {
        return force;
    };
    let more = wound(region, parts, windings);
    std::array::from_fn(|k| force[k] + more[k])
}

/// The same on coils that are regions of points.
fn wound<const D: usize>(region: &Region<D>, parts: Vec<Part<D>>, windings: &Windings) -> [f64; 3] {
    let coil: Vec<winding::Part> = windings.parts(region).collect();
    let field = field(region, parts);
    let on = |part: &winding::Part| cross_mean(part.moment, field(part.place));
    let force = opposite(coil.par_iter().map(on).collect());
    if region.axial {
        [0.0, 0.0, force[2]]
    } else {
        force
    }
}

/// The flux density of currents at a place in space.
fn field<const D: usize>(
    region: &Region<D>,
    parts: Vec<Part<D>>,
) -> Box<dyn Fn([f64; 3]) -> [C; 3] + Sync> {
    if region.axial {
        let rings: Vec<Loop> = parts.iter().map(ring).collect();
        Box::new(move |place| sum(rings.iter().map(|r| (r.current, r.flux(place)))))
    } else if D == 2 {
        let lines: Vec<Wire> = parts.iter().map(line).collect();
        Box::new(move |place| sum(lines.iter().map(|l| (l.current, l.flux(place)))))
    } else {
        let currents = moments(&parts);
        Box::new(move |place| biot_savart(&currents, place))
    }
}

/// Coils that are regions of points, as parts.
fn wound_parts<const D: usize>(region: &Region<D>, windings: &Windings) -> Vec<Part<D>> {
    let part = |part: winding::Part| Part {
        place: region.lower(part.place),
        moment: part.moment,
    };
    windings.parts(region).map(part).collect()
}

/// A turn of a part about an axis.
fn ring<const D: usize>(part: &Part<D>) -> Loop {
    Loop {
        centre: [0.0, 0.0, part.place[1]],
        axis: [0.0, 0.0, 1.0],
        radius: part.place[0],
        wire_radius: THIN,
        current: part.moment[1] / (TAU * part.place[0]),
    }
}

/// A part in a plane.
fn line<const D: usize>(part: &Part<D>) -> Wire {
    Wire {
        place: [part.place[0], part.place[1]],
        wire_radius: THIN,
        current: part.moment[2],
    }
}

/// Places and moments of parts in space, with `mu0 / 4 pi`.
fn moments<const D: usize>(parts: &[Part<D>]) -> Vec<([f64; 3], [C; 3])> {
    let moment = |part: &Part<D>| {
        let place = std::array::from_fn(|k| part.place[k]);
        (place, part.moment.map(|j| j * 1e-7))
    };
    parts.iter().map(moment).collect()
}

/// Sum of fields of 1 A times their currents.
fn sum(fields: impl Iterator<Item = (C, [f64; 3])>) -> [C; 3] {
    let mut sum = [C::default(); 3];
    for (current, field) in fields {
        for (sum, part) in sum.iter_mut().zip(field) {
            *sum += current * part;
        }
    }
    sum
}

/// Along the axis: `2 pi a Re(I* B_r)` on each loop, with the field of rings.
fn coaxial<const D: usize>(parts: &[Part<D>], source: &Source) -> f64 {
    let rings: Vec<Loop> = parts.iter().map(ring).collect();
    let on = |coil: &Loop| {
        let place = [coil.radius, 0.0, coil.centre[2]];
        let outward: C = rings.iter().map(|r| r.current * r.flux(place)[0]).sum();
        let current = coil.current * coil.axis[2].signum();
        TAU * coil.radius * (current.conj() * outward).re
    };
    let all: Vec<f64> = source.loops.par_iter().map(on).collect();
    all.iter().sum()
}

/// Per length: `-Re(I* z x B)` on each wire, with the field of lines.
fn parallel<const D: usize>(parts: &[Part<D>], source: &Source) -> [f64; 3] {
    let lines: Vec<Wire> = parts.iter().map(line).collect();
    let on = |wire: &Wire| {
        let place = [wire.place[0], wire.place[1], 0.0];
        let b = sum(lines.iter().map(|l| (l.current, l.flux(place))));
        cross_mean([C::default(), C::default(), wire.current], b)
    };
    opposite(source.wires.par_iter().map(on).collect())
}

/// `-Re sum I* dl x B`.
fn in_space<const D: usize>(parts: &[Part<D>], source: &Source) -> [f64; 3] {
    let currents = moments(parts);
    let loops = source.loops.iter().map(|l| (l.pieces(PIECES), l.current));
    let segments = source
        .segments
        .iter()
        .map(|s| (s.pieces(PIECES), s.current));
    let mut force = [0.0; 3];
    for (pieces, current) in loops.chain(segments) {
        let on = |(place, along): &([f64; 3], [f64; 3])| {
            let b = biot_savart(&currents, *place);
            cross_mean(along.map(|x| current * x), b)
        };
        let part = opposite(pieces.par_iter().map(on).collect());
        force = std::array::from_fn(|k| force[k] + part[k]);
    }
    force
}

fn opposite(forces: Vec<[f64; 3]>) -> [f64; 3] {
    let add = |sum: [f64; 3], f: &[f64; 3]| std::array::from_fn(|k| sum[k] - f[k]);
    forces.iter().fold([0.0; 3], add)
}

/// `mu0/(4 pi) sum J dV x d / d^3`; `mu0 / 4 pi` is in the moments.
fn biot_savart(currents: &[([f64; 3], [C; 3])], p: [f64; 3]) -> [C; 3] {
    let mut sum = [C::new(0.0, 0.0); 3];
    for (place, moment) in currents {
        let d = difference(p, *place);
        let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let inverse = (square * square.sqrt()).recip();
        let re = cross(moment.map(|m| m.re), d);
        let im = cross(moment.map(|m| m.im), d);
        for k in 0..3 {
            sum[k] += C::new(re[k], im[k]) * inverse;
        }
    }
    sum
}
