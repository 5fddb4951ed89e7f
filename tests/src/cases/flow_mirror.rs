//! `flow-mirror`: half a layer beside a mirror, and the whole.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::norms::Worst as _;
use crate::particles::{Frames, number};

/// The case.
pub(super) struct FlowMirror;

/// Cells along each axis of the grid on which fields are compared.
const CELLS: [usize; 3] = [8, 2, 4];

impl Case for FlowMirror {
    fn name(&self) -> &'static str {
        "flow-mirror"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "the whole layer, whose middle plane is the mirror"
    }

    fn targets(&self) -> Vec<Target> {
        let each = (1..=3).flat_map(|level| {
            [
                Target::error("speed", 0.02).at_level(level),
                Target::error("temperature", 0.02).at_level(level),
                Target::error("energy", 0.01).at_level(level),
                Target::error("heat", 0.01).at_level(level),
            ]
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        // 5, 8 and 10 layers; 8 need their own width.
        let layers = [5.0, 8.0, 10.0][level.clamp(1, 3) as usize - 1];
        let spacing = 2.5e-3 / layers;
        let patch = json!({"spacing_m": spacing});
        let label = format!("level{level}");
        let half = lab.run("poolsph", self.name(), &label, &patch)?;
        let deep = number(&half, "/faces/max_m/1")?;
        let (mut bodies, mut faces) = (half.scene["bodies"].clone(), half.scene["faces"].clone());
        bodies[0]["shape"]["box"]["min_m"][1] = json!(-deep);
        faces["min_m"][1] = json!(-deep);
        faces["mirror"] = json!([]);
        let walls = faces["wall"].as_array_mut();
        walls
            .into_iter()
            .for_each(|walls| walls.push(json!({"face": "y-"})));
        let whole = json!({"bodies": bodies, "faces": faces});
        let whole = lab.varied(&half, &format!("{label}-whole"), &whole)?;
        let errors = errors(&half, &whole, deep)?;
        let points = Frames::read(&half.artefact, "temperature")?.liquid.len() as u64;
        Ok(Measurement::over(
            vec![half, whole],
            points,
            spacing,
            errors,
        ))
    }
}

/// Means over the second half of the run, on a grid: greatest differences over the range of the whole; energy of motion, and
/// heat that walls give and take, twice the half's beside the whole's.
fn errors(half: &Finished, whole: &Finished, deep: f64) -> Result<Errors, LabError> {
    let size = [
        number(half, "/faces/max_m/0")?,
        deep,
        number(half, "/bodies/0/shape/box/max_m/2")?,
    ];
    let [one, other] = [half, whole].map(|run| Frames::read(&run.artefact, "temperature"));
    let (one, other) = (gridded(&one?, size), gridded(&other?, size));
    let scale = |of: fn(&Cell) -> f64| {
        let all = other.iter().map(of);
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        high - low
    };
    let worst = |of: fn(&Cell) -> f64| {
        let apart = one.iter().zip(&other).map(|(a, b)| (of(a) - of(b)).abs());
        apart.worst()
    };
    let along = |cell: &Cell| cell.mean[0];
    let kelvin = |cell: &Cell| cell.mean[1];
    let energy = |cells: &[Cell]| cells.iter().map(|cell| cell.square).sum::<f64>();
    // Between a hot and a cold wall the sum of both says nothing.
    let heat = |name: &str| {
        let of = |run: &Finished| run.closing(name);
        (2.0 * of(half) / of(whole) - 1.0).abs()
    };
    let errors = [
        ("speed", worst(along) / scale(along)),
        ("temperature", worst(kelvin) / scale(kelvin)),
        ("energy", (energy(&one) / energy(&other) - 1.0).abs()),
        (
            "heat",
            heat("energy_in_walls_j").max(heat("energy_out_walls_j")),
        ),
    ];
    Ok(errors.map(|(name, error)| (name.to_owned(), error)).into())
}

/// What a cell of the grid holds in the mean.
#[derive(Clone, Copy)]
struct Cell {
    /// u along x \[m/s\] and T \[K\].
    mean: [f64; 2],
    /// u^2 \[m2/s2\] times its particles per frame.
    square: f64,
}

/// Means over cells beside the mirror plane, both sides taken together.
fn gridded(frames: &Frames, size: [f64; 3]) -> Vec<Cell> {
    let mut sums = vec![[0.0; 4]; CELLS.iter().product()];
    let mut sides = 1.0;
    for k in frames.second_half() {
        for (a, x) in frames.position[k].iter().enumerate() {
            if x[1] < 0.0 {
                sides = 2.0;
            }
            let place = [x[0], x[1].abs(), x[2]];
            let cell: [usize; 3] = std::array::from_fn(|i| {
                let at = place[i] / size[i] * CELLS[i] as f64;
                (at.max(0.0) as usize).min(CELLS[i] - 1)
            });
            let u = frames.velocity[k][a];
            let sum = &mut sums[(cell[2] * CELLS[1] + cell[1]) * CELLS[0] + cell[0]];
            let more = [
                u[0],
                frames.scalar[k][a],
                u.iter().map(|u| u * u).sum(),
                1.0,
            ];
            *sum = std::array::from_fn(|i| sum[i] + more[i]);
        }
    }
    let cells = sums.iter().map(|[u, kelvin, square, count]| Cell {
        mean: [u / count, kelvin / count],
        square: square / sides,
    });
    cells.collect()
}
