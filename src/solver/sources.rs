//! What the elements reflect, as a gathering vertex sees it: finer the nearer it looks.

use glam::{DMat3, DVec3};
use smallvec::SmallVec;

use super::solution::Solution;
use crate::colour::{Rgb, strength};
use crate::light::{ElementLight, Optics, VertexLight};
use crate::mesh::{ElementId, Mesh, PatchId};
use crate::refine::mean_radiosity;

/// Radiosity beyond this many times the mean of the scene counts as that much in it.
pub(super) const HOT: f64 = 8.0;

/// The mean is settled after so many rounds, whatever is hot.
const ROUNDS: usize = 8;

/// The mean counts as at least this share of what direct light lets expect: to look for less would take time without
/// end.
const LEAST: f64 = 1.0 / 32.0;

/// What leaves have of a `light`, W, none counting as brighter than `most`, W/m².
pub(super) fn capped_power(
    mesh: &Mesh,
    leaves: impl Iterator<Item = ElementId>,
    most: f64,
    light: impl Fn(ElementId) -> Rgb,
) -> f64 {
    leaves.map(|leaf| strength(light(leaf)).min(most) * mesh[leaf].area).sum()
}

/// Mean radiosity of a scene, W/m², by which errors are measured.
pub(crate) fn mean_radiosity_shown(solution: &Solution) -> f64 {
    let Solution { mesh, vertex_light, .. } = solution;
    Sources::of_solution(solution).mean_radiosity_shown(mesh, vertex_light)
}

/// Reflected radiosities, W/m², emission not included.
#[derive(Clone, Debug)]
pub(super) struct Sources<'a> {
    pub(super) optics: &'a Optics,
    /// Mean over each element.
    mean: Vec<Rgb>,
    /// How far the radiosity within an element is from its mean.
    spread: Vec<f64>,
    /// Irradiance of vertices, W/m².
    irradiance: Vec<Rgb>,
}

/// A piece of an element, with the radiosities of its corners.
#[derive(Clone, Debug)]
pub(super) struct RadiosityPiece {
    pub(super) corners: SmallVec<[DVec3; 4]>,
    light: SmallVec<[Rgb; 4]>,
}

impl<'a> Sources<'a> {
    /// From the means over elements, and irradiances of vertices that need only be right in how they vary.
    pub(super) fn new(
        mesh: &Mesh,
        optics: &'a Optics,
        light: &ElementLight,
        irradiance: Vec<Rgb>,
    ) -> Self {
        let mean: Vec<Rgb> = mesh
            .elements
            .iter()
            .zip(light.direct.iter().zip(&light.indirect))
            .map(|(element, (direct, indirect))| optics.of(element) * (direct + indirect))
            .collect();
        let mut sources = Self { optics, spread: vec![0.0; mean.len()], mean, irradiance };
        for index in (0..mesh.elements.len()).rev() {
            sources.spread[index] = sources.deviation(mesh, ElementId(index as u32));
        }
        sources
    }

    /// From the direct light of elements and vertices.
    pub(super) fn of_direct_light(
        mesh: &Mesh,
        optics: &'a Optics,
        vertices: &VertexLight,
        light: &ElementLight,
    ) -> Self {
        let direct = |v| vertices.direct_irradiance(v);
        Self::new(mesh, optics, light, mesh.vertex_ids().map(direct).collect())
    }

    /// From the light of all vertices.
    pub(super) fn of_vertices(mesh: &Mesh, optics: &'a Optics, light: &VertexLight) -> Self {
        let irradiance = mesh.vertex_ids().map(|v| light.irradiance(v)).collect();
        Self::new(mesh, optics, &ElementLight::of_vertices(mesh, light), irradiance)
    }

    /// From the light of a solution.
    pub(super) fn of_solution(solution: &'a Solution) -> Self {
        let Solution { mesh, optics, vertex_light, light, .. } = solution;
        let irradiance = mesh.vertex_ids().map(|v| vertex_light.irradiance(v)).collect();
        Self::new(mesh, optics, light, irradiance)
    }

    fn deviation(&self, mesh: &Mesh, id: ElementId) -> f64 {
        let (element, mean) = (&mesh[id], self.mean[id.index()]);
        if element.is_leaf() {
            let corners = self.corners(mesh, id);
            return corners.iter().map(|&c| strength(c - mean)).fold(0.0, f64::max);
        }
        let part =
            |part: &ElementId| strength(self.mean[part.index()] - mean) + self.spread[part.index()];
        element.children.iter().map(part).fold(0.0, f64::max)
    }

    fn corners(&self, mesh: &Mesh, element: ElementId) -> SmallVec<[Rgb; 4]> {
        let reflectance = self.optics.of(&mesh[element]);
        let corners = mesh[element].corners.iter();
        corners.map(|v| reflectance * self.irradiance[v.index()]).collect()
    }

