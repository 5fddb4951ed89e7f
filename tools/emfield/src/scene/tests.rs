use super::*;

const GOOD: &str = r#"{"geometry": "space", "domain": {"box": {"min_m": [-1, -1, -1], "max_m": [1, 1, 1]}},
    "bodies": [{"name": "ball", "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 0.3}}}],
    "electrostatics": {"outer": [{"potential_v": {"expr": "z"}}]}, "points": {"spacing_m": 0.1}}"#;

/// Paths of what is wrong with the good scene after a text in it has been replaced.
fn wrong(from: &str, to: &str) -> Vec<String> {
    let text = GOOD.replace(from, to);
    assert_ne!(text, GOOD, "{from} is not there");
    let scene: Scene = serde_json::from_str(&text).unwrap();
    scene.faults().iter().map(|f| f.path().to_owned()).collect()
}

#[test]
fn a_good_scene_has_no_fault() {
    let scene: Scene = serde_json::from_str(GOOD).unwrap();
    assert!(scene.faults().is_empty());
    assert_eq!(scene.medium_name(1), "ball");
    assert_eq!(scene.medium(0), Medium::default());
}

#[test]
fn faults_are_located() {
    assert_eq!(wrong("[1, 1, 1]", "[1, 1]"), ["/domain/box/max_m"]);
    assert_eq!(wrong("[1, 1, 1]", "[1, -1, 1]"), ["/domain/box/max_m/1"]);
    assert_eq!(wrong("\"ball\"", "\"surroundings\""), ["/bodies/0/name"]);
    assert_eq!(
        wrong(r#""expr": "z""#, r#""expr": "q + 1""#),
        ["/electrostatics/outer/0/potential_v/expr"]
    );
    assert_eq!(
        wrong(
            r#"[{"potential_v""#,
            r#"[{"faces": ["z+", "top"], "potential_v""#
        ),
        ["/electrostatics/outer/0/faces/1"]
    );
    assert_eq!(
        wrong(r#"{"outer": [{"potential_v": {"expr": "z"}}]}"#, "{}"),
        ["/electrostatics"]
    );
    let none = wrong(
        r#""electrostatics": {"outer": [{"potential_v": {"expr": "z"}}]}, "#,
        "",
    );
    assert_eq!(none, [""]);
    let plane = wrong("\"space\"", "\"plane\"");
    assert!(plane.contains(&"/domain/box/min_m".to_owned()));
    assert!(plane.contains(&"/bodies/0/shape".to_owned()));
}

#[test]
fn faults_of_open_walls_are_located() {
    let open = |text: &str| {
        wrong(
            r#""electrostatics": {"outer": [{"potential_v": {"expr": "z"}}]}"#,
            &format!(r#""electrostatics": {{{text}}}"#),
        )
    };
    let multipole = r#""outer": "multipole""#;
    assert_eq!(open(multipole), ["/electrostatics"]);
    let applied = r#""applied_potential_v": {"expr": "x*y"}"#;
    assert_eq!(open(&format!("{multipole}, {applied}")), [""; 0]);
    let uniform = r#""applied_field_v_m": [1, 0, 0]"#;
    assert_eq!(open(&format!("{multipole}, {uniform}")), [""; 0]);
    let at = "/electrostatics/applied_potential_v";
    assert_eq!(open(&format!("{uniform}, {applied}")), [at]);
    let formula = r#""applied_potential_v": {"expr": "q"}"#;
    assert_eq!(
        open(&format!("{multipole}, {formula}")),
        [format!("{at}/expr")]
    );
    let ring = GOOD
        .replace("space", "axisymmetric")
        .replace("[-1, -1, -1]", "[0.1, -1]")
        .replace("[1, 1, 1]", "[1, 1]")
        .replace(
            r#""sphere": {"centre_m": [0, 0, 0]"#,
            r#""disc": {"centre_m": [0.5, 0]"#,
        )
        .replace(
            r#"[{"potential_v": {"expr": "z"}}]"#,
            r#""multipole", "applied_field_v_m": [0, 1]"#,
        );
    let scene: Scene = serde_json::from_str(&ring).unwrap();
    let faults = scene.faults();
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert_eq!(faults[0].path(), "/electrostatics/outer");
}

#[test]
fn faults_of_eddy_currents_are_located() {
    let eddy = |text: &str| {
        wrong(
            r#""electrostatics": {"outer": [{"potential_v": {"expr": "z"}}]}"#,
            &format!(r#""eddy_currents": {{{text}}}"#),
        )
    };
    let at = "/eddy_currents";
    let applied = r#""applied_flux_density_t": [0, 0, 1]"#;
    let harmonic = r#""harmonic": {"frequency_hz": 50}"#;
    assert!(eddy(&format!("{harmonic}, {applied}")).is_empty());
    assert_eq!(eddy(applied), [at]);
    assert_eq!(eddy(harmonic), [at]);
    let both = format!(r#"{harmonic}, {applied}, "transient": {{"end_s": 1, "step_s": 0.1}}"#);
    assert_eq!(eddy(&both), [format!("{at}/transient")]);
    let wire =
        format!(r#"{harmonic}, "coils": [{{"wire": {{"place_m": [0, 0], "current_a": 1}}}}]"#);
    assert_eq!(eddy(&wire), [format!("{at}/coils/0")]);
    let wave = format!(
        r#"{applied}, "transient": {{"end_s": 1, "step_s": 0.1, "wave": {{"expr": "x"}}}}"#
    );
    assert_eq!(eddy(&wave), [format!("{at}/transient/wave/expr")]);
    let grown = |most: f64| {
        eddy(&format!(
            r#"{applied}, "transient": {{"end_s": 1, "step_s": 0.1, "adaptive": {{"greatest_s": {most}}}}}"#
        ))
    };
    let short = format!("{at}/transient/adaptive/greatest_s");
    assert_eq!((grown(0.05), grown(0.1)), (vec![short], Vec::new()));
}

#[test]
fn ways_that_equations_do_not_have_are_refused() {
    let with = |method: &str, more: &str| {
        let new = format!(r#""method": {{{method}}}, {more}"electrostatics""#);
        wrong(r#""electrostatics""#, &new)
    };
    let eddy = r#""eddy_currents": {"harmonic": {"frequency_hz": 50}, "applied_flux_density_t": [0, 0, 1]}, "#;
    let smeared = r#""interfaces": {"smeared": {}}"#;
    assert_eq!(with(smeared, ""), [""; 0]);
    assert_eq!(with(smeared, eddy), ["/method/interfaces/smeared"]);
    assert_eq!(with(r#""positive": true"#, ""), [""; 0]);
    let quartics = r#""order": 4, "positive": true"#;
    assert_eq!(with(quartics, ""), ["/method/positive"]);
    let quartics = format!("{quartics}, {smeared}");
    assert_eq!(with(&quartics, ""), ["/method/positive"]);
    let cubics = format!(r#""order": 3, "positive": true, {smeared}"#);
    assert_eq!(with(&cubics, ""), [""; 0]);
}

#[test]
fn peak_currents_are_root_mean_squares_too() {
    let text = r#"{"harmonic": {"frequency_hz": 50}, "amplitude": "peak"}"#;
    let currents: EddyCurrents = serde_json::from_str(text).unwrap();
    assert!((currents.rms(2.0) - 2.0_f64.sqrt()).abs() < 1e-15);
    let text = r#"{"transient": {"end_s": 1, "step_s": 0.1}, "amplitude": "peak"}"#;
    let currents: EddyCurrents = serde_json::from_str(text).unwrap();
    assert!((currents.rms(2.0) - 2.0).abs() < 1e-15);
}

#[test]
fn a_march_shorter_than_stamps_of_time_has_its_end() {
    let output = Output::default();
    assert_eq!(output.instants(1e-14), [1e-14]);
    assert_eq!(output.instants(2e-5), [2e-5]);
}
