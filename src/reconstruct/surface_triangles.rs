//! The triangles of one surface.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::edge_vertices::Places;
use super::fit::{HatFit, LeafLight};
use super::normal::normal_at;
use super::triangulate::{LeafTriangle, triangulate};
use super::trimesh::Irradiance;
use crate::colour::Rgb;
use crate::light::VertexLight;
use crate::mesh::{Element, ElementId, Mesh, VertexId};
use crate::scene::MaterialId;
use crate::solver::Solution;
use crate::surface::{Surface, Surfaces, mean_texture};

/// A triangulated surface.
#[derive(Debug)]
pub(super) struct SurfaceTriangles {
    pub(super) corners: Vec<LitCorner>,
    /// Indices into `corners`.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The leaf that each triangle is part of.
    pub(super) leaves: Vec<ElementId>,
    /// Places inside edges of leaves; some more than once.
    pub(super) hanging: Vec<u32>,
    /// True if the surface stands for a part of a curved one.
    pub(super) curved: bool,
    pub(super) material: MaterialId,
}

/// What will be a vertex of the triangle mesh.
#[derive(Clone, Debug)]
pub(super) struct LitCorner {
    pub(super) place: u32,
    pub(super) normal: DVec3,
    pub(super) uv: DVec2,
    pub(super) irradiance: Irradiance,
    pub(super) radiosity: Rgb,
    /// The part of the radiosity that the surface emits.
    pub(super) emitted: Rgb,
    pub(super) texture_mean: Rgb,
    /// Diffuse reflectance without the texture's part.
    pub(super) reflectance: Rgb,
}

/// Where a corner has its light from: a vertex of the mesh, or the middle of an edge between two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum CornerSource {
    Vertex(VertexId),
    Between(VertexId, VertexId),
}

/// The leaves of a surface, outlined by places.
#[derive(Debug)]
pub(super) struct OutlinedLeaves {
    pub(super) leaves: Vec<ElementId>,
    /// Leaf by leaf: the places of its corners.
    pub(super) outlines: Vec<Vec<u32>>,
}

/// An edge of a leaf: vertices of the mesh, and the places where they are.
#[derive(Clone, Copy, Debug)]
struct LeafEdge {
    vertices: [VertexId; 2],
    places: [u32; 2],
}

/// A place on the way around a leaf: the first of an edge of it, or one that hangs there.
#[derive(Clone, Copy, Debug)]
struct OutlinePoint {
    place: u32,
    edge: usize,
    hangs: bool,
}

/// Sums over the leaves that share a corner, by area.
#[derive(Clone, Copy, Debug, Default)]
struct TextureMeans {
    area: f64,
    reflectance_texture: Rgb,
    exitance_texture: Rgb,
}

/// Collects the corners of a surface.
struct Builder<'a> {
    mesh: &'a Mesh,
    light: &'a VertexLight,
    surface: &'a Surface,
    places: &'a Places,
    numbers: HashMap<(u32, CornerSource), u32>,
    corners: Vec<LitCorner>,
    textures: Vec<TextureMeans>,
    hanging: Vec<u32>,
}

impl SurfaceTriangles {
    /// Triangulates the leaves of one of the `surfaces`.
    pub(super) fn new(
        surfaces: &Surfaces,
        surface: &Surface,
        solution: &Solution,
        places: &Places,
        OutlinedLeaves { leaves, outlines }: &OutlinedLeaves,
    ) -> Self {
        let mesh = &solution.mesh;
        let mut builder = Builder {
            mesh,
            light: &solution.vertex_light,
            surface,
            places,
            numbers: HashMap::new(),
            corners: Vec::new(),
            textures: Vec::new(),
            hanging: Vec::new(),
        };
        let mut loops = Vec::new();
        let mut numbered = Vec::new();
        for (&leaf, outline) in leaves.iter().zip(outlines) {
            let means = texture_means(surfaces, surface, mesh, leaf);
            let (places, corners) = builder.outline(&mesh[leaf], outline, means);
            numbered.push(places.iter().copied().zip(corners).collect::<HashMap<u32, u32>>());
            loops.push(places);
        }
        let tiles = triangulate(&loops, |place| surface.plane.flatten(places.at(place)));
        // Where rounding has brought a stranger into a leaf, any corner at its place will do.
        let anywhere = |place| numbered.iter().find_map(|numbers| numbers.get(&place)).copied();
        let corner = |tile: &LeafTriangle, place| {
            numbered[tile.leaf].get(&place).copied().or_else(|| anywhere(place)).unwrap_or_default()
        };
        let triangle = |tile: &LeafTriangle| tile.corners.map(|place| corner(tile, place));
        let triangles: Vec<[u32; 3]> = tiles.iter().map(triangle).collect();
        builder.fit(leaves, &tiles, &triangles);
        Self {
            triangles,
            leaves: tiles.iter().map(|tile| leaves[tile.leaf]).collect(),
            hanging: std::mem::take(&mut builder.hanging),
            corners: builder.finish(),
            curved: !surface.normals.is_empty(),
            material: surface.material,
        }
    }
}

