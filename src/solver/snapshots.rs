//! Light on its way: what a solution looks like before reflected light has all been exchanged.

use super::context::Context;
use super::interreflection::Interreflection;
use super::lit_mesh::{LitMesh, VertexLighting};
use super::observer::Observer;
use super::solution::Solution;
use super::stop::Stop;
use crate::error::Result;
use crate::light::VertexLight;
use crate::mesh::Mesh;
use crate::settings::Settings;

/// The solution after each of these numbers of shots of reflected light, the light still unshot
/// estimated as ambient; those that the whole exchange does not reach are left out.
pub(super) fn snapshots(
    context: Context<'_>,
    settings: &Settings,
    LitMesh { mesh, light, work }: &LitMesh<'_>,
    shots: &[usize],
    observer: &mut Observer<'_>,
) -> Result<Vec<Solution>> {
    let emitters =
        context.optics.exitance.iter().filter(|exitance| exitance.max_element() > 0.0).count();
    let mut snapshots = Vec::new();
    // They are soon made anew, and not steps on the way to the solution.
    let checkpoint = std::mem::take(observer.checkpoint);
    for shots in shots {
        let most = emitters.saturating_add(*shots);
        if settings.max_shots.is_some_and(|limit| limit <= most) {
            continue;
        }
        let settings = Settings { max_shots: Some(most), ..settings.clone() };
        let interreflection = Interreflection::new(context, &settings, mesh, light, observer)?;
        if interreflection.stop == Stop::ShotLimit {
            let (mesh, mut light) = (Mesh::clone(mesh), VertexLight::clone(light));
            interreflection.spread(&mesh, &mut light);
            let lighting = VertexLighting { light, work: **work };
            snapshots.push(interreflection.solution(mesh, context.optics.clone(), lighting));
        }
    }
    *observer.checkpoint = checkpoint;
    Ok(snapshots)
}
