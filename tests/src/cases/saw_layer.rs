//! `saw-layer`: liquid metal that freezes under a bed of grains, which melts.

use std::f64::consts::PI;

use artefact::{Frame, Reader};
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, mass};
use crate::lab::{Finished, Lab, LabError};
use crate::neumann::{front, halved};
use crate::norms::relative;
use crate::particles::number;
use crate::special::erf;

/// The case.
pub(super) struct SawLayer;

/// Height of the bed over the depth of the metal.
const BED: f64 = 0.5;
/// Depth of the metal over sqrt(alpha t) at the end.
const REACHES: f64 = 5.5;
/// Columns of grains along each side.
const SIDE: usize = 3;

impl Case for SawLayer {
    fn name(&self) -> &'static str {
        "saw-layer"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Neumann's solution for two half-spaces that touch, each with a front, Carslaw and Jaeger (1959), section 11.2"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("front_metal", 0.015),
            Target::error("front_slag", 0.015),
            Target::error("temperature_l2", 0.015),
            Target::error("energy", 1e-10),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let label = format!("scene{level}");
        let first = lab.run("poolsph", self.name(), &label, &json!({}))?;
        let bed = Bed::of(&first)?;
        let run = lab.varied(&first, &format!("level{level}"), &bed.patch(&first, level)?)?;
        let bed = Bed::of(&run)?;
        let exact = Exact::of(&bed);
        let errors = errors(&run, &bed, &exact)?;
        let points = run.scene["grains"]["bodies"][0]["places_m"].as_array();
        let grains = points.map_or(0, Vec::len);
        let layers = (bed.depth / bed.spacing).round() as usize;
        let points = (grains + layers * SIDE * SIDE) as u64;
        Ok(Measurement::of(run, points, bed.spacing, errors))
    }
}

/// The scene, and what a bed of such grains conducts and holds.
struct Bed {
    /// d of the metal, and the diameter of a grain.
    spacing: f64,
    depth: f64,
    end: f64,
    radius: f64,
    /// Overlap over the diameter.
    overlap: f64,
    stiffness: f64,
    /// Effective moduli of two grains and of a grain on metal \[Pa\].
    moduli: [f64; 2],
    gas: f64,
    solid: f64,
    slag: f64,
    mass: f64,
    metal: Matter,
    grain: Matter,
}

/// Capacity \[J/(m3 K)\] or \[J/(kg K)\], heat of fusion, and temperatures \[K\].
struct Matter {
    conductivity: f64,
    heat: f64,
    latent: f64,
    melting: f64,
    start: f64,
    density: f64,
}

impl Bed {
    fn of(run: &Finished) -> Result<Self, LabError> {
        let at = |key: &str| number(run, key);
        let soft = |key: &str| -> Result<f64, LabError> {
            let nu = at(&format!("{key}/poisson_ratio"))?;
            Ok((1.0 - nu * nu) / at(&format!("{key}/youngs_modulus_pa"))?)
        };
        let grain = soft("/grains/heat/contact/elastic")?;
        let metal = soft("/grains/metal/elastic")?;
        let radius = at("/grains/bodies/0/radius_m")?;
        let spacing = at("/spacing_m")?;
        let lowest = at("/grains/bodies/0/places_m/0/2")?;
        Ok(Self {
            spacing,
            depth: -at("/bodies/0/shape/box/min_m/2")?,
            end: at("/time/end_s")?,
            radius,
            overlap: 0.5 - 0.5 * lowest / radius,
            stiffness: at("/grains/contact/law/linear/stiffness_n_m")?,
            moduli: [0.5 / grain, 1.0 / (grain + metal)],
            gas: at("/grains/heat/gas_conductivity_w_m_k")?,
            solid: at("/grains/heat/thermal_conductivity_w_m_k")?,
            slag: at("/grains/heat/melting/slag_conductivity_ratio")?,
            mass: mass(at("/grains/density_kg_m3")?, radius),
            metal: Matter {
                conductivity: at("/heat/thermal_conductivity_w_m_k")?,
                heat: at("/heat/specific_heat_j_kg_k")?,
                latent: at("/heat/melting/latent_heat_j_kg")?,
                melting: at("/heat/melting/point_k")?,
                start: at("/bodies/0/temperature_k")?,
                density: at("/density_kg_m3")?,
            },
            grain: Matter {
                conductivity: 0.0,
                heat: at("/grains/heat/specific_heat_j_kg_k")?,
                latent: at("/grains/heat/melting/latent_heat_j_kg")?,
                melting: at("/grains/heat/melting/point_k")?,
                start: at("/grains/bodies/0/temperature_k")?,
                density: 0.0,
            },
        })
    }

    /// Distance of grains \[m\].
    fn apart(&self) -> f64 {
        2.0 * self.radius * (1.0 - self.overlap)
    }

