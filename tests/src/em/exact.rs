//! Exact fields along the lines of a scene of `emfield` whose solution is known, and its totals.
//!
//! Known are a dielectric sphere whose dipole is imposed on the walls, and a conducting sphere among coaxial
//! loops; the one lies about the origin, the other on the axis of the loops. Columns are named as `emfield` names them.

use serde_json::{Value, json};

use super::C;
use super::coaxial::Coaxial;
use super::dielectric::Sphere;
use super::sphere::Solution;
use super::walls::amounts;

/// A solution that is known.
#[derive(Debug, Clone)]
pub enum Known {
    /// A dielectric sphere in what was a uniform field.
    Dielectric(Sphere),
    /// A conducting sphere among loops.
    Conductor {
        /// The fields, seen from the centre of the sphere.
        solution: Box<Solution>,
        /// The sphere and the loops.
        scene: Coaxial,
    },
}

/// A value with its name and unit.
pub type Entry = (String, &'static str, f64);

/// A line by name, and its places \[m\].
pub type Places = (String, Vec<[f64; 3]>);

fn number(scene: &Value, pointer: &str) -> Result<f64, String> {
    let found = scene.pointer(pointer).and_then(Value::as_f64);
    found.ok_or_else(|| format!("the scene has no number at {pointer}"))
}

fn numbers(value: &Value) -> Option<[f64; 3]> {
    let part = |k: usize| value[k].as_f64();
    Some([part(0)?, part(1)?, part(2)?])
}

/// Places along the lines of a scene.
///
/// # Errors
/// Where one cannot be read.
pub fn lines(scene: &Value) -> Result<Vec<Places>, String> {
    let all = scene.pointer("/output/lines").and_then(Value::as_array);
    let mut found = Vec::new();
    for line in all.into_iter().flatten() {
        let read = || {
            let (from, to) = (numbers(&line["from_m"])?, numbers(&line["to_m"])?);
            let count = line["points"].as_u64().filter(|n| *n > 1)?;
            let at = |n: u64| {
                let t = n as f64 / (count - 1) as f64;
                [0, 1, 2].map(|k| from[k] + t * (to[k] - from[k]))
            };
            Some((
                line["name"].as_str()?.to_owned(),
                (0..count).map(at).collect(),
            ))
        };
        found.push(read().ok_or_else(|| format!("no line in space: {line}"))?);
    }
    Ok(found)
}

impl Known {
    /// The solution of a scene.
    ///
    /// # Errors
    /// Where none is known.
    pub fn of(scene: &Value) -> Result<Self, String> {
        let bodies = scene["bodies"].as_array().map_or(0, Vec::len);
        if scene["geometry"] != "space" || bodies != 1 {
            return Err("known is one sphere in space".to_owned());
        }
        if scene.get("electrostatics").is_some() {
            return Ok(Self::Dielectric(dielectric(scene)?));
        }
        let scene = Coaxial::of(scene)?;
        let solution = Solution::of(scene.body, scene.sources.clone());
        Ok(Self::Conductor {
            solution: Box::new(solution),
            scene,
        })
    }

    /// Where the solution comes from.
    #[must_use]
    pub fn source(&self) -> &'static str {
        match self {
            Self::Dielectric(_) => "dipole of the sphere, Matsuzawa (2017), eqs 3.3 to 3.11",
            Self::Conductor { .. } => {
                "spherical harmonics and Bessel functions, Smythe (1950), chapter XI, the current spread evenly over the wires"
            }
        }
    }

    /// All fields at a place.
    #[must_use]
    pub fn fields(&self, p: [f64; 3]) -> Vec<Entry> {
        match self {
            Self::Dielectric(sphere) => {
                let mut all = vec![("potential".to_owned(), "V", sphere.potential(p))];
                all.extend(vector("electric_field", "V/m", sphere.electric(p)));
                all
            }
            Self::Conductor { solution, scene } => currents(solution, scene, p),
        }
    }

    /// Force and heat.
    #[must_use]
    pub fn totals(&self) -> Vec<Entry> {
        match self {
            Self::Dielectric(_) => Vec::new(),
            Self::Conductor { solution, .. } => {
                let lift = ["volume", "maxwell", "coil"];
                let lift = lift.map(|n| (format!("force_{n}_z"), "N", solution.lift()));
                let heat = ["volume", "poynting"];
                let heat = heat.map(|n| (format!("power_{n}"), "W", solution.power()));
                lift.into_iter().chain(heat).collect()
            }
        }
    }

    /// Traction along the outward normal over the height of a place on the surface, as a line.
    fn surface(&self) -> Option<Value> {
        let Self::Dielectric(sphere) = self else {
            return None;
        };
        let cosines: Vec<f64> = (-50..=50).map(|k| f64::from(k) / 50.0).collect();
        let heights: Vec<f64> = cosines.iter().map(|c| c * sphere.radius).collect();
        let tractions: Vec<f64> = cosines.iter().map(|c| sphere.traction(*c)).collect();
        Some(json!({"name": "surface", "columns": [
            {"name": "z_m", "unit": "m", "values": heights},
            {"name": "traction", "unit": "N/m2", "values": tractions}
        ]}))
    }

    /// The solution along the lines of its scene, as a file.
    ///
    /// # Errors
    /// Where a line leaves the places where it is known.
    pub fn file(&self, scene: &Value) -> Result<Value, String> {
        let mut all = Vec::new();
        for (name, places) in lines(scene)? {
            if let Self::Conductor { scene, .. } = self
                && places
                    .iter()
                    .any(|p| length(scene.axes().place(*p)) >= scene.reach())
            {
                return Err(format!(
                    "line {name} leaves the ball within the nearest wire, {} m",
                    scene.reach()
                ));
            }
            let rows: Vec<Vec<Entry>> = places.iter().map(|p| self.fields(*p)).collect();
            let column = |k: usize| {
                let values: Vec<f64> = rows.iter().map(|r| r[k].2).collect();
                json!({"name": rows[0][k].0, "unit": rows[0][k].1, "values": values})
            };
            let count = rows.first().map_or(0, Vec::len);
            let columns: Vec<Value> = (0..count).map(column).collect();
            all.push(json!({"name": name, "columns": columns}));
        }
        all.extend(self.surface());
        let total =
            |(name, unit, value): Entry| json!({"name": name, "unit": unit, "value": value});
        Ok(json!({
            "kind": "field-exact",
            "version": "1.0",
            "source": self.source(),
            "lines": all,
            "totals": self.totals().into_iter().map(total).collect::<Vec<Value>>(),
        }))
    }
}

