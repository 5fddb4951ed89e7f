//! What a scene of averages says.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::grid::{Cut, Section};
use crate::heat_map::HEAT_MAP;
use crate::layout::Layout;
use crate::profile::PROFILE;

/// A scene of averages. Lengths are in the frame of reference of the averages: with `follow`, x and
/// y count from the source; z counts from the original surface of the plate.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// What is averaged, for people.
    #[serde(default)]
    pub title: Option<String>,
    /// Channel of the particle frames; `/pool` when absent.
    #[serde(default = "pool")]
    pub channel: String,
    /// Which frames count; absent: all.
    #[serde(default)]
    pub time: Option<Span>,
    /// Averages on a grid that moves with the source, and velocities relative to it; absent: at rest.
    #[serde(default)]
    pub follow: Option<Follow>,
    /// Averages at equal phases of the droplet period; absent: over time alone. Needs `follow`.
    #[serde(default)]
    pub phases: Option<Phases>,
    /// States of grains that count, where the frames are of grains (`"channel": "/grains"`); absent: all grains.
    #[serde(default)]
    #[schemars(length(min = 1))]
    pub states: Option<Vec<GrainState>>,
    /// Leaves out liquid in flight; absent: everything counts. Not for grains.
    #[serde(default)]
    pub landed: Option<Landed>,
    /// Spacing of the grid \[m\]; absent: one particle diameter, as the frames' `/plate` says.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m"))]
    pub spacing_m: Option<f64>,
    /// Smoothing length h of the kernel mean \[m\], its support is 2h; absent: the spacing.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m"))]
    pub smoothing_length_m: Option<f64>,
    /// The sections, each a channel of the output; none where a heat map alone is wanted.
    #[serde(default)]
    pub sections: Vec<Cutting>,
    /// The surface over the distance from the source, for an arc above it: the channel `/profile`; absent: none.
    #[serde(default)]
    pub profile: Option<Round>,
    /// Maps of the heat flux into metal, interval by interval, of frames that tell what each particle has got (`heat_received` of
    /// the output of `poolsph`); absent: none.
    #[serde(default)]
    pub heat_map: Option<HeatMap>,
}

fn pool() -> String {
    "/pool".to_owned()
}

/// What a grain is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum GrainState {
    /// Has not melted yet.
    Powder,
    /// Is molten.
    Slag,
    /// Has set again.
    Frozen,
}

/// A span of simulated time.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Span {
    /// First moment \[s\].
    #[schemars(range(min = 0.0), extend("x-unit" = "s"))]
    pub from_s: f64,
    /// Last moment \[s\]; absent: to the end.
    #[serde(default)]
    #[schemars(range(min = 0.0), extend("x-unit" = "s"))]
    pub to_s: Option<f64>,
}

/// What the grid moves with.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Follow {
    /// Channel that tells place, phase and droplet of the source; `/source` when absent.
    #[serde(default = "source")]
    pub channel: String,
}

fn source() -> String {
    "/source".to_owned()
}

/// Phases of the droplet period.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Phases {
    /// Number of phases; phase k stands at the fraction k / count of the period.
    #[schemars(range(min = 1, max = 1000))]
    pub count: u32,
    /// Fraction of the frames' own period that becomes phase 0, for example the one just before a
    /// droplet touches the pool.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub origin: f64,
}

/// What has landed: liquid joined to solid metal by a chain of particles.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Landed {
    /// Greatest distance between neighbours in the chain \[m\]; 1.5 particle diameters is good.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m"))]
    pub link_m: f64,
}

/// The height of the surface, averaged over the angle around the source and over all frames, in rings as wide as
/// the spacing. Liquid in flight is surface too, unless the scene has `landed`.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Round {
    /// Radius of the outermost ring \[m\]; metal should reach as far on all sides.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m"))]
    pub radius_m: f64,
}