    /// H of two grains of the conductivity `k` \[W/K\].
    fn conductance(&self, k: f64) -> f64 {
        let push = self.stiffness * 2.0 * self.radius * self.overlap;
        let r = self.radius;
        let r_c = (0.75 * push * 0.5 * r / self.moduli[0]).cbrt();
        let share = r_c / r;
        let gas = 2.0 * PI * (1.0 - 0.5 * share * share) * (r - r_c) / (1.0 - 0.25 * PI);
        2.0 * k * r_c + self.gas * gas
    }

    /// Bed and metal on a lattice `2^(1 - level)` times as wide.
    fn patch(&self, first: &Finished, level: u32) -> Result<Value, LabError> {
        let scale = 0.5_f64.powi(level.clamp(1, 5) as i32 - 1);
        let d = self.spacing * scale;
        let radius = self.radius * scale;
        let (apart, low) = (self.apart() * scale, (1.0 - 2.0 * self.overlap) * radius);
        let layers = (BED * self.depth / apart).floor() as usize;
        let mut places = Vec::new();
        for k in 0..layers {
            for j in 0..SIDE {
                for i in 0..SIDE {
                    places.push([
                        (i as f64 + 0.5) * d,
                        (j as f64 + 0.5) * d,
                        low + k as f64 * apart,
                    ]);
                }
            }
        }
        let side = SIDE as f64 * d;
        let [low, high] = [[0.0, 0.0, -self.depth], [side, side, 0.0]];
        let mut body = first.scene["grains"]["bodies"][0].clone();
        body["places_m"] = json!(places);
        body["radius_m"] = json!(radius);
        let mut metal = first.scene["bodies"][0].clone();
        metal["shape"] = json!({"box": {"min_m": low, "max_m": high}});
        // Heat has gone a fifth of the depth.
        let diffusivity = self.metal.conductivity / (self.metal.density * self.metal.heat);
        let end = (self.depth / REACHES).powi(2) / diffusivity;
        let steps = (600.0 / (scale * scale)).round();
        Ok(json!({
            "spacing_m": d,
            "time": {"step_s": end / steps, "end_s": end},
            "bodies": [metal],
            "heat": {"faces": {"min_m": low, "max_m": high}},
            // The same push over the square of the diameter: contacts as wide over it.
            "grains": {"bodies": [body], "contact": {"law": {"linear": {"stiffness_n_m": self.stiffness * scale}}}},
            "output": {"particles_interval_s": end / 300.0, "balance_interval_s": end}
        }))
    }
}

/// Neumann's solution on both sides of a face.
struct Exact {
    /// T of the face \[K\].
    face: f64,
    /// Of the metal: diffusivity \[m2/s\] and the constant of its front.
    metal: [f64; 2],
    /// Of the slag: diffusivity and the constant of its front; of the powder: diffusivity.
    slag: [f64; 2],
    powder: f64,
}

impl Exact {
    fn of(bed: &Bed) -> Self {
        let volume = bed.apart() * (2.0 * bed.radius).powi(2);
        let capacity = bed.mass * bed.grain.heat / volume;
        let across = bed.apart() / (2.0 * bed.radius).powi(2);
        let [powder, slag] = [1.0, bed.slag].map(|by| bed.conductance(by * bed.solid) * across);
        let (m, g) = (&bed.metal, &bed.grain);
        let diffusivity = m.conductivity / (m.density * m.heat);
        let metal = |face: f64| {
            let over = m.heat / m.latent;
            front(
                [over * (m.melting - face), over * (m.start - m.melting)],
                1.0,
                1.0,
            )
        };
        let melts = |face: f64| {
            let over = g.heat / g.latent;
            let ratio = powder / slag;
            front(
                [over * (face - g.melting), over * (g.melting - g.start)],
                ratio,
                ratio,
            )
        };
        // Heat that comes through the face from the metal, less what goes into the bed.
        let excess = |face: f64| {
            let from =
                m.conductivity * (m.melting - face) / (diffusivity.sqrt() * erf(metal(face)));
            let into = slag * (face - g.melting) / ((slag / capacity).sqrt() * erf(melts(face)));
            from - into
        };
        let face = halved(g.melting + 1e-6, m.melting - 1e-6, |face| {
            excess(face) > 0.0
        });
        Self {
            face,
            metal: [diffusivity, metal(face)],
            slag: [slag / capacity, melts(face)],
            powder: powder / capacity,
        }
    }

    /// How far a front has gone \[m\].
    fn front([diffusivity, constant]: [f64; 2], time: f64) -> f64 {
        2.0 * constant * (diffusivity * time).sqrt()
    }

