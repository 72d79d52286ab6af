//! What the laws are held to: scenes, their light, and lookups in maps.

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use fastrand::Rng;
use glam::{DVec2, DVec3, Vec2, Vec3};
use radiosity::colour::Rgb;
use radiosity::lightmap::{Atlas, Lightmap};
use radiosity::reconstruct::TriMesh;
use radiosity::{Scene, Settings, Solution, Surfaces, reconstruct, surfaces_of};

use crate::common::{Block, Stage, coarse, furnished_room, solve};

/// Surfaces, their light, and the mesh that carries it.
#[derive(Clone)]
pub(crate) struct Lit {
    pub(crate) surfaces: Surfaces,
    pub(crate) solution: Solution,
    pub(crate) mesh: TriMesh,
}

/// A room with two boxes that stand on its floor.
pub(crate) static ROOM: LazyLock<Lit> =
    LazyLock::new(|| Lit::new(&room(), &Settings { max_level: 4, ..coarse() }));

/// A ball of large facets over a floor.
pub(crate) static BALL: LazyLock<Lit> = LazyLock::new(|| Lit::new(&ball([14, 7]), &coarse()));

impl Lit {
    pub(crate) fn new(scene: &Scene, settings: &Settings) -> Self {
        let surfaces = surfaces_of(scene);
        let solution = solve(&surfaces, settings);
        let mesh = reconstruct(&surfaces, &solution);
        Self { surfaces, solution, mesh }
    }

    /// Index of the surface of a triangle.
    pub(crate) fn surface(&self, triangle: usize) -> usize {
        self.solution.mesh.surface_of(self.mesh.leaves[triangle]).index()
    }

    /// Radiance of a white surface, W/(m² sr), at a vertex.
    pub(crate) fn light(&self, vertex: u32) -> Rgb {
        let irradiance = &self.mesh.irradiance[vertex as usize];
        (irradiance.direct + irradiance.indirect) / PI
    }

    /// A place on a triangle, m, the light that is interpolated there, and where it is in an atlas.
    pub(crate) fn random(&self, atlas: &Atlas, triangle: usize, rng: &mut Rng) -> Sample {
        let (x, y) = (rng.f64(), rng.f64());
        let (x, y) = if x + y > 1.0 { (1.0 - x, 1.0 - y) } else { (x, y) };
        let corners = self.mesh.triangles[triangle];
        let weighted = corners.iter().zip([1.0 - x - y, x, y]);
        let (mut place, mut light) = (DVec3::ZERO, Rgb::ZERO);
        for (&corner, weight) in weighted {
            place += self.mesh.positions[corner as usize] * weight;
            light += self.light(corner) * weight;
        }
        let surface = self.surface(triangle);
        let chart = &atlas.charts[atlas.chart_of[surface] as usize];
        Sample { surface, light, texel: chart.texel(place) }
    }
}

/// A place in a map and the light it should hold.
pub(crate) struct Sample {
    pub(crate) surface: usize,
    pub(crate) light: Rgb,
    pub(crate) texel: DVec2,
}

pub(crate) fn room() -> Scene {
    let block =
        |x, z, turn| Block { base: DVec3::new(x, 0.0, z), size: DVec3::new(0.8, 1.2, 0.8), turn };
    furnished_room(&[block(1.2, 1.5, 0.3), block(2.8, 3.4, -0.2)])
}

/// A ball that hangs over a floor, below a lamp, with so many facets around and from pole to pole.
pub(crate) fn ball([around, down]: [usize; 2]) -> Scene {
    let mut stage = Stage::default();
    let (grey, light) = (stage.material(0.5, 0.0), stage.material(0.0, 10.0));
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let floor = [corner(-2.0, -2.0), corner(-2.0, 2.0), corner(2.0, 2.0), corner(2.0, -2.0)];
    stage.polygon(grey, &floor);
    stage.lamp(light, DVec3::new(-0.5, 3.0, -0.5), DVec3::new(0.5, 3.0, 0.5));
    let out = |row: usize, column: usize| {
        let (tilt, turn) =
            (PI * row as f64 / down as f64, TAU * (column % around) as f64 / around as f64);
        let ring = if row.is_multiple_of(down) { 0.0 } else { tilt.sin() };
        DVec3::new(ring * turn.cos(), tilt.cos(), -ring * turn.sin())
    };
    for row in 0..down {
        for column in 0..around {
            let [a, b] = [out(row, column), out(row, column + 1)];
            let [c, d] = [out(row + 1, column + 1), out(row + 1, column)];
            for normals in [[a, d, c], [a, c, b]] {
                let [x, y, z] = normals;
                if x != y && y != z && z != x {
                    let face = stage.polygon(grey, &normals.map(|n| DVec3::Y * 1.5 + n * 0.5));
                    face.normals = normals.iter().map(|n| n.as_vec3()).collect();
                }
            }
        }
    }
    stage.scene
}

/// The bilinear mean of the texels around a place, given in texels, of a square picture.
pub(crate) fn lookup(texels: &[Vec3], size: u32, place: DVec2) -> Vec3 {
    let last = i64::from(size) - 1;
    let from = place - 0.5;
    let (low, share) = (from.floor(), (from - from.floor()).as_vec2());
    let at = |x: f64, y: f64| {
        let [x, y] = [x, y].map(|c| (c as i64).clamp(0, last) as usize);
        texels[y * size as usize + x]
    };
    let row = |y: f64| at(low.x, y).lerp(at(low.x + 1.0, y), share.x);
    row(low.y).lerp(row(low.y + 1.0), share.y)
}

/// The next mip level: the means of squares of four texels.
pub(crate) fn halved(texels: &[Vec3], size: u32) -> Vec<Vec3> {
    let (size, half) = (size as usize, size as usize / 2);
    let mean = |texel: usize| {
        let first = texel / half * 2 * size + texel % half * 2;
        [0, 1, size, size + 1].map(|step| texels[first + step]).iter().sum::<Vec3>() / 4.0
    };
    (0..half * half).map(mean).collect()
}

/// The texel of a place given by second texture coordinates.
pub(crate) fn texel_of(map: &Lightmap, uv: Vec2) -> DVec2 {
    uv.as_dvec2() * f64::from(map.atlas.size)
}
