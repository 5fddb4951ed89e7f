//! Thin layers of gas on electrodes that the cells do not hold: the sheath, the film, and the heights of samples.

use crate::current::sheath::Held;
use crate::grid::FaceIndex;
use crate::sample::Sample;
use crate::solver::Arc;
use crate::surface;

/// Part of the current, or of the surface, that may be without its layer.
const FEW: f64 = 0.1;

impl Arc {
    /// What is to be told of layers that are not there.
    #[must_use]
    pub fn unheld(&self, sample: &Sample) -> Vec<String> {
        let mut told = self.sheathless();
        told.extend(self.filmless());
        told.extend(surface::unreached(self, sample));
        told
    }

    /// Current that crosses into electrodes where there is no sheath.
    fn sheathless(&self) -> Vec<String> {
        let sheath = self.case.potential.as_ref();
        let sheath = sheath.and_then(|potential| potential.sheath.as_ref());
        let (Some(sheath), Some(electric)) = (sheath, &self.electric) else {
            return Vec::new();
        };
        let current = |face: &FaceIndex| match face {
            FaceIndex::Radial(at) => electric.potential.radial[*at].abs(),
            FaceIndex::Axial(at) => electric.potential.axial[*at].abs(),
        };
        let through = |which: Option<Held>| -> f64 {
            let faces = sheath.faces.iter();
            let faces = faces.filter(|(_, held)| which.is_none_or(|which| *held == which));
            faces.map(|(face, _)| current(face)).sum()
        };
        let depth = sheath.depth();
        let tell = |which: Held, what: &str, advice: &str| {
            let part = through(Some(which)) / through(None);
            (part > FEW).then(|| {
                format!(
                    "the sheath of {depth:.2e} m is {what} where {:.0} % of the current crosses into electrodes, and there is none: {advice}",
                    100.0 * part
                )
            })
        };
        let finer = format!(
            "take cells of at most {:.2e} m there, or leave 'sheath_m' out",
            2.0 * depth
        );
        let told = [
            tell(
                Held::Thin,
                "thinner than half of the cell beside the metal",
                &finer,
            ),
            tell(
                Held::Thick,
                "as thick as the gas",
                "take a 'sheath_m' that leaves gas beyond it",
            ),
        ];
        told.into_iter().flatten().collect()
    }

    /// Surface of electrodes that has less gas than its film is thick.
    fn filmless(&self) -> Option<String> {
        let surfaces = self.case.surfaces.as_ref()?;
        let depth = surfaces.film_depth?;
        let area = |lacks: bool| -> f64 {
            let each = surfaces.contacts.iter().zip(&surfaces.layers);
            let each = each.filter(|(_, layer)| !lacks || layer.is_cut());
            each.map(|(contact, _)| contact.area).sum()
        };
        let part = area(true) / area(false);
        (part > FEW).then(|| {
            format!(
                "the film of {depth:.2e} m is thicker than the gas on {:.0} % of the surface of electrodes, and ends where \
                 the gas does: take a smaller 'film_m'",
                100.0 * part
            )
        })
    }
}
