//! A liquid with a free surface.

use run::Fault;
use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;
use shapes::Shape;
use shapes::check::{self, Misfit};

use super::faults::PLACE;
use super::{Domain, Faces, Geometry, Groups, LiquidHeat, MagneticField, Scene};

/// How the liquid moves in time.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LiquidMarch {
    /// End.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub end_s: f64,
    /// Longest step; when it is absent, with the spacing h and the radius R of a sphere of the same volume: 0.3 h/R of
    /// sqrt(rho R^3/gamma), a quarter of sqrt(h/g) and of h over the fastest speed at the start, whichever is least.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub step_s: Option<f64>,
}

/// The shape of a drop at rest, found without a march: in a uniform electric field along z, in the alternating field that
/// `magnetic` is, or on a wall below it. It has the volume of the sphere that `shape` is.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Equilibrium {
    /// Electric field far away; absent in a magnetic field.
    #[schemars(extend("x-unit" = "V/m", "exclusiveMinimum" = 0.0))]
    pub field_v_m: Option<f64>,
    /// Contact angle of a drop on a wall, measured within the liquid; no wall when it is absent. The wall is horizontal and passes
    /// through the centre of the sphere; gravity is along z, and upward where the drop hangs.
    #[schemars(range(min = 1.0, max = 179.0), extend("x-unit" = "deg"))]
    pub contact_angle_deg: Option<f64>,
    /// Permittivity of the liquid over that of the gas; a conductor when it is absent.
    #[schemars(range(max = 1e12), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub relative_permittivity: Option<f64>,
    /// Whether the greatest field in which a drop is at rest is found too.
    #[serde(default)]
    pub limit: bool,
}

/// A uniform electric field about a liquid that moves: its traction on the surface acts at every step.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElectricField {
    /// Field far away.
    #[schemars(extend("x-unit" = "V/m"), length(min = 3, max = 3))]
    pub field_v_m: Vec<f64>,
    /// Permittivity of the liquid over that of the gas; a conductor when it is absent.
    #[schemars(range(max = 1e12), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub relative_permittivity: Option<f64>,
    /// Conductivity of the liquid over that of the gas, where charges gather on the surface faster than it moves (Taylor 1966); nothing
    /// leaks when it is absent.
    #[schemars(range(max = 1e12), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub relative_conductivity: Option<f64>,
    /// Charge of a conductor, none when it is absent; several drops share it by their volumes at the start.
    #[schemars(extend("x-unit" = "C"))]
    pub charge_c: Option<f64>,
    /// Degree of the polynomials of potentials.
    #[serde(default = "order")]
    #[schemars(range(min = 3, max = 4))]
    pub order: u8,
}

/// A liquid with a free surface, on points that move with it (Matsuzawa 2017, chapter 2.2). The spacing of `points` is the one
/// number that refines.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Liquid {
    /// What it fills at the start.
    pub shape: Shape,
    /// Faces of the box that it fills, between which it moves; a drop in the open when it is absent.
    pub faces: Option<Faces>,
    /// Density.
    #[schemars(extend("x-unit" = "kg/m3", "exclusiveMinimum" = 0.0))]
    pub density_kg_m3: f64,
    /// Viscosity; none when it is absent.
    #[schemars(extend("x-unit" = "Pa s", "exclusiveMinimum" = 0.0))]
    pub viscosity_pa_s: Option<f64>,
    /// Surface tension; none when it is absent.
    #[schemars(extend("x-unit" = "N/m", "exclusiveMinimum" = 0.0))]
    pub surface_tension_n_m: Option<f64>,
    /// Pressure of the gas around.
    #[serde(default)]
    #[schemars(extend("x-unit" = "Pa"))]
    pub gas_pressure_pa: f64,
    /// Acceleration of gravity; none when it is absent.
    #[schemars(extend("x-unit" = "m/s2"), length(min = 2, max = 3))]
    pub gravity_m_s2: Option<Vec<f64>>,
    /// Velocity at the start, functions of x, y, z, r without divergence; at rest when it is absent.
    #[schemars(extend("x-unit" = "m/s"), length(min = 2, max = 3))]
    pub velocity_m_s: Option<Vec<Property>>,
    /// Degree of the polynomials of derivatives.
    #[serde(default = "order")]
    #[schemars(range(min = 2, max = 3))]
    pub order: u8,
    /// Drops that meet and part; none do when it is absent.
    pub groups: Option<Groups>,
    /// Electric field in which it moves; none when it is absent.
    pub electric: Option<ElectricField>,
    /// Alternating magnetic field in which it moves or rests; none when it is absent.
    pub magnetic: Option<MagneticField>,
    /// Heat in it; none when it is absent.
    pub heat: Option<LiquidHeat>,
    /// Motion in time; this or `equilibrium`.
    pub march: Option<LiquidMarch>,
    /// Rest in a field; this or `march`.
    pub equilibrium: Option<Equilibrium>,
}

fn order() -> u8 {
    3
}

