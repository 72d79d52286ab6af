//! Rays through regular, axis-parallel meshes: this crate's hierarchy against obvhs's builders, and
//! packets against single rays.
//!
//! `cargo bench --bench bvh`

#[path = "../tests/library/common/mod.rs"]
mod common;

use std::hint::black_box;
use std::time::Duration;

use divan::Bencher;
use divan::counter::ItemsCount;
use glam::{DMat3, DVec3, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::{Ray, RayHit};
use radiosity::form_factor::rays::{Rays, Sphere};
use radiosity::geometry::hierarchy::hierarchy;
use radiosity::mesh::Mesh;
use radiosity::visibility::{PatchHierarchy, SurfacePoint};
use radiosity::{Length, Settings, surfaces_of};

/// Squares along each edge of a wall.
const ACROSS: usize = 128;

/// Names of the builders compared.
const BUILDERS: [&str; 4] = ["ours", "medium_build", "slow_build", "very_slow_build"];

fn main() {
    divan::main();
}

/// The walls of a room of 10 × 8 × 3 m in equal rectangles: boxes without thickness, and the axis
/// across each.
fn walls() -> Vec<(Aabb, usize)> {
    let size = Vec3A::new(10.0, 8.0, 3.0);
    let place = |wall: usize, i: usize, j: usize| {
        let mut at = [(wall % 2) as f32, i as f32 / ACROSS as f32, j as f32 / ACROSS as f32];
        at.rotate_right(wall / 2);
        Vec3A::from(at) * size - size / 2.0
    };
    let cells =
        (0..6 * ACROSS * ACROSS).map(|k| (k / ACROSS / ACROSS, k / ACROSS % ACROSS, k % ACROSS));
    cells
        .map(|(wall, i, j)| (Aabb::new(place(wall, i, j), place(wall, i + 1, j + 1)), wall / 2))
        .collect()
}

fn build(builder: &str, boxes: &[Aabb]) -> Bvh2 {
    let params = match builder {
        "medium_build" => BvhBuildParams::medium_build(),
        "slow_build" => BvhBuildParams::slow_build(),
        "very_slow_build" => BvhBuildParams::very_slow_build(),
        _ => return hierarchy(boxes),
    };
    build_bvh2(boxes, params, &mut Duration::default())
}

/// The boxes of the walls; padding makes them differ by rounding, and so spares obvhs its ties.
fn boxes(walls: &[(Aabb, usize)], padding: f32) -> Vec<Aabb> {
    let padding = Vec3A::splat(padding);
    walls.iter().map(|(bounds, _)| Aabb::new(bounds.min - padding, bounds.max + padding)).collect()
}

#[divan::bench(args = BUILDERS)]
fn build_room_of_98_304(bencher: Bencher<'_, '_>, builder: &str) {
    let boxes = boxes(&walls(), 0.0);
    bencher.counter(ItemsCount::new(boxes.len())).bench(|| build(builder, black_box(&boxes)));
}

/// Rays from a place on the floor, in the order of a spiral: not coherent.
fn rays(count: usize) -> impl Iterator<Item = Ray> {
    let turn = DMat3::from_rotation_z(0.3);
    Sphere::new(count)
        .directions()
        .map(move |d| turn * d)
        .collect::<Vec<_>>()
        .into_iter()
        .map(|d| Ray::new_inf(Vec3A::new(1.3, -2.1, -1.4999), d.as_vec3a()))
}

#[divan::bench(args = BUILDERS)]
fn rays_in_room_of_98_304(bencher: Bencher<'_, '_>, builder: &str) {
    walk(bencher, builder, 0.0);
}

#[divan::bench(args = BUILDERS)]
fn rays_in_room_of_98_304_padded(bencher: Bencher<'_, '_>, builder: &str) {
    walk(bencher, builder, 1e-4);
}

fn walk(bencher: Bencher<'_, '_>, builder: &str, padding: f32) {
    let walls = walls();
    let tree = build(builder, &boxes(&walls, padding));
    let slots: Vec<(Aabb, usize)> =
        tree.primitive_indices.iter().map(|&k| walls[k as usize]).collect();
    let rays: Vec<Ray> = rays(4096).collect();
    let meet = |ray: &Ray, slot: usize| {
        let (bounds, axis) = &slots[slot];
        let t = (bounds.min[*axis] - ray.origin[*axis]) * ray.inv_direction[*axis];
        let mut at = Vec3::from(ray.origin + ray.direction * t);
        at[*axis] = bounds.min[*axis];
        if t > 0.0 && bounds.contains_point(at.into()) { t } else { f32::INFINITY }
    };
    bencher.counter(ItemsCount::new(rays.len())).bench(|| {
        let hits = rays.iter().filter(|ray| tree.ray_traverse(**ray, &mut RayHit::none(), meet));
        hits.count()
    });
}

/// A room with two blocks and a lamp in it, in about this many patches.
fn room(patches: usize) -> Mesh {
    let block = |x, z, turn| common::Block {
        base: DVec3::new(x, 0.0, z),
        size: DVec3::new(0.8, 1.2, 0.7),
        turn,
    };
    let scene = common::furnished_room(&[block(1.2, 1.3, 0.5), block(2.9, 3.3, 0.0)]);
    let surfaces = surfaces_of(&scene);
    let patch_size = Length::Metres((surfaces.area() / patches as f64).sqrt());
    Mesh::new(&surfaces, &Settings { patch_size, ..common::coarse() })
}

const EYE: SurfacePoint = SurfacePoint { position: DVec3::new(2.1, 0.0, 2.3), normal: DVec3::Y };

const PATCHES: [usize; 3] = [1_000, 10_000, 100_000];

#[divan::bench(args = PATCHES)]
fn single_rays_to_patches(bencher: Bencher<'_, '_>, patches: usize) {
    let mesh = room(patches);
    let hierarchy = PatchHierarchy::new(&mesh.patches);
    let directions: Vec<DVec3> =
        Sphere::new(4096).directions().map(|d| DVec3::new(d.y, d.z, d.x)).collect();
    bencher.counter(ItemsCount::new(directions.len())).bench(|| {
        directions
            .iter()
            .filter(|direction| hierarchy.first(EYE.position, **direction).is_some())
            .count()
    });
}

#[divan::bench(args = PATCHES)]
fn packets_to_patches(bencher: Bencher<'_, '_>, patches: usize) {
    let mesh = room(patches);
    let hierarchy = PatchHierarchy::new(&mesh.patches);
    let sphere = Sphere::new(4096);
    let mut rays = Rays::new(&sphere, &hierarchy);
    bencher
        .counter(ItemsCount::new(sphere.rays()))
        .bench_local(|| rays.look(&mesh.patches, EYE, 0.3).len());
}

#[divan::bench]
fn million_rays_to_100_000_patches(bencher: Bencher<'_, '_>) {
    let mesh = room(100_000);
    let hierarchy = PatchHierarchy::new(&mesh.patches);
    let sphere = Sphere::new(1_000_000);
    let mut rays = Rays::new(&sphere, &hierarchy);
    bencher
        .counter(ItemsCount::new(sphere.rays()))
        .bench_local(|| rays.look(&mesh.patches, EYE, 0.3).len());
}
