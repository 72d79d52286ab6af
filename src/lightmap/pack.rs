//! Rectangles into a square, as large as they fit.

use crunch::{Item, Rect, Rotation};
use glam::UVec2;

use super::{BLOCK, Chart};

/// Halvings of the range of densities.
const HALVINGS: usize = 14;

/// Puts all charts into a square of `size` texels; returns the texels to a metre, or `None` if the charts
/// do not fit with a texel each.
pub(super) fn pack(charts: &mut [Chart], size: u32) -> Option<f64> {
    let blocks = size / BLOCK;
    let area: f64 = charts.iter().map(Chart::weight).sum();
    // No more fits than the rectangles' own area, and what is a thousandth of that is as good as nothing.
    let most = f64::from(size) / area.max(f64::MIN_POSITIVE).sqrt();
    let mut best = (0.0, packed(charts, 0.0, blocks)?);
    let (mut low, mut high) = (most / 1000.0, most);
    for _ in 0..HALVINGS {
        let density = (low * high).sqrt();
        match packed(charts, density, blocks) {
            Some(corners) => {
                low = density;
                best = (density, corners);
            }
            None => high = density,
        }
    }
    let (density, corners) = best;
    for (chart, corner) in charts.iter_mut().zip(corners) {
        chart.put(corner, density);
    }
    Some(density)
}

/// The first block of each chart's rectangle, if all fit.
fn packed(charts: &[Chart], density: f64, blocks: u32) -> Option<Vec<UVec2>> {
    let sizes: Vec<UVec2> = charts.iter().map(|chart| chart.blocks(density)).collect();
    let area: u64 = sizes.iter().map(|size| u64::from(size.x) * u64::from(size.y)).sum();
    if area > u64::from(blocks) * u64::from(blocks) {
        return None;
    }
    let item = |(number, size): (usize, &UVec2)| {
        Item::new(number, size.x as usize, size.y as usize, Rotation::None)
    };
    let square = Rect::of_size(blocks as usize, blocks as usize);
    let packed = crunch::pack(square, sizes.iter().enumerate().map(item)).ok()?;
    let mut corners = vec![UVec2::ZERO; charts.len()];
    for item in packed {
        corners[item.data] = UVec2::new(item.rect.x as u32, item.rect.y as u32);
    }
    Some(corners)
}
