//! Rectangles into a square, as large as they fit.

use crunch::{Item, Rect, Rotation};
use glam::UVec2;

use super::chart::{BLOCK, Chart};

/// Halvings of the range of densities.
const HALVINGS: usize = 14;

/// Puts all charts into a square of `size` texels; returns the texels to a metre, or `None` if the charts
/// do not fit with a texel each.
pub(super) fn pack(charts: &mut [Chart], size: u32) -> Option<f64> {
    let blocks = size / BLOCK;
    let area: f64 = charts.iter().map(Chart::weight).sum();
    // No more fits than the rectangles' own area, and what is a thousandth of that is as good as nothing.
    let most = f64::from(size) / area.max(f64::MIN_POSITIVE).sqrt();
    // Turning rectangles helps most atlases and harms some.
    let fitted = |charts: &[Chart], density| {
        let mut either = [Rotation::Allowed, Rotation::None].into_iter();
        either.find_map(|rotation| packed(charts, density, blocks, rotation))
    };
    let mut best = (0.0, fitted(charts, 0.0)?);
    let (mut low, mut high) = (most / 1000.0, most);
    for _ in 0..HALVINGS {
        let density = (low * high).sqrt();
        match fitted(charts, density) {
            Some(places) => {
                low = density;
                best = (density, places);
            }
            None => high = density,
        }
    }
    let (density, places) = best;
    for (chart, PackedRect { corner, is_turned }) in charts.iter_mut().zip(places) {
        if is_turned {
            chart.turn();
        }
        chart.put(corner, density);
    }
    Some(density)
}

/// Where a rectangle has come to lie.
#[derive(Clone, Copy, Default)]
struct PackedRect {
    /// Its first block.
    corner: UVec2,
    is_turned: bool,
}

/// The places of the charts' rectangles, if all fit.
fn packed(
    charts: &[Chart],
    density: f64,
    blocks: u32,
    rotation: Rotation,
) -> Option<Vec<PackedRect>> {
    let sizes: Vec<UVec2> = charts.iter().map(|chart| chart.blocks(density)).collect();
    let area: u64 = sizes.iter().map(|size| u64::from(size.x) * u64::from(size.y)).sum();
    if area > u64::from(blocks) * u64::from(blocks) {
        return None;
    }
    let item = |(number, size): (usize, &UVec2)| {
        Item::new(number, size.x as usize, size.y as usize, rotation)
    };
    let square = Rect::of_size(blocks as usize, blocks as usize);
    let packed = crunch::pack(square, sizes.iter().enumerate().map(item)).ok()?;
    let mut places = vec![PackedRect::default(); charts.len()];
    for item in packed {
        let corner = UVec2::new(item.rect.x as u32, item.rect.y as u32);
        places[item.data] =
            PackedRect { corner, is_turned: item.rect.w as u32 != sizes[item.data].x };
    }
    Some(places)
}