impl Liquid {
    pub(super) fn check(&self, scene: &Scene, misfits: &mut Vec<Misfit>) {
        let dimensions = scene.geometry.dimensions();
        let spacing = scene.points.spacing_m;
        check::filled(&self.shape, "/liquid/shape", dimensions, spacing, misfits);
        if let Some(faces) = &self.faces {
            faces.check(scene, self, misfits);
        } else if scene.geometry != Geometry::Space {
            let what = "a drop moves in space: take \"space\", or \"faces\" of the liquid";
            misfits.push(Misfit::at("/geometry", what));
        }
        if let Some(g) = &self.gravity_m_s2 {
            check::coordinates(g, "/liquid/gravity_m_s2", dimensions, misfits);
        }
        if let Some(v) = &self.velocity_m_s
            && v.len() != dimensions
        {
            let what = format!("{} components; {dimensions} are wanted", v.len());
            misfits.push(Misfit::at("/liquid/velocity_m_s", what));
        }
        match (&self.march, &self.equilibrium) {
            (Some(march), None) => {
                if let Some(step) = march.step_s
                    && step > march.end_s
                {
                    let what = format!("{step} s is beyond the end at {} s", march.end_s);
                    misfits.push(Misfit::at("/liquid/march/step_s", what));
                }
            }
            (None, Some(rest)) => self.check_rest(rest, misfits),
            (None, None) => {
                let what = "one of \"march\" and \"equilibrium\" is wanted";
                misfits.push(Misfit::at("/liquid", what));
            }
            (Some(_), Some(_)) => {
                let what = "\"march\" and \"equilibrium\" exclude each other";
                misfits.push(Misfit::at("/liquid/equilibrium", what));
            }
        }
        if self.groups.is_some() {
            Groups::check(self, misfits);
        }
        if let Some(electric) = &self.electric {
            self.check_electric(electric, misfits);
        }
        if let Some(magnetic) = &self.magnetic {
            magnetic.check(scene, misfits);
        }
        if let Some(heat) = &self.heat {
            heat.check(self, misfits);
        }
        let fields = scene.electrostatics.is_some() || scene.eddy_currents.is_some();
        if fields {
            let what = "a liquid moves in the field of its key \"electric\" or \"magnetic\" alone: leave \"electrostatics\" and \"eddy_currents\" away";
            misfits.push(Misfit::at("/liquid", what));
        } else if !scene.bodies.is_empty() {
            let what = "bodies act by their fields, and the scene has none: leave them away";
            misfits.push(Misfit::at("/bodies", what));
        } else if scene.domain != Domain::default() {
            let what = "fields are sought in a domain, and the scene has none: leave it away";
            misfits.push(Misfit::at("/domain", what));
        }
    }

    /// A field that acts on a march.
    fn check_electric(&self, electric: &ElectricField, misfits: &mut Vec<Misfit>) {
        let field = &electric.field_v_m;
        check::coordinates(field, "/liquid/electric/field_v_m", 3, misfits);
        if self.march.is_none() {
            let what = "acts on a march: take \"march\"";
            misfits.push(Misfit::at("/liquid/electric", what));
        }
        if self.magnetic.is_some() {
            let what = "\"electric\" and \"magnetic\" exclude each other";
            misfits.push(Misfit::at("/liquid/electric", what));
        }
        if electric.relative_conductivity.is_some() {
            if electric.relative_permittivity.is_none() {
                let what = "belongs to a dielectric: take \"relative_permittivity\"";
                misfits.push(Misfit::at("/liquid/electric/relative_conductivity", what));
            }
            if self.viscosity_pa_s.is_none() {
                let what = "charges that leak drag the surface along, and friction alone holds it: take \"viscosity_pa_s\"";
                misfits.push(Misfit::at("/liquid/electric/relative_conductivity", what));
            }
        }
        if electric.charge_c.is_some() && electric.relative_permittivity.is_some() {
            let what = "a dielectric has no free charge: leave \"relative_permittivity\" away";
            misfits.push(Misfit::at("/liquid/electric/charge_c", what));
        }
    }

    /// What a drop at rest in a field is and is not.
    fn check_rest(&self, rest: &Equilibrium, misfits: &mut Vec<Misfit>) {
        let electric = rest.field_v_m.is_some();
        let wall = rest.contact_angle_deg.is_some();
        let given = [electric, wall, self.magnetic.is_some()];
        if given.iter().filter(|g| **g).count() != 1 {
            let what = "one of \"field_v_m\", \"contact_angle_deg\" and the key \"magnetic\" of the liquid is wanted";
            misfits.push(Misfit::at("/liquid/equilibrium", what));
        }
        if !electric && (rest.limit || rest.relative_permittivity.is_some()) {
            let what =
                "\"limit\" and \"relative_permittivity\" belong to \"field_v_m\": leave them away";
            misfits.push(Misfit::at("/liquid/equilibrium", what));
        }
        let aslant = self
            .gravity_m_s2
            .as_ref()
            .filter(|g| g.iter().take(2).any(|c| *c != 0.0));
        if wall && aslant.is_some() {
            let what = "a drop on a wall is round about z: take gravity along z";
            misfits.push(Misfit::at("/liquid/gravity_m_s2", what));
        }
        if !matches!(self.shape, Shape::Sphere(_)) {
            let what = "a drop at rest in a field has the volume of a sphere: take \"sphere\"";
            misfits.push(Misfit::at("/liquid/shape", what));
        }
        if self.surface_tension_n_m.is_none() {
            let what = "\"surface_tension_n_m\" is wanted: it holds the drop together";
            misfits.push(Misfit::at("/liquid", what));
        }
        for (given, key) in [
            (electric && self.gravity_m_s2.is_some(), "gravity_m_s2"),
            (self.velocity_m_s.is_some(), "velocity_m_s"),
        ] {
            if given {
                let what = "has no part in a drop at rest that nothing holds: leave it away";
                misfits.push(Misfit::at(&format!("/liquid/{key}"), what));
            }
        }
    }

    pub(super) fn formulas(&self, faults: &mut Vec<Fault>) {
        for (k, v) in self.velocity_m_s.iter().flatten().enumerate() {
            let at = format!("/liquid/velocity_m_s/{k}");
            faults.extend(v.compile(&at, &PLACE).err());
        }
        if let Some(heat) = &self.heat {
            heat.formulas(faults);
        }
    }
}
