//! `dem-contact`: impacts of two equal grains, of two of the ratio 1 to 3, and on a wall.

use artefact::Frame;
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{Swing, fault, frames, mass};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::number;

/// The case.
pub(super) struct DemContact;

/// Places within a step at which impacts begin; the worst of them is told.
const BEGINNINGS: usize = 8;
/// Overlap of a hard impact over the lesser radius.
const DEEP: f64 = 0.02;
/// Laws that are tried beside that of the scene.
const METHODS: [&str; 7] = [
    "scene",
    "hard",
    "stiff",
    "inelastic",
    "elastic",
    "ends-at-zero-overlap",
    "hertz",
];

impl Case for DemContact {
    fn name(&self) -> &'static str {
        "dem-contact"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "a damped swing, Schwager and Poeschel (2007); Hertz (1881), Antypov and Elliott (2011)"
    }

    fn methods(&self) -> &'static [&'static str] {
        &METHODS
    }

    fn targets(&self) -> Vec<Target> {
        let within = |method: &&'static str| {
            let quantities = ["restitution", "duration", "overlap"];
            quantities.map(|q| Target::error(q, 0.01).at_level(2).of(*method))
        };
        let mut targets: Vec<Target> = METHODS.iter().flat_map(within).collect();
        let order = |method: &str, order| {
            Target::order("restitution", order)
                .or_error_below(1e-5)
                .of(method)
        };
        targets.extend(METHODS[..5].iter().map(|method| order(method, 1.8)));
        targets.push(order("ends-at-zero-overlap", 1.5));
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let steps = 25.0 * f64::from(1 << (level.clamp(1, 6) - 1));
        let law = patch_of(method);
        let label = |kind: &str| format!("{method}-{kind}-level{level}");
        let scene = lab.run("poolsph", self.name(), &label("scene"), &law)?;
        let contact = Exact::of(&scene)?;
        let mut errors = Errors::new();
        let mut runs = Vec::new();
        for (kind, pair) in contact.pairs() {
            let patch = contact.impacts(pair, steps);
            let run = lab.varied(&scene, &label(kind), &patch)?;
            for (name, error) in contact.errors(&run, pair)? {
                let worst = errors.entry(name.to_owned()).or_insert(0.0);
                *worst = worst.max(error);
            }
            runs.push(run);
        }
        // The way of a grain in a step: errors are those of the step.
        let [speed, duration, _] = contact.impact(Pair { ratio: Some(1.0) });
        let way = speed * duration / steps;
        Ok(Measurement::over(runs, steps as u64, way, errors))
    }
}

/// What a method changes of the scene.
fn patch_of(method: &str) -> Value {
    let contact = match method {
        "hard" => json!({"law": {"linear": {"stiffness_n_m": 1e4}}}),
        "stiff" => json!({"law": {"linear": {"stiffness_n_m": 1e7}}, "restitution": 0.3}),
        "inelastic" => json!({"restitution": 0.05}),
        "elastic" => json!({"restitution": 1.0}),
        "ends-at-zero-overlap" => json!({"restitution": 0.05, "ending": "zero_overlap"}),
        "hertz" => json!({
            "law": {"linear": null, "hertz": {"youngs_modulus_pa": 1e9, "poisson_ratio": 0.25}},
            "restitution": 1.0
        }),
        _ => json!({}),
    };
    json!({"grains": {"contact": contact}})
}

/// Two grains, or a grain and a wall.
#[derive(Debug, Clone, Copy)]
struct Pair {
    /// Radius of the other grain over that of the first; none for a wall.
    ratio: Option<f64>,
}

/// What the scene says of impacts.
struct Exact {
    radius: f64,
    density: f64,
    /// Spring \[N/m\], or effective modulus \[Pa\].
    spring: Option<f64>,
    modulus: f64,
    e: f64,
    swing: Swing,
}

impl Exact {
    fn of(run: &Finished) -> Result<Self, LabError> {
        let at = |key: &str| number(run, &format!("/grains/{key}"));
        let e = at("contact/restitution")?;
        let ending = run.scene.pointer("/grains/contact/ending");
        let at_zero_force = ending.and_then(Value::as_str) != Some("zero_overlap");
        let spring = at("contact/law/linear/stiffness_n_m").ok();
        let modulus = match spring {
            Some(_) => 0.0,
            None => {
                let nu = at("contact/law/hertz/poisson_ratio")?;
                0.5 * at("contact/law/hertz/youngs_modulus_pa")? / (1.0 - nu * nu)
            }
        };
        Ok(Self {
            radius: at("bodies/0/radius_m")?,
            density: at("density_kg_m3")?,
            spring,
            modulus,
            e,
            swing: Swing::of(e, at_zero_force),
        })
    }

