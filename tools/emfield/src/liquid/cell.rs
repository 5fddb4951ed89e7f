//! The part of a tangent plane that belongs to a point: what is nearer to it than to any neighbour.

/// Where a plane ends: `s . way <= half`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bisector {
    /// The way to a neighbour \[m\].
    pub(super) way: [f64; 2],
    /// \[m2\].
    pub(super) half: f64,
}

/// Neighbours that stand around a point of an even surface.
const AROUND: usize = 6;
/// A corner farther than this from the point, over the mean way to its nearest neighbours, is none of a closed surface: that of
/// a square lattice is at 0.6, those of points in disorder are within 1.
const OPEN: f64 = 1.5;
/// How far a part reaches to the side where nothing stands, over the same.
const EDGE: f64 = 0.6;
/// Where neighbours are farther than this many spacings, there are none.
const SPARSE: f64 = 4.0 / 3.0;

/// Corners of the polygon that bisectors leave, in order; none where they leave nothing. Where no neighbour bounds it, as at the
/// edge of a sheet or of a crease, it ends little beyond half the way to the nearest ones. Points are some spacing apart.
pub(super) fn cell(mut bisectors: Vec<Bisector>, spacing: f64) -> Vec<[f64; 2]> {
    bisectors.sort_by(|a, b| span(a).total_cmp(&span(b)));
    let far = bisectors.last().map_or(0.0, span);
    let whole = vec![[-far, -far], [far, -far], [far, far], [-far, far]];
    let mut cell = clipped(whole, &bisectors);
    let near = nearest(&bisectors).min(SPARSE * spacing);
    if cell.iter().any(|q| q[0].hypot(q[1]) > OPEN * near) {
        let sides = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
        let sides = sides.map(|way| Bisector {
            way,
            half: EDGE * near,
        });
        cell = clipped(cell, &sides);
    }
    cell
}

/// Mean of the ways to the nearest neighbours, each twice as far as its bisector.
fn nearest(bisectors: &[Bisector]) -> f64 {
    let mut ways: Vec<f64> = bisectors.iter().map(|b| 2.0 * b.half / span(b)).collect();
    ways.retain(|way| way.is_finite());
    ways.sort_by(f64::total_cmp);
    ways.truncate(AROUND);
    ways.iter().sum::<f64>() / ways.len() as f64
}

/// What bisectors leave of a polygon.
fn clipped(mut cell: Vec<[f64; 2]>, bisectors: &[Bisector]) -> Vec<[f64; 2]> {
    let mut next = Vec::new();
    for Bisector { way, half } in bisectors {
        let beyond = |q: &[f64; 2]| q[0] * way[0] + q[1] * way[1] - half;
        next.clear();
        for (k, a) in cell.iter().enumerate() {
            let b = cell[(k + 1) % cell.len()];
            let (u, v) = (beyond(a), beyond(&b));
            if u <= 0.0 {
                next.push(*a);
            }
            if (u < 0.0) != (v < 0.0) && (u > 0.0) != (v > 0.0) {
                let t = u / (u - v);
                next.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
            }
        }
        std::mem::swap(&mut cell, &mut next);
        if cell.is_empty() {
            break;
        }
    }
    cell
}

fn span(bisector: &Bisector) -> f64 {
    bisector.way[0].hypot(bisector.way[1])
}

/// Twice the area of a polygon.
pub(super) fn twice(cell: &[[f64; 2]]) -> f64 {
    let each = (0..cell.len()).map(|k| {
        let (a, b) = (cell[k], cell[(k + 1) % cell.len()]);
        a[0] * b[1] - a[1] * b[0]
    });
    each.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn among(ways: &[[f64; 2]]) -> f64 {
        let bisectors = ways.iter().map(|way| Bisector {
            way: *way,
            half: 0.5 * (way[0] * way[0] + way[1] * way[1]),
        });
        0.5 * twice(&cell(bisectors.collect(), 1.0))
    }

    /// Points of a square lattice within three spacings of its origin, on one side of a line or everywhere.
    fn lattice(keep: impl Fn(f64, f64) -> bool) -> Vec<[f64; 2]> {
        let all = (-3..=3).flat_map(|i| (-3..=3).map(move |j| [f64::from(i), f64::from(j)]));
        let apart = |w: &[f64; 2]| w[0] != 0.0 || w[1] != 0.0;
        all.filter(|w| apart(w) && keep(w[0], w[1])).collect()
    }

    #[test]
    fn a_part_at_an_edge_is_no_larger_than_half_a_spacing_more() {
        assert!((among(&lattice(|_, _| true)) - 1.0).abs() < 1e-12);
        // Without what stands to the right it would reach three spacings far.
        let edge = among(&lattice(|x, _| x <= 0.0));
        assert!((1.0..1.6).contains(&edge), "{edge}");
        let corner = among(&lattice(|x, y| x <= 0.0 && y <= 0.0));
        assert!((1.0..2.0).contains(&corner), "{corner}");
        // One that stands alone has no more than its share.
        let alone = among(&[[4.0, 0.0], [4.0, 4.0]]);
        assert!(alone < 3.0, "{alone}");
        // One hole among neighbours is shared, not cut.
        let beside = among(&lattice(|x, y| (x, y) != (1.0, 0.0)));
        assert!((beside - 1.25).abs() < 1e-12, "{beside}");
    }
}
