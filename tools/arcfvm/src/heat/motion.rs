//! Heat that moves with metal: the fed wire and the moving plate.

use crate::case::{Case, FeedRule, MovingPlate, Wire};
use crate::material::Enthalpy;

impl Wire {
    /// Mass fed per time \[kg/s\] at `speed` \[m/s\].
    #[must_use]
    pub fn mass_rate(&self, speed: f64) -> f64 {
        self.density * self.section * speed
    }

    /// The speed at which `heat` \[W\] melts the wire into drops (Komen 2019, eq. 5.27), or the
    /// given one.
    #[must_use]
    pub fn speed(&self, rule: FeedRule, heat: f64, enthalpy: &Enthalpy) -> f64 {
        match rule {
            FeedRule::Speed(speed) => speed,
            FeedRule::Melting(tip) => {
                heat.max(0.0) / self.mass_rate(1.0) / (self.drop_share * enthalpy.at(tip))
            }
        }
    }

    /// Adds the wire's downward mass flux to the axial faces of its cells, tip excluded: there the
    /// metal leaves as drops \[kg/s\].
    pub fn carry(&self, case: &Case, speed: f64, mass_axial: &mut [f64]) {
        let grid = &case.grid;
        for j in self.tip + 1..=grid.nz {
            for i in 0..self.columns {
                mass_axial[grid.axial_face(i, j)] = -self.density * speed * grid.ring[i];
            }
        }
    }

    /// Heat that leaves with drops \[W\], their enthalpy being that of the tip cells or their part of it.
    #[must_use]
    pub fn drops(&self, case: &Case, speed: f64, enthalpy: &[f64]) -> f64 {
        let leaving = self.leaving(case, speed, enthalpy);
        self.drop_share * leaving.map(|(_, heat)| heat).sum::<f64>()
    }

    /// Gives the tip cells back what their metal takes along beyond the enthalpy of drops \[W\].
    pub fn keep(&self, case: &Case, speed: f64, enthalpy: &[f64], source: &mut [[f64; 2]]) {
        if self.drop_share < 1.0 {
            for (k, heat) in self.leaving(case, speed, enthalpy) {
                source[k][0] += (1.0 - self.drop_share) * heat;
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
