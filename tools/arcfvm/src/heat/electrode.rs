//! Heat that an electrode takes up or gives off at its surface, per area (Komen 2019, eqs 5.16,
//! 5.19 to 5.21, 5.24).
//!
//! Conduction from the gas is part of the energy equation. The anode takes up `|j| phi`. The cathode
//! gives off `j_e phi` by the electrons of Richardson and Dushman, never more than carry the whole
//! current, and takes up `(|j| - j_e) V_i` from ions, or `(|j| - j_e) (V_i - phi)` where these pay for the electron that they
//! take out of the metal.
//!
//! A metal that boils before it emits, as iron does, is no thermionic cathode, and spots too small and
//! too brief to resolve carry its current. The other closure takes the cathode fall U as given, from
//! measurement, and the energy of the layer in front of the metal as the law: electrons that crossed
//! the fall ionise what comes back as ions and enter the column at its temperature,
//! `j_e U = j_i V_i + 3.2 j k T_e / e`, so that with `theta = k T_e / e`
//!
//! ```text
//! j_i = j (U - 3.2 theta) / (U + V_i)    q = j_i (U + V_i - phi) - j_e phi = j (U - phi - 3.2 theta)
//! ```
//!
//! (Benilov and Marotta 1995; Benilov 2008 for q). The gas beside the metal takes up `3.2 j theta`, and
//! U is the voltage of the cathode: what the supply gives is what metal and gas take up. Neglected: the
//! current of electrons from the gas against the fall, and the heat of the metal's own electrons.
//!
//! Radiation goes off as `eps sigma (T^4 - Ta^4)`
//! (eq. 4.10; eqs 5.16 and 5.19 leave out the surroundings), vapour as Hertz and Knudsen tell for
//! evaporation into a gas free of it.

use std::sync::Arc;

/// Charge of the electron over Boltzmann's constant \[K/V\].
const KELVIN_PER_VOLT: f64 = 11_604.518_12;
/// Stefan-Boltzmann constant \[W/(m2 K4)\].
pub(crate) const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// Molar gas constant \[J/(mol K)\].
const MOLAR_GAS: f64 = 8.314_462_618;
/// Energy that an electron takes into the column, over k T_e (Benilov and Marotta 1995).
const ENTERING: f64 = 3.2;
/// Pressure at the boiling point \[Pa\].
const ATMOSPHERE: f64 = 101_325.0;

/// Which way current crosses the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// Takes up electrons.
    Anode {
        /// Work function \[V\].
        work_function: f64,
    },
    /// Emits electrons and takes up ions.
    Cathode {
        /// Work function \[V\].
        work_function: f64,
        /// Ionisation voltage of the gas \[V\].
        ionisation_voltage: f64,
        /// What makes it emit.
        emission: Emission,
    },
}

/// The closure of a cathode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Emission {
    /// Electrons leave by heat, with this Richardson constant \[A/(m2 K2)\] (eq. 5.20); ions give their whole ionisation
    /// voltage (eq. 5.21).
    Thermionic(f64),
    /// The same; ions give their ionisation voltage less the work function of the electron that they take.
    NetIons(f64),
    /// The energy of the layer that has this fall \[V\] tells how many.
    Fall(f64),
}

/// Vapour leaving a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaporation {
    /// Boiling point at 1 atm \[K\].
    pub boiling: f64,
    /// Latent heat \[J/kg\].
    pub latent_heat: f64,
    /// Molar mass \[kg/mol\].
    pub molar_mass: f64,
}

/// A metal that current enters or leaves through the gas.
#[derive(Debug, Clone, PartialEq)]
pub struct Electrode {
    /// Name of the body.
    pub name: Arc<str>,
    /// Anode or cathode.
    pub role: Role,
    /// Emissivity.
    pub emissivity: f64,
    /// Temperature of the surroundings \[K\].
    pub surroundings: f64,
    /// Evaporation.
    pub evaporation: Option<Evaporation>,
    /// Whether it takes its part of the arc's radiation.
    pub absorbs: bool,
}

