//! What distortion programs take over: temperatures at the nodes of a mesh, and a fitted heat source.

pub(crate) mod calculix;
mod field;
mod fit;
pub(crate) mod goldak;
mod mesh;
mod pool;
