//! Force on all that a closed surface encloses: the integral of Maxwell's stress over it, in a medium that carries no
//! current.
//!
//! - `T n = eps (E (E.n) - |E|^2 n / 2)` of electrostatics;
//! - `T n = Re(B (B*.n) - |B|^2 n / 2) / mu` of eddy currents: the mean of a period, or the value at an instant;
//! - heat `-Re((E x B*).n) / mu` by Poynting's vector.

use shapes::frame::{Vector, dot};
use shapes::surface::Piece;

use crate::geometry::Geometry;

use crate::magnetic::source::C;

/// A closed surface, ready to be integrated over.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Enclosing {
    /// Name in the scene.
    pub name: String,
    /// Places in space, about an axis those of the half plane y = 0 \[m\].
    pub places: Vec<Vector>,
    /// Normals outward.
    pub normals: Vec<Vector>,
    /// Areas \[m2; m in a plane; of the full turn about an axis\].
    pub areas: Vec<f64>,
    /// The medium in which it lies.
    pub medium: u16,
    /// Whether points of the cloud lie within.
    pub within: Vec<bool>,
}

impl Enclosing {
    /// A surface of pieces in coordinates of the scene, in the surroundings.
    pub(crate) fn of(name: &str, geometry: Geometry, pieces: &[Piece]) -> Self {
        let turn = |p: &Piece| match geometry {
            Geometry::Axisymmetric => std::f64::consts::TAU * p.place[0] * p.area,
            Geometry::Plane | Geometry::Space => p.area,
        };
        Self {
            name: name.to_owned(),
            places: pieces.iter().map(|p| geometry.place(p.place)).collect(),
            normals: pieces.iter().map(|p| geometry.place(p.normal)).collect(),
            areas: pieces.iter().map(turn).collect(),
            ..Self::default()
        }
    }

    /// Sum of `Re(F (F*.n)) - |F|^2 n / 2` over the places: the force of a field F where eps, or 1 / mu, is one.
    #[must_use]
    pub fn stress(&self, field: &[[C; 3]]) -> Vector {
        let mut force = [0.0; 3];
        for ((field, n), area) in field.iter().zip(&self.normals).zip(&self.areas) {
            let square: f64 = field.iter().map(C::norm_sqr).sum();
            let through: C = field.iter().zip(n).map(|(f, n)| f.conj() * n).sum();
            for k in 0..3 {
                force[k] += area * ((field[k] * through).re - 0.5 * square * n[k]);
            }
        }
        force
    }

    /// Sum of a flow by place through the surface, inward.
    #[must_use]
    pub fn inward(&self, flow: impl Iterator<Item = Vector>) -> f64 {
        let each = flow.zip(&self.normals).zip(&self.areas);
        -each.map(|((f, n), area)| area * dot(f, *n)).sum::<f64>()
    }
}
