//! The patches of a mesh, laid out for hemicubes: their corners coordinate by coordinate, in blocks.

use glam::DVec3;
use smallvec::SmallVec;

use super::clip::{LocalCorners, LocalPolygon};
use super::frame::Frame;
use super::resolution::MANY;
use crate::mesh::Patch;
use crate::visibility::{PatchHierarchy, hair};

/// Patches that are turned into a hemicube's frame at once: enough to fill registers, few enough for the
/// nearest cache.
const BLOCK: usize = 32;

/// What hemicubes look at; made once for all of them.
#[derive(Clone, Debug)]
pub struct HemicubeScene {
    /// By coordinate: the corners, m, patch after patch.
    corners: [Vec<f64>; 3],
    patches: Vec<ScenePatch>,
    blocks: Vec<Block>,
    /// For rays, where patches are many.
    hierarchy: Option<PatchHierarchy>,
    hair: f64,
}

/// A patch.
#[derive(Clone, Debug)]
struct ScenePatch {
    /// First of its corners.
    first: u32,
    normal: DVec3,
    two_sided: bool,
}

/// Patches that follow each other, and a sphere around them.
#[derive(Clone, Debug)]
struct Block {
    patches: std::ops::Range<usize>,
    centre: DVec3,
    radius: f64,
}

impl HemicubeScene {
    /// The patches of a mesh, in their order.
    pub fn new(patches: &[Patch]) -> Self {
        let mut scene = Self {
            corners: [Vec::new(), Vec::new(), Vec::new()],
            patches: Vec::with_capacity(patches.len() + 1),
            blocks: Vec::with_capacity(patches.len().div_ceil(BLOCK)),
            hierarchy: (patches.len() > MANY).then(|| PatchHierarchy::new(patches)),
            hair: hair(patches),
        };
        for patch in patches {
            let first = scene.corners[0].len() as u32;
            scene.patches.push(ScenePatch {
                first,
                normal: patch.normal,
                two_sided: patch.two_sided,
            });
            for corner in &patch.corners {
                for (list, value) in scene.corners.iter_mut().zip(corner.to_array()) {
                    list.push(value);
                }
            }
        }
        for (number, block) in patches.chunks(BLOCK).enumerate() {
            let corners = || block.iter().flat_map(|patch| patch.corners.iter().copied());
            let centre = corners().sum::<DVec3>() / corners().count().max(1) as f64;
            let radius = corners().map(|corner| corner.distance(centre)).fold(0.0, f64::max);
            let first = number * BLOCK;
            scene.blocks.push(Block { patches: first..first + block.len(), centre, radius });
        }
        scene
    }

    /// What rays look for patches in, if these are so many that a hemicube's cells may be fewer.
    pub(super) fn hierarchy(&self) -> Option<&PatchHierarchy> {
        self.hierarchy.as_ref()
    }

    /// An eye not higher than that over the plane of a patch is in it, m.
    #[inline(always)]
    pub(super) fn hair(&self) -> f64 {
        self.hair
    }

    /// Corners of a patch, m.
    pub(super) fn outline(&self, patch: usize) -> SmallVec<[DVec3; 8]> {
        self.corners_of(patch).map(|index| self.corner(index)).collect()
    }

    /// Number of patches.
    pub fn len(&self) -> usize {
        self.patches.len()
    }

    /// True if there are no patches.
    pub fn is_empty(&self) -> bool {
        self.patches.is_empty()
    }

    /// Unit normal of a patch.
    pub(super) fn normal(&self, patch: usize) -> DVec3 {
        self.patches[patch].normal
    }

    /// True if the back of a patch is the front of another.
    pub(super) fn two_sided(&self, patch: usize) -> bool {
        self.patches[patch].two_sided
    }

    /// Height of an eye above the plane of a patch, m.
    #[inline(always)]
    pub(super) fn height(&self, patch: usize, eye: DVec3) -> f64 {
        let ScenePatch { first, normal, .. } = self.patches[patch];
        (eye - self.corner(first as usize)).dot(normal)
    }

    /// Calls `visit` with the patches that are not wholly below the horizon, in the hemicube's
    /// frame.
    #[inline(always)]
    pub(super) fn for_each_above(
        &self,
        frame: &Frame,
        local: &mut LocalCorners,
        mut visit: impl FnMut(usize, LocalPolygon<'_>),
    ) {
        let (eye, up) = (frame.eye, frame.normal());
        for block in &self.blocks {
            if (block.centre - eye).dot(up) < -block.radius {
                continue;
            }
            let first = self.patches[block.patches.start].first as usize;
            let end = self.corners_of(block.patches.end - 1).end;
            local.place(self.corners.each_ref().map(|list| &list[first..end]), frame);
            for patch in block.patches.clone() {
                let corners = self.corners_of(patch);
                visit(patch, local.polygon(corners.start - first..corners.end - first));
            }
        }
    }

    #[inline(always)]
    fn corners_of(&self, patch: usize) -> std::ops::Range<usize> {
        let next = self.patches.get(patch + 1);
        let end = next.map_or(self.corners[0].len(), |next| next.first as usize);
        self.patches[patch].first as usize..end
    }

    #[inline(always)]
    fn corner(&self, index: usize) -> DVec3 {
        DVec3::from(self.corners.each_ref().map(|list| list[index]))
    }
}
