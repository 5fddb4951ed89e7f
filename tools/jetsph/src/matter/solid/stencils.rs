//! Weights that particles share: in a lattice all that stand alike to its faces have the same ones.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hasher};

/// Weights of neighbours in their order, of each kind once.
#[derive(Debug, Clone)]
pub(super) struct Stencils<const T: usize> {
    start: Vec<usize>,
    weight: Vec<[f64; T]>,
    back: Vec<[f64; T]>,
    total: Vec<[f64; T]>,
    /// First kind with given bits.
    known: HashMap<u64, u32>,
}

impl<const T: usize> Default for Stencils<T> {
    fn default() -> Self {
        Self {
            start: vec![0],
            weight: Vec::new(),
            back: Vec::new(),
            total: Vec::new(),
            known: HashMap::new(),
        }
    }
}

/// One kind of stencil.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stencil<'a, const T: usize> {
    pub(super) weight: &'a [[f64; T]],
    pub(super) back: &'a [[f64; T]],
    pub(super) total: &'a [f64; T],
}

impl<const T: usize> Stencils<T> {
    /// Number of the kind with these weights w_ij and w_ji.
    pub(super) fn kind(&mut self, weight: &[[f64; T]], back: &[[f64; T]]) -> u32 {
        let mut hasher = DefaultHasher::new();
        let numbers = weight.as_flattened().iter().chain(back.as_flattened());
        numbers.for_each(|x| hasher.write_u64(x.to_bits()));
        let bits = hasher.finish();
        if let Some(kind) = self.known.get(&bits) {
            let there = self.stencil(*kind);
            if there.weight == weight && there.back == back {
                return *kind;
            }
        }
        let kind = self.total.len() as u32;
        self.known.entry(bits).or_insert(kind);
        self.weight.extend_from_slice(weight);
        self.back.extend_from_slice(back);
        self.start.push(self.weight.len());
        let mut total = [0.0; T];
        for weight in weight {
            (0..T).for_each(|m| total[m] += weight[m]);
        }
        self.total.push(total);
        kind
    }

    /// Keeps the kinds in use alone where they are less than half, and numbers them anew.
    pub(super) fn tidy(&mut self, kinds: &mut [u32]) {
        let mut used = kinds.to_vec();
        used.sort_unstable();
        used.dedup();
        if 2 * used.len() >= self.total.len() {
            return;
        }
        let mut kept = Self::default();
        let new: HashMap<u32, u32> = used
            .iter()
            .map(|kind| {
                let stencil = self.stencil(*kind);
                (*kind, kept.kind(stencil.weight, stencil.back))
            })
            .collect();
        kinds.iter_mut().for_each(|kind| *kind = new[kind]);
        *self = kept;
    }

    /// A kind.
    #[inline(always)]
    pub(super) fn stencil(&self, kind: u32) -> Stencil<'_, T> {
        let kind = kind as usize;
        let range = self.start[kind]..self.start[kind + 1];
        Stencil {
            weight: &self.weight[range.clone()],
            back: &self.back[range],
            total: &self.total[kind],
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        16 * T * self.weight.len() + (24 + 8 * T) * self.total.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_alike_is_held_once() {
        let mut stencils = Stencils::<5>::default();
        let (one, other) = ([[1.0; 5], [2.0; 5]], [[3.0; 5]; 2]);
        let kinds = [&one, &other, &one].map(|weight| stencils.kind(weight, &other));
        assert_eq!(kinds, [0, 1, 0]);
        assert!((stencils.stencil(0).total[4] - 3.0).abs() <= 0.0);
        for k in 0..3 {
            stencils.kind(&[[10.0 + f64::from(k); 5]; 2], &other);
        }
        let mut kinds = [1, 1, 3];
        stencils.tidy(&mut kinds);
        assert_eq!(kinds, [0, 0, 1], "what is in use is kept");
        assert!((stencils.stencil(1).weight[0][4] - 11.0).abs() <= 0.0);
        assert_eq!(stencils.kind(&other, &other), 0);
    }
}
