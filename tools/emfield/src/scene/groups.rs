//! Drops that meet and part.

use schemars::JsonSchema;
use serde::Deserialize;
use shapes::check::Misfit;

use super::Liquid;

/// Groups of points (Matsuzawa 2017, chapter 2.2.5): drops that meet become one, and one that becomes too thin parts. What is apart in
/// `shape` are drops of their own from the start. Nothing between the drops delays that they meet. In an electric field each conductor
/// keeps its charge, joined or parted, and has a potential of its own.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Groups {
    /// Distance of two surfaces that approach each other, over the spacing, at which they become one.
    #[serde(default = "join")]
    #[schemars(range(min = 0.1, max = 0.9), extend("x-unit" = "1"))]
    pub join_within: f64,
    /// Depth beneath the surface, over the spacing, at which a drop holds together. A neck parts that is nowhere so deep, and thin edges become parcels without a shape.
    #[serde(default = "part")]
    #[schemars(range(min = 0.6, max = 1.5), extend("x-unit" = "1"))]
    pub part_below: f64,
}

fn join() -> f64 {
    0.5
}

fn part() -> f64 {
    1.2
}

impl Groups {
    pub(super) fn check(liquid: &Liquid, misfits: &mut Vec<Misfit>) {
        for (given, key) in [
            (liquid.faces.is_some(), "faces"),
            (liquid.magnetic.is_some(), "magnetic"),
            (liquid.heat.is_some(), "heat"),
            (liquid.equilibrium.is_some(), "equilibrium"),
        ] {
            if given {
                let what = format!(
                    "drops meet and part in the open, in an electric field at most: leave \"{key}\" or \"groups\" away"
                );
                misfits.push(Misfit::at("/liquid/groups", what));
            }
        }
    }
}