    /// The parts of an element, none if it was whole when the sources were made.
    pub(super) fn parts<'m>(&self, mesh: &'m Mesh, element: ElementId) -> &'m [ElementId] {
        let children = &mesh[element].children;
        if children.iter().all(|child| child.index() < self.mean.len()) { children } else { &[] }
    }

    /// Mean over an element, W/m².
    pub(super) fn mean(&self, element: ElementId) -> Rgb {
        self.mean[element.index()]
    }

    /// How far the radiosity within an element is from its mean, W/m².
    pub(super) fn spread(&self, element: ElementId) -> f64 {
        self.spread[element.index()]
    }

    /// A leaf as a piece whose mean is the leaf's; the corners say how light varies over it.
    pub(super) fn piece(&self, mesh: &Mesh, leaf: ElementId) -> RadiosityPiece {
        let plane = mesh.plane(mesh[leaf].patch);
        let (light, mean) = (self.corners(mesh, leaf), self.mean(leaf));
        let around = light.iter().sum::<Rgb>() / light.len() as f64;
        // Nothing becomes negative, and the mean is kept.
        let adapted = |corner: Rgb| {
            Rgb::select(mean.cmplt(around), corner * (mean / around), corner + (mean - around))
        };
        RadiosityPiece {
            corners: mesh[leaf].corners.iter().map(|&v| plane.lift(mesh[v].position)).collect(),
            light: light.into_iter().map(adapted).collect(),
        }
    }

    /// Mean radiosity of a scene, W/m², by which errors are measured: as direct light lets expect, unless far less
    /// of it goes round.
    ///
    /// Light that is shut in, as between an emitter and the ceiling that it all but touches, makes a small spot hot and
    /// the room no brighter, and the errors that it hides are those of the room.
    pub(super) fn mean_radiosity_shown(&self, mesh: &Mesh, light: &VertexLight) -> f64 {
        let area: f64 = mesh.leaves().map(|leaf| mesh[leaf].area).sum();
        let capped = |most: f64| {
            let all = capped_power(mesh, mesh.leaves(), most, |leaf| self.mean(leaf));
            all / area.max(f64::MIN_POSITIVE)
        };
        let found = (0..ROUNDS).fold(capped(f64::INFINITY), |mean, _| capped(HOT * mean));
        let expected = mean_radiosity(mesh, self.optics, light);
        expected.min(2.0 * found).max(LEAST * expected)
    }

    /// How much the light that a patch shows has changed since `before`, at most, W/m².
    pub(super) fn change(&self, mesh: &Mesh, before: &Self, patch: PatchId) -> f64 {
        let root = mesh[patch].root;
        let spread = (self.spread(root) - before.spread(root)).abs();
        strength(self.mean(root) - before.mean(root)) + spread
    }
}

impl RadiosityPiece {
    /// Mean radiosity, W/m².
    pub(super) fn mean(&self) -> Rgb {
        self.light.iter().sum::<Rgb>() / self.light.len() as f64
    }

    /// Mean of the corners, m.
    pub(super) fn centre(&self) -> DVec3 {
        self.corners.iter().sum::<DVec3>() / self.corners.len() as f64
    }

    /// Radiosity at a place on it, W/m², by the plane that fits the corners best.
    pub(super) fn at(&self, place: DVec3) -> Rgb {
        let (centre, mean) = (self.centre(), self.mean());
        let (mut square, mut slopes) = (DMat3::ZERO, [DVec3::ZERO; 3]);
        for (&corner, &light) in self.corners.iter().zip(&self.light) {
            let aside = corner - centre;
            square += outer(aside);
            for (slope, rise) in slopes.iter_mut().zip((light - mean).to_array()) {
                *slope += aside * rise;
            }
        }
        // Across the plane nothing rises, so any other number there would do.
        let [a, b] = [0, 1].map(|k| self.corners[k + 1] - self.corners[k]);
        let normal = a.cross(b).normalize_or_zero();
        let square = square + outer(normal) * (square.x_axis.x + square.y_axis.y + square.z_axis.z);
        if square.determinant() <= f64::MIN_POSITIVE {
            return mean;
        }
        let towards = square.inverse() * (place - centre);
        (mean + Rgb::from_array(slopes.map(|slope| slope.dot(towards)))).max(Rgb::ZERO)
    }

    /// How far the corners are from the mean, W/m².
    pub(super) fn spread(&self) -> f64 {
        let mean = self.mean();
        self.light.iter().map(|&corner| strength(corner - mean)).fold(0.0, f64::max)
    }

    /// Its parts between each corner, the middles of the edges there, and its centre.
    pub(super) fn parts(&self) -> SmallVec<[Self; 4]> {
        let corners = quarters(&self.corners, self.centre(), |a, b| (a + b) * 0.5);
        let light = quarters(&self.light, self.mean(), |a, b| (a + b) * 0.5);
        let part = |(corners, light): ([DVec3; 4], [Rgb; 4])| Self {
            corners: corners.into(),
            light: light.into(),
        };
        corners.zip(light).map(part).collect()
    }
}

/// What is known at the corners of a polygon, on its parts: each is between a corner, the middles of the edges there,
/// and the centre.
pub(super) fn quarters<T: Copy>(
    corners: &[T],
    centre: T,
    middle: impl Fn(T, T) -> T,
) -> impl Iterator<Item = [T; 4]> {
    let n = corners.len();
    (0..n).map(move |k| {
        let [before, at, after] = [k + n - 1, k, k + 1].map(|k| corners[k % n]);
        [at, middle(at, after), centre, middle(before, at)]
    })
}

/// v vᵀ.
fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}