/// Heat fluxes into the metal \[W/m2\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SurfaceHeat {
    /// Electrons: taken up (anode) or emitted (cathode).
    pub electron: f64,
    /// Ions that recombine.
    pub ion: f64,
    /// Surface radiation, a loss.
    pub emission: f64,
    /// Vapour, a loss.
    pub vapour: f64,
}

/// Voltage that carries an electron into gas at `gas` \[K\] \[V\].
fn entering(gas: f64) -> f64 {
    ENTERING * gas / KELVIN_PER_VOLT
}

impl SurfaceHeat {
    /// Sum of the parts.
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.electron + self.ion + self.emission + self.vapour
    }
}

impl Evaporation {
    /// Heat carried off by vapour at temperature `t` \[W/m2\] (eq. 5.24 without vapour in the gas;
    /// saturation pressure by Clausius and Clapeyron from the boiling point).
    #[must_use]
    pub fn heat(&self, t: f64) -> f64 {
        let molar = self.latent_heat * self.molar_mass / MOLAR_GAS;
        let pressure = ATMOSPHERE * (molar * (1.0 / self.boiling - 1.0 / t)).exp();
        let root = (self.molar_mass / (2.0 * std::f64::consts::PI * MOLAR_GAS * t)).sqrt();
        self.latent_heat * pressure * root
    }
}

impl Electrode {
    /// The same beside gas with the part `fraction` of iron, whose ionisation voltage is `iron` \[V\]: a
    /// cathode's goes linearly from its own to that one.
    #[must_use]
    pub fn beside(&self, fraction: f64, iron: f64) -> Self {
        let mut electrode = self.clone();
        if let Role::Cathode {
            ionisation_voltage, ..
        } = &mut electrode.role
        {
            *ionisation_voltage += fraction * (iron - *ionisation_voltage);
        }
        electrode
    }

    /// Ionisation voltage of the gas beside a cathode \[V\]; 0 at an anode.
    #[must_use]
    pub fn ionisation(&self) -> f64 {
        match self.role {
            Role::Anode { .. } => 0.0,
            Role::Cathode {
                ionisation_voltage, ..
            } => ionisation_voltage,
        }
    }

    /// Current density of emitted electrons \[A/m2\] where the whole is `current`, the surface at `t`
    /// and the gas beside it at `gas` \[K\] (eq. 5.20, or the energy of the layer).
    #[must_use]
    pub fn emitted(&self, current: f64, t: f64, gas: f64) -> f64 {
        let Role::Cathode {
            work_function,
            ionisation_voltage,
            emission,
        } = self.role
        else {
            return 0.0;
        };
        match emission {
            Emission::Thermionic(richardson) | Emission::NetIons(richardson) => {
                let thermionic = richardson * t * t * (-work_function * KELVIN_PER_VOLT / t).exp();
                thermionic.min(current)
            }
            Emission::Fall(fall) => {
                let ions = (fall - entering(gas)) / (fall + ionisation_voltage);
                current * (1.0 - ions.max(0.0))
            }
        }
    }

    /// Heat at surface temperature `t` with the current density `current` \[A/m2\] from gas at `gas`
    /// \[K\].
    #[must_use]
    pub fn heat(&self, current: f64, t: f64, gas: f64) -> SurfaceHeat {
        let (electron, ion) = match self.role {
            Role::Anode { work_function } => (current * work_function, 0.0),
            Role::Cathode {
                work_function,
                ionisation_voltage,
                emission,
            } => {
                let emitted = self.emitted(current, t, gas);
                let each = match emission {
                    Emission::Thermionic(_) => ionisation_voltage,
                    Emission::NetIons(_) => ionisation_voltage - work_function,
                    Emission::Fall(fall) => fall + ionisation_voltage - work_function,
                };
                (-emitted * work_function, (current - emitted) * each)
            }
        };
        let fourth = t.powi(4) - self.surroundings.powi(4);
        SurfaceHeat {
            electron,
            ion,
            emission: -self.emissivity * STEFAN_BOLTZMANN * fourth,
            vapour: -self.evaporation.map_or(0.0, |e| e.heat(t)),
        }
    }