/// Cells seen from above, on which heat fluxes are told: the channel `/heat_map`, and `/heat_map/time_mean` over all frames.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeatMap {
    /// Extent across the weld \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub x_m: [f64; 2],
    /// Extent along the weld \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub y_m: [f64; 2],
    /// Side of a cell \[m\]; absent: the spacing of the averages.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m"))]
    pub cell_m: Option<f64>,
    /// A map for each interval of so long \[s\]; absent: one from each frame to the next.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s"))]
    pub interval_s: Option<f64>,
    /// Places whose fluxes are told interval by interval, each in the channel `/heat_map/NAME`.
    #[serde(default)]
    pub places: Vec<HeatPlace>,
}

/// A place of a heat map.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeatPlace {
    /// Name; becomes the end of the channel.
    #[schemars(regex(pattern = "^[a-z][a-z0-9_]*$"))]
    pub name: String,
    /// Across the weld \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub x_m: f64,
    /// Along the weld \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub y_m: f64,
}

impl HeatMap {
    /// Its cells, as wide as `spacing` \[m\] where it does not say so.
    #[must_use]
    pub fn layout(&self, spacing: f64) -> Layout {
        let side = self.cell_m.unwrap_or(spacing);
        let interval = self.interval_s.unwrap_or(0.0);
        let mut layout = Layout::new([self.x_m, self.y_m], side, interval);
        let places = self.places.iter();
        layout.places = places.map(|p| (p.name.clone(), [p.x_m, p.y_m])).collect();
        layout
    }

    /// What the schema cannot say: JSON pointer and fault.
    fn faults(&self) -> Vec<(String, String)> {
        let mut found = Vec::new();
        for (key, range) in [("x_m", self.x_m), ("y_m", self.y_m)] {
            if range[1] <= range[0] {
                let what = format!("[{}, {}] m does not ascend", range[0], range[1]);
                found.push((format!("/heat_map/{key}"), what));
            }
        }
        for (i, place) in self.places.iter().enumerate() {
            let at = format!("/heat_map/places/{i}");
            for (key, value, range) in [("x_m", place.x_m, self.x_m), ("y_m", place.y_m, self.y_m)]
            {
                if value < range[0] || value > range[1] {
                    let what = format!(
                        "{value} m lies beyond the map, {} to {} m",
                        range[0], range[1]
                    );
                    found.push((format!("{at}/{key}"), what));
                }
            }
            let name = &place.name;
            if name == "time_mean" || self.places[..i].iter().any(|other| other.name == *name) {
                found.push((
                    format!("{at}/name"),
                    format!("'{name}' is the name of another channel"),
                ));
            }
        }
        found
    }
}

/// A section: a name, how it is cut, and its extent.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cutting {
    /// Name; becomes the channel.
    #[schemars(regex(pattern = "^[a-z][a-z0-9_]*$"))]
    pub name: String,
    /// How it is cut.
    pub cut: CutScene,
    /// Extent of the first axis \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub first_m: [f64; 2],
    /// Extent of the second axis \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub second_m: [f64; 2],
}

/// How a section is cut.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum CutScene {
    /// A plane normal to an axis; its own axes are the other two, in the order x, y, z.
    Plane {
        /// Axis of the normal.
        normal: Axis,
        /// Where the plane stands \[m\].
        #[serde(default)]
        #[schemars(extend("x-unit" = "m"))]
        at_m: f64,
        /// Particles at most this far from the plane count \[m\].
        #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m"))]
        half_thickness_m: f64,
    },
    /// The topmost metal as seen from above; its axes are x and y.
    Surface {
        /// Particles at most this far below the top of their column count \[m\].
        #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m"))]
        layer_m: f64,
    },
}

/// An axis.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// Across the weld.
    X,
    /// Along the weld.
    Y,
    /// Upwards.
    Z,
}

impl Scene {
    /// The sections on a grid of `spacing` \[m\].
    #[must_use]
    pub fn sections(&self, spacing: f64) -> Vec<Section> {
        self.sections
            .iter()
            .map(|s| Section::new(&s.name, s.cut.into(), [s.first_m, s.second_m], spacing))
            .collect()
    }

