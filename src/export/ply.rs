//! Binary PLY with colours to look at and radiosity to compute with.

use std::io::{self, Write};

use glam::DVec3;

use super::exposed::{ExposedMesh, coded, singles};
use super::group;

const VERTEX_PROPERTIES: [&str; 9] = [
    "float nx",
    "float ny",
    "float nz",
    "uchar red",
    "uchar green",
    "uchar blue",
    "float radiosity_red",
    "float radiosity_green",
    "float radiosity_blue",
];

/// Writes little-endian binary PLY.
pub(crate) fn write(exposed: &ExposedMesh, out: &mut impl Write) -> io::Result<()> {
    let group = group::whole(exposed.mesh);
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    for remark in exposed.remarks() {
        writeln!(out, "comment {remark}")?;
    }
    writeln!(out, "comment radiosity_red, _green, _blue: W/m^2, linear, Rec. 709 primaries.")?;
    writeln!(out, "element vertex {}", group.vertices.len())?;
    let number = if is_far(exposed) { "double" } else { "float" };
    writeln!(out, "property {number} x\nproperty {number} y\nproperty {number} z")?;
    for property in VERTEX_PROPERTIES {
        writeln!(out, "property {property}")?;
    }
    writeln!(out, "element face {}", group.triangles.len())?;
    writeln!(out, "property list uchar uint vertex_indices\nend_header")?;

    for &vertex in &group.vertices {
        write_vertex(exposed, vertex, out)?;
    }
    for triangle in &group.triangles {
        out.write_all(&[3])?;
        for corner in triangle {
            out.write_all(&corner.to_le_bytes())?;
        }
    }
    Ok(())
}

/// Whether single precision cannot tell places of the mesh apart.
fn is_far(exposed: &ExposedMesh) -> bool {
    exposed.origin != DVec3::ZERO
}

fn write_vertex(exposed: &ExposedMesh, vertex: u32, out: &mut impl Write) -> io::Result<()> {
    let index = vertex as usize;
    let write_singles = |values: [f32; 3], out: &mut dyn Write| {
        values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
    };
    let position = exposed.mesh.positions[index];
    if is_far(exposed) {
        position.to_array().iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
    } else {
        write_singles(singles(position), out)?;
    }
    write_singles(exposed.mesh.normals[index].to_array(), out)?;
    out.write_all(&coded(exposed.colour(vertex)).map(|value| (value * 255.0).round() as u8))?;
    write_singles(singles(exposed.mesh.radiosity[index]), out)
}
