//! The form factors from a point.

use glam::DVec3;

use super::Method;
use super::sampled::{Look, Seen, turn};
use super::views::{Cells, Sphere};
use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::{DeltaFactors, Targets};
use crate::form_factor::rays;
use crate::mesh::Patch;
use crate::visibility::{HalfSpace, Occluders, PatchHierarchy};

/// Looks whose mean is taken: what lies along the cells in one does not in the others.
const TURNS: usize = 4;

/// Form factors (0..=1) from a point on a surface with unit `normal` to what it sees of each patch.
///
/// By contours they are exact; by hemicubes and rays they are for patches of which nothing is hidden,
/// and means of four looks for the others.
pub fn factors_at(
    patches: &[Patch],
    occluders: &Occluders,
    method: Method,
    (point, normal): (DVec3, DVec3),
) -> Vec<f64> {
    match method {
        Method::Contour => {
            let factor = |patch: &Patch| exact(patch, occluders, (point, normal));
            patches.iter().map(factor).collect()
        }
        Method::Hemicube(resolution) => {
            let (delta, targets) = (DeltaFactors::new(resolution as usize), Targets::new(patches));
            let mut look = Cells::new(patches, occluders, (&delta, &targets));
            mean(patches.len(), |turn| look.look(point, normal, turn))
        }
        Method::Rays(count) => {
            let (sphere, hierarchy) =
                (rays::Sphere::new(count as usize), PatchHierarchy::new(patches));
            let mut look = Sphere::new(patches, occluders, (&sphere, &hierarchy));
            mean(patches.len(), |turn| look.look(point, normal, turn))
        }
    }
}

fn exact(patch: &Patch, occluders: &Occluders, (point, normal): (DVec3, DVec3)) -> f64 {
    if HalfSpace::new(patch.corners[0], patch.normal).depth(point) <= 0.0 {
        return 0.0;
    }
    let above = HalfSpace::new(point, normal).clip(&patch.corners);
    if above.is_empty() {
        return 0.0;
    }
    let pieces = occluders.visible_pieces(point, &above, patch.normal);
    pieces.iter().map(|piece| point_to_polygon(point, normal, piece)).sum()
}

/// The mean of some looks, each turned another way.
fn mean(count: usize, mut look: impl FnMut(f64) -> Vec<Seen>) -> Vec<f64> {
    let mut factors = vec![0.0; count];
    for seen in (0..TURNS).flat_map(|k| look(turn(k))) {
        factors[seen.patch as usize] += seen.factor / TURNS as f64;
    }
    factors
}
