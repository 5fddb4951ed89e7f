use krylov::{Ending, Error, Options, Rescue, Rule, Solved};

use crate::magnetic::diffusion::{Conductors, Ground};
use crate::magnetic::medium::interface::Permeable;
use crate::magnetic::medium::law::{Curve, Law};
use crate::magnetic::saturation::equations::Saturation;
use crate::magnetic::saturation::newton::{Ended, Newton, STILL};
use crate::magnetic::saturation::places::level;
use crate::magnetic::source::{MU0, Source};
use crate::magnetic::stage::{Alone, Equations};
use crate::magnetic::unknown::Unknown;
use crate::march::scheme::{Stage, slope};
use crate::stencils::region::Region;
use crate::stencils::sides::{Form, Sides};
use crate::stencils::tests::rings;

fn rule() -> Rule<'static> {
    Rule {
        reduction: 1e-12,
        ..Rule::default()
    }
}

/// What stays of a uniform flux density of 1 T in a bar across it, some time after what made it is gone.
struct Decay {
    region: Region<2>,
    sides: Sides<2>,
    permeable: Permeable,
    laws: [Law; 2],
    slope: f64,
}

impl Decay {
    /// In a bar of a curve of magnetisation, over one step.
    fn new(curve: Curve, step: f64) -> Self {
        let mut region = rings(0.2);
        region.bent = vec![false, true];
        let form = Form {
            order: 4,
            ..Form::default()
        };
        let sides = Sides::new(&region, &form).unwrap();
        let permeability = [MU0, MU0 / level(&curve, MU0)];
        Self {
            permeable: Permeable::of(&region, &permeability).unwrap(),
            laws: [Law::Constant(MU0), Law::Curve(curve)],
            slope: slope(step),
            region,
            sides,
        }
    }

    fn stage(&self) -> Alone<1> {
        let conductors = Conductors {
            mu_sigma: vec![0.0, 1.0],
            axial: None,
            permeable: Permeable::of(&self.region, &[MU0, MU0 / self.permeable.weight(1)]),
        };
        let unknown = Unknown::Potential;
        let held = |i| conductors.held(&self.region, unknown, i).then_some([0.0]);
        let equations = Equations {
            bound: Vec::new(),
            rates: conductors.rates(&self.region, &self.sides, unknown),
            rows: conductors.rows(&self.region, &self.sides, unknown),
            low: None,
            held: (0..self.region.len()).map(held).collect(),
            given: Vec::new(),
            pairs: Vec::new(),
            options: Options::default(),
        };
        Alone::new(equations, self.slope).unwrap()
    }

    fn media(&self) -> Saturation<'_, 2> {
        let ground = Ground {
            region: &self.region,
            sides: &self.sides,
            unknown: Unknown::Potential,
        };
        Saturation::new(
            ground,
            &self.permeable,
            &self.laws,
            &[false, true],
            &Source::default(),
            None,
        )
    }

    /// What was before: `A_z = y`.
    fn driven(&self) -> Vec<f64> {
        let places = self.region.places.iter();
        places.map(|p| -self.slope * p[1]).collect()
    }

    /// By Newton's method on a stage, and the solves that it took.
    fn solved(&self, stage: &mut dyn Stage) -> (Ended, u64) {
        let (media, driven) = (self.media(), self.driven());
        let mut newton = Newton {
            stage,
            media: &media,
            driven: &driven,
            wave: 1.0,
            rule: rule(),
            taken: (0, 0),
        };
        let ended = newton.solve::<1>(vec![0.0; self.region.len()]);
        (ended, newton.taken.0)
    }

    /// `inv(L) (b + R(a))`.
    fn led(&self, unknown: &[f64]) -> Vec<f64> {
        let (mut stage, media, driven) = (self.stage(), self.media(), self.driven());
        let moved = stage.moved(&driven, unknown);
        let seen = media.look::<1>(unknown.as_chunks().0, 1.0, moved.as_chunks().0);
        let right = media.right(&seen, &media.sheets(&seen)).into_flattened();
        let mut led = unknown.to_vec();
        stage.solve(&driven, 1.0, &right, &mut led, rule());
        led
    }
}

/// It bends gently at 0.5 T.
fn gentle() -> Curve {
    let b: Vec<f64> = (0..=20).map(|k| 0.1 * f64::from(k)).collect();
    let mu = |b: f64| 2.0 + 4.0 / (1.0 + (b / 0.5).powi(2));
    let h = b.iter().map(|b| b / (MU0 * mu(*b))).collect();
    Curve::new(b, h).unwrap()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    let both = a.iter().zip(b);
    both.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Where the plain iteration converges both end in one field, which is no step of a linear one.
#[test]
fn newton_finds_the_field_to_which_the_plain_iteration_creeps() {
    let decay = Decay::new(gentle(), 0.3);
    let (ended, steps) = decay.solved(&mut decay.stage());
    assert!(
        ended.found && ended.most.0 < 10.0 * STILL,
        "{:?}",
        ended.most
    );
    let mut crept = vec![0.0; decay.region.len()];
    let mut taken = 0;
    let last = loop {
        let led = decay.led(&crept);
        let change = apart(&led, &crept);
        let half = crept.iter().zip(&led).map(|(a, b)| 0.5 * (a + b));
        crept = half.collect();
        taken += 1;
        if change < 1e-10 || taken == 500 {
            break change;
        }
    };
    assert!(last < 1e-10, "{last}");
    assert!(steps < taken, "{steps} {taken}");
    let most = ended.unknown.iter().fold(0.0, |m: f64, a| m.max(a.abs()));
    assert!(most > 0.1 && apart(&crept, &ended.unknown) < 1e-7 * most);
}

/// A straight curve is found at once: what is left after one step is what the linear solve leaves.
#[test]
fn a_straight_curve_takes_as_many_steps_as_its_linear_solves_ask_for() {
    let line = Curve::new(vec![0.0, 10.0], vec![0.0, 10.0 / (20.0 * MU0)]);
    let decay = Decay::new(line.unwrap(), 0.3);
    let (ended, steps) = decay.solved(&mut decay.stage());
    assert!(ended.found && steps < 60, "{steps}");
    assert!(apart(&decay.led(&ended.unknown), &ended.unknown) < 1e-7);
}

/// A stage whose solves end in no number.
struct Lost;

impl Stage for Lost {
    fn pace(&mut self, _: f64) -> Result<(), Error> {
        Ok(())
    }

    fn rescued(&self) -> Option<Rescue> {
        None
    }

    fn rescue(&mut self, _: Rescue) -> Result<(), Error> {
        Ok(())
    }

    fn moved(&self, driven: &[f64], _: &[f64]) -> Vec<f64> {
        driven.to_vec()
    }

    fn solve(&mut self, _: &[f64], _: f64, _: &[f64], unknown: &mut [f64], _: Rule) -> Solved {
        unknown.fill(f64::NAN);
        Solved {
            ending: Ending::Converged,
            products: 1,
            steps: 0,
            first: 0.0,
            last: 0.0,
            history: Vec::new(),
        }
    }
}

#[test]
fn a_field_that_is_no_number_is_not_found() {
    let (ended, steps) = Decay::new(gentle(), 0.3).solved(&mut Lost);
    assert!(!ended.found);
    assert_eq!(steps, 1);
}
