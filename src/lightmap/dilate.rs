//! Light beyond the border of surfaces, so that lookups beside it meet no darkness.

use glam::{UVec2, Vec3};

/// The texels of a rectangle, those without light given that of the nearest ones that have it.
pub(super) fn dilate(texels: Vec<Option<Vec3>>, size: UVec2) -> Vec<Vec3> {
    let mut known = texels;
    let mut wave: Vec<usize> = (0..known.len()).filter(|&texel| known[texel].is_none()).collect();
    // At first only those beside a texel that has light; all others follow from their neighbours.
    wave.retain(|&texel| mean_around(&known, texel, size).is_some());
    while !wave.is_empty() {
        let reached: Vec<(usize, Option<Vec3>)> =
            wave.iter().map(|&texel| (texel, mean_around(&known, texel, size))).collect();
        for (texel, light) in reached {
            known[texel] = light;
        }
        wave = wave.iter().flat_map(|&texel| around(texel, size)).collect();
        wave.retain(|&texel| known[texel].is_none());
        wave.sort_unstable();
        wave.dedup();
    }
    known.into_iter().map(Option::unwrap_or_default).collect()
}

/// The mean of the texels around one that have light.
fn mean_around(known: &[Option<Vec3>], texel: usize, size: UVec2) -> Option<Vec3> {
    let lit = || around(texel, size).filter_map(|other| known[other]);
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
        let mut texels = vec![None; 7 * 5];
        texels[9] = Some(Vec3::new(1.0, 2.0, 3.0));
        let filled = dilate(texels, UVec2::new(7, 5));
        assert!(filled.iter().all(|texel| texel.distance(Vec3::new(1.0, 2.0, 3.0)) < 1e-5));
    }

    #[test]
    fn a_texel_beyond_a_border_has_the_light_of_that_border() {
        let texels = [Some(Vec3::X), None, None, None, None, Some(Vec3::Y)];
        let filled = dilate(texels.to_vec(), UVec2::new(6, 1));
        assert_eq!(filled, [Vec3::X, Vec3::X, Vec3::X, Vec3::Y, Vec3::Y, Vec3::Y]);
    }

    #[test]
    fn darkness_without_any_light_is_black() {
        assert_eq!(dilate(vec![None; 4], UVec2::new(2, 2)), [Vec3::ZERO; 4]);
    }
}
