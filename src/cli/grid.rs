//! `solve --grid`: illuminance on a work plane.

use std::fmt::{self, Display, Formatter};
use std::path::PathBuf;

use clap::Args;
use radiosity::export::save_grid;
use radiosity::render::Solved;
use radiosity::solver::{Evenness, WorkPlane, read};
use radiosity::visibility::SurfacePoint;
use radiosity::{Error, Surfaces};
use serde::Serialize;

use super::interrupt::Interrupt;
use super::meter::Meter;
use super::options::values::number;

/// Where illuminance is to be told, and where to write it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Work plane")]
pub(crate) struct GridOptions {
    /// Illuminance on a horizontal grid: height over the scene's lowest point, and spacing, in metres
    ///
    /// Places over a floor's front and outside of solids. Told are mean, least and most lux, and their uniformity
    /// U0, least by mean. Direct light is exact; reflected light is looked for from each place.
    #[arg(long, value_name = "HEIGHT,SPACING", value_parser = work_plane)]
    pub(crate) grid: Option<WorkPlane>,

    /// The grid to write: x,y,z,nx,ny,nz in metres, and `E_lux`, `direct_lux`, `indirect_lux`
    #[arg(long, value_name = "FILE.csv", requires = "grid")]
    pub(crate) grid_csv: Option<PathBuf>,
}

/// Illuminance on a grid, lx.
#[derive(Debug, Serialize)]
pub(crate) struct GridFigures {
    /// Over the lowest point of the scene, m.
    height: f64,
    /// m.
    spacing: f64,
    places: usize,
    mean: f64,
    min: f64,
    max: f64,
    /// The darkest by the mean; null without light.
    uniformity: Option<f64>,
}

impl GridOptions {
    /// Its places, found before long work, if it is asked for.
    pub(crate) fn plan(&self, surfaces: &Surfaces) -> Result<Option<PlannedGrid>, Error> {
        let Some(plane) = self.grid else { return Ok(None) };
        let places = plane.places(surfaces)?;
        Ok(Some(PlannedGrid { plane, places, csv: self.grid_csv.clone() }))
    }
}

/// A grid without light yet.
#[derive(Debug)]
pub(crate) struct PlannedGrid {
    plane: WorkPlane,
    /// Each with the normal of the plane.
    places: Vec<SurfacePoint>,
    csv: Option<PathBuf>,
}

impl PlannedGrid {
    /// Reads the grid off a solution and writes it.
    pub(crate) fn read(
        &self,
        Solved { surfaces, settings, solution }: Solved<'_>,
        interrupt: &Interrupt,
        meter: &mut Meter,
    ) -> Result<Option<GridFigures>, Error> {
        meter.begin("grid");
        let readings = read(surfaces, settings, solution, &self.places, |done| {
            meter.advance("grid", done);
            interrupt.go_on()
        });
        if let Some(path) = &self.csv {
            save_grid(&readings, path)?;
        }
        if readings.is_empty() {
            return Ok(None);
        }
        let evenness = Evenness::of(&readings);
        let uniformity = evenness.uniformity();
        let (Evenness { mean, min, max }, places) = (evenness, readings.len());
        let WorkPlane { height, spacing } = self.plane;
        Ok(Some(GridFigures { height, spacing, places, mean, min, max, uniformity }))
    }
}

impl Display for GridFigures {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { height, places, mean, min, max, uniformity, .. } = self;
        write!(
            f,
            "grid       {places} places at {height} m: mean {mean:.1} lx, {min:.1} to {max:.1} lx, "
        )?;
        match uniformity {
            Some(uniformity) => write!(f, "U0 {uniformity:.2}"),
            None => write!(f, "in darkness, without a U0"),
        }
    }
}

/// `0.75,0.5`.
fn work_plane(text: &str) -> Result<WorkPlane, String> {
    let above_zero = |text: &str| number(text.trim()).ok().filter(|metres| *metres > 0.0);
    let parts = text.split_once(',');
    parts
        .and_then(|(height, spacing)| {
            Some(WorkPlane { height: above_zero(height)?, spacing: above_zero(spacing)? })
        })
        .ok_or_else(|| "write HEIGHT,SPACING in metres, as in 0.75,0.5".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_work_plane_has_a_height_and_a_spacing() {
        assert_eq!(work_plane("0.75, 0.5"), Ok(WorkPlane { height: 0.75, spacing: 0.5 }));
        for wrong in ["", "1", "0,1", "1,0", "1,2,3", "nan,1"] {
            assert!(work_plane(wrong).is_err(), "{wrong}");
        }
    }
}
