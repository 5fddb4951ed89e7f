//! A set of particles of one matter.

use crate::column::Column;
use crate::held::{Held, Several};
use crate::store::{Store, Value};

/// x \[m\], held by every set.
pub const POSITION: Column<[f64; 3]> = Column::new("position", "m", [0.0; 3]).saved().shown();
/// Number for life, held by every set.
pub const ID: Column<u32> = Column::new("id", "1", 0).saved().shown();

/// What the particles of a set are made of, and the lattice that they start on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matter {
    /// rho at rest \[kg/m3\].
    pub density: f64,
    /// Spacing d of the lattice \[m\].
    pub spacing: f64,
    /// h of the kernel \[m\]; its support is 2h.
    pub smoothing_length: f64,
}

impl Matter {
    /// Volume of a particle, d^3 \[m3\].
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.spacing * self.spacing * self.spacing
    }

    /// Mass of a particle \[kg\].
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.density * self.volume()
    }

    /// Radius of the kernel's support, 2h \[m\].
    #[must_use]
    pub fn support(&self) -> f64 {
        2.0 * self.smoothing_length
    }
}

/// Gives every particle of a run a number of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Ids {
    /// The next number.
    pub next: u32,
}

impl Ids {
    fn take(&mut self) -> u32 {
        self.next += 1;
        self.next - 1
    }
}

/// A column that is held, to be looked at.
#[derive(Debug, Clone, Copy)]
pub struct Declared<'a> {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Whether checkpoints keep it.
    pub saved: bool,
    /// Whether frames show it.
    pub shown: bool,
    /// Its values.
    pub values: &'a Store,
}

impl Declared<'_> {
    /// Its bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.values.len() * self.values.width()
    }
}

/// A set of particles: rows of the columns that were declared.
#[derive(Debug, Clone)]
pub struct Set {
    name: String,
    /// What its particles are made of.
    pub matter: Matter,
    rows: usize,
    held: Vec<Held>,
}

impl Set {
    /// An empty set with positions and ids.
    #[must_use]
    pub fn new(name: impl Into<String>, matter: Matter) -> Self {
        let mut set = Self {
            name: name.into(),
            matter,
            rows: 0,
            held: Vec::new(),
        };
        set.declare(&POSITION);
        set.declare(&ID);
        set
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows
    }

    /// True without particles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Declares a column; a second time saves or shows it where either asks for it.
    pub fn declare<T: Value>(&mut self, column: &Column<T>) {
        if let Some(held) = self.held.iter_mut().find(|held| held.name == column.name) {
            held.saved |= column.saved;
            held.shown |= column.shown;
            return;
        }
        self.held.push(Held {
            name: column.name,
            unit: column.unit,
            saved: column.saved,
            shown: column.shown,
            default: T::store(vec![column.default]),
            values: T::store(vec![column.default; self.rows]),
        });
    }

    /// Whether a column was declared.
    #[must_use]
    pub fn has<T: Value>(&self, column: &Column<T>) -> bool {
        self.held.iter().any(|held| held.name == column.name)
    }

    /// Values of a column; none where it was not declared.
    #[must_use]
    pub fn column<T: Value>(&self, column: &Column<T>) -> &[T] {
        let held = self.held.iter().find(|held| held.name == column.name);
        held.and_then(|held| T::of(&held.values))
            .map_or(&[], Vec::as_slice)
    }

    /// Values of a column, to be changed; none where it was not declared.
    #[must_use]
    pub fn column_mut<T: Value>(&mut self, column: &Column<T>) -> &mut [T] {
        let held = self.held.iter_mut().find(|held| held.name == column.name);
        held.and_then(|held| T::of_mut(&mut held.values))
            .map_or(&mut [], Vec::as_mut_slice)
    }

