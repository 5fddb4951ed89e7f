//! What is given of an electric field about a liquid: the field far away, and what the liquid is.

use crate::electric::equations::{Held, Problem};
use crate::liquid::air::{ASLEEP, Air};
use crate::liquid::vector::{difference, dot};
use crate::stencils::region::{Kind, Region};

/// What acts on the liquid, and what it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Applied {
    /// Field far away \[V/m\].
    pub field: [f64; 3],
    /// Permittivity over that of the air; none of a conductor.
    pub permittivity: Option<f64>,
    /// Conductivity over that of the air, where charges gather on the surface at once; none where nothing leaks.
    pub leak: Option<f64>,
    /// Charge of a conductor \[C\].
    pub charge: f64,
}

impl Applied {
    /// Whether the liquid is a conductor.
    #[must_use]
    pub fn conducts(&self) -> bool {
        self.permittivity.is_none()
    }

    fn at(&self, x: &[f64; 3], air: &Air) -> f64 {
        -dot(&self.field, &difference(x, &air.centre))
    }

    /// The potential without a liquid, by point \[V\].
    pub(super) fn potential(&self, region: &Region<3>, air: &Air) -> Vec<f64> {
        region.places.iter().map(|x| self.at(x, air)).collect()
    }

    /// `div(eps grad V) = 0`, or `div(sigma grad V) = 0` where charges leak, with that potential on the wall far away, and none on a conductor and on points that sleep.
    pub(super) fn problem(&self, region: &Region<3>, air: &Air) -> Problem {
        let held = |(kind, x): (&Kind, &[f64; 3])| match kind {
            Kind::Wall { wall: 0, .. } => Some(Held::Potential(self.at(x, air))),
            Kind::Wall { .. } => Some(Held::Potential(0.0)),
            _ => None,
        };
        let liquid = self.leak.or(self.permittivity).unwrap_or(1.0);
        let mut permittivity = vec![1.0, liquid, 1.0];
        let mut electrodes = vec![None; usize::from(ASLEEP)];
        electrodes.push(Some(0.0));
        // Other drops.
        if let Some(last) = region.faces.iter().map(|face| face.inner).max() {
            let media = permittivity.len().max(usize::from(last) + 1);
            permittivity.resize(media, liquid);
            electrodes.resize(media, None);
        }
        Problem {
            permittivity,
            electrodes,
            held: region.kinds.iter().zip(&region.places).map(held).collect(),
        }
    }
}
