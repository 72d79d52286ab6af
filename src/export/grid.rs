//! Illuminance at places, as CSV for spreadsheets and plots.

use std::io::Write;
use std::path::Path;

use crate::error::Result;
use crate::file;
use crate::solver::Reading;

/// What the columns are called.
const COLUMNS: &str = "x,y,z,nx,ny,nz,E_lux,direct_lux,indirect_lux";

/// Writes readings as `.csv`: places, m, unit normals, and illuminances, lx: all, straight from emitters, and by
/// reflected light.
///
/// # Errors
/// When the ending is not `.csv` or the file cannot be written.
pub fn save_grid(readings: &[Reading], path: &Path) -> Result<()> {
    super::history::check_ending(path)?;
    file::replace(path, |out| {
        writeln!(out, "{COLUMNS}")?;
        readings.iter().try_for_each(|reading| {
            let Reading { place: p, normal: n, .. } = reading;
            let (all, direct) = (reading.lux(), reading.direct_lux());
            let indirect = reading.indirect_lux();
            writeln!(
                out,
                "{},{},{},{},{},{},{all:.6},{direct:.6},{indirect:.6}",
                p.x, p.y, p.z, n.x, n.y, n.z
            )
        })
    })
}
