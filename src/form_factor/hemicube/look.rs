//! A look through a hemicube: patches are drawn, or rays are cast, and what the cells see is summed up by patch.

use glam::{DMat3, DVec3};
use pulp::{Arch, Simd, WithSimd};

use super::clip::LocalCorners;
use super::coverage::Coverage;
use super::delta::DeltaFactors;
use super::frame::Frame;
use super::item_buffer::{ItemBuffer, NOTHING, Span};
use super::raster::Raster;
use super::ray_fill;
use super::resolution::is_by_rays;
use super::scene::HemicubeScene;
use crate::form_factor::contour::point_to_polygon;
use crate::visibility::{Occluders, PatchHierarchy, RECESS, SurfacePoint};

/// A hemicube, reused from point to point; nothing is allocated for a look.
#[derive(Clone, Debug)]
pub struct Hemicube<'a> {
    pub(super) scene: &'a HemicubeScene,
    pub(super) occluders: &'a Occluders,
    pub(super) arch: Arch,
    raster: Raster,
    corners: LocalCorners,
    pub(super) frame: Frame,
    pub(super) buffer: ItemBuffer<'a>,
    /// Of the cells of all faces, row by row.
    pub(super) spans: Vec<Span>,
    /// Set if this look is by rays.
    pub(super) rays: Option<&'a PatchHierarchy>,
    /// By patch; of those not drawn in this look, nothing.
    pub(super) coverage: Vec<Coverage>,
    pub(super) drawn: Vec<u32>,
}

impl<'a> Hemicube<'a> {
    /// A hemicube with cells as `delta` has them; what falls between their centres is looked for by a ray.
    pub fn new(
        delta: &'a DeltaFactors,
        scene: &'a HemicubeScene,
        occluders: &'a Occluders,
    ) -> Self {
        Self {
            scene,
            occluders,
            arch: Arch::new(),
            raster: Raster::default(),
            corners: LocalCorners::default(),
            frame: Frame { eye: DVec3::ZERO, axes: DMat3::IDENTITY },
            buffer: ItemBuffer::new(delta),
            spans: Vec::new(),
            rays: None,
            coverage: vec![Coverage::NONE; scene.len()],
            drawn: Vec::new(),
        }
    }

    /// The same, with no instructions but those that every processor has.
    pub fn portable(mut self) -> Self {
        self.arch = Arch::Scalar;
        self
    }

    /// Where it looks from.
    pub fn eye(&self) -> SurfacePoint {
        SurfacePoint::new(self.frame.eye, self.frame.normal())
    }

    /// A direction of its frame, whose z is the normal, in the scene.
    pub fn to_scene(&self, direction: DVec3) -> DVec3 {
        self.frame.axes.transpose() * direction
    }

    /// Looks from `eye` along its normal, turned about it by `turn` radians.
    pub fn look(&mut self, eye: SurfacePoint, turn: f64) -> &Self {
        self.frame = Frame::new(eye, turn);
        let by_rays = is_by_rays(self.scene.len(), self.buffer.resolution());
        self.rays = self.scene.hierarchy().filter(|_| by_rays);
        self.arch.dispatch(LookPass(self));
        if self.rays.is_some() {
            self.weigh_rays();
        }
        self
    }

    /// Takes what rays found for drawn. Most patches then cover no cell's centre, and those that do stand
    /// for the others: their form factors are the plain sums of delta factors.
    fn weigh_rays(&mut self) {
        let Self { spans, drawn, coverage, scene, frame, .. } = self;
        drawn.extend(spans.iter().map(|span| span.patch).filter(|&patch| patch != NOTHING));
        drawn.sort_unstable();
        drawn.dedup();
        for &patch in &*drawn {
            let corners = scene.outline(patch as usize);
            let whole = point_to_polygon(frame.eye, frame.normal(), &corners);
            coverage[patch as usize].covered = whole as f32;
        }
    }

    #[inline(always)]
    fn fill<S: Simd>(&mut self, simd: S) {
        self.buffer.clear();
        for patch in self.drawn.drain(..) {
            self.coverage[patch as usize] = Coverage::NONE;
        }
        if let Some(hierarchy) = self.rays {
            // What is seen is known from the spans alone.
            return ray_fill::fill(hierarchy, &self.frame, &mut self.buffer);
        }
        let Self { scene, frame, .. } = *self;
        let Self { raster, corners, buffer, coverage, drawn, .. } = self;
        scene.for_each_above(
            &frame,
            corners,
            #[inline(always)]
            |patch, polygon| {
                let height = scene.height(patch, frame.eye);
                // The back of a double-sided polygon has a patch of its own.
                if height.abs() < scene.hair() || (scene.two_sided(patch) && height < 0.0) {
                    return;
                }
                let recess = if height < 0.0 { RECESS as f32 } else { 1.0 };
                let plane = frame.plane(scene.normal(patch), height);
                let mut covered = None;
                raster.project(
                    buffer.resolution(),
                    &polygon,
                    plane,
                    #[inline(always)]
                    |footprint| {
                        *covered.get_or_insert(0.0) +=
                            buffer.draw(simd, footprint, patch as u32, recess);
                    },
                );
                if let Some(covered) = covered {
                    drawn.push(patch as u32);
                    coverage[patch] = Coverage { covered, kept: 0.0, last: NOTHING };
                }
            },
        );
    }

    #[inline(always)]
    fn sum_up(&mut self) {
        let Self { buffer, spans, coverage, .. } = self;
        let delta = buffer.delta();
        spans.clear();
        buffer.for_each_span(
            #[inline(always)]
            |mut span| {
                if let Some(coverage) = coverage.get_mut(span.patch as usize) {
                    let row = delta.sums(span.face.into(), span.row.into());
                    let [from, to] = span.columns.map(usize::from);
                    coverage.kept += row[to] - row[from];
                    span.before = std::mem::replace(&mut coverage.last, spans.len() as u32);
                }
                spans.push(span);
            },
        );
    }
}

/// The work of a look, to be compiled for several processors.
struct LookPass<'h, 'a>(&'h mut Hemicube<'a>);

impl WithSimd for LookPass<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.0.fill(simd);
        self.0.sum_up();
    }
}
