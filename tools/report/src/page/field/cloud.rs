//! The points: where they lie, how many there are of which kind.

use run::Failure;

use super::Run;
use crate::field::plane::View;
use crate::field::scene::Geometry;
use crate::field::{Kind, Points};
use crate::html::{Rows, escape, figure, picture, side_by_side};
use crate::page::{encoding, grouped};
use crate::picture::field::{kinds, spacings};
use crate::records::figure as digits;

/// The section.
pub(super) fn section(run: &Run) -> Result<String, Failure> {
    let points = &run.points;
    let whole = View::whole(points, 1);
    let near = View::near(points, 1);
    let place = place(points);
    let wide = format!("The distance of points in the whole domain{place}.");
    let close = format!(
        "The points about the bodies{place}: finer layers along surfaces, lattices beyond them."
    );
    let image = |canvas, words: &str| picture(&canvas, words).map_err(|e| encoding(&e));
    let mut pictures = vec![figure(&image(spacings(points, &whole), &wide)?, &wide)];
    if points.kind.contains(&Kind::Interface) {
        pictures.push(figure(&image(kinds(points, &near), &close)?, &close));
    }
    Ok(side_by_side(&pictures) + &table(points))
}

/// How the plane of the pictures lies.
fn place(points: &Points) -> &'static str {
    match points.scene.geometry {
        Geometry::Plane => "",
        Geometry::Axisymmetric => ", in a half plane through the axis",
        Geometry::Space => ", in a slab as thin as one distance across y",
    }
}

fn table(points: &Points) -> String {
    let mut table = Rows::new(&[
        "Medium",
        "#Points inside",
        "#On interfaces",
        "#On walls",
        "#Least distance [\u{b5}m]",
        "#Greatest distance [\u{b5}m]",
    ]);
    let mut media: Vec<u8> = points.medium.clone();
    media.sort_unstable();
    media.dedup();
    for medium in media {
        let own = |n: &usize| points.medium[*n] == medium;
        let of = |kind: Kind| {
            let each = (0..points.medium.len()).filter(own);
            grouped(each.filter(|n| points.kind[*n] == kind).count())
        };
        let each = (0..points.medium.len())
            .filter(own)
            .map(|n| points.spacing[n]);
        let [least, most] = each.fold([f64::INFINITY, 0.0_f64], |[l, h], s| [l.min(s), h.max(s)]);
        table.row([
            escape(points.scene.name(medium)),
            of(Kind::Inside),
            of(Kind::Interface),
            of(Kind::Wall),
            digits(1e6 * least),
            digits(1e6 * most),
        ]);
    }
    table.render()
}
