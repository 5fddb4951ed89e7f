//! Droplets from the wire: born at a height, falling at one speed, part of the pool once they reach it.
//!
//! A droplet is the lattice of spacing d within a radius around its centre, 19 particles for
//! 0.75 mm and d = 0.5 mm in layers of 5, 9 and 5 (Komen 2019, section 4.3, fig. 4.9). In flight
//! it keeps its temperature and meets nobody. It joins the liquid when a particle of it comes
//! within the support of the kernel of anything that does not fly; before the flow has started,
//! where it would touch, and rests there.
//!
//! Print gives a droplet every 0.1 s and means 10 ms; 19 particles of volume d^3 carry the volume of
//! the wire feed with a longer period. Lattices of other spacings hold other volumes within the radius, so that a scene
//! best says the feed, and droplets come as often as they carry it.
//!
//! Where the source goes along a mirror plane, half of each droplet is born. Its layers stand half a spacing and more from the plane, so
//! that with their images they are a droplet whose lattice the plane halves. The feed of the scene is that of the whole wire.

use std::sync::Arc;

use neighbours::Grid;
use particles::{Matter, POSITION};
use run::Fault;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::heat::Caloric;
use crate::heat::ledger::Sum;
use crate::stage::{Figure, Stage, StageError};
use crate::state::{DROPLET, PHASE, Particle, State, VELOCITY, phase};

/// Part of a spacing that a droplet falls in a step when it lands, where steps are adaptive.
const FALL: f64 = 0.4;
/// Part of a period by which a droplet may be early, for the rounding of times.
const EARLY: f64 = 1e-6;

/// Droplets from the wire (key `droplets`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Time between two droplets \[s\]; the first is born at time 0. Where it is absent, `feed_m3_s` decides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub period_s: Option<f64>,
    /// Volume of wire that melts in a second \[m3/s\]: droplets come as often as they carry it, however many particles
    /// they are at the spacing. Left aside where there is `period_s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "m3/s", "exclusiveMinimum" = 0.0))]
    pub feed_m3_s: Option<f64>,
    /// Lattice points within this radius make a droplet \[m\].
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub radius_m: f64,
    /// Height of its centre above the source at birth \[m\].
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub height_m: f64,
    /// Speed of its fall \[m/s\].
    #[schemars(extend("x-unit" = "m/s", "exclusiveMinimum" = 0.0))]
    pub speed_m_s: f64,
    /// Temperature until it reaches the pool \[K\]; needed where the scene has heat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "K", "exclusiveMinimum" = 0.0))]
    pub temperature_k: Option<f64>,
}

impl Parameters {
    /// Time between two droplets of particles of the spacing \[m\] \[s\]: T = N d^3 / V', N particles each, V' the feed; half of
    /// each side of a mirror.
    #[must_use]
    pub fn period(&self, spacing: f64, mirror: Option<Mirror>) -> Option<f64> {
        let sides = if mirror.is_some() { 2.0 } else { 1.0 };
        let volume =
            || sides * shape(self.radius_m, spacing, mirror).len() as f64 * spacing.powi(3);
        self.period_s
            .or_else(|| self.feed_m3_s.map(|feed| volume() / feed))
    }

    /// The mirror plane that halves droplets of a source that starts at a place \[m\], among mirrors by axis, whether the
    /// metal is below the plane, and place \[m\].
    ///
    /// # Errors
    /// A mirror that a droplet would reach through, and more than one that halves it.
    pub fn mirror(
        &self,
        start: [f64; 3],
        velocity: [f64; 3],
        mirrors: &[(Mirror, f64)],
    ) -> Result<Option<Mirror>, Fault> {
        let mut halves = None;
        for (mirror, plane) in mirrors.iter().filter(|(mirror, _)| mirror.axis < 2) {
            let off = (start[mirror.axis] - plane).abs();
            let along = velocity[mirror.axis].abs() <= f64::MIN_POSITIVE;
            let on = off <= 1e-6 * self.radius_m && along;
            if on && halves.is_none() {
                halves = Some(*mirror);
            } else if on || (off < self.radius_m && along) {
                let what = format!(
                    "{off} m from the axis of the droplets, of the radius {} m: a mirror halves them or is out of their reach",
                    self.radius_m
                );
                return Err(Fault::at("/faces/mirror", what));
            }
        }
        Ok(halves)
    }
}

