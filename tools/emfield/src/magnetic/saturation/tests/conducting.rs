use crate::cloud;
use crate::magnetic::saturation::equations::Saturation;
use crate::magnetic::unknown::Unknown;
use crate::scene::Scene;
use crate::stencils::region::{Kind, Region};
use crate::stencils::setup::region;
use crate::stencils::sides::{Form, Sides};
use crate::stencils::tests::{rings, shells};

/// Media of which only the derivatives of their rows are asked for.
fn media<'a, const D: usize>(
    region: &'a Region<D>,
    sides: &'a Sides<D>,
    unknown: Unknown,
) -> Saturation<'a, D> {
    Saturation {
        region,
        sides,
        unknown,
        media: Vec::new(),
        points: Vec::new(),
        faces: Vec::new(),
        walls: Vec::new(),
        slots: Vec::new(),
    }
}

/// The largest error of the curl inside medium 1, of a vector by place, against what it is.
fn error<const D: usize, const K: usize>(
    region: &Region<D>,
    form: Form,
    unknown: Unknown,
    vector: impl Fn([f64; D], [f64; D]) -> [f64; 3],
    curl: impl Fn([f64; D]) -> [f64; K],
) -> f64 {
    let sides = Sides::new(region, &form).unwrap();
    let media = media(region, &sides, unknown);
    let inside = (0..region.len()).filter(|i| matches!(region.kinds[*i], Kind::Inside(1)));
    let off = inside.map(|i| {
        let at = |j: usize| vector(region.places[j], media.beside(j));
        let found: [f64; K] = media.turned(i, at);
        let wanted = curl(region.places[i]);
        (0..K)
            .map(|k| (found[k] - wanted[k]).abs())
            .fold(0.0, f64::max)
    });
    off.fold(0.0, f64::max)
}

fn form(order: u8, around: f64) -> Form {
    Form {
        order,
        around,
        ..Form::default()
    }
}

#[test]
fn the_curl_in_a_plane_is_exact_on_quartics() {
    let vector = |[x, y]: [f64; 2], _| [x * y * y - y, x.powi(4) + 3.0 * x * y, 7.0];
    let curl = |[x, y]: [f64; 2]| [4.0 * x.powi(3) + 3.0 * y - 2.0 * x * y + 1.0];
    let region = rings(0.2);
    let off = error(&region, form(4, 1.0), Unknown::Potential, vector, curl);
    assert!(off < 1e-9, "{off}");
}

#[test]
fn the_curl_in_space_is_exact_on_quadratics() {
    let vector = |[x, y, z]: [f64; 3], _| [y * z, 2.0 * x * x - z, x * z - 3.0 * y * y];
    let curl = |[x, y, z]: [f64; 3]| [1.0 - 6.0 * y, y - z, 4.0 * x - z];
    let (region, _) = shells(0.25, 0.25);
    let off = error(&region, form(2, 1.0), Unknown::Potential, vector, curl);
    assert!(off < 1e-9, "{off}");
}

/// `(d P_r/dz - d P_z/dr) / r`, also on the axis itself.
#[test]
fn the_curl_about_an_axis_is_exact_on_quartics() {
    let scene = serde_json::json!({"geometry": "axisymmetric",
        "domain": {"sphere": {"centre_m": [0, 0], "radius_m": 2}},
        "bodies": [{"name": "ball", "conductivity_s_m": 1,
            "shape": {"disc": {"centre_m": [0, 0], "radius_m": 1}}}],
        "eddy_currents": {"static": {}, "outer": "multipole", "applied_flux_density_t": [0, 1]},
        "points": {"spacing_m": 0.2, "layers": {"first_m": 0.1}, "outward": 0}});
    let scene: Scene = serde_json::from_value(scene).unwrap();
    let cloud = cloud::setup::cloud(&scene).unwrap();
    let region = region::<2>(&scene, &cloud, &|_| false);
    assert!(region.places.iter().any(|p| p[0] == 0.0));
    // What is odd about the axis is known beside it.
    let vector = |[r, z]: [f64; 2], beside: [f64; 2]| {
        [
            beside[0] * (z * z + r * r * z),
            0.0,
            r * r * (1.0 + z) + z.powi(4),
        ]
    };
    let curl = |[r, z]: [f64; 2]| [2.0 * z + r * r - 2.0 * (1.0 + z)];
    let form = form(4, Unknown::Around.around());
    let off = error(&region, form, Unknown::Around, vector, curl);
    assert!(off < 1e-9, "{off}");
}
