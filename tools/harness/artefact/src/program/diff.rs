//! `artefact diff`: two files column by column.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use artefact::{Channel, Column, GRID, Header, Reader, TABLE, Values, sha256_file};

use super::Streams;
use super::open::open;
use super::sheet::Sheet;
use super::trouble::{Trouble, Verdict};

/// Arguments of `diff`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:
  target/release/artefact diff build/gmaw-quick/pool.mcap build/other/pool.mcap
For each column that differs it prints, over all messages of the channel,
  Linf      greatest difference, and where it is (time, row)
  L2        root of the mean square of the difference
  relative  L2 norm of the difference by the L2 norm of the column in A
Frames with a column 'id' are compared particle by particle. Headers (scene, inputs, versions) are
shown where they differ, and do not count: exit code 0 when all messages are equal, 1 when not.")]
pub(crate) struct Arguments {
    /// The reference file.
    #[arg(value_name = "A")]
    a: PathBuf,
    /// The other file.
    #[arg(value_name = "B")]
    b: PathBuf,
    /// Only these channels.
    #[arg(long, value_name = "CHANNEL")]
    channel: Vec<String>,
    /// Prints equal columns, too.
    #[arg(long)]
    all: bool,
}

/// The difference of a column over all messages.
#[derive(Debug, Default, Clone, PartialEq)]
struct Norms {
    entries: usize,
    differing: usize,
    greatest: f64,
    /// Time \[s\] and row of the greatest difference.
    place: (f64, usize),
    squares: f64,
    squares_of_a: f64,
}

impl Norms {
    fn add(&mut self, a: f64, b: f64, time_s: f64, row: usize) {
        self.entries += 1;
        self.squares_of_a += a * a;
        if a.to_bits() == b.to_bits() {
            return;
        }
        self.differing += 1;
        let d = (a - b).abs();
        // A NaN on one side is the greatest difference that there is.
        if self.differing == 1 || d > self.greatest || (d.is_nan() && !self.greatest.is_nan()) {
            self.greatest = d;
            self.place = (time_s, row);
        }
        self.squares += d * d;
    }

    fn l2(&self) -> f64 {
        (self.squares / self.entries.max(1) as f64).sqrt()
    }

    fn relative(&self) -> f64 {
        (self.squares / self.squares_of_a).sqrt()
    }
}

pub(crate) fn run(arguments: &Arguments, streams: &mut Streams<'_>) -> Result<Verdict, Trouble> {
    let (a, b) = (open(&arguments.a, streams)?, open(&arguments.b, streams)?);
    let bytes_equal = same_bytes(&arguments.a, &arguments.b)?;
    headers(a.header(), b.header(), streams)?;
    let mut equal = true;
    let pairs = pairs(&a, &b);
    let unknown = |name: &&String| !pairs.contains_key(*name);
    if let Some(name) = arguments.channel.iter().find(unknown) {
        let present: Vec<&str> = pairs.keys().map(String::as_str).collect();
        return Err(Trouble::Usage(format!(
            "neither file has a channel '{name}'; they have {}",
            present.join(", ")
        )));
    }
    for (name, pair) in pairs {
        if !arguments.channel.is_empty() && !arguments.channel.contains(&name) {
            continue;
        }
        match pair {
            (Some(of_a), Some(of_b)) => {
                let compared = compare(&a, &of_a, &b, &of_b)?;
                equal &= compared.print(&name, arguments.all, streams)?;
            }
            (of_a, _) => {
                equal = false;
                let only = if of_a.is_some() { &a } else { &b };
                writeln!(streams.out, "{name}: only in {}", only.path().display())?;
            }
        }
    }
    writeln!(
        streams.out,
        "messages: {}; bytes: {}",
        if equal { "equal" } else { "different" },
        if bytes_equal { "equal" } else { "different" }
    )?;
    Ok(Verdict::from_good(equal))
}

fn same_bytes(a: &Path, b: &Path) -> Result<bool, Trouble> {
    Ok(sha256_file(a)? == sha256_file(b)?)
}

type Pair = (Option<Channel>, Option<Channel>);

/// The channels of both files by name.
fn pairs(a: &Reader, b: &Reader) -> BTreeMap<String, Pair> {
    let mut pairs: BTreeMap<String, Pair> = BTreeMap::new();
    for channel in a.channels() {
        let name = channel.name.clone();
        pairs.entry(name).or_default().0 = Some(channel);
    }
    for channel in b.channels() {
        let name = channel.name.clone();
        pairs.entry(name).or_default().1 = Some(channel);
    }
    pairs
}

