//! Grains glued into a body, which moves as one.
//!
//! ```text
//! M dU/dt = sum F_a + M g        dL/dt = sum (r_a x F_a + M_a)        L = I W        dq/dt = W q / 2
//! x_a = X + r_a,  r_a = q r_a0 q*        u_a = U + W x r_a        w_a = W
//! I = sum (m_a ((r_a . r_a) 1 - r_a r_a) + c m_a R_a^2 1)
//! ```
//!
//! X is the centre of mass, q the turn since the start as a unit quaternion, and r_a0 where a grain was then. A step is that of Verlet as of
//! single grains; the turn goes about the momentum of half the step, with the inertia of half the turn:
//!
//! ```text
//! q' = exp(dt I(q'')^-1 (L + dt/2 T) / 2) q        q'' is half of this turn, reckoned with I(q)
//! ```
//!
//! A free body keeps L to the last bit. A contact has the dashpot of the single grain, whose mass is less than that of the body: an impact of
//! the body bounces more than the restitution of the scene says.

use contact::Grain;
use particles::Set;
use shapes::frame::{Vector, along, cross, difference, dot, length, scaled};

use super::greater::greater;
use super::{GLUED, GLUED_AT};

/// A unit quaternion: its real part first.
type Quaternion = [f64; 4];
/// A symmetric matrix: xx, yy, zz, yz, zx, xy.
type Symmetric = [f64; 6];

/// Numbers of a body in a checkpoint.
const NUMBERS: usize = 14;

/// What of a body a checkpoint keeps.
#[derive(Debug, Clone, Copy)]
struct State {
    /// X \[m\].
    centre: Vector,
    /// U \[m/s\].
    velocity: Vector,
    /// L about the centre \[kg m2/s\].
    momentum: Vector,
    turn: Quaternion,
}

/// Grains that move as one.
#[derive(Debug, Clone)]
struct Body {
    /// Its number in the scene.
    number: usize,
    /// Rows of its grains, and r_0 of each \[m\].
    rows: Vec<usize>,
    places: Vec<Vector>,
    /// M \[kg\], and I without a turn \[kg m2\].
    mass: f64,
    inertia: Symmetric,
    /// None until it is taken first.
    state: Option<State>,
    /// Force \[N\] and moment about the centre \[N m\] of the step before.
    acting: [Vector; 2],
}

/// Motion of the grains, their forces and moments.
pub(super) struct Grains<'a> {
    pub(super) grains: &'a mut [Grain],
    pub(super) force: &'a [Vector],
    pub(super) moment: &'a [Vector],
    pub(super) listed: &'a [Vector],
}

/// All bodies of glued grains.
#[derive(Debug, Clone, Default)]
pub(super) struct Glued {
    bodies: Vec<Body>,
}

impl Glued {
    /// Takes the rows of the bodies; `c` is the inertia factor of a grain.
    pub(super) fn take(&mut self, set: &Set, grains: &[Grain], c: f64) {
        if !set.has(&GLUED) {
            return;
        }
        for body in &mut self.bodies {
            body.rows.clear();
            body.places.clear();
        }
        let columns = set.column(&GLUED).iter().zip(set.column(&GLUED_AT));
        for (row, (body, place)) in columns.enumerate().filter(|(_, (body, _))| **body > 0) {
            let body = self.body(*body as usize - 1);
            body.rows.push(row);
            body.places.push(*place);
        }
        self.bodies.retain(|body| !body.rows.is_empty());
        self.bodies
            .iter_mut()
            .for_each(|body| body.weigh(grains, c));
    }

    /// The body of a number in the scene.
    fn body(&mut self, number: usize) -> &mut Body {
        let found = self
            .bodies
            .binary_search_by_key(&number, |body| body.number);
        let place = found.unwrap_or_else(|place| {
            self.bodies.insert(place, Body::new(number));
            place
        });
        &mut self.bodies[place]
    }

    pub(super) fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// All rows.
    pub(super) fn rows(&self) -> impl Iterator<Item = usize> {
        self.bodies
            .iter()
            .flat_map(|body| body.rows.iter().copied())
    }

