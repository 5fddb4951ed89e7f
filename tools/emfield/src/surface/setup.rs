//! The enclosing surfaces of a scene: whether they enclose, and where their places are.

use run::Fault;
use shapes::Body;
use shapes::frame::Vector;
use shapes::rule::rule;
use shapes::surface::Piece;

use crate::cloud::layout::Layout;
use crate::cloud::setup::layout;
use crate::cloud::{Class, Cloud, SurfacePoint};
use crate::geometry::Geometry;
use crate::magnetic::setup::{source, unknown};
use crate::magnetic::source::Source;
use crate::magnetic::unknown::Unknown;
use crate::scene::Scene;
use crate::scene::output::{Closed, Enclosure};
use crate::surface::enclosing::Enclosing;

/// Most places on a surface.
const MOST: usize = 10_000_000;
/// Pieces of which a coil is made where it is asked whether it lies within.
const PIECES: usize = 64;
/// Part of the spacing that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// What the surfaces of a scene are looked at with.
struct Finder<'a> {
    scene: &'a Scene,
    cloud: &'a Cloud,
    layout: Layout,
    /// Places of coils with the radius of their wire, in coordinates of the scene \[m\].
    wires: Vec<(Vector, f64)>,
}

/// The enclosing surfaces of a scene; none where it asks for none.
///
/// # Errors
/// Faults of surfaces that leave the domain, cut a body or a coil, lie in what conducts, or enclose nothing.
pub(crate) fn enclosing(scene: &Scene, cloud: &Cloud) -> Result<Vec<Enclosing>, Vec<Fault>> {
    let enclosures = &scene.output.enclosures;
    if enclosures.is_empty() {
        return Ok(Vec::new());
    }
    let finder = Finder {
        scene,
        cloud,
        layout: layout(scene),
        wires: wires(scene),
    };
    let (mut found, mut faults) = (Vec::new(), Vec::new());
    for (number, enclosure) in enclosures.iter().enumerate() {
        match finder.surface(enclosure) {
            Ok(one) => found.push(one),
            Err(what) => faults.push(Fault::at(&format!("/output/enclosures/{number}"), what)),
        }
    }
    if faults.is_empty() {
        Ok(found)
    } else {
        Err(faults)
    }
}

