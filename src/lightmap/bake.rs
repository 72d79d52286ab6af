//! Light from the triangles of a solution into the texels of an atlas.
//!
//! Light is linear on a triangle, so its mean over a texel is found exactly: the triangle is cut along
//! the borders of texels, and each piece counts by its area. A texel that surfaces cover in part has
//! the mean of that part.
//!
//! What lies under a box has no light at all. A texel half under it has that of the other half, and
//! [`PADDING`] texels more hold it, too: else a dark line would run around all that stands on a floor.

use std::f64::consts::PI;

use glam::{DVec2, UVec2, Vec3};
use rayon::prelude::*;
use smallvec::SmallVec;

use super::atlas::Atlas;
use super::chart::{Chart, PADDING};
use super::dilate::{Texel, dilate};
use crate::colour::Rgb;
use crate::geometry::polygon::{area, centroid};
use crate::reconstruct::TriMesh;
use crate::solver::Solution;
use crate::surface::Surfaces;

/// An atlas filled with light.
#[derive(Clone, Debug)]
pub struct Lightmap<'a> {
    /// The surfaces it is the light of.
    pub surfaces: &'a Surfaces,
    /// Where they are in it.
    pub atlas: &'a Atlas,
    /// Radiance of a white diffuse surface, E/π, W/(m² sr), row by row; zero outside of charts.
    pub texels: Vec<Vec3>,
}

/// Share of a texel below which it counts as not covered: what rounding leaves of pieces.
const NOTHING: f64 = 1e-9;

/// Share of the brightest light below which there is none: what rounding sends under a box.
const DARKNESS: f64 = 1e-9;

/// A piece of a triangle: seven corners at most, after cuts along four lines.
type ClippedTriangle = SmallVec<[DVec2; 8]>;

/// Fills an atlas of `surfaces` with the light of their `solution`, reconstructed as `mesh`.
pub fn bake<'a>(
    surfaces: &'a Surfaces,
    atlas: &'a Atlas,
    solution: &Solution,
    mesh: &TriMesh,
) -> Lightmap<'a> {
    let mut triangles = vec![Vec::new(); atlas.charts.len()];
    for (triangle, &leaf) in mesh.triangles.iter().zip(&mesh.leaves) {
        let surface = solution.mesh.surface_of(leaf);
        triangles[atlas.chart_of[surface.index()] as usize].push(*triangle);
    }
    let light: Vec<Rgb> = mesh
        .irradiance
        .iter()
        .map(|irradiance| (irradiance.direct + irradiance.indirect).max(Rgb::ZERO) / PI)
        .collect();
    let darkness = DARKNESS * light.iter().map(|light| light.max_element()).fold(0.0, f64::max);
    let fill = |(chart, triangles): (&Chart, &Vec<[u32; 3]>)| {
        let mut sums = TexelSums::new(chart.texels, darkness);
        for triangle in triangles {
            let place = |corner: u32| chart.texel(mesh.positions[corner as usize]);
            let corners = triangle.map(|corner| place(corner) - chart.corner.as_dvec2());
            sums.add(corners, triangle.map(|corner| light[corner as usize]));
        }
        filled(sums.means(), chart.texels)
    };
    let blocks: Vec<Vec<Vec3>> = atlas.charts.par_iter().zip(&triangles).map(fill).collect();

    let size = atlas.size as usize;
    let mut texels = vec![Vec3::ZERO; size * size];
    for (chart, block) in atlas.charts.iter().zip(&blocks) {
        let [corner, extent] = [chart.corner, chart.texels].map(|v| v.as_usizevec2());
        for (row, values) in block.chunks_exact(extent.x).enumerate() {
            let start = (corner.y + row) * size + corner.x;
            texels[start..start + extent.x].copy_from_slice(values);
        }
    }
    Lightmap { surfaces, atlas, texels }
}

/// The texels of a chart's rectangle, row by row, each with some light.
fn filled(mut texels: Vec<Texel>, size: UVec2) -> Vec<Vec3> {
    let dark: Vec<usize> =
        (0..texels.len()).filter(|&texel| texels[texel] == Texel::Dark).collect();
    dilate(&mut texels, size, Texel::Dark, PADDING);
    for texel in dark {
        if texels[texel] == Texel::Dark {
            texels[texel] = Texel::Lit(Vec3::ZERO);
        }
    }
    dilate(&mut texels, size, Texel::Outside, u32::MAX);
    texels.into_iter().map(|texel| texel.light().unwrap_or_default()).collect()
}

/// Light over texels, summed.
struct TexelSums {
    texels: UVec2,
    /// Light below which there is none, W/(m² sr).
    darkness: f64,
    /// Light times area, area that has light, and all area, texels.
    sums: Vec<(Rgb, f64, f64)>,
}

