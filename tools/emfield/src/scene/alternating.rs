//! An alternating magnetic field about a liquid that conducts.

use schemars::JsonSchema;
use serde::Deserialize;
use shapes::Shape;
use shapes::check::Misfit;
use shapes::shape::Sphere;

use super::currents::{Harmonic, OuterReaction};
use super::domain::BoxDomain;
use super::{
    Amplitude, BodyScene, Coil, Domain, EddyCurrents, ElectricPotential, Geometry, Method, Output,
    Permeability, Scene,
};
use crate::cloud::points::{Layers, Points};

/// The wall of the field lies so many radii of the drop from its centre.
const WALL: f64 = 10.0;
/// First layer beside the surface over the spacing of the field, and over the skin depth, at most.
const FIRST: f64 = 0.3;
const THIN: f64 = 0.25;

/// An alternating magnetic field about a liquid that conducts: the mean force of its currents acts at every step. The
/// currents must not meet the surface, as in a drop on the axis of its coils; those that do are reported.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MagneticField {
    /// Conductivity of the liquid.
    #[schemars(range(max = 1e12), extend("x-unit" = "S/m", "exclusiveMinimum" = 0.0))]
    pub conductivity_s_m: f64,
    /// Frequency.
    #[schemars(range(max = 1e12), extend("x-unit" = "Hz", "exclusiveMinimum" = 0.0))]
    pub frequency_hz: f64,
    /// Coils: loops and segments.
    #[schemars(length(min = 1))]
    pub coils: Vec<Coil>,
    /// Whether currents are given as root mean square or as peak values.
    #[serde(default)]
    pub amplitude: Amplitude,
    /// Whether all currents are multiplied by one factor so that the lift at the start equals the weight; the factor is
    /// reported.
    #[serde(default)]
    pub balanced: bool,
    /// Distance of the points of the field along the surface; that of `points` when it is absent.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub spacing_m: Option<f64>,
    /// Distance of their first layer from the surface; 0.3 of their spacing and a quarter of the skin depth, whichever is less,
    /// when it is absent.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub first_m: Option<f64>,
    /// Degree of the polynomials of the field.
    #[serde(default = "order")]
    #[schemars(range(min = 2, max = 4))]
    pub order: u8,
}

fn order() -> u8 {
    4
}

impl MagneticField {
    /// Depth in which currents fall to 1/e \[m\].
    #[must_use]
    pub fn skin(&self) -> f64 {
        let omega = std::f64::consts::TAU * self.frequency_hz;
        (2.0 / (omega * crate::magnetic::source::MU0 * self.conductivity_s_m)).sqrt()
    }

    /// The scene of the field about a ball in place of the drop, all else left as it is.
    #[must_use]
    pub fn about(&self, scene: &Scene, centre: [f64; 3], radius: f64) -> Scene {
        let spacing = self.spacing_m.unwrap_or(scene.points.spacing_m);
        let first = (FIRST * spacing).min(THIN * self.skin());
        let edge = |side: f64| centre.iter().map(|c| c + side * WALL * radius).collect();
        let ball = BodyScene {
            name: "liquid".to_owned(),
            shape: Shape::Sphere(Sphere {
                name: None,
                centre_m: centre.to_vec(),
                radius_m: radius,
            }),
            relative_permittivity: 1.0,
            relative_permeability: Permeability::default(),
            conductivity_s_m: self.conductivity_s_m,
            potential_v: None,
            net_current_a: None,
            net_current_phase_deg: None,
            spacing_m: None,
        };
        Scene {
            title: None,
            geometry: Geometry::Space,
            domain: Domain::Box(BoxDomain {
                min_m: edge(-1.0),
                max_m: edge(1.0),
            }),
            surroundings: scene.surroundings,
            bodies: vec![ball],
            electrostatics: None,
            eddy_currents: Some(self.currents()),
            liquid: None,
            points: Points {
                spacing_m: spacing,
                layers: Layers {
                    first_m: Some(self.first_m.unwrap_or(first)),
                    ..Layers::default()
                },
                ..scene.points.clone()
            },
            method: Method {
                order: usize::from(self.order),
                ..Method::default()
            },
            solver: scene.solver,
            output: Output::default(),
        }
    }

    fn currents(&self) -> EddyCurrents {
        EddyCurrents {
            harmonic: Some(Harmonic {
                frequency_hz: self.frequency_hz,
            }),
            transient: None,
            standing: None,
            coils: self.coils.clone(),
            applied_flux_density_t: None,
            magnet: None,
            amplitude: self.amplitude,
            outer: OuterReaction::Multipole,
            potential: Some(ElectricPotential::None),
        }
    }

    pub(super) fn check(&self, scene: &Scene, misfits: &mut Vec<Misfit>) {
        const AT: &str = "/liquid/magnetic";
        for (number, coil) in self.coils.iter().enumerate() {
            let at = format!("{AT}/coils/{number}");
            match coil {
                Coil::Loop(_) | Coil::Segments(_) => coil.check(&at, scene, misfits),
                Coil::Wire(_) | Coil::Region(_) => {
                    let what = "a liquid in space has \"loop\" and \"segments\" about it";
                    misfits.push(Misfit::at(&at, what));
                }
            }
        }
        let weighs = scene.liquid.as_ref().and_then(|l| l.gravity_m_s2.as_ref());
        if self.balanced && weighs.is_none_or(|g| g.iter().all(|g| *g == 0.0)) {
            let what = "without \"gravity_m_s2\" there is no weight that a lift could equal";
            misfits.push(Misfit::at(&format!("{AT}/balanced"), what));
        }
    }
}