    /// T at a depth in the metal \[K\].
    fn in_metal(&self, bed: &Bed, depth: f64, time: f64) -> f64 {
        let [diffusivity, constant] = self.metal;
        let (eta, m) = (depth / (2.0 * (diffusivity * time).sqrt()), &bed.metal);
        if eta < constant {
            self.face + (m.melting - self.face) * erf(eta) / erf(constant)
        } else {
            m.start + (m.melting - m.start) * (1.0 - erf(eta)) / (1.0 - erf(constant))
        }
    }

    /// T at a height in the bed \[K\].
    fn in_bed(&self, bed: &Bed, height: f64, time: f64) -> f64 {
        let ([diffusivity, constant], g) = (self.slag, &bed.grain);
        let eta = height / (2.0 * (diffusivity * time).sqrt());
        if eta < constant {
            return self.face + (g.melting - self.face) * erf(eta) / erf(constant);
        }
        let scale = (diffusivity / self.powder).sqrt();
        let part = (1.0 - erf(eta * scale)) / (1.0 - erf(constant * scale));
        g.start + (g.melting - g.start) * part
    }
}

/// What frames tell of one side: distances from the face, when each point changed, and temperatures at the end.
struct Side {
    away: Vec<f64>,
    changed: Vec<Option<f64>>,
    temperature: Vec<f64>,
}

impl Side {
    /// `sign` points into the side, `column` and `value` tell a point that has changed.
    fn read(
        reader: &Reader,
        channel: &str,
        sign: f64,
        column: &str,
        value: u8,
    ) -> Result<Self, LabError> {
        let mut side = Self {
            away: Vec::new(),
            changed: Vec::new(),
            temperature: Vec::new(),
        };
        let mut before = 0.0;
        for frame in reader.frames(channel)? {
            let frame: Frame = frame?;
            let places = frame.position_vectors()?;
            side.away = places.iter().map(|x| sign * x[2]).collect();
            side.changed.resize(side.away.len(), None);
            for (changed, now) in side.changed.iter_mut().zip(frame.u8(column)?) {
                if *now == value && changed.is_none() {
                    *changed = Some(0.5 * (before + frame.time_s));
                }
            }
            side.temperature = frame.f64("temperature")?;
            before = frame.time_s;
        }
        Ok(side)
    }

    /// Greatest error of the front in the second half of the run, over its way.
    fn front(&self, end: f64, exact: impl Fn(f64) -> f64) -> f64 {
        let passages = self.away.iter().zip(&self.changed);
        let late = passages.filter_map(|(x, t)| t.filter(|t| *t > 0.5 * end).map(|t| (x, t)));
        // No passage at all is no success.
        late.map(|(x, t)| (x / exact(t) - 1.0).abs())
            .fold(f64::NAN, f64::max)
    }
}

fn errors(run: &Finished, bed: &Bed, exact: &Exact) -> Result<Errors, LabError> {
    let reader = Reader::open_kind(&run.artefact, "particle-frames", 1)?;
    let metal = Side::read(&reader, "/particles", -1.0, "molten", 0)?;
    let grains = Side::read(&reader, "/grains", 1.0, "state", 1)?;
    let mut found = Vec::new();
    let mut wanted = Vec::new();
    for (x, t) in metal.away.iter().zip(&metal.temperature) {
        found.push(t - bed.metal.start);
        wanted.push(exact.in_metal(bed, *x, bed.end) - bed.metal.start);
    }
    for (x, t) in grains.away.iter().zip(&grains.temperature) {
        found.push(t - bed.grain.start);
        wanted.push(exact.in_bed(bed, *x, bed.end) - bed.grain.start);
    }
    let (l2, linf) = relative(&found, &wanted);
    Ok(Errors::from([
        (
            "front_metal".to_owned(),
            metal.front(bed.end, |t| Exact::front(exact.metal, t)),
        ),
        (
            "front_slag".to_owned(),
            grains.front(bed.end, |t| Exact::front(exact.slag, t)),
        ),
        ("temperature_l2".to_owned(), l2),
        ("temperature_linf".to_owned(), linf),
        ("energy".to_owned(), energy(run, &reader)?),
    ]))
}

/// What metal and grains hold together, over what one gave the other.
fn energy(run: &Finished, reader: &Reader) -> Result<f64, LabError> {
    let change = |channel: &str, name: &str| -> Result<f64, LabError> {
        let records = reader.records(channel)?;
        let of = |k: usize| records.get(k).and_then(|(_, record)| record.get(name).ok());
        match (of(0), of(records.len().saturating_sub(1))) {
            (Some(first), Some(last)) => Ok(last - first),
            _ => Err(fault(run, &format!("has no '{name}' in {channel}"))),
        }
    };
    let metal = change("/balance", "energy_stored_j")?;
    let grains = change("/grains_balance", "enthalpy_j")?;
    Ok((metal + grains).abs() / grains.abs())
}