impl TexelSums {
    fn new(texels: UVec2, darkness: f64) -> Self {
        let count = (texels.x * texels.y) as usize;
        Self { texels, darkness, sums: vec![(Rgb::ZERO, 0.0, 0.0); count] }
    }

    /// Adds a triangle, given in texels, with light at its corners.
    fn add(&mut self, corners: [DVec2; 3], light: [Rgb; 3]) {
        let field = Field::new(corners, light);
        let mut rest: ClippedTriangle = corners.into_iter().collect();
        while let Some(row) = first(&rest, 1, self.texels.y) {
            let [mut strip, below] = cut(&rest, 1, end(row, self.texels.y));
            while let Some(column) = first(&strip, 0, self.texels.x) {
                let [piece, right] = cut(&strip, 0, end(column, self.texels.x));
                self.add_piece((row * self.texels.x + column) as usize, &piece, &field);
                strip = right;
            }
            rest = below;
        }
    }

    fn add_piece(&mut self, texel: usize, piece: &ClippedTriangle, field: &Field) {
        let covered = area(piece).abs();
        if piece.len() > 2 && covered > 0.0 {
            let (light, lit, all) = &mut self.sums[texel];
            *all += covered;
            if field.range[1].max_element() > self.darkness {
                *light += field.at(centroid(piece)) * covered;
                *lit += covered;
            }
        }
    }

    /// The mean light of each texel, as far as it has any.
    fn means(self) -> Vec<Texel> {
        let mean = |(light, lit, all): (Rgb, f64, f64)| match (lit > NOTHING, all > NOTHING) {
            (true, _) => {
                let brightest = Rgb::splat(f64::from(f32::MAX));
                Texel::Lit((light / lit).min(brightest).as_vec3())
            }
            (false, true) => Texel::Dark,
            (false, false) => Texel::Outside,
        };
        self.sums.into_iter().map(mean).collect()
    }
}

/// Light that is linear on a triangle.
struct Field {
    origin: DVec2,
    light: Rgb,
    /// Change by texel, to the right and down.
    slopes: [Rgb; 2],
    range: [Rgb; 2],
}

impl Field {
    fn new([a, b, c]: [DVec2; 3], [at_a, at_b, at_c]: [Rgb; 3]) -> Self {
        let (along, across) = (b - a, c - a);
        let doubled = along.perp_dot(across);
        let (rise, other) = (at_b - at_a, at_c - at_a);
        // Triangles too thin to tell a slope have the light of a corner.
        let scale = if doubled.abs() > f64::MIN_POSITIVE { 1.0 / doubled } else { 0.0 };
        let slopes = [
            (rise * across.y - other * along.y) * scale,
            (other * along.x - rise * across.x) * scale,
        ];
        let range = [at_a.min(at_b).min(at_c), at_a.max(at_b).max(at_c)];
        Self { origin: a, light: at_a, slopes, range }
    }

    fn at(&self, place: DVec2) -> Rgb {
        let DVec2 { x, y } = place - self.origin;
        let light = self.light + self.slopes[0] * x + self.slopes[1] * y;
        let [least, most] = self.range;
        // In this order, so that what is no number becomes one.
        light.max(least).min(most)
    }
}

/// The row or column, below `count`, in which a piece begins along an axis; `None` once nothing is left.
fn first(piece: &ClippedTriangle, axis: usize, count: u32) -> Option<u32> {
    let least = piece.iter().map(|corner| corner[axis]).fold(f64::INFINITY, f64::min);
    (piece.len() > 2).then(|| (least.max(0.0) as u32).min(count - 1))
}

/// Where a row or a column ends; the last takes whatever is left.
fn end(number: u32, count: u32) -> f64 {
    if number + 1 < count { f64::from(number) + 1.0 } else { f64::INFINITY }
}

/// The parts of a convex piece before and after a line across an axis.
fn cut(piece: &ClippedTriangle, axis: usize, line: f64) -> [ClippedTriangle; 2] {
    let (mut before, mut after) = (ClippedTriangle::new(), ClippedTriangle::new());
    for (k, &corner) in piece.iter().enumerate() {
        let next = piece[(k + 1) % piece.len()];
        let (here, there) = (corner[axis] - line, next[axis] - line);
        if here <= 0.0 {
            before.push(corner);
        }
        if here >= 0.0 {
            after.push(corner);
        }
        if here * there < 0.0 {
            let mut crossing = corner.lerp(next, here / (here - there));
            crossing[axis] = line;
            before.push(crossing);
            after.push(crossing);
        }
    }
    // A single edge on the line is no part.
    [before, after].map(|part| {
        let is_flat = part.iter().all(|corner| corner[axis] == line);
        if is_flat { ClippedTriangle::new() } else { part }
    })
}
