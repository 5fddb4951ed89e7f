//! The part of a tangent plane that belongs to a point: what is nearer to it than to any neighbour.

/// Where a plane ends: `s . way <= half`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bisector {
    /// The way to a neighbour \[m\].
    pub(super) way: [f64; 2],
    /// \[m2\].
    pub(super) half: f64,
}

/// Corners of the polygon that bisectors leave, in order; none where they leave nothing.
pub(super) fn cell(mut bisectors: Vec<Bisector>) -> Vec<[f64; 2]> {
    bisectors.sort_by(|a, b| span(a).total_cmp(&span(b)));
    let far = bisectors.last().map_or(0.0, span);
    let mut cell = vec![[-far, -far], [far, -far], [far, far], [-far, far]];
    let mut next = Vec::new();
    for Bisector { way, half } in &bisectors {
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
