//! How the light that a patch shoots arrives on the elements.
//!
//! A hemicube over the patch's centre tells what sees it and how much of each; the amounts are exact form factors,
//! taken from the receiving element to the whole shooting polygon, so that neighbours are right at any distance.

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use crate::form_factor::contour::point_to_polygon;
use crate::form_factor::hemicube::{Hemicube, Sight};
use crate::mesh::{ElementId, Mesh, PatchId};
use crate::surface::Surfaces;
use crate::surface::polygon::centroid;

/// Receivers nearer than this many of their own and the shooter's sizes are taken in parts.
const NEAR: f64 = 2.5;

/// Receivers smaller than this share of the shooter's size are not taken in parts.
const FINE: f64 = 0.3;

/// Where the light of one patch goes.
#[derive(Clone, Debug, Default)]
pub(super) struct Row {
    /// Elements and the form factors towards them, times the shooter's area, m².
    pub(super) entries: Vec<(ElementId, f64)>,
    /// Share of the light that meets nothing.
    pub(super) escaped: f64,
    /// Share of the light that meets the black backs of surfaces.
    pub(super) on_backs: f64,
}

/// The row of one patch.
pub(super) fn row(
    mesh: &Mesh,
    surfaces: &Surfaces,
    hemicube: &mut Hemicube<'_>,
    shooter: PatchId,
) -> Row {
    let patch = &mesh[shooter];
    let eye = patch.corners.iter().sum::<DVec3>() / patch.corners.len() as f64;
    let sights = hemicube.look(&mesh.patches, (eye, patch.normal), turn(shooter.index()));
    let mut row = Row { escaped: hemicube.escaping(), ..Row::default() };
    for sight in sights {
        if sight.front {
            receive(mesh, surfaces, hemicube, (shooter, sight), &mut row.entries);
        } else {
            row.on_backs += sight.delta;
        }
    }
    row
}

/// Angle by which the `index`-th hemicube is turned, radians: no two alike, so that their cells' errors do not add up.
pub(super) fn turn(index: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (index as f64 * GOLDEN).fract() * std::f64::consts::FRAC_PI_2
}

/// Adds what a patch in sight receives, on elements fine enough for their distance.
fn receive(
    mesh: &Mesh,
    surfaces: &Surfaces,
    hemicube: &mut Hemicube<'_>,
    (shooter, sight): (PatchId, Sight),
    entries: &mut Vec<(ElementId, f64)>,
) {
    let patch = &mesh[shooter];
    let from = patch.corners.iter().sum::<DVec3>() / patch.corners.len() as f64;
    let size = patch.area.sqrt();
    let plane = &surfaces.list[mesh[sight.patch].surface as usize].plane;
    let mut open: SmallVec<[ElementId; 32]> = SmallVec::new();
    open.push(mesh[sight.patch].root);
    while let Some(receiver) = open.pop() {
        let element = &mesh[receiver];
        let outline = mesh.outline(receiver);
        let own = element.area.sqrt();
        let near = plane.lift(centroid(&outline)).distance(from) < NEAR * (own + size);
        if near && !element.is_leaf() && own > FINE * size {
            open.extend(element.children.iter().copied());
            continue;
        }
        let visible = if sight.visible < 1.0 {
            let corners: SmallVec<[DVec3; 8]> = outline.iter().map(|&p| plane.lift(p)).collect();
            hemicube.visible_share(sight.patch, &corners, plane.normal)
        } else {
            1.0
        };
        if visible > 0.0 {
            let see = |place: DVec2| {
                let place = plane.lift(place);
                let in_front = (place - patch.corners[0]).dot(patch.normal) > 0.0;
                if in_front { point_to_polygon(place, plane.normal, &patch.corners) } else { 0.0 }
            };
            let places =
                if near { parts(&outline) } else { SmallVec::from_elem(centroid(&outline), 1) };
            let factor = places.iter().map(|&place| see(place)).sum::<f64>() / places.len() as f64;
            entries.push((receiver, factor * visible * element.area));
        }
    }
}

/// Places that stand for equal parts of a polygon: a 3 × 3 grid, or a point for each corner.
fn parts(outline: &[DVec2]) -> SmallVec<[DVec2; 9]> {
    const AT: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
    if let &[a, b, c, d] = outline {
        let at = |s: f64, t: f64| a.lerp(b, s).lerp(d.lerp(c, s), t);
        return AT.iter().flat_map(|&s| AT.iter().map(move |&t| at(s, t))).collect();
    }
    let middle = centroid(outline);
    outline.iter().map(|corner| corner.lerp(middle, 0.5)).collect()
}
