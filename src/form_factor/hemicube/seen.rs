//! What the last look of a hemicube saw: by patch, by cell, and of parts of patches.

use glam::{DVec3, Vec3};
use pulp::{Simd, WithSimd};

use super::clip::LocalCorners;
use super::coverage::{Coverage, PatchCoverage, VisiblePatch};
use super::item_buffer::{NOTHING, Span};
use super::look::Hemicube;
use super::raster::Raster;
use crate::mesh::PatchId;

impl Hemicube<'_> {
    /// The patches seen, in their order.
    pub fn visible_patches(&self) -> impl Iterator<Item = VisiblePatch> + '_ {
        self.visible_patches_of(|_| true)
    }

    /// Those of the patches seen that are `wanted`, in their order.
    pub fn visible_patches_of(
        &self,
        wanted: impl Fn(PatchId) -> bool,
    ) -> impl Iterator<Item = VisiblePatch> {
        let wanted = self.drawn.iter().filter(move |&&index| wanted(PatchId(index)));
        wanted.filter_map(|&index| self.visible_patch(index))
    }

    /// What is known of a patch by cells alone: none are looked for that cover no cell's centre.
    pub fn coverage_of(
        &self,
        wanted: impl Fn(PatchId) -> bool,
    ) -> impl Iterator<Item = PatchCoverage> {
        let wanted = self.drawn.iter().filter(move |&&index| wanted(PatchId(index)));
        wanted.map(|&index| {
            let Coverage { covered, kept, .. } = self.coverage[index as usize];
            let front = self.scene.height(index as usize, self.frame.eye) > 0.0;
            PatchCoverage {
                patch: PatchId(index),
                covered: covered.into(),
                kept: kept.into(),
                front,
            }
        })
    }

    /// True if this look was by rays: patches that they did not meet are unknown.
    pub fn is_by_rays(&self) -> bool {
        self.rays.is_some()
    }

    /// The patch that each cell sees: the top face's rows, then those of the four half faces.
    pub fn items(&self) -> impl Iterator<Item = Option<PatchId>> + '_ {
        let items = self.buffer.rows().flat_map(|(.., items)| items);
        items.map(|&item| (item != NOTHING).then_some(PatchId(item)))
    }

    /// Share, 0..=1, of a patch seen that nothing hides, or of a convex part of it with these corners.
    pub fn visible_share(&self, sight: &VisiblePatch, part: Option<&[DVec3]>) -> f64 {
        match part {
            Some(corners) if sight.visible != 1.0 => {
                self.arch.dispatch(SharePass { hemicube: self, patch: sight.patch, corners })
            }
            _ => sight.visible,
        }
    }

    /// Sum of the delta factors of cells that see something not deeper than `depth`, m.
    pub fn share_within(&self, depth: f64) -> f64 {
        let nearness = (1.0 / depth) as f32;
        let row = |(face, row, _): (usize, usize, &[u32])| {
            let delta = self.buffer.delta().row(face, row);
            let cells = self.buffer.depths(face, row).iter().zip(delta);
            cells
                .filter(|(cell, _)| **cell > nearness)
                .map(|(_, &cell)| f64::from(cell))
                .sum::<f64>()
        };
        self.buffer.rows().map(row).sum()
    }

    /// Sum of the delta factors of cells that see nothing.
    pub fn escaping(&self) -> f64 {
        let spans = self.spans.iter().filter(|span| span.patch == NOTHING);
        spans.map(|&span| f64::from(self.sum(span))).sum()
    }

    #[inline(always)]
    fn sum(&self, span: Span) -> f32 {
        let row = self.buffer.delta().sums(span.face.into(), span.row.into());
        row[usize::from(span.columns[1])] - row[usize::from(span.columns[0])]
    }

    fn visible_patch(&self, index: u32) -> Option<VisiblePatch> {
        let Coverage { covered, kept, .. } = self.coverage[index as usize];
        let [covered, kept] = [covered, kept].map(f64::from);
        let front = self.scene.height(index as usize, self.frame.eye) > 0.0;
        let visible = match covered {
            0.0 if front => self.probe_centre(&self.scene.outline(index as usize)),
            0.0 => 0.0,
            covered if self.rays.is_some() => kept / covered,
            covered => (kept / covered).min(1.0),
        };
        (visible > 0.0).then_some(VisiblePatch {
            patch: PatchId(index),
            visible,
            delta: kept,
            front,
        })
    }

    #[inline(always)]
    fn share<S: Simd>(&self, simd: S, patch: PatchId, polygon: &[DVec3]) -> Option<f64> {
        let mut corners = LocalCorners::default();
        let point = |axis: usize| polygon.iter().map(move |corner| corner[axis]);
        let points: [smallvec::SmallVec<[f64; 16]>; 3] =
            std::array::from_fn(|axis| point(axis).collect());
        corners.place(points.each_ref().map(|list| list.as_slice()), &self.frame);
        let (mut covered, mut kept) = (0.0, 0.0);
        let (delta, polygon) = (self.buffer.delta(), corners.polygon(0..polygon.len()));
        Raster::default().project(
            delta.resolution(),
            &polygon,
            Vec3::ZERO,
            #[inline(always)]
            |footprint| {
                let face = footprint.face;
                footprint.for_each_row(
                    simd,
                    #[inline(always)]
                    |row, from, to| {
                        let sums = delta.sums(face, row);
                        covered += sums[to] - sums[from];
                        let items = &self.buffer.items(face, row)[from..to];
                        for (item, cell) in items.iter().zip(&delta.row(face, row)[from..to]) {
                            kept += if *item == patch.0 { *cell } else { 0.0 };
                        }
                    },
                );
            },
        );
        (covered > 0.0).then(|| f64::from(kept / covered).min(1.0))
    }
}

/// The work of [`Hemicube::visible_share`], to be compiled for several processors.
struct SharePass<'h, 'a> {
    hemicube: &'h Hemicube<'a>,
    patch: PatchId,
    corners: &'h [DVec3],
}

impl WithSimd for SharePass<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        self.hemicube
            .share(simd, self.patch, self.corners)
            .unwrap_or_else(|| self.hemicube.probe_centre(self.corners))
    }
}