impl Builder<'_> {
    /// A leaf's outline with the places that hang on it, and the corners there; nothing if it encloses nothing.
    fn outline(
        &mut self,
        leaf: &Element,
        outline: &[u32],
        means: TextureMeans,
    ) -> (Vec<u32>, Vec<u32>) {
        let next = |k: usize| (k + 1) % outline.len();
        let stops = (0..outline.len()).flat_map(|edge| {
            let hanging = self.places.between(outline[edge], outline[next(edge)]);
            let corner = OutlinePoint { place: outline[edge], edge, hangs: false };
            let hang = move |place| OutlinePoint { place, edge, hangs: true };
            [corner].into_iter().chain(hanging.into_iter().map(hang))
        });
        let stops = without_spikes(stops.collect());
        let corner = |&OutlinePoint { place, edge, hangs }: &OutlinePoint| {
            let vertices = [leaf.corners[edge], leaf.corners[next(edge)]];
            if !hangs {
                let light = arriving(self.light, vertices[0]);
                return self.corner(CornerSource::Vertex(vertices[0]), place, light, means);
            }
            self.hanging.push(place);
            let edge = LeafEdge { vertices, places: [outline[edge], outline[next(edge)]] };
            let (source, light) = self.hanging(leaf, edge, place);
            self.corner(source, place, light, means)
        };
        let corners = stops.iter().map(corner).collect();
        (stops.iter().map(|stop| stop.place).collect(), corners)
    }

    /// Light at a place on an edge: what is known there, else what is interpolated along the edge.
    fn hanging(&self, leaf: &Element, edge: LeafEdge, place: u32) -> (CornerSource, Irradiance) {
        let at = |place| self.places.at(place);
        let known = self.mesh.find_vertex(leaf.patch, self.surface.plane.flatten(at(place)));
        let lit =
            |v: &VertexId| self.light.direct(*v).is_some() && self.light.indirect(*v).is_some();
        if let Some(vertex) = known.filter(lit) {
            return (CornerSource::Vertex(vertex), arriving(self.light, vertex));
        }
        let LeafEdge { vertices: [a, b], places: [from, to] } = edge;
        let share = at(from).distance(at(place)) / at(from).distance(at(to));
        let [a_light, b_light] = [a, b].map(|v| arriving(self.light, v));
        let light = a_light.lerp(b_light, share);
        (CornerSource::Between(a.min(b), a.max(b)), light)
    }

    fn corner(
        &mut self,
        source: CornerSource,
        place: u32,
        irradiance: Irradiance,
        means: TextureMeans,
    ) -> u32 {
        let number = *self.numbers.entry((place, source)).or_insert_with(|| {
            let position = self.surface.plane.flatten(self.places.at(place));
            let corner = LitCorner {
                place,
                normal: normal_at(self.surface, position),
                uv: self.surface.uv.map_or(DVec2::ZERO, |uv| uv.transform_point2(position)),
                irradiance,
                radiosity: Rgb::ZERO,
                emitted: Rgb::ZERO,
                texture_mean: Rgb::ONE,
                reflectance: self.surface.reflectance_at(position),
            };
            self.corners.push(corner);
            self.textures.push(TextureMeans::default());
            self.corners.len() as u32 - 1
        });
        self.textures[number as usize].add(means);
        number
    }

    /// Moves light at the corners so that triangles hold what leaves do.
    fn fit(&mut self, leaves: &[ElementId], tiles: &[LeafTriangle], triangles: &[[u32; 3]]) {
        let direct = self.fits(leaves, tiles, triangles, |v| {
            self.light.direct(v).map(|direct| direct.irradiance)
        });
        let indirect = self.fits(leaves, tiles, triangles, |v| self.light.indirect(v));
        for (corner, (direct, indirect)) in
            self.corners.iter_mut().zip(direct.iter().zip(&indirect))
        {
            let irradiance = &mut corner.irradiance;
            irradiance.direct = direct.moved(irradiance.direct);
            irradiance.direct_on_facet = direct.moved(irradiance.direct_on_facet);
            irradiance.indirect = indirect.moved(irradiance.indirect);
        }
    }

    /// By how much one kind of light is to be moved, corner by corner.
    fn fits(
        &self,
        leaves: &[ElementId],
        tiles: &[LeafTriangle],
        triangles: &[[u32; 3]],
        light: impl Fn(VertexId) -> Option<Rgb>,
    ) -> Vec<HatFit> {
        let known: Vec<Option<LeafLight>> =
            leaves.iter().map(|&leaf| LeafLight::new(self.mesh, leaf, &light)).collect();
        let mut fits = vec![HatFit::default(); self.corners.len()];
        for (tile, triangle) in tiles.iter().zip(triangles) {
            let Some(known) = known[tile.leaf] else { continue };
            let at = |place: u32| self.surface.plane.flatten(self.places.at(place));
            for (&corner, share) in triangle.iter().zip(known.shares(tile.corners.map(at))) {
                fits[corner as usize].add(share, known.range);
            }
        }
        fits
    }

    /// The corners with their radiosities: B = E + ρ H, texture means included.
    fn finish(self) -> Vec<LitCorner> {
        let exitance = self.surface.exitance;
        let with_light = |(corner, means): (LitCorner, TextureMeans)| {
            let texture_mean = means.reflectance_texture / means.area;
            let emitted = exitance * means.exitance_texture / means.area;
            let Irradiance { direct, indirect, .. } = corner.irradiance;
            let radiosity = emitted + corner.reflectance * texture_mean * (direct + indirect);
            LitCorner { radiosity, emitted, texture_mean, ..corner }
        };
        self.corners.into_iter().zip(self.textures).map(with_light).collect()
    }
}

