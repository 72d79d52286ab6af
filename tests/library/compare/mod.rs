//! Comparisons of meshes: the truth, the errors, the verdict and their files.

mod files;
mod reference;
mod score;
mod statistics;
mod verdict;