    /// A body of which one grain leaves does so as a whole.
    pub(super) fn leave(&self, leaves: &mut [bool]) {
        for body in &self.bodies {
            if body.rows.iter().any(|row| leaves[*row]) {
                body.rows.iter().for_each(|row| leaves[*row] = true);
            }
        }
    }

    /// X += dt U + dt^2/2 A, U += dt A, L += dt T, and the turn. Gives the farthest way of a grain since neighbours were listed \[m\].
    pub(super) fn predict(&mut self, all: &mut Grains<'_>, step: f64, gravity: Vector) -> f64 {
        let mut far = 0.0;
        for body in &mut self.bodies {
            body.predict(all, step, gravity);
            for row in &body.rows {
                let way = difference(all.grains[*row].position, all.listed[*row]);
                far = greater(far, dot(way, way));
            }
        }
        far.sqrt()
    }

    /// U += dt/2 (A' - A), L += dt/2 (T' - T).
    pub(super) fn correct(&mut self, all: &mut Grains<'_>, step: f64) {
        self.bodies
            .iter_mut()
            .for_each(|body| body.correct(all, step));
    }

    /// Adds the numbers of a checkpoint.
    pub(super) fn save(&self, saved: &mut Vec<f64>) {
        for body in &self.bodies {
            if let Some(state) = &body.state {
                saved.push(body.number as f64);
                saved.extend([state.centre, state.velocity, state.momentum].as_flattened());
                saved.extend(state.turn);
            }
        }
    }

    /// Takes back what [`Glued::save`] added; gives the rest.
    pub(super) fn restore<'a>(&mut self, saved: &'a [f64]) -> &'a [f64] {
        let (own, rest) = saved.split_at((NUMBERS * self.bodies.len()).min(saved.len()));
        for [number, x, y, z, u, v, w, k, l, m, turn @ ..] in own.as_chunks::<NUMBERS>().0 {
            self.body(*number as usize).state = Some(State {
                centre: [*x, *y, *z],
                velocity: [*u, *v, *w],
                momentum: [*k, *l, *m],
                turn: *turn,
            });
        }
        rest
    }
}

impl Body {
    fn new(number: usize) -> Self {
        Self {
            number,
            rows: Vec::new(),
            places: Vec::new(),
            mass: 0.0,
            inertia: [0.0; 6],
            state: None,
            acting: [[0.0; 3]; 2],
        }
    }

    /// M, I, and at the start the motion that the grains begin with.
    fn weigh(&mut self, grains: &[Grain], c: f64) {
        (self.mass, self.inertia) = (0.0, [0.0; 6]);
        let (mut centre, mut momentum) = ([0.0; 3], [0.0; 3]);
        for (row, [x, y, z]) in self.rows.iter().zip(&self.places) {
            let grain = &grains[*row];
            let (m, own) = (grain.mass, c * grain.mass * grain.radius * grain.radius);
            self.mass += m;
            let squares = [y * y + z * z, z * z + x * x, x * x + y * y];
            for (k, square) in squares.into_iter().enumerate() {
                self.inertia[k] += m * square + own;
            }
            for (k, product) in [y * z, z * x, x * y].into_iter().enumerate() {
                self.inertia[3 + k] -= m * product;
            }
            centre = along(centre, m, grain.position);
            momentum = along(momentum, m, grain.velocity);
        }
        let inertia = self.inertia;
        let spin = grains[self.rows[0]].spin;
        self.state.get_or_insert(State {
            centre: scaled(1.0 / self.mass, centre),
            velocity: scaled(1.0 / self.mass, momentum),
            momentum: times(&inertia, spin),
            turn: [1.0, 0.0, 0.0, 0.0],
        });
    }

    /// W of a turn and a momentum: q I^-1 q* L.
    fn spin(&self, turn: Quaternion, momentum: Vector) -> Vector {
        let own = turned(conjugate(turn), momentum);
        turned(turn, solved(&self.inertia, own))
    }

