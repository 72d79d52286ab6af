//! The hemicube: which patches a point sees, and how much of each.
//!
//! Based on: Cohen and Greenberg 1985, *The hemi-cube*. Patches are projected on the five faces
//! with a z-buffer; a cell keeps the nearest. The *form factor* of what is seen is then not the sum
//! of its cells' delta factors but the exact one of the polygon times the share of its cells that
//! it kept: the cells only measure visibility, which takes most of the aliasing away.
//!
//! Only whole patches are drawn. What element a cell sees follows from where on the patch its ray
//! ends, so that a look costs patches and cells, never elements. The loops are written in registers'
//! widths and compiled twice; which of both runs is found out when it runs, and changes no bit.

mod cells;
mod chart;
mod clip;
mod delta;
mod element_map;
mod elements;
mod packets;
mod probe;
mod raster;
mod resolution;
mod targets;

use glam::{DMat3, DVec3, Vec3};
use pulp::{Arch, Simd, WithSimd};

use super::contour::point_to_polygon;
use crate::mesh::PatchId;
use crate::visibility::{Occluders, PatchHierarchy};

pub use delta::DeltaFactors;
pub use element_map::ElementMap;
pub use elements::ElementSums;
pub(crate) use resolution::enough_cells;
pub use targets::Targets;

use cells::{Cells, NOTHING, Run};
use clip::Corners;
use raster::Raster;
use resolution::is_by_rays;

/// Factor on the nearness of backs: of two faces back to back in one place, the front one must win
/// over rounding.
const RECESS: f32 = 1.0 - 1e-5;

/// A hemicube, reused from point to point; nothing is allocated for a look.
#[derive(Clone, Debug)]
pub struct Hemicube<'a> {
    delta: &'a DeltaFactors,
    targets: &'a Targets,
    occluders: &'a Occluders,
    arch: Arch,
    raster: Raster,
    corners: Corners,
    eye: DVec3,
    frame: DMat3,
    cells: Cells,
    runs: Vec<Run>,
    /// Set if this look is by rays.
    rays: Option<&'a PatchHierarchy>,
    /// By patch; of those not drawn in this look, nothing.
    prints: Vec<Print>,
    drawn: Vec<u32>,
}

/// What a patch that was drawn has come to.
#[derive(Clone, Copy, Debug)]
struct Print {
    /// Sum of the delta factors of the cells it covers.
    covered: f32,
    /// Sum of those of the cells it kept.
    kept: f32,
    /// The last of its runs, or [`NOTHING`].
    last: u32,
}

impl Print {
    const NONE: Self = Self { covered: 0.0, kept: 0.0, last: NOTHING };
}

/// A patch that a point sees, or might see if its view were clearer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// The patch.
    pub patch: PatchId,
    /// Share of its projection that nothing hides, 0..=1; where patches outnumber cells, what `delta`
    /// is of its form factor, which for a patch smaller than a cell may be more than 1.
    pub visible: f64,
    /// Sum of the delta factors of the cells it kept.
    pub delta: f64,
    /// True if its front is seen; its back is black.
    pub front: bool,
}

/// The cells of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cover {
    /// The patch.
    pub patch: PatchId,
    /// Sum of the delta factors of the cells that it covers; of a look by rays, its form factor.
    pub covered: f64,
    /// Sum of those of the cells that it kept.
    pub kept: f64,
    /// True if its front is seen.
    pub front: bool,
}

impl<'a> Hemicube<'a> {
    /// A hemicube with cells as `delta` has them; what falls between their centres is looked for by a ray.
    pub fn new(delta: &'a DeltaFactors, targets: &'a Targets, occluders: &'a Occluders) -> Self {
        Self {
            delta,
            targets,
            occluders,
            arch: Arch::new(),
            raster: Raster::default(),
            corners: Corners::default(),
            eye: DVec3::ZERO,
            frame: DMat3::IDENTITY,
            cells: Cells::new(delta.resolution()),
            runs: Vec::new(),
            rays: None,
            prints: vec![Print::NONE; targets.len()],
            drawn: Vec::new(),
        }
    }

    /// The same, with no instructions but those that every processor has.
    pub fn portable(mut self) -> Self {
        self.arch = Arch::Scalar;
        self
    }

    /// Looks from `eye` along the unit `normal`, turned about it by `turn` radians.
    pub fn look(&mut self, (eye, normal): (DVec3, DVec3), turn: f64) -> &Self {
        self.eye = eye;
        self.frame = frame(normal, turn);
        let by_rays = is_by_rays(self.targets.len(), self.cells.resolution());
        self.rays = self.targets.hierarchy().filter(|_| by_rays);
        self.arch.dispatch(Look(self));
        if self.rays.is_some() {
            self.weigh_rays();
        }
        self
    }