impl Finder<'_> {
    /// A surface, or what is wrong with it.
    fn surface(&self, enclosure: &Enclosure) -> Result<Enclosing, String> {
        let body = self.body(&enclosure.surface)?;
        let spacing = enclosure.spacing_m.unwrap_or(self.scene.points.spacing_m);
        let pieces = self.pieces(&body, spacing)?;
        let medium = self.medium(&pieces, spacing)?;
        self.bodies(&body, medium)?;
        self.coils(&body)?;
        let geometry = self.scene.geometry;
        let coordinates = |i: usize| geometry.coordinates(self.cloud.position[i]);
        let within: Vec<bool> = (0..self.cloud.len())
            .map(|i| body.distance(coordinates(i)) < 0.0)
            .collect();
        let other = |i: usize| within[i] && self.cloud.class[i] != Class::Inside(medium);
        if !(0..self.cloud.len()).any(other) {
            return Err("the surface encloses nothing".to_owned());
        }
        let carries = |s: &&SurfacePoint| {
            let media = [s.inner, s.outer].map(usize::from);
            within[s.point as usize] && media.into_iter().any(|m| self.scene.carries(m))
        };
        if let Some(s) = self.cloud.surface.iter().find(carries) {
            return Err(told_coil(self.cloud.position[s.point as usize]));
        }
        Ok(Enclosing {
            medium,
            within,
            ..Enclosing::of(&enclosure.name, geometry, &pieces)
        })
    }

    fn body(&self, surface: &Closed) -> Result<Body, String> {
        let dimensions = self.scene.geometry.dimensions();
        match surface {
            Closed::Shape(shape) => Ok(Body::new(shape, dimensions)),
            Closed::Around(around) => {
                let own = self.scene.bodies.iter().find(|b| b.name == around.body);
                let grown =
                    own.and_then(|b| Body::new(&b.shape, dimensions).grown(around.distance_m));
                grown.ok_or_else(|| {
                    format!(
                        "moved outward by {} m, the surface of {} fills what is cut away from it: give a \"shape\"",
                        around.distance_m, around.body
                    )
                })
            }
        }
    }

    /// Pieces of the surface: about an axis those on its right side.
    fn pieces(&self, body: &Body, spacing: f64) -> Result<Vec<Piece>, String> {
        let dimensions = self.scene.geometry.dimensions();
        let [low, high] = body.bounds();
        let size = (0..dimensions).map(|k| (high[k] - low[k]) / spacing);
        let places: f64 = size.clone().map(|s| s.max(1.0)).product();
        if !places.is_finite() {
            return Err("the surface is not closed: the shape has no end".to_owned());
        }
        // Of a body of this size a surface has about so many places.
        let widest = size.fold(1.0, f64::max);
        if widest.powi(dimensions as i32 - 1) > MOST as f64 {
            return Err(format!(
                "spacing {spacing} m gives more than {MOST} places: choose \"spacing_m\""
            ));
        }
        let mut pieces = rule(body, dimensions, spacing);
        if self.scene.geometry == Geometry::Axisymmetric {
            pieces.retain(|p| p.place[0] > ROUNDING * spacing);
        }
        if pieces.is_empty() {
            return Err("the shape has no surface".to_owned());
        }
        Ok(pieces)
    }

    /// The one medium in which all of the surface lies.
    fn medium(&self, pieces: &[Piece], spacing: f64) -> Result<u16, String> {
        let told = |x: Vector| match self.scene.geometry {
            Geometry::Space => format!("({:.4e}, {:.4e}, {:.4e}) m", x[0], x[1], x[2]),
            _ => format!("({:.4e}, {:.4e}) m", x[0], x[1]),
        };
        let outside = |p: &&Piece| self.layout.depth(p.place) < -ROUNDING * spacing;
        if let Some(piece) = pieces.iter().find(outside) {
            let at = told(piece.place);
            return Err(format!("the surface leaves the domain at {at}"));
        }
        let media: Vec<u16> = pieces.iter().map(|p| self.layout.medium(p.place)).collect();
        let first = media[0];
        let name = |m: u16| self.scene.medium_name(m as usize);
        if let Some(n) = media.iter().position(|m| *m != first) {
            let body = if first == 0 { media[n] } else { first };
            let (body, at) = (name(body), told(pieces[n].place));
            return Err(format!("the surface cuts {body} at {at}"));
        }
        let own = self.scene.medium(first as usize);
        if self.scene.eddy_currents.is_some() && own.conductivity_s_m > 0.0 {
            let name = name(first);
            return Err(format!("the surface lies in {name}, which conducts"));
        }
        if self.scene.eddy_currents.is_some() && self.scene.saturates(first as usize) {
            let name = name(first);
            return Err(format!(
                "the surface lies in {name}, whose permeability depends on the field: Maxwell's stress is known outside of it"
            ));
        }
        if self.scene.carries(first as usize) {
            return Err(format!("the surface lies in the coil {}", name(first)));
        }
        let electrode = (first as usize)
            .checked_sub(1)
            .map(|k| &self.scene.bodies[k]);
        let held = electrode.is_some_and(|b| b.potential_v.is_some());
        if self.scene.electrostatics.is_some() && held {
            let name = name(first);
            return Err(format!("the surface lies in the electrode {name}"));
        }
        Ok(first)
    }

    /// Whether the surface passes between bodies: all points of the surface of each lie on one side.
    fn bodies(&self, body: &Body, medium: u16) -> Result<(), String> {
        let geometry = self.scene.geometry;
        let mut sides = vec![[false; 2]; self.cloud.media.len()];
        for s in &self.cloud.surface {
            let x = geometry.coordinates(self.cloud.position[s.point as usize]);
            let side = usize::from(body.distance(x) < 0.0);
            for m in [s.inner, s.outer] {
                sides[m as usize][side] = true;
            }
        }
        for (m, side) in sides.iter().enumerate().skip(1) {
            if m != medium as usize && *side == [true; 2] {
                let name = self.scene.medium_name(m);
                return Err(format!("the surface cuts {name}"));
            }
        }
        Ok(())
    }

    /// Whether all coils lie outside.
    fn coils(&self, body: &Body) -> Result<(), String> {
        let Some(currents) = &self.scene.eddy_currents else {
            return Ok(());
        };
        if unknown(self.scene, currents) == Unknown::Axial {
            let what = "a field along z is the same all over the surface: it exerts no force";
            return Err(what.to_owned());
        }
        let inside = |(x, radius): &&(Vector, f64)| body.distance(*x) < *radius;
        match self.wires.iter().find(inside) {
            Some((x, _)) => Err(told_coil(self.scene.geometry.place(*x))),
            None => Ok(()),
        }
    }
}

fn told_coil(x: Vector) -> String {
    format!(
        "the surface encloses or cuts a coil at ({:.4e}, {:.4e}, {:.4e}) m, on which the field exerts a force too",
        x[0], x[1], x[2]
    )
}

/// Places of the coils of a scene.
fn wires(scene: &Scene) -> Vec<(Vector, f64)> {
    let source = match &scene.eddy_currents {
        Some(currents) => source(scene, currents),
        None => Source::default(),
    };
    let mut all = Vec::new();
    for coil in &source.loops {
        if scene.geometry == Geometry::Axisymmetric {
            all.push(([coil.radius, coil.centre[2], 0.0], coil.wire_radius));
            continue;
        }
        let pieces = coil.pieces(PIECES);
        all.extend(pieces.into_iter().map(|p| (p.0, coil.wire_radius)));
    }
    for segment in &source.segments {
        let pieces = segment.pieces(PIECES);
        all.extend(pieces.into_iter().map(|p| (p.0, segment.wire_radius)));
    }
    for wire in &source.wires {
        all.push(([wire.place[0], wire.place[1], 0.0], wire.wire_radius));
    }
    all
}
