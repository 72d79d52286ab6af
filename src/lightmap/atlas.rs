//! The atlas: charts for all surfaces, packed into a square, and the coarse mesh that lies in it.

use super::chart::Chart;
use super::coarse::{self, CoarseMesh};
use super::{grow, pack};
use crate::error::{Error, Result};
use crate::surface::Surfaces;

/// Texels along a side of an atlas, least and most.
pub const SIZES: std::ops::RangeInclusive<u32> = 16..=8192;

/// Where every place of the surfaces is in a square picture.
#[derive(Clone, Debug)]
pub struct Atlas {
    /// Texels along a side.
    pub size: u32,
    /// Texels to a metre, on all charts but those of surfaces beyond [`Surfaces::extent`], which get fewer.
    pub density: f64,
    /// Its parts.
    pub charts: Vec<Chart>,
    /// The chart that each surface lies on.
    pub chart_of: Vec<u32>,
    /// The surfaces, triangulated.
    pub mesh: CoarseMesh,
}

impl Atlas {
    /// Charts all surfaces, as finely as `size` texels along a side allow.
    ///
    /// # Errors
    /// When `size` is not in [`SIZES`], or too small to hold every chart.
    pub fn new(surfaces: &Surfaces, size: u32) -> Result<Self> {
        let wrong = |message| Error::Setting { name: "lightmap", message };
        if !SIZES.contains(&size) {
            let (least, most) = (SIZES.start(), SIZES.end());
            return Err(wrong(format!("a map has {least} to {most} texels along a side")));
        }
        surfaces.check()?;
        let triangulated = coarse::triangulated(surfaces);
        let groups = grow::groups(surfaces, &triangulated);
        let mut charts: Vec<Chart> =
            groups.into_iter().map(|group| Chart::new(surfaces, &triangulated, group)).collect();
        let density = pack::pack(&mut charts, size).ok_or_else(|| {
            wrong(format!("{size} texels cannot hold {} charts; try twice that", charts.len()))
        })?;
        let mut chart_of = vec![0; surfaces.list.len()];
        for (number, chart) in charts.iter().enumerate() {
            for &surface in &chart.surfaces {
                chart_of[surface as usize] = number as u32;
            }
        }
        let mesh = CoarseMesh::new(surfaces, &triangulated, |surface, place| {
            charts[chart_of[surface] as usize].texel(place) / f64::from(size)
        });
        Ok(Self { size, density, charts, chart_of, mesh })
    }
}
