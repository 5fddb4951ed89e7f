//! What is told of a liquid: frames of its points and its surface, and a row of numbers for each step.

use artefact::{Frame, Precision, Record};

use super::outline::Outline;
use super::step::{Liquid, Matter};
use super::surface::Patch;
use super::vector::{dot, spatial};

/// Modes that are told, from 2.
const MODES: usize = 6;
/// Volume of a surface point over that of one inside, about.
const HALF: f64 = 0.35;

/// Totals of a drop at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Totals {
    /// Volume \[m3\].
    pub volume: f64,
    /// Centre \[m\].
    pub centre: [f64; 3],
    /// Area \[m2\].
    pub area: f64,
    /// The velocity of the centre, which is momentum over mass \[m/s\].
    pub drift: [f64; 3],
    /// Kinetic energy \[J\].
    pub kinetic: f64,
    /// What points stand for \[m3\].
    pub volumes: Vec<f64>,
}

impl Totals {
    /// Those of a liquid with its outline; none where its points cannot tell integrals.
    #[must_use]
    pub fn new(liquid: &Liquid<3>, matter: &Matter<3>, outline: &Outline) -> Option<Self> {
        let (volume, centre) = outline.volume();
        let surface = liquid.surface();
        let share = |i: usize| if i < surface { HALF } else { 1.0 };
        let whole: f64 = (0..liquid.position.len()).map(share).sum();
        let guess: Vec<f64> = (0..liquid.position.len())
            .map(|i| volume * share(i) / whole)
            .collect();
        let volumes = outline.volumes(&liquid.position, &guess)?;
        let skin = &liquid.position[..surface];
        let drift = outline.centre_velocity(skin, &liquid.normal, &liquid.velocity)?;
        let masses = volumes.iter().map(|v| 0.5 * matter.density * v);
        let kinetic = masses.zip(&liquid.velocity).map(|(m, u)| m * dot(u, u));
        let kinetic = kinetic.sum();
        Some(Self {
            volume,
            centre,
            area: outline.area(),
            drift,
            kinetic,
            volumes,
        })
    }

    /// A row: radii, modes, volume, centre, energies.
    #[must_use]
    pub fn row(&self, matter: &Matter<3>, outline: &Outline) -> Record {
        let radius = [0, 1, 2].map(|k| {
            let mut n = [0.0; 3];
            n[k] = 1.0;
            0.5 * (outline.radius(&n) + outline.radius(&n.map(|c| -c)))
        });
        let mut record = Record::new();
        for (axis, r) in ["x", "y", "z"].iter().zip(radius) {
            record = record.with(&format!("radius_{axis}"), "m", r);
        }
        record = record.with("axis_ratio", "1", 2.0 * radius[2] / (radius[0] + radius[1]));
        for l in 2..=MODES.min(outline.degree) {
            record = record
                .with(&format!("mode_{l}"), "m", outline.mode(l))
                .with(&format!("strength_{l}"), "m", outline.strength(l));
        }
        record = record
            .with("outline_residual", "m", outline.residual)
            .with("volume", "m3", self.volume)
            .with("area", "m2", self.area);
        for (k, axis) in ["x", "y", "z"].iter().enumerate() {
            record = record
                .with(&format!("centre_{axis}"), "m", self.centre[k])
                .with(&format!("velocity_{axis}"), "m/s", self.drift[k]);
        }
        let tension = matter.tension * self.area;
        record
            .with("kinetic_energy", "J", self.kinetic)
            .with("surface_energy", "J", tension)
    }
}

/// Places, kinds (1 on the surface, 2 on a wall), velocity and pressure of all points, without the magnetic pressure that it
/// carries.
#[must_use]
pub fn points<const D: usize>(
    liquid: &Liquid<D>,
    matter: &Matter<D>,
    magnetic: &[f64],
    precision: Precision,
) -> Frame {
    let carried = |i: usize| magnetic.get(i).copied().unwrap_or(0.0);
    let borne = |i: usize| {
        let x = &liquid.position[i];
        matter.density * liquid.room.potential(&matter.gravity, x)
    };
    let pressure = liquid.pressure.iter().enumerate();
    let pressure = pressure.map(|(i, p)| p - carried(i) + borne(i));
    let (surface, walls) = (liquid.surface(), liquid.walls());
    let kind = |i: usize| u8::from(i < surface) + 2 * u8::from(walls.contains(&i));
    Frame::new(precision)
        .positions(liquid.position.iter().map(spatial))
        .flag("kind", (0..liquid.position.len()).map(kind))
        .vector("velocity", "m/s", liquid.velocity.iter().map(spatial))
        .scalar("pressure", "Pa", pressure)
}

/// Places, normals, areas and curvatures of the surface.
#[must_use]
pub fn surface<const D: usize>(
    liquid: &Liquid<D>,
    patches: &[Patch<D>],
    precision: Precision,
) -> Frame {
    let unit = if D == 2 { "m" } else { "m2" };
    let frame = Frame::new(precision)
        .positions(liquid.position[..patches.len()].iter().map(spatial))
        .vector("normal", "1", patches.iter().map(|p| spatial(&p.normal)))
        .scalar("area", unit, patches.iter().map(|p| p.area))
        .scalar("curvature", "1/m", patches.iter().map(|p| p.curvature));
    if liquid.pull[0].is_empty() {
        frame
    } else {
        frame.scalar("traction", "Pa", liquid.pull[0].iter().copied())
    }
}
