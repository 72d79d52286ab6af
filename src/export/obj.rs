//! OBJ with vertex colours, its MTL, and the pictures that the MTL names.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::exposed::{ExposedMesh, coded, singles};
use super::group::{self, Group};
use super::picture::{self, Coding};
use crate::error::{Error, Result};
use crate::file;
use crate::scene::Texture;

/// The first line of a file of materials, by which it is known again.
const MARK: &str = "# materials of an OBJ by radiosity";

/// The files that are written beside the OBJ at `path` whose pictures are among `textures`.
pub(super) fn beside(path: &Path, textures: &[Texture]) -> Vec<PathBuf> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    // A brightened JPEG becomes a PNG.
    let codings = |texture| BTreeSet::from([Coding::of(texture, 1.0).ending(), "png"]);
    let pictures = textures.iter().enumerate().flat_map(|(number, texture)| {
        codings(texture).into_iter().map(move |ending| (number, ending))
    });
    let pictures =
        pictures.map(|(number, ending)| path.with_file_name(name_of(&stem, number, ending)));
    [path.with_extension("mtl")].into_iter().chain(pictures).collect()
}

/// Those of them that are there already, and that were not written beside an earlier OBJ of that name.
pub(super) fn strangers(path: &Path, textures: &[Texture]) -> Vec<PathBuf> {
    let known = std::fs::read(path.with_extension("mtl")).unwrap_or_default();
    let known = String::from_utf8_lossy(&known);
    let is_own = |file: &PathBuf| {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let is_used = || known.lines().any(|line| line.strip_prefix(MAP) == Some(&*name));
        known.starts_with(MARK) && (file.extension().is_some_and(|end| end == "mtl") || is_used())
    };
    beside(path, textures).into_iter().filter(|file| file.exists() && !is_own(file)).collect()
}

/// What comes before the name of a material's picture.
const MAP: &str = "map_Kd ";

/// Writes the OBJ at `path`, and beside it a file of materials and the pictures in use.
pub(crate) fn save(exposed: &ExposedMesh, path: &Path) -> Result<()> {
    let groups = group::by_object(exposed.mesh);
    let names = material_names(&groups);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let textures: BTreeSet<u32> = groups.iter().filter_map(|group| group.texture).collect();
    for &texture in &textures {
        let target = path.with_file_name(picture_name(exposed, &stem, texture));
        let white = exposed.whites[texture as usize];
        let bytes = picture::encoded(&exposed.mesh.textures[texture as usize], white)
            .map_err(Error::io(&target))?;
        file::replace(&target, |out| out.write_all(&bytes))?;
    }
    file::replace(&path.with_extension("mtl"), |out| {
        writeln!(out, "{MARK}")?;
        let mut written = BTreeSet::new();
        groups.iter().zip(&names).filter(|(_, name)| written.insert(*name)).try_for_each(
            |(group, name)| {
                let picture = group.texture.map(|texture| picture_name(exposed, &stem, texture));
                write_material(name, picture.as_deref(), group.cutoff.is_some(), out)
            },
        )
    })?;
    file::replace(path, |out| {
        write_header(exposed, &stem, out)?;
        let mut body = ObjBody { exposed, out, vertices: 0, uvs: 0, object: None };
        groups.iter().zip(&names).try_for_each(|(group, name)| body.write_group(group, name))
    })
}

fn write_header(exposed: &ExposedMesh, stem: &str, out: &mut impl Write) -> io::Result<()> {
    for remark in exposed.remarks() {
        writeln!(out, "# {remark}")?;
    }
    writeln!(
        out,
        "# v x y z r g b; where there is a picture, r g b is the light to multiply it by."
    )?;
    writeln!(out, "mtllib {stem}.mtl")
}

/// What is written so far, by which OBJ numbers what follows.
struct ObjBody<'a, W> {
    exposed: &'a ExposedMesh<'a>,
    out: &'a mut W,
    vertices: usize,
    uvs: usize,
    object: Option<u32>,
}

