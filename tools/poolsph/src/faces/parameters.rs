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
    /// Walls to which the liquid sticks, in the plane of the face itself.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub wall: Vec<WallParameters>,
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
        Ok(Faces::new(self.min_m, self.max_m, sides))
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
            (Some(property), true) => Some(property.compile(&key, &["x", "y", "z", "t"])?),
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
