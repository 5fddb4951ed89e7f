//! What is written of eddy currents: fields of points, forces and heat.

use shapes::frame::Vector;

use super::charge::fields::Voltage;
use super::problem::Problem;
use crate::frames::{Column, Found};
use crate::magnetic::driven::winding::Windings;
use crate::magnetic::fields::{Fields, Media, Solution};
use crate::magnetic::medium::law::traction;
use crate::magnetic::source::{C, Source};
use crate::magnetic::totals::Totals;
use crate::magnetic::unknown::Unknown;
use crate::stencils::region::Face;
use crate::surface::ways::push_force;

/// Ending of a column and what it holds of a phasor.
type Part = (&'static str, fn(&C) -> f64);

/// What drives currents, as strong as it is.
#[derive(Clone, Copy)]
pub(crate) struct Driven<'a> {
    /// Sources.
    pub(crate) source: &'a Source,
    /// Their flux density by point \[T\].
    pub(crate) flux: &'a [[C; 3]],
    /// Coils of points.
    pub(crate) windings: Option<&'a Windings>,
}

impl<const D: usize> Problem<'_, D> {
    /// Columns and totals of a solution, with what drives it and charges on conductors.
    pub(crate) fn found<const K: usize>(
        &self,
        solution: Solution<'_, K>,
        charged: Option<&Voltage>,
        driven: Driven<'_>,
    ) -> Found {
        let conductivity = &self.parameters.conductivity;
        let media = Media {
            laws: &self.parameters.laws,
            conductivity,
            flux: driven.flux,
        };
        let mut fields = Fields::new(
            &self.region,
            &self.sides,
            self.parameters.unknown,
            solution,
            &media,
        );
        let mut all = Found::default();
        let columns = &mut all.columns;
        if let Some(charged) = charged {
            fields.charged(&self.region, &media, &charged.beyond);
            for (part, of) in self.parts() {
                let values = charged.voltage.iter().map(of).collect();
                let name = format!("electric_potential{part}");
                columns.push(Column::new(&name, "V", values));
            }
        }
        if let Some(windings) = driven.windings {
            fields.wound::<D, K>(
                &self.region,
                &self.sides,
                self.parameters.unknown,
                &media,
                windings,
            );
        }
        if self.parameters.unknown == Unknown::Axial {
            for (part, of) in self.parts() {
                let name = format!("magnetic_field{part}");
                let values = solution.found.iter().map(|h| of(&h[0])).collect();
                columns.push(Column::new(&name, "A/m", values));
            }
        } else {
            let potential = &fields.potential;
            self.vector(columns, "vector_potential", "Wb/m", potential, &[]);
        }
        self.flux(&fields, columns);
        if conductivity.iter().any(|s| *s > 0.0) || driven.windings.is_some() {
            self.currents(&fields, columns);
        }
        if self.magnetic() {
            all.surface.extend(self.pulls(&fields));
        }
        let totals = self.totals(&fields, driven, &mut all);
        self.enclosed(solution, &fields, &totals, driven.source, &mut all);
        all.doubts.extend(self.doubt(&fields, &totals));
        all.doubts.extend(self.heat_doubt(&fields, &totals));
        all
    }

    /// Flux density, which jumps where permeability does.
    fn flux(&self, fields: &Fields, columns: &mut Vec<Column>) {
        let mut beyond: Vec<[C; 3]> = Vec::new();
        if self.magnetic() {
            beyond.extend(fields.beyond.iter().map(|b| b.flux));
        }
        let name = "magnetic_flux_density";
        self.vector(columns, name, "T", &fields.flux, &beyond);
    }

    /// Whether permeability is not uniform.
    fn magnetic(&self) -> bool {
        self.parameters.magnetic.contains(&true)
    }

    /// Traction where permeability jumps, by surface point.
    fn pulls(&self, fields: &Fields) -> [Column; 3] {
        let pull = |face: &Face<D>| {
            let normal = self.region.raise(face.normal);
            let flux = fields.flux[face.point as usize];
            traction(&self.parameters.laws, face, flux, normal)
        };
        let pulls: Vec<Vector> = self.region.faces.iter().map(pull).collect();
        Column::vector("magnetic_traction", "Pa", &pulls, &[])
    }

    /// Endings of columns and what they hold: phasors have two parts, fields of a march are real.
    fn parts(&self) -> &'static [Part] {
        match self.parameters.omega {
            Some(_) => &[("_real", |c| c.re), ("_imag", |c| c.im)],
            None => &[("", |c| c.re)],
        }
    }

    /// Columns of a vector by its parts, with its values beyond interfaces if it jumps there.
    fn vector(
        &self,
        columns: &mut Vec<Column>,
        name: &str,
        unit: &'static str,
        values: &[[C; 3]],
        beyond: &[[C; 3]],
    ) {
        for (part, of) in self.parts() {
            let [all, outer]: [Vec<Vector>; 2] = [values, beyond].map(|values| {
                let parts = values.iter().map(|v| [0, 1, 2].map(|k| of(&v[k])));
                parts.collect()
            });
            columns.extend(Column::vector(&format!("{name}{part}"), unit, &all, &outer));
        }
    }

    /// Currents, forces and heat of conductors.
    fn currents(&self, fields: &Fields, columns: &mut Vec<Column>) {
        let beyond: Vec<[C; 3]> = fields.beyond.iter().map(|b| b.current).collect();
        let current = &fields.current;
        self.vector(columns, "current_density", "A/m2", current, &beyond);
        let beyond: Vec<Vector> = fields.beyond.iter().map(|b| b.force).collect();
        columns.extend(Column::vector(
            "force_density",
            "N/m3",
            &fields.force,
            &beyond,
        ));
        columns.push(Column {
            beyond: fields.beyond.iter().map(|b| b.heat).collect(),
            ..Column::new("joule_heat", "W/m3", fields.heat.clone())
        });
    }

    /// Adds and gives the totals of all conductors.
    fn totals(&self, fields: &Fields, driven: Driven<'_>, all: &mut Found) -> Totals {
        let acting = self.acting();
        let geometry = self.cloud.geometry;
        let (newton, watt) = (geometry.unit_of_force(), geometry.unit_of_power());
        let mut force = |name: &str, value| push_force(geometry, name, value, all);
        if self.parameters.unknown == Unknown::Axial {
            // A field along z pulls at no coil, and what flows in through a wall is not told apart.
            let all_points = |_: usize| true;
            let found = Totals::bodies(&self.region, fields, &self.weights, acting, all_points);
            force("force_volume", found.force_volume);
            all.totals
                .push(("power_volume".to_owned(), watt, found.heat_volume));
            return Totals {
                force_volume: found.force_volume,
                heat_volume: found.heat_volume,
                ..Totals::default()
            };
        }
        let found = Totals::of(
            &self.region,
            fields,
            &self.weights,
            driven.source,
            driven.windings,
            acting,
        );
        force("force_volume", found.force_volume);
        force("force_maxwell", found.force_stress);
        force("force_coil", found.force_coil);
        for (name, unit, value) in [
            ("force_spread", newton, found.spread()),
            ("power_volume", watt, found.heat_volume),
            ("power_poynting", watt, found.heat_surface),
            (
                "power_spread",
                watt,
                (found.heat_volume - found.heat_surface).abs(),
            ),
        ] {
            all.totals.push((name.to_owned(), unit, value));
        }
        found
    }
}