    /// What the schema cannot say: JSON pointer and fault, in the order of the keys.
    #[must_use]
    pub fn faults(&self) -> Vec<(String, String)> {
        let mut found = Vec::new();
        if let Some(Span {
            from_s,
            to_s: Some(to_s),
        }) = self.time
            && to_s <= from_s
        {
            let what = format!("{to_s} s is not after from_s = {from_s} s");
            found.push(("/time/to_s".to_owned(), what));
        }
        if self.phases.is_some() && self.follow.is_none() {
            let what = "phases are told by the channel of the source: they need 'follow'";
            found.push(("/phases".to_owned(), what.to_owned()));
        }
        if self.sections.is_empty() && self.profile.is_none() && self.heat_map.is_none() {
            let what = "nothing is averaged: name sections, a profile or a heat map";
            found.push(("/sections".to_owned(), what.to_owned()));
        }
        found.extend(self.heat_map.iter().flat_map(HeatMap::faults));
        for (i, section) in self.sections.iter().enumerate() {
            for (key, range) in [("first_m", section.first_m), ("second_m", section.second_m)] {
                if range[1] <= range[0] {
                    let what = format!("[{}, {}] m does not ascend", range[0], range[1]);
                    found.push((format!("/sections/{i}/{key}"), what));
                }
            }
            if self.profile.is_some() && section.name == PROFILE {
                let what = "is the name of the channel that the key 'profile' asks for";
                found.push((format!("/sections/{i}/name"), what.to_owned()));
            }
            if self.heat_map.is_some() && section.name == HEAT_MAP {
                let what = "is the name of the channel of the heat map";
                found.push((format!("/sections/{i}/name"), what.to_owned()));
            }
            if self.sections[..i].iter().any(|s| s.name == section.name) {
                let what = format!("'{}' is the name of two sections", section.name);
                found.push((format!("/sections/{i}/name"), what));
            }
        }
        found
    }
}

impl From<CutScene> for Cut {
    fn from(cut: CutScene) -> Self {
        match cut {
            CutScene::Plane {
                normal,
                at_m,
                half_thickness_m,
            } => Self::Plane {
                axis: normal as usize,
                at: at_m,
                half_thickness: half_thickness_m,
            },
            CutScene::Surface { layer_m } => Self::Surface { layer: layer_m },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(text: &str) -> Result<Scene, serde_json::Error> {
        serde_json::from_str(text)
    }

    const SMALL: &str = r#"{"sections": [{"name": "x0", "first_m": [-1, 1], "second_m": [0, 1],
        "cut": {"plane": {"normal": "x", "half_thickness_m": 0.5}}}]}"#;

    #[test]
    fn absent_keys_are_absent_physics() {
        let s = scene(SMALL).unwrap();
        assert!(s.follow.is_none() && s.phases.is_none() && s.landed.is_none());
        assert!(s.profile.is_none());
        assert_eq!(s.channel, "/pool");
        assert!(s.faults().is_empty());
        assert_eq!(s.sections(0.5)[0].axes, [1, 2]);
    }

    #[test]
    fn what_cannot_be_is_named_with_its_place() {
        let text = SMALL.replacen(
            '{',
            r#"{"phases": {"count": 8}, "time": {"from_s": 2, "to_s": 1},"#,
            1,
        );
        let paths: Vec<String> = scene(&text)
            .unwrap()
            .faults()
            .into_iter()
            .map(|f| f.0)
            .collect();
        assert_eq!(paths, ["/time/to_s", "/phases"]);
        let named = SMALL.replace("x0", "profile");
        assert!(scene(&named).unwrap().faults().is_empty());
        let both = named.replacen('{', r#"{"profile": {"radius_m": 1},"#, 1);
        let faults = scene(&both).unwrap().faults();
        assert_eq!(faults[0].0, "/sections/0/name");
    }

    #[test]
    fn unknown_keys_are_refused() {
        assert!(scene(&SMALL.replace("normal", "normale")).is_err());
        assert!(scene(&SMALL.replacen('{', r#"{"phase": 8,"#, 1)).is_err());
    }
}
