//! Which extensions of the format are read.

pub(super) const MESHOPT: &str = "EXT_meshopt_compression";
pub(super) const DRACO: &str = "KHR_draco_mesh_compression";

/// Required extensions that are read, or whose absence leaves diffuse light as it is.
const READABLE: [&str; 8] = [
    DRACO,
    MESHOPT,
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
];

/// Whether an extension is read, or says nothing about diffuse light.
pub(super) fn is_readable(name: &str) -> bool {
    READABLE.contains(&name) || name.starts_with("KHR_materials_")
}
