//! Binary PLY with colours to look at and radiosity to compute with.

use std::io::{self, Write};

use glam::DVec3;

use super::group;
use super::look::{Look, coded, singles};

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
pub(crate) fn write(look: &Look, out: &mut impl Write) -> io::Result<()> {
    let group = group::whole(look.mesh);
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    for remark in look.remarks() {
        writeln!(out, "comment {remark}")?;
    }
    writeln!(out, "comment radiosity_red, _green, _blue: W/m^2, linear, Rec. 709 primaries.")?;
    writeln!(out, "element vertex {}", group.vertices.len())?;
    let number = if is_far(look) { "double" } else { "float" };
    writeln!(out, "property {number} x\nproperty {number} y\nproperty {number} z")?;
    for property in VERTEX_PROPERTIES {
        writeln!(out, "property {property}")?;
    }
    writeln!(out, "element face {}", group.triangles.len())?;
    writeln!(out, "property list uchar uint vertex_indices\nend_header")?;

    for &vertex in &group.vertices {
        write_vertex(look, vertex, out)?;
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
fn is_far(look: &Look) -> bool {
    look.origin != DVec3::ZERO
}

fn write_vertex(look: &Look, vertex: u32, out: &mut impl Write) -> io::Result<()> {
    let index = vertex as usize;
    let write_singles = |values: [f32; 3], out: &mut dyn Write| {
        values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
    };
    let position = look.mesh.positions[index];
    if is_far(look) {
        position.to_array().iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
    } else {
        write_singles(singles(position), out)?;
    }
    write_singles(look.mesh.normals[index].to_array(), out)?;
    out.write_all(&coded(look.colour(vertex)).map(|value| (value * 255.0).round() as u8))?;
    write_singles(singles(look.mesh.radiosity[index]), out)
}
