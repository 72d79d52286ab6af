//! The sphere of rays: what a point sees, by one ray through each of many equal cells of its hemisphere.
//!
//! A form factor is the area that a patch covers on the unit disc once projected on the hemisphere
//! and from there straight down (Nusselt's analogue). So the disc is cut in cells of equal area, each
//! with the same delta form factor, and a ray runs through the middle of each. Nothing is
//! clipped or projected, and small patches cost nothing until a ray meets them: the way to look at
//! more patches than there are rays.
//!
//! Root mean squared errors over 300 triangles, against the contour integral, by how the disc is cut:
//!
//! | rays | spiral | concentric squares | rings | at random |
//! |---|---|---|---|---|
//! | 4 096 | 5.6e-4 | 7.6e-4 | 6.8e-4 | 3.0e-3 |
//! | 65 536 | 6.8e-5 | 8.7e-5 | 8.0e-5 | 7.5e-4 |
//!
//! A million rays give the patches of an empty room to 4e-6, the cells of a hemicube of 256 to 8e-5.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use super::hemicube::axes;
use crate::mesh::{Patch, PatchId};
use crate::visibility::packet::{NOTHING, Packet, RAYS};
use crate::visibility::{PatchHierarchy, SurfacePoint};

/// Packets cast in one go: few enough to stay near the processor.
const BATCH: usize = 64;

/// Directions into cells of equal delta form factor.
#[derive(Clone, Debug)]
pub struct Sphere {
    /// x, y and z of the directions about the normal +z, neighbours together.
    packets: Vec<[[f32; RAYS]; 3]>,
}

/// A sphere of rays, reused from point to point.
#[derive(Clone, Debug)]
pub struct Rays<'a> {
    sphere: &'a Sphere,
    hierarchy: &'a PatchHierarchy,
    batch: Vec<Packet>,
    /// By patch: the rays that met it.
    counts: Vec<u32>,
    met: Vec<u32>,
    escaping: usize,
}

/// A patch that rays met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledPatch {
    /// The patch.
    pub patch: PatchId,
    /// Share of the rays that met it: the form factor from the point to what it sees of the patch.
    pub delta: f64,
    /// True if its front is seen; its back is black.
    pub front: bool,
}

impl Sphere {
    /// At least `count` rays, up to a whole number of packets.
    ///
    /// The k-th of n cells is around the point at radius √((k + ½) / n) and angle k (3 - √5) π of the
    /// disc, the sunflower's spiral ([Vogel 1979]; [Marques et al. 2013] sample light with it).
    ///
    /// [Vogel 1979]: https://doi.org/10.1016/0025-5564(79)90080-4
    /// [Marques et al. 2013]: https://doi.org/10.1111/cgf.12190
    pub fn new(count: usize) -> Self {
        let count = count.max(1).next_multiple_of(RAYS);
        let turn = PI * (3.0 - 5.0_f64.sqrt());
        let mut directions: Vec<(u32, [f32; 3])> = (0..count)
            .map(|k| {
                let share = (k as f64 + 0.5) / count as f64;
                let (sine, cosine) = (k as f64 * turn).sin_cos();
                let (x, y) = (share.sqrt() * cosine, share.sqrt() * sine);
                (curve(x, y), [x as f32, y as f32, (1.0 - share).sqrt() as f32])
            })
            .collect();
        directions.sort_by_key(|&(place, _)| place);
        let packet = |rays: &[(u32, [f32; 3])]| {
            std::array::from_fn(|axis| std::array::from_fn(|ray| rays[ray].1[axis]))
        };
        Self { packets: directions.chunks_exact(RAYS).map(packet).collect() }
    }

    /// Number of rays.
    pub fn rays(&self) -> usize {
        self.packets.len() * RAYS
    }

    /// Delta form factor of each cell.
    pub fn delta(&self) -> f64 {
        1.0 / self.rays() as f64
    }

    /// The directions of all rays, unit vectors about the normal +z.
    pub fn directions(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.packets.iter().flat_map(|[x, y, z]| {
            (0..RAYS).map(|ray| DVec3::new(x[ray].into(), y[ray].into(), z[ray].into()))
        })
    }
}

impl<'a> Rays<'a> {
    /// Rays along the directions of `sphere`, through the patches of `hierarchy`.
    pub fn new(sphere: &'a Sphere, hierarchy: &'a PatchHierarchy) -> Self {
        let (batch, counts, met) = (Vec::new(), Vec::new(), Vec::new());
        Self { sphere, hierarchy, batch, counts, met, escaping: 0 }
    }

    /// Looks at `patches`, those of the hierarchy, from `point` along its normal, turned about it by `turn`
    /// radians.
    ///
    /// What is seen comes in the patches' order.
    pub fn look(&mut self, patches: &[Patch], point: SurfacePoint, turn: f64) -> Vec<SampledPatch> {
        let (eye, axes) = (point.position, axes(point.normal, turn));
        self.counts.resize(patches.len(), 0);
        self.escaping = 0;
        for packets in self.sphere.packets.chunks(BATCH) {
            self.batch.clear();
            self.batch.extend(packets.iter().map(|directions| turned(&axes, directions)));
            self.hierarchy.cast(eye, &mut self.batch);
            for patch in self.batch.iter().flat_map(|packet| packet.patch) {
                if patch == NOTHING {
                    self.escaping += 1;
                    continue;
                }
                let count = &mut self.counts[patch as usize];
                if *count == 0 {
                    self.met.push(patch);
                }
                *count += 1;
            }
        }
        self.met.sort_unstable();
        let (counts, delta) = (&mut self.counts, self.sphere.delta());
        let sampled = |index: u32| {
            let patch = &patches[index as usize];
            let count = std::mem::take(&mut counts[index as usize]);
            let front = (eye - patch.corners[0]).dot(patch.normal) > 0.0;
            SampledPatch { patch: PatchId(index), delta: f64::from(count) * delta, front }
        };
        self.met.drain(..).map(sampled).collect()
    }

    /// Delta form factor of each ray.
    pub fn delta(&self) -> f64 {
        self.sphere.delta()
    }

    /// Share of the last look's rays that met nothing.
    pub fn escaping(&self) -> f64 {
        self.escaping as f64 * self.sphere.delta()
    }
}

/// A packet in space from directions about axes that are rows.
fn turned(axes: &DMat3, [x, y, z]: &[[f32; RAYS]; 3]) -> Packet {
    let [to_x, to_y, to_z] = axes.to_cols_array_2d().map(|column| column.map(|c| c as f32));
    let turned = |[a, b, c]: [f32; 3]| std::array::from_fn(|k| a * x[k] + b * y[k] + c * z[k]);
    Packet::new([turned(to_x), turned(to_y), turned(to_z)])
}

/// Place of a point of the disc along a curve that keeps neighbours together (Morton's).
fn curve(x: f64, y: f64) -> u32 {
    let spread = |place: f64| {
        let place = ((place + 1.0) * 32767.5) as u32;
        (0..16).fold(0, |bits, k| bits | (place >> k & 1) << (2 * k))
    };
    spread(x) | spread(y) << 1
}