/// A way around without what leads to a place and straight back, or only stays: it encloses nothing.
fn without_spikes(mut stops: Vec<OutlinePoint>) -> Vec<OutlinePoint> {
    loop {
        let n = stops.len();
        let at = |k: usize| stops[k % n].place;
        let Some(k) = (0..n).find(|&k| at(k) == at(k + 1) || at(k) == at(k + 2)) else {
            return stops;
        };
        let needless = if at(k) == at(k + 1) { vec![k] } else { vec![(k + 1) % n, (k + 2) % n] };
        let mut index = 0..;
        stops.retain(|_| !index.next().is_some_and(|k| needless.contains(&k)));
    }
}

/// What is known to arrive at a vertex; nothing where no light was evaluated.
fn arriving(light: &VertexLight, vertex: VertexId) -> Irradiance {
    let direct = light.direct_irradiance(vertex);
    let indirect = light.indirect(vertex).unwrap_or(Rgb::ZERO);
    Irradiance { direct, indirect, direct_on_facet: direct }
}

impl TextureMeans {
    fn add(&mut self, other: Self) {
        self.area += other.area;
        self.reflectance_texture += other.reflectance_texture * other.area;
        self.exitance_texture += other.exitance_texture * other.area;
    }
}

/// Area and mean texture of a leaf.
fn texture_means(
    surfaces: &Surfaces,
    surface: &Surface,
    mesh: &Mesh,
    leaf: ElementId,
) -> TextureMeans {
    let [reflectance_texture, exitance_texture] =
        mean_texture(surfaces, surface, &mesh.outline(leaf));
    TextureMeans { area: mesh[leaf].area, reflectance_texture, exitance_texture }
}