    /// Heat that emitted electrons bring into gas at `gas` \[K\] \[W/m2\]: what is left of the fall,
    /// where it is the law.
    #[must_use]
    pub fn into_gas(&self, current: f64, gas: f64) -> f64 {
        match self.role {
            Role::Cathode {
                emission: Emission::Fall(fall),
                ..
            } => current * entering(gas).min(fall),
            _ => 0.0,
        }
    }

    /// Work function times current densities \[W/m2\]: what an anode gains, what all electrons climb that leave a cathode, and
    /// how much of that the closure does not take from it, where `emitted` of `current` leave into the gas.
    #[must_use]
    pub fn work(&self, current: f64, emitted: f64) -> [f64; 3] {
        match self.role {
            Role::Anode { work_function } => [current * work_function, 0.0, 0.0],
            Role::Cathode {
                work_function,
                emission,
                ..
            } => {
                let ungiven = match emission {
                    Emission::Thermionic(_) => (current - emitted) * work_function,
                    Emission::NetIons(_) | Emission::Fall(_) => 0.0,
                };
                [0.0, current * work_function, ungiven]
            }
        }
    }

    /// Power of the layer in front of a cathode \[W/m2\]; over the current it is the cathode drop (eq.
    /// 5.29, with the areas that the sum needs), `emitted` of `current` leaving into the gas.
    #[must_use]
    pub fn layer(&self, current: f64, emitted: f64) -> f64 {
        match self.role {
            Role::Anode { .. } => 0.0,
            Role::Cathode {
                emission,
                ionisation_voltage,
                ..
            } => match emission {
                Emission::Thermionic(_) | Emission::NetIons(_) => {
                    (current - emitted) * ionisation_voltage
                }
                Emission::Fall(fall) => fall * current,
            },
        }
    }

