//! Shares of functions of temperature, gathered cell by cell.

use std::collections::BTreeMap;

use rayon::prelude::*;
use run::property::OutOfRange;

use super::Materials;
use super::enthalpy::Enthalpy;
use crate::system::storage::{Content, Storage};
use shapes::frame::Vector;

/// What cells hold, as far as it is gathered.
pub(super) struct Holds<'a> {
    materials: &'a Materials,
    position: &'a [Vector],
    /// Heat capacity of each cell \[J/K\], where none depends on temperature.
    capacity: Vec<f64>,
    /// Shares of each cell, where one does.
    cells: Vec<Vec<(u32, f64)>>,
    functions: Vec<Enthalpy>,
    /// Functions of materials at points, where each place has its own.
    own: BTreeMap<(usize, usize), usize>,
}

impl<'a> Holds<'a> {
    /// Nothing yet, in cells about the given points.
    pub(super) fn new(
        materials: &'a Materials,
        position: &'a [Vector],
    ) -> Result<Self, OutOfRange> {
        let varies = materials.stores_by_temperature();
        let (fixed, varying) = if varies {
            (0, position.len())
        } else {
            (position.len(), 0)
        };
        let mut holds = Self {
            materials,
            position,
            capacity: vec![0.0; fixed],
            cells: vec![Vec::new(); varying],
            functions: Vec::new(),
            own: BTreeMap::new(),
        };
        if varies {
            holds.functions.clone_from(&materials.enthalpies);
            // The last of the shared ones is the temperature itself.
            holds.functions.push(Enthalpy::even(materials.range.0));
            holds.each()?;
        }
        Ok(holds)
    }

    /// The functions of points whose place has its own.
    fn each(&mut self) -> Result<(), OutOfRange> {
        let table = |i: usize| {
            let material = self.materials.at(self.position[i]);
            let table = self.materials.own_enthalpy(material, self.position[i])?;
            Some(table.map(|table| (material, i, table)))
        };
        let points = (0..self.position.len()).into_par_iter();
        let all: Vec<_> = points.filter_map(table).collect::<Result<_, _>>()?;
        for (material, i, table) in all {
            self.own.insert((material, i), self.functions.len());
            self.functions.push(table);
        }
        Ok(())
    }

    /// Number of the function of a material in the cell of point `i`.
    pub(super) fn function(&mut self, material: usize, i: usize) -> Result<usize, OutOfRange> {
        if self.cells.is_empty() {
            return Ok(0);
        }
        if let Some(shared) = self.materials.enthalpy(material) {
            return Ok(shared);
        }
        if let Some(own) = self.own.get(&(material, i)) {
            return Ok(*own);
        }
        match self.materials.own_enthalpy(material, self.position[i]) {
            None => Ok(self.materials.enthalpies.len()),
            Some(table) => {
                self.own.insert((material, i), self.functions.len());
                self.functions.push(table?);
                Ok(self.functions.len() - 1)
            }
        }
    }

    /// Adds to cell `i` an amount of a function.
    pub(super) fn add(&mut self, i: usize, function: usize, amount: f64) {
        let Some(own) = self.cells.get_mut(i) else {
            self.capacity[i] += amount;
            return;
        };
        match own.iter_mut().find(|(f, _)| *f as usize == function) {
            Some((_, sum)) => *sum += amount,
            None => own.push((function as u32, amount)),
        }
    }

    /// Heat of a part above that which it would have at a temperature.
    pub(super) fn surplus(&self, function: usize, stored: f64, heat: f64, t: f64) -> f64 {
        if self.cells.is_empty() {
            return heat - stored * t;
        }
        // What is gathered of a function of one place is the mean temperature; of a shared one, its heat.
        let of = |t: f64| self.functions[function].at(t).1;
        let heat = if function > self.materials.enthalpies.len() {
            stored * of(heat / stored)
        } else {
            heat
        };
        heat - stored * of(t)
    }

    /// All that was gathered.
    pub(super) fn storage(self) -> Storage {
        if self.cells.is_empty() {
            Storage::Fixed(self.capacity)
        } else {
            Storage::Varies(Content::new(self.functions, self.cells))
        }
    }
}
