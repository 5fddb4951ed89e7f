//! Heat that moves with metal: the fed wire and the moving plate.

use crate::case::{Case, Drops, FeedRule, MovingPlate, Wire};
use crate::grid::Grid;
use crate::heat::energy::Energy;
use crate::material::{Enthalpy, GAS};

impl Wire {
    /// Mass fed per time \[kg/s\] at `speed` \[m/s\].
    #[must_use]
    pub fn mass_rate(&self, speed: f64) -> f64 {
        self.density * self.section * speed
    }

    /// The speed at which heat melts the wire into drops (Komen 2019, eq. 5.27), or the given one. Of `taken`
    /// \[W\] vapour carries `boiled` away; `tip` is the mean enthalpy of the tip \[J/kg\]. With a part s of the wire
    /// that boils off, a kilogram takes the enthalpy of drops and s times the latent heat.
    #[must_use]
    pub fn speed(
        &self,
        rule: FeedRule,
        [taken, boiled]: [f64; 2],
        enthalpy: &Enthalpy,
        tip: f64,
    ) -> f64 {
        let (heat, wanted) = match rule {
            FeedRule::Speed(speed) => return speed,
            FeedRule::Melting(t) => (taken - boiled, self.drops.of(enthalpy.at(t))),
            FeedRule::Boiling {
                share, latent_heat, ..
            } => (taken, self.drops.of(tip) + share * latent_heat),
        };
        heat.max(0.0) / self.mass_rate(1.0) / wanted
    }

    /// Heat conducted from what the wire runs through and from what stands below its tip \[W\]. That of gas
    /// crosses the surfaces of electrodes, which count it.
    #[must_use]
    pub fn from_beside(&self, case: &Case, energy: &Energy) -> f64 {
        let (grid, t) = (&case.grid, &energy.temperature);
        let from = |out: usize, own: usize, conductance: f64| match case.material[out] {
            GAS => 0.0,
            _ => conductance * (t[out] - t[own]),
        };
        let column = self.columns;
        let mut heat = 0.0;
        if column < grid.nr {
            for j in self.tip..grid.nz {
                let conductance = energy.radial[grid.radial_face(column, j)];
                heat += from(grid.cell(column, j), grid.cell(column - 1, j), conductance);
            }
        }
        if let Some(below) = self.tip.checked_sub(1) {
            for i in 0..column {
                let conductance = energy.axial[grid.axial_face(i, self.tip)];
                heat += from(grid.cell(i, below), grid.cell(i, self.tip), conductance);
            }
        }
        heat
    }

    /// Mean enthalpy of the tip's cells \[J/kg\].
    #[must_use]
    pub fn tip_enthalpy(&self, case: &Case, enthalpy: &[f64]) -> f64 {
        let grid = &case.grid;
        let cells = (0..self.columns).map(|i| grid.ring[i] * enthalpy[grid.cell(i, self.tip)]);
        let area: f64 = grid.ring[..self.columns].iter().sum();
        cells.sum::<f64>() / area
    }

    /// Mass of the wire through an axial face within it, upward, its tip excluded: there the metal leaves as
    /// drops \[kg/s\].
    #[inline]
    pub(crate) fn carried(&self, grid: &Grid, speed: f64, face: usize) -> Option<f64> {
        let above = face >= grid.axial_face(0, self.tip + 1);
        let within = above && face % grid.nr < self.columns;
        within.then(|| -self.density * speed * grid.ring[face % grid.nr])
    }

    /// Heat that leaves with drops \[W\], their enthalpy being that of the tip cells or their part of it.
    #[must_use]
    pub fn drops(&self, case: &Case, speed: f64, enthalpy: &[f64]) -> f64 {
        let leaving = self.leaving(case, speed, enthalpy);
        self.drop_share(case, enthalpy) * leaving.map(|(_, heat)| heat).sum::<f64>()
    }

    /// Gives the tip cells back what their metal takes along beyond the enthalpy of drops \[W\].
    pub fn keep(&self, case: &Case, speed: f64, enthalpy: &[f64], source: &mut [[f64; 2]]) {
        let kept = 1.0 - self.drop_share(case, enthalpy);
        if kept > 0.0 {
            for (k, heat) in self.leaving(case, speed, enthalpy) {
                source[k][0] += kept * heat;
            }
        }
    }

    /// Part of the enthalpy of the tip that drops take along.
    fn drop_share(&self, case: &Case, enthalpy: &[f64]) -> f64 {
        match self.drops {
            Drops::Part(part) => part,
            own @ Drops::Enthalpy(_) => {
                let tip = self.tip_enthalpy(case, enthalpy);
                if tip > 0.0 { own.of(tip) / tip } else { 1.0 }
            }
        }
    }

    /// The tip cells, and the heat that leaves each with its metal \[W\].
    fn leaving(
        &self,
        case: &Case,
        speed: f64,
        enthalpy: &[f64],
    ) -> impl Iterator<Item = (usize, f64)> {
        let (grid, flux) = (&case.grid, self.density * speed);
        (0..self.columns).map(move |i| {
            let k = grid.cell(i, self.tip);
            (k, flux * grid.ring[i] * enthalpy[k])
        })
    }
}

impl MovingPlate {
    /// Heat that the plate carries away from cell `(i, j)` (Komen 2019, eq. 5.22): the metal swept
    /// per time through the cell's cut, on both sides of the arc or once per radian, comes in as warm as the plate
    /// is at the distance `ahead`. Returns the loss \[W\] and its slope with the cell's temperature \[W/K\].
    #[must_use]
    pub fn loss(&self, case: &Case, i: usize, j: usize, temperature: &[f64]) -> (f64, f64) {
        let grid = &case.grid;
        let k = grid.cell(i, j);
        let material = case.of(k);
        let (Some(enthalpy), Some(density)) = (&material.enthalpy, &material.density) else {
            return (0.0, 0.0);
        };
        let far = grid.rc[i] + self.ahead;
        let ahead = if far >= grid.rf[grid.nr] {
            self.beyond[j]
        } else {
            temperature[grid.cell(grid.column_of(far), j)]
        };
        let t = temperature[k];
        let swept = density.at(grid.rc[i], grid.zc[j], t)
            * self.speed
            * self.swept
            * grid.dr[i]
            * grid.dz[j];
        (
            swept * (enthalpy.at(t) - enthalpy.at(ahead)),
            swept * enthalpy.slope(t),
        )
    }
}