    fn predict(&mut self, all: &mut Grains<'_>, step: f64, gravity: Vector) {
        let Some(mut state) = self.state else { return };
        let [force, moment] = self.sums(all, &state);
        let gained = along(scaled(step / self.mass, force), step, gravity);
        state.centre = along(state.centre, step, along(state.velocity, 0.5, gained));
        state.velocity = along(state.velocity, 1.0, gained);
        let middle = along(state.momentum, 0.5 * step, moment);
        let half = product(
            turn_by(scaled(0.5 * step, self.spin(state.turn, middle))),
            state.turn,
        );
        let whole = turn_by(scaled(step, self.spin(half, middle)));
        state.turn = unit(product(whole, state.turn));
        state.momentum = along(state.momentum, step, moment);
        (self.acting, self.state) = ([force, moment], Some(state));
        self.place(all);
    }

    fn correct(&mut self, all: &mut Grains<'_>, step: f64) {
        let Some(mut state) = self.state else { return };
        let [force, moment] = self.sums(all, &state);
        let half = 0.5 * step;
        let more = [0, 1].map(|k| difference([force, moment][k], self.acting[k]));
        state.velocity = along(state.velocity, half / self.mass, more[0]);
        state.momentum = along(state.momentum, half, more[1]);
        self.state = Some(state);
        self.place(all);
    }

    /// sum F_a and sum (r_a x F_a + M_a), in the order of rows.
    fn sums(&self, all: &Grains<'_>, state: &State) -> [Vector; 2] {
        let mut sums = [[0.0; 3]; 2];
        for (row, place) in self.rows.iter().zip(&self.places) {
            let (force, arm) = (all.force[*row], turned(state.turn, *place));
            sums[0] = along(sums[0], 1.0, force);
            sums[1] = along(
                sums[1],
                1.0,
                along(all.moment[*row], 1.0, cross(arm, force)),
            );
        }
        sums
    }

    /// x_a = X + r_a, u_a = U + W x r_a, w_a = W.
    fn place(&self, all: &mut Grains<'_>) {
        let Some(state) = &self.state else { return };
        let spin = self.spin(state.turn, state.momentum);
        for (row, place) in self.rows.iter().zip(&self.places) {
            let (arm, grain) = (turned(state.turn, *place), &mut all.grains[*row]);
            grain.position = along(state.centre, 1.0, arm);
            grain.velocity = along(state.velocity, 1.0, cross(spin, arm));
            grain.spin = spin;
        }
    }
}

/// A x.
fn times(a: &Symmetric, x: Vector) -> Vector {
    let [xx, yy, zz, yz, zx, xy] = *a;
    [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]].map(|row| dot(row, x))
}

/// A^-1 b, by Cramer's rule.
fn solved(a: &Symmetric, b: Vector) -> Vector {
    let [xx, yy, zz, yz, zx, xy] = *a;
    let (p, q, r) = ([xx, xy, zx], [xy, yy, yz], [zx, yz, zz]);
    let volume = dot(p, cross(q, r));
    [
        dot(b, cross(q, r)) / volume,
        dot(p, cross(b, r)) / volume,
        dot(p, cross(q, b)) / volume,
    ]
}

/// p q.
fn product(p: Quaternion, q: Quaternion) -> Quaternion {
    let ([a, b @ ..], [c, d @ ..]) = (p, q);
    let [x, y, z] = along(along(cross(b, d), a, d), c, b);
    [a * c - dot(b, d), x, y, z]
}

fn conjugate([a, x, y, z]: Quaternion) -> Quaternion {
    [a, -x, -y, -z]
}

fn unit(q: Quaternion) -> Quaternion {
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / norm)
}

/// A turn by the angle |w| about w.
fn turn_by(w: Vector) -> Quaternion {
    let angle = length(w);
    // sin(angle/2) / angle, also where that is none.
    let part = if angle > 1e-8 {
        (0.5 * angle).sin() / angle
    } else {
        0.5
    };
    let [x, y, z] = scaled(part, w);
    [(0.5 * angle).cos(), x, y, z]
}

/// q x q*.
fn turned([a, b @ ..]: Quaternion, x: Vector) -> Vector {
    let twice = scaled(2.0, cross(b, x));
    along(along(x, a, twice), 1.0, cross(b, twice))
}
