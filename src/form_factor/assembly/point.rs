//! The form factors from a point.

use glam::DVec3;

use super::Method;
use super::sampled::{Look, Seen};
use super::views::{Cells, Sphere};
use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::{DeltaFactors, Targets};
use crate::form_factor::rays;
use crate::mesh::Patch;
use crate::visibility::{HalfSpace, Occluders, PatchHierarchy};

/// Form factors (0..=1) from a point on a surface with unit `normal` to what it sees of each patch.
///
/// By contours they are exact; by hemicubes and rays they are for patches of which nothing is hidden.
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
            let seen = look.look(point, normal, 0.0);
            dense(patches.len(), &seen)
        }
        Method::Rays(count) => {
            let (sphere, hierarchy) =
                (rays::Sphere::new(count as usize), PatchHierarchy::new(patches));
            let mut look = Sphere::new(patches, occluders, (&sphere, &hierarchy));
            dense(patches.len(), &look.look(point, normal, 0.0))
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
    let pieces = occluders.visible_pieces(point, &above, patch.normal, usize::MAX);
    pieces.iter().flatten().map(|piece| point_to_polygon(point, normal, piece)).sum()
}

fn dense(count: usize, seen: &[Seen]) -> Vec<f64> {
    let mut factors = vec![0.0; count];
    seen.iter().for_each(|seen| factors[seen.patch as usize] = seen.factor);
    factors
}
