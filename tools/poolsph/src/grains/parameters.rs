//! Grains in a scene.

use std::sync::Arc;

use contact::{Elastic, Ending, Friction, Hertz, Linear, Rolling};
use run::Fault;
use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;
use shapes::Shape;

use super::law::Law;
use super::metal_parameters::{HertzScene, MetalScene};
use super::vapour::VapourScene;
use super::wall_parameters::WallScene;
use crate::heat::{self, Caloric};

/// Grains, what they are made of and what holds them.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Density rho of the grains.
    #[schemars(extend("x-unit" = "kg/m3", "exclusiveMinimum" = 0.0))]
    pub density_kg_m3: f64,
    /// Inertia factor I / (m r^2): 2/5 for a solid sphere, 2/3 for a hollow one.
    #[serde(default = "solid_sphere")]
    #[schemars(range(max = 1.0), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub inertia_factor: f64,
    /// Gravity g that acts on the grains; absent: none.
    #[schemars(extend("x-unit" = "m/s2"))]
    pub gravity_m_s2: Option<[f64; 3]>,
    /// What grains that touch do to each other.
    pub contact: ContactScene,
    /// Grains at the start.
    #[schemars(length(min = 1, max = 250))]
    pub bodies: Vec<GrainBody>,
    /// Walls. A grain has one contact with each wall: a corner in which grains lie needs several walls, or a hollow one.
    #[serde(default)]
    pub walls: Vec<WallScene>,
    /// Grains are followed within this box and forgotten outside; absent: everywhere.
    pub bounds: Option<BoundsScene>,
    /// Heat between grains that touch; absent: no temperatures.
    pub heat: Option<GrainHeat>,
    /// How metal acts on grains, where a scene has both; absent: with the friction of grains on each other and the elasticity of
    /// steel.
    pub metal: Option<MetalScene>,
    /// The run ends as soon as the grains have come to rest; absent: at `end_s`.
    pub until: Option<RestScene>,
    /// Grains at rest sleep, which saves time: they are not moved until something disturbs them; absent: all grains are moved in
    /// each step.
    pub sleep: Option<SleepScene>,
    /// Least number of steps in the duration of a contact between two of the lightest grains; stability may require more.
    #[serde(default = "twenty")]
    #[schemars(range(min = 5.0, max = 10000.0), extend("x-unit" = "1"))]
    pub steps_per_contact: f64,
}

fn solid_sphere() -> f64 {
    contact::steps::SOLID_SPHERE
}

fn twenty() -> f64 {
    20.0
}

/// What grains that touch do to each other.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactScene {
    /// Law of the normal force.
    pub law: LawScene,
    /// Coefficient of restitution e.
    #[schemars(range(max = 1.0), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub restitution: f64,
    /// When a contact ends.
    #[serde(default)]
    pub ending: EndingScene,
    /// Coefficient of friction; absent: contacts have no friction.
    #[schemars(range(min = 0.0), extend("x-unit" = "1"))]
    pub friction: Option<f64>,
    /// Resistance to rolling; absent: none.
    pub rolling: Option<RollingScene>,
}

/// When grains fall asleep, by cells of some two grains along each side. What is slower is taken for rest.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SleepScene {
    /// A cell falls asleep where, over `held_s`, the grains of it and of the cells beside it have moved on average no farther than at
    /// this speed; surfaces of grains that rotate count likewise.
    #[schemars(extend("x-unit" = "m/s", "exclusiveMinimum" = 0.0))]
    pub speed_m_s: f64,
    /// Time over which the movement of the grains is measured.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub held_s: f64,
    /// A single grain may move this many times as far: one that rattles between others and bears no load.
    #[serde(default = "one")]
    #[schemars(range(min = 1.0, max = 1000.0), extend("x-unit" = "1"))]
    pub rattle: f64,
    /// Heat between grains that sleep, away from awake ones, and from metal into them is computed once in this number of steps of
    /// the run, over all of their time.
    #[serde(default = "each")]
    #[schemars(range(min = 1, max = 10000), extend("x-unit" = "1"))]
    pub heat_interval_steps: u64,
}

fn each() -> u64 {
    1
}

/// Law of the push.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LawScene {
    /// Spring and dashpot.
    Linear(LinearScene),
    /// Elastic spheres (Hertz and Mindlin).
    Hertz(HertzScene),
}

/// Spring and dashpot.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinearScene {
    /// Stiffness k of the normal spring.
    #[schemars(extend("x-unit" = "N/m", "exclusiveMinimum" = 0.0))]
    pub stiffness_n_m: f64,
    /// Stiffness of the tangential spring over that of the normal one, k_t/k.
    #[serde(default = "one")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub tangential_ratio: f64,
}

fn one() -> f64 {
    1.0
}

