//! The wire that is fed down, and what its drops take along.

use super::Faults;
use super::layout::Layout;
use crate::case::{FeedRule, Wire};
use crate::material::{Enthalpy, Material};
use crate::scene::{Body, Feed};

/// The one body that is fed, if any is.
pub(super) fn wire(
    layout: &Layout,
    (bodies, materials): (&[(&String, &Body)], &[Material]),
    faults: &mut Faults,
) -> Option<Wire> {
    let mut found = None;
    for (n, (name, body)) in bodies.iter().enumerate() {
        let at = format!("/bodies/{name}/feed");
        let Some(feed) = body.feed.as_ref() else {
            continue;
        };
        let rule = match (feed.speed_m_s, feed.drop_temperature_k) {
            (Some(speed), None) => FeedRule::Speed(speed),
            (None, Some(t)) => FeedRule::Melting(t),
            _ => {
                faults.add(&at, "wants exactly one of speed_m_s and drop_temperature_k");
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
        let enthalpy = materials[n + 1].enthalpy.as_ref();
        let drop_share = drop_share(feed, enthalpy).unwrap_or_else(|what| {
            faults.add(&format!("{at}/drop_enthalpy_j_kg"), what);
            1.0
        });
        found = Some(Wire {
            material: n + 1,
            columns: grid.rf.partition_point(|r| *r < ring.r_m[1] - 1e-12),
            tip: grid.zf.partition_point(|z| *z < ring.z_m[0] - 1e-12),
            section: std::f64::consts::PI * ring.r_m[1] * ring.r_m[1],
            density,
            drop_share,
            feed: Some(rule),
        });
    }
    found
}

/// Part of the enthalpy of the tip that drops take along.
fn drop_share(feed: &Feed, enthalpy: Option<&Enthalpy>) -> Result<f64, String> {
    let Some(own) = feed.drop_enthalpy_j_kg else {
        return Ok(1.0);
    };
    let Some(tip) = feed.drop_temperature_k else {
        return Err("wants drop_temperature_k, the temperature of the tip".to_owned());
    };
    let Some(enthalpy) = enthalpy else {
        return Err("means nothing without heat".to_owned());
    };
    let most = enthalpy.at(tip);
    if own > most {
        return Err(format!(
            "{own} J/kg is out of range: at most {most:.4e} J/kg, the enthalpy at {tip} K"
        ));
    }
    Ok(own / most)
}
