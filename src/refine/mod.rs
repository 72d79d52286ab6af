//! The oracle: whether interpolation across an element is good enough, and if not, where to divide it.
//!
//! Interpolated values are compared with values evaluated afresh: at the midpoints of the edges, at
//! the centre, and, for direct light, at probes in between, so that a small shadow is not
//! overlooked.

mod events;
mod lines;

use smallvec::SmallVec;

use crate::colour::Rgb;
use crate::mesh::{Element, ElementId, Mesh, Middle, Patch, Reason, Split, Vertex, VertexId};
use crate::settings::Settings;

/// A halved quadrilateral may become this much longer than wide; its triangles then keep 11° and more.
const SLENDER: f64 = 5.0;

/// Halving must leave at most this share of the error that is allowed.
const RESIDUE: f64 = 0.7;

/// Elements of this share of the scene's extent are held to the tolerance as it is;
/// larger ones more strictly and smaller ones less, since an error counts by the area that it spoils.
const PLAIN_SIZE: f64 = 0.02;

/// The least and the most that size counts for. In between, allowed errors are as one over the size of
/// elements, so that all have the same share in the squared error: the least in all for their number.
const SIZE_RANGE: [f64; 2] = [0.1, 5.0];

/// Elements of less than this share of the square of the shortest side are not divided.
const LEAST_AREA: f64 = 0.25;

/// Elements of fewer shortest sides than this are small.
const FEW_SIDES: f64 = 4.0;

/// Light straight from emitters is held to this share of the tolerance: it has the edges that eyes look
/// for, and costs little to evaluate.
const DIRECT_SHARE: f64 = 1.0 / 3.0;

/// Light from other surfaces is held to this share: it is smooth, and costs much.
const REFLECTED_SHARE: f64 = 1.5;

/// Light is judged as if at least this share of the mean were there: errors in the dark count for little.
const DARKEST: f64 = 0.05;

pub use lines::{Discontinuity, cut, discontinuities};

/// Judges elements by one kind of light.
#[derive(Clone, Debug)]
pub struct Oracle {
    tolerance: f64,
    /// That of elements beside the outline of what hovers over them: there reflected light has an edge, too.
    outline_tolerance: f64,
    min_element: f64,
    max_level: u32,
    plain_size: f64,
    /// Mean radiosity of the scene, W/m².
    level: f64,
}

/// Errors of interpolation across an element, W/m².
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    /// Largest at the midpoints of edges 0 and 2, then of edges 1 and 3 and all others.
    edges: [f64; 2],
    /// At the centre, from all corners.
    centre: f64,
    /// At the centre, from the midpoints of edges 0 and 2, and from those of edges 1 and 3.
    across: [f64; 2],
}

impl Oracle {
    /// An oracle of light straight from emitters, for a scene of this extent, m.
    ///
    /// Direct light must be known at the corners of all patches of the mesh.
    pub fn of_direct_light(settings: &Settings, extent: f64, mesh: &Mesh) -> Self {
        Self::new(settings, DIRECT_SHARE, (extent, mean_radiosity(mesh)))
    }

    /// An oracle of light from other surfaces, for a scene of this extent, m, and this mean radiosity, W/m².
    pub fn of_reflected_light(settings: &Settings, extent: f64, level: f64) -> Self {
        Self::new(settings, REFLECTED_SHARE, (extent, level))
    }

    fn new(settings: &Settings, share: f64, (extent, level): (f64, f64)) -> Self {
        Self {
            tolerance: settings.tolerance * share,
            outline_tolerance: settings.tolerance * share.min(DIRECT_SHARE),
            min_element: settings.min_element.metres(extent),
            max_level: settings.max_level,
            plain_size: PLAIN_SIZE * extent,
            level,
        }
    }

    /// True if an element may be divided at all.
    pub fn may_divide(&self, mesh: &Mesh, element: ElementId) -> bool {
        let [width, height] = mesh.sides(element);
        let Element { level, area, .. } = mesh[element];
        // Slivers gain nothing by being shorter.
        let is_wide = area >= LEAST_AREA * self.min_element.powi(2);
        level < self.max_level && is_wide && width.max(height) >= 2.0 * self.min_element
    }

