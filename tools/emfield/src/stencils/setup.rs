//! From the cloud of a scene to points in as many coordinates as the equations have.

use shapes::frame::Vector;
use wls::Metric;

use crate::cloud::layout::Wall;
use crate::cloud::{self, Class, Cloud};
use crate::geometry::Geometry;
use crate::scene::Scene;
use crate::stencils::region::{Face, Kind, Region};

/// The first `D` coordinates of the scene of a place or direction in space.
pub(crate) fn reduce<const D: usize>(geometry: Geometry, x: Vector) -> [f64; D] {
    let own = geometry.coordinates(x);
    std::array::from_fn(|k| own[k])
}

/// A direction of the scene in space.
pub(crate) fn raise<const D: usize>(geometry: Geometry, x: [f64; D]) -> Vector {
    geometry.place(std::array::from_fn(|k| if k < D { x[k] } else { 0.0 }))
}

/// Numbers of the walls on which a place of the scene lies.
pub(crate) fn walls(cloud: &Cloud, x: Vector) -> Vec<usize> {
    match &cloud.wall {
        Wall::Ball { .. } => vec![0],
        Wall::Box { low, high, .. } => {
            let near = |a: f64, b: f64, k: usize| (a - b).abs() <= 1e-9 * (high[k] - low[k]);
            (0..2 * cloud.geometry.dimensions())
                .filter(|f| {
                    let (k, end) = (f / 2, if f % 2 == 0 { low } else { high });
                    near(x[k], end[k], k)
                })
                .collect()
        }
    }
}

/// Outward direction at a place of the given walls.
fn outward(wall: &Wall, x: Vector, walls: &[usize]) -> Vector {
    let sum = match wall {
        Wall::Ball { centre, .. } => shapes::frame::difference(x, *centre),
        Wall::Box { .. } => {
            let mut sum = [0.0; 3];
            for f in walls {
                sum[f / 2] += if f % 2 == 0 { -1.0 } else { 1.0 };
            }
            sum
        }
    };
    shapes::frame::direction(sum)
}

/// The points of a cloud in `D` coordinates; `open` tells whether a wall lets no field through, so that its normal is
/// asked for.
pub(crate) fn region<const D: usize>(
    scene: &Scene,
    cloud: &Cloud,
    open: &dyn Fn(usize) -> bool,
) -> Region<D> {
    let geometry = cloud.geometry;
    let mut region = Region {
        axial: geometry == Geometry::Axisymmetric,
        faces: cloud
            .surface
            .iter()
            .map(|s| Face {
                point: s.point,
                inner: s.inner,
                outer: s.outer,
                normal: reduce(geometry, s.normal),
                area: s.area,
            })
            .collect(),
        still: still(scene),
        bent: bent(scene),
        ..Region::default()
    };
    let mut faces = 0;
    for i in 0..cloud.len() {
        let x = geometry.coordinates(cloud.position[i]);
        region.places.push(reduce(geometry, cloud.position[i]));
        region.metrics.push(match cloud.metric[i] {
            cloud::Metric::Round => Metric::round(cloud.spacing[i]),
            cloud::Metric::Layered {
                normal,
                across,
                along,
                foot,
            } => {
                let straight = Metric::layered(reduce(geometry, normal), across, along);
                match cloud.curvature(i, foot, normal) {
                    Some(c) => straight.bent(reduce(geometry, c.along), c.principal),
                    None => straight,
                }
            }
        });
        let mut normal = [0.0; 3];
        region.kinds.push(match cloud.class[i] {
            Class::Inside(medium) => Kind::Inside(medium),
            Class::Interface { .. } => {
                faces += 1;
                Kind::Interface(faces - 1)
            }
            Class::Outer { medium, face } => {
                let all = walls(cloud, x);
                let free: Vec<usize> = all.iter().copied().filter(|f| open(*f)).collect();
                normal = outward(&cloud.wall, x, if free.is_empty() { &all } else { &free });
                Kind::Wall { medium, wall: face }
            }
        });
        region.wall_normals.push(std::array::from_fn(|k| normal[k]));
    }
    region
}

/// Media in which no current flows, where permeability mixes the components of potentials.
fn still(scene: &Scene) -> Vec<bool> {
    let magnetic = (1..=scene.bodies.len()).any(|m| scene.magnetic(m));
    if scene.eddy_currents.is_none() || scene.geometry != Geometry::Space || !magnetic {
        return Vec::new();
    }
    let quiet = |m: usize| scene.medium(m).conductivity_s_m == 0.0 && !scene.carries(m);
    (0..=scene.bodies.len()).map(quiet).collect()
}

/// Media whose permeability depends on the field.
fn bent(scene: &Scene) -> Vec<bool> {
    let saturates = |m: usize| scene.eddy_currents.is_some() && scene.saturates(m);
    let media = 0..=scene.bodies.len();
    if media.clone().any(saturates) {
        media.map(saturates).collect()
    } else {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::magnetic::diffusion::Conductors;
    use crate::magnetic::unknown::Unknown;
    use crate::stencils::sides::{Form, Sides};

    /// What stands before the own value and before its rate in a row of an interface have opposite signs, or the value
    /// grows by itself: slopes of quartics on boxes of a few spacings leaned on their own points with the sign of others.
    #[test]
    fn no_point_of_a_surface_grows_by_itself() {
        for (jitter, order) in [(0.0, 3), (0.0, 4), (0.3, 4)] {
            let scene = format!(
                r#"{{"geometry": "space", "domain": {{"sphere": {{"centre_m": [0, 0, 0], "radius_m": 9}}}},
                "bodies": [{{"name": "a", "conductivity_s_m": 1e7,
                    "shape": {{"box": {{"min_m": [-3.6, -1.8, -1.8], "max_m": [0, 1.8, 1.8]}}}}}},
                  {{"name": "b", "conductivity_s_m": 1e7,
                    "shape": {{"box": {{"min_m": [0, -1.8, -1.8], "max_m": [3.6, 1.8, 1.8]}}}}}}],
                "eddy_currents": {{"harmonic": {{"frequency_hz": 1}}, "applied_flux_density_t": [0, 0, 1]}},
                "points": {{"spacing_m": 1, "layers": {{"first_m": 0.3}}, "jitter": {jitter}, "seed": 1}}}}"#
            );
            let scene: Scene = serde_json::from_str(&scene).unwrap();
            let cloud = cloud::setup::cloud(&scene).unwrap();
            let region: Region<3> = region(&scene, &cloud, &|_| false);
            let form = Form {
                order,
                ..Form::default()
            };
            let sides = Sides::new(&region, &form).unwrap();
            let conductors = Conductors {
                mu_sigma: vec![0.0, 1.0, 1.0],
                axial: None,
                permeable: None,
            };
            let rows = conductors.rows(&region, &sides, Unknown::Potential);
            let rates = conductors.rates(&region, &sides, Unknown::Potential);
            for face in &region.faces {
                let i = face.point as usize;
                let (own, rate) = (rows.diagonal(i), rates[i]);
                let place = region.places[i];
                assert!(own * rate < 0.0, "order {order}: {own} {rate} at {place:?}");
            }
        }
    }
}
