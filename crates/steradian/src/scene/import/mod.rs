//! Importers: each turns files of one format into a [`SceneDesc`](super::SceneDesc).

pub mod pbrt;
pub mod ply;
