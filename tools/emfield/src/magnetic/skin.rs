//! Whether points resolve the skin of conductors: across their surfaces, and along them.
//!
//! A field falls in a conductor as `exp(-(1 + j) d / delta)`. Polynomials over a support follow that while the support is hardly
//! deeper than delta; what conductors carry in a plane is fitted by such waves themselves, and only where the surface leaves
//! its tangent plane within the support by a part of delta are these wrong.

use run::Session;

use super::problem::Problem;
use crate::cloud::{Class, Metric};

/// Radius of supports of orders up to 2, and of higher ones, over the spacing.
const SUPPORT: [f64; 2] = [2.5, 3.5];
/// Depth of a support over the skin depth up to which polynomials follow the field: heat errs by 5 % there.
const DEEP: f64 = 1.75;
/// Way of the surface from its tangent plane within a support, over the skin depth, up to which plane waves follow the field.
const BOWED: f64 = 0.5;

/// How wide points at the surface of a conductor are, at most.
#[derive(Clone, Copy, Default)]
struct Widest {
    /// Spacing across the surface \[m\].
    across: f64,
    /// How far the surface leaves its tangent plane within a support, where offsets do not follow it \[m\].
    bow: f64,
    /// Spacing along the surface there \[m\].
    along: f64,
}

impl<const D: usize> Problem<'_, D> {
    /// Says where points do not resolve the skin of a conductor.
    pub(crate) fn warn(&self, session: &mut Session) {
        let lasts = self.parameters.omega.map_or(f64::INFINITY, f64::recip);
        self.warn_over(lasts, session);
    }

    /// The same in fields that change in a time of `lasts` \[s\]: 1/omega of a sine.
    pub(crate) fn warn_over(&self, lasts: f64, session: &mut Session) {
        self.warn_walls(session);
        if lasts.is_infinite() {
            return;
        }
        for (m, mu_sigma) in self.conductors.mu_sigma.iter().enumerate() {
            if *mu_sigma > 0.0 {
                let skin = (2.0 * lasts / mu_sigma).sqrt();
                let name = &self.cloud.media[m];
                if let Some(what) = self.unresolved(m as u16, skin) {
                    session.warn(format!(
                        "unresolved: skin depth {skin:.3e} m in {name}, {what}"
                    ));
                }
            }
        }
    }

    /// Radius of supports over the spacing.
    fn support(&self) -> f64 {
        let usual = SUPPORT[usize::from(self.parameters.numerics.form.order > 2)];
        self.parameters.numerics.form.support.unwrap_or(usual)
    }

    /// What of a conductor's surface does not resolve its skin.
    fn unresolved(&self, medium: u16, skin: f64) -> Option<String> {
        let support = self.support();
        let Widest { across, bow, along } = self.widest(medium, support);
        if across > skin {
            return Some(format!("spacing {across:.3e} m across its surface"));
        }
        if self.waves.is_none() {
            let deep = support * across;
            return (deep > DEEP * skin).then(|| {
                format!("spacing {across:.3e} m across its surface: stencils reach {deep:.3e} m, {:.2} skin depths, of which polynomials follow {DEEP}; thinner first layers help", deep / skin)
            });
        }
        (bow > BOWED * skin).then(|| {
            format!("spacing {along:.3e} m along its surface: within a stencil it leaves its tangent plane by {bow:.3e} m, {:.2} skin depths, and waves that are plane follow {BOWED}; smaller spacings along it help, thinner layers alone do not", bow / skin)
        })
    }

    fn widest(&self, medium: u16, support: f64) -> Widest {
        let mut widest = Widest::default();
        for i in 0..self.cloud.len() {
            let inside = matches!(self.cloud.class[i], Class::Inside(_));
            if inside || !self.cloud.touches(i, medium) {
                continue;
            }
            match self.cloud.metric[i] {
                Metric::Round => widest.across = widest.across.max(self.cloud.spacing[i]),
                Metric::Layered {
                    across,
                    along,
                    foot,
                    ..
                } => {
                    widest.across = widest.across.max(across);
                    let foot = &self.cloud.feet[foot as usize];
                    let bow = foot.curvature.bow(support * along);
                    if !foot.thin && bow > widest.bow {
                        (widest.bow, widest.along) = (bow, along);
                    }
                }
            }
        }
        widest
    }

    /// Says where a conductor touches a wall that stands for the space beyond it.
    fn warn_walls(&self, session: &mut Session) {
        if !self.parameters.open {
            return;
        }
        let conducts = |m: u16| self.conductors.mu_sigma[m as usize] > 0.0;
        for (class, [x, y, z]) in self.cloud.class.iter().zip(&self.cloud.position) {
            if let Class::Outer { medium, face } = class
                && conducts(*medium)
            {
                let wall = self.cloud.faces[*face as usize];
                let name = &self.cloud.media[*medium as usize];
                session.warn(format!(
                    "{name} touches the wall {wall} at ({x:.3e}, {y:.3e}, {z:.3e}) m: no current passes there, and the multipoles of \"outer\" hold only where currents are farther away; leave room, or take \"zero\" where the wall screens"
                ));
                return;
            }
        }
    }
}
