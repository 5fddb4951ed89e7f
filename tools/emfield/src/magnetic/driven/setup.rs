//! Bars and coils of a scene that are regions of points: whether their current can flow, and how dense it is.

use run::Fault;
use shapes::Body;
use shapes::frame::{Vector, along, difference, direction, dot, length};
use shapes::rule::rule;
use shapes::surface::{Piece, enclosed};

use crate::cloud::Cloud;
use crate::cloud::layout::Layout;
use crate::cloud::setup::layout;
use crate::geometry::Geometry;
use crate::magnetic::driven::winding::{Flow, Winding};
use crate::magnetic::source::C;
use crate::scene::currents::RegionCoil;
use crate::scene::{EddyCurrents, Scene};

/// Pieces of the surface of a coil per spacing, over those that shapes make by themselves.
const FINER: f64 = 4.0;
/// Part of the spacing by which a place beside a surface is told from one on it.
const BESIDE: f64 = 1e-4;

/// What a coil is looked at with.
struct Finder<'a> {
    scene: &'a Scene,
    currents: &'a EddyCurrents,
    cloud: &'a Cloud,
    layout: Layout,
}

/// The coils of a scene that are regions of points.
///
/// # Errors
/// Faults of coils that another body or a wall cuts, or whose axis goes through them.
pub(crate) fn windings(
    scene: &Scene,
    currents: &EddyCurrents,
    cloud: &Cloud,
) -> Result<Vec<Winding>, Vec<Fault>> {
    if currents.coils.iter().all(|c| c.region().is_none()) {
        return Ok(Vec::new());
    }
    let finder = Finder {
        scene,
        currents,
        cloud,
        layout: layout(scene),
    };
    let (mut found, mut faults) = (Vec::new(), Vec::new());
    for (number, coil) in currents.coils.iter().enumerate() {
        match coil.region().map(|region| finder.winding(region)) {
            Some(Ok(one)) => found.push(one),
            Some(Err(what)) => {
                let at = format!("/eddy_currents/coils/{number}/region");
                faults.push(Fault::at(&at, what));
            }
            None => {}
        }
    }
    if faults.is_empty() {
        Ok(found)
    } else {
        Err(faults)
    }
}

impl Finder<'_> {
    fn winding(&self, coil: &RegionCoil) -> Result<Winding, String> {
        let name = &coil.body;
        let bodies = &self.scene.bodies;
        let number = bodies.iter().position(|b| b.name == *name);
        let number = number.ok_or_else(|| format!("\"{name}\" is no body"))?;
        let own = &bodies[number];
        let dimensions = self.scene.geometry.dimensions();
        let body = Body::new(&own.shape, dimensions);
        let spacing = own.spacing_m.unwrap_or(self.scene.points.spacing_m);
        let pieces = rule(&body, dimensions, spacing / FINER);
        self.whole(&body, number, spacing, &pieces)?;
        let flow = match (self.scene.geometry, &coil.axis) {
            (Geometry::Plane, _) => Flow::Along,
            (Geometry::Axisymmetric, _) => Flow::Turn,
            (Geometry::Space, Some(axis)) => Flow::Ring(axis.centre_m, direction(axis.normal)),
            (Geometry::Space, None) => return Err("in space an axis is wanted".to_owned()),
        };
        let section = section(&body, BESIDE * spacing, flow, &pieces)?;
        let current = self.currents.rms(coil.current_a * coil.turns);
        Ok(Winding {
            medium: number as u16 + 1,
            density: C::from_polar(current / section, coil.phase_deg.to_radians()),
            flow,
        })
    }

    /// Whether nothing cuts a coil: all of its surface lies within the domain and no earlier body reaches in.
    fn whole(
        &self,
        body: &Body,
        number: usize,
        spacing: f64,
        pieces: &[Piece],
    ) -> Result<(), String> {
        let name = &self.scene.bodies[number].name;
        let own = number as u16 + 1;
        for piece in pieces {
            let inside = along(piece.place, -BESIDE * spacing, piece.normal);
            if self.layout.depth(inside) < 0.0 {
                return Err(format!("{name} leaves the domain: its current has no way"));
            }
            let medium = self.layout.medium(inside);
            if medium != own {
                let other = self.scene.medium_name(medium as usize);
                return Err(format!("{other} cuts {name}: its current has no way"));
            }
        }
        let geometry = self.scene.geometry;
        for s in &self.cloud.surface {
            let place = geometry.coordinates(self.cloud.position[s.point as usize]);
            let other = match [s.inner, s.outer] {
                [a, b] if a == own => b,
                [a, b] if b == own => a,
                _ => continue,
            };
            if body.distance(place).abs() > BESIDE * spacing {
                let other = self.scene.medium_name(other as usize);
                return Err(format!("{other} lies in {name}: its current has no way"));
            }
        }
        Ok(())
    }
}

/// Area of the section of a coil across its current \[m2\]: around an axis
/// `int dV / (2 pi r)`, which is that of the distance's gradient through its surface over `2 pi`.
fn section(body: &Body, rounding: f64, flow: Flow, pieces: &[Piece]) -> Result<f64, String> {
    let through = "the axis goes through the coil: its current has no way there";
    match flow {
        Flow::Along => Ok(enclosed(pieces, 2)),
        Flow::Turn => {
            let beside = |p: &Piece| p.place[0] > 0.0;
            if pieces.iter().all(beside) {
                Ok(enclosed(pieces, 2))
            } else {
                Err(through.to_owned())
            }
        }
        Flow::Ring(centre, axis) => {
            let mut sum = 0.0;
            for piece in pieces {
                let off = difference(piece.place, centre);
                let foot: Vector = along(centre, dot(off, axis), axis);
                let away = difference(piece.place, foot);
                if body.distance(foot) < -rounding || length(away) < rounding {
                    return Err(through.to_owned());
                }
                sum += piece.area * dot(piece.normal, direction(away));
            }
            Ok(sum / std::f64::consts::TAU)
        }
    }
}

/// Media of the bars of a scene whose net current is given, with it \[A\].
///
/// # Errors
/// Where one touches another conductor.
pub(crate) fn bars(
    scene: &Scene,
    currents: &EddyCurrents,
    cloud: &Cloud,
) -> Result<Vec<(u16, C)>, Fault> {
    let given = |m: u16| {
        let body = (m as usize).checked_sub(1).map(|k| &scene.bodies[k]);
        body.is_some_and(|b| b.net_current_a.is_some())
    };
    let conducts = |m: u16| scene.medium(m as usize).conductivity_s_m > 0.0;
    for face in &cloud.surface {
        let (a, b) = (face.inner, face.outer);
        if conducts(a) && conducts(b) && (given(a) || given(b)) {
            let (own, other) = if given(a) { (a, b) } else { (b, a) };
            let [x, y, _] = cloud.position[face.point as usize];
            let what = format!(
                "the bar touches {} at ({x:.3e}, {y:.3e}) m, into which its current may pass: leave a gap, or give none of them a net current",
                scene.medium_name(other as usize)
            );
            let at = format!("/bodies/{}/net_current_a", own - 1);
            return Err(Fault::at(&at, what));
        }
    }
    let mut bars = Vec::new();
    for (k, body) in scene.bodies.iter().enumerate() {
        if let Some(current) = body.net_current_a {
            let lead = body.net_current_phase_deg.unwrap_or(0.0).to_radians();
            let current = C::from_polar(currents.rms(current), lead);
            bars.push((k as u16 + 1, current));
        }
    }
    Ok(bars)
}
