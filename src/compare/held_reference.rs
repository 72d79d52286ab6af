//! The reference that the runs of a comparison are held against, as it becomes more exact.

use std::ops::ControlFlow;

use super::path_tracer::PathTracer;
use super::plan::ReferenceSource;
use super::reference::Reference;
use super::score::{Band, ErrorStatistics, Score};
use super::traced::TracedReference;
use super::verdict::TIE;
use crate::error::Result;

/// The reference: at first only as good as it must be for runs to be judged at all, so that there is something to tell
/// soon; once their errors are known, so good that it resolves them.
#[derive(Debug)]
pub(super) enum HeldReference<'a> {
    Traced(Box<TracedReference<'a>>),
    Loaded(Reference),
}

impl<'a> HeldReference<'a> {
    /// # Errors
    /// Those of [`Reference::load`] and [`TracedReference::begin`].
    pub(super) fn begin(
        tracer: &'a PathTracer<'a>,
        source: &ReferenceSource,
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Self> {
        Ok(match source {
            ReferenceSource::File(path) => {
                Self::Loaded(Reference::load(path, tracer.surfaces.extent)?)
            }
            ReferenceSource::Traced(effort) => {
                Self::Traced(Box::new(TracedReference::begin(tracer, effort, observe)?))
            }
        })
    }

    /// The scores anew, by a reference that resolves the errors of all of them if there is time for that; what has been
    /// read stays as it is.
    pub(super) fn sharpened(
        &mut self,
        scores: &[&Score],
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Vec<Score> {
        let by = |reference: &Reference| -> Vec<Score> {
            scores.iter().map(|score| Score::new(reference, score.found.clone())).collect()
        };
        if let Self::Traced(traced) = self {
            traced.sharpen(&mut |reference| share_resolved(&by(reference)), observe);
        }
        by(self.reference())
    }

    pub(super) fn reference(&self) -> &Reference {
        match self {
            Self::Traced(traced) => &traced.reference,
            Self::Loaded(reference) => reference,
        }
    }

    pub(super) fn into_reference(self) -> Reference {
        match self {
            Self::Traced(traced) => traced.reference,
            Self::Loaded(reference) => reference,
        }
    }
}

/// How much of the paths has been followed that are needed for a reference to resolve the errors of all runs: 1 once
/// chance makes the smallest of them wrong by less than half of what is a tie.
///
/// With the variance of the reference taken off, a root mean square error e is wrong by chance, one standard deviation,
/// by floor² / 4 e; and the square of the floor falls as one over the number of paths.
fn share_resolved(scores: &[Score]) -> f64 {
    let share = |errors: &ErrorStatistics| {
        let bearable = 2.0 * (TIE - 1.0) * errors.rmse.powi(2);
        let square = errors.floor.powi(2);
        if square <= bearable { 1.0 } else { bearable / square }
    };
    let shares = scores.iter().flat_map(|score| Band::ALL.map(|band| share(score.of(band))));
    shares.fold(1.0, f64::min)
}
