//! Eddy currents of a scene: its equations, their solution, fields, forces and heat.

use krylov::{Rule, System};
use num_complex::Complex;
use run::{Failure, Fault, Session};
use shapes::frame::{Vector, direction};

use super::region::{reduce, region};
use crate::cloud::region::vector;
use crate::cloud::{Class, Cloud, Metric};
use crate::output::{Column, Found};
use crate::scene::currents::OuterReaction;
use crate::scene::{Coil, EddyCurrents, Geometry, Scene};
use crate::solve::diffusion::{self, Conductors, Unknown};
use crate::solve::eddy::{Drive, Fields, Media};
use crate::solve::multipole::{Cells, Multipoles};
use crate::solve::region::Region;
use crate::solve::sides::Sides;
use crate::solve::totals::{self, Totals};
use crate::source::{Loop, MU0, Segment, Source, Uniform, Wire};

type C = Complex<f64>;

/// Radius of a wire that the scene calls thin, over the size of its coil.
const THIN: f64 = 1e-3;

/// What is sought in a scene.
#[must_use]
pub fn unknown(scene: &Scene, currents: &EddyCurrents) -> Unknown {
    let axial = currents.applied_flux_density_t.as_ref();
    match scene.geometry {
        Geometry::Space => Unknown::Potential,
        Geometry::Axisymmetric => Unknown::Around,
        Geometry::Plane if axial.is_some_and(|b| b[2] != 0.0) => Unknown::Axial,
        Geometry::Plane => Unknown::Potential,
    }
}

/// What is wrong with the currents of a scene beyond what its types and single keys can tell.
#[must_use]
pub fn faults(scene: &Scene, currents: &EddyCurrents) -> Vec<Fault> {
    let mut faults = Vec::new();
    let unknown = unknown(scene, currents);
    let own = scene.surroundings.relative_permeability;
    for (k, body) in scene.bodies.iter().enumerate() {
        if unknown != Unknown::Axial && (body.relative_permeability - own).abs() > 1e-12 * own {
            let what = format!(
                "{} differs from {own} of the surroundings: only one permeability is computed",
                body.relative_permeability
            );
            faults.push(Fault::at(
                &format!("/bodies/{k}/relative_permeability"),
                what,
            ));
        }
    }
    if let (Unknown::Axial, Some(b)) = (unknown, &currents.applied_flux_density_t) {
        let at = "/eddy_currents/applied_flux_density_t";
        if b[0] != 0.0 || b[1] != 0.0 {
            faults.push(Fault::at(
                at,
                "either along z or in the plane: they are two scenes",
            ));
        }
        if !currents.coils.is_empty() {
            let what = "wires along z and a field along z are two scenes";
            faults.push(Fault::at("/eddy_currents/coils", what));
        }
        if currents.outer == OuterReaction::Multipole {
            let what = "a field along z is what it is at the walls: leave \"outer\" away";
            faults.push(Fault::at("/eddy_currents/outer", what));
        }
    }
    faults
}

/// The exact fields of coils and of the applied field, rms.
#[must_use]
pub fn source(scene: &Scene, currents: &EddyCurrents) -> Source {
    let mut source = Source::default();
    let phasor =
        |current: f64, degrees: f64| C::from_polar(currents.rms(current), degrees.to_radians());
    for coil in &currents.coils {
        match coil {
            Coil::Loop(l) => {
                let one = Loop {
                    centre: scene.geometry.place(vector(&l.centre_m)),
                    axis: direction(l.normal.unwrap_or([0.0, 0.0, 1.0])),
                    radius: l.radius_m,
                    wire_radius: l.wire_radius_m.unwrap_or(THIN * l.radius_m),
                    current: phasor(l.current_a * l.turns, l.phase_deg),
                };
                if l.wire_radius_m.is_some() {
                    source.loops.extend(one.filaments());
                } else {
                    source.loops.push(one);
                }
            }
            Coil::Segments(s) => {
                let size =
                    shapes::frame::length(shapes::frame::difference(s.points_m[1], s.points_m[0]));
                let ends = s.points_m.iter().skip(1);
                let back = s.closed.then(|| &s.points_m[0]);
                for (from, to) in s.points_m.iter().zip(ends.chain(back)) {
                    source.segments.push(Segment {
                        from: *from,
                        to: *to,
                        wire_radius: THIN * size,
                        current: phasor(s.current_a, s.phase_deg),
                    });
                }
            }
            Coil::Wire(w) => source.wires.push(Wire {
                place: w.place_m,
                wire_radius: THIN * scene.points.spacing_m,
                current: phasor(w.current_a, w.phase_deg),
            }),
        }
    }
    if let Some(b) = &currents.applied_flux_density_t {
        let b = match scene.geometry {
            Geometry::Axisymmetric => [0.0, 0.0, b[1]],
            _ => vector(b),
        };
        source.uniform.push(Uniform {
            flux: b.map(|b| C::from(currents.rms(b))),
            origin: [0.0; 3],
        });
    }
    source
}

