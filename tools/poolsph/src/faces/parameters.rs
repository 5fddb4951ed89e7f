//! What a scene says of the faces of the flow.

use run::Fault;
use run::property::{Curve, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shapes::{Axis, Face};

use super::planes::{Faces, Side};

/// The box whose faces the flow goes on beside, and what its faces are (key `faces`). A face that is not named is none:
/// the liquid may leave the box there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "FlowFaces")]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Lower corner \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub min_m: [f64; 3],
    /// Upper corner \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub max_m: [f64; 3],
    /// Axes along which what leaves through one face enters through the other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub periodic: Vec<Axis>,
    /// Planes of symmetry: nothing flows through them, nothing drags along them, no heat crosses them. A wall on which
    /// the liquid slips is the same.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mirror: Vec<Face>,
    /// Planes that hold the free surface flat, as rigid lids: the liquid slips along them and does not leave them. Heat, losses and
    /// stresses of the surface act there as on any other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lid: Vec<Face>,
    /// Walls to which the liquid sticks, in the plane of the face itself.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub wall: Vec<WallParameters>,
    /// Angles at which the free surface meets mirrors and walls; a right angle where none is given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contact_angles: Vec<ContactAngle>,
}

/// The angle at which a free surface that has tension meets a face.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactAngle {
    /// Which face it is: a mirror or a wall.
    pub face: Face,
    /// Angle between face and surface, within the liquid: below 90 degrees the liquid wets the face. Below 50 degrees the edge
    /// is a film too thin for particles.
    #[schemars(range(min = 50.0, max = 165.0), extend("x-unit" = "deg"))]
    pub angle_deg: f64,
}

/// A wall in the plane of a face.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "FlowWall")]
#[serde(deny_unknown_fields)]
pub struct WallParameters {
    /// Which face it is.
    pub face: Face,
    /// U, along the wall \[m/s\]; rest if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "m/s"))]
    pub velocity_m_s: Option<[f64; 3]>,
    /// T of the wall \[K\], a number or a formula in x, y, z, t; insulated if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "K"))]
    pub temperature_k: Option<Property>,
}

const NAMES: [&str; 3] = ["x", "y", "z"];

impl Parameters {
    /// x of the one mirror across which the weld goes on \[m\]; none where there is none, or two.
    #[must_use]
    pub fn mirror_x_m(&self) -> Option<f64> {
        let mut across = self.mirror.iter().filter_map(|face| match face.side() {
            (0, upper) => Some(if upper { self.max_m[0] } else { self.min_m[0] }),
            _ => None,
        });
        across.next().filter(|_| across.next().is_none())
    }

    /// True if a wall keeps a temperature.
    #[must_use]
    pub fn holds_heat(&self) -> bool {
        self.wall.iter().any(|wall| wall.temperature_k.is_some())
    }