    /// Takes what rays found for drawn. Most patches then cover no cell's centre, and those that do stand
    /// for the others: their form factors are the plain sums of delta factors.
    fn weigh_rays(&mut self) {
        let Self { runs, drawn, prints, targets, .. } = self;
        drawn.extend(runs.iter().map(|run| run.patch).filter(|&patch| patch != NOTHING));
        drawn.sort_unstable();
        drawn.dedup();
        for &patch in &*drawn {
            let corners = targets.outline(patch as usize);
            let whole = point_to_polygon(self.eye, self.frame.row(2), &corners);
            prints[patch as usize].covered = whole as f32;
        }
    }

    /// The patches seen, in their order.
    pub fn sights(&self) -> impl Iterator<Item = Sight> + '_ {
        self.sights_of(|_| true)
    }

    /// Those of the patches seen that are `wanted`, in their order.
    pub fn sights_of(&self, wanted: impl Fn(PatchId) -> bool) -> impl Iterator<Item = Sight> {
        let wanted = self.drawn.iter().filter(move |&&index| wanted(PatchId(index)));
        wanted.filter_map(|&index| self.sight(index))
    }

    /// What is known of a patch by cells alone: none are looked for that cover no cell's centre.
    pub fn prints_of(&self, wanted: impl Fn(PatchId) -> bool) -> impl Iterator<Item = Cover> {
        let wanted = self.drawn.iter().filter(move |&&index| wanted(PatchId(index)));
        wanted.map(|&index| {
            let Print { covered, kept, .. } = self.prints[index as usize];
            let front = self.targets.height(index as usize, self.eye) > 0.0;
            Cover { patch: PatchId(index), covered: covered.into(), kept: kept.into(), front }
        })
    }

    /// True if this look was by rays: patches that they did not meet are unknown.
    pub fn is_by_rays(&self) -> bool {
        self.rays.is_some()
    }

    /// The patch that each cell sees: the top face's rows, then those of the four half faces.
    pub fn items(&self) -> impl Iterator<Item = Option<PatchId>> + '_ {
        let items = self.cells.rows().flat_map(|(.., items)| items);
        items.map(|&item| (item != NOTHING).then_some(PatchId(item)))
    }

    /// Share, 0..=1, of a convex part of a patch that nothing hides.
    pub fn visible_share(&self, patch: PatchId, corners: &[DVec3]) -> f64 {
        self.arch.dispatch(Share { hemicube: self, patch, corners })
    }

    /// Sum of the delta factors of cells that see something not deeper than `depth`, m.
    pub fn share_within(&self, depth: f64) -> f64 {
        let nearness = (1.0 / depth) as f32;
        let row = |(face, row, _): (usize, usize, &[u32])| {
            let cells = self.cells.depths(face, row).iter().zip(self.delta.row(face, row));
            cells
                .filter(|(cell, _)| **cell > nearness)
                .map(|(_, &cell)| f64::from(cell))
                .sum::<f64>()
        };
        self.cells.rows().map(row).sum()
    }

    /// Sum of the delta factors of cells that see nothing.
    pub fn escaping(&self) -> f64 {
        let runs = self.runs.iter().filter(|run| run.patch == NOTHING);
        runs.map(|&run| f64::from(self.sum(run))).sum()
    }

    #[inline(always)]
    fn fill<S: Simd>(&mut self, simd: S) {
        self.cells.clear();
        for patch in self.drawn.drain(..) {
            self.prints[patch as usize] = Print::NONE;
        }
        if let Some(hierarchy) = self.rays {
            // What is seen is known from the runs alone.
            return packets::fill(hierarchy, (self.eye, &self.frame), &mut self.cells);
        }
        let Self { targets, delta, eye, frame, .. } = *self;
        let Self { raster, corners, cells, prints, drawn, .. } = self;
        targets.for_each_above(
            (eye, &frame),
            corners,
            #[inline(always)]
            |patch, corners, range| {
                let height = targets.height(patch, eye);
                // The back of a double-sided polygon has a patch of its own.
                if height.abs() < targets.hair() || (targets.two_sided(patch) && height < 0.0) {
                    return;
                }
                let ink = (patch as u32, if height < 0.0 { RECESS } else { 1.0 }, delta);
                let shape = (corners, range, plane(&frame, targets.normal(patch), height));
                let mut covered = None;
                raster.project(
                    delta.resolution(),
                    shape,
                    #[inline(always)]
                    |footprint| {
                        *covered.get_or_insert(0.0) += cells.draw(simd, footprint, ink);
                    },
                );
                if let Some(covered) = covered {
                    drawn.push(patch as u32);
                    prints[patch] = Print { covered, kept: 0.0, last: NOTHING };
                }
            },
        );
    }

    #[inline(always)]
    fn sum_up(&mut self) {
        let Self { cells, runs, prints, delta, .. } = self;
        runs.clear();
        cells.for_each_run(
            #[inline(always)]
            |mut run| {
                if let Some(print) = prints.get_mut(run.patch as usize) {
                    let row = delta.sums(run.face.into(), run.row.into());
                    let [from, to] = run.columns.map(usize::from);
                    print.kept += row[to] - row[from];
                    run.before = std::mem::replace(&mut print.last, runs.len() as u32);
                }
                runs.push(run);
            },
        );
    }

    #[inline(always)]
    fn sum(&self, run: Run) -> f32 {
        let row = self.delta.sums(run.face.into(), run.row.into());
        row[usize::from(run.columns[1])] - row[usize::from(run.columns[0])]
    }

    fn sight(&self, index: u32) -> Option<Sight> {
        let Print { covered, kept, .. } = self.prints[index as usize];
        let [covered, kept] = [covered, kept].map(f64::from);
        let front = self.targets.height(index as usize, self.eye) > 0.0;
        let visible = match covered {
            0.0 if front => self.glimpse(&self.targets.outline(index as usize)),
            0.0 => 0.0,
            covered if self.rays.is_some() => kept / covered,
            covered => (kept / covered).min(1.0),
        };
        (visible > 0.0).then_some(Sight { patch: PatchId(index), visible, delta: kept, front })
    }

    #[inline(always)]
    fn share<S: Simd>(&self, simd: S, patch: PatchId, polygon: &[DVec3]) -> Option<f64> {
        let mut corners = Corners::default();
        let point = |axis: usize| polygon.iter().map(move |corner| corner[axis]);
        let points: [smallvec::SmallVec<[f64; 16]>; 3] =
            std::array::from_fn(|axis| point(axis).collect());
        corners.place(points.each_ref().map(|list| list.as_slice()), self.eye, &self.frame);
        let (mut covered, mut kept) = (0.0, 0.0);
        let shape = (&corners, 0..polygon.len(), Vec3::ZERO);
        Raster::default().project(
            self.delta.resolution(),
            shape,
            #[inline(always)]
            |footprint| {
                let face = footprint.face;
                footprint.for_each_row(
                    simd,
                    #[inline(always)]
                    |row, from, to| {
                        let sums = self.delta.sums(face, row);
                        covered += sums[to] - sums[from];
                        let items = &self.cells.items(face, row)[from..to];
                        for (item, cell) in items.iter().zip(&self.delta.row(face, row)[from..to]) {
                            kept += if *item == patch.0 { *cell } else { 0.0 };
                        }
                    },
                );
            },
        );
        (covered > 0.0).then(|| f64::from(kept / covered).min(1.0))
    }
}

