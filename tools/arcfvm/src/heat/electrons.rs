//! Enthalpy that electrons carry with the current (Hsu, Etemadi and Pfender 1983).
//!
//! ```text
//! div (rho u h) = div (kappa grad T) + (5/2)(k/e) j . grad T + ...
//! ```
//!
//! Electrons go against the current, each with 5/2 k T. What they carry through a face is a flux of
//! `F = -(5/2)(k/e) I` watts per kelvin, I being the current that potential and Joule heat have there,
//! and adds to that of the mass: one hybrid coefficient for both. They pass the surface of a body at its
//! temperature. Where they leave the gas faster than it conducts, the body takes up `F (T_gas - T_body)`.
//! Bodies hold no such enthalpy: what crosses their surfaces and the edges is an item of the balance.
//! Komen (2019), eqs 3.6 and 5.8, has no such term.

use crate::equation::faces::{Beyond, FaceOf};
use crate::grid::FaceIndex;
use crate::heat::reads::Around;
use crate::material::GAS;

/// Enthalpy of an electron over its charge and temperature, 5/2 k/e \[V/K\].
pub const ENTHALPY: f64 = 2.5 * 1.380_649e-23 / 1.602_176_634e-19;

/// What carries heat through faces beside mass and conduction.
pub(crate) trait Carried {
    /// Heat that leaves through a face by the kelvin \[W/K\].
    fn out(&self, face: &FaceOf) -> f64;

    /// The scheme's coefficient of a face, from its mass flux, its conductance and a specific heat that is worked
    /// out where mass flows alone \[W/K\].
    fn link(
        &self,
        face: &FaceOf,
        scheme: fn(f64, f64) -> f64,
        capacity: impl FnOnce() -> f64,
    ) -> f64;
}

/// Nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nothing;

impl Carried for Nothing {
    #[inline]
    fn out(&self, _: &FaceOf) -> f64 {
        0.0
    }

    #[inline]
    fn link(
        &self,
        face: &FaceOf,
        scheme: fn(f64, f64) -> f64,
        capacity: impl FnOnce() -> f64,
    ) -> f64 {
        if face.mass_out == 0.0 {
            return face.conductance;
        }
        let capacity = capacity();
        scheme(face.mass_out, face.conductance / capacity) * capacity
    }
}

/// Electrons of a current.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drift<'a> {
    /// Current through radial faces, outward \[A\].
    radial: &'a [f64],
    /// Current through axial faces, upward \[A\].
    axial: &'a [f64],
    /// Material of each cell.
    material: &'a [usize],
}

impl<'a> Drift<'a> {
    /// Those of the present current, where they carry heat.
    pub(crate) fn of(around: Around<'a>) -> Option<Self> {
        around.heat.electrons?;
        let potential = around.potential?;
        Some(Self {
            radial: &potential.radial,
            axial: &potential.axial,
            material: &around.case.material,
        })
    }

    /// Whether there is gas on this side of a face and a body on the other.
    pub(crate) fn at_body(&self, face: &FaceOf) -> bool {
        matches!(face.beyond, Beyond::Cell(n) if self.in_gas(face.own) && !self.in_gas(n))
    }

    /// Heat through a face, outward or upward \[W/K\].
    pub(crate) fn through(&self, face: FaceIndex) -> f64 {
        -ENTHALPY
            * match face {
                FaceIndex::Radial(at) => self.radial[at],
                FaceIndex::Axial(at) => self.axial[at],
            }
    }

    /// Whether a cell is gas.
    pub(crate) fn in_gas(&self, k: usize) -> bool {
        self.material[k] == GAS
    }
}

impl Carried for Drift<'_> {
    fn out(&self, face: &FaceOf) -> f64 {
        let outward = self.through(face.at);
        match (self.in_gas(face.own), face.before) {
            (false, _) => 0.0,
            (true, true) => -outward,
            (true, false) => outward,
        }
    }

    fn link(
        &self,
        face: &FaceOf,
        scheme: fn(f64, f64) -> f64,
        capacity: impl FnOnce() -> f64,
    ) -> f64 {
        let out = self.out(face);
        if out == 0.0 || self.at_body(face) {
            return Nothing.link(face, scheme, capacity) - out;
        }
        let mass = if face.mass_out == 0.0 {
            0.0
        } else {
            face.mass_out * capacity()
        };
        scheme(mass + out, face.conductance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equation::transport::hybrid;

    fn face(mass_out: f64, before: bool) -> FaceOf {
        FaceOf {
            own: usize::from(before),
            beyond: Beyond::Cell(usize::from(!before)),
            at: FaceIndex::Axial(0),
            before,
            mass_out: if before { -mass_out } else { mass_out },
            conductance: 0.3,
            area: 1.0,
        }
    }

    #[test]
    fn what_leaves_one_cell_enters_the_next() {
        let (capacity, [t, beyond]) = (2.0, [900.0, 400.0]);
        for (electrons, mass) in [(0.1, 0.0), (0.1, 0.07), (-2.0, 0.07), (5.0, -0.2)] {
            let both = Drift {
                radial: &[],
                axial: &[-electrons / ENTHALPY],
                material: &[GAS; 2],
            };
            let [a, b] = [false, true].map(|before| {
                let face = face(mass, before);
                (
                    both.link(&face, hybrid, || capacity),
                    mass * capacity + electrons,
                )
            });
            let out = a.1 * t + a.0 * (t - beyond);
            let into = b.1 * beyond - b.0 * (beyond - t);
            assert!((out - into).abs() < 1e-9, "{out} {into}");
        }
    }

    #[test]
    fn metal_takes_up_what_gas_gives_less_what_stays_with_electrons() {
        let drift = Drift {
            radial: &[],
            axial: &[-0.2 / ENTHALPY],
            material: &[GAS, 1],
        };
        let [gas, metal] =
            [false, true].map(|before| drift.link(&face(0.0, before), hybrid, || 1.0));
        assert!((gas - 0.1).abs() < 1e-15 && (metal - 0.3).abs() < 1e-15);
    }
}
