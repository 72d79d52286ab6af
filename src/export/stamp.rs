//! What a file says about the light in it, beside the light.

use crate::tone::Exposure;

/// What a file says about the light in it, beside the light.
#[derive(Clone, Debug, PartialEq)]
pub struct Stamp {
    /// How the colours were, or are to be, exposed.
    pub exposure: Exposure,
    /// The settings of the solution, as the caller wants them on record; kept by `.glb` only.
    pub settings: serde_json::Value,
    /// False if the solver was stopped before it was done.
    pub finished: bool,
}

impl Default for Stamp {
    fn default() -> Self {
        Self { exposure: Exposure::Automatic, settings: serde_json::Value::Null, finished: true }
    }
}
