//! Light at vertices where it was not evaluated, from those where it was.

use crate::colour::Rgb;
use crate::mesh::{Direct, ElementId, Mesh, Vertex, VertexId};
use crate::surface::polygon::distance;

/// One kind of light: what of it is known at a vertex, and what is to be.
#[derive(Clone, Copy)]
pub(super) struct Kind {
    get: fn(&Vertex) -> Option<[Rgb; 2]>,
    set: fn(&mut Vertex, [Rgb; 2]),
}

/// Light straight from emitters, as it is and as it would be if nothing stood in between.
pub(super) const DIRECT: Kind = Kind {
    get: |vertex| vertex.direct.map(|direct| [direct.irradiance, direct.unoccluded]),
    set: |vertex, [irradiance, unoccluded]| {
        vertex.direct = Some(Direct { irradiance, unoccluded });
    },
};

/// Light from other surfaces.
pub(super) const REFLECTED: Kind = Kind {
    get: |vertex| vertex.indirect.map(|indirect| [indirect; 2]),
    set: |vertex, [indirect, _]| vertex.indirect = Some(indirect),
};

/// Gives vertices that lack a kind of light what their parents' corners say, from the patches downwards.
pub(super) fn interpolate(mesh: &mut Mesh, kind: Kind) {
    for index in 0..mesh.elements.len() {
        let element = ElementId(index as u32);
        let Some(middle) = mesh.find_middle(element) else { continue };
        let corners = mesh[element].corners.clone();
        for (k, &vertex) in middle.edges.iter().enumerate() {
            let ends = [corners[k], corners[(k + 1) % corners.len()]];
            kind.give(mesh, vertex, |mesh| kind.mean(mesh, &ends));
        }
        kind.give(mesh, middle.centre, |mesh| kind.mean(mesh, &corners));
        let parts = mesh[element].children.clone();
        for vertex in parts.iter().flat_map(|&part| mesh[part].corners.clone()).collect::<Vec<_>>()
        {
            kind.give(mesh, vertex, |mesh| {
                kind.along_edges(mesh, (&corners, &middle.edges), vertex)
            });
        }
    }
}

impl Kind {
    fn at(self, mesh: &Mesh, vertex: VertexId) -> [Rgb; 2] {
        (self.get)(&mesh[vertex]).unwrap_or_default()
    }

    /// Gives a vertex light unless it has some.
    fn give(self, mesh: &mut Mesh, vertex: VertexId, light: impl FnOnce(&Mesh) -> [Rgb; 2]) {
        if (self.get)(&mesh[vertex]).is_none() {
            let light = light(mesh);
            (self.set)(&mut mesh.vertices[vertex.index()], light);
        }
    }

    fn mean(self, mesh: &Mesh, vertices: &[VertexId]) -> [Rgb; 2] {
        let sum = |k: usize| vertices.iter().map(|&v| self.at(mesh, v)[k]).sum::<Rgb>();
        [0, 1].map(|k| sum(k) / vertices.len() as f64)
    }

    /// Light at a vertex on the border of an element, from the corners and midpoints of the nearest edge.
    fn along_edges(
        self,
        mesh: &Mesh,
        (corners, middles): (&[VertexId], &[VertexId]),
        vertex: VertexId,
    ) -> [Rgb; 2] {
        let at = |v: VertexId| mesh[v].position;
        let place = at(vertex);
        let n = corners.len();
        let halves =
            (0..n).flat_map(|k| [[corners[k], middles[k]], [middles[k], corners[(k + 1) % n]]]);
        let gap = |half: &[VertexId; 2]| distance(half.map(at), place);
        let nearest = halves.min_by(|a, b| gap(a).total_cmp(&gap(b)));
        let [a, b] = nearest.unwrap_or([corners[0]; 2]);
        // Ends that were welded are at no distance.
        let share = at(a).distance(place) / at(a).distance(at(b)).max(f64::MIN_POSITIVE);
        let (from, to) = (self.at(mesh, a), self.at(mesh, b));
        [0, 1].map(|k| from[k].lerp(to[k], share.min(1.0)))
    }
}
