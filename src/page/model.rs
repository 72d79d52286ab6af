//! A lit mesh as a page carries it: few bytes to a triangle, and errors too small to be seen.

use std::collections::BTreeMap;

use glam::DVec3;
use serde::Serialize;

use super::chunks::Chunks;
use super::pictures::PictureSet;
use super::textured::{RunRecord, Textured};
use super::{bulk, quantise};
use crate::colour::Rgb;
use crate::mesh::Mesh;
use crate::reconstruct::TriMesh;
use crate::render::leaves;

/// A lit mesh for a [`viewer`](super::viewer()), quantised.
///
/// Positions are within 1/131 070 of the bounding box, radiosities within 1/512 of their largest
/// channel: 10 bytes a vertex and 6 a triangle, 2 more with levels and reasons; 8 more a vertex, and the
/// pictures themselves, if there are pictures on surfaces.
#[derive(Clone, Debug)]
pub struct Model {
    low: DVec3,
    size: DVec3,
    /// What radiosities are counted in, W/m².
    unit: f64,
    positions: Vec<[u16; 3]>,
    /// By vertex; that of a white picture where there are pictures.
    radiosity: Vec<u32>,
    corners: Vec<[u32; 3]>,
    /// By triangle; empty if not known.
    levels: Vec<u8>,
    /// By triangle, as indices into [`leaves::REASONS`]; empty if not known.
    reasons: Vec<u8>,
    /// By vertex; empty if not known.
    errors: Vec<i16>,
    /// Ends of a good scale of radiosity, W/m².
    pub(super) range: [f64; 2],
    /// Upper end of a good scale of errors.
    pub(super) error_limit: f64,
    /// The pictures on surfaces, if there are any.
    textured: Option<Textured>,
}

impl Model {
    /// A mesh and its light.
    pub fn of_mesh(mesh: &TriMesh) -> Self {
        let low = mesh.positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = mesh.positions.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let (low, size) = if low.is_finite() { (low, high - low) } else { Default::default() };
        let textured = Textured::of_mesh(mesh);
        // What pictures are multiplied by; it is the radiosity where there is none.
        let on_white = textured.as_ref().map(|_| light_on_white(mesh));
        let light = on_white.as_ref().unwrap_or(&mesh.radiosity);
        let peak = light.iter().map(|colour| colour.max_element()).fold(0.0, f64::max);
        let unit = quantise::unit(peak);
        let position = |&point: &DVec3| quantise::position(point, low, size);
        Self {
            low,
            size,
            unit,
            positions: mesh.positions.iter().map(position).collect(),
            radiosity: light.iter().map(|&light| quantise::colour(light, unit)).collect(),
            corners: mesh.triangles.clone(),
            levels: Vec::new(),
            reasons: Vec::new(),
            errors: Vec::new(),
            range: bulk::radiosity_range(mesh),
            error_limit: 0.0,
            textured,
        }
    }

    /// A mesh and its light, and of which level its elements are and why they were made: `solved` is
    /// the mesh of the solution that `mesh` was made of.
    pub fn of_solution(mesh: &TriMesh, solved: &Mesh) -> Self {
        let of_triangles = |by_element: Vec<usize>| -> Vec<u8> {
            let number = |leaf: usize| by_element[leaf].min(u8::MAX.into()) as u8;
            mesh.leaves.iter().map(|leaf| number(leaf.index())).collect()
        };
        Self {
            levels: of_triangles(leaves::level_numbers(solved)),
            reasons: of_triangles(leaves::reason_numbers(solved)),
            ..Self::of_mesh(mesh)
        }
    }

    /// With the signed relative error of every vertex's radiosity, 0.01 for one per cent too bright;
    /// beyond ±400 % they are shown as that. Errors for another number of vertices are left out.
    #[must_use]
    pub fn with_errors(self, errors: &[f64]) -> Self {
        if errors.len() != self.positions.len() {
            return self;
        }
        Self {
            errors: errors.iter().map(|&error| quantise::error(error)).collect(),
            error_limit: bulk::error_limit(errors),
            ..self
        }
    }

    /// Whether there are triangles, levels and reasons, and errors.
    pub(super) fn has_leaves(&self) -> bool {
        !self.levels.is_empty()
    }

    pub(super) fn has_errors(&self) -> bool {
        !self.errors.is_empty()
    }

    /// Deepest level of its elements.
    pub(super) fn deepest(&self) -> u8 {
        self.levels.iter().copied().max().unwrap_or(0)
    }

    /// What the scripts get; the bytes go to `chunks`, the pictures to `gallery`.
    pub(super) fn packed<'a>(
        &'a self,
        chunks: &mut Chunks,
        gallery: &mut PictureSet<'a>,
    ) -> Packed {
        let wide = self.positions.len() > 1 + usize::from(u16::MAX);
        let corners = self.corners.iter().flatten().copied();
        let corners: Vec<u8> = match wide {
            true => corners.flat_map(u32::to_le_bytes).collect(),
            false => corners.flat_map(|corner| (corner as u16).to_le_bytes()).collect(),
        };
        let positions = self.positions.iter().flatten().copied();
        let mut lists = BTreeMap::from([
            ("corners", chunks.add(&corners)),
            ("positions", chunks.add(&positions.flat_map(u16::to_le_bytes).collect::<Vec<_>>())),
        ]);
        let radiosity: Vec<u8> =
            self.radiosity.iter().copied().flat_map(u32::to_le_bytes).collect();
        lists.insert("radiosity", chunks.add(&radiosity));
        let runs = self.textured.iter().flat_map(|textured| {
            let uvs = textured.uvs.iter().flat_map(|uv| uv.to_array()).flat_map(f32::to_le_bytes);
            lists.insert("uvs", chunks.add(&uvs.collect::<Vec<_>>()));
            textured.packed(gallery)
        });
        let runs = runs.collect();
        if self.has_leaves() {
            lists.insert("levels", chunks.add(&self.levels));
            lists.insert("reasons", chunks.add(&self.reasons));
        }
        if self.has_errors() {
            let errors: Vec<u8> = self.errors.iter().copied().flat_map(i16::to_le_bytes).collect();
            lists.insert("errors", chunks.add(&errors));
        }
        Packed {
            low: self.low.to_array(),
            size: self.size.to_array(),
            unit: self.unit,
            error_step: quantise::ERROR_STEP,
            vertices: self.positions.len(),
            wide,
            runs,
            lists,
        }
    }
}

fn light_on_white(mesh: &TriMesh) -> Vec<Rgb> {
    (0..mesh.positions.len()).map(|vertex| mesh.light(vertex)).collect()
}

/// A model as `model.js` reads it.
#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Packed {
    low: [f64; 3],
    size: [f64; 3],
    unit: f64,
    error_step: f64,
    vertices: usize,
    /// Whether corners have 32 bits, not 16.
    wide: bool,
    /// Triangles by their pictures; none if there are no pictures.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    runs: Vec<RunRecord>,
    /// Lists by name, as indices into the chunks; little-endian.
    lists: BTreeMap<&'static str, usize>,
}
