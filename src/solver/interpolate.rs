//! Light at vertices where it was not evaluated, from those where it was.

use crate::colour::Rgb;
use crate::geometry::polygon::distance;
use crate::light::{Direct, VertexLight};
use crate::mesh::{ElementId, Mesh, VertexId};

/// One kind of light: what of it is known at a vertex, and what is to be.
#[derive(Clone, Copy)]
pub(super) struct Kind {
    get: fn(&VertexLight, VertexId) -> Option<[Rgb; 2]>,
    set: fn(&mut VertexLight, VertexId, [Rgb; 2]),
}

/// Light straight from emitters, as it is and as it would be if nothing stood in between.
pub(super) const DIRECT: Kind = Kind {
    get: |light, v| light.direct(v).map(|direct| [direct.irradiance, direct.unoccluded]),
    set: |light, v, [irradiance, unoccluded]| {
        light.set_direct(v, Direct { irradiance, unoccluded });
    },
};

/// Light from other surfaces.
pub(super) const REFLECTED: Kind = Kind {
    get: |light, v| light.indirect(v).map(|indirect| [indirect; 2]),
    set: |light, v, [indirect, _]| light.set_indirect(v, indirect),
};

/// Gives vertices that lack a kind of light what their parents' corners say, from the patches downwards.
pub(super) fn interpolate(mesh: &Mesh, light: &mut VertexLight, kind: Kind) {
    for index in 0..mesh.elements.len() {
        let element = ElementId(index as u32);
        let Some(middle) = mesh.find_middle(element) else { continue };
        let corners = &mesh[element].corners;
        for (k, &vertex) in middle.edges.iter().enumerate() {
            let ends = [corners[k], corners[(k + 1) % corners.len()]];
            kind.give(light, vertex, |light| kind.mean(light, &ends));
        }
        kind.give(light, middle.centre, |light| kind.mean(light, corners));
        let parts = &mesh[element].children;
        for &vertex in parts.iter().flat_map(|&part| &mesh[part].corners) {
            kind.give(light, vertex, |light| {
                let [a, b] = nearest_half(mesh, corners, &middle.edges, vertex);
                kind.between(mesh, light, [a, b], vertex)
            });
        }
    }
}

impl Kind {
    fn at(self, light: &VertexLight, vertex: VertexId) -> [Rgb; 2] {
        (self.get)(light, vertex).unwrap_or_default()
    }

    /// Gives a vertex light unless it has some.
    fn give(
        self,
        light: &mut VertexLight,
        vertex: VertexId,
        found: impl FnOnce(&VertexLight) -> [Rgb; 2],
    ) {
        if (self.get)(light, vertex).is_none() {
            let found = found(light);
            (self.set)(light, vertex, found);
        }
    }

    fn mean(self, light: &VertexLight, vertices: &[VertexId]) -> [Rgb; 2] {
        let sum = |k: usize| vertices.iter().map(|&v| self.at(light, v)[k]).sum::<Rgb>();
        [0, 1].map(|k| sum(k) / vertices.len() as f64)
    }

    /// Light at a vertex between two others.
    fn between(
        self,
        mesh: &Mesh,
        light: &VertexLight,
        [a, b]: [VertexId; 2],
        vertex: VertexId,
    ) -> [Rgb; 2] {
        let at = |v: VertexId| mesh[v].position;
        // Ends that were welded are at no distance.
        let share = at(a).distance(at(vertex)) / at(a).distance(at(b)).max(f64::MIN_POSITIVE);
        let (from, to) = (self.at(light, a), self.at(light, b));
        [0, 1].map(|k| from[k].lerp(to[k], share.min(1.0)))
    }
}

/// The ends of the half of an edge of an element that is nearest to a vertex on its border.
fn nearest_half(
    mesh: &Mesh,
    corners: &[VertexId],
    middles: &[VertexId],
    vertex: VertexId,
) -> [VertexId; 2] {
    let at = |v: VertexId| mesh[v].position;
    let n = corners.len();
    let halves =
        (0..n).flat_map(|k| [[corners[k], middles[k]], [middles[k], corners[(k + 1) % n]]]);
    let gap = |half: &[VertexId; 2]| distance(half.map(at), at(vertex));
    halves.min_by(|a, b| gap(a).total_cmp(&gap(b))).unwrap_or([corners[0]; 2])
}
