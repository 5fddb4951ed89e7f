//! Droplet-phase and time averages of particle frames on a grid that moves with the source.
