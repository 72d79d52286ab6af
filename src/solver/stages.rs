//! Light on its way: what a solution looks like before reflected light has all been exchanged.

use super::direct_pass::World;
use super::{Exchange, Observer, Solution, Stop, Work};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::settings::Settings;

/// The solution after each of these numbers of shots of reflected light, the light still unshot
/// estimated as ambient; those that the whole exchange does not reach are left out.
pub(super) fn stages(
    world: World<'_>,
    settings: &Settings,
    (mesh, shots): (&Mesh, &[usize]),
    observer: &mut Observer<'_>,
) -> Result<Vec<Solution>> {
    let emitters = mesh.patches.iter().filter(|patch| patch.exitance.max_element() > 0.0).count();
    let mut stages = Vec::new();
    // They are soon made anew, and not steps on the way to the solution.
    let checkpoint = std::mem::take(observer.checkpoint);
    for shots in shots {
        let most = emitters.saturating_add(*shots);
        if settings.max_shots.is_some_and(|limit| limit <= most) {
            continue;
        }
        let settings = Settings { max_shots: Some(most), ..settings.clone() };
        let exchange = Exchange::new(world, &settings, mesh, observer)?;
        if exchange.stop == Stop::ShotLimit {
            let mut mesh = mesh.clone();
            exchange.spread(&mut mesh);
            let work = Work::new(world.light.lamps(), exchange.factors);
            stages.push(exchange.solution(mesh, 0, work));
        }
    }
    *observer.checkpoint = checkpoint;
    Ok(stages)
}
