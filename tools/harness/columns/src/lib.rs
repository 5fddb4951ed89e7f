//! Sets of particles as frames and in checkpoints, read off the columns that were declared.
//!
//! What is saved and shown says the stage that declares a column ([`particles::Column`]); nothing here knows a name but
//! that of the positions.

use artefact::{Checkpoint, Frame, Precision, Result};
use particles::{Declared, ID, POSITION, Set, Store};

/// Components of a symmetric matrix that frames show.
const COMPONENTS: [(&str, usize, usize); 6] = [
    ("xx", 0, 0),
    ("yy", 1, 1),
    ("zz", 2, 2),
    ("xy", 0, 1),
    ("xz", 0, 2),
    ("yz", 1, 2),
];

/// How frames show columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Form {
    /// Width of the floats.
    pub precision: Precision,
    /// 2 in the plane x, y, across which nothing shears; 3 in space.
    pub dimensions: usize,
}

/// Channel of a set.
#[must_use]
pub fn channel(set: &Set) -> String {
    format!("/{}", set.name())
}

/// The columns of a set that frames show, in the order of their declaration.
pub fn shown(set: &Set) -> impl Iterator<Item = Declared<'_>> {
    set.declared().filter(|column| column.shown)
}

/// Rows of a set by the numbers of its particles, in whatever order they are kept.
#[must_use]
pub fn by_number(set: &Set) -> Vec<usize> {
    let ids = set.column(&ID);
    let mut rows: Vec<usize> = (0..ids.len()).collect();
    rows.sort_unstable_by_key(|row| ids[*row]);
    rows
}

/// The given rows of columns as a frame.
#[must_use]
pub fn frame<'a>(
    columns: impl IntoIterator<Item = Declared<'a>>,
    rows: impl Iterator<Item = usize> + Clone,
    form: Form,
) -> Frame {
    let new = Frame::new(form.precision);
    columns.into_iter().fold(new, |frame, column| {
        let (name, unit) = (column.name, column.unit);
        match column.values {
            Store::Vectors(values) if name == POSITION.name => frame.positions(of(values, &rows)),
            Store::Vectors(values) => frame.vector(name, unit, of(values, &rows)),
            Store::Scalars(values) => frame.scalar(name, unit, of(values, &rows)),
            Store::Flags(values) => frame.flag(name, of(values, &rows)),
            Store::Marks(values) => frame.flag(name, of(values, &rows).map(u8::from)),
            Store::Ids(values) => frame.id(name, of(values, &rows)),
            Store::Matrices(values) => {
                let plane = form.dimensions == 2;
                let components = COMPONENTS.iter();
                let components = components.filter(|(_, i, j)| !plane || i == j || i + j == 1);
                components.fold(frame, |frame, (axes, i, j)| {
                    let component = of(values, &rows).map(|matrix| matrix[*i][*j]);
                    frame.scalar(&format!("{name}_{axes}"), unit, component)
                })
            }
        }
    })
}

fn of<T: Copy>(
    values: &[T],
    rows: &(impl Iterator<Item = usize> + Clone),
) -> impl Iterator<Item = T> {
    rows.clone().map(|row| values[row])
}

/// Puts the saved columns of a set into a checkpoint, under its name.
pub fn save(checkpoint: &mut Checkpoint, set: &Set) {
    for column in set.declared().filter(|column| column.saved) {
        let name = entry(set.name(), column.name);
        match column.values {
            Store::Scalars(values) => checkpoint.put_f64(&name, values),
            Store::Vectors(values) => checkpoint.put_vectors(&name, values),
            Store::Matrices(values) => checkpoint.put_vectors(&name, values.as_flattened()),
            Store::Flags(values) => checkpoint.put_u8(&name, values),
            Store::Marks(values) => {
                let bytes: Vec<u8> = values.iter().map(|mark| u8::from(*mark)).collect();
                checkpoint.put_u8(&name, &bytes);
            }
            Store::Ids(values) => {
                let wide: Vec<u64> = values.iter().map(|id| u64::from(*id)).collect();
                checkpoint.put_u64(&name, &wide);
            }
        }
    }
}

