//! From a scene to what is sought and given of its eddy currents, and what is wrong with these.

use run::{Failure, Fault};
use shapes::frame::direction;

use super::driven::setup::{bars, windings};
use super::medium::law::{Curve, Law};
use super::parameters::Parameters;
use crate::cloud::Cloud;
use crate::cloud::layout::vector;
use crate::cloud::setup::layout;
use crate::geometry::Geometry;
use crate::magnetic::source::{C, Loop, MU0, Origin, Segment, Source, Uniform, Wire};
use crate::magnetic::unknown::Unknown;
use crate::scene::currents::OuterReaction;
use crate::scene::{Coil, EddyCurrents, ElectricPotential, Magnet, Scene};
use crate::solve::Numerics;

/// Radius of a wire that the scene calls thin, over the size of its coil.
const THIN: f64 = 1e-3;

/// What is sought and given in a scene.
///
/// # Errors
/// Where a curve of magnetisation is none, or coils and bars are not whole.
pub(crate) fn parameters(
    scene: &Scene,
    currents: &EddyCurrents,
    cloud: &Cloud,
    numerics: Numerics,
) -> Result<Parameters, Failure> {
    let media = 0..=scene.bodies.len();
    Ok(Parameters {
        unknown: unknown(scene, currents),
        omega: currents.angular_frequency(),
        still: currents.standing.is_some(),
        open: currents.outer == OuterReaction::Multipole,
        charged: currents.charged(scene.geometry),
        conductivity: (media.clone())
            .map(|m| scene.medium(m).conductivity_s_m)
            .collect(),
        laws: laws(scene)?,
        around: MU0 * scene.surroundings.relative_permeability,
        magnetic: media.map(|m| scene.magnetic(m)).collect(),
        source: source(scene, currents),
        coils: windings(scene, currents, cloud)?,
        bars: bars(scene, currents, cloud)?,
        run: run(scene, currents),
        numerics,
    })
}

/// Media through which wires run.
fn run(scene: &Scene, currents: &EddyCurrents) -> Vec<u16> {
    let place = layout(scene);
    let wire = |coil: &Coil| match coil {
        Coil::Wire(wire) => Some(place.medium(vector(&wire.place_m))),
        _ => None,
    };
    currents.coils.iter().filter_map(wire).collect()
}

/// How the field of each medium follows its flux density.
///
/// # Errors
/// Where a curve is none.
fn laws(scene: &Scene) -> Result<Vec<Law>, Fault> {
    let law = |m: usize| {
        let rows = match m.checked_sub(1) {
            None => None,
            Some(k) => {
                let at = format!("/bodies/{k}/relative_permeability");
                scene.bodies[k].relative_permeability.rows(&at)?
            }
        };
        let curve = rows.and_then(|(b, h)| Curve::new(b, h)).map(Law::Curve);
        let constant = Law::Constant(MU0 * scene.medium(m).relative_permeability);
        Ok(curve.unwrap_or(constant))
    };
    (0..=scene.bodies.len()).map(law).collect()
}

/// What is sought in a scene.
pub(crate) fn unknown(scene: &Scene, currents: &EddyCurrents) -> Unknown {
    let axial = currents.applied_flux_density_t.as_ref();
    match scene.geometry {
        Geometry::Space => Unknown::Potential,
        Geometry::Axisymmetric => Unknown::Around,
        Geometry::Plane if axial.is_some_and(|b| b[2] != 0.0) => Unknown::Axial,
        Geometry::Plane => Unknown::Potential,
    }
}

