//! Light beyond the border of what is lit, so that lookups beside it meet no darkness.

use glam::{UVec2, Vec3};

/// What is known of a texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Texel {
    /// No surface covers it.
    Outside,
    /// A surface covers it that has no light there.
    Dark,
    /// Light, W/(m² sr).
    Lit(Vec3),
}

impl Texel {
    pub(super) fn light(self) -> Option<Vec3> {
        match self {
            Self::Lit(light) => Some(light),
            Self::Outside | Self::Dark => None,
        }
    }
}

/// Gives the texels of one kind, in a rectangle, the mean light of those beside them, in so many
/// steps outward at most.
pub(super) fn dilate(texels: &mut [Texel], size: UVec2, kind: Texel, steps: u32) {
    let mut wave: Vec<usize> = (0..texels.len()).filter(|&texel| texels[texel] == kind).collect();
    for _ in 0..steps {
        let reached: Vec<(usize, Vec3)> = wave
            .iter()
            .filter_map(|&texel| Some((texel, mean_around(texels, texel, size)?)))
            .collect();
        if reached.is_empty() {
            return;
        }
        for &(texel, light) in &reached {
            texels[texel] = Texel::Lit(light);
        }
        wave = reached.iter().flat_map(|&(texel, _)| around(texel, size)).collect();
        wave.retain(|&texel| texels[texel] == kind);
        wave.sort_unstable();
        wave.dedup();
    }
}

/// The mean of the texels around one that have light.
fn mean_around(texels: &[Texel], texel: usize, size: UVec2) -> Option<Vec3> {
    let lit = || around(texel, size).filter_map(|other| texels[other].light());
    let count = lit().count() as f32;
    // Divided first: a sum could leave the range of numbers.
    (count > 0.0).then(|| lit().map(|light| light / count).sum())
}

/// The texels that touch one, within a rectangle.
fn around(texel: usize, size: UVec2) -> impl Iterator<Item = usize> {
    let (width, height) = (size.x as usize, size.y as usize);
    let (column, row) = (texel % width, texel / width);
    let rows = row.saturating_sub(1)..(row + 2).min(height);
    rows.flat_map(move |y| {
        let columns = column.saturating_sub(1)..(column + 2).min(width);
        columns.map(move |x| y * width + x)
    })
    .filter(move |&other| other != texel)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_lit_texel_fills_its_rectangle() {
        let light = Vec3::new(1.0, 2.0, 3.0);
        let mut texels = [Texel::Outside; 7 * 5];
        texels[9] = Texel::Lit(light);
        dilate(&mut texels, UVec2::new(7, 5), Texel::Outside, u32::MAX);
        let is_filled = |texel: &Texel| texel.light().is_some_and(|l| l.distance(light) < 1e-5);
        assert!(texels.iter().all(is_filled), "{texels:?}");
    }

    #[test]
    fn light_goes_outward_from_the_nearest_border_as_far_as_it_is_told() {
        let (x, y, o) = (Texel::Lit(Vec3::X), Texel::Lit(Vec3::Y), Texel::Outside);
        let row = |steps| {
            let mut texels = [x, o, o, o, o, o, y];
            dilate(&mut texels, UVec2::new(7, 1), o, steps);
            texels
        };
        assert_eq!(row(1), [x, x, o, o, o, y, y]);
        assert_eq!(row(2), [x, x, x, o, y, y, y]);
        let middle = Texel::Lit((Vec3::X + Vec3::Y) / 2.0);
        assert_eq!(row(9), [x, x, x, middle, y, y, y]);
    }

    #[test]
    fn without_any_light_nothing_changes() {
        let mut texels = [Texel::Outside; 4];
        dilate(&mut texels, UVec2::new(2, 2), Texel::Outside, u32::MAX);
        assert_eq!(texels, [Texel::Outside; 4]);
    }
}