/// Where a contact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EndingScene {
    /// Where the force is zero: grains never pull.
    #[default]
    ZeroForce,
    /// Where the overlap is zero: the dashpot pulls at the end.
    ZeroOverlap,
}

/// Resistance to rolling.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RollingScene {
    /// The moment against rolling is at most this coefficient times the normal force and the effective radius.
    #[schemars(range(min = 0.0), extend("x-unit" = "1"))]
    pub coefficient: f64,
    /// Stiffness of the rolling spring over that of the tangential spring.
    #[serde(default = "one")]
    #[schemars(range(max = 1.0), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub stiffness_ratio: f64,
}

/// Grains of one size.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainBody {
    /// Places of single grains. A body has exactly one of `places_m`, `shape` and `bed`.
    #[serde(default)]
    #[schemars(extend("x-unit" = "m"))]
    pub places_m: Vec<[f64; 3]>,
    /// A shape that is filled with grains on a cubic lattice; each grain lies wholly inside.
    pub shape: Option<Shape>,
    /// The grains of the input `bed`, where they lay at its end.
    #[serde(default)]
    pub bed: bool,
    /// Radius of a grain; not needed for a bed, whose grains have their own radii.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub radius_m: Option<f64>,
    /// Spacing of the lattice; a diameter if absent.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub spacing_m: Option<f64>,
    /// Grains in a shape are shifted at random by up to this part of the spacing along each axis.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.5), extend("x-unit" = "1"))]
    pub jitter: f64,
    /// Density of these grains; that of the key `grains` if absent.
    #[schemars(extend("x-unit" = "kg/m3", "exclusiveMinimum" = 0.0))]
    pub density_kg_m3: Option<f64>,
    /// u at the start; rest if absent.
    #[schemars(extend("x-unit" = "m/s"))]
    pub velocity_m_s: Option<[f64; 3]>,
    /// Angular velocity at the start; none if absent.
    #[schemars(extend("x-unit" = "rad/s"))]
    pub spin_rad_s: Option<[f64; 3]>,
    /// T at the start, a number or a formula in x, y, z, r; needed with heat.
    #[schemars(extend("x-unit" = "K"))]
    pub temperature_k: Option<Property>,
    /// T that the grains keep, a number or a formula in t. Absent: their temperature changes freely.
    #[schemars(extend("x-unit" = "K"))]
    pub held_temperature_k: Option<Property>,
    /// The grains are glued: they move as one rigid body under the sum of their forces and moments. Free of each other if absent.
    #[serde(default)]
    pub glued: bool,
    /// Prescribed velocity of the grains, numbers or formulas in t; they do not rotate. Absent: they move freely.
    #[schemars(extend("x-unit" = "m/s"))]
    pub driven_m_s: Option<[Property; 3]>,
}

/// Heat between grains that touch.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainHeat {
    /// kappa(T) of the grain itself, not of the bed.
    #[schemars(extend("x-unit" = "W/(m K)"))]
    pub thermal_conductivity_w_m_k: Property,
    /// c(T).
    #[schemars(extend("x-unit" = "J/(kg K)"))]
    pub specific_heat_j_kg_k: Property,
    /// How wide the area is through which a contact conducts.
    #[serde(default)]
    pub contact: ConductanceScene,
    /// kappa(T) of the gas around contacts; absent: it conducts nothing.
    #[schemars(extend("x-unit" = "W/(m K)"))]
    pub gas_conductivity_w_m_k: Option<Property>,
    /// Melting to slag; absent: grains never melt.
    pub melting: Option<GrainMelting>,
    /// Slag wets what it touches: a contact conducts through the whole grain where one of both is molten, both have been, or the other
    /// is metal. Absent: it touches as a grain of powder does.
    #[serde(default)]
    pub slag_wets: bool,
    /// What becomes of the vapour of slag that boils.
    #[serde(default)]
    pub slag_vapour: VapourScene,
}

/// How wide a contact conducts.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ConductanceScene {
    /// As elastic spheres of the real modulus under the same push; that of soda-lime glass if absent.
    Elastic(HertzScene),
    /// As the overlap (Komen 2019, eq. 5.34).
    Overlap,
    /// As the overlap, and half of what that conducts: eq. 5.35 as printed.
    Printed,
}

impl ConductanceScene {
    /// What makes contacts wide, where that is elasticity.
    #[must_use]
    pub fn elastic(self) -> Option<HertzScene> {
        match self {
            Self::Elastic(elastic) => Some(elastic),
            Self::Overlap | Self::Printed => None,
        }
    }
}

impl Default for ConductanceScene {
    /// Soda-lime glass, the silicate best known: 70 GPa, 0.22.
    fn default() -> Self {
        Self::Elastic(HertzScene {
            youngs_modulus_pa: 70e9,
            poisson_ratio: 0.22,
        })
    }
}

