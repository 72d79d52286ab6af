//! The hemicube: which patches a point sees, and how much of each.
//!
//! Based on: Cohen and Greenberg 1985, *The hemi-cube*. Patches are projected on the five faces
//! with a z-buffer; a cell keeps the nearest. The *form factor* of what is seen is then not the sum
//! of its cells' delta factors but the exact one of the polygon times the share of its cells that
//! it kept: the cells only measure visibility, which takes most of the aliasing away.

mod delta;
mod packets;
mod raster;

use glam::{DMat3, DVec3};

use super::contour::point_to_polygon;
use crate::mesh::{Patch, PatchId};
use crate::visibility::{Occluders, PatchHierarchy};

pub use delta::DeltaFactors;
use raster::{Footprint, Raster, first_centre};

/// Patches in one plane with the eye are seen edge-on, that is, not at all; heights below this, m,
/// are rounding.
const HAIR: f64 = 1e-11;

/// Factor on the nearness of backs: of two faces back to back in one place, the front one must win
/// over rounding.
const RECESS: f32 = 1.0 - 1e-5;

/// No patch at all: light escapes through the cell.
const NOTHING: u32 = u32::MAX;

/// A hemicube, reused from point to point.
#[derive(Clone, Debug)]
pub struct Hemicube<'a> {
    delta: &'a DeltaFactors,
    occluders: &'a Occluders,
    /// Where patches outnumber cells, rays find what the cells see.
    hierarchy: Option<&'a PatchHierarchy>,
    raster: Raster,
    eye: DVec3,
    frame: DMat3,
    /// Reciprocal depth of what each cell sees.
    depth: Vec<f32>,
    /// Patch that each cell sees.
    item: Vec<u32>,
    /// By patch: sums of delta factors it covers, and of those it kept.
    sums: Vec<[f32; 2]>,
    drawn: Vec<u32>,
}

/// A patch that a point sees, or might see if its view were clearer.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    /// The patch.
    pub patch: PatchId,
    /// Share of its projection that nothing hides, 0..=1; where rays fill the cells, what `delta` is
    /// of its form factor, which for a patch smaller than a cell may be more than 1.
    pub visible: f64,
    /// Sum of the delta factors of the cells it kept.
    pub delta: f64,
    /// True if its front is seen; its back is black.
    pub front: bool,
}

impl<'a> Hemicube<'a> {
    /// A hemicube with cells as `delta` has them; what falls between their centres is looked for by a ray.
    pub fn new(delta: &'a DeltaFactors, occluders: &'a Occluders) -> Self {
        let cells = delta.cells().len();
        Self {
            delta,
            occluders,
            hierarchy: None,
            raster: Raster::new(delta.resolution()),
            eye: DVec3::ZERO,
            frame: DMat3::IDENTITY,
            depth: vec![0.0; cells],
            item: vec![NOTHING; cells],
            sums: Vec::new(),
            drawn: Vec::new(),
        }
    }

    /// The same hemicube, to look by rays where patches outnumber cells. Most of them then cover no
    /// cell's centre, and those that do stand for the others: their form factors are the plain sums
    /// of delta factors.
    #[must_use]
    pub fn with_rays(self, hierarchy: &'a PatchHierarchy) -> Self {
        Self { hierarchy: Some(hierarchy), ..self }
    }

    /// Looks at `patches` from `eye` along the unit `normal`, turned about it by `turn` radians.
    ///
    /// The sights come in the patches' order.
    pub fn look(
        &mut self,
        patches: &[Patch],
        (eye, normal): (DVec3, DVec3),
        turn: f64,
    ) -> Vec<Sight> {
        self.eye = eye;
        self.frame = frame(normal, turn);
        self.sums.clear();
        self.sums.resize(patches.len(), [0.0; 2]);
        self.drawn.clear();
        if let Some(hierarchy) = self.hierarchy.filter(|_| patches.len() > self.item.len()) {
            return self.look_by_rays(hierarchy, patches);
        }
        self.depth.fill(0.0);
        self.item.fill(NOTHING);
        for (index, patch) in patches.iter().enumerate() {
            self.draw(index as u32, patch);
        }
        for (&item, &cell) in self.item.iter().zip(self.delta.cells()) {
            if item != NOTHING {
                self.sums[item as usize][1] += cell;
            }
        }
        self.drawn.iter().filter_map(|&index| self.sight(index, &patches[index as usize])).collect()
    }

    fn look_by_rays(&mut self, hierarchy: &PatchHierarchy, patches: &[Patch]) -> Vec<Sight> {
        let cells = (&mut self.item[..], &mut self.depth[..]);
        packets::fill(hierarchy, (self.eye, &self.frame), self.delta.resolution(), cells);
        for (&item, &cell) in self.item.iter().zip(self.delta.cells()) {
            if item == NOTHING {
                continue;
            }
            let kept = &mut self.sums[item as usize][1];
            if *kept == 0.0 {
                self.drawn.push(item);
            }
            *kept += cell;
        }
        self.drawn.sort_unstable();
        let sight = |&index: &u32| {
            let patch = &patches[index as usize];
            let delta = f64::from(self.sums[index as usize][1]);
            let front = (self.eye - patch.corners[0]).dot(patch.normal) > 0.0;
            let whole = point_to_polygon(self.eye, self.frame.row(2), &patch.corners);
            let visible = if whole > 0.0 { delta / whole } else { 1.0 };
            Sight { patch: PatchId(index), visible, delta, front }
        };
        self.drawn.iter().map(sight).collect()
    }