/// A sinusoidal steady state in `D` coordinates with `K` unknowns a point.
struct Steady<'a, const D: usize> {
    scene: &'a Scene,
    cloud: &'a Cloud,
    currents: &'a EddyCurrents,
    omega: f64,
    unknown: Unknown,
    source: Source,
    region: Region<D>,
    sides: Sides<D>,
    conductors: Conductors,
    centroid: Vec<[f64; D]>,
}

/// Solves the eddy currents of a scene in `D` coordinates with `K` unknowns a point: 3 in space, else 1.
///
/// # Errors
/// Where a stencil cannot be made or the solve breaks down.
pub fn eddy_currents<const D: usize, const K: usize>(
    scene: &Scene,
    currents: &EddyCurrents,
    cloud: &Cloud,
    session: &mut Session,
) -> Result<Found, Failure> {
    let Some(omega) = currents.angular_frequency() else {
        let what = "a march in time is not computed";
        return Err(Fault::at("/eddy_currents/transient", what).into());
    };
    let region: Region<D> = region(scene, cloud, &|_| false);
    let made = session.timed("weights", || Sides::new(&region, &super::form(scene)));
    let steady = Steady {
        sides: made.map_err(|error| Failure::Other(format!("eddy currents: {error}")))?,
        unknown: unknown(scene, currents),
        source: source(scene, currents),
        conductors: Conductors {
            mu_sigma: media(scene, |m| {
                MU0 * m.relative_permeability * m.conductivity_s_m
            }),
        },
        centroid: cloud
            .centroid
            .iter()
            .map(|x| reduce(cloud.geometry, *x))
            .collect(),
        region,
        scene,
        cloud,
        currents,
        omega,
    };
    steady.warn(session);
    let drive = session.timed("source", || steady.drive::<K>());
    let found = steady.solve(&drive, session)?;
    Ok(session.timed("fields", || steady.found(&found, &drive)))
}

fn media(scene: &Scene, of: impl Fn(crate::scene::Medium) -> f64) -> Vec<f64> {
    (0..=scene.bodies.len())
        .map(|m| of(scene.medium(m)))
        .collect()
}

