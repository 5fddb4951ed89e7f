//! Heat that each particle of metal has got since the start, way by way (key `heat_received` of the output).
//!
//! ```text
//! q = sum over the particles of a patch of (Q_a(t_2) - Q_a(t_1)) / (A (t_2 - t_1))           (as in Komen 2019, fig. 5.28)
//! ```
//!
//! is the mean flux \[W/m2\] through a patch of the area A between two frames, exact in time however far apart they are. The
//! sums of a column over all particles are those of the energy balance.

use particles::Column;

/// From arcs \[J\].
pub const FROM_ARC: Column<f64> = way("heat_from_arc");
/// From torches \[J\].
pub const FROM_TORCHES: Column<f64> = way("heat_from_torches");
/// From grains that have never melted \[J\].
pub const FROM_POWDER: Column<f64> = way("heat_from_powder");
/// From grains that are molten or have set again \[J\].
pub const FROM_SLAG: Column<f64> = way("heat_from_slag");
/// Given off by radiation, to gas and with vapour \[J\].
pub const LOST: Column<f64> = way("heat_lost");

const fn way(name: &'static str) -> Column<f64> {
    Column::new(name, "J", 0.0).saved().shown()
}

/// Adds `heat` \[J\] to what particle `a` has got by one way; nothing happens where its column is absent.
#[inline]
pub(crate) fn add(way: &mut [f64], a: usize, heat: f64) {
    if let Some(sum) = way.get_mut(a) {
        *sum += heat;
    }
}
