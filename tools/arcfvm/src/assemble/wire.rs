//! The wire that is fed down, and what its drops take along.

use super::Faults;
use super::layout::Layout;
use super::vapour::evaporation;
use crate::case::{Drops, FeedRule, Wire};
use crate::material::{Enthalpy, Material};
use crate::scene::{Body, Feed};

/// The one body that is fed, if any is.
pub(super) fn wire(
    layout: &Layout,
    bodies: &[(&String, &Body)],
    materials: &[Material],
    faults: &mut Faults,
) -> Option<Wire> {
    let mut found = None;
    for (n, (name, body)) in bodies.iter().enumerate() {
        let at = format!("/bodies/{name}/feed");
        let Some(feed) = body.feed.as_ref() else {
            continue;
        };
        let enthalpy = materials[n + 1].enthalpy.as_ref();
        let rule = match rule(feed, body, enthalpy) {
            Ok(rule) => rule,
            Err((key, what)) => {
                faults.add(&format!("{at}{key}"), what);
                continue;
            }
        };
        let [ring] = body.shape.rings() else {
            faults.add(&at, "a fed wire is a single ring");
            continue;
        };
        let grid = &layout.grid;
        let top = grid.zf[grid.nz];
        if ring.r_m[0] > 0.0 || (ring.z_m[1] - top).abs() > 1e-9 {
            faults.add(
                &at,
                format!("a fed wire reaches from the axis to the top at {top} m"),
            );
            continue;
        }
        let Some(density) = body.material.density_kg_m3 else {
            faults.add(&at, "a fed wire wants material/density_kg_m3");
            continue;
        };
        if found.is_some() {
            faults.add(&at, "a second fed body; only one can be fed");
        }
        let drops = drops(feed, rule, enthalpy).unwrap_or_else(|what| {
            faults.add(&format!("{at}/drop_enthalpy_j_kg"), what);
            Drops::Part(1.0)
        });
        found = Some(Wire {
            material: n + 1,
            columns: grid.rf.partition_point(|r| *r < ring.r_m[1] - 1e-12),
            tip: grid.zf.partition_point(|z| *z < ring.z_m[0] - 1e-12),
            section: std::f64::consts::PI * ring.r_m[1] * ring.r_m[1],
            density,
            drops,
            feed: Some(rule),
        });
    }
    found
}

/// What rules the feed; or the key that is wrong, and why.
fn rule(
    feed: &Feed,
    body: &Body,
    enthalpy: Option<&Enthalpy>,
) -> Result<FeedRule, (&'static str, String)> {
    match (feed.speed_m_s, feed.drop_temperature_k, feed.vapour_share) {
        (Some(speed), None, None) => Ok(FeedRule::Speed(speed)),
        (None, Some(t), None) => Ok(FeedRule::Melting(t)),
        (None, None, Some(share)) => {
            let wrong = |what: &str| ("/vapour_share", what.to_owned());
            let (_, metal) = evaporation(body).ok_or_else(|| {
                wrong("wants evaporation of the wire's anode, cathode or electrode")
            })?;
            let enthalpy = enthalpy.ok_or_else(|| wrong("means nothing without heat"))?;
            Ok(FeedRule::Boiling {
                share,
                latent_heat: metal.latent_heat_j_kg,
                at_most: enthalpy.at(metal.boiling_k),
            })
        }
        _ => {
            let what = "wants exactly one of speed_m_s, drop_temperature_k and vapour_share";
            Err(("", what.to_owned()))
        }
    }
}

/// What drops take along.
fn drops(feed: &Feed, rule: FeedRule, enthalpy: Option<&Enthalpy>) -> Result<Drops, String> {
    let Some(own) = feed.drop_enthalpy_j_kg else {
        return Ok(Drops::Part(1.0));
    };
    let Some(enthalpy) = enthalpy else {
        return Err("means nothing without heat".to_owned());
    };
    match rule {
        FeedRule::Speed(_) => {
            Err("wants drop_temperature_k, the temperature of the tip, or vapour_share".to_owned())
        }
        FeedRule::Melting(tip) => {
            let most = enthalpy.at(tip);
            within(own, most, &format!("{tip} K"))?;
            Ok(Drops::Part(own / most))
        }
        FeedRule::Boiling { at_most, .. } => {
            within(own, at_most, "the boiling point")?;
            Ok(Drops::Enthalpy(own))
        }
    }
}

/// Whether drops hold no more than metal does at that place.
fn within(own: f64, most: f64, place: &str) -> Result<(), String> {
    if own > most {
        return Err(format!(
            "{own} J/kg is out of range: at most {most:.4e} J/kg, the enthalpy at {place}"
        ));
    }
    Ok(())
}
