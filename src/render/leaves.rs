//! What is known of leaves: their level, why they were made, and how good they are.

use super::colours::{self, Swatch};
use super::subject::Solved;
use crate::colour::Rgb;
use crate::mesh::{ElementId, Mesh, Reason, VertexId};
use crate::refine::{Oracle, Sample};
use crate::solver::{Solution, mean_radiosity_shown};

/// Names of what makes leaves, in the order of their colours.
pub(crate) const REASONS: [&str; 6] =
    ["whole patch", "uniform mesh", "gradient", "shadow edge", "contact", "discontinuity line"];

/// Colours of elements by their level, linear, and what they stand for.
pub(super) fn levels(mesh: &Mesh) -> (Vec<Rgb>, Vec<Swatch>) {
    let by_element = level_numbers(mesh);
    let deepest = by_element.iter().copied().max().unwrap_or(0);
    let names = (0..=deepest).map(|level| level.to_string());
    coloured(by_element.into_iter(), names.zip(colours::steps(deepest + 1)).collect())
}

/// Levels by element.
pub(crate) fn level_numbers(mesh: &Mesh) -> Vec<usize> {
    mesh.elements.iter().map(|element| element.level as usize).collect()
}

/// Colours of elements by why their parents were divided, linear, and what they stand for.
pub(super) fn reasons(mesh: &Mesh) -> (Vec<Rgb>, Vec<Swatch>) {
    let names = REASONS.iter().map(|&name| name.to_owned());
    coloured(reason_numbers(mesh).into_iter(), names.zip(colours::CATEGORIES).collect())
}

/// Why the parents of elements were divided, by element, as indices into [`REASONS`].
pub(crate) fn reason_numbers(mesh: &Mesh) -> Vec<usize> {
    let mut by_element = vec![0; mesh.elements.len()];
    for element in &mesh.elements {
        for child in &element.children {
            by_element[child.index()] = match element.reason {
                None => 0,
                Some(Reason::Uniform) => 1,
                Some(Reason::Gradient) => 2,
                Some(Reason::ShadowEdge) => 3,
                Some(Reason::Contact) => 4,
                Some(Reason::Discontinuity) => 5,
            };
        }
    }
    by_element
}

/// Looks colours up; the key has only those that are there.
fn coloured(
    by_element: impl Iterator<Item = usize> + Clone,
    key: Vec<(String, [u8; 3])>,
) -> (Vec<Rgb>, Vec<Swatch>) {
    let mut there = vec![false; key.len()];
    by_element.clone().for_each(|number| there[number] = true);
    let values = by_element.map(|number| colours::linear(key[number].1)).collect();
    let swatch = |(name, colour)| Swatch { name, colour };
    let key = key.into_iter().zip(there).filter(|(_, there)| *there);
    (values, key.map(|(entry, _)| swatch(entry)).collect())
}

/// Errors of interpolation in the middle of leaves, by element, as shares of what the settings
/// allow: the larger of that of direct light and, where it was gathered, of indirect light.
pub(super) fn errors(solved: &Solved<'_>) -> Vec<Rgb> {
    let Solution { mesh, optics, vertex_light: light, .. } = solved.solution;
    let Solved { surfaces, settings, .. } = solved;
    let of_direct_light = Oracle::of_direct_light(settings, surfaces.extent, mesh, optics, light);
    let mean = mean_radiosity_shown(solved.solution);
    let of_reflected_light = Oracle::of_reflected_light(settings, surfaces.extent, mean);
    let error = |leaf: ElementId| {
        let middle = mesh.find_middle(leaf)?;
        let excess = |oracle: &Oracle, shown: &dyn Fn(VertexId) -> Rgb| {
            oracle.excess(&Sample::new(mesh, leaf, shown), &middle, shown)
        };
        let of_direct = excess(
            &of_direct_light,
            &optics.reflected(&mesh[leaf], |v| light.direct_irradiance(v)),
        );
        let mut places = middle.edges.iter().chain([&middle.centre]);
        if places.any(|&v| light.indirect(v).is_none()) {
            return Some(of_direct);
        }
        let indirect = optics.reflected(&mesh[leaf], |v| light.indirect(v).unwrap_or(Rgb::ZERO));
        Some(of_direct.max(excess(&of_reflected_light, &indirect)))
    };
    let mut errors = vec![Rgb::ZERO; mesh.elements.len()];
    for leaf in mesh.leaves() {
        errors[leaf.index()] = Rgb::splat(error(leaf).unwrap_or(0.0));
    }
    errors
}
