//! Net currents of bars in a scene.

use num_complex::Complex;
use run::{Failure, Fault};

use super::setting::Setting;
use crate::cloud::Cloud;
use crate::magnetic::driven::bar::Bar;
use crate::magnetic::unknown::Unknown;
use crate::output::Found;
use crate::scene::{EddyCurrents, Geometry, Scene};
use crate::stencils::region::Region;

type C = Complex<f64>;

/// What net currents a scene cannot have.
pub(super) fn faults((scene, currents): (&Scene, &EddyCurrents), unknown: Unknown) -> Vec<Fault> {
    let mut faults = Vec::new();
    let magnetic = (1..=scene.bodies.len()).any(|m| scene.magnetic(m));
    for (k, body) in scene.bodies.iter().enumerate() {
        if body.net_current_a.is_none() {
            if body.net_current_phase_deg.is_some() {
                let at = format!("/bodies/{k}/net_current_phase_deg");
                faults.push(Fault::at(
                    &at,
                    "is the lead of a \"net_current_a\", which is absent",
                ));
            }
            continue;
        }
        let why = if scene.geometry != Geometry::Plane || unknown != Unknown::Potential {
            "is that of a bar along z in a plane, with wires or a field across it"
        } else if currents.harmonic.is_none() {
            "is that of a sinusoidal steady state: take \"harmonic\"; a coil of points carries a current at any instant"
        } else if scene.carries(k + 1) {
            "the body is a coil, whose current is given there"
        } else if body.conductivity_s_m == 0.0 {
            "the body does not conduct: give it a \"conductivity_s_m\", or let a coil of points carry the current"
        } else if magnetic {
            "stands where all bodies have the permeability of the surroundings"
        } else {
            continue;
        };
        faults.push(Fault::at(&format!("/bodies/{k}/net_current_a"), why));
    }
    faults
}

/// The bars of a scene whose net current is given.
///
/// # Errors
/// Where one touches another conductor.
pub(super) fn bars<const D: usize>(
    (scene, currents): (&Scene, &EddyCurrents),
    (cloud, region): (&Cloud, &Region<D>),
    weights: &[f64],
) -> Result<Vec<Bar>, Failure> {
    let given = |m: u8| {
        let body = (m as usize).checked_sub(1).map(|k| &scene.bodies[k]);
        body.is_some_and(|b| b.net_current_a.is_some())
    };
    let conducts = |m: u8| scene.medium(m as usize).conductivity_s_m > 0.0;
    for face in &region.faces {
        let (a, b) = (face.inner, face.outer);
        if conducts(a) && conducts(b) && (given(a) || given(b)) {
            let (own, other) = if given(a) { (a, b) } else { (b, a) };
            let [x, y, _] = cloud.position[face.point as usize];
            let what = format!(
                "the bar touches {} at ({x:.3e}, {y:.3e}) m, into which its current may pass: leave a gap, or give none of them a net current",
                scene.medium_name(other as usize)
            );
            let at = format!("/bodies/{}/net_current_a", own - 1);
            return Err(Fault::at(&at, what).into());
        }
    }
    let mut bars = Vec::new();
    for (k, body) in scene.bodies.iter().enumerate() {
        if let Some(current) = body.net_current_a {
            let lead = body.net_current_phase_deg.unwrap_or(0.0).to_radians();
            let current = C::from_polar(currents.rms(current), lead);
            let medium = (k as u8 + 1, body.conductivity_s_m);
            bars.push(Bar::new(region, weights, medium, current));
        }
    }
    Ok(bars)
}

impl<const D: usize> Setting<'_, D> {
    /// Takes what is applied along bars from the rates of their points, and what of sources waves know there; the totals.
    pub(super) fn applied<const K: usize>(
        &self,
        (omega, found): (f64, &[[C; K]]),
        change: &mut [[C; K]],
        source: &mut [[C; K]],
    ) -> Found {
        let mut totals = Found::default();
        let all: Vec<[C; K]> = found
            .iter()
            .zip(source.iter())
            .map(|(a, s)| std::array::from_fn(|k| a[k] + s[k]))
            .collect();
        for bar in &self.bars {
            let along = bar.voltage(omega, &all);
            for i in (0..self.region.len()).filter(|i| self.region.touches(*i, bar.medium)) {
                for k in 0..K {
                    change[i][k] -= along[k];
                    source[i][k] -= along[k] / C::new(0.0, omega);
                }
            }
            let name = self.scene.medium_name(bar.medium as usize);
            for (part, value) in [("real", along[0].re), ("imag", along[0].im)] {
                totals
                    .totals
                    .push((format!("bar_voltage_{name}_{part}"), "V/m", value));
            }
        }
        totals
    }
}
