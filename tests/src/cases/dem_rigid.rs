//! `dem-rigid`: a pyramid of balls that slips apart, with springs ever stiffer, beside balls that are rigid.
//!
//! Rigid balls with friction move, in a step h, to the velocities v that solve (Anitescu 2006; De Saxce and Feng 1998)
//!
//! ```text
//! min 1/2 v' M v - v' (M v0 + h f)    with  u_n + gap/h + mu |u_t| >= mu |u_t|   at each contact, as a cone
//! ```
//!
//! u_n and u_t are the velocities at a contact, linear in v; the term on the left is that of the last iteration, so that
//! nothing opens where it slides. `clarabel` solves the cone program.

use artefact::Frame;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, SecondOrderConeT, SolverStatus, SupportedConeT,
};
use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, frames};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::number;

/// The case.
pub(super) struct DemRigid;

/// Steps of the rigid balls between two frames.
const STEPS: usize = 10;
/// Solutions of a step, each with the slip of the one before.
const ITERATIONS: usize = 4;
/// Surfaces this near, over the diameter, may touch within a step.
const NEAR: f64 = 0.2;

type Vector = [f64; 3];

impl Case for DemRigid {
    fn name(&self) -> &'static str {
        "dem-rigid"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "rigid balls with Coulomb friction by a cone program, Anitescu (2006), extrapolated from two steps"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("position", 0.01),
            // It grows with k, until what the steps of the rigid balls leave is as large.
            Target::order("position", 0.5),
            Target::error("of_the_step", 0.01),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let scene = lab.run("poolsph", self.name(), &format!("scene{level}"), &json!({}))?;
        let at = "/grains/contact/law/linear/stiffness_n_m";
        let stiffness = number(&scene, at)? * 10.0_f64.powi(level.clamp(1, 6) as i32 - 1);
        let law = json!({"linear": {"stiffness_n_m": stiffness}});
        let patch = json!({"grains": {"contact": {"law": law}}});
        let run = lab.varied(&scene, &format!("level{level}"), &patch)?;
        let frames = frames(&run.artefact)?;
        let coarse = Balls::of(&run)?.path(&frames, STEPS);
        let fine = Balls::of(&run)?.path(&frames, 2 * STEPS);
        let (Some(coarse), Some(fine)) = (coarse, fine) else {
            return Err(fault(
                &run,
                "has a step that the cone program does not solve",
            ));
        };
        let radius = number(&run, "/grains/bodies/0/radius_m")?;
        let (mut apart, mut of_step, mut way) = (0.0_f64, 0.0_f64, 0.0_f64);
        for (k, frame) in frames.iter().enumerate() {
            for (a, place) in frame.position_vectors()?.iter().enumerate() {
                let place = place.map(|x| x / (2.0 * radius));
                let (one, two) = (coarse[k][a], fine[k][a]);
                let exact = [0, 1, 2].map(|i| 2.0 * two[i] - one[i]);
                apart = apart.max(length(minus(place, exact)));
                of_step = of_step.max(length(minus(two, one)));
                way = way.max(length(minus(exact, coarse[0][a])));
            }
        }
        let errors = Errors::from([
            ("position".to_owned(), apart / way),
            ("of_the_step".to_owned(), of_step / way),
        ]);
        let weight = number(&run, "/grains/density_kg_m3")? * 9.81 * 4.19 * radius.powi(3);
        let balls = frames.first().map_or(0, Frame::len) as u64;
        // Errors are those of the overlap under the weight of a ball.
        Ok(Measurement::of(run, balls, weight / stiffness, errors))
    }
}

/// Rigid balls on a floor; lengths over d, masses over m, accelerations over g.
struct Balls {
    place: Vec<Vector>,
    velocity: Vec<Vector>,
    spin: Vec<Vector>,
    /// I / (m d^2).
    inertia: f64,
    friction: f64,
    /// sqrt(d / g) \[s\].
    time: f64,
}

/// A contact of a ball with another, or with the floor.
struct Touch {
    a: usize,
    b: Option<usize>,
    normal: Vector,
    across: [Vector; 2],
    gap: f64,
}