impl<W: Write> ObjBody<'_, W> {
    fn write_group(&mut self, group: &Group, name: &str) -> io::Result<()> {
        let mesh = self.exposed.mesh;
        if let Some(object) = group.object.filter(|_| group.object != self.object) {
            let name = mesh.objects.get(object as usize).map(String::as_str).unwrap_or_default();
            writeln!(self.out, "o {}", name.replace(char::is_control, "_"))?;
        }
        self.object = group.object;
        for &vertex in &group.vertices {
            let position = mesh.positions[vertex as usize];
            let [r, g, b] = coded(self.exposed.shown(vertex, group));
            if self.exposed.origin == DVec3::ZERO {
                let [x, y, z] = singles(position);
                writeln!(self.out, "v {x} {y} {z} {r:.4} {g:.4} {b:.4}")?;
            } else {
                let DVec3 { x, y, z } = position;
                writeln!(self.out, "v {x} {y} {z} {r:.4} {g:.4} {b:.4}")?;
            }
        }
        for &vertex in &group.vertices {
            let [x, y, z] = mesh.normals[vertex as usize].to_array();
            writeln!(self.out, "vn {x:.5} {y:.5} {z:.5}")?;
        }
        if group.texture.is_some() {
            for &vertex in &group.vertices {
                // OBJ counts texture coordinates from the bottom of the picture.
                let uv = mesh.uvs[vertex as usize];
                writeln!(self.out, "vt {} {}", uv.x, 1.0 - uv.y)?;
            }
        }
        writeln!(self.out, "usemtl {name}")?;
        for triangle in &group.triangles {
            let [a, b, c] = triangle.map(|corner| self.corner(corner as usize, group));
            writeln!(self.out, "f {a} {b} {c}")?;
        }
        self.vertices += group.vertices.len();
        self.uvs += if group.texture.is_some() { group.vertices.len() } else { 0 };
        Ok(())
    }

    fn corner(&self, corner: usize, group: &Group) -> String {
        let vertex = self.vertices + corner + 1;
        match group.texture {
            Some(_) => format!("{vertex}/{}/{vertex}", self.uvs + corner + 1),
            None => format!("{vertex}//{vertex}"),
        }
    }
}

/// A material that shows its colour as it is, `illum 0`: the light is already in it. Holes are those of its picture's alpha.
fn write_material(
    name: &str,
    picture: Option<&str>,
    has_holes: bool,
    out: &mut impl Write,
) -> io::Result<()> {
    writeln!(out, "newmtl {name}\nKd 1 1 1\nillum 0")?;
    if let Some(picture) = picture.filter(|_| has_holes) {
        writeln!(out, "map_d {picture}")?;
    }
    match picture {
        Some(picture) => writeln!(out, "{MAP}{picture}\n"),
        None => writeln!(out),
    }
}

fn picture_name(exposed: &ExposedMesh, stem: &str, texture: u32) -> String {
    let number = texture as usize;
    name_of(
        stem,
        number,
        Coding::of(&exposed.mesh.textures[number], exposed.whites[number]).ending(),
    )
}

fn name_of(stem: &str, number: usize, ending: &str) -> String {
    format!("{stem}-{number}.{ending}")
}

/// Names of the groups' materials that an MTL can hold: without spaces, and each used for one look.
fn material_names(groups: &[Group]) -> Vec<String> {
    let (mut taken, mut known) = (BTreeSet::new(), BTreeMap::new());
    let mut name_of = |group: &Group| {
        let plain: String = group
            .name
            .chars()
            .map(|c| if c.is_whitespace() || c.is_control() { '_' } else { c })
            .collect();
        let plain = if plain.is_empty() { "material".to_owned() } else { plain };
        let mut name = plain.clone();
        let mut count = 1;
        while !taken.insert(name.clone()) {
            count += 1;
            name = format!("{plain}.{count}");
        }
        name
    };
    let names = groups
        .iter()
        .map(|group| known.entry(group.key()).or_insert_with(|| name_of(group)).clone());
    names.collect()
}
