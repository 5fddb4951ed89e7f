//! Bodies of the scene become particles.

use std::collections::HashMap;

use run::Fault;
use run::property::{Arguments, Curve};
use shapes::frame::{difference, dot, squared};

use super::round::Round;
use super::shape::{Shape, edge};
use crate::heat::{Caloric, Substances};
use crate::state::slag::SLAG;
use crate::state::{Particle, State, phase};

/// A later body comes no closer to an earlier one than this part of d.
pub const CLEARANCE: f64 = 0.7;

/// A plane that cuts a body: kept is where (x - point) . normal <= 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cut {
    /// A point of the plane \[m\].
    pub point: [f64; 3],
    /// Direction of what is cut off; any length.
    pub normal: [f64; 3],
}

impl Cut {
    /// How far beyond the plane a place is \[m\].
    fn beyond(&self, place: [f64; 3]) -> f64 {
        // Of a normal of any length, without overflow.
        let most = self
            .normal
            .iter()
            .fold(0.0_f64, |most, n| most.max(n.abs()));
        let normal = self.normal.map(|n| n / most);
        dot(difference(place, self.point), normal) / squared(normal).sqrt()
    }
}

/// A body ready to be filled.
#[derive(Debug, Clone)]
pub struct Body {
    /// Its shape.
    pub shape: Shape,
    /// Spacings of its lattice along the axes \[m\].
    pub pitch: [f64; 3],
    /// Origin of its lattice \[m\]; the lower corner of its box by default.
    pub lattice: Option<[f64; 3]>,
    /// How the lattice of a round body lies.
    pub round: Round,
    /// Planes that cut it.
    pub cuts: Vec<Cut>,
    /// Solid or liquid at the start.
    pub phase: u8,
    /// Belongs to the container.
    pub wall: bool,
    /// Slag, not metal.
    pub slag: bool,
    /// u at the start \[m/s\] over x, y, z, r.
    pub velocity: [Curve; 3],
    /// T at the start \[K\] over x, y, z, r.
    pub temperature: Curve,
    /// T that it keeps \[K\] over x, y, z, r, t.
    pub held: Option<Curve>,
}

/// How a body came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Filled {
    /// Particles placed.
    pub placed: usize,
    /// Lattice points left out because an earlier body is there.
    pub left_out: usize,
}

/// Places of particles by cells, to find whether one is near.
#[derive(Debug)]
struct Occupied {
    edge: f64,
    cells: HashMap<[i64; 3], Vec<[f64; 3]>>,
}

impl Occupied {
    fn cell(&self, p: [f64; 3]) -> [i64; 3] {
        p.map(|x| (x / self.edge).floor() as i64)
    }

    fn insert(&mut self, p: [f64; 3]) {
        self.cells.entry(self.cell(p)).or_default().push(p);
    }

    /// Whether a particle stands closer to `p` than the edge of a cell.
    fn near(&self, p: [f64; 3]) -> bool {
        let centre = self.cell(p);
        (0..27).any(|k| {
            let cell = [
                centre[0] + k % 3 - 1,
                centre[1] + k / 3 % 3 - 1,
                centre[2] + k / 9 - 1,
            ];
            self.cells.get(&cell).is_some_and(|places| {
                places.iter().any(|q| {
                    let square: f64 = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum();
                    square < self.edge * self.edge
                })
            })
        })
    }
}

/// Fills `bodies` in order; what they are `made` of gives their enthalpy, and is absent where the scene has no
/// heat. Body `i` gets the particles that follow those of the bodies before it.
///
/// # Errors
/// A fault at the temperature of the body that does not fit the metal.
pub fn fill(
    state: &mut State,
    bodies: &[Body],
    made: Option<&Substances>,
) -> Result<Vec<Filled>, Fault> {
    let d = state.metal.matter.spacing;
    let mut occupied = Occupied {
        edge: CLEARANCE * d,
        cells: HashMap::new(),
    };
    let mut earlier = Vec::with_capacity(bodies.len());
    let mut filled = Vec::with_capacity(bodies.len());
    for (i, body) in bodies.iter().enumerate() {
        let points = body_points(body);
        let caloric = made.map(|made| made.which(body.slag).caloric.as_ref());
        // The particles of an earlier body may leave room between them; a later one has no place there.
        let (kept, crowded): (Vec<_>, Vec<_>) = points
            .into_iter()
            .partition(|p| !occupied.near(*p) && !within(&earlier, *p));
        for &position in &kept {
            let (temperature, enthalpy) = warmth(body, position, caloric)
                .map_err(|what| Fault::at(&format!("/bodies/{i}/temperature_k"), what))?;
            let velocity = speed(body, position)
                .map_err(|what| Fault::at(&format!("/bodies/{i}/velocity_m_s"), what))?;
            state.push(Particle {
                position,
                velocity,
                phase: body.phase,
                droplet: false,
                wall: body.wall,
                temperature,
                enthalpy,
            });
            if body.slag {
                let row = state.len() - 1;
                state.metal.set(&SLAG, row, true);
            }
        }
        kept.iter().for_each(|p| occupied.insert(*p));
        filled.push(Filled {
            placed: kept.len(),
            left_out: crowded.len(),
        });
        let shape = body.shape.plain();
        earlier.extend(shape.map(|shape| (shapes::Body::new(&shape, 3), body)));
    }
    Ok(filled)
}