impl Balls {
    fn of(run: &Finished) -> Result<Self, LabError> {
        let at = |key: &str| number(run, &format!("/grains/{key}"));
        let d = 2.0 * at("bodies/0/radius_m")?;
        let frames = frames(&run.artefact)?;
        let first = frames.first().ok_or_else(|| fault(run, "has no frame"))?;
        let places = first.position_vectors()?;
        Ok(Self {
            velocity: vec![[0.0; 3]; places.len()],
            spin: vec![[0.0; 3]; places.len()],
            place: places.iter().map(|x| x.map(|x| x / d)).collect(),
            inertia: 0.25 * at("inertia_factor").unwrap_or(0.4),
            friction: at("contact/friction")?,
            time: (d / -at("gravity_m_s2/2")?).sqrt(),
        })
    }

    /// Places at the times of the frames; none where a step has no solution.
    fn path(mut self, frames: &[Frame], steps: usize) -> Option<Vec<Vec<Vector>>> {
        let mut path = vec![self.place.clone()];
        for pair in frames.windows(2) {
            let step = (pair[1].time_s - pair[0].time_s) / (steps as f64 * self.time);
            for _ in 0..steps {
                self.step(step)?;
            }
            path.push(self.place.clone());
        }
        Some(path)
    }

    fn step(&mut self, step: f64) -> Option<()> {
        let touches = self.touches();
        let mut slips: Vec<f64> = touches.iter().map(|t| self.slip(t)).collect();
        let start = (self.velocity.clone(), self.spin.clone());
        for _ in 0..ITERATIONS {
            let found = self.solve(&touches, &slips, &start.0, &start.1, step)?;
            for (a, v) in found.chunks(6).enumerate() {
                self.velocity[a] = [v[0], v[1], v[2]];
                self.spin[a] = [v[3], v[4], v[5]];
            }
            for (slip, touch) in slips.iter_mut().zip(&touches) {
                *slip = self.slip(touch);
            }
        }
        for (x, u) in self.place.iter_mut().zip(&self.velocity) {
            for k in 0..3 {
                x[k] += step * u[k];
            }
        }
        Some(())
    }

    fn touches(&self) -> Vec<Touch> {
        let mut touches = Vec::new();
        let mut touch = |a, b, normal: Vector, gap: f64| {
            if gap < NEAR {
                let across = across(normal);
                touches.push(Touch {
                    a,
                    b,
                    normal,
                    across,
                    gap,
                });
            }
        };
        for (a, x) in self.place.iter().enumerate() {
            touch(a, None, [0.0, 0.0, 1.0], x[2] - 0.5);
            for (b, y) in self.place.iter().enumerate().skip(a + 1) {
                let apart = minus(*x, *y);
                let far = length(apart);
                touch(a, Some(b), apart.map(|x| x / far), far - 1.0);
            }
        }
        touches
    }

    /// Speed along the contact.
    fn slip(&self, touch: &Touch) -> f64 {
        let along = touch.across.map(|t| {
            let rows = touch.row(t);
            let parts = rows.iter().map(|(column, by)| {
                let (a, k) = (column / 6, column % 6);
                let v = if k < 3 {
                    self.velocity[a][k]
                } else {
                    self.spin[a][k - 3]
                };
                by * v
            });
            parts.sum::<f64>()
        });
        along[0].hypot(along[1])
    }