/// What is wrong with the currents of a scene beyond what its types and single keys can tell.
pub(crate) fn faults(scene: &Scene, currents: &EddyCurrents) -> Vec<Fault> {
    let mut faults = Vec::new();
    let unknown = unknown(scene, currents);
    if currents.harmonic.is_none() {
        let lead = |coil: &Coil| match coil {
            Coil::Loop(l) => ("loop", l.phase_deg),
            Coil::Segments(s) => ("segments", s.phase_deg),
            Coil::Wire(w) => ("wire", w.phase_deg),
            Coil::Region(r) => ("region", r.phase_deg),
        };
        for (k, (kind, lead)) in currents.coils.iter().map(lead).enumerate() {
            if lead != 0.0 {
                let at = format!("/eddy_currents/coils/{k}/{kind}/phase_deg");
                let what = "a current in time has no phase: it follows \"wave\"";
                faults.push(Fault::at(&at, what));
            }
        }
    }
    faults.extend(saturating(scene, currents, unknown));
    faults.extend(barred(scene, currents, unknown));
    let left_out = currents.potential == Some(ElectricPotential::Conductors)
        && !currents.charged(scene.geometry);
    if left_out {
        let what = "charges on conductors are computed in space alone: in a plane and about an axis none gather";
        faults.push(Fault::at("/eddy_currents/potential", what));
    }
    faults.extend(magnet(scene, currents));
    let own = scene.surroundings.relative_permeability;
    faults.extend(vacuum(own, currents));
    if let (Unknown::Axial, Some(b)) = (unknown, &currents.applied_flux_density_t) {
        let at = "/eddy_currents/applied_flux_density_t";
        if b[0] != 0.0 || b[1] != 0.0 {
            faults.push(Fault::at(
                at,
                "either along z or in the plane: they are two scenes",
            ));
        }
        if !currents.coils.is_empty() {
            let what = "wires along z and a field along z are two scenes";
            faults.push(Fault::at("/eddy_currents/coils", what));
        }
        if currents.outer == OuterReaction::Multipole {
            let what = "a field along z is what it is at the walls: leave \"outer\" away";
            faults.push(Fault::at("/eddy_currents/outer", what));
        }
    }
    faults
}

/// Curves of magnetisation where fields are sinusoids, or where H is sought.
fn saturating(scene: &Scene, currents: &EddyCurrents, unknown: Unknown) -> Vec<Fault> {
    let why = if currents.harmonic.is_some() {
        "a curve of magnetisation has no sinusoidal steady state, as the field of a sinusoidal current is no sinusoid: give a number, march with \"transient\", or take \"static\" where nothing changes"
    } else if unknown == Unknown::Axial {
        "a curve of magnetisation has a place where the field lies in the plane: along z H is sought, whose equation has one permeability; give a number"
    } else {
        return Vec::new();
    };
    let saturates = (0..scene.bodies.len()).filter(|k| scene.saturates(k + 1));
    let at = |k: usize| Fault::at(&format!("/bodies/{k}/relative_permeability"), why);
    saturates.map(at).collect()
}

/// Coils whose exact field is that in vacuum, in surroundings of another permeability.
fn vacuum(own: f64, currents: &EddyCurrents) -> Option<Fault> {
    let exact = currents.coils.iter().any(|c| c.region().is_none());
    let what = format!(
        "{own}: loops, segments and wires have the field that they have in vacuum, with 1; coils of points have any"
    );
    let other = exact && (own - 1.0).abs() > 1e-12;
    other.then(|| Fault::at("/surroundings/relative_permeability", what))
}

/// What the applied field comes from.
fn origin(magnet: Option<Magnet>) -> Origin {
    match magnet {
        None => Origin::Solenoid([0.0; 3]),
        Some(Magnet::Solenoid { centre_m }) => Origin::Solenoid(centre_m),
        Some(Magnet::Sheets { normal }) => Origin::Sheets(direction(normal)),
    }
}

