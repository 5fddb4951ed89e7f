//! Targets that cannot mean what they say: unknown measures, other units, negative tolerances.

use run::Fault;
use run::scene::nearest;

use super::{Balances, Target, Targets};
use crate::measure::bead::{MEASURES, measure_of};

/// Every fault of the targets. An arc that is not given is not known: nothing is said of its values.
pub(super) fn faults(targets: &Targets, arcs: &Balances) -> Vec<Fault> {
    let mut found = Vec::new();
    for (index, target) in targets.targets.iter().enumerate() {
        let own = [tolerance(target), measure(target, arcs)];
        let within = |fault: Fault| fault.within(&format!("/targets/{index}"));
        found.extend(own.into_iter().flatten().map(within));
    }
    found
}

fn tolerance(target: &Target) -> Option<Fault> {
    let tolerance = target.tolerance.filter(|t| *t < 0.0)?;
    let what = format!(
        "{tolerance} {} is out of range: at least 0; leave the key out where nothing is judged",
        target.unit
    );
    Some(Fault::at("/tolerance", what))
}

fn measure(target: &Target, arcs: &Balances) -> Option<Fault> {
    let Some((arc, name)) = target.measure.split_once('/') else {
        return match measure_of(&target.measure) {
            Some(known) => unit(target, known.unit),
            None => Some(unknown(&target.measure, &MEASURES.map(|m| m.name), "")),
        };
    };
    let (_, balance) = arcs.iter().find(|(own, _)| own == arc)?;
    match balance.values.iter().find(|entry| entry.name == name) {
        Some(known) => unit(target, &known.unit),
        None => {
            let names: Vec<&str> = balance.values.iter().map(|e| e.name.as_str()).collect();
            Some(unknown(name, &names, &format!("{arc}/")))
        }
    }
}

fn unit(target: &Target, known: &str) -> Option<Fault> {
    let what = || {
        format!(
            "is \"{}\", '{}' is in \"{known}\"",
            target.unit, target.measure
        )
    };
    (target.unit != known).then(|| Fault::at("/unit", what()))
}

/// The fault of a name that is none of those known; `arc` is what stands before it.
fn unknown(name: &str, known: &[&str], arc: &str) -> Fault {
    let hint = match nearest(name, known) {
        Some(meant) => format!("did you mean '{arc}{meant}'?"),
        None if arc.is_empty() => format!(
            "known are: {}; ARC/NAME is a value of the balance of an arc",
            known.join(", ")
        ),
        None => format!("the balance of this arc has: {}", known.join(", ")),
    };
    Fault::at(
        "/measure",
        format!("'{arc}{name}' is not a known measure; {hint}"),
    )
}
