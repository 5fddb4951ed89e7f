//! A weld is measured alike wherever it lies: turned, shifted, mirrored, of half a plate, on a plate at another height.

use std::path::Path;

use artefact::{Frame, Precision, Record, Writer};
use serde_json::{Value, json};

use crate::{report, sample};

/// Particle spacing \[m\].
const D: f64 = 1e-3;
/// Half of the plate's width, its length, its thickness, in spacings.
const PLATE: [i32; 3] = [12, 34, 9];
/// Where the source starts \[m\], and its speed \[m/s\].
const START: f64 = 4e-3;
const SPEED: f64 = 12e-3;

/// How a weld lies in its scene. It runs along +y in its own coordinates, with the surface of the plate at 0.
#[derive(Clone, Copy)]
struct Placed {
    /// Turned about z, in quarters.
    turn: f64,
    /// Whether y is reflected first.
    mirrored: bool,
    shift: [f64; 3],
    /// How much wider it is on the right than on the left.
    lean: f64,
    /// Whether the half beyond the mirror x = 0 is left out.
    half: bool,
    /// Whether torches move in place of a source.
    torches: bool,
    /// Whether a drop has flown off and lies on the plate.
    spatter: bool,
    /// Thickness of the plate in spacings.
    thick: i32,
}

const AS_IT_IS: Placed = Placed {
    turn: 0.0,
    mirrored: false,
    shift: [0.0; 3],
    lean: 1.25,
    half: false,
    torches: false,
    spatter: false,
    thick: PLATE[2],
};

impl Placed {
    fn turned(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let y = if self.mirrored { -y } else { y };
        let (sin, cos) = (std::f64::consts::FRAC_PI_2 * self.turn).sin_cos();
        [x * cos - y * sin, x * sin + y * cos, z]
    }

    fn world(&self, p: [f64; 3]) -> [f64; 3] {
        let p = self.turned(p);
        [0, 1, 2].map(|k| p[k] + self.shift[k])
    }

    /// Corners of the plate in its scene.
    fn corners(&self) -> [[f64; 3]; 2] {
        let [half, long, _] = PLATE.map(|n| f64::from(n) * D);
        let low = if self.half { 0.0 } else { -half };
        let thick = f64::from(self.thick) * D;
        let corners = [
            [low, 0.0, -thick],
            [half, 0.0, 0.0],
            [low, long, 0.0],
            [half, long, -thick],
        ];
        let all = corners.map(|p| self.world(p));
        [f64::min, f64::max]
            .map(|of| [0, 1, 2].map(|k| all.iter().map(|p| p[k]).reduce(of).unwrap()))
    }

    /// Its header, with the path of its torches.
    fn header(&self) -> artefact::Header {
        let ends = [START, START + 2.0 * SPEED].map(|y| self.world([0.0, y, 0.0]));
        let mut header = sample::header("particle-frames", "poolsph");
        if self.torches {
            header.scene = json!({"torches": [{"power_w": 1.0, "path": {"points_m": ends, "speed_m_s": SPEED}}]});
        }
        header
    }

    fn write(&self, path: &Path) {
        let mut writer = Writer::create(path, &self.header()).unwrap();
        let [low, high] = self.corners();
        let direction = match self.torches {
            true => [0.0, 1.0, 0.0],
            false => self.turned([0.0, 1.0, 0.0]),
        };
        let mut plate = json!({"min_m": low, "max_m": high, "spacing_m": D, "particle_volume_m3": D.powi(3),
            "melting_point_k": 1750.0, "direction": direction});
        if self.half {
            plate["mirror_x_m"] = json!(self.world([0.0; 3])[0]);
        }
        writer
            .json("/plate", 0.0, ("test.plate", "{}"), &plate)
            .unwrap();
        for time in [0.0, 1.0, 1.8, 2.0] {
            let [x, y, z] = self.world([0.0, START + SPEED * time, 0.0]);
            let source =
                json!({"time_s": time, "x_m": x, "y_m": y, "z_m": z, "phase": 0.0, "droplet": 0});
            if !self.torches {
                writer
                    .json("/source", time, ("test.source", "{}"), &source)
                    .unwrap();
            }
            writer.frame("/particles", time, &self.frame(time)).unwrap();
            let balance = Record::new()
                .with("energy_in_torches_j", "J", 1e3 * time)
                .with("energy_stored_j", "J", 1e3 * time);
            writer.record("/balance", time, &balance).unwrap();
            writer
                .record(
                    "/probes",
                    time,
                    &Record::new().with("couple", "K", 300.0 + time),
                )
                .unwrap();
        }
        writer.finish().unwrap();
    }

