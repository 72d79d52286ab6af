//! What the patches of a mesh see of the lamps: those that can shine on each, and what stands in between.
//!
//! Found once for a patch, it spares all places on it the search.

use glam::DVec3;
use rayon::prelude::*;

use super::lines::Line;
use super::rims::Rims;
use super::{AreaLamp, Lamps, punctual};
use crate::colour::Rgb;
use crate::mesh::{Direct, Mesh, Patch, PatchId, Vertex};
use crate::scene::area_vector;
use crate::visibility::{Facet, Occluders};

/// More occluders than this are found quicker from each place anew.
const FEW: usize = 32;

/// Of more occluders than this, as of curved things, only the edges on their rims make lines, and only long
/// ones. Of fewer, those that bound nothing cost little, and are found by what they carry.
const MANY: usize = 256;

/// Where occluders are many, edges shorter than this share of the patch's size are those of facets: the shadow
/// of what they stand for has no kinks, and no element is cut along so short a line.
const LEAST_EDGE: f64 = 0.25;

/// Direct light on the patches of a mesh.
#[derive(Debug)]
pub struct PatchLight {
    lamps: Lamps,
    occluders: Occluders,
    /// By patch.
    outlooks: Vec<Outlook>,
    rims: Rims,
}

#[derive(Debug)]
struct Outlook {
    corners: Vec<DVec3>,
    normal: DVec3,
    prospects: Vec<Prospect>,
}

/// A lamp that can shine on a patch.
#[derive(Debug)]
struct Prospect {
    /// Index into [`Lamps::areas`].
    lamp: u32,
    /// The numbers of the occluders of which something stands between; `None` if those between the patch and a
    /// piece of the sky are not few.
    between: Option<Box<[u32]>>,
}

impl PatchLight {
    /// The light of `lamps` on the patches of `mesh`, whatever their elements.
    pub fn new(lamps: Lamps, occluders: Occluders, mesh: &Mesh) -> Self {
        let outlook = |patch: &Patch| Outlook::new(&lamps, &occluders, patch);
        let outlooks = mesh.patches.par_iter().map(outlook).collect();
        let rims = Rims::new(&occluders);
        Self { lamps, occluders, outlooks, rims }
    }

    /// Where it comes from.
    pub fn lamps(&self) -> &Lamps {
        &self.lamps
    }

    /// What stands in its way.
    pub fn occluders(&self) -> &Occluders {
        &self.occluders
    }

    /// What arrives at a place on a patch.
    pub fn at(&self, patch: PatchId, place: DVec3) -> Direct {
        self.by(patch, place, |_| true) + self.points_at(patch, place)
    }

    /// What would arrive at a place on a patch if nothing stood between, W/m².
    pub fn unoccluded(&self, patch: PatchId, place: DVec3) -> Rgb {
        let Outlook { normal, prospects, .. } = &self.outlooks[patch.index()];
        let areas = prospects
            .iter()
            .map(|prospect| self.lamps.areas[prospect.lamp as usize].unoccluded((place, *normal)));
        let points = self.lamps.points.iter();
        let points = points.filter_map(|point| punctual::irradiance(point, place, *normal));
        areas.sum::<Rgb>() + points.map(|(irradiance, _)| irradiance).sum::<Rgb>()
    }

    /// What arrives at vertices, in their order.
    pub fn at_vertices(&self, vertices: &[&Vertex]) -> Vec<Direct> {
        vertices.par_iter().map(|vertex| self.at(vertex.patch, vertex.site)).collect()
    }

    /// What arrives at a place on a patch from some of the polygons, chosen by their numbers.
    pub(crate) fn by(&self, patch: PatchId, place: DVec3, chosen: impl Fn(u32) -> bool) -> Direct {
        let Outlook { normal, prospects, .. } = &self.outlooks[patch.index()];
        let shine = |prospect: &Prospect| {
            let among = prospect.between.as_deref().filter(|between| between.len() <= FEW);
            let lamp = &self.lamps.areas[prospect.lamp as usize];
            lamp.shine((&self.occluders, among), (place, *normal), self.lamps.rows)
        };
        let chosen = prospects.iter().filter(|prospect| chosen(prospect.lamp));
        self.lamps.sum(chosen.filter_map(shine))
    }

    fn points_at(&self, patch: PatchId, place: DVec3) -> Direct {
        self.lamps.points_shine(&self.occluders, place, self.outlooks[patch.index()].normal)
    }

    /// Segments in the plane of a patch on which its irradiance by polygons may have a kink or a bend;
    /// they may reach beyond the patch. The sky makes none: its pieces have no borders that could be seen.
    pub fn lines(&self, patch: PatchId) -> Vec<Line> {
        let Outlook { corners, normal, prospects } = &self.outlooks[patch.index()];
        let receiver = Facet::new(corners, *normal);
        let least = LEAST_EDGE * area_vector(corners).length().sqrt();
        let mut lines = Vec::new();
        for Prospect { lamp: number, between } in prospects {
            let lamp = &self.lamps.areas[*number as usize];
            let between = between.iter().flatten().filter(|_| !lamp.glow.is_sky());
            let crowd = (between.clone().count() > MANY).then_some((&self.rims, least));
            let among = (&self.occluders, crowd);
            lines.extend(lamp.lines((*number, receiver), among, between.copied()));
        }
        lines
    }
}

impl Outlook {
    fn new(lamps: &Lamps, occluders: &Occluders, patch: &Patch) -> Self {
        let receiver = Facet::new(&patch.corners, patch.normal);
        let prospect = |(number, lamp): (usize, &AreaLamp)| {
            let above = lamp.above(receiver)?;
            let source = Facet { corners: &above, plane: lamp.front };
            let between = occluders.numbers_between(source, receiver);
            let between = if lamp.glow.is_sky() {
                let few: Vec<u32> = between.take(FEW + 1).collect();
                (few.len() <= FEW).then(|| few.into_boxed_slice())
            } else {
                Some(between.collect())
            };
            Some(Prospect { lamp: number as u32, between })
        };
        let prospects = lamps.areas.iter().enumerate().filter_map(prospect).collect();
        Self { corners: patch.corners.to_vec(), normal: patch.normal, prospects }
    }
}
