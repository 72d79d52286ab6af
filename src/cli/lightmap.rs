//! `solve --lightmap`: light as a picture on a coarse mesh.

use std::path::PathBuf;

use clap::Args;
use radiosity::export::{Stamp, check_writable_lightmap, lightmap_files, save_lightmap};
use radiosity::lightmap::{Atlas, SIZES, bake};
use radiosity::render::{Solved, Subject};
use radiosity::{Result, Surfaces};

use super::meter::Meter;

/// The lightmap to write.
#[derive(Debug, Args)]
#[command(next_help_heading = "Writing")]
pub(crate) struct LightmapOptions {
    /// Lightmap to write: the surfaces without refinement, and beside FILE.glb the maps of their light
    ///
    /// FILE.glb has second texture coordinates for the maps, and materials with the surfaces' own colours,
    /// pictures and emission. FILE.lightmap.exr holds linear light, irradiance by π: what is seen is
    /// albedo × texel + emission, in W/(m² sr). FILE.lightmap.png is the same exposed as the colours of other
    /// outputs are, sRGB.
    #[arg(long, value_name = "FILE.glb")]
    pub(crate) lightmap: Option<PathBuf>,

    /// With --lightmap: texels along a side of the square maps, 16 to 8192
    #[arg(long, value_name = "TEXELS", default_value_t = 1024, requires = "lightmap")]
    #[arg(value_parser = clap::value_parser!(u32).range(i64::from(*SIZES.start())..=i64::from(*SIZES.end())))]
    lightmap_size: u32,
}

impl LightmapOptions {
    /// Whether the files could be written.
    pub(crate) fn check(&self) -> Result<()> {
        self.lightmap.as_deref().map_or(Ok(()), check_writable_lightmap)
    }

    /// The files to write.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        self.lightmap.as_deref().map_or_else(Vec::new, |path| lightmap_files(path).to_vec())
    }

    /// The place of every surface in the maps, found before long work.
    pub(crate) fn atlas(&self, surfaces: &Surfaces) -> Result<Option<Atlas>> {
        self.lightmap.as_ref().map(|_| Atlas::new(surfaces, self.lightmap_size)).transpose()
    }

    /// Writes the files, if they are asked for.
    pub(crate) fn write(
        &self,
        atlas: Option<&Atlas>,
        subject: &Subject<'_>,
        stamp: &Stamp,
        meter: &mut Meter,
    ) -> Result<()> {
        let wanted = self.lightmap.as_ref().zip(atlas).zip(subject.solved);
        let Some(((path, atlas), Solved { surfaces, solution, .. })) = wanted else {
            return Ok(());
        };
        meter.begin("lightmap");
        let map = bake(surfaces, atlas, solution, subject.mesh);
        save_lightmap(&map, subject.mesh, path, stamp)?;
        let (charts, density) = (atlas.charts.len(), atlas.density);
        meter.tell(&format!("lightmap of {charts} charts, {density:.1} texels to a metre"));
        Ok(())
    }
}
