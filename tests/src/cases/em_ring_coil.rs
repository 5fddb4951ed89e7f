//! `em-ring-coil`: the field of a ring whose points carry a current.

use artefact::Reader;
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::coil::{Section, parts, ring};
use crate::em::frames::{Level, Points, measured, number};
use crate::heat::frames::greater;
use crate::heat::methods::over;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmRingCoil;

/// A round section with quartics, shaken points, quadratics; a square section about the axis and in space.
const METHODS: &[&str] = &["round", "irregular", "quadratic", "square", SPACE];
const SPACE: &str = "space";

/// Points in space are compared one in so many.
const EACH: usize = 50;

impl Case for EmRingCoil {
    fn name(&self) -> &'static str {
        "em-ring-coil"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Loops by elliptic integrals, Jackson (1998), section 5.5, over the section"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        let bounds = [
            ("round", 2e-3, 2.0),
            ("irregular", 2e-3, 2.0),
            ("quadratic", 2e-2, 1.5),
            ("square", 2e-2, 1.5),
            (SPACE, 1e-1, 1.0),
        ];
        let mut targets = Vec::new();
        for (method, error, order) in bounds {
            for quantity in ["axis_linf", "flux_linf"] {
                targets.push(Target::error(quantity, error).of(method));
                targets.push(Target::order(quantity, order).of(method));
            }
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let level = level.clamp(1, 3) as usize - 1;
        let spacing = match method {
            SPACE => [2e-3, 1.4e-3, 1e-3][level],
            _ => [1e-3, 7e-4, 5e-4][level],
        };
        let points = json!({"points": {"spacing_m": spacing}});
        let patch = over(points, &method_patch(method));
        measured(
            lab,
            self,
            Level {
                level: level as u32 + 1,
                method,
                spacing,
            },
            &patch,
            errors,
        )
    }
}

/// What the ways of the square section and of space are made from: the ring that they have in common \[m\].
const RADIUS: f64 = 0.01;
const HALF: f64 = 0.003;

fn method_patch(method: &str) -> Value {
    match method {
        "irregular" => json!({"points": {"jitter": 0.2}}),
        "quadratic" => json!({"method": {"order": 2}}),
        "square" => json!({"bodies": [{"name": "ring", "shape": {"box": {
            "min_m": [RADIUS - HALF, -HALF], "max_m": [RADIUS + HALF, HALF]}}}]}),
        SPACE => {
            let bar = |radius: f64| json!({"cylinder": {"centre_m": [0, 0, 0], "radius_m": radius, "length_m": 2.0 * HALF}});
            let places = [("centre", 0.0), ("near", 0.005), ("far", 0.02)];
            let probes = places.map(|(name, z)| json!({"name": name, "place_m": [0, 0, z]}));
            json!({
                "geometry": SPACE,
                "points": {"outward": 0.15},
                "domain": {"sphere": {"centre_m": [0, 0, 0]}},
                "bodies": [{"name": "ring",
                    "shape": {"difference": [bar(RADIUS + HALF), bar(RADIUS - HALF)]}}],
                "eddy_currents": {"coils": [{"region": {"body": "ring", "current_a": 1000,
                    "axis": {"centre_m": [0, 0, 0], "normal": [0, 0, 1]}}}]},
                "output": {"probes": probes}
            })
        }
        _ => json!({}),
    }
}

/// The ring of a scene.
struct Ring {
    /// Of the middle of its section: distance from the axis and height \[m\].
    middle: [f64; 2],
    section: Section,
    /// \[A\]
    current: f64,
}

impl Ring {
    /// The ring that was run.
    ///
    /// # Errors
    /// When its section has no exact field here.
    fn of(run: &Finished) -> Result<Self, LabError> {
        let value = |place: &str| number(run, &format!("/bodies/0/shape/{place}"));
        let shape = &run.scene["bodies"][0]["shape"];
        let (middle, section) = if shape["disc"].is_object() {
            let middle = [value("disc/centre_m/0")?, value("disc/centre_m/1")?];
            (middle, Section::Round(value("disc/radius_m")?))
        } else if shape["box"].is_object() {
            let low = [value("box/min_m/0")?, value("box/min_m/1")?];
            let high = [value("box/max_m/0")?, value("box/max_m/1")?];
            let half = [0, 1].map(|k| 0.5 * (high[k] - low[k]));
            let middle = [0, 1].map(|k| 0.5 * (high[k] + low[k]));
            (middle, Section::Rectangle(half))
        } else {
            let outer = value("difference/0/cylinder/radius_m")?;
            let inner = value("difference/1/cylinder/radius_m")?;
            let height = value("difference/0/cylinder/centre_m/2")?;
            let length = value("difference/0/cylinder/length_m")?;
            let half = [0.5 * (outer - inner), 0.5 * length];
            ([0.5 * (outer + inner), height], Section::Rectangle(half))
        };
        let current = number(run, "/eddy_currents/coils/0/region/current_a")?;
        Ok(Self {
            middle,
            section,
            current,
        })
    }

    /// Half of the greatest width of the section \[m\].
    fn size(&self) -> f64 {
        match self.section {
            Section::Round(radius) => radius,
            Section::Rectangle(half) => greater(half[0], half[1]),
        }
    }

    /// Flux density away from and along the axis \[T\].
    fn flux(&self, parts: &[([f64; 2], f64)], [rho, z]: [f64; 2]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for ([out, up], share) in parts {
            let part = ring(self.middle[0] + out, rho, z - self.middle[1] - up);
            for k in 0..2 {
                sum[k] += self.current * share * part[k];
            }
        }
        sum
    }
}

fn errors(run: &Finished, points: &Points) -> Result<Errors, LabError> {
    let coil = Ring::of(run)?;
    let section = parts(coil.section);
    let scale = coil.current.abs() * ring(coil.middle[0], 0.0, 0.0)[1];
    let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
    let probes = reader.record("/probes")?;
    let (mut axis, mut flux) = (0.0, 0.0);
    for probe in run.scene["output"]["probes"]
        .as_array()
        .into_iter()
        .flatten()
    {
        let name = probe["name"].as_str().unwrap_or_default();
        let place = probe["place_m"].as_array().and_then(|p| p.last()?.as_f64());
        let found = probes.get(&format!("{name}.magnetic_flux_density_real_z"))?;
        let wanted = coil.flux(&section, [0.0, place.unwrap_or(f64::NAN)])[1];
        axis = greater(axis, (found - wanted).abs() / scale);
    }
    let each = if points.position.len() > 20_000 {
        EACH
    } else {
        1
    };
    let found = points.phasors("magnetic_flux_density")?;
    for (p, b) in points.position.iter().zip(&found).step_by(each) {
        let rho = p[0].hypot(p[1]);
        if (rho - coil.middle[0]).hypot(p[2] - coil.middle[1]) < 2.0 * coil.size() {
            continue;
        }
        let [away, along] = coil.flux(&section, [rho, p[2]]);
        let share = |k: usize| if rho > 0.0 { p[k] / rho } else { 0.0 };
        let wanted = [away * share(0), away * share(1), along];
        let far = (0..3).map(|k| (b[k] - wanted[k]).norm_sqr()).sum::<f64>();
        flux = greater(flux, far.sqrt() / scale);
    }
    Ok(Errors::from([
        ("axis_linf".to_owned(), axis),
        ("flux_linf".to_owned(), flux),
    ]))
}
