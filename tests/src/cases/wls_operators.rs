//! `wls-operators`: gradient and Laplacian by weighted least squares on clouds of every kind.
//!
//! The library is measured itself, as no scene asks for operators alone: the run time is that of
//! sorting the cloud and of all weights.

use std::time::Instant;

use wls::{Cloud, Metric, Plan, Rules, Search, Stencils, Wants};

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::norms;

/// Points per side of the unit cube, by level.
const SIDES: [usize; 5] = [12, 16, 24, 34, 48];
/// Runs of which the middle one's time counts, where the first is shorter than this \[s\].
const SHORT_S: f64 = 0.2;
/// As many of them.
const REPEATS: usize = 3;
/// Order of the fit and kind of the cloud.
const METHODS: [&str; 18] = [
    "2-regular",
    "2-jitter-10",
    "2-jitter-30",
    "2-graded",
    "2-half",
    "2-near-coplanar",
    "3-regular",
    "3-jitter-10",
    "3-jitter-30",
    "3-graded",
    "3-half",
    "3-near-coplanar",
    "4-regular",
    "4-jitter-10",
    "4-jitter-30",
    "4-graded",
    "4-half",
    "4-near-coplanar",
];
/// What an observed order may lack.
const MARGIN: f64 = 0.2;

/// The case.
pub(super) struct WlsOperators;

/// A cloud in the unit cube.
struct Points {
    places: Vec<[f64; 3]>,
    metrics: Vec<Metric<3>>,
    /// Supports have no points with greater x than their own, but near the face x = 0.
    half: bool,
    spacing: f64,
}

impl Rules<3> for Points {
    fn allowed(&self, i: usize, j: usize) -> bool {
        !self.half || self.places[i][0] < 0.5 || self.places[j][0] <= self.places[i][0]
    }
}

impl Points {
    fn new(kind: &str, side: usize) -> Self {
        let spacing = 1.0 / side as f64;
        let jitter = match kind {
            "jitter-30" => 0.3,
            "regular" => 0.0,
            _ => 0.1,
        };
        let mut random = Random(side as u64);
        let mut points = Self {
            places: Vec::new(),
            metrics: Vec::new(),
            half: kind == "half",
            spacing,
        };
        for k in 0..side.pow(3) {
            let cell = [k % side, k / side % side, k / side / side];
            let mut place = cell.map(|c| spacing * (c as f64 + 0.5 + jitter * random.next()));
            let mut own = spacing;
            if kind == "graded" {
                // The slope of (x + x^2) / 2 grows from 1/2 to 3/2.
                own *= (0.5 + place[0]).max(1.0);
                place[0] = 0.5 * (place[0] + place[0].powi(2));
            }
            // The two layers in the middle lie almost in one plane, one between the other's points.
            if kind == "near-coplanar" && (cell[2] + 1 == side / 2 || cell[2] == side / 2) {
                place[2] = 0.5 + 1e-3 * spacing * random.next();
                let aside = 0.5 * spacing * (cell[2] + 1 - side / 2) as f64;
                place[0] += aside;
                place[1] += aside;
            }
            points.places.push(place);
            points.metrics.push(Metric::round(own));
        }
        points
    }

    fn stencils(&self, order: u8) -> Result<Stencils<3>, wls::Error> {
        let wants = Wants {
            gradient: true,
            laplacian: true,
            ..Wants::default()
        };
        let search = Search::new(Cloud {
            points: &self.places,
            metrics: &self.metrics,
        })?;
        Stencils::build(&search, &Plan::new::<3>(order, wants), self)
    }

