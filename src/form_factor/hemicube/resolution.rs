//! How many cells are enough.

/// At more patches to a cell, rays find what cells see sooner than projection: at 2.3 to a cell, in a room with a leafy
/// plant, the exchange takes two thirds of the time.
const CROWDED: usize = 2;

/// Numbers of cells along an edge to choose from.
const CELLS: [usize; 4] = [16, 24, 32, 64];

/// Fewer patches than this never outnumber a hemicube's cells so much.
pub(super) const MANY: usize = CROWDED * 3 * CELLS[0] * CELLS[0];

/// Share of a tolerance that visibility may be wrong by.
const SHARE: f64 = 0.12;

/// True if so many patches outnumber a hemicube's cells, with so many along its edge, by so much that it looks by rays.
pub(super) fn is_by_rays(patches: usize, resolution: usize) -> bool {
    patches > CROWDED * 3 * resolution * resolution
}

/// Cells along the edge of a hemicube over so many patches: as few as a relative tolerance of light admits, where rays
/// fill them and fewer are quicker; else the `most`.
pub(crate) fn enough_cells(patches: usize, tolerance: f64, most: usize) -> usize {
    let will_do = |&cells: &usize| {
        cells <= most && is_by_rays(patches, cells) && error(cells) <= SHARE * tolerance
    };
    CELLS.into_iter().find(will_do).unwrap_or(most)
}

/// Relative error, rms, of the irradiance that a look finds; measured in rooms of 16 000 and 80 000 facets.
fn error(cells: usize) -> f64 {
    0.003 * (32.0 / cells as f64).powf(1.3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_fewer_only_where_rays_fill_them_and_errors_are_tolerated() {
        let cells = |patches, tolerance| enough_cells(patches, tolerance, 128);
        assert_eq!(cells(1_000, 0.5), 128);
        assert_eq!(cells(20_000, 0.08), 16);
        assert_eq!(cells(20_000, 0.03), 32);
        assert_eq!(enough_cells(20_000, 0.02, 32), 32);
        assert_eq!(cells(20_000, 0.02), 128);
        assert_eq!(cells(100_000, 0.02), 64);
        assert_eq!(cells(1_000_000, 0.001), 128);
    }
}
