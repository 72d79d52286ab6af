//! The form factors from a point.

use super::delta_sums::CellRow;
use super::method::FormFactorMethod;
use super::sampled::{PatchVisibility, SeenPatch, turn};
use super::views::{HemicubeView, RayView};
use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::{DeltaFactors, Hemicube, HemicubeScene};
use crate::form_factor::rays::{Rays, Sphere};
use crate::mesh::Patch;
use crate::visibility::{Occluders, PatchHierarchy, SurfacePoint};

/// Looks whose mean is taken: what lies along the cells in one does not in the others.
const TURNS: usize = 4;

/// Form factors (0..=1) from a point to what it sees of each patch.
///
/// By contours they are exact; by hemicubes and rays they are for patches of which nothing is hidden,
/// and means of four looks for the others; by sums over a hemicube's cells, those of one look.
pub fn factors_at(
    patches: &[Patch],
    occluders: &Occluders,
    method: FormFactorMethod,
    point: SurfacePoint,
) -> Vec<f64> {
    match method {
        FormFactorMethod::Contour => {
            let factor = |patch: &Patch| exact(patch, occluders, point);
            patches.iter().map(factor).collect()
        }
        FormFactorMethod::Hemicube(resolution) => {
            let (delta, scene) =
                (DeltaFactors::new(resolution as usize), HemicubeScene::new(patches));
            let hemicube = Hemicube::new(&delta, &scene, occluders);
            let mut view = HemicubeView::new(patches, hemicube);
            mean(patches.len(), |turn| view.seen_from(point, turn))
        }
        FormFactorMethod::HemicubeSum(resolution) => {
            let (delta, scene) =
                (DeltaFactors::new(resolution as usize), HemicubeScene::new(patches));
            let mut hemicube = Hemicube::new(&delta, &scene, occluders);
            let mut factors = vec![0.0; patches.len()];
            for (patch, sum) in CellRow::of(hemicube.look(point, turn(0))).fronts {
                factors[patch as usize] = sum;
            }
            factors
        }
        FormFactorMethod::Rays(count) => {
            let (sphere, hierarchy) = (Sphere::new(count as usize), PatchHierarchy::new(patches));
            let mut view = RayView::new(patches, occluders, Rays::new(&sphere, &hierarchy));
            mean(patches.len(), |turn| view.seen_from(point, turn))
        }
    }
}

fn exact(patch: &Patch, occluders: &Occluders, point: SurfacePoint) -> f64 {
    let SurfacePoint { position, normal } = point;
    if patch.polygon().plane.depth(position) <= 0.0 {
        return 0.0;
    }
    let above = point.above().clip(&patch.corners);
    if above.is_empty() {
        return 0.0;
    }
    let pieces = occluders.visible_pieces(position, &above, patch.normal);
    pieces.iter().map(|piece| point_to_polygon(position, normal, piece)).sum()
}

/// The mean of some looks, each turned another way.
fn mean(count: usize, mut look: impl FnMut(f64) -> Vec<SeenPatch>) -> Vec<f64> {
    let mut factors = vec![0.0; count];
    for seen in (0..TURNS).flat_map(|k| look(turn(k))) {
        factors[seen.patch as usize] += seen.factor / TURNS as f64;
    }
    factors
}
