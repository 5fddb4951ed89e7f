//! Temperatures at the start.

use super::layout::Layout;
use super::{Faults, PLACE, value};
use crate::case::Wire;
use crate::material::REFERENCE_K;
use crate::scene::Scene;

/// How far a hot channel reaches up the wire, in its radius: an arc spreads over the wire's side.
const CLIMB: f64 = 0.5;
/// Temperature of every cell at the start \[K\].
pub(super) fn start(
    scene: &Scene,
    layout: &Layout,
    wire: Option<&Wire>,
    faults: &mut Faults,
) -> Vec<f64> {
    let grid = &layout.grid;
    let mut all = vec![REFERENCE_K; grid.len()];
    let at = "/start/temperature_k";
    let Some(curve) = faults.keep(scene.start.temperature_k.compile(at, &PLACE)) else {
        return all;
    };
    let climb = scene
        .start
        .channel
        .as_ref()
        .map_or(0.0, |c| CLIMB * c.radius_m);
    let top = wire.map_or(grid.nz, |w| grid.row_of(grid.zf[w.tip] + climb));
    for j in 0..grid.nz {
        for i in 0..grid.nr {
            let k = grid.cell(i, j);
            match value(&curve, grid.rc[i], grid.zc[j], REFERENCE_K) {
                Ok(t) if t > 0.0 => all[k] = t,
                Ok(t) => {
                    faults.add(at, format!("{t} K is not above 0 K at {}", layout.place(k)));
                    return all;
                }
                Err(what) => {
                    faults.add(at, what);
                    return all;
                }
            }
            let Some(channel) = scene.start.channel.as_ref().filter(|_| layout.is_gas(k)) else {
                continue;
            };
            if grid.rc[i] < channel.radius_m && j < top {
                all[k] = channel.temperature_k;
            }
        }
    }
    all
}
