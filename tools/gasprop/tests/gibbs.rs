//! An independent check of compositions: the least Gibbs energy as a convex program over exponential cones.
//!
//! At given temperature and pressure, G/RT = sum of n_s (mu_s + ln(n_s/n)), n = sum of n_s, is convex. With t_s above
//! n_s ln(n_s/n) for each species, which is the exponential cone (-t_s, n_s, n), the program
//!
//! minimise sum of mu_s n_s + t_s, subject to sum of a_es n_s = b_e, sum of z_s n_s = 0,
//!
//! is solved by an interior-point method that knows nothing of element potentials or component species. Its standard
//! potentials mu_s = -ln(q_s kT/p) are written out here again.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod gas;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use gas::{GASES, with_iron};
use gasprop::constants::{ATMOSPHERE, BOLTZMANN, PLANCK};
use gasprop::mixture::{Element, Lowering, Mixture, Species};
use std::f64::consts::PI;

/// mu of a species over RT, at pressure p.
fn potential(species: &Species, t: f64, p: f64) -> f64 {
    let thermal = BOLTZMANN * t;
    let flight = (2.0 * PI * species.mass * thermal).powf(1.5) / PLANCK.powi(3);
    species.formation / thermal - species.internal(t).ln_partition - (flight * thermal / p).ln()
}

/// Entries of a matrix by row, column and value; rows of cones after rows of equations.
struct Program {
    rows: usize,
    entries: Vec<(usize, usize, f64)>,
    right: Vec<f64>,
}

impl Program {
    fn row(&mut self, terms: impl IntoIterator<Item = (usize, f64)>, right: f64) {
        self.entries.extend(
            terms
                .into_iter()
                .map(|(column, value)| (self.rows, column, value)),
        );
        self.right.push(right);
        self.rows += 1;
    }

    fn matrix(&self, columns: usize) -> CscMatrix<f64> {
        let (mut i, mut j, mut v) = (Vec::new(), Vec::new(), Vec::new());
        for &(row, column, value) in self
            .entries
            .iter()
            .filter(|(_, _, value)| value.abs() > 0.0)
        {
            i.push(row);
            j.push(column);
            v.push(value);
        }
        CscMatrix::new_from_triplets(self.rows, columns, i, j, v)
    }
}

/// Mole fractions of the least Gibbs energy, and how the solver ended.
fn least_gibbs(mixture: &Mixture, t: f64, p: f64, x: f64) -> (Vec<f64>, SolverStatus) {
    let species = &mixture.species;
    let count = species.len();
    let mut program = Program {
        rows: 0,
        entries: Vec::new(),
        right: Vec::new(),
    };
    for (e, element) in mixture.elements.iter().enumerate() {
        let iron = if *element == Element::Fe { x } else { 0.0 };
        let terms = (0..count).map(|s| (s, f64::from(species[s].count(*element))));
        program.row(terms, mixture.base[e] * (1.0 - x) + iron);
    }
    program.row((0..count).map(|s| (s, f64::from(species[s].charge))), 0.0);
    program.row((0..count).map(|s| (s, 1.0)).chain([(2 * count, -1.0)]), 0.0);
    let equations = program.rows;
    for s in 0..count {
        program.row([(count + s, 1.0)], 0.0);
        program.row([(s, -1.0)], 0.0);
        program.row([(2 * count, -1.0)], 0.0);
    }
    let mut cones = vec![SupportedConeT::ZeroConeT(equations)];
    cones.extend((0..count).map(|_| SupportedConeT::ExponentialConeT()));
    let mut objective: Vec<f64> = species.iter().map(|one| potential(one, t, p)).collect();
    objective.extend(vec![1.0; count]);
    objective.push(0.0);
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: 1e-12,
        tol_gap_rel: 1e-12,
        tol_feas: 1e-12,
        max_iter: 400,
        ..DefaultSettings::default()
    };
    let columns = 2 * count + 1;
    let none = CscMatrix::zeros((columns, columns));
    let matrix = program.matrix(columns);
    let mut solver =
        DefaultSolver::new(&none, &objective, &matrix, &program.right, &cones, settings).unwrap();
    solver.solve();
    let all = solver.solution.x[2 * count];
    (
        solver.solution.x[..count].iter().map(|n| n / all).collect(),
        solver.solution.status,
    )
}

/// Mole fractions agree to 1e-6, the accuracy of the interior-point method; the energies themselves to 1e-9.
#[test]
fn compositions_have_the_least_gibbs_energy() {
    let mut checked = 0;
    for gas in GASES {
        let mixture = with_iron(gas).with_lowering(Lowering::None);
        for t in [
            5000.0, 6500.0, 8000.0, 11_000.0, 15_000.0, 22_000.0, 30_000.0,
        ] {
            for (p, x) in [(0.1, 0.3), (1.0, 0.02), (1.0, 0.5), (10.0, 0.9)] {
                let pressure = p * ATMOSPHERE;
                let state = mixture.equilibrium(t, pressure, x).unwrap();
                let all: f64 = state.number.iter().sum();
                let (least, status) = least_gibbs(&mixture, t, pressure, x);
                let at = format!("{gas:?} {t} K, {p} atm, x {x}");
                assert!(
                    matches!(status, SolverStatus::Solved | SolverStatus::AlmostSolved),
                    "{at}: {status:?}"
                );
                let newton: Vec<f64> = state.number.iter().map(|n| n / all).collect();
                for ((species, got), expected) in mixture.species.iter().zip(&newton).zip(&least) {
                    assert!(
                        (got - expected).abs() < 1e-6,
                        "{at}: {} {got} {expected}",
                        species.name
                    );
                    checked += 1;
                }
                let energies = [&newton, &least]
                    .map(|fractions| per_nucleus(&mixture, fractions, t, pressure));
                assert!(
                    (energies[0] / energies[1] - 1.0).abs() < 1e-9,
                    "{at}: G/RT {energies:?}"
                );
            }
        }
    }
    assert!(checked > 4000);
}

/// G/RT of mole fractions per nucleus.
fn per_nucleus(mixture: &Mixture, fractions: &[f64], t: f64, p: f64) -> f64 {
    let (mut energy, mut nuclei) = (0.0, 0.0);
    for (species, fraction) in mixture.species.iter().zip(fractions) {
        if *fraction > 0.0 {
            energy += fraction * (potential(species, t, p) + fraction.ln());
        }
        nuclei += fraction
            * species
                .elements
                .iter()
                .map(|(_, n)| f64::from(*n))
                .sum::<f64>();
    }
    energy / nuclei
}
