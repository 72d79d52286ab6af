//! The classic relaxations of M B = E, M = I − diag(ρ) F, row by row in residual form.
//!
//! B is the radiosity so far and r = E − M B what is still missing. Relaxing row i adds
//! ω `r_i` / `M_ii` to `B_i`, takes it from `r_i`, and gives every other row what it reflects of it.
//! Seen as light: a patch shoots what it has received and not yet sent on. The methods differ only
//! in which row is next ([`Method`](crate::settings::Method)), after [Cohen, Chen, Wallace and Greenberg 1988] and
//! [Gortler, Cohen and Slusallek 1994].
//!
//! The same loop works on an assembled matrix, [`System`], and on the hierarchical exchange of
//! [`solve`](super::solve), whose rows are made when they are needed.
//!
//! [Cohen, Chen, Wallace and Greenberg 1988]: https://doi.org/10.1145/54852.378487
//! [Gortler, Cohen and Slusallek 1994]: https://doi.org/10.1109/38.329094

mod check;
mod residuals;

mod order;
mod stall_detector;

mod run;

mod direct;
mod system;

pub(super) use check::check_reflectance;
pub use residuals::RelaxationStep;
pub(super) use residuals::RelaxationSystem;
pub(super) use run::Convergence;
pub use run::Relaxation;
pub use system::{Criteria, Relaxed, System};
