//! Grains in a scene.

use contact::{Elastic, Ending, Friction, Hertz, Linear, Rolling};
use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;
use shapes::Shape;

use super::heat_parameters::GrainHeat;
use super::law::Law;
use super::metal_parameters::{HertzScene, MetalScene};
use super::wall_parameters::WallScene;

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