    /// Velocities and spins after a step, six numbers for each ball.
    fn solve(
        &self,
        touches: &[Touch],
        slips: &[f64],
        velocity: &[Vector],
        spin: &[Vector],
        step: f64,
    ) -> Option<Vec<f64>> {
        let n = 6 * self.place.len();
        let inertia = |column: usize| if column % 6 < 3 { 1.0 } else { self.inertia };
        let mass = CscMatrix::new(
            n,
            n,
            (0..=n).collect(),
            (0..n).collect(),
            (0..n).map(inertia).collect(),
        );
        let pushed = (0..n).map(|column| {
            let (a, k) = (column / 6, column % 6);
            let fall = if k == 2 { step } else { 0.0 };
            let v = if k < 3 {
                velocity[a][k]
            } else {
                spin[a][k - 3]
            };
            -inertia(column) * (v - fall)
        });
        let pushed: Vec<f64> = pushed.collect();
        let mut columns: Vec<Vec<(usize, f64)>> = vec![Vec::new(); n];
        let mut right = Vec::with_capacity(3 * touches.len());
        for (touch, slip) in touches.iter().zip(slips) {
            let scaled = [1.0, self.friction, self.friction];
            let ways = [touch.normal, touch.across[0], touch.across[1]];
            for (k, (way, by)) in ways.into_iter().zip(scaled).enumerate() {
                for (column, value) in touch.row(way) {
                    columns[column].push((right.len(), -by * value));
                }
                right.push(if k == 0 {
                    touch.gap / step + self.friction * slip
                } else {
                    0.0
                });
            }
        }
        let mut starts = vec![0];
        let (mut rows, mut values) = (Vec::new(), Vec::new());
        for column in columns {
            for (row, value) in column {
                rows.push(row);
                values.push(value);
            }
            starts.push(rows.len());
        }
        let contacts = CscMatrix::new(right.len(), n, starts, rows, values);
        let cones: Vec<SupportedConeT<f64>> = touches.iter().map(|_| SecondOrderConeT(3)).collect();
        let mut solver =
            DefaultSolver::new(&mass, &pushed, &contacts, &right, &cones, settings()).ok()?;
        solver.solve();
        let solved = matches!(
            solver.solution.status,
            SolverStatus::Solved | SolverStatus::AlmostSolved
        );
        solved.then(|| solver.solution.x.clone())
    }
}

/// Programs are solved to ten digits, by one thread.
fn settings() -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        max_threads: 1,
        tol_gap_abs: 1e-11,
        tol_gap_rel: 1e-11,
        tol_feas: 1e-11,
        ..DefaultSettings::default()
    }
}

impl Touch {
    /// Velocity of the contact along `way`, as a row over the velocities and spins: `(u_a - u_b - (w_a + w_b) x n d/2) . way`.
    fn row(&self, way: Vector) -> Vec<(usize, f64)> {
        // (w x n) . t = w . (n x t)
        let turn = cross(self.normal, way);
        let mut row = Vec::with_capacity(12);
        for k in 0..3 {
            row.push((6 * self.a + k, way[k]));
            row.push((6 * self.a + 3 + k, -0.5 * turn[k]));
            if let Some(b) = self.b {
                row.push((6 * b + k, -way[k]));
                row.push((6 * b + 3 + k, -0.5 * turn[k]));
            }
        }
        row
    }
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn length(a: Vector) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Two directions across a normal.
fn across(normal: Vector) -> [Vector; 2] {
    let aside = if normal[0].abs() < 0.6 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let first = cross(normal, aside);
    let first = first.map(|x| x / length(first));
    [first, cross(normal, first)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball on the floor.
    fn ball(velocity: Vector, friction: f64) -> Balls {
        Balls {
            place: vec![[0.0, 0.0, 0.5]],
            velocity: vec![velocity],
            spin: vec![[0.0; 3]],
            inertia: 0.1,
            friction,
            time: 1.0,
        }
    }

    #[test]
    fn a_rigid_ball_slides_until_it_rolls_at_five_sevenths() {
        let mut rolls = ball([1.0, 0.0, 0.0], 0.3);
        for _ in 0..50 {
            rolls.step(0.002).unwrap();
        }
        assert!((rolls.velocity[0][0] - (1.0 - 0.3 * 0.1)).abs() < 1e-6);
        for _ in 0..500 {
            rolls.step(0.002).unwrap();
        }
        assert!((rolls.velocity[0][0] - 5.0 / 7.0).abs() < 1e-6);
        assert!((rolls.place[0][2] - 0.5).abs() < 1e-6);
    }

    #[test]
    fn a_rigid_ball_falls_until_it_lies() {
        let mut falls = ball([0.0; 3], 0.3);
        falls.place[0][2] = 0.6;
        for _ in 0..100 {
            falls.step(0.01).unwrap();
        }
        assert!((falls.place[0][2] - 0.5).abs() < 1e-6);
        assert!(length(falls.velocity[0]) < 1e-6);
    }
}
