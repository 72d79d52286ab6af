//! A scene while it is read from PLY: elements of vertices and faces, and what is skipped.

use glam::{DVec3, Vec3};
use smallvec::SmallVec;

use super::header::{PlyElement, PlyHeader, Property, PropertyKind};
use super::values::Values;
use crate::colour::{Rgb, linear_from_srgb};
use crate::scene::limits::tamed;
use crate::scene::notes::note_count;
use crate::scene::{Face, MAX_REFLECTANCE, Material, Scene};

/// What has been read so far.
#[derive(Default)]
pub(super) struct PlyImport {
    points: Vec<DVec3>,
    normals: Vec<Vec3>,
    tints: Vec<Vec3>,
    faces: Vec<Face>,
    loose: usize,
    skipped: usize,
}

/// What may go wrong with a value, in words.
type Told<T> = Result<T, String>;

/// Where in a row the properties of these names stand, if all of them do.
fn places(element: &PlyElement, names: [&str; 3]) -> Option<[usize; 3]> {
    let place =
        |name: &str| element.properties.iter().position(|p| p.name.eq_ignore_ascii_case(name));
    let [x, y, z] = names.map(place);
    Some([x?, y?, z?])
}

/// Names by which colours go.
const COLOURS: [[&str; 3]; 3] =
    [["red", "green", "blue"], ["r", "g", "b"], ["diffuse_red", "diffuse_green", "diffuse_blue"]];

/// Where the colour of a row stands.
fn colour_places(element: &PlyElement) -> Option<[usize; 3]> {
    COLOURS.iter().find_map(|names| places(element, *names))
}

/// The reflectance that a colour means: integers are codes of sRGB, floats are linear.
fn tint(element: &PlyElement, row: &[f64], places: [usize; 3]) -> Vec3 {
    let channel = |place: usize| match element.properties[place].kind {
        PropertyKind::One(number) => match number.full() {
            Some(full) => linear_from_srgb((row[place] / full).clamp(0.0, 1.0)),
            None => row[place],
        },
        PropertyKind::List(..) => 0.0,
    };
    tamed(Rgb::from_array(places.map(channel)), 1.0).as_vec3()
}

impl PlyImport {
    pub(super) fn add_vertices(
        &mut self,
        element: &PlyElement,
        values: &mut Values<'_>,
    ) -> Told<()> {
        let position = places(element, ["x", "y", "z"]).ok_or("has no x, y and z")?;
        let (normal, colour) = (places(element, ["nx", "ny", "nz"]), colour_places(element));
        let mut row = Vec::new();
        for number in 0..element.count {
            self.row(element, values, &mut row).map_err(|why| format!("row {number}: {why}"))?;
            let at = |places: [usize; 3]| DVec3::from_array(places.map(|place| row[place]));
            let point = at(position);
            if !point.is_finite() {
                return Err(format!("row {number}: {point} is no place"));
            }
            self.points.push(point);
            self.normals.extend(normal.map(|n| at(n).normalize_or_zero().as_vec3()));
            self.tints.extend(colour.map(|colour| tint(element, &row, colour)));
        }
        Ok(())
    }

    pub(super) fn add_faces(&mut self, element: &PlyElement, values: &mut Values<'_>) -> Told<()> {
        let is_list = |p: &Property| {
            let name = p.name.as_str();
            matches!(p.kind, PropertyKind::List(..))
                && ["vertex_indices", "vertex_index"].contains(&name)
        };
        let list =
            element.properties.iter().position(is_list).ok_or("has no list vertex_indices")?;
        let colour = colour_places(element);
        let (mut row, mut corners) = (Vec::new(), Vec::new());
        for number in 0..element.count {
            let told = |why: String| format!("row {number}: {why}");
            row.clear();
            for (place, property) in element.properties.iter().enumerate() {
                let corners = (place == list).then_some(&mut corners);
                row.push(values.property(property, corners).map_err(told)?);
            }
            let tint = colour.map(|colour| tint(element, &row, colour));
            self.add_face(&corners, tint).map_err(told)?;
        }
        Ok(())
    }

    fn add_face(&mut self, corners: &[f64], tint: Option<Vec3>) -> Told<()> {
        if corners.len() < 3 {
            self.loose += 1;
            return Ok(());
        }
        let index = |&corner: &f64| match corner {
            0.0..4_294_967_295.0 if corner.fract() == 0.0 => Ok(corner as u32),
            _ => Err(format!("{corner} is no number of a vertex")),
        };
        let vertices = corners.iter().map(index).collect::<Told<SmallVec<[u32; 4]>>>()?;
        let tints = tint.map(|tint| SmallVec::from_elem(tint, vertices.len()));
        self.faces.push(Face { vertices, tints: tints.unwrap_or_default(), ..Face::default() });
        Ok(())
    }

    /// Reads past what is not known.
    pub(super) fn skip(&mut self, element: &PlyElement, values: &mut Values<'_>) -> Told<()> {
        self.skipped += usize::try_from(element.count).unwrap_or(usize::MAX);
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut row = Vec::new();
        (0..element.count).try_for_each(|number| {
            self.row(element, values, &mut row).map_err(|why| format!("row {number}: {why}"))
        })
    }

    /// The numbers of a row; lists count as 0.
    fn row(&self, element: &PlyElement, values: &mut Values<'_>, row: &mut Vec<f64>) -> Told<()> {
        row.clear();
        for property in &element.properties {
            row.push(values.property(property, None)?);
        }
        Ok(())
    }

    pub(super) fn finish(mut self, header: &PlyHeader) -> Told<Scene> {
        let (points, normals, tints) = (&self.points, &self.normals, &self.tints);
        for face in &mut self.faces {
            if let Some(vertex) = face.vertices.iter().find(|&&v| v as usize >= points.len()) {
                return Err(format!(
                    "vertex {vertex} is used, but there are only {}",
                    points.len()
                ));
            }
            let of = |list: &[Vec3]| -> SmallVec<[Vec3; 4]> {
                face.vertices.iter().filter_map(|&v| list.get(v as usize).copied()).collect()
            };
            let own = of(tints);
            face.normals = of(normals);
            if face.tints.is_empty() {
                face.tints = own;
            }
        }
        let is_coloured = self.faces.iter().any(|face| !face.tints.is_empty());
        let reflectance =
            if is_coloured { Rgb::splat(MAX_REFLECTANCE) } else { Material::default().reflectance };
        let mut notes = Vec::new();
        note_count(&mut notes, self.loose, "face", "of fewer than 3 corners ignored");
        note_count(&mut notes, self.skipped, "row", "that is neither vertex nor face ignored");
        if header.has_picture {
            notes.push("the picture that a comment names is not read".to_owned());
        }
        Ok(Scene {
            positions: self.points,
            faces: self.faces,
            objects: vec!["default".to_owned()],
            materials: vec![Material { reflectance, ..Material::default() }],
            notes,
            ..Scene::default()
        })
    }
}
