//! What belongs to the bead and what is spatter.

use std::collections::BTreeMap;

/// Cell of a particle.
type Cell = [i64; 3];

/// Marks the largest group of particles that `counts` names, joined by distances below `link` \[m\].
/// Drops in flight and spatter on the plate are other groups.
pub(crate) fn largest(position: &[[f64; 3]], counts: &[bool], link: f64) -> Vec<bool> {
    let cell = |p: &[f64; 3]| -> Cell { p.map(|x| (x / link).floor() as i64) };
    let mut cells: BTreeMap<Cell, Vec<usize>> = BTreeMap::new();
    for (i, p) in position.iter().enumerate().filter(|(i, _)| counts[*i]) {
        cells.entry(cell(p)).or_default().push(i);
    }
    let mut seen = vec![false; position.len()];
    let mut best: Vec<usize> = Vec::new();
    for start in (0..position.len()).filter(|i| counts[*i]) {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        let mut group = vec![start];
        let mut next = 0;
        while let Some(&a) = group.get(next) {
            next += 1;
            for b in around(&cells, cell(&position[a])) {
                if !seen[b] && near(&position[a], &position[b], link) {
                    seen[b] = true;
                    group.push(b);
                }
            }
        }
        if group.len() > best.len() {
            best = group;
        }
    }
    let mut marked = vec![false; position.len()];
    for i in best {
        marked[i] = true;
    }
    marked
}

fn around(cells: &BTreeMap<Cell, Vec<usize>>, at: Cell) -> Vec<usize> {
    let mut found = Vec::new();
    for n in 0..27 {
        let place = [at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1];
        found.extend(cells.get(&place).into_iter().flatten());
    }
    found
}

fn near(a: &[f64; 3], b: &[f64; 3], link: f64) -> bool {
    let square: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
    square < link * link
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_group_is_the_bead() {
        let row = |x: f64, n: u32| (0..n).map(move |k| [x, f64::from(k), -0.5]);
        let position: Vec<[f64; 3]> = row(0.0, 3).chain(row(10.0, 5)).chain(row(1.4, 2)).collect();
        let counts = vec![true; position.len()];
        let found = largest(&position, &counts, 1.5);
        // The first and the last row touch, and are 5 as well; the first group found wins.
        assert_eq!(found.iter().filter(|f| **f).count(), 5);
        assert!(found[0] && found[9] && !found[4]);
        let mut fewer = counts;
        fewer[0] = false;
        assert!(largest(&position, &fewer, 1.5)[4]);
        assert!(largest(&[], &[], 1.0).is_empty());
    }
}
