//! What is wrong or odd with the arcs of a scene.

use run::Fault;
use torch::Waveform;

use super::Scene;

/// Steps in a period below which its pulses are blurred.
const STEPS: f64 = 8.0;

/// Waveforms that make no sense, and heat that replaces none.
pub(super) fn faults(scene: &Scene) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (number, arc) in scene.arcs.iter().enumerate() {
        if let Some(misfit) = arc.waveform.as_ref().and_then(Waveform::misfit) {
            let at = format!("/arcs/{number}/waveform{}", misfit.path);
            faults.push(Fault::at(&at, misfit.what));
        }
        let at = format!("/arcs/{number}/heat");
        match (&arc.heat, &scene.arc) {
            (Some(_), None) => {
                let what = "takes the place of the key 'arc', which is not there";
                faults.push(Fault::at(&at, what));
            }
            (Some(own), Some(all)) if own.on != all.on => {
                let what =
                    "differs from \"on\" of the key 'arc': all arcs fall on one kind of area";
                faults.push(Fault::at(&format!("{at}/on"), what).or_at("/arc/on"));
            }
            _ => {}
        }
        if arc.droplets.is_some() && scene.flow.is_none() {
            let what = "means nothing without the key 'flow'";
            faults.push(Fault::at(&format!("/arcs/{number}/droplets"), what));
        }
    }
    faults
}

/// Pulses that few steps see.
pub(super) fn blurred(scene: &Scene) -> impl Iterator<Item = String> {
    let step = scene.step();
    let arcs = scene.arcs.iter().map(|arc| ("arcs", &arc.waveform));
    let torches = scene.torches.iter();
    let torches = torches.map(|torch| ("torches", &torch.waveform));
    let numbered = arcs.enumerate().chain(torches.enumerate());
    numbered.filter_map(move |(number, (key, waveform))| {
        let steps = waveform.as_ref()?.period_s / step;
        (steps < STEPS).then(|| {
            format!(
                "{key}/{number}: a period of its waveform has {steps:.1} steps: each gets its mean, and pulses are blurred"
            )
        })
    })
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn scene(arcs: Value) -> Scene {
        let scene = json!({
            "spacing_m": 5e-4,
            "time": {"step_s": 1e-4, "end_s": 2.0},
            "density_kg_m3": 7850,
            "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [0.01, 0.02, 0.005]}}, "state": "solid"}],
            "source": {"start_m": [0, 0, 0], "velocity_m_s": [0, 0.005, 0]},
            "arcs": arcs,
            "output": {"particles_interval_s": 0.1}
        });
        serde_json::from_value(scene).unwrap()
    }

    #[test]
    fn what_is_wrong_is_told_at_its_key() {
        let told = |arcs| {
            let found = faults(&scene(arcs));
            found
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
                .join("\n")
        };
        let wave = |times: Value, levels: Value| json!([{"waveform": {"period_s": 0.01, "times_s": times, "levels": levels}}]);
        assert!(told(wave(json!([0, 0.004]), json!([1, 0]))).is_empty());
        let few = told(wave(json!([0, 0.004]), json!([1])));
        assert!(few.contains("/arcs/0/waveform/levels"), "{few}");
        let late = told(wave(json!([0, 0.04]), json!([1, 0])));
        assert!(
            late.contains("/arcs/0/waveform/times_s") && late.contains("0.04 s"),
            "{late}"
        );
        let drops = told(
            json!([{"droplets": {"period_s": 0.01, "radius_m": 5e-4, "height_m": 0.01, "speed_m_s": 1}}]),
        );
        assert!(
            drops.contains("/arcs/0/droplets") && drops.contains("'flow'"),
            "{drops}"
        );
        let heat = told(json!([{}, {"heat": {"parts": ["radiation"]}}]));
        assert!(
            heat.contains("/arcs/1/heat") && heat.contains("'arc'"),
            "{heat}"
        );
    }

    #[test]
    fn pulses_of_few_steps_are_noted() {
        let wave = |period: f64| json!([{"waveform": {"period_s": period, "times_s": [0], "levels": [1]}}]);
        assert_eq!(blurred(&scene(wave(5e-4))).count(), 1);
        assert_eq!(blurred(&scene(wave(5e-3))).count(), 0);
    }
}
