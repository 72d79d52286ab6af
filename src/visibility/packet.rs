//! Rays in packets: neighbouring rays from one eye walk through the hierarchy together.
//!
//! Loops over the rays of a packet are written in registers' widths and compiled for several processors; which runs is
//! found out when it runs, and changes no bit. With packets of sixteen rays, a room with 29 000 polygons has its
//! hemicubes filled in two thirds of the time that packets of eight took, left to the compiler to vectorize; `cargo bench
//! --bench bvh` compares packets with single rays. Beyond a patch to a ray, neighbours share little of their way, and
//! memory sets the pace.

use std::array::from_fn;

use glam::{DVec3, Vec3A};
use obvhs::bvh2::node::Bvh2Node;
use pulp::{Arch, Simd, WithSimd};
use smallvec::SmallVec;

use super::patches::{EDGE, PatchHierarchy, ProjectedQuad};

/// Rays in a packet.
pub const RAYS: usize = 16;

/// No patch: the ray leaves the scene. As bits of a floating point number, this and all numbers of patches are in order.
pub const NOTHING: u32 = 0x7f00_0000;

/// One number for each ray.
type Lanes = [f32; RAYS];

/// Rays from one eye, best of all into nearly the same direction, and what they meet.
#[derive(Clone, Copy, Debug)]
pub struct Packet {
    /// x, y and z of the directions; of lengths between 1 and 2.
    pub directions: [Lanes; 3],
    /// Reciprocal of the distance at which a patch is met, over the direction's length, 1/m; 0 if none is.
    pub nearness: Lanes,
    /// The patch met first, as an index, or [`NOTHING`].
    pub patch: [u32; RAYS],
}

impl Packet {
    /// Rays that have yet to meet something.
    pub fn new(directions: [[f32; RAYS]; 3]) -> Self {
        Self { directions, nearness: [0.0; RAYS], patch: [NOTHING; RAYS] }
    }
}

impl PatchHierarchy {
    /// Finds for each ray from `eye` the patch it meets first, as [`PatchHierarchy::first`] does but for
    /// the rounding of 32 bits.
    pub fn cast(&self, eye: DVec3, packets: &mut [Packet]) {
        if !self.quads.is_empty() {
            Arch::new().dispatch(Cast { scene: self, eye, packets });
        }
    }
}

struct Cast<'a> {
    scene: &'a PatchHierarchy,
    eye: DVec3,
    packets: &'a mut [Packet],
}

/// What the walk of one packet needs at every node.
struct Walk {
    origin: Vec3A,
    /// Reciprocals of the directions' components.
    inverse: [Lanes; 3],
    /// Parameters at which the rays meet their nearest patch so far.
    ends: Lanes,
}

impl WithSimd for Cast<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { scene, eye, packets } = self;
        for packet in packets {
            walk(simd, scene, eye, packet);
        }
    }
}

/// Visits the nodes that a ray of the packet enters, near ones first.
#[inline(always)]
fn walk<S: Simd>(simd: S, scene: &PatchHierarchy, eye: DVec3, packet: &mut Packet) {
    let origin = (eye - scene.centre).as_vec3a();
    let inverse = from_fn(|axis| from_fn(|ray| inverse(packet.directions[axis][ray])));
    let mut walk = Walk { origin, inverse, ends: [f32::INFINITY; RAYS] };
    let mut last = f32::INFINITY;
    let mut stack: SmallVec<[(u32, f32); 64]> = SmallVec::new();
    let nodes = &scene.bvh.nodes[..];
    let (mut index, mut entry) = (0, walk.entry(simd, &nodes[0]));
    loop {
        // Another node may have ended the rays since.
        if entry < last {
            let node = &nodes[index as usize];
            let first = node.first_index;
            if !node.is_leaf() {
                let children = &nodes[first as usize..][..2];
                let entries = [walk.entry(simd, &children[0]), walk.entry(simd, &children[1])];
                let swap = entries[1] < entries[0];
                let (near, far) = if swap { (first + 1, first) } else { (first, first + 1) };
                let [enter_near, enter_far] = if swap { [entries[1], entries[0]] } else { entries };
                if enter_far < f32::INFINITY {
                    stack.push((far, enter_far));
                }
                (index, entry) = (near, enter_near);
                continue;
            }
            for quad in &scene.quads[first as usize..(first + node.prim_count) as usize] {
                if let Some(quad) = quad.seen(eye, scene.hair) {
                    meet(simd, &quad, packet);
                }
            }
            last = walk.end(simd, &packet.nearness);
        }
        let Some(next) = stack.pop() else { return };
        (index, entry) = next;
    }
}

