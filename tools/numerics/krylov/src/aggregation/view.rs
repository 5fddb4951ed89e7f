//! What is coarsened: a symmetric matrix, or the symmetric part of another.

use super::rows::{Balance, Link, Rows};
use crate::grouping::NONE;

/// A symmetric matrix to be coarsened: its couplings, diagonal and excess.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    starts: Vec<u32>,
    links: Vec<Link>,
    excess: Vec<f64>,
}

/// Where the couplings of a matrix are found.
#[derive(Debug, Clone, Copy)]
pub(crate) enum View<'a> {
    /// A symmetric matrix itself.
    Rows(&'a Rows, &'a Balance),
    /// The symmetric part of another.
    Part(&'a Graph, &'a Balance),
}

impl<'a> View<'a> {
    pub(crate) fn row(self, i: usize) -> impl Iterator<Item = (u32, f64)> + 'a {
        let links = match self {
            View::Rows(rows, _) => rows.row(i),
            View::Part(graph, _) => graph.row(i),
        };
        let others = links.iter().filter(move |link| link.0 as usize != i);
        others.map(|&(j, w)| (j, f64::from(w)))
    }

    pub(crate) fn diagonal(self, i: usize) -> f64 {
        match self {
            View::Rows(_, balance) | View::Part(_, balance) => balance.diagonal[i],
        }
    }

    /// Excess; what falls below zero (convection that leaves) counts as none.
    pub(crate) fn excess(self, i: usize) -> f64 {
        match self {
            View::Rows(_, balance) => balance.excess[i].max(0.0),
            View::Part(graph, _) => graph.excess[i].max(0.0),
        }
    }

    /// Number of rows.
    pub(crate) fn len(self) -> usize {
        match self {
            View::Rows(_, balance) | View::Part(_, balance) => balance.diagonal.len(),
        }
    }
}

impl Graph {
    fn row(&self, i: usize) -> &[Link] {
        &self.links[self.starts[i] as usize..self.starts[i + 1] as usize]
    }

    /// The symmetric part of `rows`.
    pub(crate) fn of(rows: &Rows, balance: &Balance) -> Self {
        let (n, entries) = (rows.len(), rows.entries());
        let others = |i: usize| {
            let links = rows.row(i).iter();
            links.filter(move |link| link.0 as usize != i)
        };
        let mut begin = vec![0_u32; n + 1];
        for i in 0..n {
            for &(j, _) in others(i) {
                begin[j as usize + 1] += 1;
            }
        }
        for i in 0..n {
            begin[i + 1] += begin[i];
        }
        let mut transposed = vec![(0, 0.0); entries];
        let mut next = begin.clone();
        for i in 0..n {
            for &(j, w) in others(i) {
                transposed[next[j as usize] as usize] = (i as u32, w);
                next[j as usize] += 1;
            }
        }
        let mut graph = Self {
            starts: vec![0],
            links: Vec::with_capacity(entries),
            excess: Vec::with_capacity(n),
        };
        let mut place = vec![NONE; n];
        for i in 0..n {
            let first = graph.links.len();
            let other = &transposed[begin[i] as usize..begin[i + 1] as usize];
            let mut sum = 0.0;
            for &(j, w) in others(i).chain(other) {
                let at = place[j as usize];
                if at != NONE && at as usize >= first {
                    graph.links[at as usize].1 += 0.5 * w;
                } else {
                    place[j as usize] = graph.links.len() as u32;
                    graph.links.push((j, 0.5 * w));
                }
                sum += 0.5 * f64::from(w);
            }
            graph.starts.push(graph.links.len() as u32);
            graph.excess.push(balance.diagonal[i] - sum);
        }
        graph
    }
}