fn headers(a: &Header, b: &Header, streams: &mut Streams<'_>) -> Result<(), Trouble> {
    let (of_a, of_b) = (a.to_metadata(), b.to_metadata());
    for (key, value) in &of_a {
        let other = of_b.get(key).map_or("", String::as_str);
        if value == other {
            continue;
        }
        if key == "scene" {
            scenes(a, b, streams)?;
        } else {
            writeln!(streams.out, "header {key}: {value} | {other}")?;
        }
    }
    Ok(())
}

/// The entries of two scenes that differ.
fn scenes(a: &Header, b: &Header, streams: &mut Streams<'_>) -> Result<(), Trouble> {
    let entries = |header: &Header| -> BTreeMap<String, String> {
        let sheet = Sheet::json(&header.scene);
        let numbers = sheet.columns.iter();
        let numbers = numbers.map(|c| (c.name.clone(), c.values.to_f64()[0].to_string()));
        numbers.chain(sheet.texts.iter().cloned()).collect()
    };
    let (of_a, of_b) = (entries(a), entries(b));
    let keys: std::collections::BTreeSet<&String> = of_a.keys().chain(of_b.keys()).collect();
    for key in keys {
        let of = |map: &BTreeMap<String, String>| map.get(key).cloned();
        let (x, y) = (of(&of_a), of(&of_b));
        if x != y {
            let word = |x: Option<String>| x.unwrap_or_else(|| "(absent)".to_owned());
            writeln!(streams.out, "scene {key}: {} | {}", word(x), word(y))?;
        }
    }
    Ok(())
}

/// What was found in one channel.
#[derive(Debug, Default)]
struct Compared {
    columns: Vec<(String, String, Norms)>,
    remarks: Vec<String>,
    messages: usize,
}

/// At most this many remarks of a channel are printed.
const REMARKS: usize = 8;

impl Compared {
    fn print(&self, name: &str, all: bool, streams: &mut Streams<'_>) -> Result<bool, Trouble> {
        let out = &mut streams.out;
        let differ = |n: &Norms| n.differing > 0;
        let equal = self.remarks.is_empty() && !self.columns.iter().any(|c| differ(&c.2));
        let word = if equal { "equal" } else { "different" };
        writeln!(out, "{name}: {word} ({} messages)", self.messages)?;
        for remark in self.remarks.iter().take(REMARKS) {
            writeln!(out, "  {remark}")?;
        }
        if self.remarks.len() > REMARKS {
            writeln!(out, "  ... and {} more", self.remarks.len() - REMARKS)?;
        }
        let shown: Vec<_> = self
            .columns
            .iter()
            .filter(|c| all || differ(&c.2))
            .collect();
        if shown.is_empty() {
            return Ok(equal);
        }
        writeln!(
            out,
            "  {:<32} {:<8} {:>12} {:>12} {:>12} {:>10}  at t [s], row",
            "column", "unit", "Linf", "L2", "relative", "entries"
        )?;
        for (column, unit, norms) in shown {
            let place = match norms.differing {
                0 => "equal".to_owned(),
                _ => format!("{}, {}", norms.place.0, norms.place.1),
            };
            writeln!(
                out,
                "  {column:<32} {unit:<8} {:>12.4e} {:>12.4e} {:>12.4e} {:>10}  {place}",
                norms.greatest,
                norms.l2(),
                norms.relative(),
                norms.differing
            )?;
        }
        Ok(equal)
    }

    fn norms(&mut self, column: &Column) -> &mut Norms {
        let known = self.columns.iter().position(|c| c.0 == column.name);
        let at = known.unwrap_or_else(|| {
            let (name, unit) = (column.name.clone(), column.unit.clone());
            self.columns.push((name, unit, Norms::default()));
            self.columns.len() - 1
        });
        &mut self.columns[at].2
    }