/// The work of a look, to be compiled for several processors.
struct Look<'h, 'a>(&'h mut Hemicube<'a>);

impl WithSimd for Look<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.0.fill(simd);
        self.0.sum_up();
    }
}

struct Share<'h, 'a> {
    hemicube: &'h Hemicube<'a>,
    patch: PatchId,
    corners: &'h [DVec3],
}

impl WithSimd for Share<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        self.hemicube
            .share(simd, self.patch, self.corners)
            .unwrap_or_else(|| self.hemicube.glimpse(self.corners))
    }
}

/// Angle by which the `index`-th hemicube is turned, radians: no two alike, so that their cells'
/// errors do not add up.
pub(crate) fn turn(index: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (index * GOLDEN).fract() * std::f64::consts::FRAC_PI_2
}

/// Rotation into the axes of a hemicube: its rows are the hemicube's x, y and z.
pub(super) fn frame(normal: DVec3, turn: f64) -> DMat3 {
    let (sine, cosine) = turn.sin_cos();
    let (x, y) = normal.any_orthonormal_pair();
    DMat3::from_cols(x * cosine + y * sine, y * cosine - x * sine, normal).transpose()
}

/// The vector n with n · p = 1 on a plane above which the eye, the origin, is at this height, m.
#[inline(always)]
fn plane(frame: &DMat3, normal: DVec3, height: f64) -> Vec3 {
    (*frame * normal / -height).as_vec3()
}
