//! Uniform and adaptive meshes side by side: their errors against a reference, and what they cost.
//!
//! ```text
//! Scene → Surfaces → first Reference → a Run for each mesh → Reference that resolves their errors → Verdict, ShadowProfile
//! ```
//!
//! One reference, one norm weighted by area, one tolerance of the solver, the same exact direct light and the same
//! threads for all; time includes every set-up.
//!
//! | what | where |
//! |---|---|
//! | what to compare | `plan` |
//! | the truth | `reference`: `traced` by the `path_tracer` with `sobol` numbers at `sample_points`, refined by `estimate`; or read by `table`, `arrays`; in either case a `held_reference` |
//! | one mesh | `run` in so much `memory`; `score` of what `locate` finds |
//! | all of them | `comparison`: `curve` by family, `verdict`, `sentences`; a `profile` across a shadow |
//! | told | `report`, `record` |

mod arrays;
mod comparison;
mod curve;
mod estimate;
mod held_reference;
mod locate;
mod memory;
mod path_tracer;
mod plan;
mod profile;
mod record;
mod reference;
mod report;
mod run;
mod sample_points;
mod score;
mod sentences;
mod sobol;
mod table;
mod traced;
mod verdict;

pub use comparison::{Comparison, ComparisonProgress, compare};
pub use curve::{CostCurve, Needed};
pub use estimate::Effort;
pub use locate::Locator;
pub use path_tracer::Site;
pub use plan::{ComparisonPlan, ReferenceSource};
pub use profile::{ShadowProfile, Trace};
pub use record::{check_writable, figures, save};
pub use reference::{Origin, Point, Reference, Set};
pub use report::{Account, report};
pub use run::{Division, Family, Lit, Run, Seconds, TimedSurfaces};
pub use score::{Band, ErrorStatistics, Score, score};
pub use sentences::{laws, number, percent};
pub use verdict::{
    AtEqualCost, AtEqualError, BandVerdict, Contest, Cost, LAWS, Slopes, TIE, Verdict, Winner,
    nearest_law,
};
