//! Direct light where it was not evaluated in time: coarse, but never without shadows.

use std::ops::ControlFlow;
use std::time::Duration;

use super::interpolate::{DIRECT, interpolate};
use crate::colour::Rgb;
use crate::direct::DirectLight;
use crate::light::{Direct, VertexLight};
use crate::mesh::{Mesh, VertexId};
use crate::visibility::SurfacePoint;
use crate::watch::{in_batches, within};

/// Time for a rough look at all places: who has ended the work waits.
const TIME: Duration = Duration::from_millis(700);

/// Deepest level of elements in whose middle light may be another than between their corners.
const COARSE: u32 = 1;

/// Share of the golden section: its multiples are even over everything, wherever they end.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// Gives vertices that were not evaluated in time light: corners of patches and the middles of elements that were
/// hardly divided by a few rays, all others from those.
///
/// Where even that takes too long, corners have what others of their patch have, or of their surface.
pub(super) fn make_do(emitters: &DirectLight, mesh: &Mesh, light: &mut VertexLight) {
    let mut go_on = within(TIME);
    let corners = mesh.patches.iter().flat_map(|patch| mesh[patch.root].corners.iter().copied());
    look(emitters, mesh, light, corners, &mut go_on);
    let coarse = mesh.leaves().filter(|&leaf| mesh[leaf].level <= COARSE);
    let middles = coarse.filter_map(|leaf| mesh.find_middle(leaf));
    let places = middles.flat_map(|middle| middle.edges.into_iter().chain([middle.centre]));
    look(emitters, mesh, light, places, &mut go_on);
    borrow(mesh, light);
    interpolate(mesh, light, DIRECT);
}

/// Those of the vertices whose light is not known, in an order of which any beginning is spread over all.
fn dark(light: &VertexLight, vertices: impl Iterator<Item = VertexId>) -> Vec<VertexId> {
    let mut dark: Vec<VertexId> = vertices.filter(|&v| light.direct(v).is_none()).collect();
    dark.sort_unstable();
    dark.dedup();
    let mut order: Vec<(f64, VertexId)> =
        dark.into_iter().enumerate().map(|(k, v)| ((k as f64 * GOLDEN).fract(), v)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    order.into_iter().map(|(_, vertex)| vertex).collect()
}

/// Looks roughly at those of the vertices whose light is not known, as long as it may.
fn look(
    emitters: &DirectLight,
    mesh: &Mesh,
    light: &mut VertexLight,
    vertices: impl Iterator<Item = VertexId>,
    go_on: &mut impl FnMut(f64) -> ControlFlow<()>,
) {
    let dark = dark(light, vertices);
    let at = |(): &mut (), &vertex: &VertexId| {
        let point = SurfacePoint::new(mesh[vertex].site, mesh[mesh[vertex].patch].normal);
        let mut random = fastrand::Rng::with_seed(vertex.index() as u64);
        emitters.emitters().rough(emitters.occluders(), point, || random.f64())
    };
    let found: Vec<Direct> = in_batches(&dark, |_| (), at, go_on);
    for (&vertex, direct) in dark.iter().zip(found) {
        light.set_direct(vertex, direct);
    }
}

/// Gives corners of patches that are still dark the mean of what is known of their patch, else of their surface, else
/// of all.
fn borrow(mesh: &Mesh, light: &mut VertexLight) {
    let surfaces = mesh.patches.iter().map(|patch| patch.surface.index() + 1).max().unwrap_or(0);
    let mut by_surface = vec![Mean::default(); surfaces];
    let mut all = Mean::default();
    for (index, vertex) in mesh.vertices.iter().enumerate() {
        if let Some(direct) = light.direct(VertexId(index as u32)) {
            by_surface[vertex.surface.index()].add(direct);
            all.add(direct);
        }
    }
    for patch in mesh.patch_ids() {
        let corners = &mesh[mesh[patch].root].corners;
        let mut own = Mean::default();
        corners.iter().filter_map(|&v| light.direct(v)).for_each(|direct| own.add(direct));
        let means = [own, by_surface[mesh[patch].surface.index()], all];
        let best = means.iter().find_map(Mean::value).unwrap_or_default();
        for &corner in corners {
            if light.direct(corner).is_none() {
                light.set_direct(corner, best);
            }
        }
    }
}

/// A mean of what arrives.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: Direct,
    count: f64,
}

impl Mean {
    fn add(&mut self, direct: Direct) {
        self.sum = self.sum + direct;
        self.count += 1.0;
    }

    fn value(&self) -> Option<Direct> {
        let mean = |sum: Rgb| sum / self.count;
        (self.count > 0.0).then(|| Direct {
            irradiance: mean(self.sum.irradiance),
            unoccluded: mean(self.sum.unoccluded),
        })
    }
}
