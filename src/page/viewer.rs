//! A lit mesh that can be turned.

use maud::{Markup, html};
use serde::Serialize;

use super::chunks::Chunks;
use super::data::inert;
use super::image::image;
use super::model::{Model, Packed};
use super::pictures::{PictureRecord, PictureSet};
use super::{base64, colour_maps};
use crate::render::{colours, leaves};
use crate::scene::Camera;
use crate::tone::exposure_value;

/// What a viewer shows, and from where at first.
#[derive(Clone, Copy, Debug)]
pub struct Viewer<'a> {
    /// At least one; of more, a slider chooses, at first the last.
    pub steps: &'a [Step],
    /// From where it is seen at first. Its picture is upright, whatever is up in the camera's.
    pub camera: &'a Camera,
    /// Factor on radiosity, m²/W, from [`crate::tone::exposure_scale`]; a slider changes it.
    pub exposure: f64,
    /// Viewers of one group move together, show the same quantity and have the same scales.
    pub group: &'a str,
    /// What there is to see, for those who do not see it.
    pub alt: &'a str,
    /// Below the viewer; nothing if empty.
    pub caption: &'a str,
    /// A picture, a PNG, for readers without scripts or WebGL, and of the viewer's shape, width to height.
    pub still: Option<&'a [u8]>,
}

/// A mesh among those that a viewer shows one after another.
#[derive(Clone, Debug)]
pub struct Step {
    /// What tells it from the others, a few words.
    pub label: String,
    /// The mesh.
    pub model: Model,
}

/// The viewer's settings and meshes as `viewer.js` reads them.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct ViewerRecord<'a> {
    camera: ViewerCamera,
    /// Factor on radiosity, m²/W, and the same as an exposure value.
    exposure: f64,
    ev: f64,
    /// Ends of scales: radiosity, W/m²; relative errors; levels.
    range: [f64; 2],
    error_limit: f64,
    deepest: u8,
    modes: Vec<&'static str>,
    /// Colours, sRGB-coded, and names.
    reasons: Vec<([u8; 3], &'static str)>,
    viridis: String,
    diverging: String,
    steps: Vec<StepRecord<'a>>,
    /// What lies on surfaces.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pictures: Vec<PictureRecord>,
    chunks: Vec<String>,
}

#[derive(Serialize)]
struct ViewerCamera {
    eye: [f64; 3],
    target: [f64; 3],
    up: [f64; 3],
    /// Radians.
    fov: f64,
}

#[derive(Serialize)]
struct StepRecord<'a> {
    label: &'a str,
    #[serde(flatten)]
    model: Packed,
}

/// A mesh to turn, shift and zoom, by mouse, touch or keys: as the eye would see it, in false
/// colours, by level and reason of its elements and by error, as far as its models know, with the
/// triangles drawn over it at will. The pictures on its surfaces can be taken away, to see the light alone.
///
/// Fronts only are drawn, so that one looks into a room from outside. Without steps there is nothing.
pub fn viewer(viewer: &Viewer<'_>) -> Markup {
    if viewer.steps.is_empty() {
        return Markup::default();
    }
    let (record, limit) = record(viewer);
    html! {
        figure.viewer data-group=(viewer.group) {
            div.stage {
                @if let Some(png) = viewer.still { div.still { (image(png, viewer.alt)) } }
                canvas tabindex="0" role="img" aria-label=(viewer.alt) {}
                p.message hidden role="status" {}
                noscript { p { "With scripts allowed, this can be turned and looked at in other ways." } }
            }
            figcaption {
                @if !viewer.caption.is_empty() { (viewer.caption) }
                @if let Some(side) = limit {
                    " Pictures on surfaces are kept small: " (side) " texels a side at most."
                }
                span.hint {
                    "Drag to turn, with shift or the right button to shift; wheel or pinch to zoom; \
                     arrow keys, + and \u{2212} do the same, 0 goes back."
                }
            }
            script type="application/json" { (inert(&record)) }
        }
    }
}

/// What the scripts get, and how many texels a side has at most where that is less than there were.
fn record<'a>(viewer: &Viewer<'a>) -> (ViewerRecord<'a>, Option<u32>) {
    let models = || viewer.steps.iter().map(|step| &step.model);
    let (mut chunks, mut gallery) = (Chunks::default(), PictureSet::default());
    let step = |step: &'a Step| StepRecord {
        label: &step.label,
        model: step.model.packed(&mut chunks, &mut gallery),
    };
    let steps = viewer.steps.iter().map(step).collect();
    let (pictures, limit) = gallery.packed(&mut chunks);
    let Camera { eye, target, up, vertical_fov, .. } = viewer.camera;
    let record = ViewerRecord {
        camera: ViewerCamera {
            eye: eye.to_array(),
            target: target.to_array(),
            up: up.to_array(),
            fov: *vertical_fov,
        },
        exposure: viewer.exposure,
        ev: exposure_value(viewer.exposure),
        range: [
            models().map(|model| model.range[0]).fold(f64::INFINITY, f64::min),
            models().map(|model| model.range[1]).fold(0.0, f64::max),
        ],
        error_limit: models().map(|model| model.error_limit).fold(0.0, f64::max),
        deepest: models().map(Model::deepest).max().unwrap_or(0),
        modes: modes(models),
        reasons: colours::CATEGORIES.into_iter().zip(leaves::REASONS).collect(),
        viridis: base64::coded(&colour_maps::viridis()),
        diverging: base64::coded(&colour_maps::diverging()),
        steps,
        pictures,
        chunks: chunks.0,
    };
    (record, limit)
}

/// Names, as `viewer.js` has them, of what can be shown.
fn modes<'a, Models: Iterator<Item = &'a Model>>(models: impl Fn() -> Models) -> Vec<&'static str> {
    let mut modes = vec!["light", "radiosity"];
    if models().any(Model::has_leaves) {
        modes.extend(["level", "reason"]);
    }
    if models().any(Model::has_errors) {
        modes.push("error");
    }
    modes
}
