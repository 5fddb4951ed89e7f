//! Neighbour lists of point clouds by cell lists.