/// The sphere whose dipole the walls of a scene have.
pub(crate) fn dielectric(scene: &Value) -> Result<Sphere, String> {
    let centre = scene.pointer("/bodies/0/shape/sphere/centre_m");
    if centre.and_then(numbers).is_none_or(|c| length(c) > 0.0) {
        return Err("known is a dielectric sphere about the origin".to_owned());
    }
    let around = number(scene, "/surroundings/relative_permittivity").unwrap_or(1.0);
    let alone = Sphere {
        radius: number(scene, "/bodies/0/shape/sphere/radius_m")?,
        ratio: number(scene, "/bodies/0/relative_permittivity").unwrap_or(1.0) / around,
        around,
        field: 1.0,
        middle: 0.0,
    };
    let [field, middle] = amounts(scene, [&|p| alone.potential(p), &|_| 1.0])?;
    Ok(Sphere {
        field,
        middle,
        ..alone
    })
}

/// Fields of the conducting sphere: what goes around the axis, and what lies in its planes.
fn currents(solution: &Solution, scene: &Coaxial, p: [f64; 3]) -> Vec<Entry> {
    let p = scene.axes().place(p);
    let rho = p[0].hypot(p[1]);
    let share = if rho > 0.0 {
        [p[0] / rho, p[1] / rho]
    } else {
        [0.0; 2]
    };
    let zero = C::new(0.0, 0.0);
    let around = |v: C| [v * -share[1], v * share[0], zero];
    let inside = length(p) <= scene.body.radius;
    let potential = solution.potential(rho, p[2]);
    let [out, up] = solution.flux(rho, p[2]);
    let current = if inside {
        solution.current(rho, p[2])
    } else {
        zero
    };
    let mut all = phasor("vector_potential", "Wb/m", around(potential));
    all.extend(phasor(
        "magnetic_flux_density",
        "T",
        [out * share[0], out * share[1], up],
    ));
    all.extend(phasor("current_density", "A/m2", around(current)));
    let [away, along] = [(current * up.conj()).re, -(current * out.conj()).re];
    all.extend(vector(
        "force_density",
        "N/m3",
        [away * share[0], away * share[1], along],
    ));
    all.push((
        "joule_heat".to_owned(),
        "W/m3",
        current.norm_sqr() / scene.body.conductivity,
    ));
    all
}