/// Whether a place is within one of the bodies, as their shapes and cuts have it.
fn within(bodies: &[(shapes::Body, &Body)], place: [f64; 3]) -> bool {
    let mut bodies = bodies.iter();
    bodies.any(|(shape, body)| {
        shape.holds(place) && !body.cuts.iter().any(|cut| cut.beyond(place) > 0.0)
    })
}

/// Velocity \[m/s\] of a body at a place.
fn speed(body: &Body, position: [f64; 3]) -> Result<[f64; 3], String> {
    let at = Arguments::at(position, 0.0);
    let mut velocity = [0.0; 3];
    for (component, curve) in velocity.iter_mut().zip(&body.velocity) {
        *component = curve.value(&at).map_err(|fault| fault.to_string())?;
    }
    Ok(velocity)
}

/// Temperature \[K\] and specific enthalpy \[J/kg\] of a body at a place.
fn warmth(
    body: &Body,
    position: [f64; 3],
    caloric: Option<&Caloric>,
) -> Result<(f64, f64), String> {
    let temperature = body
        .temperature
        .value(&Arguments::at(position, 0.0))
        .map_err(|e| e.to_string())?;
    let Some(caloric) = caloric else {
        return Ok((temperature, 0.0));
    };
    if !caloric.covers(temperature) {
        let (from, to) = caloric.range();
        return Err(format!(
            "{temperature} K at ({}, {}, {}) m is outside of the properties, {from} K to {to} K",
            position[0], position[1], position[2]
        ));
    }
    let enthalpy = caloric.enthalpy(temperature);
    let liquid = body.phase == phase::LIQUID;
    match (caloric.melting_point()).filter(|_| !body.wall && !body.slag) {
        Some(point) if liquid != caloric.is_liquid(enthalpy) => Err(format!(
            "{temperature} K does not fit a {} body that melts at {point} K",
            if liquid { "liquid" } else { "solid" }
        )),
        _ => Ok((temperature, enthalpy)),
    }
}