/// What is wrong with the magnet of a scene.
fn magnet(scene: &Scene, currents: &EddyCurrents) -> Option<Fault> {
    let at = "/eddy_currents/magnet";
    let magnet = currents.magnet?;
    let Some(b) = &currents.applied_flux_density_t else {
        return Some(Fault::at(at, "there is no \"applied_flux_density_t\""));
    };
    if scene.geometry != Geometry::Space {
        return Some(Fault::at(at, "a magnet has a place in space alone"));
    }
    let Magnet::Sheets { normal } = magnet else {
        return None;
    };
    let b = vector(b);
    let along: f64 = (0..3).map(|k| b[k] * normal[k]).sum();
    let size = shapes::frame::length(b) * shapes::frame::length(normal);
    let square = along.abs() <= 1e-9 * size && size > 0.0;
    let at = format!("{at}/sheets/normal");
    (!square).then(|| Fault::at(&at, "not zero, and square to the applied flux density"))
}

/// The exact fields of coils and of the applied field, rms.
pub(crate) fn source(scene: &Scene, currents: &EddyCurrents) -> Source {
    let mut source = Source::default();
    let phasor =
        |current: f64, degrees: f64| C::from_polar(currents.rms(current), degrees.to_radians());
    for coil in &currents.coils {
        match coil {
            Coil::Loop(l) => {
                let one = Loop {
                    centre: scene.geometry.place(vector(&l.centre_m)),
                    axis: direction(l.normal.unwrap_or([0.0, 0.0, 1.0])),
                    radius: l.radius_m,
                    wire_radius: l.wire_radius_m.unwrap_or(THIN * l.radius_m),
                    current: phasor(l.current_a * l.turns, l.phase_deg),
                };
                if l.wire_radius_m.is_some() {
                    source.loops.extend(one.filaments());
                } else {
                    source.loops.push(one);
                }
            }
            Coil::Segments(s) => {
                let size =
                    shapes::frame::length(shapes::frame::difference(s.points_m[1], s.points_m[0]));
                let ends = s.points_m.iter().skip(1);
                let back = s.closed.then(|| &s.points_m[0]);
                for (from, to) in s.points_m.iter().zip(ends.chain(back)) {
                    source.segments.push(Segment {
                        from: *from,
                        to: *to,
                        wire_radius: THIN * size,
                        current: phasor(s.current_a, s.phase_deg),
                    });
                }
            }
            Coil::Wire(w) => source.wires.push(Wire {
                place: w.place_m,
                wire_radius: THIN * scene.points.spacing_m,
                current: phasor(w.current_a, w.phase_deg),
            }),
            Coil::Region(_) => {}
        }
    }
    if let Some(b) = &currents.applied_flux_density_t {
        let b = match scene.geometry {
            Geometry::Axisymmetric => [0.0, 0.0, b[1]],
            _ => vector(b),
        };
        source.uniform.push(Uniform {
            flux: b.map(|b| C::from(currents.rms(b))),
            origin: origin(currents.magnet),
        });
    }
    source
}

/// What net currents a scene cannot have.
fn barred(scene: &Scene, currents: &EddyCurrents, unknown: Unknown) -> Vec<Fault> {
    let mut faults = Vec::new();
    let magnetic = (1..=scene.bodies.len()).any(|m| scene.magnetic(m));
    for (k, body) in scene.bodies.iter().enumerate() {
        if body.net_current_a.is_none() {
            if body.net_current_phase_deg.is_some() {
                let at = format!("/bodies/{k}/net_current_phase_deg");
                faults.push(Fault::at(
                    &at,
                    "is the lead of a \"net_current_a\", which is absent",
                ));
            }
            continue;
        }
        let why = if scene.geometry != Geometry::Plane || unknown != Unknown::Potential {
            "is that of a bar along z in a plane, with wires or a field across it"
        } else if currents.harmonic.is_none() {
            "is that of a sinusoidal steady state: take \"harmonic\"; a coil of points carries a current at any instant"
        } else if scene.carries(k + 1) {
            "the body is a coil, whose current is given there"
        } else if body.conductivity_s_m == 0.0 {
            "the body does not conduct: give it a \"conductivity_s_m\", or let a coil of points carry the current"
        } else if magnetic {
            "stands where all bodies have the permeability of the surroundings"
        } else {
            continue;
        };
        faults.push(Fault::at(&format!("/bodies/{k}/net_current_a"), why));
    }
    faults
}
