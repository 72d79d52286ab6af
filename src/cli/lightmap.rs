//! `solve --lightmap`: light as a picture on a coarse mesh.

use std::path::PathBuf;

use clap::Args;
use radiosity::export::{Stamp, check_writable_lightmap, lightmap_files, save_lightmap};
use radiosity::lightmap::{Atlas, SIZES, bake};
use radiosity::render::{Solved, Subject};
use radiosity::{Error, Result, Surfaces};

use super::meter::Meter;
use super::streams::Streams;

/// The lightmap to write.
#[derive(Debug, Args)]
#[command(next_help_heading = "Writing")]
pub(crate) struct LightmapOptions {
    /// Write a lightmap, too: the surfaces without refinement, and square maps of their light, 16 to 8192 texels wide
    ///
    /// Beside the first output, `room.glb`: `room.lightmap.glb` with second texture coordinates for the maps, and materials
    /// with the surfaces' own colours, pictures and emission; `room.lightmap.exr` with linear light, irradiance by π: what
    /// is seen is albedo × texel + emission, in W/(m² sr); `room.lightmap.png`, the same exposed as the colours of other
    /// outputs are, sRGB.
    #[arg(long, value_name = "SIZE", requires = "output")]
    #[arg(value_parser = clap::value_parser!(u32).range(i64::from(*SIZES.start())..=i64::from(*SIZES.end())))]
    lightmap: Option<u32>,
}

impl LightmapOptions {
    /// Whether the files could be written.
    pub(crate) fn check(&self, outputs: &[PathBuf], streams: &Streams) -> Result<()> {
        if self.lightmap.is_some() && outputs.first().is_some_and(|first| streams.holds(first)) {
            let message = "takes its name from the first -o, which must be a file".to_owned();
            return Err(Error::Setting { name: "lightmap", message });
        }
        self.path(outputs).as_deref().map_or(Ok(()), check_writable_lightmap)
    }

    /// The files to write beside other outputs.
    pub(crate) fn files(&self, outputs: &[PathBuf]) -> Vec<PathBuf> {
        self.path(outputs).map_or_else(Vec::new, |path| lightmap_files(&path).to_vec())
    }

    fn path(&self, outputs: &[PathBuf]) -> Option<PathBuf> {
        self.lightmap.and(outputs.first()).map(|output| output.with_extension("lightmap.glb"))
    }

    /// Texels of its maps.
    pub(crate) fn texels(&self) -> u64 {
        self.lightmap.map_or(0, |size| u64::from(size).pow(2))
    }

    /// The place of every surface in the maps, found before long work, if they are asked for.
    pub(crate) fn plan(
        &self,
        surfaces: &Surfaces,
        outputs: &[PathBuf],
    ) -> Result<Option<PlannedLightmap>> {
        let Some((size, path)) = self.lightmap.zip(self.path(outputs)) else {
            return Ok(None);
        };
        Ok(Some(PlannedLightmap { atlas: Atlas::new(surfaces, size)?, path }))
    }
}

/// A lightmap without light yet.
#[derive(Debug)]
pub(crate) struct PlannedLightmap {
    atlas: Atlas,
    path: PathBuf,
}

impl PlannedLightmap {
    /// Writes the files of it with the light of a solution.
    pub(crate) fn write(
        &self,
        subject: &Subject<'_>,
        stamp: &Stamp,
        meter: &mut Meter,
    ) -> Result<()> {
        let Some(Solved { surfaces, solution, .. }) = subject.solved else {
            return Ok(());
        };
        meter.begin("lightmap");
        let map = bake(surfaces, &self.atlas, solution, subject.mesh);
        save_lightmap(&map, subject.mesh, &self.path, stamp)?;
        let (charts, density) = (self.atlas.charts.len(), self.atlas.density);
        meter.tell(&format!("lightmap of {charts} charts, {density:.1} texels to a metre"));
        Ok(())
    }
}