    /// The faces, checked; `support` is that of the kernel \[m\], `heat` whether temperatures are followed.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn faces(&self, support: f64, heat: bool) -> Result<Faces, Fault> {
        let mut sides: [[Option<Side>; 2]; 3] = Default::default();
        let mut claim = |at: String, (axis, upper): (usize, bool), side: Side| {
            let place = &mut sides[axis][usize::from(upper)];
            let sign = if upper { '+' } else { '-' };
            match place.replace(side) {
                None => Ok(()),
                Some(_) => Err(Fault::at(
                    &at,
                    format!("the face '{}{sign}' is named twice", NAMES[axis]),
                )),
            }
        };
        for (i, axis) in self.periodic.iter().enumerate() {
            for upper in [false, true] {
                claim(
                    format!("/periodic/{i}"),
                    (axis.index(), upper),
                    Side::Periodic,
                )?;
            }
        }
        for (i, face) in self.mirror.iter().enumerate() {
            claim(format!("/mirror/{i}"), face.side(), Side::Mirror)?;
        }
        for (i, face) in self.lid.iter().enumerate() {
            claim(format!("/lid/{i}"), face.side(), Side::Lid)?;
        }
        for (i, wall) in self.wall.iter().enumerate() {
            let at = format!("/wall/{i}");
            claim(at.clone(), wall.face.side(), wall.side(&at, heat)?)?;
        }
        for (axis, name) in NAMES.into_iter().enumerate() {
            let wide = self.max_m[axis] - self.min_m[axis];
            // Solid metal two supports from the liquid is looked for across a periodic face.
            let least = match sides[axis] {
                [Some(Side::Periodic), _] => 2.25 * support,
                [Some(_), Some(_)] => support,
                _ => 0.0,
            };
            if wide <= 0.0 || wide < least * (1.0 - 1e-9) {
                let what = format!(
                    "the box is {wide} m wide in {name}, out of range: at least {least} m between its faces"
                );
                return Err(Fault::at(&format!("/max_m/{axis}"), what));
            }
        }
        let cots = self.cots(&sides)?;
        Ok(Faces::new(self.min_m, self.max_m, sides).with_contact_angles(cots))
    }

    /// Contact angles that mean nothing: without `tension`, or where the flow is not without divergence (`even`).
    #[must_use]
    pub fn meaningless_angles(&self, tension: bool, even: bool) -> Option<Fault> {
        let what = match (tension, even) {
            _ if self.contact_angles.is_empty() => return None,
            (true, true) => return None,
            (false, _) => "means nothing without the key 'tension'",
            (true, false) => {
                "means nothing with this method, whose cohesion has an angle of its own: take \"divergence_free\" as 'method' of 'flow'"
            }
        };
        Some(Fault::at("/contact_angles", what))
    }

    /// What means nothing where a lid holds the surface flat, of the keys of a scene that are there.
    pub fn under_lids<'a>(&self, there: impl Iterator<Item = &'a str>) -> Vec<Fault> {
        if self.lid.is_empty() {
            return Vec::new();
        }
        let fault = |key: &str| {
            let what = format!(
                "holds the surface flat, beside which '{key}' does nothing: leave one of them out"
            );
            Fault::at("/lid", what)
        };
        there.map(fault).collect()
    }

    /// cot theta at each face.
    fn cots(&self, sides: &[[Option<Side>; 2]; 3]) -> Result<[[f64; 2]; 3], Fault> {
        let mut cots = [[None; 2]; 3];
        for (i, angle) in self.contact_angles.iter().enumerate() {
            let (axis, upper) = angle.face.side();
            let (side, sign) = (usize::from(upper), if upper { '+' } else { '-' });
            let fault = |what: &str| {
                let what = format!("the face '{}{sign}' {what}", NAMES[axis]);
                Fault::at(&format!("/contact_angles/{i}/face"), what)
            };
            match sides[axis][side] {
                Some(Side::Mirror | Side::Wall { .. }) => {}
                Some(Side::Periodic) => return Err(fault("is periodic: no surface ends there")),
                Some(Side::Lid) => return Err(fault("is a lid, which the surface lies in")),
                None => return Err(fault("is neither a mirror nor a wall")),
            }
            // Nothing at a right angle, to the bit.
            let cot = (90.0 - angle.angle_deg).to_radians().tan();
            if cots[axis][side].replace(cot).is_some() {
                return Err(fault("has two angles"));
            }
        }
        Ok(cots.map(|axis| axis.map(Option::unwrap_or_default)))
    }
}

impl WallParameters {
    fn side(&self, at: &str, heat: bool) -> Result<Side, Fault> {
        let velocity = self.velocity_m_s.unwrap_or_default();
        let (axis, _) = self.face.side();
        if velocity[axis] != 0.0 {
            let what = format!(
                "{} m/s across the wall, out of range: 0, a wall moves along itself",
                velocity[axis]
            );
            return Err(Fault::at(&format!("{at}/velocity_m_s/{axis}"), what));
        }
        let key = format!("{at}/temperature_k");
        let temperature: Option<Curve> = match (&self.temperature_k, heat) {
            (None, _) => None,
            (Some(property), true) => {
                Some(property.compile_temperature(&key, &["x", "y", "z", "t"])?)
            }
            (Some(_), false) => {
                return Err(Fault::at(&key, "means nothing without the key 'heat'"));
            }
        };
        Ok(Side::Wall {
            velocity,
            temperature,
        })
    }
}
