//! Neighbour lists of point clouds by cell lists.
//!
//! [`Grid`] sorts points into cubic cells (counting sort, stable: ascending index within a
//! cell); [`Lists`] holds, for each row, the points closer than a radius, in the order of the
//! cells and then of the index. That order depends on the points alone, never on the threads,
//! so a sum over a row is bitwise reproducible. A point at exactly the radius is no neighbour
//! (every kernel is zero there), nor is a point its own.
//!
//! Points of the cells around are tested in the widest vectors that the machine has. No operation is
//! fused or reordered for it: the bits are the same on every machine.
//!
//! [`Tree`] serves clouds whose spacing varies, where no one size of cells fits.
//!
//! Lists are kept in chunks of [`ROWS`] rows. A chunk is the unit of parallel work and of
//! memory: buffers keep their capacity from build to build, so that a settled cloud is searched
//! without allocation. Pair data of a caller can use the same offsets ([`Chunk::offsets`]).
//!
//! ```
//! use neighbours::{Grid, Lists};
//! let points = [[0.0, 0.0, 0.0], [0.9, 0.0, 0.0], [1.0, 0.0, 0.0], [-3.0, 0.0, 0.0]];
//! let (mut grid, mut lists) = (Grid::new(1.0), Lists::new());
//! grid.bin(&points);
//! lists.build(grid.search(&points, 1.0), |_| true, |_, _| true);
//! assert_eq!(lists.row(0), [1]);
//! assert_eq!(lists.row(1), [0, 2]);
//! ```

mod grid;
mod halo;
mod lists;
pub mod naive;
mod sieve;
mod tree;

pub use grid::{Grid, Search};
pub use halo::Halo;
pub use lists::{Chunk, Lists, ROWS};
pub use tree::Tree;