    /// How to divide an element, by the `light` (W/m² of radiosity) known at its corners and middle, and by whether
    /// light `is_off` elsewhere on it by more than an error, W/m²; `None` if interpolation will do.
    pub fn judge(
        &self,
        (mesh, element): (&Mesh, ElementId),
        middle: &Middle,
        light: impl Fn(&Vertex) -> Rgb,
        is_off: impl FnOnce(f64) -> bool,
    ) -> Option<Split> {
        let corners: SmallVec<[Rgb; 4]> =
            mesh[element].corners.iter().map(|&v| light(&mesh[v])).collect();
        let errors = Errors::new(&corners, middle, |v| light(&mesh[v]));
        let allowed = self.allowed(mesh, element, &corners);
        let round = || Some(mesh.round_split(element));
        if errors.largest() <= allowed {
            return if is_off(allowed) { round() } else { None };
        }
        let halves = (corners.len() == 4)
            .then(|| self.halving(mesh.sides(element), &errors, allowed))
            .flatten()
            .filter(|_| !is_off(allowed));
        halves.or_else(round)
    }

    /// True if the `light` (W/m² of radiosity) at the corners of an element differs by less than the error that it
    /// is allowed: a facet among others like it then shows well enough how light varies.
    pub fn is_even(
        &self,
        (mesh, element): (&Mesh, ElementId),
        light: impl Fn(&Vertex) -> Rgb,
    ) -> bool {
        let corners: SmallVec<[Rgb; 4]> =
            mesh[element].corners.iter().map(|&v| light(&mesh[v])).collect();
        let low = corners.iter().copied().fold(Rgb::INFINITY, Rgb::min);
        let high = corners.iter().copied().fold(Rgb::NEG_INFINITY, Rgb::max);
        strength(high - low) <= self.allowed(mesh, element, &corners)
    }

    /// True if the sides of an element are only few times as long as the shortest that refinement may make.
    pub fn is_small(&self, mesh: &Mesh, element: ElementId) -> bool {
        let [width, height] = mesh.sides(element);
        width.max(height) < FEW_SIDES * self.min_element
    }

    /// The error of interpolation found in the middle of an element, as a share of what it is allowed.
    pub fn excess(
        &self,
        (mesh, element): (&Mesh, ElementId),
        middle: &Middle,
        light: impl Fn(&Vertex) -> Rgb,
    ) -> f64 {
        let corners: SmallVec<[Rgb; 4]> =
            mesh[element].corners.iter().map(|&v| light(&mesh[v])).collect();
        let errors = Errors::new(&corners, middle, |v| light(&mesh[v]));
        errors.largest() / self.allowed(mesh, element, &corners).max(f64::MIN_POSITIVE)
    }

    /// The direction in which cutting a quadrilateral once is enough, if there is one.
    fn halving(&self, sides: [f64; 2], errors: &Errors, allowed: f64) -> Option<Split> {
        let leaves = |k: usize| errors.edges[1 - k].max(errors.across[k]);
        let stays_round = |k: usize| sides[1 - k] <= SLENDER * sides[k] / 2.0;
        let best = usize::from(leaves(1) < leaves(0));
        (leaves(best) <= RESIDUE * allowed && stays_round(best)).then_some(Split::Halves(best))
    }

    /// The error of direct light that an element is allowed, W/m².
    fn allowed_at(&self, mesh: &Mesh, element: ElementId) -> f64 {
        let reflectance = mesh[mesh[element].patch].reflectance;
        let light = |v: &VertexId| reflectance * mesh[*v].direct.unwrap_or_default().irradiance;
        let corners: SmallVec<[Rgb; 4]> = mesh[element].corners.iter().map(light).collect();
        self.allowed(mesh, element, &corners)
    }

    /// The error that an element is allowed, W/m²: a share of the geometric mean of the radiosities
    /// here and in the whole scene.
    fn allowed(&self, mesh: &Mesh, element: ElementId, corners: &[Rgb]) -> f64 {
        let here = corners.iter().map(|&c| strength(c)).sum::<f64>() / corners.len() as f64;
        let around = (self.level * here.max(DARKEST * self.level)).sqrt();
        let is_beside = mesh[element].corners.iter().any(|&corner| mesh.gap_over(corner) > 0.0);
        let tolerance = if is_beside { self.outline_tolerance } else { self.tolerance };
        tolerance * around * by_size(self.plain_size, mesh[element].area)
    }

