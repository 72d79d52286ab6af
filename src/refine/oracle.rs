//! Judges elements: whether interpolation is good enough, and if not, where to divide.

use super::mean::mean_radiosity;
use super::sample::{Errors, Sample};
use crate::colour::{Rgb, strength};
use crate::light::{Optics, VertexLight};
use crate::mesh::{Element, ElementId, Mesh, Middle, Patch, Reason, Split, VertexId};
use crate::settings::Settings;

/// A halved quadrilateral may become this much longer than wide; its triangles then keep 11° and more.
///
/// At 2.5, two rooms (medium) take 8 630 triangles for 8 498; at 10, shadows there err by 0.96 % for 0.78 %.
const SLENDER: f64 = 5.0;

/// Halving must leave at most this share of the error that is allowed.
///
/// At 0.4, two rooms (medium) take 8 890 triangles for 8 498 and err no less; at 0.95, the floor of the blocker scene
/// errs by 0.155 % for 0.144 %.
const RESIDUE: f64 = 0.7;

/// Elements of this share of the scene's extent are held to the tolerance as it is;
/// larger ones more strictly and smaller ones less, since an error counts by the area that it spoils.
///
/// At 0.01, two rooms joined by a door (medium) take 14 672 triangles for 8 498, and err no less; at 0.04, shadows
/// there err by 1.19 % for 0.78 %, and those of the Cornell box by 0.71 % for 0.55 %.
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
///
/// At 1/6, the Cornell box (medium) takes 20 751 triangles for 14 024, and errs no less (0.57 % of the mean radiosity);
/// at 2/3, the shadows of a room behind a door err by 1.21 % for 0.78 %, and those of the blocker scene by 0.28 % for
/// 0.18 %.
const DIRECT_SHARE: f64 = 1.0 / 3.0;

/// Light from other surfaces is held to this share: it is smooth, and costs much.
///
/// At 0.75, two rooms joined by a door (medium) take 11 230 triangles for 8 498 and 1.7 times the time, for 0.71 % error
/// instead of 0.72 %; at 3, shadows there err by 1.24 % for 0.78 %, and those of the Cornell box by 0.71 % for 0.55 %.
const REFLECTED_SHARE: f64 = 1.5;

/// Light is judged as if at least this share of the mean were there: errors in the dark count for little.
///
/// At 0.025, two rooms (medium) take 8 826 triangles for 8 498; at 0.1, shadows there err by 0.97 % for 0.78 %.
const DARKEST: f64 = 0.05;

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
    mean: f64,
}

impl Oracle {
    /// An oracle of light straight from emitters, for a scene of this extent, m.
    ///
    /// Direct light must be known at the corners of all patches of the mesh.
    pub fn of_direct_light(
        settings: &Settings,
        extent: f64,
        mesh: &Mesh,
        optics: &Optics,
        light: &VertexLight,
    ) -> Self {
        Self::new(settings, DIRECT_SHARE, extent, mean_radiosity(mesh, optics, light))
    }

    /// An oracle of light from other surfaces, for a scene of this extent, m, and this mean radiosity, W/m².
    pub fn of_reflected_light(settings: &Settings, extent: f64, mean: f64) -> Self {
        Self::new(settings, REFLECTED_SHARE, extent, mean)
    }

    fn new(settings: &Settings, share: f64, extent: f64, mean: f64) -> Self {
        Self {
            tolerance: settings.tolerance * share,
            outline_tolerance: settings.tolerance * share.min(DIRECT_SHARE),
            min_element: settings.min_element.metres(extent),
            max_level: settings.max_level,
            plain_size: PLAIN_SIZE * extent,
            mean,
        }
    }

    /// Length of the shortest sides that refinement may make, m.
    pub fn min_element(&self) -> f64 {
        self.min_element
    }

    /// True if an element may be divided at all.
    pub fn may_divide(&self, mesh: &Mesh, element: ElementId) -> bool {
        let [width, height] = mesh.sides(element);
        let Element { level, area, .. } = mesh[element];
        // Slivers gain nothing by being shorter.
        let is_wide = area >= LEAST_AREA * self.min_element.powi(2);
        level < self.max_level && is_wide && width.max(height) >= 2.0 * self.min_element
    }