/// Takes back what [`save`] put.
///
/// # Errors
/// When the checkpoint lacks a column.
pub fn restore(checkpoint: &mut Checkpoint, set: &mut Set) -> Result<()> {
    let of = set.name().to_owned();
    set.restore(|name, kind| {
        let name = entry(&of, name);
        Ok(match kind {
            Store::Scalars(_) => Store::Scalars(checkpoint.f64(&name)?),
            Store::Vectors(_) => Store::Vectors(checkpoint.vectors(&name)?),
            Store::Matrices(_) => {
                Store::Matrices(checkpoint.vectors(&name)?.as_chunks::<3>().0.to_vec())
            }
            Store::Flags(_) => Store::Flags(checkpoint.u8(&name)?),
            Store::Marks(_) => {
                let bytes = checkpoint.u8(&name)?;
                Store::Marks(bytes.iter().map(|byte| *byte != 0).collect())
            }
            Store::Ids(_) => {
                let wide = checkpoint.u64(&name)?;
                Store::Ids(wide.iter().map(|id| *id as u32).collect())
            }
        })
    })
}

fn entry(set: &str, column: &str) -> String {
    format!("{set}.{column}")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]

    use std::collections::BTreeMap;

    use super::*;
    use artefact::{Header, Version};
    use particles::{Column, Ids, Matter};

    const STRESS: Column<[[f64; 3]; 3]> = Column::new(
        "stress",
        "Pa",
        [[1.0, 2.0, 3.0], [2.0, 4.0, 5.0], [3.0, 5.0, 6.0]],
    )
    .saved()
    .shown();
    const BROKEN: Column<u8> = Column::new("broken", "1", 0).saved().shown();
    const WORK: Column<f64> = Column::new("work", "J", 0.5).saved();

    fn set() -> Set {
        let matter = Matter {
            density: 1000.0,
            spacing: 1e-3,
            smoothing_length: 1e-3,
        };
        let mut set = Set::new("solid", matter);
        set.declare(&STRESS);
        set.declare(&BROKEN);
        set.declare(&WORK);
        set
    }

    #[test]
    fn frames_hold_the_rows_that_are_asked_for_and_no_shear_across_the_plane() {
        let mut set = set();
        let mut ids = Ids::default();
        for _ in 0..3 {
            set.push(&mut ids);
        }
        set.column_mut(&BROKEN)[2] = 7;
        set.arrange(&[2, 0, 1]);
        let form = Form {
            precision: Precision::F64,
            dimensions: 2,
        };
        let rows = by_number(&set);
        let frame = frame(shown(&set), rows.iter().copied(), form);
        let names: Vec<&str> = frame.columns().iter().map(|c| c.name.as_str()).collect();
        let stress = ["stress_xx", "stress_yy", "stress_zz", "stress_xy"];
        assert_eq!(names[names.len() - 5..names.len() - 1], stress);
        assert_eq!(frame.u8("broken").unwrap(), [0, 0, 7]);
        assert_eq!(frame.u32("id").unwrap(), [0, 1, 2]);
        assert!(!frame.has("work"));
    }

    #[test]
    fn a_checkpoint_brings_a_set_back() {
        let (mut old, mut new) = (set(), set());
        let mut ids = Ids::default();
        for _ in 0..2 {
            old.push(&mut ids);
        }
        old.column_mut(&WORK)[1] = -2.0;
        old.column_mut(&STRESS)[0][1][2] = 9.0;
        let header = Header {
            kind: "jet-frames".to_owned(),
            version: Version::new(1, 0),
            tool: "jetsph".to_owned(),
            tool_version: "0".to_owned(),
            scene: serde_json::json!({}),
            inputs: BTreeMap::new(),
        };
        let mut checkpoint = Checkpoint::new(&header);
        save(&mut checkpoint, &old);
        restore(&mut checkpoint, &mut new).unwrap();
        for (old, new) in old.declared().zip(new.declared()) {
            assert_eq!(old.values, new.values, "{}", old.name);
        }
    }
}
