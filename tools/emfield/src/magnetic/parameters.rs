//! What is sought and given of eddy currents, whoever says it.

use num_complex::Complex;

use super::driven::winding::Winding;
use super::medium::law::Law;
use super::source::Source;
use super::unknown::Unknown;
use crate::solve::Numerics;

/// What is sought and given. Lists by medium begin with the surroundings.
#[derive(Debug, Clone)]
pub(crate) struct Parameters {
    pub(crate) unknown: Unknown,
    /// Angular frequency \[rad/s\]; none in a march in time.
    pub(crate) omega: Option<f64>,
    /// Whether fields stand still, so that nothing has a rate.
    pub(crate) still: bool,
    /// Whether walls stand for the space beyond them.
    pub(crate) open: bool,
    /// Whether charges on conductors are sought.
    pub(crate) charged: bool,
    /// Conductivity by medium \[S/m\].
    pub(crate) conductivity: Vec<f64>,
    /// How the field follows the flux density, by medium.
    pub(crate) laws: Vec<Law>,
    /// Permeability of the surroundings \[V s/(A m)\].
    pub(crate) around: f64,
    /// Whether a medium has another permeability than the surroundings.
    pub(crate) magnetic: Vec<bool>,
    /// What coils and applied fields give.
    pub(crate) source: Source,
    /// Coils that are regions of points.
    pub(crate) coils: Vec<Winding>,
    /// Media of bars with their net current \[A\].
    pub(crate) bars: Vec<(u16, Complex<f64>)>,
    /// Media through which a wire runs.
    pub(crate) run: Vec<u16>,
    pub(crate) numerics: Numerics,
}