/// A mirror plane by its axis, and on which side of it the metal is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mirror {
    /// Number of the axis across it.
    pub axis: usize,
    /// Whether the metal lies towards lesser values.
    pub below: bool,
}

/// The stage that makes and moves droplets.
pub struct Droplets {
    parameters: Parameters,
    /// Time between two \[s\].
    period: f64,
    /// Places of the particles about the centre \[m\].
    shape: Vec<[f64; 3]>,
    temperature: f64,
    enthalpy: f64,
    mass: f64,
    born: u64,
    energy: Sum,
    flying: Vec<usize>,
}

/// Lattice points of spacing `d` within `radius` of the origin, layer by layer from below; of a droplet that a mirror halves, those on
/// the side of the metal.
#[must_use]
pub fn shape(radius: f64, d: f64, mirror: Option<Mirror>) -> Vec<[f64; 3]> {
    let n = (radius / d + 1e-9).floor() as i64 + 1;
    let mut points = Vec::new();
    for k in -n..=n {
        for j in -n..=n {
            for i in -n..=n {
                let mut point = [i, j, k].map(|c| c as f64 * d);
                if let Some(Mirror { axis, below }) = mirror {
                    point[axis] += 0.5 * d;
                    if (point[axis] > 0.0) == below {
                        continue;
                    }
                }
                let square: f64 = point.iter().map(|x| x * x).sum();
                if square <= radius * radius * (1.0 + 1e-9) {
                    points.push(point);
                }
            }
        }
    }
    points
}

impl Droplets {
    /// Droplets of `metal`; `caloric` where the scene has heat.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn new(
        parameters: Parameters,
        (metal, mirror): (Matter, Option<Mirror>),
        caloric: Option<&Arc<Caloric>>,
    ) -> Result<Self, Fault> {
        let Some(period) = parameters.period(metal.spacing, mirror) else {
            let what = "has neither 'period_s' in s nor 'feed_m3_s' in m3/s, which say how often droplets come";
            return Err(Fault::at("", what));
        };
        let shape = shape(parameters.radius_m, metal.spacing, mirror);
        let (temperature, enthalpy) = match (parameters.temperature_k, caloric) {
            (_, None) => (0.0, 0.0),
            (None, Some(_)) => {
                let what = "has no key 'temperature_k' in K, which a scene with heat needs";
                return Err(Fault::at("", what));
            }
            (Some(t), Some(caloric)) if caloric.covers(t) => {
                let enthalpy = caloric.enthalpy(t);
                if caloric.melting_point().is_some() && !caloric.is_liquid(enthalpy) {
                    return Err(Fault::at("/temperature_k", format!("{t} K is not liquid")));
                }
                (t, enthalpy)
            }
            (Some(t), Some(caloric)) => {
                let (from, to) = caloric.range();
                let what = format!("{t} K is outside of the properties, {from} K to {to} K");
                return Err(Fault::at("/temperature_k", what));
            }
        };
        Ok(Self {
            parameters,
            period,
            shape,
            temperature,
            enthalpy,
            mass: metal.mass(),
            born: 0,
            energy: Sum::default(),
            flying: Vec::new(),
        })
    }

    /// Particles of a droplet.
    #[must_use]
    pub fn particles(&self) -> usize {
        self.shape.len()
    }

    /// Number of droplets born until the time \[s\], its own moment included.
    fn due(&self, time: f64) -> u64 {
        // A millionth of a period decides, not the rounding of the time.
        (time / self.period + EARLY).floor() as u64 + 1
    }

    fn bear(&mut self, state: &mut State, axis: [f64; 3]) {
        let centre = [axis[0], axis[1], axis[2] + self.parameters.height_m];
        for offset in &self.shape {
            self.flying.push(state.len());
            state.push(Particle {
                position: [0, 1, 2].map(|k| centre[k] + offset[k]),
                velocity: [0.0, 0.0, -self.parameters.speed_m_s],
                phase: phase::FLYING,
                droplet: true,
                wall: false,
                temperature: self.temperature,
                enthalpy: self.enthalpy,
            });
            self.energy.add(self.mass * self.enthalpy);
        }
        self.born += 1;
    }

    /// Droplets that have come near what does not fly join it; `fall` is the way of the step \[m\].
    fn land(&mut self, state: &mut State, fall: f64) {
        let reach = if state.flowing {
            state.metal.matter.support()
        } else {
            state.metal.matter.spacing
        };
        let Some(ground) = Ground::below(state, &self.flying, reach) else {
            return;
        };
        let mut flying = Vec::with_capacity(self.flying.len());
        for droplet in self.flying.chunks(self.shape.len()) {
            if !ground.touches(state, droplet, 0.0) {
                flying.extend_from_slice(droplet);
                continue;
            }
            // One that comes to rest goes back to where it touches and does not dig in.
            let back = if state.flowing {
                0.0
            } else {
                ground.back(state, droplet, fall)
            };
            let (phases, places, velocities) =
                (state.metal).columns_mut((&PHASE, &POSITION, &VELOCITY));
            for &a in droplet {
                phases[a] = phase::LIQUID;
                places[a][2] += back;
                if !state.flowing {
                    velocities[a] = [0.0; 3];
                }
            }
        }
        self.flying = flying;
    }
}