impl<const D: usize> Steady<'_, D> {
    /// Says where layers are too thick for the skin of a conductor.
    fn warn(&self, session: &mut Session) {
        for (m, mu_sigma) in self.conductors.mu_sigma.iter().enumerate() {
            let touches = |i: usize| {
                self.cloud.touches(i, m as u8) && !matches!(self.cloud.class[i], Class::Inside(_))
            };
            let across = |i: usize| match self.cloud.metric[i] {
                Metric::Round => self.cloud.spacing[i],
                Metric::Layered { across, .. } => across,
            };
            let widest = (0..self.cloud.len())
                .filter(|i| touches(*i))
                .map(across)
                .fold(0.0, f64::max);
            let skin = (2.0 / (self.omega * mu_sigma)).sqrt();
            if *mu_sigma > 0.0 && skin < widest {
                let name = self.scene.medium_name(m);
                session.warn(format!(
                    "unresolved: skin depth {skin:.3e} m in {name}, spacing {widest:.3e} m across its surface"
                ));
            }
        }
    }

    /// What sources give of the unknowns.
    fn drive<const K: usize>(&self) -> Drive<K> {
        let zero = C::default();
        let places = &self.cloud.position;
        let mut held = [zero; K];
        let source = match self.unknown {
            Unknown::Axial => {
                let applied = self.source.uniform.iter().map(|u| u.flux[2]).sum::<C>();
                held[0] = applied / MU0;
                vec![[zero; K]; places.len()]
            }
            Unknown::Around => {
                let a = self.source.potential(places);
                let at = |(x, a): (&Vector, [C; 3])| {
                    let mut value = [zero; K];
                    value[0] = if x[0] > 0.0 {
                        a[1] / x[0]
                    } else {
                        // A = r B_z / 2 beside the axis.
                        self.source.flux_at(*x)[2] * 0.5
                    };
                    value
                };
                places.iter().zip(a).map(at).collect()
            }
            Unknown::Potential if K == 1 => {
                let mut source = self.source.clone();
                // Of a uniform field in the plane the z component carries all, not half.
                for uniform in &mut source.uniform {
                    uniform.flux = uniform.flux.map(|b| b * 2.0);
                }
                let a = source.potential(places);
                a.into_iter().map(|a| [a[2]; K]).collect()
            }
            Unknown::Potential => {
                let a = self.source.potential(places);
                a.into_iter()
                    .map(|a| std::array::from_fn(|k| a[k]))
                    .collect()
            }
        };
        Drive {
            omega: self.omega,
            source,
            held,
        }
    }

    fn solve<const K: usize>(
        &self,
        drive: &Drive<K>,
        session: &mut Session,
    ) -> Result<Vec<[C; K]>, Failure> {
        let (region, sides) = (&self.region, &self.sides);
        let (rates, rows) = session.timed("assemble", || {
            let rates = self.conductors.rates(region, sides, self.unknown);
            (rates, self.conductors.rows(region, sides, self.unknown))
        });
        let at = (region, self.unknown);
        let mut right = drive.right(&self.conductors, at, &rates);
        let pairs = if self.currents.outer == OuterReaction::Multipole {
            let multipoles = Multipoles::new(region, &self.cells());
            drive.pairs(&self.conductors, at, &multipoles, &mut right)
        } else {
            Vec::new()
        };
        let shift = diffusion::shift(&rates, self.omega);
        let options = super::options(self.scene);
        let made = session.timed("factorise", || System::new(rows, shift, options));
        let failed = |error: krylov::Error| Failure::Other(format!("eddy currents: {error}"));
        let mut system = made.map_err(failed)?;
        let mut x = vec![[C::default(); K]; right.len()];
        let rule: Rule = super::rule(self.scene);
        let solved = session.timed("solve", || system.solve_with(&pairs, &right, &mut x, rule));
        super::report("vector_potential", &solved, session)?;
        Ok(x)
    }

    fn cells(&self) -> Cells<'_, D> {
        Cells {
            volume: &self.cloud.volume,
            centroid: &self.centroid,
        }
    }

    fn found<const K: usize>(&self, found: &[[C; K]], drive: &Drive<K>) -> Found {
        let flux = self.source.flux(&self.cloud.position);
        let conductivity = media(self.scene, |m| m.conductivity_s_m);
        let media = Media {
            omega: self.omega,
            permeability: &media(self.scene, |m| MU0 * m.relative_permeability),
            conductivity: &conductivity,
            flux: &flux,
        };
        let fields = Fields::new(
            (&self.region, &self.sides),
            self.unknown,
            (found, &drive.source),
            &media,
        );
        let mut all = Found::default();
        let columns = &mut all.columns;
        if self.unknown == Unknown::Axial {
            columns.push(Column::new(
                "magnetic_field_real",
                "A/m",
                found.iter().map(|h| h[0].re).collect(),
            ));
            columns.push(Column::new(
                "magnetic_field_imag",
                "A/m",
                found.iter().map(|h| h[0].im).collect(),
            ));
        } else {
            phasor(
                columns,
                "vector_potential",
                "Wb/m",
                (&fields.potential, None),
            );
        }
        phasor(columns, "magnetic_flux_density", "T", (&fields.flux, None));
        if conductivity.iter().any(|s| *s > 0.0) {
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
            phasor(
                columns,
                "current_density",
                "A/m2",
                (&fields.current, Some((self.cloud, &beyond))),
            );
            let scaled = |s: &crate::cloud::SurfacePoint, k: f64| {
                fields.force[s.point as usize].map(|f| f * k)
            };
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
        self.totals(&fields, &conductivity, &mut all);
        all
    }

    fn totals(&self, fields: &Fields, conductivity: &[f64], all: &mut Found) {
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
        if let (Some(region), Some(sides)) = (self.in_space(), self.sides_in_space()) {
            let centroid: Vec<Vector> = self.cloud.centroid.clone();
            let cells = Cells {
                volume: &self.cloud.volume,
                centroid: &centroid,
            };
            let conducts: Vec<bool> = conductivity.iter().map(|s| *s > 0.0).collect();
            let found = Totals::in_space(
                (region, sides),
                fields,
                &cells,
                (&self.source, self.omega, &conducts),
            );
            force("force_volume", found.force_volume);
            force("force_maxwell", found.force_stress);
            force("force_coil", found.force_coil);
            all.totals
                .push(("force_spread".to_owned(), newton, found.spread()));
            all.totals
                .push(("power_volume".to_owned(), watt, found.heat_volume));
            all.totals
                .push(("power_poynting".to_owned(), watt, found.heat_surface));
        } else {
            let (pull, heat) = totals::volume(&self.region, &self.sides, fields, &self.cells());
            force("force_volume", pull);
            all.totals.push(("power_volume".to_owned(), watt, heat));
        }
    }

    /// The points, if they have three coordinates.
    fn in_space(&self) -> Option<&Region<3>> {
        (&self.region as &dyn std::any::Any).downcast_ref()
    }

    fn sides_in_space(&self) -> Option<&Sides<3>> {
        (&self.sides as &dyn std::any::Any).downcast_ref()
    }
}

/// Six columns of a vector of phasors; beyond interfaces it is that much of the value before them.
fn phasor(
    columns: &mut Vec<Column>,
    name: &str,
    unit: &'static str,
    (values, beyond): (&[[C; 3]], Option<(&Cloud, &[f64])>),
) {
    let mut part = |name: String, of: fn(&C) -> f64| {
        let all: Vec<Vector> = values
            .iter()
            .map(|v| [0, 1, 2].map(|k| of(&v[k])))
            .collect();
        let outer: Vec<Vector> = beyond.map_or_else(Vec::new, |(cloud, share)| {
            let each = cloud.surface.iter().zip(share);
            each.map(|(s, share)| all[s.point as usize].map(|v| v * share))
                .collect()
        });
        columns.extend(Column::vector(&name, unit, &all, &outer));
    };
    part(format!("{name}_real"), |c| c.re);
    part(format!("{name}_imag"), |c| c.im);
}