    fn sheets(&mut self, a: &Sheet, b: &Sheet) {
        let time = a.time_s;
        if a.time_s.to_bits() != b.time_s.to_bits() {
            self.remarks
                .push(format!("a message at {time} s is at {} s in B", b.time_s));
        }
        let rows = pairing(a, b);
        if rows.len() != a.rows() || rows.len() != b.rows() {
            self.remarks.push(format!(
                "t = {time} s: {} {} in A, {} in B, {} compared",
                a.rows(),
                a.form.word(),
                b.rows(),
                rows.len()
            ));
        }
        for column in a.all() {
            let Some(other) = b.all().find(|c| c.name == column.name) else {
                self.remarks
                    .push(format!("t = {time} s: column '{}' only in A", column.name));
                continue;
            };
            if column.unit != other.unit || column.values.type_name() != other.values.type_name() {
                self.remarks.push(format!(
                    "t = {time} s: column '{}' is {} [{}] in A, {} [{}] in B",
                    column.name,
                    column.values.type_name(),
                    column.unit,
                    other.values.type_name(),
                    other.unit
                ));
            }
            let (x, y) = (column.values.to_f64(), other.values.to_f64());
            let norms = self.norms(column);
            if x.len() == a.rows() && y.len() == b.rows() {
                for &(i, k) in &rows {
                    norms.add(x[i], y[k], time, i);
                }
            } else {
                // Axes and attributes have lengths of their own.
                for (i, (x, y)) in x.iter().zip(&y).enumerate() {
                    norms.add(*x, *y, time, i);
                }
            }
        }
        for column in b.all() {
            if !a.all().any(|c| c.name == column.name) {
                self.remarks
                    .push(format!("t = {time} s: column '{}' only in B", column.name));
            }
        }
        if a.texts != b.texts {
            self.remarks.push(format!("t = {time} s: texts differ"));
        }
    }
}

/// Rows that belong together: particles by `id`, else by place.
fn pairing(a: &Sheet, b: &Sheet) -> Vec<(usize, usize)> {
    let ids = |sheet: &'_ Sheet| -> Option<Vec<u32>> {
        let column = sheet.columns.iter().find(|c| c.name == "id")?;
        match &column.values {
            Values::U32(ids) => Some(ids.clone()),
            _ => None,
        }
    };
    match (ids(a), ids(b)) {
        (Some(x), Some(y)) if x != y => {
            let rows: BTreeMap<u32, usize> = y.iter().enumerate().map(|(k, id)| (*id, k)).collect();
            let found = x.iter().enumerate();
            found
                .filter_map(|(i, id)| rows.get(id).map(|&k| (i, k)))
                .collect()
        }
        _ => (0..a.rows().min(b.rows())).map(|i| (i, i)).collect(),
    }
}

fn compare(a: &Reader, of_a: &Channel, b: &Reader, of_b: &Channel) -> Result<Compared, Trouble> {
    let mut compared = Compared {
        messages: of_a.messages.min(of_b.messages),
        ..Compared::default()
    };
    if of_a.schema != of_b.schema {
        let (x, y) = (&of_a.schema, &of_b.schema);
        compared.remarks.push(format!("holds {x} in A, {y} in B"));
        // A grid is a grid in either encoding.
        if ![x, y].into_iter().all(|s| s == TABLE || s == GRID) {
            return Ok(compared);
        }
    }
    if of_a.messages != of_b.messages {
        let (x, y) = (of_a.messages, of_b.messages);
        compared.remarks.push(format!(
            "{x} messages in A, {y} in B; the first are compared"
        ));
    }
    for index in 0..compared.messages {
        let of_a = Sheet::read(a, of_a, index)?;
        let of_b = Sheet::read(b, of_b, index)?;
        compared.sheets(&of_a, &of_b);
    }
    Ok(compared)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms_are_those_of_their_definitions() {
        let mut norms = Norms::default();
        for (row, (a, b)) in [(3.0, 3.0), (4.0, 4.5), (0.0, -1.0)]
            .into_iter()
            .enumerate()
        {
            norms.add(a, b, 0.25, row);
        }
        assert_eq!((norms.entries, norms.differing), (3, 2));
        assert_eq!((norms.greatest, norms.place), (1.0, (0.25, 2)));
        assert!((norms.l2() - (1.25_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!((norms.relative() - 1.25_f64.sqrt() / 5.0).abs() < 1e-15);
    }

    #[test]
    fn a_nan_on_one_side_is_a_difference_and_on_both_is_none() {
        let mut norms = Norms::default();
        norms.add(f64::NAN, f64::NAN, 0.0, 0);
        assert_eq!(norms.differing, 0);
        norms.add(1.0, f64::NAN, 0.0, 1);
        norms.add(1.0, 9.0, 0.0, 2);
        assert_eq!(norms.differing, 2);
        assert!(norms.greatest.is_nan());
        assert_eq!(norms.place.1, 1);
    }
}
