//! What of one polygon points on another see, past what stands between.

use glam::DVec3;

use super::cubature::{at, quadrilaterals};
use crate::form_factor::contour::point_to_polygon_above;
use crate::geometry::PlanarPolygon;
use crate::visibility::Between;

/// Distance of eyes from the border of what they are on, in tolerances: occluders within two of them
/// count as in one plane with an eye.
const MARGIN: f64 = 4.0;

/// Form factors, or exchanges, of the visible part and of all.
pub(super) type VisibleOfAll = [f64; 2];

/// One polygon as seen from points on another.
#[derive(Clone, Copy)]
pub(super) struct PairView<'a> {
    pub(super) from: PlanarPolygon<'a>,
    pub(super) to: PlanarPolygon<'a>,
    pub(super) between: &'a Between,
}

impl PairView<'_> {
    /// Form factors from a place of a quadrilateral times its area per area of the unit square there, m².
    pub(super) fn look(&self, quadrilateral: &[DVec3; 4], place: [f64; 2]) -> VisibleOfAll {
        let [s, t] = inside(quadrilateral, place, MARGIN * self.between.epsilon());
        let (eye, area) = at(quadrilateral, s, t);
        let factor =
            |polygon: &[DVec3]| point_to_polygon_above(eye, self.from.plane.normal, polygon);
        let all = factor(self.to.corners);
        let pieces = self.between.visible_part(eye, self.to);
        let visible: f64 = pieces.iter().map(|piece| factor(piece)).sum();
        [area * visible.min(all), area * all]
    }

    /// Share of the exchange that nothing hides, by Gauss's two by two points.
    pub(super) fn visible_share(&self) -> f64 {
        const NODES: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
        let points = || NODES.into_iter().flat_map(|s| NODES.map(|t| [s, t]));
        let looks = quadrilaterals(self.from.corners)
            .flat_map(|quadrilateral| points().map(move |place| self.look(&quadrilateral, place)));
        share(looks.fold([0.0; 2], add))
    }
}

/// A place on the border of a quadrilateral moved inside, by `margin`, m, or more, where there is
/// room: what touches a place has no side there.
fn inside([a, b, c, d]: &[DVec3; 4], place: [f64; 2], margin: f64) -> [f64; 2] {
    const LEAST: f64 = 0.002;
    const MOST: f64 = 0.4;
    let [s, t] = place.map(|x| x.clamp(LEAST, 1.0 - LEAST));
    let (along_s, along_t) = ((b - a).lerp(c - d, t), (d - a).lerp(c - b, s));
    let area = along_s.cross(along_t).length().max(f64::MIN_POSITIVE);
    let clear = |x: f64, across: DVec3| {
        let inset = (margin * across.length() / area).clamp(LEAST, MOST);
        x.clamp(inset, 1.0 - inset)
    };
    [clear(s, along_t), clear(t, along_s)]
}

pub(super) fn add([visible, all]: VisibleOfAll, other: VisibleOfAll) -> VisibleOfAll {
    [visible + other[0], all + other[1]]
}

/// The visible share of all.
pub(super) fn share([visible, all]: VisibleOfAll) -> f64 {
    if all > 0.0 { visible / all } else { 0.0 }
}
