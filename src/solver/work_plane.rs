//! A horizontal grid of places over the floor, and how evenly it is lit.

use glam::DVec3;

use super::illuminance::Reading;
use crate::error::{Error, Result};
use crate::surface::Surfaces;
use crate::visibility::{Met, Occluders, SurfacePoint};

/// Most places of a grid.
const MOST_PLACES: f64 = 250_000.0;

/// A horizontal plane of places that face up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorkPlane {
    /// Over the lowest corner of the scene, m.
    pub height: f64,
    /// Between neighbours, along X and Z, m.
    pub spacing: f64,
}

/// How a grid is lit, lx.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Evenness {
    /// Mean of all places.
    pub mean: f64,
    /// The darkest.
    pub min: f64,
    /// The brightest.
    pub max: f64,
}

impl Evenness {
    /// Of some readings; all zero if there are none.
    pub fn of(readings: &[Reading]) -> Self {
        let Some(first) = readings.first().map(Reading::lux) else { return Self::default() };
        let lux = || readings.iter().map(Reading::lux);
        Self {
            mean: lux().sum::<f64>() / readings.len() as f64,
            min: lux().fold(first, f64::min),
            max: lux().fold(first, f64::max),
        }
    }

    /// U₀, the darkest by the mean (EN 12464-1); none where there is no light.
    pub fn uniformity(&self) -> Option<f64> {
        (self.mean > 0.0).then(|| self.min / self.mean)
    }
}

impl WorkPlane {
    /// The places of the grid, in the middle of the scene's bounding box, row by row along X: those over the front
    /// of something and not inside a solid, and their normals.
    ///
    /// # Errors
    /// When height and spacing make no plane within the scene, there are too many places, or none is left.
    pub fn places(&self, surfaces: &Surfaces) -> Result<Vec<SurfacePoint>> {
        let (low, high) = surfaces.bounds().unwrap_or_default();
        let size = high - low;
        self.check(size)?;
        let axis = |low: f64, size: f64| {
            // A width of eight spacings has eight places, whatever was rounded.
            let gaps = ((size / self.spacing - 1e-6).ceil() - 1.0).max(0.0);
            let start = low + (size - gaps * self.spacing) / 2.0;
            (0..=gaps as u32).map(move |k| start + f64::from(k) * self.spacing)
        };
        let occluders = Occluders::new(surfaces);
        let y = low.y + self.height;
        let grid =
            axis(low.z, size.z).flat_map(|z| axis(low.x, size.x).map(move |x| DVec3::new(x, y, z)));
        let is_over_floor = |place: &DVec3| is_over_floor(surfaces, &occluders, *place);
        let places: Vec<_> =
            grid.filter(is_over_floor).map(|place| SurfacePoint::new(place, DVec3::Y)).collect();
        if places.is_empty() {
            return Err(wrong(format!(
                "no place at {y} m is over the front of a floor and outside of solids; if floors face down, \
                 make surfaces two-sided"
            )));
        }
        Ok(places)
    }

    fn check(&self, size: DVec3) -> Result<()> {
        let Self { height, spacing } = *self;
        if !(spacing.is_finite() && spacing > 0.0) {
            return Err(wrong(format!("{spacing} is no distance between places")));
        }
        if !(height > 0.0 && height < size.y) {
            return Err(wrong(format!(
                "{height} m is not between floor and top, 0 and {} m",
                size.y
            )));
        }
        let count = (size.x / spacing).ceil() * (size.z / spacing).ceil();
        if count > MOST_PLACES {
            return Err(wrong(format!(
                "{count:.0} places are more than {MOST_PLACES}; space them wider"
            )));
        }
        Ok(())
    }
}

fn wrong(message: String) -> Error {
    Error::Setting { name: "grid", message }
}

/// Whether what is straight below a place shows its front, and not most of what is around it its back.
fn is_over_floor(surfaces: &Surfaces, occluders: &Occluders, place: DVec3) -> bool {
    let shows_back = |met: &Met| !met.front && !surfaces[met.surface].two_sided;
    let below = occluders.first(place, DVec3::NEG_Y);
    if below.is_none_or(|met| shows_back(&met)) {
        return false;
    }
    let mut ways = [-1.0, 0.0, 1.0]
        .into_iter()
        .flat_map(|x| [-1.0, 0.0, 1.0].map(|y| (x, y)))
        .flat_map(|(x, y)| [-1.0, 0.0, 1.0].map(|z| DVec3::new(x, y, z)))
        .filter_map(DVec3::try_normalize)
        .collect::<Vec<_>>();
    let all = ways.len();
    ways.retain(|&way| occluders.first(place, way).is_some_and(|met| shows_back(&met)));
    2 * ways.len() <= all
}