/// Lattice points of a body with its cuts made.
fn body_points(body: &Body) -> Vec<[f64; 3]> {
    let d = edge(body.pitch);
    let mut points = body.round.points(&body.shape, body.pitch, body.lattice);
    for cut in &body.cuts {
        // A point on the plane is kept, whatever the rounding.
        points.retain(|p| cut.beyond(*p) <= 1e-9 * d);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::shape::Container;
    use crate::state::{ENTHALPY, TEMPERATURE, WALL};
    use particles::{Matter, POSITION};
    use shapes::Face;
    use shapes::shape::{BoxShape, Sphere};

    const D: f64 = 1e-3;

    fn empty() -> State {
        let metal = Matter {
            density: 7850.0,
            spacing: D,
            smoothing_length: D,
        };
        let mut state = State::new(metal);
        state.metal.declare(&TEMPERATURE);
        state.metal.declare(&ENTHALPY);
        state
    }

    fn body(shape: Shape, phase: u8) -> Body {
        Body {
            shape,
            pitch: [D; 3],
            lattice: None,
            round: Round::default(),
            cuts: Vec::new(),
            phase,
            wall: false,
            slag: false,
            velocity: [const { Curve::Constant(0.0) }; 3],
            temperature: Curve::Constant(300.0),
            held: None,
        }
    }

    /// 500 J/(kg K); with a melting point, 1 J/kg of latent heat.
    fn plain(melting_point: Option<f64>) -> Caloric {
        let text = match melting_point {
            None => String::new(),
            Some(t) => format!(r#","melting":{{"point_k":{t},"latent_heat_j_kg":1}}"#),
        };
        let text =
            format!(r#"{{"thermal_conductivity_w_m_k":30,"specific_heat_j_kg_k":500{text}}}"#);
        let heat: crate::heat::Parameters = serde_json::from_str(&text).unwrap();
        heat.caloric().unwrap().as_ref().clone()
    }

    fn cube(edge: f64) -> Shape {
        Shape::Box(BoxShape {
            name: None,
            min_m: vec![0.0; 3],
            max_m: vec![edge; 3],
        })
    }

    fn made(caloric: Caloric) -> Substances {
        Substances::of(std::sync::Arc::new(caloric), empty().metal.matter)
    }

    fn put(state: &mut State, bodies: &[Body]) -> Vec<Filled> {
        fill(state, bodies, Some(&made(plain(None)))).unwrap()
    }

    #[test]
    fn a_later_body_keeps_its_distance() {
        let mut state = empty();
        let mut ball = body(
            Shape::Sphere(Sphere {
                name: None,
                centre_m: vec![10.4 * D, 5.0 * D, 5.0 * D],
                radius_m: 3.0 * D,
            }),
            phase::LIQUID,
        );
        ball.lattice = Some([0.17 * D; 3]);
        let filled = put(&mut state, &[body(cube(10.0 * D), phase::SOLID), ball]);
        assert_eq!(filled[0].placed, 1000);
        assert!(filled[1].placed > 0 && filled[1].left_out > 0);
        for a in 1000..state.len() {
            for b in 0..1000 {
                let (p, q) = (
                    state.metal.column(&POSITION)[a],
                    state.metal.column(&POSITION)[b],
                );
                let square: f64 = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum();
                assert!(square.sqrt() >= CLEARANCE * D);
            }
        }
        assert_eq!(state.liquid(), filled[1].placed);
    }

    #[test]
    fn nothing_of_a_later_body_stands_between_the_particles_of_an_earlier_one() {
        let mut state = empty();
        // The middle of the ball, between its particles, is a place of the box.
        let centre_m = [4.5 * D; 3];
        let ball = Sphere {
            name: None,
            centre_m: centre_m.to_vec(),
            radius_m: 3.0 * D,
        };
        let ball = body(Shape::Sphere(ball), phase::LIQUID);
        let filled = put(&mut state, &[ball, body(cube(9.0 * D), phase::LIQUID)]);
        for p in &state.metal.column(&POSITION)[filled[0].placed..] {
            let far: f64 = (0..3).map(|k| (p[k] - centre_m[k]).powi(2)).sum();
            assert!(far.sqrt() > 3.0 * D * (1.0 - 1e-12), "{p:?}");
        }
    }

    #[test]
    fn a_full_tank_leaves_no_gap_and_no_overlap() {
        let mut state = empty();
        let tank = Container {
            min_m: [0.0; 3],
            max_m: [6.0 * D; 3],
            thickness_m: 2.0 * D,
            open: vec![Face::ZHigh],
        };
        let mut wall = body(Shape::Container(tank), phase::SOLID);
        wall.wall = true;
        let filled = put(&mut state, &[wall, body(cube(6.0 * D), phase::LIQUID)]);
        assert_eq!(
            filled[1],
            Filled {
                placed: 216,
                left_out: 0
            }
        );
        assert_eq!(state.len(), 10 * 10 * 8);
        assert_eq!(
            state.metal.column(&WALL).iter().filter(|w| **w).count(),
            584
        );
    }

    #[test]
    fn cuts_and_temperatures_follow_the_scene() {
        let mut state = empty();
        let mut wedge = body(cube(10.0 * D), phase::SOLID);
        wedge.cuts.push(Cut {
            point: [5.0 * D; 3],
            normal: [2.0, 0.0, 2.0],
        });
        let warm: run::property::Property =
            serde_json::from_value(serde_json::json!({"expr": "300 + 1000*x"})).unwrap();
        wedge.temperature = warm.compile("", &["x", "y", "z", "r"]).unwrap();
        put(&mut state, &[wedge]);
        assert_eq!(state.len(), 10 * 55);
        let first = state.metal.column(&ENTHALPY)[0];
        for (p, (t, h)) in state.metal.column(&POSITION).iter().zip(
            state
                .metal
                .column(&TEMPERATURE)
                .iter()
                .zip(state.metal.column(&ENTHALPY)),
        ) {
            assert!(p[0] + p[2] <= 10.0 * D * (1.0 + 1e-12));
            assert!((t - 300.0 - 1000.0 * p[0]).abs() < 1e-12);
            assert!((h - first - 500.0 * (t - state.metal.column(&TEMPERATURE)[0])).abs() < 1e-6);
        }
    }

    #[test]
    fn a_body_must_be_as_warm_as_its_state_says() {
        let steel = made(plain(Some(1750.0)));
        let refused = |phase, kelvin| {
            let mut cold = body(cube(2.0 * D), phase);
            cold.temperature = Curve::Constant(kelvin);
            fill(&mut empty(), &[cold], Some(&steel)).map_err(|fault| fault.path().to_owned())
        };
        let path = "/bodies/0/temperature_k".to_owned();
        assert_eq!(refused(phase::LIQUID, 1700.0), Err(path.clone()));
        assert_eq!(refused(phase::SOLID, 1800.0), Err(path));
        assert!(refused(phase::LIQUID, 1800.0).is_ok() && refused(phase::SOLID, 1700.0).is_ok());
    }
}
