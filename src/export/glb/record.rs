//! What a solved GLB says about itself, in `asset.extras`.

use gltf_json::extras::RawValue;
use serde::{Deserialize, Serialize};

use crate::export::exposed::{ExposedMesh, TONE_CURVE};
use crate::export::stamp::Stamp;
use crate::surface::LightGroup;
use crate::tone::{Exposure, exposure_value};

/// The contents of `asset.extras`.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct GlbRecord {
    version: String,
    /// Of `_RADIOSITY`.
    unit: String,
    exposure: ExposureRecord,
    tone_curve: String,
    settings: serde_json::Value,
    finished: bool,
    /// Lights whose radiosities are kept apart, as `_LIGHT_0` and so on, at a strength of 1.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) lights: Vec<LightGroup>,
}

#[derive(Debug, Serialize, Deserialize)]
struct ExposureRecord {
    automatic: bool,
    /// Exposure value at ISO 100, chosen or found.
    ev: f64,
    /// Factor on radiosity before the tone curve, m²/W.
    scale: f64,
}

impl GlbRecord {
    pub(super) fn new(exposed: &ExposedMesh) -> Self {
        let (automatic, ev) = match exposed.stamp.exposure {
            Exposure::Automatic => (true, exposure_value(exposed.scale)),
            Exposure::Found(ev) => (true, ev),
            Exposure::Ev(ev) => (false, ev),
        };
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            unit: "W/m^2".to_owned(),
            exposure: ExposureRecord { automatic, ev, scale: exposed.scale },
            tone_curve: TONE_CURVE.to_owned(),
            settings: exposed.stamp.settings.clone(),
            finished: exposed.stamp.finished,
            lights: exposed.mesh.lights.iter().map(|light| light.group.clone()).collect(),
        }
    }

    pub(super) fn to_raw(&self) -> serde_json::Result<Box<RawValue>> {
        serde_json::value::to_raw_value(self)
    }

    /// The stamp that the file was written with.
    pub(super) fn into_stamp(self) -> Stamp {
        let exposure = if self.exposure.automatic {
            Exposure::Automatic
        } else {
            Exposure::Ev(self.exposure.ev)
        };
        Stamp { exposure, settings: self.settings, finished: self.finished }
    }
}

/// The `extras` of a texture whose picture was brightened to be shown.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Brightened {
    /// What white in the picture stands for, 0..=1.
    pub(super) white: f64,
}

impl Brightened {
    pub(super) fn to_raw(&self) -> serde_json::Result<Box<RawValue>> {
        serde_json::value::to_raw_value(self)
    }
}
