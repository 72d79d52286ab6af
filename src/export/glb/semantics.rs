//! Names of the attributes that no other program writes.

/// Attribute with the radiosity, W/m² per channel; glTF puts an underscore before it.
pub(super) const RADIOSITY: &str = "RADIOSITY";

/// Attribute with the mean of the picture under a vertex, only on textured primitives.
pub(super) const TEXTURE_MEAN: &str = "TEXTURE_MEAN";

/// Attributes with the radiosity by each of the lights in `asset.extras`, at a strength of 1, W/m² per channel; a
/// number follows.
pub(super) const LIGHT: &str = "LIGHT_";
