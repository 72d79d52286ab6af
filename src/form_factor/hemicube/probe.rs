//! Whether polygons are seen that fall between the centres of cells.

use glam::DVec3;

use super::look::Hemicube;

/// What is met before this share of the way to a place is surely before it.
const BEFORE: f64 = 0.99;

impl Hemicube<'_> {
    /// Whether the middle of what is above the horizon of a polygon that covers no cell's centre is
    /// seen, 0 or 1.
    pub(super) fn probe_centre(&self, corners: &[DVec3]) -> f64 {
        let above = self.frame.above().clip(corners);
        let middle = above.iter().sum::<DVec3>() / above.len().max(1) as f64;
        let is_seen =
            || !self.is_surely_hidden(middle) && !self.occluders.blocks(self.frame.eye, middle);
        f64::from(u8::from(!above.is_empty() && is_seen()))
    }

    /// True if all cells around the direction of a place above the horizon see one patch, and it hides the place.
    fn is_surely_hidden(&self, place: DVec3) -> bool {
        let way = place - self.frame.eye;
        let Some(item) = self.buffer.item_around((self.frame.axes * way).as_vec3()) else {
            return false;
        };
        // The share of the way at which the patch's plane is met.
        let slope = self.scene.normal(item as usize).dot(way);
        let met = -self.scene.height(item as usize, self.frame.eye) / slope;
        met > 0.0 && met < BEFORE
    }
}
