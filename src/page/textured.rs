//! What a mesh with pictures on it has beside its light.

use glam::Vec2;
use serde::Serialize;

use super::pictures::PictureSet;
use crate::reconstruct::TriMesh;
use crate::scene::Texture;

/// Pictures, and how the triangles and vertices of a mesh show them.
#[derive(Clone, Debug)]
pub(super) struct Textured {
    /// Consecutive; together they are all triangles.
    runs: Vec<DrawRun>,
    textures: Vec<Texture>,
    /// By vertex.
    pub(super) uvs: Vec<Vec2>,
}

/// Triangles in a row that are drawn alike.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DrawRun {
    triangles: usize,
    /// Index into [`Textured::textures`].
    texture: Option<usize>,
    /// Alpha of the texture, 0..=1, below which there is a hole.
    cutoff: Option<f64>,
}

/// A run as `drawing.js` reads it.
#[derive(Debug, Serialize)]
pub(super) struct RunRecord {
    corners: usize,
    /// Index into the viewer's pictures.
    picture: Option<usize>,
    cutoff: Option<f64>,
}

impl Textured {
    /// Nothing of a mesh without pictures.
    pub(super) fn of_mesh(mesh: &TriMesh) -> Option<Self> {
        let count = mesh.positions.len();
        let are_laid_on = [mesh.uvs.len(), mesh.texture_mean.len()] == [count; 2];
        let runs = runs(mesh);
        let has_pictures = runs.iter().any(|run| run.texture.is_some());
        let (textures, uvs) = (mesh.textures.clone(), mesh.uvs.clone());
        (are_laid_on && has_pictures).then_some(Self { runs, textures, uvs })
    }

    /// The runs as the scripts get them; their pictures go to `gallery`.
    pub(super) fn packed<'a>(&'a self, gallery: &mut PictureSet<'a>) -> Vec<RunRecord> {
        let record = |run: &DrawRun| RunRecord {
            corners: 3 * run.triangles,
            picture: run.texture.map(|number| gallery.number(&self.textures[number])),
            cutoff: run.cutoff,
        };
        self.runs.iter().map(record).collect()
    }
}

fn runs(mesh: &TriMesh) -> Vec<DrawRun> {
    let is_whole = |number: &usize| {
        mesh.textures.get(*number).is_some_and(|texture| {
            let size = texture.width as usize * texture.height as usize;
            size > 0 && texture.texels.len() == size
        })
    };
    let mut runs: Vec<DrawRun> = Vec::new();
    for part in mesh.parts.iter().filter(|part| !part.triangles.is_empty()) {
        let triangles = part.triangles.len();
        let texture = part.texture.map(|number| number as usize).filter(is_whole);
        let cutoff = part.cutoff.filter(|_| texture.is_some());
        match runs.last_mut().filter(|last| (last.texture, last.cutoff) == (texture, cutoff)) {
            Some(last) => last.triangles += triangles,
            None => runs.push(DrawRun { triangles, texture, cutoff }),
        }
    }
    runs
}
