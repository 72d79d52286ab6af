//! The sky: a box of polygons far beyond the scene, and their light in closed form.
//!
//! As polygons, pieces of a sky are cut by what hides them like any emitter, so that the light of a window is exact.

use std::f64::consts::PI;

use glam::DVec3;

use super::emitter::AreaEmitter;
use super::profile::RadianceProfile;
use crate::colour::Rgb;
use crate::form_factor::contour::point_to_polygon_above;
use crate::geometry::{HalfSpace, Polygon};
use crate::scene::{SUN_RADIUS, Sky};
use crate::surface::Surfaces;

/// Half the width of the box, in extents of the scene: the horizon is off by less than 1e-4 radians.
const FAR: f64 = 1e4;

/// The pieces of a sky with this irradiance of an open horizontal place, W/m²: 12 squares, four overhead and
/// two in each direction.
///
/// They end at the height of the scene's top, so that nothing that faces down sees them.
pub(super) fn emitters(surfaces: &Surfaces, sky: Sky, irradiance: Rgb) -> Vec<AreaEmitter> {
    let Some((low, high)) = surfaces.bounds() else { return Vec::new() };
    let (centre, size) = (low.midpoint(high).with_y(high.y), FAR * surfaces.extent);
    let (exitance, profile) = match sky {
        Sky::Uniform => (irradiance, RadianceProfile::UniformSky),
        // E = 7/9 π Lz.
        Sky::Overcast => (irradiance * 9.0 / 7.0, RadianceProfile::OvercastSky),
    };
    let emitter = |corners: [DVec3; 4]| {
        let corners: Polygon = corners.iter().map(|&corner| centre + corner * size).collect();
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        AreaEmitter { front: HalfSpace::new(corners[0], normal), corners, exitance, profile }
    };
    squares().map(emitter).collect()
}

/// A sun that shines along a unit `direction`, with this irradiance of a plane that faces it, W/m²: a square of
/// the disc's solid angle.
pub(super) fn sun(surfaces: &Surfaces, direction: DVec3, irradiance: Rgb) -> Option<AreaEmitter> {
    let (low, high) = surfaces.bounds()?;
    let (middle, distance) = (low.midpoint(high), FAR * surfaces.extent);
    let half = distance * SUN_RADIUS.tan() * PI.sqrt() / 2.0;
    let x = DVec3::Y.cross(direction).try_normalize().unwrap_or(DVec3::X);
    let (u, v) = (x * half, direction.cross(x) * half);
    let centre = middle - direction * distance;
    let corners =
        Polygon::from_slice(&[centre - u - v, centre + u - v, centre + u + v, centre - u + v]);
    let factor = point_to_polygon_above(middle, -direction, &corners);
    let (front, exitance) = (HalfSpace::new(centre, direction), irradiance / factor);
    Some(AreaEmitter { corners, front, exitance, profile: RadianceProfile::Diffuse })
}

/// The squares of a box of height 1 around the origin, without a bottom, facing inward.
fn squares() -> impl Iterator<Item = [DVec3; 4]> {
    [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].into_iter().flat_map(|(x, z)| {
        let (out, along) = (DVec3::new(x, 0.0, z), DVec3::new(-z, 0.0, x));
        let wall = |from: f64| {
            let (a, b) = (out + along * from, out + along * (from + 1.0));
            [a, b, b + DVec3::Y, a + DVec3::Y]
        };
        let top = [DVec3::Y, DVec3::Y + out, DVec3::Y + along + out, DVec3::Y + along];
        [wall(-1.0), wall(0.0), top]
    })
}
