//! Columns of fields, and the quantities that they make up.

use artefact::{Frame, Table};

/// Named columns of equal length with their units.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Columns {
    all: Vec<(String, String, Vec<f64>)>,
}

/// A quantity that `emfield` writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Quantity {
    /// Begin of the names of its columns.
    pub(crate) stem: &'static str,
    /// What it is called.
    pub(crate) title: &'static str,
    /// Whether it is of conductors alone.
    pub(crate) conductors: bool,
}

/// All quantities in the order in which they are shown.
pub(crate) const QUANTITIES: [Quantity; 8] = [
    quantity("potential", "potential", false),
    quantity("electric_field", "electric field", false),
    quantity("vector_potential", "vector potential", false),
    quantity("magnetic_field", "magnetic field", false),
    quantity("magnetic_flux_density", "flux density", false),
    quantity("current_density", "current density", true),
    quantity("force_density", "force density", true),
    quantity("joule_heat", "Joule heat", true),
];

const fn quantity(stem: &'static str, title: &'static str, conductors: bool) -> Quantity {
    Quantity {
        stem,
        title,
        conductors,
    }
}

/// The real or the imaginary part of a phasor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// At the greatest current of the coils.
    Real,
    /// A quarter of a period earlier, while that current rises through zero.
    Imaginary,
}

impl Columns {
    /// The columns of a frame.
    pub(crate) fn of_frame(frame: &Frame) -> Self {
        let one = |c: &artefact::Column| (c.name.clone(), c.unit.clone(), c.values.to_f64());
        Self {
            all: frame.columns().iter().map(one).collect(),
        }
    }

    /// The columns of a table.
    pub(crate) fn of_table(table: &Table) -> Self {
        let one = |c: &artefact::Series| (c.name.clone(), c.unit.clone(), c.values.clone());
        Self {
            all: table.columns.iter().map(one).collect(),
        }
    }

    /// Columns with names and units.
    pub(crate) fn of(all: Vec<(String, String, Vec<f64>)>) -> Self {
        Self { all }
    }

    /// The values of a column.
    pub(crate) fn get(&self, name: &str) -> Option<&[f64]> {
        let found = self.all.iter().find(|(n, _, _)| n == name);
        found.map(|(_, _, values)| values.as_slice())
    }

    /// The parts of a quantity: components, real and imaginary ones.
    fn parts(&self, stem: &str) -> Vec<(&str, &[f64])> {
        let own = |name: &str| {
            let Some(rest) = name.strip_prefix(stem) else {
                return false;
            };
            let rest = rest.strip_prefix("_real").unwrap_or(rest);
            let rest = rest.strip_prefix("_imag").unwrap_or(rest);
            matches!(rest, "" | "_x" | "_y" | "_z")
        };
        let found = self.all.iter().filter(|(name, _, _)| own(name));
        found.map(|(n, _, v)| (n.as_str(), v.as_slice())).collect()
    }

    /// Unit of a quantity; `None` where it is absent.
    pub(crate) fn unit(&self, quantity: &Quantity) -> Option<&str> {
        let first = self.parts(quantity.stem).first()?.0;
        let found = self.all.iter().find(|(n, _, _)| n == first);
        found.map(|(_, unit, _)| unit.as_str())
    }

    /// Whether a quantity is the size of several parts: a vector or a phasor.
    pub(crate) fn is_size(&self, quantity: &Quantity) -> bool {
        self.parts(quantity.stem).len() > 1
    }

    /// Values of a quantity: its size, or with its sign what has one part alone.
    pub(crate) fn values(&self, quantity: &Quantity) -> Option<Vec<f64>> {
        let parts = self.parts(quantity.stem);
        match parts.as_slice() {
            [] => None,
            [(_, one)] => Some(one.to_vec()),
            [(_, first), ..] => {
                let size = |n: usize| parts.iter().map(|(_, v)| v[n] * v[n]).sum::<f64>().sqrt();
                Some((0..first.len()).map(size).collect())
            }
        }
    }

    /// Size of what a quantity differs by from the same of other columns, which must have the same parts.
    pub(crate) fn difference(&self, other: &Self, quantity: &Quantity) -> Option<Vec<f64>> {
        let (own, their) = (self.parts(quantity.stem), other.parts(quantity.stem));
        let count = own.first()?.1.len();
        let mut sum = vec![0.0; count];
        for (name, values) in &own {
            let wanted = their.iter().find(|(n, _)| n == name)?.1;
            if wanted.len() != count {
                return None;
            }
            for (sum, (a, b)) in sum.iter_mut().zip(values.iter().zip(wanted)) {
                *sum += (a - b) * (a - b);
            }
        }
        Some(sum.into_iter().map(f64::sqrt).collect())
    }