impl Walk {
    /// Where the first of the rays enters a node, infinite if none does before its end.
    #[inline(always)]
    fn entry<S: Simd>(&self, simd: S, node: &Bvh2Node) -> f32 {
        let bounds = node.aabb();
        let low = splat(simd, (bounds.min - self.origin).to_array());
        let high = splat(simd, (bounds.max - self.origin).to_array());
        let inverse = self.inverse.each_ref().map(
            #[inline(always)]
            |lanes| S::as_simd_f32s(lanes).0,
        );
        let never = simd.splat_f32s(f32::INFINITY);
        let mut entry = never;
        for (k, &end) in S::as_simd_f32s(&self.ends).0.iter().enumerate() {
            let (mut from, mut to) = (simd.splat_f32s(0.0), end);
            for axis in 0..3 {
                let at = [low, high].map(
                    #[inline(always)]
                    |side| simd.mul_f32s(side[axis], inverse[axis][k]),
                );
                from = simd.max_f32s(from, simd.min_f32s(at[0], at[1]));
                to = simd.min_f32s(to, simd.max_f32s(at[0], at[1]));
            }
            let enters = simd.less_than_or_equal_f32s(from, to);
            entry = simd.min_f32s(entry, simd.select_f32s(enters, from, never));
        }
        simd.reduce_min_f32s(entry)
    }

    /// Ends the rays where they meet something; returns where the last of them ends.
    #[inline(always)]
    fn end<S: Simd>(&mut self, simd: S, nearness: &Lanes) -> f32 {
        let mut last = simd.splat_f32s(0.0);
        let one = simd.splat_f32s(1.0);
        let ends = S::as_mut_simd_f32s(&mut self.ends).0.iter_mut();
        for (end, &nearness) in ends.zip(S::as_simd_f32s(nearness).0) {
            *end = simd.div_f32s(one, nearness);
            last = simd.max_f32s(last, *end);
        }
        simd.reduce_max_f32s(last)
    }
}

/// Tests a quad, as the eye sees it, against all rays of a packet.
#[inline(always)]
fn meet<S: Simd>(simd: S, quad: &ProjectedQuad, packet: &mut Packet) {
    let sides: [[f32; 4]; 4] = from_fn(
        #[inline(always)]
        |k| {
            let [x, y, z] = quad.edges.map(
                #[inline(always)]
                |component| component[k] as f32,
            );
            [x, y, z, (x.abs() + y.abs() + z.abs()) * EDGE as f32]
        },
    );
    let plane = splat(simd, quad.plane.as_vec3().to_array());
    let (zero, number) = (simd.splat_f32s(0.0), simd.splat_f32s(f32::from_bits(quad.patch)));
    let [x, y, z] = packet.directions.each_ref().map(
        #[inline(always)]
        |lanes| S::as_simd_f32s(lanes).0,
    );
    let nearest = S::as_mut_simd_f32s(&mut packet.nearness).0.iter_mut();
    let patches = S::as_mut_simd_u32s(&mut packet.patch).0.iter_mut();
    for (k, (best, patch)) in nearest.zip(patches).enumerate() {
        let direction = [x[k], y[k], z[k]];
        let mut inside = simd.splat_f32s(f32::INFINITY);
        for [x, y, z, slack] in sides {
            let depth = dot(simd, direction, splat(simd, [x, y, z]));
            inside = simd.min_f32s(inside, simd.add_f32s(depth, simd.splat_f32s(slack)));
        }
        let inside = simd.greater_than_or_equal_f32s(inside, zero);
        let nearness = dot(simd, direction, plane);
        let before = simd.transmute_f32s_u32s(*patch);
        let same = simd.and_m32s(
            simd.greater_than_or_equal_f32s(nearness, *best),
            simd.and_m32s(simd.less_than_f32s(number, before), simd.greater_than_f32s(*best, zero)),
        );
        let nearer = simd.or_m32s(simd.greater_than_f32s(nearness, *best), same);
        let met = simd.and_m32s(inside, nearer);
        *best = simd.select_f32s(met, nearness, *best);
        *patch = simd.transmute_u32s_f32s(simd.select_f32s(met, number, before));
    }
}

#[inline(always)]
fn splat<S: Simd>(simd: S, values: [f32; 3]) -> [S::f32s; 3] {
    values.map(
        #[inline(always)]
        |value| simd.splat_f32s(value),
    )
}

#[inline(always)]
fn dot<S: Simd>(simd: S, a: [S::f32s; 3], b: [S::f32s; 3]) -> S::f32s {
    let sum = simd.add_f32s(simd.mul_f32s(a[0], b[0]), simd.mul_f32s(a[1], b[1]));
    simd.add_f32s(sum, simd.mul_f32s(a[2], b[2]))
}

/// Reciprocal of a direction's component, finite even where it vanishes.
#[inline(always)]
fn inverse(component: f32) -> f32 {
    1.0 / if component.abs() < f32::EPSILON { f32::EPSILON } else { component }
}