    fn pairs(&self) -> [(&'static str, Pair); 3] {
        [
            ("equal", Pair { ratio: Some(1.0) }),
            ("unequal", Pair { ratio: Some(3.0) }),
            ("wall", Pair { ratio: None }),
        ]
    }

    /// Speed \[m/s\], duration \[s\] and greatest overlap \[m\].
    fn impact(&self, pair: Pair) -> [f64; 3] {
        let own = mass(self.density, self.radius);
        let (m, r) = match pair.ratio {
            Some(ratio) => {
                let other = mass(self.density, ratio * self.radius);
                (
                    own * other / (own + other),
                    self.radius * ratio / (1.0 + ratio),
                )
            }
            None => (own, self.radius),
        };
        let deep = DEEP * self.radius;
        match self.spring {
            Some(k) => {
                let omega = (k / m).sqrt();
                let speed = deep * omega;
                [
                    speed,
                    self.swing.duration() / omega,
                    self.swing.deepest() * deep,
                ]
            }
            None => {
                let speed = (deep.powf(2.5) * 16.0 * self.modulus * r.sqrt() / (15.0 * m)).sqrt();
                [speed, 2.943_275 * deep / speed, deep]
            }
        }
    }

    /// Impacts that begin at different parts of a step, `steps` in each, as a patch.
    fn impacts(&self, pair: Pair, steps: f64) -> Value {
        let [speed, duration, _] = self.impact(pair);
        let (step, r) = (duration / steps, self.radius);
        let mut bodies = Vec::new();
        for n in 0..BEGINNINGS {
            let gap = (n as f64 + 0.37) / BEGINNINGS as f64 * step * speed;
            let y = 10.0 * r * n as f64;
            let body = |x: f64, radius: f64, speed: f64| json!({"places_m": [[x, y, 0.0]], "radius_m": radius, "velocity_m_s": [speed, 0.0, 0.0]});
            bodies.push(body(-r - gap, r, speed));
            if let Some(ratio) = pair.ratio {
                bodies.push(body(ratio * r, ratio * r, 0.0));
            }
        }
        let wall = json!({"shape": {"half_space": {"point_m": [0, 0, 0], "normal": [-1, 0, 0]}}});
        let walls = if pair.ratio.is_some() {
            json!([])
        } else {
            json!([wall])
        };
        json!({
            "time": {"step_s": step, "end_s": (1.5 * steps).round() * step},
            "grains": {"bodies": bodies, "walls": walls, "steps_per_contact": 5},
            "output": {"particles_interval_s": step}
        })
    }

    fn errors(&self, run: &Finished, pair: Pair) -> Result<Vec<(&'static str, f64)>, LabError> {
        let frames = frames(&run.artefact)?;
        let [speed, duration, deep] = self.impact(pair);
        let each = if pair.ratio.is_some() { 2 } else { 1 };
        let mut worst = [0.0_f64; 3];
        for n in 0..BEGINNINGS {
            let seen = Seen::read(&frames, n * each, pair.ratio.map(|_| n * each + 1))?;
            let found = seen.impact(speed, self.swing_ends_at_force());
            let found = found.ok_or_else(|| fault(run, "ends before the impact does"))?;
            let errors = [
                (found[0] - self.e) / self.e,
                found[1] / duration - 1.0,
                found[2] / deep - 1.0,
            ];
            for (worst, error) in worst.iter_mut().zip(errors) {
                *worst = worst.max(error.abs());
            }
        }
        let names = ["restitution", "duration", "overlap"];
        Ok(names.into_iter().zip(worst).collect())
    }

    fn swing_ends_at_force(&self) -> bool {
        self.spring.is_some() && self.swing.ends_at_force()
    }
}

/// One impact as frames show it.
struct Seen {
    time: Vec<f64>,
    /// Below zero while they are apart \[m\].
    overlap: Vec<f64>,
    /// Speed of parting \[m/s\].
    parting: Vec<f64>,
    /// Push on the first grain, back \[N\].
    push: Vec<f64>,
}

impl Seen {
    fn read(frames: &[Frame], a: usize, b: Option<usize>) -> Result<Self, LabError> {
        let mut seen = Self {
            time: Vec::new(),
            overlap: Vec::new(),
            parting: Vec::new(),
            push: Vec::new(),
        };
        for frame in frames {
            let (x, u) = (frame.position_vectors()?, frame.vectors("velocity")?);
            let radius = frame.f64("radius")?;
            let other = b.map_or([0.0; 3], |b| [x[b][0], u[b][0], radius[b]]);
            seen.time.push(frame.time_s);
            seen.overlap
                .push(radius[a] + other[2] - (other[0] - x[a][0]));
            seen.parting.push(other[1] - u[a][0]);
            seen.push.push(-frame.vectors("force")?[a][0]);
        }
        Ok(seen)
    }

    /// Restitution, duration and greatest overlap of an impact at `speed`.
    fn impact(&self, speed: f64, ends_at_force: bool) -> Option<[f64; 3]> {
        let last = self.time.len() - 1;
        let ended = self.parting[last] > 0.0 && self.push[last].abs() <= f64::MIN_POSITIVE;
        if !ended {
            return None;
        }
        // Both ends lie on straight parts of the way.
        let begin = self.time[0] - self.overlap[0] / speed;
        let end = if ends_at_force {
            let k = self.push.iter().rposition(|push| *push > 0.0)?;
            let [before, push] = [self.push[k - 1], self.push[k]];
            let fall = (before - push) / (self.time[k] - self.time[k - 1]);
            self.time[k] + push / fall
        } else {
            self.time[last] + self.overlap[last] / self.parting[last]
        };
        let top = (1..last).max_by(|a, b| self.overlap[*a].total_cmp(&self.overlap[*b]))?;
        let [a, b, c] = [top - 1, top, top + 1].map(|k| self.overlap[k]);
        let deepest = b + (a - c).powi(2) / (8.0 * (2.0 * b - a - c)).max(f64::MIN_POSITIVE);
        Some([self.parting[last] / speed, end - begin, deepest])
    }
}