    /// The vectors of a quantity: of a phasor one part.
    pub(crate) fn vectors(&self, quantity: &Quantity, part: Part) -> Option<Vec<[f64; 3]>> {
        let middle = match part {
            Part::Real => "_real",
            Part::Imaginary => "_imag",
        };
        self.joined(&format!("{}{middle}", quantity.stem))
            .or_else(|| self.joined(quantity.stem))
    }

    /// Vectors by the begin of the names of their components.
    pub(crate) fn joined(&self, stem: &str) -> Option<Vec<[f64; 3]>> {
        let of = |axis: &str| self.get(&format!("{stem}_{axis}"));
        let (x, y, z) = (of("x")?, of("y")?, of("z")?);
        Some((0..x.len()).map(|n| [x[n], y[n], z[n]]).collect())
    }
}

/// A unit with a prefix that keeps numbers up to `most` short, and the factor to it. Powers are raised, and with them the
/// prefix: mm² are 1e-6 m².
pub(crate) fn prefixed(unit: &str, most: f64) -> (String, f64) {
    const PREFIXES: [(&str, f64); 9] = [
        ("G", 1e9),
        ("M", 1e6),
        ("k", 1e3),
        ("", 1.0),
        ("m", 1e-3),
        ("\u{b5}", 1e-6),
        ("n", 1e-9),
        ("p", 1e-12),
        ("f", 1e-15),
    ];
    let raised = unit.replace("m2", "m\u{b2}").replace("m3", "m\u{b3}");
    // The power of the symbol that takes the prefix.
    let after = unit.trim_start_matches(char::is_alphabetic);
    let power = after.chars().next().and_then(|c| c.to_digit(10));
    let power = power.filter(|_| after.len() < unit.len()).unwrap_or(1);
    let sized = PREFIXES.map(|(prefix, size)| (prefix, size.powi(power.cast_signed())));
    let fits = |(_, size): &&(&str, f64)| most >= *size * 0.9999;
    let (prefix, size) = sized.iter().find(fits).copied().unwrap_or(("", 1.0));
    (format!("{prefix}{raised}"), 1.0 / size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns() -> Columns {
        let one = |n: &str, v: f64| (n.to_owned(), "T".to_owned(), vec![v, 2.0 * v]);
        Columns::of(vec![
            one("magnetic_flux_density_real_x", 1.0),
            one("magnetic_flux_density_real_y", 0.0),
            one("magnetic_flux_density_real_z", 2.0),
            one("magnetic_flux_density_imag_x", 0.0),
            one("magnetic_flux_density_imag_y", -2.0),
            one("magnetic_flux_density_imag_z", 0.0),
            one("potential", -3.0),
        ])
    }

    #[test]
    fn a_phasor_has_one_size_and_two_vectors() {
        let all = columns();
        let (potential, flux) = (QUANTITIES[0], QUANTITIES[4]);
        assert_eq!(all.values(&flux), Some(vec![3.0, 6.0]));
        let vectors = all.vectors(&flux, Part::Imaginary).unwrap();
        assert!(vectors[1][0].abs() < 1e-15 && (vectors[1][1] + 4.0).abs() < 1e-15);
        assert_eq!(all.values(&potential), Some(vec![-3.0, -6.0]));
        assert_eq!(all.values(&QUANTITIES[1]), None);
        assert!(all.is_size(&flux) && !all.is_size(&potential));
        assert_eq!(all.difference(&all, &flux), Some(vec![0.0, 0.0]));
    }

    #[test]
    fn units_get_a_prefix_by_the_largest_value() {
        assert_eq!(prefixed("A/m2", 1.7e8), ("MA/m\u{b2}".to_owned(), 1e-6));
        assert_eq!(prefixed("T", 0.04).0, "mT");
        assert_eq!(prefixed("V", 2500.0).0, "kV");
        assert_eq!(prefixed("V", 0.0), ("V".to_owned(), 1.0));
        let (area, factor) = prefixed("m2", 3e-6);
        assert!(area == "mm\u{b2}" && (3e-6 * factor - 3.0).abs() < 1e-12);
        let (flow, factor) = prefixed("m3/s", 2e-7);
        assert!(flow == "mm\u{b3}/s" && (2e-7 * factor - 200.0).abs() < 1e-9);
    }
}
