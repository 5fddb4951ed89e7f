//! Constants of physics: CODATA 2018. The first five are exact by definition of the SI.

/// Boltzmann's constant k, J/K.
pub const BOLTZMANN: f64 = 1.380_649e-23;
/// Charge of the proton e, C.
pub const ELEMENTARY_CHARGE: f64 = 1.602_176_634e-19;
/// Planck's constant h, J s.
pub const PLANCK: f64 = 6.626_070_15e-34;
/// Avogadro's constant, 1/mol.
pub const AVOGADRO: f64 = 6.022_140_76e23;
/// Speed of light c, m/s.
pub const LIGHT_SPEED: f64 = 299_792_458.0;
/// Molar gas constant R = k N_A, J/(mol K).
pub const GAS_CONSTANT: f64 = BOLTZMANN * AVOGADRO;
/// Mass of the electron, kg.
pub const ELECTRON_MASS: f64 = 9.109_383_701_5e-31;
/// Unit of atomic mass, kg.
pub const ATOMIC_MASS: f64 = 1.660_539_066_60e-27;
/// Permittivity of vacuum, F/m.
pub const PERMITTIVITY: f64 = 8.854_187_812_8e-12;
/// Stefan and Boltzmann's constant, W/(m2 K4).
pub const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// The electron-volt, J.
pub const ELECTRON_VOLT: f64 = ELEMENTARY_CHARGE;
/// Rydberg's constant as an energy R, J.
pub const RYDBERG: f64 = 2.179_872_361_103_5e-18;
/// One standard atmosphere, Pa.
pub const ATMOSPHERE: f64 = 101_325.0;