    /// Values of two to seven columns, to be changed side by side; none of one that was not declared.
    #[must_use]
    pub fn columns_mut<C: Several>(&mut self, columns: C) -> C::Values<'_> {
        columns.of(&mut self.held)
    }

    /// Gives a particle its value of a column; nothing happens where it was not declared.
    pub fn set<T: Value>(&mut self, column: &Column<T>, row: usize, value: T) {
        if let Some(own) = self.column_mut(column).get_mut(row) {
            *own = value;
        }
    }

    /// Takes the values of a column out, to work on them beside others; [`Set::put`] brings them back.
    #[must_use]
    pub fn take<T: Value>(&mut self, column: &Column<T>) -> Vec<T> {
        let held = self.held.iter_mut().find(|held| held.name == column.name);
        held.and_then(|held| T::of_mut(&mut held.values))
            .map(std::mem::take)
            .unwrap_or_default()
    }

    /// Brings the values of a column back.
    ///
    /// # Panics
    /// When there are not as many as particles.
    pub fn put<T: Value>(&mut self, column: &Column<T>, values: Vec<T>) {
        assert!(
            values.len() == self.rows,
            "{} values of {} for {} particles",
            values.len(),
            column.name,
            self.rows
        );
        if let Some(held) = self.held.iter_mut().find(|held| held.name == column.name) {
            held.values = T::store(values);
        }
    }

    /// Appends a particle with the default of every column; gives its row.
    pub fn push(&mut self, ids: &mut Ids) -> usize {
        for held in &mut self.held {
            held.values.append(&held.default, 0);
        }
        self.rows += 1;
        let row = self.rows - 1;
        self.column_mut(&ID)[row] = ids.take();
        row
    }

    /// Takes the particles away for which `leaves` says so; the others keep their order.
    pub fn remove(&mut self, leaves: impl Fn(usize) -> bool) {
        let rows = self.rows;
        for held in &mut self.held {
            held.values.retain(|row| !leaves(row));
        }
        self.rows = (0..rows).filter(|row| !leaves(*row)).count();
    }

    /// Puts the particle of the row `order[k]` into the row k, for all k; `order` names every row once.
    ///
    /// # Panics
    /// When `order` names another number of rows.
    pub fn arrange(&mut self, order: &[u32]) {
        assert!(
            order.len() == self.rows,
            "{} of {} rows",
            order.len(),
            self.rows
        );
        for held in &mut self.held {
            held.values.arrange(order);
        }
    }

    /// Moves the particles for which `leaves` says so behind those of another set, in their order. Columns that both
    /// hold go along, the id among them; the others of the new set get their defaults.
    pub fn transfer(&mut self, to: &mut Self, leaves: impl Fn(usize) -> bool) {
        let moving: Vec<usize> = (0..self.rows).filter(|row| leaves(*row)).collect();
        for new in &mut to.held {
            let old = self.held.iter().find(|old| old.name == new.name);
            for row in &moving {
                match old {
                    Some(old) => new.values.append(&old.values, *row),
                    None => new.values.append(&new.default, 0),
                }
            }
        }
        to.rows += moving.len();
        if !moving.is_empty() {
            self.remove(leaves);
        }
    }

    /// All columns, in the order of their declaration.
    pub fn declared(&self) -> impl Iterator<Item = Declared<'_>> {
        self.held.iter().map(|held| Declared {
            name: held.name,
            unit: held.unit,
            saved: held.saved,
            shown: held.shown,
            values: &held.values,
        })
    }

    /// Replaces all particles by those of saved columns: `values` gives the store of each saved name, and the other
    /// columns get their defaults.
    ///
    /// # Errors
    /// What `values` reports.
    pub fn restore<E>(
        &mut self,
        mut values: impl FnMut(&'static str, &Store) -> Result<Store, E>,
    ) -> Result<(), E> {
        for held in self.held.iter_mut().filter(|held| held.saved) {
            held.values = values(held.name, &held.values)?;
        }
        self.rows = self.column(&ID).len();
        for held in self.held.iter_mut().filter(|held| !held.saved) {
            held.values = held.values.empty();
            for _ in 0..self.rows {
                held.values.append(&held.default, 0);
            }
        }
        Ok(())
    }

    /// Bytes of all columns.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.declared().map(|column| column.bytes()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEED: Column<f64> = Column::new("speed", "m/s", 1.5).saved().shown();
    const STRESS: Column<[[f64; 3]; 3]> = Column::new("stress", "Pa", [[0.0; 3]; 3]);
    const BROKEN: Column<u8> = Column::new("broken", "1", 0).saved();
    const MATTER: Matter = Matter {
        density: 1000.0,
        spacing: 1e-3,
        smoothing_length: 1.5e-3,
    };

    fn alike(found: &[f64], expected: &[f64]) -> bool {
        let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        bits(found) == bits(expected)
    }

    fn set(name: &str, ids: &mut Ids, rows: usize) -> Set {
        let mut set = Set::new(name, MATTER);
        set.declare(&SPEED);
        for _ in 0..rows {
            let row = set.push(ids);
            set.column_mut(&POSITION)[row] = [row as f64, 0.0, 0.0];
        }
        set
    }

    #[test]
    fn a_column_that_nobody_declares_is_not_held() {
        let mut set = set("a", &mut Ids::default(), 3);
        assert!(!set.has(&STRESS) && set.column(&STRESS).is_empty());
        assert_eq!(set.bytes(), 3 * (24 + 4 + 8));
        set.declare(&STRESS);
        assert_eq!(set.column(&STRESS).len(), 3);
        assert_eq!(set.bytes(), 3 * (24 + 4 + 8 + 72));
    }

    #[test]
    fn rows_move_to_another_set_with_their_ids() {
        let mut ids = Ids::default();
        let (mut solid, mut debris) = (set("solid", &mut ids, 4), set("debris", &mut ids, 1));
        solid.declare(&BROKEN);
        debris.declare(&STRESS);
        solid.column_mut(&SPEED)[2] = 7.0;
        solid.transfer(&mut debris, |row| row == 0 || row == 2);
        assert_eq!(solid.column(&ID), [1, 3]);
        assert_eq!(debris.column(&ID), [4, 0, 2]);
        assert!(alike(debris.column(&SPEED), &[1.5, 1.5, 7.0]));
        assert!(alike(&debris.column(&POSITION)[2], &[2.0, 0.0, 0.0]));
        assert_eq!((solid.len(), debris.len()), (2, 3));
        assert_eq!(debris.column(&STRESS).len(), 3);
        let row = solid.push(&mut ids);
        assert_eq!(solid.column(&ID)[row], 5, "no number is given twice");
    }

    #[test]
    fn rows_are_put_in_another_order() {
        let mut set = set("a", &mut Ids::default(), 3);
        set.column_mut(&SPEED)[2] = 7.0;
        set.arrange(&[2, 0, 1]);
        assert_eq!(set.column(&ID), [2, 0, 1]);
        assert!(alike(set.column(&SPEED), &[7.0, 1.5, 1.5]));
        assert!(alike(&set.column(&POSITION)[0], &[2.0, 0.0, 0.0]));
    }

    #[test]
    fn saved_columns_bring_a_set_back() {
        let mut ids = Ids::default();
        let mut old = set("solid", &mut ids, 3);
        old.declare(&STRESS);
        old.column_mut(&SPEED)[1] = -2.0;
        let mut new = set("solid", &mut Ids::default(), 0);
        new.declare(&STRESS);
        let saved = |name: &'static str, _: &Store| -> Result<Store, ()> {
            let found = old.declared().find(|column| column.name == name);
            found.map(|column| column.values.clone()).ok_or(())
        };
        new.restore(saved).unwrap();
        assert!(alike(new.column(&SPEED), &[1.5, -2.0, 1.5]));
        assert_eq!(new.column(&STRESS).len(), 3);
        assert_eq!(new.len(), 3);
    }

    #[test]
    fn columns_are_changed_side_by_side() {
        let mut set = set("a", &mut Ids::default(), 2);
        let (ids, speed, broken) = set.columns_mut((&ID, &SPEED, &BROKEN));
        (ids[1], speed[0]) = (7, 3.0);
        assert!(broken.is_empty(), "not declared");
        set.set(&SPEED, 1, 4.0);
        set.set(&BROKEN, 1, 1);
        assert_eq!(set.column(&ID), [0, 7]);
        assert!(alike(set.column(&SPEED), &[3.0, 4.0]));
    }

    #[test]
    fn columns_taken_out_come_back() {
        let mut set = set("a", &mut Ids::default(), 2);
        let mut speed = set.take(&SPEED);
        speed[0] = 3.0;
        set.put(&SPEED, speed);
        assert!(alike(set.column(&SPEED), &[3.0, 1.5]));
    }
}