fn vector(name: &str, unit: &'static str, v: [f64; 3]) -> Vec<Entry> {
    let each = ["x", "y", "z"].iter().zip(v);
    each.map(|(axis, v)| (format!("{name}_{axis}"), unit, v))
        .collect()
}

fn phasor(name: &str, unit: &'static str, v: [C; 3]) -> Vec<Entry> {
    let mut all = vector(&format!("{name}_real"), unit, v.map(|c| c.re));
    all.extend(vector(&format!("{name}_imag"), unit, v.map(|c| c.im)));
    all
}

fn length(p: [f64; 3]) -> f64 {
    p.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(text: &str) -> Value {
        serde_json::from_str(text).unwrap()
    }

    const DROP: &str = include_str!("../../../pipelines/levitation-field/scene.json");
    const SPHERE: &str = include_str!("../../../pipelines/dielectric-sphere/scene.json");

    #[test]
    fn the_dipole_is_read_from_the_walls() {
        let mut own = scene(SPHERE);
        let Known::Dielectric(sphere) = Known::of(&own).unwrap() else {
            panic!("no dielectric");
        };
        assert!((sphere.field + 5e6).abs() < 1e-3 && (sphere.middle - 2500.0).abs() < 1e-9);
        own["bodies"][0]["relative_permittivity"] = json!(2);
        assert!(Known::of(&own).is_err());
    }

    #[test]
    fn the_levitated_drop_has_its_known_lift_and_heat() {
        let known = Known::of(&scene(DROP)).unwrap();
        let of = |name: &str| known.totals().iter().find(|e| e.0 == name).unwrap().2;
        assert!((of("force_coil_z") / 0.026_570 - 1.0).abs() < 1e-4);
        assert!((of("power_volume") / 16.337 - 1.0).abs() < 1e-4);
    }

    #[test]
    fn lines_of_the_studies_are_known_all_along() {
        for text in [DROP, SPHERE] {
            let own = scene(text);
            let file = Known::of(&own).unwrap().file(&own).unwrap();
            let all = file["lines"].as_array().unwrap();
            let wanted = own["output"]["lines"].as_array().unwrap();
            for line in wanted {
                assert!(all.iter().any(|l| l["name"] == line["name"]));
            }
            let values = all.iter().flat_map(|l| l["columns"].as_array().unwrap());
            for column in values {
                let numbers = column["values"].as_array().unwrap();
                assert!(numbers.iter().all(Value::is_f64), "{}", column["name"]);
            }
        }
        let mut long = scene(DROP);
        long["output"]["lines"][0]["to_m"] = json!([0.01, 0, 0]);
        assert!(Known::of(&long).unwrap().file(&long).is_err());
    }

    #[test]
    fn the_force_is_that_of_current_and_flux_density() {
        let known = Known::of(&scene(DROP)).unwrap();
        let all = known.fields([1.3e-3, 0.9e-3, -1.7e-3]);
        let of = |name: String| all.iter().find(|e| e.0 == name).unwrap().2;
        let part = |stem: &str, axis: &str| {
            C::new(
                of(format!("{stem}_real_{axis}")),
                of(format!("{stem}_imag_{axis}")),
            )
        };
        let axes = ["x", "y", "z"];
        let j = axes.map(|a| part("current_density", a));
        let b = axes.map(|a| part("magnetic_flux_density", a).conj());
        for (k, axis) in axes.iter().enumerate() {
            let (m, n) = ((k + 1) % 3, (k + 2) % 3);
            let wanted = (j[m] * b[n] - j[n] * b[m]).re;
            let found = of(format!("force_density_{axis}"));
            assert!(
                (found - wanted).abs() < 1e-9 * wanted.abs().max(1.0),
                "{k}: {found} {wanted}"
            );
        }
    }
}
