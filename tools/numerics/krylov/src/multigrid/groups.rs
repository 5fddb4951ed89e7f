//! Points that are strongly coupled both ways, in groups.

use crate::grouping::{Grouping, NONE};
use crate::{Rows, Scalar};

/// First points whose strong neighbours are all free, with these; then what is left joins the
/// group it is coupled to most, or forms groups of its own. A row of nothing but its diagonal
/// is in no group.
pub(crate) fn groups<T: Scalar>(rows: &Rows<T>, strong: f64) -> Grouping {
    let n = rows.len();
    let graph = graph(rows, strong);
    let mut of = vec![NONE; n];
    let mut count = 0;
    for i in 0..n {
        let near = graph.columns(i);
        if near.is_empty() || of[i] != NONE || near.iter().any(|j| of[*j as usize] != NONE) {
            continue;
        }
        of[i] = count;
        for &j in near {
            of[j as usize] = count;
        }
        count += 1;
    }
    let first = of.clone();
    for i in (0..n).filter(|i| first[*i] == NONE) {
        let mut best = (0.0, NONE);
        for (j, v) in graph.pairs(i) {
            if first[j] != NONE && v > best.0 {
                best = (v, first[j]);
            }
        }
        of[i] = best.1;
    }
    for i in 0..n {
        if of[i] != NONE || rows.columns(i).len() == 1 {
            continue;
        }
        if rows.pairs(i).all(|(j, v)| j == i || v == T::ZERO) {
            continue;
        }
        of[i] = count;
        for &j in graph.columns(i) {
            if of[j as usize] == NONE {
                of[j as usize] = count;
            }
        }
        count += 1;
    }
    Grouping::new(of, count as usize)
}

/// How much a coefficient couples: its real part against that of the diagonal, if of the other
/// sign.
fn coupling<T: Scalar>(value: T, diagonal: T) -> f64 {
    let sign = if diagonal.real_part() < 0.0 {
        1.0
    } else {
        -1.0
    };
    (sign * value.real_part()).max(0.0)
}

/// Neighbours strong both ways, and how strong.
fn graph<T: Scalar>(rows: &Rows<T>, strong: f64) -> Rows<f64> {
    let largest: Vec<[f64; 1]> = {
        let mut largest = vec![[0.0]; rows.len()];
        crate::columns::update(&mut largest, |range, out| {
            for (i, out) in range.zip(out) {
                let d = rows.diagonal(i);
                let off = rows.pairs(i).filter(|(j, _)| *j != i);
                *out = [off.map(|(_, v)| coupling(v, d)).fold(0.0, f64::max)];
            }
        });
        largest
    };
    Rows::made(
        rows.len(),
        || (),
        |i, (), columns, values| {
            let d = rows.diagonal(i);
            let [most] = largest[i];
            for (j, v) in rows.pairs(i) {
                let there = coupling(v, d);
                if j == i || there == 0.0 || there < strong * most {
                    continue;
                }
                let Ok(at) = rows.columns(j).binary_search(&(i as u32)) else {
                    continue;
                };
                let back = coupling(rows.values(j)[at], rows.diagonal(j));
                if back > 0.0 && back >= 0.5 * strong * largest[j][0] {
                    columns.push(j as u32);
                    values.push(there);
                }
            }
        },
    )
}