    /// Share, 0..=1, of a convex part of a patch that nothing hides.
    pub fn visible_share(&mut self, patch: PatchId, corners: &[DVec3], normal: DVec3) -> f64 {
        let (mut covered, mut kept) = (0.0, 0.0);
        let resolution = self.delta.resolution();
        let mut raster = std::mem::replace(&mut self.raster, Raster::new(0));
        raster.project((self.eye, &self.frame), (corners, normal), |footprint| {
            for (row, columns) in footprint.rows(resolution) {
                covered += self.delta.sum(row, columns.clone());
                let cells = row * resolution + columns.start..row * resolution + columns.end;
                for (&item, &cell) in
                    self.item[cells.clone()].iter().zip(&self.delta.cells()[cells])
                {
                    kept += if item == patch.0 { cell } else { 0.0 };
                }
            }
        });
        self.raster = raster;
        if covered > 0.0 {
            return f64::from(kept / covered).min(1.0);
        }
        self.glimpse(corners)
    }

    /// Sum of the delta factors of cells that see something not deeper than `depth`, m.
    pub fn share_within(&self, depth: f64) -> f64 {
        let nearness = (1.0 / depth) as f32;
        let cells = self.depth.iter().zip(self.delta.cells());
        cells.filter(|(cell, _)| **cell > nearness).map(|(_, &cell)| f64::from(cell)).sum()
    }

    /// Sum of the delta factors of cells that see nothing.
    pub fn escaping(&self) -> f64 {
        let cells = self.item.iter().zip(self.delta.cells());
        cells.filter(|(item, _)| **item == NOTHING).map(|(_, &cell)| f64::from(cell)).sum()
    }

    fn draw(&mut self, index: u32, patch: &Patch) {
        let height = (self.eye - patch.corners[0]).dot(patch.normal);
        // The back of a double-sided polygon has a patch of its own.
        if height.abs() < HAIR || (patch.two_sided && height < 0.0) {
            return;
        }
        let recess = if height < 0.0 { RECESS } else { 1.0 };
        let resolution = self.delta.resolution();
        let (depths, items, delta) = (&mut self.depth, &mut self.item, self.delta);
        let mut covered = 0.0;
        let mut drawn = false;
        let shape = (patch.corners.as_slice(), patch.normal);
        self.raster.project((self.eye, &self.frame), shape, |footprint| {
            drawn = true;
            for (row, columns) in footprint.rows(resolution) {
                covered += delta.sum(row, columns.clone());
                let [first, step] = footprint.nearness(row, columns.start).map(|n| n * recess);
                let cells = row * resolution + columns.start..row * resolution + columns.end;
                let cells = depths[cells.clone()].iter_mut().zip(&mut items[cells]);
                for (column, (depth, item)) in cells.enumerate() {
                    let nearness = first + step * column as f32;
                    let nearer = nearness > *depth;
                    *depth = if nearer { nearness } else { *depth };
                    *item = if nearer { index } else { *item };
                }
            }
        });
        if drawn {
            self.drawn.push(index);
            self.sums[index as usize][0] = covered;
        }
    }

    fn sight(&self, index: u32, patch: &Patch) -> Option<Sight> {
        let [covered, kept] = self.sums[index as usize].map(f64::from);
        let front = (self.eye - patch.corners[0]).dot(patch.normal) > 0.0;
        let visible = match covered {
            0.0 if front => self.glimpse(&patch.corners),
            0.0 => 0.0,
            covered => (kept / covered).min(1.0),
        };
        (visible > 0.0).then_some(Sight { patch: PatchId(index), visible, delta: kept, front })
    }

    /// Whether the middle of a polygon that covers no cell's centre is seen, 0 or 1.
    fn glimpse(&self, corners: &[DVec3]) -> f64 {
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let above = (middle - self.eye).dot(self.frame.row(2)) > 0.0;
        f64::from(u8::from(above && !self.occluders.blocks(self.eye, middle)))
    }
}

impl Footprint<'_> {
    /// The rows covered, counted over all faces, and their columns.
    fn rows(
        &self,
        resolution: usize,
    ) -> impl Iterator<Item = (usize, std::ops::Range<usize>)> + '_ {
        self.spans.iter().enumerate().filter_map(move |(row, &[from, to])| {
            let columns = first_centre(from, resolution)..first_centre(to, resolution);
            (!columns.is_empty()).then_some((self.first_row + row, columns))
        })
    }

    /// Reciprocal depth at a cell's centre, and what it grows by from column to column.
    fn nearness(&self, row: usize, column: usize) -> [f32; 2] {
        let [origin, by_column, by_row] = self.depth;
        [origin + by_column * column as f32 + by_row * (row - self.first_row) as f32, by_column]
    }
}

/// Rotation into the axes of a hemicube: its rows are the hemicube's x, y and z.
pub(super) fn frame(normal: DVec3, turn: f64) -> DMat3 {
    let (sine, cosine) = turn.sin_cos();
    let (x, y) = normal.any_orthonormal_pair();
    DMat3::from_cols(x * cosine + y * sine, y * cosine - x * sine, normal).transpose()
}