    /// The weld as far as the source has come: 3000 K on its line, 250 K less for each mm from it.
    fn frame(&self, time: f64) -> Frame {
        let source = START + SPEED * time;
        let (mut position, mut heat, mut molten, mut fused) = (vec![], vec![], vec![], vec![]);
        let first = if self.half { 0 } else { -PLATE[0] };
        for (i, j) in (first..PLATE[0]).flat_map(|i| (0..PLATE[1]).map(move |j| (i, j))) {
            for k in -self.thick..0 {
                let p = [i, j, k].map(|n| (f64::from(n) + 0.5) * D);
                let wide = if p[0] > 0.0 { self.lean } else { 1.0 };
                let welded = time > 0.0 && p[1] > 2e-3 && p[1] < source + 2e-3;
                let t = 3000.0 - 250e3 * (p[0] / wide).hypot(p[2]);
                let t = if welded { t.max(300.0) } else { 300.0 };
                position.push(self.world(p));
                heat.push(t);
                molten.push(u8::from(t > 1750.0 && p[1] > source - 5e-3));
                fused.push(f64::from(u8::from(t > 1750.0)));
            }
        }
        if self.spatter && time > 0.0 {
            position.push(self.world([9.3e-3, 33.5e-3, 0.6e-3]));
            heat.push(1800.0);
            molten.push(1);
            fused.push(1.0);
        }
        let id = 0..position.len() as u32;
        Frame::new(Precision::F64)
            .positions(position)
            .scalar("temperature", "K", heat)
            .scalar("fused", "1", fused)
            .flag("molten", molten)
            .id("id", id)
    }

    /// What a command says of it.
    fn said(&self, words: &[&str]) -> (Option<i32>, String, String) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pool.mcap");
        self.write(&path);
        let mut all = words.to_vec();
        all.push(path.to_str().unwrap());
        let output = report(&all);
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (
            output.status.code(),
            text(&output.stdout),
            text(&output.stderr),
        )
    }

    fn told(&self, words: &[&str]) -> String {
        let (code, out, err) = self.said(words);
        assert_eq!(code, Some(0), "{err}");
        out
    }

    fn figures(&self) -> Value {
        serde_json::from_str(&self.told(&["figures", "--pool"])).unwrap()
    }

    /// Widths of the heat-affected zone to the left, to the right and below \[m\].
    fn zone(&self) -> [f64; 3] {
        let told = self.told(&["probes"]);
        let row: Vec<f64> = told
            .lines()
            .last()
            .unwrap()
            .split(',')
            .map(|n| n.parse().unwrap())
            .collect();
        [row[2], row[3], row[4]]
    }

    fn torch(&self) -> Value {
        serde_json::from_str(&self.told(&["goldak", "--melt"])).unwrap()
    }
}

/// The same names, and values that differ by less than a part of a spacing. Areas count cells of a grid, and those that a line halves may
/// count or not.
fn same(found: &Value, as_it_is: &Value, part: f64) {
    let (found, wanted) = (found.as_object().unwrap(), as_it_is.as_object().unwrap());
    assert_eq!(found.len(), wanted.len());
    for (name, own) in wanted {
        let size = match own["unit"].as_str().unwrap() {
            "m" => D,
            "m2" => D * D * (0.2 / part).max(1.0),
            _ => 1.0,
        };
        let [a, b] = [&found[name], own].map(|of| of["value"].as_f64().unwrap());
        assert!((a - b).abs() <= part * size, "{name}: {a} {b}");
        assert_eq!(found[name]["frozen"], own["frozen"], "{name}");
    }
}

#[test]
fn measures_do_not_depend_on_turn_shift_and_mirror() {
    let wanted = AS_IT_IS.figures();
    assert_eq!(wanted["penetration"]["frozen"], true);
    let of = |name: &str| wanted[name]["value"].as_f64().unwrap();
    assert!(
        (of("penetration") - 5e-3).abs() < 0.5 * D
            && (of("fused_half_width") - 6.25e-3).abs() < 0.5 * D
    );
    for turn in [1.0, 2.0, 3.0, 0.3] {
        for mirrored in [false, true] {
            same(
                &Placed {
                    turn,
                    mirrored,
                    ..AS_IT_IS
                }
                .figures(),
                &wanted,
                1e-6,
            );
        }
    }
    same(
        &Placed {
            mirrored: true,
            ..AS_IT_IS
        }
        .figures(),
        &wanted,
        1e-6,
    );
    // Shifted by whole cells of the grid of sections, and by parts of them.
    for (shift, part) in [
        ([16e-3, -7e-3, 5e-3], 1e-6),
        ([3.21e-3, 1.17e-3, -4.03e-3], 0.3),
    ] {
        same(
            &Placed {
                shift,
                turn: 1.0,
                ..AS_IT_IS
            }
            .figures(),
            &wanted,
            part,
        );
        same(&Placed { shift, ..AS_IT_IS }.figures(), &wanted, part);
    }
}

