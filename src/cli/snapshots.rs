//! Light on its way: what a solution looks like after some of its shots.

use std::ops::ControlFlow;

use radiosity::page::{Model, Step};
use radiosity::render::Solved;
use radiosity::solver::Stop;
use radiosity::{Result, Settings, Solution, reconstruct, solve};

/// Passes of a solution that stops early, of equal weight in its progress.
const PASSES: f64 = 2.0;

/// The steps after each number of shots, the lamps' counted as one, that the solution has gone beyond;
/// ends early when `observe`, told how much is done, 0..=1, breaks off.
pub(crate) fn steps(
    shots: &[u32],
    solved: &Solved<'_>,
    mut observe: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<Vec<Step>> {
    let mut wanted = shots.to_vec();
    wanted.sort_unstable();
    wanted.dedup();
    // The lamps shoot patch by patch, but always all of them.
    let lamps = patches_of_lamps(solved.solution);
    let count = wanted.len() as f64;
    let mut steps = Vec::new();
    for (number, shots) in wanted.into_iter().enumerate() {
        let max_shots = lamps + shots as usize - 1;
        if max_shots >= solved.solution.shots {
            break;
        }
        let settings = Settings { max_shots: Some(max_shots), ..solved.settings.clone() };
        let solution = solve(solved.surfaces, &settings, |progress| {
            let pass = progress.phase as u8;
            observe((number as f64 + (f64::from(pass) + progress.done) / PASSES) / count)
        })?;
        if solution.stop == Stop::Cancelled {
            break;
        }
        let mesh = reconstruct(solved.surfaces, &solution);
        let label = if shots == 1 { "1 shot".to_owned() } else { format!("{shots} shots") };
        steps.push(Step { label, model: Model::of_solution(&mesh, &solution.mesh) });
    }
    Ok(steps)
}

/// Shots that lamps have fired before reflected light was first sent on.
fn patches_of_lamps(solution: &Solution) -> usize {
    solution.shots - solution.history.last().map_or(0, |step| step.shots)
}
