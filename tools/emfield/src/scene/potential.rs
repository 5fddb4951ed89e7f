//! Electrostatics in a scene.

use run::Fault;
use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;
use shapes::check::{self, Misfit};

use super::faults::PLACE;
use super::{Domain, Geometry, Scene};

/// What holds at walls of the domain.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OuterPotential {
    /// Names of walls; every wall when they are absent.
    pub faces: Option<Vec<String>>,
    /// Potential, a function of x, y, z, r; no field passes through the wall when it is absent.
    #[schemars(extend("x-unit" = "V"))]
    pub potential_v: Option<Property>,
}

/// What holds at all walls together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Open {
    /// What bodies add to the applied potential is that of their multipoles: no error of truncation beyond the sixth
    /// degree, in a plane and about an axis the eighth. In space and about an axis nothing of it is left far away; in a
    /// plane the bodies have no charge together, and the potential far away is what lets them have none.
    Multipole,
}

/// What holds at the walls: a list of entries, or `"multipole"` where they stand for open space beyond all bodies.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Outer {
    /// The first entry that names a wall counts; a wall that none names lets no field through.
    Walls(Vec<OuterPotential>),
    /// Open space.
    Open(Open),
}

impl Default for Outer {
    fn default() -> Self {
        Self::Walls(Vec::new())
    }
}

/// The electric field of charges and electrodes: div(eps grad V) = 0 (Matsuzawa 2017, eq. 2.60).
#[derive(Debug, Clone, PartialEq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Electrostatics {
    /// What holds at the walls: the first entry that names a wall counts; a wall that none names lets no field
    /// through. Or `"multipole"`, as of `eddy_currents`: open space beyond them.
    #[serde(default)]
    pub outer: Outer,
    /// A uniform field E0 that acts from far away; the potential at the walls is then that given in `outer` beside
    /// `- E0 . x`.
    #[schemars(extend("x-unit" = "V/m"), length(min = 2, max = 3))]
    pub applied_field_v_m: Option<Vec<f64>>,
    /// The potential of sources outside the domain, as they would have it without the bodies, a function of x, y, z, r
    /// without a Laplacian in the domain; where `outer` is `"multipole"`.
    #[schemars(extend("x-unit" = "V"))]
    pub applied_potential_v: Option<Property>,
}

impl Electrostatics {
    /// The entries of walls; none where they are open.
    #[must_use]
    pub fn walls(&self) -> &[OuterPotential] {
        match &self.outer {
            Outer::Walls(walls) => walls,
            Outer::Open(_) => &[],
        }
    }

    /// Whether the walls stand for open space.
    #[must_use]
    pub fn open(&self) -> bool {
        matches!(self.outer, Outer::Open(_))
    }
}

impl Electrostatics {
    /// What a schema cannot tell of it.
    pub(super) fn check(&self, scene: &Scene, misfits: &mut Vec<Misfit>) {
        let walls = scene.domain.walls(scene.geometry);
        let dimensions = scene.geometry.dimensions();
        for (number, entry) in self.walls().iter().enumerate() {
            for (k, face) in entry.faces.iter().flatten().enumerate() {
                if !walls.contains(&face.as_str()) {
                    let at = format!("/electrostatics/outer/{number}/faces/{k}");
                    let what = format!("\"{face}\" is no wall; walls are {}", walls.join(", "));
                    misfits.push(Misfit::at(&at, what));
                }
            }
        }
        let at = "/electrostatics/applied_field_v_m";
        if let Some(field) = &self.applied_field_v_m
            && check::coordinates(field, at, dimensions, misfits)
            && scene.geometry == Geometry::Axisymmetric
            && field[0] != 0.0
        {
            misfits.push(Misfit::at(
                &format!("{at}/0"),
                "a uniform field has no radial part in an axisymmetric scene",
            ));
        }
        let held = self.walls().iter().any(|o| o.potential_v.is_some())
            || scene.bodies.iter().any(|b| b.potential_v.is_some())
            || self.applied_field_v_m.is_some()
            || self.open() && self.applied_potential_v.is_some();
        if !held {
            let what = if self.open() {
                "no body has a potential and no field is applied: there would be none"
            } else {
                "no wall and no body has a potential: it would be known up to a constant only"
            };
            misfits.push(Misfit::at("/electrostatics", what));
        }
        self.check_open(scene, misfits);
    }

    /// What open walls can be, and what wants them.
    fn check_open(&self, scene: &Scene, misfits: &mut Vec<Misfit>) {
        if self.applied_potential_v.is_some() && !self.open() {
            misfits.push(Misfit::at(
                "/electrostatics/applied_potential_v",
                "stands where \"outer\" is \"multipole\"; walls that are given have a \"potential_v\" of their own",
            ));
        }
        if let Domain::Box(b) = &scene.domain
            && self.open()
            && scene.geometry == Geometry::Axisymmetric
            && b.min_m.first().is_some_and(|r| *r > 0.0)
        {
            let what = format!(
                "\"multipole\" wants walls about all bodies: the box begins at r = {} m, off the axis; let it begin at 0, or give the potentials of the walls",
                b.min_m[0]
            );
            misfits.push(Misfit::at("/electrostatics/outer", what));
        }
    }

    /// Faults of formulas.
    pub(super) fn formulas(&self, faults: &mut Vec<Fault>) {
        for (number, entry) in self.walls().iter().enumerate() {
            if let Some(potential) = &entry.potential_v {
                let at = format!("/electrostatics/outer/{number}/potential_v");
                faults.extend(potential.compile(&at, &PLACE).err());
            }
        }
        if let Some(potential) = &self.applied_potential_v {
            let at = "/electrostatics/applied_potential_v";
            faults.extend(potential.compile(at, &PLACE).err());
        }
    }
}
