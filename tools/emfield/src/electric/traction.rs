//! Traction of an electrostatic field on a surface: the jump of Maxwell's stress.

use shapes::frame::dot;

/// Permittivity of vacuum \[F/m\] (CODATA 2018).
pub const EPS0: f64 = 8.854_187_812_8e-12;

/// Traction \[Pa\] on a surface without free charge between the permittivities `[inner, outer]`
/// (relative), from the fields `[inside, outside]` and the unit normal outward:
/// `eps0 (eps_i - eps_o)/2 (Dn^2 / (eps_i eps_o) + Et^2)` along the normal, which with `S = eps_i / eps_o` is
/// `eps0 eps_o (S - 1)/2 (S En^2 + Et^2)` of the field inside. Matsuzawa (2017), eq. 2.62, has the part of a
/// conductor alone. Both sides have the same displacement `Dn` and the same `Et`; each is taken where its
/// error counts least: `Dn` from the lesser permittivity, `Et` from the greater.
#[must_use]
pub fn dielectric(
    [inner, outer]: [f64; 2],
    [inside, outside]: [[f64; 3]; 2],
    normal: [f64; 3],
) -> [f64; 3] {
    let (displacement, rich) = if inner > outer {
        (outer * dot(outside, normal), inside)
    } else {
        (inner * dot(inside, normal), outside)
    };
    let along = dot(rich, normal);
    let tangential = dot(rich, rich) - along * along;
    let both = displacement * displacement / (inner * outer) + tangential;
    let size = 0.5 * EPS0 * (inner - outer) * both;
    normal.map(|n| n * size)
}

/// Traction \[Pa\] outward and along a surface whose charge is what currents have brought to it, of a liquid of permittivity `s` and
/// conductivity `ratio` over those outside. Both sides have the same current through the surface and the same `Et`; each is taken
/// where its error counts least: the current from the lesser conductivity, `Et` from the greater.
#[must_use]
pub fn leaky(
    [s, ratio]: [f64; 2],
    [inside, outside]: [[f64; 3]; 2],
    normal: [f64; 3],
) -> (f64, [f64; 3]) {
    let (current, rich) = if ratio > 1.0 {
        (dot(outside, normal), inside)
    } else {
        (ratio * dot(inside, normal), outside)
    };
    let through = dot(rich, normal);
    let along: [f64; 3] = std::array::from_fn(|k| rich[k] - through * normal[k]);
    let inner = current / ratio;
    let out = current * current - s * inner * inner + (s - 1.0) * dot(along, along);
    let charge = EPS0 * (current - s * inner);
    (0.5 * EPS0 * out, along.map(|e| charge * e))
}

/// Traction \[Pa\] on an electrode from the field outside: `eps E_n^2 / 2` (eq. 2.62).
#[must_use]
pub fn electrode(outer: f64, field: [f64; 3], normal: [f64; 3]) -> [f64; 3] {
    let along = dot(field, normal);
    normal.map(|n| n * 0.5 * EPS0 * outer * along * along)
}

/// Maxwell's stress on a surface of this normal where the permittivity is one: `E (E.n) - |E|^2 n / 2`.
#[must_use]
pub fn stress(field: [f64; 3], normal: [f64; 3]) -> [f64; 3] {
    let (along, square) = (dot(field, normal), dot(field, field));
    std::array::from_fn(|k| field[k] * along - 0.5 * square * normal[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dielectric_of_high_permittivity_is_pulled_like_an_electrode() {
        let normal = [0.6, 0.0, 0.8];
        // Inside, the normal field is that outside over S.
        let outside = normal.map(|n| 3e5 * n);
        let inside = outside.map(|e| e / 1e9);
        let [a, b] = [
            dielectric([1e9, 1.0], [inside, outside], normal),
            electrode(1.0, outside, normal),
        ];
        for k in [0, 2] {
            assert!((a[k] / b[k] - 1.0).abs() < 1e-8);
        }
    }

    #[test]
    fn what_leaks_as_it_is_polarised_is_pulled_like_a_dielectric() {
        let (normal, s) = ([0.0, 0.6, 0.8], 7.0);
        let through = 2.0;
        let along = [3.0, -0.8, 0.6];
        let at = |factor: f64| std::array::from_fn(|k| along[k] + factor * through * normal[k]);
        let (out, drag) = leaky([s, s], [at(1.0), at(s)], normal);
        let wanted = dot(dielectric([s, 1.0], [at(1.0), at(s)], normal), normal);
        assert!((out / wanted - 1.0).abs() < 1e-12);
        assert!(drag.iter().all(|t| t.abs() < 1e-12 * out.abs()));
        // Charge 5 - 7 of the field inside: against the field along the surface.
        let (_, drag) = leaky([s, 5.0], [at(1.0), at(5.0)], normal);
        for (t, e) in drag.iter().zip(along) {
            assert!((t / (-2.0 * EPS0 * through * e) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn traction_is_the_jump_of_the_stress_of_maxwell() {
        let (inner, outer) = (5.0, 2.0);
        let field = [3.0, -1.0, 2.0];
        let beyond = [3.0, -1.0, 2.0 * inner / outer];
        let normal = [0.0, 0.0, 1.0];
        let stress = |eps: f64, e: [f64; 3]| EPS0 * eps * (e[2] * e[2] - 0.5 * dot(e, e));
        let jump = stress(outer, beyond) - stress(inner, field);
        let found = dielectric([inner, outer], [field, beyond], normal)[2];
        assert!((found / jump - 1.0).abs() < 1e-12);
        let swapped = dielectric([outer, inner], [beyond, field], normal)[2];
        assert!((swapped / jump + 1.0).abs() < 1e-12);
    }
}
