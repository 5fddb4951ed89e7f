//! Heat between touching grains.
//!
//! ```text
//! H_c = 4 k_a k_b / (k_a + k_b) r_c                      constriction of two half-spaces (2 k r_c for equal k)
//! H_g = k_g 2 pi (1 - (r_c/r_p)^2 / 2) (r_p - r_c) / (1 - pi/4)       gas around the contact (Komen 2019, eq. 5.36)
//! ```
//!
//! Eq. 5.35 prints half of the first. Its radius of contact, eq. 5.34, is that of the circle in which the spheres cut each
//! other; it follows the soft spring of the computation and not the grain. [`radius_by_force`] is what the real modulus gives
//! under the same push (Hertz 1881), so that what is conducted does not hang on the spring.

use std::f64::consts::PI;

/// Radius of the circle in which two equal spheres cut each other \[m\] (eq. 5.34), at the distance of their centres.
#[must_use]
pub fn radius_by_overlap(grain_radius: f64, distance: f64) -> f64 {
    let half = 0.5 * distance;
    (grain_radius * grain_radius - half * half).max(0.0).sqrt()
}

/// Radius of the contact of elastic spheres under a push \[m\]: `(3 N R* / (4 E*))^(1/3)`.
#[must_use]
pub fn radius_by_force(push: f64, effective_radius: f64, effective_modulus: f64) -> f64 {
    (0.75 * push.max(0.0) * effective_radius / effective_modulus).cbrt()
}

/// Conductance through the solid contact \[W/K\] of grains of the conductivities k_a and k_b \[W/(m K)\].
#[must_use]
pub fn constriction([a, b]: [f64; 2], contact_radius: f64) -> f64 {
    4.0 * a * b / (a + b) * contact_radius
}

/// Conductance through the solid contact as eq. 5.35 prints it: half of [`constriction`].
#[must_use]
pub fn constriction_as_printed(conductivity: [f64; 2], contact_radius: f64) -> f64 {
    0.5 * constriction(conductivity, contact_radius)
}

/// Conductance through the gas around a contact \[W/K\] (eq. 5.36), for a radius of contact below that of the grains.
#[must_use]
pub fn gas(conductivity: f64, grain_radius: f64, contact_radius: f64) -> f64 {
    let share = (contact_radius / grain_radius).min(1.0);
    conductivity * 2.0 * PI * (1.0 - 0.5 * share * share) * grain_radius * (1.0 - share)
        / (1.0 - 0.25 * PI)
}
