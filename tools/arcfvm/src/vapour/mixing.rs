//! Heat that goes with the mixing of gas and iron vapour.
//!
//! Iron that diffuses one way and gas that diffuses the other carry different enthalpies. Between cells P and
//! E the difference of enthalpy is split at the mean mass fraction `Y_f`,
//!
//! ```text
//! h_P - h_E = [h(T_P, Y_f) - h(T_E, Y_f)] + rest,
//! ```
//!
//! the first part going with the conduction of heat and the rest with the diffusion of iron, each with the
//! hybrid coefficient of its own equation: the flux is `F h_P + A_T (first) + A_Y (rest)`. Where all
//! is equally warm and h linear in Y, the equation of the energy is then that of the iron: mixing warms
//! and cools nothing. Komen (2019), eq. 5.8, leaves out this part, which heats or cools gas wherever iron
//! diffuses against the flow.

use crate::case::{Case, HeatEdge, VapourEdge};
use crate::equation::faces::{Beyond, FaceOf};
use crate::grid::FaceIndex;
use crate::heat::reads::{Around, Vapours};
use crate::material::{Enthalpy, GAS};

/// Difference of temperature below which the slope tells the specific heat \[K\].
const NEAR_K: f64 = 1e-3;

/// What a face needs beside the conductance of heat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mix {
    /// Specific heat at the mean mass fraction \[J/(kg K)\].
    pub(crate) capacity: f64,
    /// Enthalpy of the own side less that of the other at the same temperature \[J/kg\].
    pub(crate) shift: f64,
    /// Diffusive conductance of iron \[kg/s\].
    pub(crate) diffusion: f64,
}

impl Default for Mix {
    fn default() -> Self {
        Self {
            capacity: 1.0,
            shift: 0.0,
            diffusion: 0.0,
        }
    }
}

/// The mixing at every face, seen from the side of smaller radius or height.
#[derive(Debug, Clone)]
pub(crate) struct Mixing {
    radial: Vec<Mix>,
    axial: Vec<Mix>,
}

/// What the mixing reads.
#[derive(Clone, Copy)]
struct Reads<'a> {
    around: Around<'a>,
    of: Vapours<'a>,
    temperature: &'a [f64],
}

impl Mixing {
    pub(crate) fn new(case: &Case) -> Self {
        Self {
            radial: vec![Mix::default(); case.grid.radial_faces()],
            axial: vec![Mix::default(); case.grid.axial_faces()],
        }
    }

    /// Takes every face at these temperatures and the present fractions.
    pub(crate) fn update(&mut self, around: Around<'_>, of: Vapours<'_>, temperature: &[f64]) {
        let grid = &around.case.grid;
        let reads = Reads {
            around,
            of,
            temperature,
        };
        for j in 0..grid.nz {
            for i in 0..grid.nr {
                let [east, west, north, south] = of.vapour.faces(around.case, None, i, j);
                // Every face once: that to the east and north, and those of edges to the west and south.
                self.radial[grid.radial_face(i + 1, j)] = reads.mix(&east);
                self.axial[grid.axial_face(i, j + 1)] = reads.mix(&north);
                if i == 0 {
                    self.radial[grid.radial_face(0, j)] = reads.mix(&west).turned();
                }
                if j == 0 {
                    self.axial[grid.axial_face(i, 0)] = reads.mix(&south).turned();
                }
            }
        }
    }

    /// A face as its cell sees it.
    #[inline]
    pub(crate) fn at(&self, face: &FaceOf) -> Mix {
        let mix = match face.at {
            FaceIndex::Radial(n) => self.radial[n],
            FaceIndex::Axial(n) => self.axial[n],
        };
        if face.before { mix.turned() } else { mix }
    }
}

impl Mix {
    fn turned(self) -> Self {
        Self {
            shift: -self.shift,
            ..self
        }
    }
}

impl Reads<'_> {
    /// The mixing at a face, from its cell.
    fn mix(&self, face: &FaceOf) -> Mix {
        let (case, iron, t) = (self.around.case, &self.of.vapour.iron, self.temperature);
        let Some(law) = &case.of(face.own).enthalpy else {
            return Mix::default();
        };
        let here = (t[face.own], iron[face.own]);
        match face.beyond {
            Beyond::Cell(n) if case.material[n] == case.material[face.own] => {
                let diffusion = if case.material[n] == GAS {
                    face.conductance
                } else {
                    0.0
                };
                split(law, here, (t[n], iron[n]), diffusion)
            }
            Beyond::Cell(_) => Mix::default(),
            Beyond::Edge(edge) => {
                let there = match *self.around.heat.edges.at(edge) {
                    HeatEdge::Temperature(t) => t,
                    _ => here.0,
                };
                match *self.of.setup.edges.at(edge) {
                    VapourEdge::Fraction(y) if case.material[face.own] == GAS => {
                        split(law, here, (there, y), face.conductance)
                    }
                    _ => split(law, here, (there, here.1), 0.0),
                }
            }
        }
    }
}

/// Splits the difference of enthalpy between two states of temperature and mass fraction.
fn split(law: &Enthalpy, here: (f64, f64), there: (f64, f64), diffusion: f64) -> Mix {
    let mean = 0.5 * (here.1 + there.1);
    let by_heat = law.within(here.0, mean) - law.within(there.0, mean);
    let whole = law.within(here.0, here.1) - law.within(there.0, there.1);
    let warmer = here.0 - there.0;
    Mix {
        capacity: if warmer.abs() > NEAR_K {
            by_heat / warmer
        } else {
            law.slope_within(here.0, mean)
        },
        shift: whole - by_heat,
        diffusion,
    }
}
