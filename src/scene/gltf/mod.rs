//! glTF 2.0 and GLB: parsed by the `gltf` crate, every number checked here before it is used.
//!
//! | what | where |
//! |---|---|
//! | the file | `file`, its `extensions`; what these compress is `packed`; numbers by `accessors` |
//! | what becomes of it | `materials`, then an `import` by `nodes`: `primitives` in their `pose`, `lights` |

mod accessors;
mod extensions;
mod file;
mod import;
mod lights;
mod materials;
mod nodes;
mod packed;
mod pose;
mod primitives;

use std::path::Path;

use self::file::GltfFile;
use self::import::GltfImport;
pub(crate) use self::materials::sampler_of;
use super::{LoadOptions, Scene};
use crate::error::Result;

/// Reads the glTF or GLB file at `path` with its buffers and pictures.
pub(super) fn read(path: &Path, options: &LoadOptions) -> Result<Scene> {
    let mut notes = Vec::new();
    let mut file = GltfFile::open(path, &mut notes)?;
    file.unpack()?;
    let mut scene = Scene { files: file.files(), notes, ..Scene::default() };
    let materials = materials::read(&file, &mut scene)?;
    let mut import = GltfImport::new(&file, scene, materials.mappings);
    import.add_nodes()?;
    import.note_lights(options.emission);
    import.note_skipped();
    import.note_extensions();
    import.scene.leave_out(&materials.clear);
    Ok(import.scene)
}
