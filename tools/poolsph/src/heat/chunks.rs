//! What befalls the exposed particles in a step, worked out side by side and applied in their order.

use rayon::prelude::*;

/// Particles of a chunk.
const SIZE: usize = 256;

/// Results by chunks of particles, with buffers that are kept from step to step.
#[derive(Debug, Clone)]
pub(super) struct Chunks<T> {
    chunks: Vec<Vec<T>>,
}

impl<T> Default for Chunks<T> {
    fn default() -> Self {
        Self { chunks: Vec::new() }
    }
}

impl<T: Send> Chunks<T> {
    /// Keeps what `each` makes of the `particles`, where it makes something.
    pub(super) fn fill(&mut self, particles: &[u32], each: impl Fn(usize) -> Option<T> + Sync) {
        let count = particles.len().div_ceil(SIZE);
        if self.chunks.len() < count {
            self.chunks.resize_with(count, || Vec::with_capacity(SIZE));
        }
        self.chunks.iter_mut().for_each(Vec::clear);
        self.chunks
            .par_iter_mut()
            .zip(particles.par_chunks(SIZE))
            .for_each(|(chunk, particles)| {
                chunk.extend(particles.iter().filter_map(|a| each(*a as usize)));
            });
    }

    /// All results, in the order of the particles.
    pub(super) fn drain(&mut self) -> impl Iterator<Item = T> {
        self.chunks.iter_mut().flat_map(|chunk| chunk.drain(..))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_the_particles_and_once() {
        let mut chunks = Chunks::default();
        for n in [1000_u32, 0, 300] {
            let particles: Vec<u32> = (0..n).map(|a| 3 * a).collect();
            chunks.fill(&particles, |a| a.is_multiple_of(2).then_some(a));
            let found: Vec<usize> = chunks.drain().collect();
            let expected = particles.iter().map(|a| *a as usize);
            assert_eq!(found, expected.filter(|a| a % 2 == 0).collect::<Vec<_>>());
        }
    }
}
