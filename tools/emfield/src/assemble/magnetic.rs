//! What is written of eddy currents: fields of points, forces and heat.

use num_complex::Complex;
use shapes::frame::Vector;

use super::currents::{Setting, media};
use crate::cloud::SurfacePoint;
use crate::output::{Column, Found};
use crate::scene::Geometry;
use crate::solve::diffusion::Unknown;
use crate::solve::eddy::{Fields, Media, Solution};
use crate::solve::totals::{self, Totals};
use crate::source::{MU0, Source};

type C = Complex<f64>;

/// Ending of a column and what it holds of a phasor.
type Part = (&'static str, fn(&C) -> f64);

impl<const D: usize> Setting<'_, D> {
    /// Columns and totals of a solution, with the flux density of its sources and these themselves.
    pub(super) fn found<const K: usize>(
        &self,
        solution: Solution<'_, K>,
        flux: &[[C; 3]],
        source: &Source,
    ) -> Found {
        let conductivity = media(self.scene, |m| m.conductivity_s_m);
        let media = Media {
            permeability: &media(self.scene, |m| MU0 * m.relative_permeability),
            conductivity: &conductivity,
            flux,
        };
        let fields = Fields::new((&self.region, &self.sides), self.unknown, solution, &media);
        let mut all = Found::default();
        let columns = &mut all.columns;
        if self.unknown == Unknown::Axial {
            for (part, of) in self.parts() {
                let name = format!("magnetic_field{part}");
                let values = solution.found.iter().map(|h| of(&h[0])).collect();
                columns.push(Column::new(&name, "A/m", values));
            }
        } else {
            let name = ("vector_potential", "Wb/m");
            self.vector(columns, name, &fields.potential, None);
        }
        self.vector(columns, ("magnetic_flux_density", "T"), &fields.flux, None);
        if conductivity.iter().any(|s| *s > 0.0) {
            self.currents(&fields, &conductivity, columns);
        }
        self.totals(&fields, &conductivity, source, &mut all);
        all
    }

    /// Endings of columns and what they hold: phasors have two parts, fields of a march are real.
    fn parts(&self) -> &'static [Part] {
        match self.omega {
            Some(_) => &[("_real", |c| c.re), ("_imag", |c| c.im)],
            None => &[("", |c| c.re)],
        }
    }

    /// Columns of a vector by its parts; beyond interfaces it is that much of the value before them.
    fn vector(
        &self,
        columns: &mut Vec<Column>,
        (name, unit): (&str, &'static str),
        values: &[[C; 3]],
        beyond: Option<&[f64]>,
    ) {
        for (part, of) in self.parts() {
            let all: Vec<Vector> = values
                .iter()
                .map(|v| [0, 1, 2].map(|k| of(&v[k])))
                .collect();
            let outer: Vec<Vector> = beyond.map_or_else(Vec::new, |share| {
                let each = self.cloud.surface.iter().zip(share);
                each.map(|(s, share)| all[s.point as usize].map(|v| v * share))
                    .collect()
            });
            columns.extend(Column::vector(&format!("{name}{part}"), unit, &all, &outer));
        }
    }

    /// Currents, forces and heat of conductors.
    fn currents(&self, fields: &Fields, conductivity: &[f64], columns: &mut Vec<Column>) {
        // E is continuous along the surface: beyond it currents are as conductivities are.
        let beyond: Vec<f64> = self
            .cloud
            .surface
            .iter()
            .map(|s| {
                let [inner, outer] = [s.inner, s.outer].map(|m| conductivity[m as usize]);
                if inner > 0.0 { outer / inner } else { 0.0 }
            })
            .collect();
        let name = ("current_density", "A/m2");
        self.vector(columns, name, &fields.current, Some(&beyond));
        let scaled = |s: &SurfacePoint, k: f64| fields.force[s.point as usize].map(|f| f * k);
        let force: Vec<Vector> = self
            .cloud
            .surface
            .iter()
            .zip(&beyond)
            .map(|(s, k)| scaled(s, *k))
            .collect();
        columns.extend(Column::vector(
            "force_density",
            "N/m3",
            &fields.force,
            &force,
        ));
        let heat = self.cloud.surface.iter().zip(&beyond);
        columns.push(Column {
            beyond: heat
                .map(|(s, k)| fields.heat[s.point as usize] * k)
                .collect(),
            ..Column::new("joule_heat", "W/m3", fields.heat.clone())
        });
    }

    fn totals(&self, fields: &Fields, conductivity: &[f64], source: &Source, all: &mut Found) {
        let plane = self.scene.geometry == Geometry::Plane;
        let (newton, watt) = if plane { ("N/m", "W/m") } else { ("N", "W") };
        let axisymmetric = self.scene.geometry == Geometry::Axisymmetric;
        let mut force = |name: &str, value: [f64; 3]| {
            for (k, axis) in ['x', 'y', 'z'].iter().enumerate() {
                // Radial forces of a full turn cancel; nothing pulls along an endless bar.
                if !(axisymmetric && k < 2 || plane && k == 2) {
                    all.totals
                        .push((format!("{name}_{axis}"), newton, value[k]));
                }
            }
        };
        if self.unknown == Unknown::Axial {
            // A field along z pulls at no coil, and what flows in through a wall is not told apart.
            let (pull, heat) = totals::volume(fields, &self.weights);
            force("force_volume", pull);
            all.totals.push(("power_volume".to_owned(), watt, heat));
            return;
        }
        let conducts: Vec<bool> = conductivity.iter().map(|s| *s > 0.0).collect();
        let found = Totals::of(&self.region, fields, &self.weights, (source, &conducts));
        force("force_volume", found.force_volume);
        force("force_maxwell", found.force_stress);
        force("force_coil", found.force_coil);
        for (name, unit, value) in [
            ("force_spread", newton, found.spread()),
            ("power_volume", watt, found.heat_volume),
            ("power_poynting", watt, found.heat_surface),
        ] {
            all.totals.push((name.to_owned(), unit, value));
        }
    }
}
