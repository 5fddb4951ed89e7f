//! The search over all pairs: slow, obvious, the oracle of the cell list.

/// Neighbours of each point within `radius`, ascending.
#[must_use]
pub fn search(points: &[[f64; 3]], radius: f64) -> Vec<Vec<u32>> {
    let mut rows = vec![Vec::new(); points.len()];
    for (a, row) in rows.iter_mut().enumerate() {
        for (b, point) in points.iter().enumerate() {
            let dx = std::array::from_fn::<f64, 3, _>(|k| points[a][k] - point[k]);
            if b != a && dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2] < radius * radius {
                row.push(u32::try_from(b).unwrap_or(u32::MAX));
            }
        }
    }
    rows
}