/// Melting of grains to slag, and setting.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainMelting {
    /// T_m.
    #[schemars(extend("x-unit" = "K"), range(min = 1.0, max = 1e4))]
    pub point_k: f64,
    /// L.
    #[schemars(extend("x-unit" = "J/kg"), range(min = 0.0, max = 1e8))]
    pub latent_heat_j_kg: f64,
    /// Thermal conductivity of slag over that of the grain; above 1 to allow for the convection in slag.
    #[serde(default = "three")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub slag_conductivity_ratio: f64,
    /// T at which slag boils: further heat goes with its vapour (`slag_vapour`), whose mass is neglected. Absent: it never boils.
    #[schemars(extend("x-unit" = "K"), range(min = 1.0, max = 1e4))]
    pub boiling_k: Option<f64>,
}

fn three() -> f64 {
    3.0
}

impl GrainHeat {
    /// What of slag cannot be.
    #[must_use]
    pub fn unmolten(&self) -> Option<Fault> {
        let condenses = self.slag_vapour == VapourScene::Condenses;
        let Some(melting) = self.melting else {
            let what =
                "grains without 'melting' never are slag: leave it out, or say when they melt";
            let condenses = condenses.then(|| Fault::at("/slag_vapour", what));
            return (self.slag_wets.then(|| Fault::at("/slag_wets", what))).or(condenses);
        };
        if condenses && melting.boiling_k.is_none() {
            let what = "slag that never boils has no vapour: leave it out, or say 'boiling_k' of 'melting'";
            return Some(Fault::at("/slag_vapour", what));
        }
        let boiling = melting.boiling_k.filter(|t| *t <= melting.point_k)?;
        let what = format!(
            "{boiling} K is not above the melting point, {} K",
            melting.point_k
        );
        Some(Fault::at("/melting/boiling_k", what))
    }

    /// Enthalpy and conductivity of the grains.
    ///
    /// # Errors
    /// A property that cannot be.
    pub fn caloric(&self) -> Result<Arc<Caloric>, Fault> {
        heat::Parameters {
            thermal_conductivity_w_m_k: self.thermal_conductivity_w_m_k.clone(),
            specific_heat_j_kg_k: self.specific_heat_j_kg_k.clone(),
            melting: self.melting.map(|melting| heat::MeltingParameters {
                point_k: melting.point_k,
                latent_heat_j_kg: melting.latent_heat_j_kg,
            }),
            rest_interval_steps: 1,
            exchange_tolerance_k: 0.0,
            faces: None,
        }
        .caloric()
    }
}

/// When grains rest.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RestScene {
    /// Speed that no grain exceeds while they rest.
    #[schemars(extend("x-unit" = "m/s", "exclusiveMinimum" = 0.0))]
    pub speed_m_s: f64,
    /// Time for which no grain may be faster.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub held_s: f64,
}

/// Box in which grains are followed.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoundsScene {
    /// Lower corner.
    #[schemars(extend("x-unit" = "m"))]
    pub min_m: [f64; 3],
    /// Upper corner.
    #[schemars(extend("x-unit" = "m"))]
    pub max_m: [f64; 3],
}

impl BoundsScene {
    /// Whether a place is within.
    #[must_use]
    pub fn holds(&self, place: [f64; 3]) -> bool {
        (0..3).all(|k| place[k] >= self.min_m[k] && place[k] <= self.max_m[k])
    }
}

impl ContactScene {
    /// The law of the push.
    #[must_use]
    pub fn law(&self) -> Law {
        let ending = match self.ending {
            EndingScene::ZeroForce => Ending::ZeroForce,
            EndingScene::ZeroOverlap => Ending::ZeroOverlap,
        };
        match self.law {
            LawScene::Linear(LinearScene {
                stiffness_n_m: k,
                tangential_ratio,
            }) => Law::Linear(Linear::new(
                k,
                tangential_ratio * k,
                self.restitution,
                ending,
            )),
            LawScene::Hertz(hertz) => {
                let material = Elastic {
                    youngs_modulus: hertz.youngs_modulus_pa,
                    poisson_ratio: hertz.poisson_ratio,
                };
                Law::Hertz(Hertz::new([material; 2], self.restitution, ending))
            }
        }
    }

    /// Friction of grains, if there is any.
    #[must_use]
    pub fn friction(&self) -> Option<Friction> {
        self.friction.map(|coefficient| Friction { coefficient })
    }

    /// Resistance to rolling, if there is any.
    #[must_use]
    pub fn rolling(&self) -> Option<Rolling> {
        self.rolling.map(|rolling| Rolling {
            coefficient: rolling.coefficient,
            stiffness_ratio: rolling.stiffness_ratio,
        })
    }
}