    /// Errors on exp(x) sin(2 y + 1) cos(z).
    fn smooth(&self, stencils: &Stencils<3>, errors: &mut Errors) {
        let value = |[x, y, z]: [f64; 3]| x.exp() * (2.0 * y + 1.0).sin() * z.cos();
        let field = self.places.iter().map(|p| value(*p)).collect::<Vec<_>>();
        let gradient = self.places.iter().map(|&[x, y, z]| {
            [
                x.exp() * (2.0 * y + 1.0).sin() * z.cos(),
                2.0 * x.exp() * (2.0 * y + 1.0).cos() * z.cos(),
                -x.exp() * (2.0 * y + 1.0).sin() * z.sin(),
            ]
        });
        let gradient = gradient.flatten().collect::<Vec<_>>();
        let found = stencils.apply_gradient(&field).concat();
        let (l2, linf) = norms::relative(&found, &gradient);
        errors.insert("gradient_l2".to_owned(), l2);
        errors.insert("gradient_linf".to_owned(), linf);
        let laplacian = field.iter().map(|u| -4.0 * u).collect::<Vec<_>>();
        let (l2, linf) = norms::relative(&stencils.apply_laplacian(&field), &laplacian);
        errors.insert("laplacian_l2".to_owned(), l2);
        errors.insert("laplacian_linf".to_owned(), linf);
    }

    /// Greatest error on (x - 2 y + z / 2)^p + (y + z)^(p - 1), derivatives counted by the spacing.
    fn polynomial(&self, stencils: &Stencils<3>, order: u8) -> f64 {
        let p = i32::from(order);
        let first = |[x, y, z]: [f64; 3]| x - 2.0 * y + 0.5 * z;
        let second = |[_, y, z]: [f64; 3]| y + z;
        let places = self.places.iter();
        let field = places.map(|q| first(*q).powi(p) + second(*q).powi(p - 1));
        let field = field.collect::<Vec<_>>();
        let mut worst = 0.0_f64;
        for (i, &q) in self.places.iter().enumerate() {
            let along = f64::from(p) * first(q).powi(p - 1);
            let beside = f64::from(p - 1) * second(q).powi(p - 2);
            let exact = [along, beside - 2.0 * along, beside + 0.5 * along];
            for (found, exact) in stencils.gradient_of(&field, i).iter().zip(exact) {
                worst = worst.max((found - exact).abs() * self.spacing);
            }
            let mut curved = 5.25 * f64::from(p * (p - 1)) * first(q).powi(p - 2);
            if p > 2 {
                curved += 2.0 * f64::from((p - 1) * (p - 2)) * second(q).powi(p - 3);
            }
            let found = stencils.laplacian(i).apply(&field);
            worst = worst.max((found - curved).abs() * self.spacing.powi(2));
        }
        worst
    }
}

/// Numbers between -1 and 1 that are the same on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
    }
}

/// Order and kind of cloud of a method.
fn parts(method: &str) -> (u8, &str) {
    let (order, kind) = method.split_once('-').unwrap_or(("2", "regular"));
    (order.parse().unwrap_or(2), kind)
}

impl Case for WlsOperators {
    fn name(&self) -> &'static str {
        "wls-operators"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "derivatives of polynomials and of exp(x) sin(2y + 1) cos(z); Matsuzawa (2017), section 2.1"
    }

    fn methods(&self) -> &'static [&'static str] {
        &METHODS
    }

    fn targets(&self) -> Vec<Target> {
        METHODS
            .iter()
            .flat_map(|&method| {
                let p = f64::from(parts(method).0);
                [
                    Target::error("polynomial", 1e-10).of(method),
                    Target::order("gradient_l2", p - MARGIN).of(method),
                    Target::order("laplacian_l2", p - 1.0 - MARGIN).of(method),
                ]
            })
            .collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let (order, kind) = parts(method);
        let content = |what: String| LabError::Content {
            path: lab.out.join(self.name()).join(method),
            what,
        };
        let side = SIDES.get(level as usize - 1).copied();
        let side = side.ok_or_else(|| content(format!("there is no level {level}")))?;
        let points = Points::new(kind, side);
        let (mut times, mut errors) = (Vec::new(), Errors::new());
        while times.len() < REPEATS {
            let start = Instant::now();
            let stencils = points.stencils(order).map_err(|e| content(e.to_string()))?;
            times.push(start.elapsed().as_secs_f64());
            if times.len() == 1 {
                points.smooth(&stencils, &mut errors);
                let worst = points.polynomial(&stencils, order);
                errors.insert("polynomial".to_owned(), worst);
            }
            if times[0] > SHORT_S {
                break;
            }
        }
        times.sort_by(f64::total_cmp);
        let run = Finished::here(times[times.len() / 2]);
        let count = points.places.len() as u64;
        Ok(Measurement::of(run, count, points.spacing, errors))
    }
}
