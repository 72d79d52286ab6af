//! Scenes built in code, shared by tests and benchmarks.
#![allow(dead_code, unreachable_pub, reason = "nobody uses all of it")]

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use radiosity::Scene;
use radiosity::colour::Rgb;
use radiosity::scene::{Face, Material, MaterialId, Sampler, Texture};

/// A scene under construction; equal positions are shared.
#[derive(Clone, Debug, Default)]
pub struct Stage {
    pub scene: Scene,
}

/// An upright box with a rectangular base, turned about its vertical axis.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Middle of the base, m.
    pub base: DVec3,
    /// Width, height and depth, m.
    pub size: DVec3,
    /// Angle about the vertical, radians.
    pub turn: f64,
}

/// The quadrilaterals of a box by their corners, outward; bit 0 of a corner is x, bit 1 y, bit 2 z.
const SIDES: [[usize; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

impl Stage {
    /// Adds a grey material of this reflectance and emitted radiance, W/(m² sr).
    pub fn material(&mut self, reflectance: f64, radiance: f64) -> MaterialId {
        self.scene.add_material(Material {
            name: format!("material-{}", self.scene.materials.len()),
            reflectance: Rgb::splat(reflectance),
            emission: Rgb::splat(radiance),
            ..Material::default()
        })
    }

    /// As [`Self::material`], for both sides of a polygon.
    pub fn double_sided(&mut self, reflectance: f64, radiance: f64) -> MaterialId {
        let number = self.material(reflectance, radiance);
        self.scene.materials[number.index()].double_sided = true;
        number
    }

    /// As [`Self::material`], with a white picture of size × size texels, and holes where its opacity, 0..=1, is below
    /// one half. Opacity is told by where a texel's middle is in the picture.
    pub fn cut_out(
        &mut self,
        [reflectance, radiance]: [f64; 2],
        (size, sampler): (u32, Sampler),
        opacity: impl Fn(DVec2) -> f64,
    ) -> MaterialId {
        let number = self.material(reflectance, radiance);
        let texels = (0..size * size).map(|texel| [texel % size, texel / size]);
        let at = |texel: [u32; 2]| (DVec2::from(texel.map(f64::from)) + 0.5) / f64::from(size);
        let code = |texel| (opacity(at(texel)).clamp(0.0, 1.0) * 255.0).round() as u8;
        self.scene.textures.push(Texture {
            width: size,
            height: size,
            texels: vec![[1.0; 3]; (size * size) as usize].into(),
            alpha: texels.map(code).collect(),
            sampler,
            ..Texture::default()
        });
        let material = &mut self.scene.materials[number.index()];
        material.texture = Some(self.scene.textures.len() as u32 - 1);
        material.cutoff = Some(0.5);
        number
    }

    /// Adds a polygon, counter-clockwise seen from its front.
    pub fn polygon(&mut self, material: MaterialId, corners: &[DVec3]) -> &mut Face {
        let vertices = corners.iter().map(|&corner| self.position(corner)).collect();
        let index = self.scene.faces.len();
        self.scene.faces.push(Face { vertices, material, ..Face::default() });
        &mut self.scene.faces[index]
    }

    /// Adds the six walls of a room, facing inward.
    pub fn room(&mut self, material: MaterialId, low: DVec3, high: DVec3) {
        for side in 0..6 {
            self.wall(material, (low, high), side);
        }
    }

    /// Adds one wall of a room, facing inward: 0 to 5 are at low x, high x, low y, high y, low z, high z.
    pub fn wall(&mut self, material: MaterialId, (low, high): (DVec3, DVec3), side: usize) {
        let mut corners = SIDES[side].map(|corner| between(low, high, corner));
        corners.reverse();
        self.polygon(material, &corners);
    }

    /// Adds a box, facing outward.
    pub fn block(&mut self, material: MaterialId, block: Block) {
        let corners = block.corners();
        for side in SIDES {
            self.polygon(material, &side.map(|corner| corners[corner]));
        }
    }

    /// Adds a ball of flat facets, 12 rows of 24.
    pub fn ball(&mut self, material: MaterialId, centre: DVec3, radius: f64) {
        let at = |row: usize, column: usize| {
            let (down, around) = (PI * row as f64 / 12.0, TAU * (column % 24) as f64 / 24.0);
            let level = DVec3::new(around.cos(), 0.0, around.sin()) * down.sin();
            // Places at the poles are the same to the last bit.
            let level = if row.is_multiple_of(12) { DVec3::ZERO } else { level };
            centre + (level + DVec3::Y * down.cos()) * radius
        };
        for (row, column) in (0..12).flat_map(|row| (0..24).map(move |column| (row, column))) {
            let [a, b] = [at(row, column), at(row, column + 1)];
            let [c, d] = [at(row + 1, column + 1), at(row + 1, column)];
            match row {
                0 => self.polygon(material, &[a, c, d]),
                11 => self.polygon(material, &[a, b, d]),
                _ => self.polygon(material, &[a, b, c, d]),
            };
        }
    }

    /// Adds a horizontal rectangle at the height of its corners, facing down.
    pub fn lamp(&mut self, material: MaterialId, low: DVec3, high: DVec3) {
        let corners = [0, 1, 5, 4].map(|corner| between(low, high, corner));
        self.polygon(material, &corners);
    }

    fn position(&mut self, at: DVec3) -> u32 {
        let positions = &mut self.scene.positions;
        let known = positions.iter().position(|&p| p == at);
        known.unwrap_or_else(|| {
            positions.push(at);
            positions.len() - 1
        }) as u32
    }
}

impl Block {
    /// A box by opposite corners.
    pub fn spanning(low: DVec3, high: DVec3) -> Self {
        let base = low.midpoint(high).with_y(low.y);
        Self { base, size: high - low, turn: 0.0 }
    }

    /// Where its corners are, m.
    pub fn corners(&self) -> [DVec3; 8] {
        let half = self.size.with_y(0.0) / 2.0;
        let (low, high) = (-half, half.with_y(self.size.y));
        std::array::from_fn(|corner| {
            let p = between(low, high, corner);
            let flat = DVec2::from_angle(self.turn).rotate(DVec2::new(p.x, p.z));
            self.base + DVec3::new(flat.x, p.y, flat.y)
        })
    }

    /// True if a point is inside, further than `margin`, m, from the walls that stand on the base.
    pub fn covers(&self, point: DVec3, margin: f64) -> bool {
        let offset = point - self.base;
        let local = DVec2::from_angle(-self.turn).rotate(DVec2::new(offset.x, offset.z));
        local.x.abs() < self.size.x / 2.0 - margin && local.y.abs() < self.size.z / 2.0 - margin
    }
}

pub fn between(low: DVec3, high: DVec3, corner: usize) -> DVec3 {
    let bits = [0, 1, 2].map(|bit| corner >> bit & 1 == 1);
    DVec3::select(glam::BVec3::from_array(bits), high, low)
}