    /// How to divide an element, by the `light` (W/m² of radiosity) known at its corners and `middle`, and by whether
    /// light `is_off` elsewhere on it by more than an error, W/m²; `None` if interpolation will do.
    pub fn judge(
        &self,
        sample: &Sample<'_>,
        middle: &Middle,
        light: impl Fn(VertexId) -> Rgb,
        is_off: impl FnOnce(f64) -> bool,
    ) -> Option<Split> {
        let Sample { mesh, element, .. } = *sample;
        let (errors, allowed) = (sample.errors(middle, light), self.allowed(sample));
        let round = || Some(mesh.round_split(element));
        if errors.largest() <= allowed {
            return if is_off(allowed) { round() } else { None };
        }
        let halves = (sample.corners.len() == 4)
            .then(|| halving(mesh.sides(element), &errors, allowed))
            .flatten()
            .filter(|_| !is_off(allowed));
        halves.or_else(round)
    }

    /// True if light at the corners of an element differs by less than the error that it is allowed: a facet among
    /// others like it then shows well enough how light varies.
    pub fn is_even(&self, sample: &Sample<'_>) -> bool {
        strength(sample.range()) <= self.allowed(sample)
    }

    /// True if the sides of an element are only few times as long as the shortest that refinement may make.
    pub fn is_small(&self, mesh: &Mesh, element: ElementId) -> bool {
        let [width, height] = mesh.sides(element);
        width.max(height) < FEW_SIDES * self.min_element
    }

    /// The error of interpolation found in the `middle` of an element, as a share of what it is allowed.
    pub fn excess(
        &self,
        sample: &Sample<'_>,
        middle: &Middle,
        light: impl Fn(VertexId) -> Rgb,
    ) -> f64 {
        sample.errors(middle, light).largest() / self.allowed(sample).max(f64::MIN_POSITIVE)
    }

    /// The error that an element is allowed, W/m²: a share of the geometric mean of the radiosities
    /// here and in the whole scene.
    pub fn allowed(&self, sample: &Sample<'_>) -> f64 {
        let Sample { mesh, element, ref corners } = *sample;
        let here = corners.iter().map(|&c| strength(c)).sum::<f64>() / corners.len() as f64;
        let around = (self.mean * here.max(DARKEST * self.mean)).sqrt();
        let is_beside = mesh[element].corners.iter().any(|&corner| mesh.gap_over(corner) > 0.0);
        let tolerance = if is_beside { self.outline_tolerance } else { self.tolerance };
        tolerance * around * by_size(self.plain_size, mesh[element].area)
    }

    /// The least error that an element is allowed, however little light there is, W/m².
    pub fn allowed_in_the_dark(&self, mesh: &Mesh, element: ElementId) -> f64 {
        self.allowed(&Sample::new(mesh, element, |_| Rgb::ZERO))
    }
}

/// The direction in which cutting a quadrilateral once is enough, if there is one.
fn halving(sides: [f64; 2], errors: &Errors, allowed: f64) -> Option<Split> {
    let leaves = |k: usize| errors.edges[1 - k].max(errors.across[k]);
    let stays_round = |k: usize| sides[1 - k] <= SLENDER * sides[k] / 2.0;
    let best = usize::from(leaves(1) < leaves(0));
    (leaves(best) <= RESIDUE * allowed && stays_round(best)).then_some(Split::Halves(best))
}

/// Why an element is divided like that, by the direct light known at its corners and middle.
pub(super) fn reason(
    mesh: &Mesh,
    light: &VertexLight,
    element: ElementId,
    split: Split,
    middle: &Middle,
) -> Reason {
    if matches!(split, Split::Along(_)) {
        return Reason::Discontinuity;
    }
    let places = || mesh[element].corners.iter().chain(&middle.edges).chain([&middle.centre]);
    let seen = places().filter_map(|&v| light.direct(v)).map(|d| d.visible());
    let (low, high) = seen.fold((1.0, 0.0), |(l, h): (f64, f64), s| (l.min(s), h.max(s)));
    if high - low > 1e-3 {
        return Reason::ShadowEdge;
    }
    let touches = mesh[element].corners.iter().any(|&v| mesh[v].on_contact);
    if touches { Reason::Contact } else { Reason::Gradient }
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
