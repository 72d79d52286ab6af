//! Light on elements, constant over each, at all levels of the trees.

use super::VertexLight;
use crate::colour::Rgb;
use crate::mesh::{ElementId, Mesh, Patch, VertexId};

/// Differences of light between elements that are rounding, as a share of it.
const EVEN: f64 = 1e-9;

/// Light on every element of a mesh; all lists are one entry per element.
#[derive(Clone, Debug, Default)]
pub struct ElementLight {
    /// Mean irradiance straight from emitters, W/m².
    pub direct: Vec<Rgb>,
    /// Mean irradiance by reflected light, W/m².
    pub indirect: Vec<Rgb>,
}

impl ElementLight {
    /// Direct light alone, from the vertices.
    pub fn direct(mesh: &Mesh, light: &VertexLight) -> Self {
        let leaf = |element| light.mean_direct(mesh, element);
        let direct = pull(mesh, leaf);
        Self { indirect: vec![Rgb::ZERO; direct.len()], direct }
    }

    /// All light, from the vertices.
    pub fn of_vertices(mesh: &Mesh, light: &VertexLight) -> Self {
        let indirect = |v: VertexId| light.indirect(v).unwrap_or_default();
        Self {
            direct: pull(mesh, |element| light.mean_direct(mesh, element)),
            indirect: pull(mesh, |element| mean(mesh, element, indirect)),
        }
    }

    /// Settles the light received at all levels, so that every element has its mean.
    pub fn settle(&mut self, mesh: &Mesh, received: &[Rgb]) {
        let mut sum = received.to_vec();
        for (index, element) in mesh.elements.iter().enumerate() {
            for child in &element.children {
                let above = sum[index];
                sum[child.index()] += above;
            }
        }
        self.indirect = pull(mesh, |element| sum[element.index()]);
    }

    /// Lets a little light that is still unshot arrive where such light has arrived before.
    ///
    /// `ambient` is what it would be on every surface, W/m². Places that none has reached stay dark.
    pub(crate) fn scale_to_the_rest(&mut self, mesh: &Mesh, ambient: Rgb) {
        let area = |patch: &Patch| mesh[patch.root].area;
        let received = |patch: &Patch| self.indirect[patch.root.index()] * area(patch);
        let received: Rgb = mesh.patches.iter().map(received).sum();
        let rest = ambient * mesh.patches.iter().map(area).sum::<f64>();
        let factor = Rgb::ONE + rest / received.max(rest).max(Rgb::splat(f64::MIN_POSITIVE));
        self.indirect.iter_mut().for_each(|light| *light *= factor);
    }

    /// Irradiance by reflected light at vertices, W/m², one per vertex: the mean of the leaves
    /// around, by area.
    pub(crate) fn indirect_at_vertices(&self, mesh: &Mesh) -> Vec<Rgb> {
        let mut sums = vec![(Rgb::ZERO, 0.0); mesh.vertices.len()];
        for leaf in mesh.leaves() {
            let element = &mesh[leaf];
            for corner in &element.corners {
                let (sum, area) = &mut sums[corner.index()];
                *sum += self.indirect[leaf.index()] * element.area;
                *area += element.area;
            }
        }
        sums.into_iter()
            .map(|(sum, area)| if area > 0.0 { sum / area } else { Rgb::ZERO })
            .collect()
    }

    /// The largest elements that reflected light falls on evenly; they cover all patches.
    pub(crate) fn evenly_lit(&self, mesh: &Mesh) -> Vec<ElementId> {
        let mut even = vec![true; mesh.elements.len()];
        for (index, element) in mesh.elements.iter().enumerate().rev() {
            let here = self.indirect[index];
            let is_like = |child: &ElementId| {
                let apart = (self.indirect[child.index()] - here).abs().max_element();
                even[child.index()] && apart <= EVEN * here.abs().max_element()
            };
            even[index] = element.children.iter().all(is_like);
        }
        let mut open: Vec<ElementId> = mesh.patches.iter().map(|patch| patch.root).collect();
        let mut found = Vec::new();
        while let Some(element) = open.pop() {
            if even[element.index()] {
                found.push(element);
            } else {
                open.extend_from_slice(&mesh[element].children);
            }
        }
        found
    }
}

/// Values of all elements from those of the leaves: a parent has the mean of its children by area.
fn pull(mesh: &Mesh, leaf: impl Fn(ElementId) -> Rgb) -> Vec<Rgb> {
    let mut values = vec![Rgb::ZERO; mesh.elements.len()];
    for (index, element) in mesh.elements.iter().enumerate().rev() {
        values[index] = if element.is_leaf() {
            leaf(ElementId(index as u32))
        } else {
            // Of nothing, the mean is nothing.
            let area = element.area.max(f64::MIN_POSITIVE);
            let part = |child: &ElementId| values[child.index()] * (mesh[*child].area / area);
            element.children.iter().map(part).sum()
        };
    }
    values
}

impl VertexLight {
    /// Mean direct irradiance of a leaf, W/m².
    pub(crate) fn mean_direct(&self, mesh: &Mesh, element: ElementId) -> Rgb {
        let steep = self.steep.get(&element).copied();
        steep.unwrap_or_else(|| mean(mesh, element, |v| self.direct_irradiance(v)))
    }
}

/// Mean over a leaf of what is known at its corners and, it may be, in its middle: by Simpson's rule.
pub(crate) fn mean(mesh: &Mesh, element: ElementId, at: impl Fn(VertexId) -> Rgb) -> Rgb {
    let corners = &mesh[element].corners;
    let mean =
        |values: &[VertexId]| values.iter().map(|&v| at(v)).sum::<Rgb>() / values.len() as f64;
    match mesh.find_middle(element) {
        Some(middle) if corners.len() == 4 => {
            (mean(corners) + mean(&middle.edges) * 4.0 + at(middle.centre) * 4.0) / 9.0
        }
        // The rule of degree two on triangles; other polygons are rare and not far from round.
        Some(middle) => mean(&middle.edges),
        None => mean(corners),
    }
}