/// What a droplet may land on.
struct Ground {
    grid: Grid,
    reach: f64,
}

impl Ground {
    /// All that does not fly, up to `reach` \[m\] below the lowest of `flying`; `None` without either.
    fn below(state: &State, flying: &[usize], reach: f64) -> Option<Self> {
        let (places, phases) = (state.metal.column(&POSITION), state.metal.column(&PHASE));
        let heights = flying.iter().map(|a| places[*a][2]);
        let lowest = heights.reduce(f64::min)?;
        let high =
            |(x, phase): &(&[f64; 3], &u8)| **phase != phase::FLYING && x[2] > lowest - reach;
        let places = places.iter().zip(phases).filter(high);
        let places: Vec<[f64; 3]> = places.map(|(x, _)| *x).collect();
        if places.is_empty() {
            return None;
        }
        let mut grid = Grid::new(reach);
        grid.bin(&places);
        Some(Self { grid, reach })
    }

    /// Whether the droplet, lifted by `lift` \[m\], is within reach.
    fn touches(&self, state: &State, droplet: &[usize], lift: f64) -> bool {
        let places = state.metal.column(&POSITION);
        droplet.iter().any(|a| {
            let [x, y, z] = places[*a];
            self.grid.any_within([x, y, z + lift], self.reach)
        })
    }

    /// The least lift of at most `fall` \[m\], to a thousandth of it, that ends the touch.
    fn back(&self, state: &State, droplet: &[usize], fall: f64) -> f64 {
        let (mut inside, mut clear) = (0.0, fall);
        while clear - inside > 1e-3 * fall {
            let middle = 0.5 * (inside + clear);
            if self.touches(state, droplet, middle) {
                inside = middle;
            } else {
                clear = middle;
            }
        }
        clear
    }
}