    /// Slope of the sum of [`Electrode::heat`] with temperature \[W/(m2 K)\], never positive.
    #[must_use]
    pub fn slope(&self, current: f64, t: f64, gas: f64) -> f64 {
        let step = 1e-4 * t;
        let (low, high) = (
            self.heat(current, t - step, gas).sum(),
            self.heat(current, t + step, gas).sum(),
        );
        ((high - low) / (2.0 * step)).min(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cathode() -> Electrode {
        Electrode {
            name: "base".into(),
            role: Role::Cathode {
                work_function: 3.85,
                ionisation_voltage: 15.68,
                emission: Emission::Thermionic(1.2e6),
            },
            emissivity: 0.4,
            surroundings: 300.0,
            evaporation: None,
            absorbs: true,
        }
    }

    #[test]
    fn a_cold_cathode_lives_on_ions_and_a_hot_one_on_electrons() {
        let e = cathode();
        let cold = e.heat(1e7, 300.0, 300.0);
        assert!((cold.ion - 1e7 * 15.68).abs() < 1e-3);
        assert!(cold.electron.abs() < 1e-12 && cold.emission.abs() < 1e-12);
        let hot = e.heat(1e7, 5000.0, 300.0);
        assert!(hot.ion.abs() < 1e-9);
        assert!((hot.electron + 1e7 * 3.85).abs() < 1e-3);
    }

    #[test]
    fn iron_in_the_gas_lowers_the_ionisation_voltage_linearly() {
        let quarter = cathode().beside(0.25, 7.9);
        assert!((quarter.ionisation() - (0.75 * 15.68 + 0.25 * 7.9)).abs() < 1e-12);
        let cold = quarter.heat(1e7, 300.0, 300.0);
        assert!((cold.ion - 1e7 * quarter.ionisation()).abs() < 1e-3);
        assert!((cathode().beside(0.0, 7.9).ionisation() - 15.68).abs() < 1e-15);
    }

    #[test]
    fn richardson_and_dushman_at_2000_k() {
        // 1.2e6 * 4e6 * exp(-3.85 * 11604.518 / 2000), worked out by hand.
        let want = 4.8e12 * (-22.338_697_4_f64).exp();
        assert!((cathode().emitted(1e9, 2000.0, 300.0) - want).abs() < 1e-6 * want);
    }

    #[test]
    fn the_fall_is_shared_between_metal_and_gas() {
        let mut e = cathode();
        let Role::Cathode { emission, .. } = &mut e.role else {
            panic!("no cathode")
        };
        *emission = Emission::Fall(15.0);
        e.emissivity = 0.0;
        for (t, gas) in [(300.0, 2000.0), (2500.0, 11_604.518_12), (2500.0, 20_000.0)] {
            let heat = e.heat(1e7, t, gas);
            let theta = gas / 11_604.518_12;
            assert!((heat.sum() - 1e7 * (15.0 - 3.85 - 3.2 * theta)).abs() < 1e-4);
            // Fall, less the work that electrons took along, is what both take up.
            let all = heat.sum() + e.into_gas(1e7, gas);
            let emitted = e.emitted(1e7, t, gas);
            assert!((all - (e.layer(1e7, emitted) - 1e7 * 3.85)).abs() < 1e-4);
            // Electrons pay for ions and for what they bring into the gas.
            let paid = (1e7 - emitted) * 15.68 + e.into_gas(1e7, gas);
            assert!((emitted * 15.0 - paid).abs() < 1e-4);
        }
        // A fall that only carries electrons into the gas makes no ions.
        assert!((e.emitted(1e7, 300.0, 1e5) - 1e7).abs() < 1e-6);
    }

    #[test]
    fn what_a_cathode_takes_up_is_what_its_layer_gives_less_the_work_function() {
        let mut e = cathode();
        e.emissivity = 0.0;
        for t in [300.0, 2600.0, 5000.0] {
            let told = |e: &Electrode| {
                let emitted = e.emitted(1e7, t, 300.0);
                let [_, climbed, ungiven] = e.work(1e7, emitted);
                let heat = e.heat(1e7, t, 300.0).sum();
                (heat - (e.layer(1e7, emitted) - climbed + ungiven), ungiven)
            };
            let (missing, ungiven) = told(&e);
            let ions = 1e7 - e.emitted(1e7, t, 300.0);
            assert!(missing.abs() < 1e-4 && (ungiven - 3.85 * ions).abs() < 1e-4);
            let mut net = e.clone();
            let Role::Cathode { emission, .. } = &mut net.role else {
                panic!("no cathode")
            };
            *emission = Emission::NetIons(1.2e6);
            let (missing, ungiven) = told(&net);
            assert!(missing.abs() < 1e-4 && ungiven.abs() < 1e-12);
        }
    }

    #[test]
    fn an_anode_gains_its_work_function() {
        let e = Electrode {
            role: Role::Anode {
                work_function: 4.65,
            },
            ..cathode()
        };
        assert!((e.heat(2e7, 300.0, 300.0).sum() - 9.3e7).abs() < 1e-3);
    }

    #[test]
    fn iron_evaporates_as_hertz_and_knudsen_say() {
        let iron = Evaporation {
            boiling: 3100.0,
            latent_heat: 6.1e6,
            molar_mass: 0.055_845,
        };
        // At the boiling point: L p0 sqrt(M / (2 pi R T)).
        let want = 6.1e6
            * 101_325.0
            * (0.055_845 / (std::f64::consts::TAU * 8.314_462_618 * 3100.0)).sqrt();
        assert!((iron.heat(3100.0) - want).abs() < 1e-9 * want);
        assert!(iron.heat(2000.0) < 1e-3 * want);
    }

    #[test]
    fn the_slope_is_that_of_the_heat() {
        let e = cathode();
        let t = 2600.0;
        let fine = (e.heat(1e7, t + 0.01, 300.0).sum() - e.heat(1e7, t - 0.01, 300.0).sum()) / 0.02;
        assert!((e.slope(1e7, t, 300.0) - fine).abs() < 1e-4 * fine.abs());
    }
}
