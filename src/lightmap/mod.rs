//! Light as a picture laid on a coarse mesh: for engines that want maps rather than many vertices.
//!
//! [`Atlas::new`] cuts the surfaces into *charts*, each a part of a square picture, and triangulates them
//! as coarsely as their outlines allow; that needs no light yet. [`bake()`] fills the picture.
//!
//! A texel holds E/π, W/(m² sr): the radiance that a white diffuse surface there would send on. So
//! what is seen of a surface is albedo × texel + emission, whatever its albedo's picture.

mod bake;
mod chart;
mod coarse;
mod dilate;
mod grow;
mod overlap;
mod pack;

use glam::Vec3;

use crate::error::{Error, Result};
use crate::surface::Surfaces;

pub use bake::bake;
pub use chart::Chart;
pub use coarse::{CoarseMesh, CoarsePart};

/// Texels along a side of an atlas, least and most.
pub const SIZES: std::ops::RangeInclusive<u32> = 16..=8192;

/// Texels around a chart that repeat its border, at least. As the rectangles of charts begin and end at
/// multiples of [`BLOCK`], bilinear lookups in the map and in its first two mip levels stay in them.
pub const PADDING: u32 = 2;

/// Rectangles of charts have sides of a multiple of this many texels.
pub const BLOCK: u32 = 4;

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

/// An atlas filled with light.
#[derive(Clone, Debug)]
pub struct Lightmap<'a> {
    /// The surfaces it is the light of.
    pub surfaces: &'a Surfaces,
    /// Where they are in it.
    pub atlas: &'a Atlas,
    /// Radiance of a white diffuse surface, E/π, W/(m² sr), row by row; zero outside of charts.
    pub texels: Vec<Vec3>,
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
        let sheets = coarse::sheets(surfaces);
        let groups = grow::groups(surfaces, &sheets);
        let mut charts: Vec<Chart> =
            groups.into_iter().map(|group| Chart::new(surfaces, &sheets, group)).collect();
        let density = pack::pack(&mut charts, size).ok_or_else(|| {
            wrong(format!("{size} texels cannot hold {} charts; try twice that", charts.len()))
        })?;
        let mut chart_of = vec![0; surfaces.list.len()];
        for (number, chart) in charts.iter().enumerate() {
            for &surface in &chart.surfaces {
                chart_of[surface as usize] = number as u32;
            }
        }
        let mesh = CoarseMesh::new(surfaces, &sheets, |surface, place| {
            charts[chart_of[surface] as usize].texel(place) / f64::from(size)
        });
        Ok(Self { size, density, charts, chart_of, mesh })
    }
}
