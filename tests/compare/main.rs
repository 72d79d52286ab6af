//! Comparisons of meshes: the truth, the errors, the verdict and their files.

#[path = "../common/mod.rs"]
mod common;

mod files;
mod reference;
mod score;
mod statistics;
mod verdict;