impl Stage for Droplets {
    fn name(&self) -> &'static str {
        "droplets"
    }

    fn declare(&self, state: &mut State) {
        state.metal.declare(&DROPLET);
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let Some(mut place) = state.source else {
            return Err(StageError::Data("droplets fall from no source".to_owned()));
        };
        let fall = self.parameters.speed_m_s * dt;
        let places = state.metal.column_mut(&POSITION);
        for &a in &self.flying {
            places[a][2] -= fall;
        }
        self.land(state, fall);
        // The end of the step is what frames show.
        let end = state.end(dt);
        let due = self.due(end);
        while self.born < due {
            self.bear(state, place.position);
        }
        let turns = end / self.period;
        place.phase = (turns - (due - 1) as f64).clamp(0.0, 1.0);
        place.droplets = self.born;
        state.source = Some(place);
        Ok(())
    }

    fn follows(&self, state: &State) -> f64 {
        let (places, phases) = (state.metal.column(&POSITION), state.metal.column(&PHASE));
        let height = |a: usize| places[a][2];
        let Some(lowest) = self.flying.iter().map(|a| height(*a)).reduce(f64::min) else {
            return f64::INFINITY;
        };
        // Down to where it may meet something it falls freely.
        let rests = (0..state.len()).filter(|a| phases[*a] != phase::FLYING);
        let top = rests.map(height).fold(f64::NEG_INFINITY, f64::max);
        let free = lowest - top - state.metal.matter.support();
        free.max(FALL * state.metal.matter.spacing) / self.parameters.speed_m_s
    }

    fn next(&self, _: f64) -> Option<f64> {
        Some((self.born as f64 - EARLY) * self.period)
    }

    fn figures(&self) -> Vec<Figure> {
        vec![
            Figure {
                name: "droplets",
                unit: "1",
                value: self.born as f64,
            },
            Figure {
                name: "energy_in_droplets_j",
                unit: "J",
                value: self.energy.value(),
            },
        ]
    }

    fn save(&self) -> Vec<f64> {
        let [total, lost] = self.energy.save();
        let mut saved = vec![self.born as f64, total, lost];
        saved.extend(self.flying.iter().map(|a| *a as f64));
        saved
    }

    fn restore(&mut self, saved: &[f64]) {
        let [born, energy @ ..] = saved else { return };
        self.born = *born as u64;
        self.energy = Sum::restored(energy);
        self.flying = saved.iter().skip(3).map(|a| *a as usize).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Place;

    const METAL: Matter = Matter {
        density: 7850.0,
        spacing: 5e-4,
        smoothing_length: 5e-4,
    };

    fn parameters() -> Parameters {
        Parameters {
            period_s: Some(1e-2),
            feed_m3_s: None,
            radius_m: 0.75e-3,
            height_m: 5e-3,
            speed_m_s: 1.56,
            temperature_k: None,
        }
    }

    fn start() -> State {
        let mut state = State::new(METAL);
        state.metal.declare(&DROPLET);
        state.flowing = true;
        state.source = Some(Place {
            position: [0.0; 3],
            phase: 0.0,
            droplets: 0,
        });
        for i in -4..=4 {
            for j in -4..=4 {
                state.push(Particle {
                    position: [f64::from(i) * 5e-4, f64::from(j) * 5e-4, -2.5e-4],
                    velocity: [0.0; 3],
                    phase: phase::SOLID,
                    droplet: false,
                    wall: false,
                    temperature: 0.0,
                    enthalpy: 0.0,
                });
            }
        }
        state
    }

    fn march(stage: &mut Droplets, state: &mut State, steps: u64) {
        for _ in 0..steps {
            stage.advance(state, 1e-4).unwrap();
            state.step += 1;
        }
    }

    #[test]
    fn a_droplet_has_layers_of_five_nine_and_five() {
        let shape = shape(0.75e-3, 5e-4, None);
        let layer = |z: f64| shape.iter().filter(|p| (p[2] - z).abs() < 1e-9).count();
        assert_eq!([layer(-5e-4), layer(0.0), layer(5e-4)], [5, 9, 5]);
        assert_eq!(shape.len(), 19);
    }

    #[test]
    fn droplets_come_in_time_and_land_with_their_speed() {
        let mut state = start();
        let mut stage = Droplets::new(parameters(), (METAL, None), None).unwrap();
        march(&mut stage, &mut state, 20);
        let first = 81;
        assert!(
            state.metal.column(&PHASE)[first..]
                .iter()
                .all(|p| *p == phase::FLYING)
        );
        // 5 mm less the half droplet, the support and the half particle, at 1.56 m/s.
        march(&mut stage, &mut state, 10);
        assert!(
            state.metal.column(&PHASE)[first..]
                .iter()
                .all(|p| *p == phase::LIQUID)
        );
        assert!((state.metal.column(&VELOCITY)[first][2] + 1.56).abs() < 1e-15);
        march(&mut stage, &mut state, 970);
        // Born at the first of the steps 1, 100, 200, ... of 1000.
        assert_eq!(state.source.unwrap().droplets, 11);
        assert_eq!(
            state.metal.column(&DROPLET).iter().filter(|d| **d).count(),
            11 * 19
        );
        assert!(state.source.unwrap().phase.abs() < 1e-9);
    }

    #[test]
    fn droplets_of_any_spacing_carry_the_feed() {
        let feed = 1.49e-7;
        let parameters = Parameters {
            period_s: None,
            feed_m3_s: Some(feed),
            ..parameters()
        };
        for spacing in [1e-3, 7e-4, 5e-4, 4e-4, 2.5e-4] {
            let metal = Matter {
                spacing,
                smoothing_length: spacing,
                ..METAL
            };
            let stage = Droplets::new(parameters, (metal, None), None).unwrap();
            let volume = stage.particles() as f64 * spacing.powi(3);
            let supplied = stage.due(10.0) as f64 * volume;
            assert!((supplied - 10.0 * feed).abs() < 1.001 * volume, "{spacing}");
        }
        // A period goes before.
        assert_eq!(
            Parameters {
                period_s: Some(0.02),
                ..parameters
            }
            .period(5e-4, None),
            Some(0.02)
        );
        let silent = Parameters {
            feed_m3_s: None,
            ..parameters
        };
        let fault = Droplets::new(silent, (METAL, None), None).err().unwrap();
        assert!(fault.to_string().contains("feed_m3_s"), "{fault}");
    }

    #[test]
    fn half_droplets_and_their_images_carry_the_feed() {
        let feed = 1.05e-7;
        let parameters = Parameters {
            period_s: None,
            feed_m3_s: Some(feed),
            radius_m: 1.25e-3,
            ..parameters()
        };
        for (axis, below) in [(0, false), (0, true), (1, false)] {
            let mirror = Mirror { axis, below };
            let half = shape(1.25e-3, 5e-4, Some(mirror));
            // Two halves are nearly the droplet of a ball, and none is on the plane.
            let ball = 4.0 / 3.0 * std::f64::consts::PI * 1.25e-3_f64.powi(3);
            let both = 2.0 * half.len() as f64 * 5e-4_f64.powi(3);
            assert!((both / ball - 1.0).abs() < 0.15, "{}", both / ball);
            let side = if below { -1.0 } else { 1.0 };
            assert!(half.iter().all(|x| side * x[axis] > 2.4e-4));
            let stage = Droplets::new(parameters, (METAL, Some(mirror)), None).unwrap();
            let supplied = stage.due(10.0) as f64 * both;
            assert!((supplied - 10.0 * feed).abs() < 1.001 * both);
        }
    }

    #[test]
    fn a_mirror_halves_droplets_on_it_and_may_not_cut_others() {
        let mirror = Mirror {
            axis: 0,
            below: false,
        };
        let of = |start: [f64; 3], velocity: [f64; 3]| {
            parameters().mirror(start, velocity, &[(mirror, 0.0)])
        };
        let along = [0.0, 5e-3, 0.0];
        assert_eq!(of([0.0; 3], along).unwrap(), Some(mirror));
        assert_eq!(of([1e-3, 0.0, 0.0], along).unwrap(), None);
        let cut = of([5e-4, 0.0, 0.0], along).err().unwrap();
        assert!(cut.to_string().contains("mirror"), "{cut}");
    }

    #[test]
    fn phases_run_from_birth_to_birth() {
        let mut state = start();
        let mut stage = Droplets::new(parameters(), (METAL, None), None).unwrap();
        for step in 1..=250_u64 {
            march(&mut stage, &mut state, 1);
            let place = state.source.unwrap();
            let expected = (step % 100) as f64 / 100.0;
            assert!(
                (place.phase - expected).abs() < 1e-9,
                "{step}: {}",
                place.phase
            );
        }
    }

    #[test]
    fn before_the_flow_a_droplet_comes_to_rest_where_it_touches() {
        let mut state = start();
        state.flowing = false;
        let mut stage = Droplets::new(parameters(), (METAL, None), None).unwrap();
        march(&mut stage, &mut state, 60);
        let lowest = state.metal.column(&POSITION)[81..]
            .iter()
            .map(|p| p[2])
            .fold(f64::MAX, f64::min);
        assert!(
            state.metal.column(&PHASE)[81..]
                .iter()
                .all(|p| *p == phase::LIQUID)
        );
        // The bottom layer of five stands over lattice places 2.5e-4 m below the plate's face.
        assert!((lowest - 2.5e-4).abs() < 1e-6, "{lowest}");
        assert!(
            state.metal.column(&VELOCITY)[81]
                .iter()
                .all(|u| u.abs() < 1e-15)
        );
    }

    #[test]
    fn a_restored_stage_goes_on_alike() {
        let (mut state, mut stage) = (
            start(),
            Droplets::new(parameters(), (METAL, None), None).unwrap(),
        );
        march(&mut stage, &mut state, 115);
        let mut again = Droplets::new(parameters(), (METAL, None), None).unwrap();
        again.restore(&stage.save());
        let mut copy = state.clone();
        march(&mut stage, &mut state, 200);
        march(&mut again, &mut copy, 200);
        assert_eq!(state.metal.column(&POSITION), copy.metal.column(&POSITION));
        assert_eq!(state.metal.column(&PHASE), copy.metal.column(&PHASE));
    }
}