#[test]
fn torches_without_a_source_say_where_the_weld_runs() {
    let wanted = AS_IT_IS.figures();
    for turn in [0.0, 1.0, 2.0] {
        let shift = [3e-3, 2e-3, 1e-3];
        same(
            &Placed {
                turn,
                shift,
                torches: true,
                ..AS_IT_IS
            }
            .figures(),
            &wanted,
            1e-6,
        );
    }
}

#[test]
fn half_a_weld_is_measured_as_the_whole() {
    let whole = Placed {
        lean: 1.0,
        ..AS_IT_IS
    };
    let half = Placed {
        half: true,
        ..whole
    };
    // Cells of the grid that the fusion line halves may count on one side or on both.
    same(&half.figures(), &whole.figures(), 0.02);
    let (whole, half) = (whole.zone(), half.zone());
    assert!(
        (0..3).all(|k| (whole[k] - half[k]).abs() < 1e-9),
        "{whole:?} {half:?}"
    );
}

#[test]
fn the_heat_affected_zone_goes_with_the_weld_and_not_with_its_spatter() {
    let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-9);
    let wanted = AS_IT_IS.zone();
    // From 1750 K to 1000.15 K at 250 K for each mm.
    assert!(
        (wanted[2] - 2.9994e-3).abs() < 0.1 * D && (wanted[1] - 1.25 * 2.9994e-3).abs() < 0.1 * D,
        "{wanted:?}"
    );
    for turn in [0.0, 1.0, 2.0] {
        let placed = Placed {
            turn,
            shift: [16e-3, -7e-3, 5e-3],
            spatter: true,
            ..AS_IT_IS
        };
        assert!(
            near(placed.zone(), wanted),
            "{turn} {:?} {wanted:?}",
            placed.zone()
        );
        let [right, left, below] = Placed {
            mirrored: true,
            ..placed
        }
        .zone();
        assert!(near([left, right, below], wanted));
    }
}

#[test]
fn a_fitted_source_goes_along_its_weld() {
    let shape = |placed: Placed| placed.torch()["shape"]["double_ellipsoid"].clone();
    let wanted = shape(AS_IT_IS);
    for (turn, mirrored) in [(1.0, false), (2.0, false), (3.0, true), (0.0, true)] {
        let placed = Placed {
            turn,
            mirrored,
            shift: [16e-3, -7e-3, 5e-3],
            ..AS_IT_IS
        };
        let torch = placed.torch();
        for key in ["half_width_m", "depth_m", "front_m", "rear_m"] {
            let [a, b] =
                [&torch["shape"]["double_ellipsoid"], &wanted].map(|of| of[key].as_f64().unwrap());
            assert!((a - b).abs() < 1e-9, "{key} {a} {b}");
        }
        let ends = [START, START + 2.0 * SPEED].map(|y| placed.world([0.0, y, 0.0]));
        for (end, at) in ends
            .iter()
            .zip(torch["path"]["points_m"].as_array().unwrap())
        {
            assert!(
                (0..3).all(|k| (end[k] - at[k].as_f64().unwrap()).abs() < 1e-9),
                "{torch}"
            );
        }
    }
}

#[test]
fn a_plate_that_is_fused_through_is_told_and_no_deeper_than_it_is_thick() {
    let figures = Placed {
        thick: 4,
        ..AS_IT_IS
    }
    .figures();
    let penetration = &figures["penetration"];
    assert!(
        (penetration["value"].as_f64().unwrap() - 4e-3).abs() < 1e-9,
        "{penetration}"
    );
    assert_eq!(penetration["through"], true);
    assert!(AS_IT_IS.figures()["penetration"].get("through").is_none());
}

#[test]
fn a_path_with_a_corner_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pool.mcap");
    let mut header = sample::header("particle-frames", "poolsph");
    header.scene = json!({"torches": [{"path": {"points_m": [[0, 4e-3, 0], [0, 16e-3, 0], [9e-3, 28e-3, 0]]}}]});
    let mut writer = Writer::create(&path, &header).unwrap();
    let [low, high] = AS_IT_IS.corners();
    let plate = json!({"min_m": low, "max_m": high, "spacing_m": D});
    writer
        .json("/plate", 0.0, ("test.plate", "{}"), &plate)
        .unwrap();
    writer
        .frame("/particles", 2.0, &AS_IT_IS.frame(2.0))
        .unwrap();
    writer.finish().unwrap();
    let output = report(&["figures", "--pool", path.to_str().unwrap()]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(
        said.contains("strays") && serde_json::from_slice::<Value>(&output.stdout).is_ok(),
        "{said}"
    );
}