    /// The least error that an element is allowed, however little light there is, W/m².
    fn allowed_in_the_dark(&self, mesh: &Mesh, element: ElementId) -> f64 {
        self.allowed(mesh, element, &[Rgb::ZERO])
    }

    /// Why an element is divided.
    pub fn reason(
        &self,
        (mesh, element): (&Mesh, ElementId),
        split: Split,
        middle: &Middle,
    ) -> Reason {
        if matches!(split, Split::Along(_)) {
            return Reason::Discontinuity;
        }
        let places = || mesh[element].corners.iter().chain(&middle.edges).chain([&middle.centre]);
        let seen = places().filter_map(|&v| mesh[v].direct).map(|d| d.visible());
        let (low, high) = seen.fold((1.0, 0.0), |(l, h): (f64, f64), s| (l.min(s), h.max(s)));
        if high - low > 1e-3 {
            return Reason::ShadowEdge;
        }
        let touches = mesh[element].corners.iter().any(|&v| mesh[v].on_contact);
        if touches { Reason::Contact } else { Reason::Gradient }
    }
}

/// Factor on the error that an element of this area, m², is allowed.
fn by_size(plain_size: f64, area: f64) -> f64 {
    let [least, most] = SIZE_RANGE;
    (plain_size / area.sqrt()).clamp(least, most)
}

/// The errors of direct light that do not matter on each patch of a scene of this extent, m: of irradiance, as shares of
/// the geometric mean of that there and that of the whole scene.
pub fn tolerated_direct(settings: &Settings, extent: f64, mesh: &Mesh) -> Vec<f32> {
    let share = |patch: &Patch| {
        // Where light varies, elements are not left larger than that.
        let size = by_size(PLAIN_SIZE * extent, patch.area).max(1.0);
        (settings.tolerance * DIRECT_SHARE * size) as f32
    };
    mesh.patches.iter().map(share).collect()
}

/// Estimate of the mean radiosity of the scene's surfaces, W/m², from the direct light at the corners of leaves.
///
/// Interreflection is taken as in a closed room: 1 / (1 - mean reflectance) times the direct light.
pub fn mean_radiosity(mesh: &Mesh) -> f64 {
    let (mut area, mut reflected, mut reflectance) = (0.0, 0.0, 0.0);
    for leaf in mesh.leaves() {
        let Element { ref corners, patch, area: part, .. } = mesh[leaf];
        let light: Rgb = corners.iter().filter_map(|&v| mesh[v].direct).map(|d| d.irradiance).sum();
        reflected += strength(mesh[patch].reflectance * light) / corners.len() as f64 * part;
        reflectance += strength(mesh[patch].reflectance) * part;
        area += part;
    }
    reflected / (area - reflectance).max(f64::MIN_POSITIVE)
}

impl Errors {
    fn new(corners: &[Rgb], middle: &Middle, light: impl Fn(VertexId) -> Rgb) -> Self {
        let n = corners.len();
        let edges: SmallVec<[Rgb; 8]> = middle.edges.iter().map(|&v| light(v)).collect();
        let centre = light(middle.centre);
        let mut errors = Self {
            centre: strength(centre - corners.iter().sum::<Rgb>() / n as f64),
            ..Self::default()
        };
        for k in 0..n {
            let error = strength(edges[k] - (corners[k] + corners[(k + 1) % n]) * 0.5);
            let pair = usize::from(n != 4 || k % 2 == 1);
            errors.edges[pair] = errors.edges[pair].max(error);
        }
        if n == 4 {
            errors.across = [0, 1].map(|k| strength(centre - (edges[k] + edges[k + 2]) * 0.5));
        }
        errors
    }

    fn largest(&self) -> f64 {
        self.edges[0].max(self.edges[1]).max(self.centre)
    }
}

/// Mean magnitude of the channels.
pub fn strength(colour: Rgb) -> f64 {
    colour.abs().element_sum() / 3.0
}
