//! Laws of rays through patches: the nearest is met, none slips through, and packets agree.

use std::f64::consts::TAU;

use glam::DVec3;
use proptest::prelude::*;
use radiosity::mesh::{Mesh, Patch};
use radiosity::visibility::PatchHierarchy;
use radiosity::visibility::packet::{NOTHING, Packet, RAYS};
use radiosity::{Length, Scene, Settings, surfaces_of};

use crate::common::{Block, Stage, coarse, furnished_room};

pub(crate) fn mesh_of(scene: &Scene, patches_across: f64) -> Mesh {
    let patch_size = Length::OfScene(1.0 / patches_across);
    Mesh::new(&surfaces_of(scene), &Settings { patch_size, ..coarse() })
}

pub(crate) fn blocks() -> [Block; 2] {
    [
        Block { base: DVec3::new(1.2, 0.0, 1.3), size: DVec3::new(0.8, 1.2, 0.7), turn: 0.5 },
        Block { base: DVec3::new(2.9, 0.9, 3.3), size: DVec3::new(0.9, 0.6, 1.1), turn: 0.0 },
    ]
}

/// Unit vectors all around, the six axes among them.
fn directions(count: usize) -> Vec<DVec3> {
    let spiral = (0..count).map(|k| {
        let z = 1.0 - 2.0 * (k as f64 + 0.5) / count as f64;
        let (sine, cosine) = (k as f64 * 0.618_034 * TAU).sin_cos();
        DVec3::new(cosine, sine, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    });
    let axes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    spiral.chain(axes).collect()
}

/// Casts each of many directions as a ray of a packet.
fn cast(hierarchy: &PatchHierarchy, eye: DVec3, directions: &[DVec3]) -> Vec<(u32, f32)> {
    let packet = |rays: &[DVec3]| {
        let ray = |k: usize| rays[k.min(rays.len() - 1)];
        Packet::new([0, 1, 2].map(|axis| std::array::from_fn(|k| ray(k)[axis] as f32)))
    };
    let mut packets: Vec<Packet> = directions.chunks(RAYS).map(packet).collect();
    hierarchy.cast(eye, &mut packets);
    let hits = packets.iter().flat_map(|p| p.patch.into_iter().zip(p.nearness));
    hits.take(directions.len()).collect()
}

/// Distance to the nearest patch and its number, by a test of each; `None` if a ray is too near an
/// edge to tell.
fn brute(patches: &[Patch], eye: DVec3, direction: DVec3) -> Option<(u32, f64)> {
    let mut nearest = (NOTHING, f64::INFINITY);
    for (patch, index) in patches.iter().zip(0..) {
        let height = (eye - patch.corners[0]).dot(patch.normal);
        let distance = -height / direction.dot(patch.normal);
        if height.abs() < 1e-9 || (patch.two_sided && height < 0.0) || distance.is_nan() {
            continue;
        }
        let at = eye + direction * distance;
        let depth = |k: usize| {
            let (a, b) = (patch.corners[k], patch.corners[(k + 1) % patch.corners.len()]);
            (b - a).cross(at - a).dot(patch.normal) / (b - a).length()
        };
        let depth = (0..patch.corners.len()).map(depth).fold(f64::INFINITY, f64::min);
        if distance <= 0.0 || depth < -1e-4 {
            continue;
        }
        if depth < 1e-4 {
            return None;
        }
        if distance < nearest.1 {
            nearest = (index, distance);
        }
    }
    Some(nearest)
}

fn point(range: f64) -> impl Strategy<Value = DVec3> {
    (-range..range, -range..range, -range..range).prop_map(DVec3::from)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn single_rays_and_packets_meet_what_a_test_of_every_patch_finds(
        triangles in prop::collection::vec(([point(1.0), point(1.0), point(1.0)], any::<bool>()), 1..12),
        eye in point(1.0),
    ) {
        let mut stage = Stage::default();
        let sides = [stage.material(0.5, 0.0), stage.double_sided(0.5, 0.0)];
        for (corners, double) in &triangles {
            let [a, b, c] = corners;
            if (b - a).cross(c - a).length() > 0.1 {
                stage.polygon(sides[usize::from(*double)], corners);
            }
        }
        let mesh = mesh_of(&stage.scene, 4.0);
        let hierarchy = PatchHierarchy::new(&mesh.patches);
        let directions = directions(300);
        let packets = cast(&hierarchy, eye, &directions);
        for (&direction, (patch, nearness)) in directions.iter().zip(packets) {
            let Some((expected, distance)) = brute(&mesh.patches, eye, direction) else { continue };
            let found = hierarchy.first(eye, direction);
            prop_assert_eq!(found.map_or(NOTHING, |(patch, _)| patch.0), expected);
            prop_assert_eq!(patch, expected, "in a packet along {}", direction);
            let nearest = found.map_or(f64::INFINITY, |(_, distance)| distance);
            prop_assert!(nearest == distance || (nearest / distance - 1.0).abs() < 2e-5);
            prop_assert!((f64::from(nearness) * distance.min(1e9) - 1.0).abs() < 2e-5 || expected == NOTHING);
        }
    }
}

/// Asserts that rays from `eye` meet something, whatever they aim at: corners, edges, the axes.
fn assert_closed(mesh: &Mesh, hierarchy: &PatchHierarchy, eye: DVec3) -> usize {
    let corners = mesh.patches.iter().flat_map(|patch| {
        let corners = patch.corners.iter();
        let edges = corners.clone().zip(patch.corners.iter().cycle().skip(1));
        corners.copied().chain(edges.map(|(a, b)| a.midpoint(*b))).collect::<Vec<DVec3>>()
    });
    let aimed = corners.filter_map(|corner| (corner - eye).try_normalize());
    let directions: Vec<DVec3> = aimed.chain(directions(500)).collect();
    for (&direction, (patch, _)) in directions.iter().zip(cast(hierarchy, eye, &directions)) {
        // A ray inside a wall's own plane meets the walls beside it.
        assert_ne!(patch, NOTHING, "packet from {eye} along {direction}");
        assert!(hierarchy.first(eye, direction).is_some(), "ray from {eye} along {direction}");
    }
    directions.len()
}

#[test]
fn no_ray_slips_out_of_a_closed_room() {
    // Walls are cut in different numbers of patches: corners of some lie on edges of others.
    let mesh = mesh_of(&furnished_room(&blocks()), 17.0);
    let hierarchy = PatchHierarchy::new(&mesh.patches);
    let mut rays = 0;
    for k in 0..6 {
        let share = |step: f64| 0.02 + 0.96 * (0.3 + f64::from(k) * step).fract();
        let eye = DVec3::new(4.0 * share(0.618), 3.0 * share(0.755), 5.0 * share(0.57));
        rays += assert_closed(&mesh, &hierarchy, eye);
    }
    // In the middle, so that many rays run along lines of the grid.
    rays += assert_closed(&mesh, &hierarchy, DVec3::new(2.0, 1.5, 2.5));
    assert!(rays > 30_000, "only {rays} rays");
}

#[test]
fn a_ray_never_meets_the_patch_it_starts_on() {
    // The block that floats: under the other one is no room for rays.
    let mesh = mesh_of(&furnished_room(&blocks()[1..]), 9.0);
    let hierarchy = PatchHierarchy::new(&mesh.patches);
    for patch in &mesh.patches {
        let eye = patch.corners.iter().sum::<DVec3>() / patch.corners.len() as f64;
        let directions: Vec<DVec3> = directions(80)
            .into_iter()
            .map(|d| d * d.dot(patch.normal).signum())
            .filter(|d| d.dot(patch.normal) > 1e-6)
            .collect();
        for (&direction, (met, _)) in directions.iter().zip(cast(&hierarchy, eye, &directions)) {
            let met = &mesh.patches[met as usize];
            assert!(met.surface != patch.surface, "{eye} along {direction}");
            let (met, distance) = hierarchy.first(eye, direction).expect("the room is closed");
            assert!(mesh[met].surface != patch.surface && distance > 1e-9, "{eye} {direction}");
        }
    }
}

#[test]
fn of_faces_back_to_back_the_front_is_met() {
    let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let square = square.map(|(x, y)| DVec3::new(x, y, 0.0));
    let mut reversed = square;
    reversed.reverse();
    let mut single = Stage::default();
    let grey = single.material(0.5, 0.0);
    single.polygon(grey, &square);
    single.polygon(grey, &reversed);
    let mut double = Stage::default();
    let grey = double.double_sided(0.5, 0.0);
    double.polygon(grey, &square);
    for scene in [single.scene, double.scene] {
        let mesh = mesh_of(&scene, 3.0);
        let hierarchy = PatchHierarchy::new(&mesh.patches);
        for side in [1.0, -1.0] {
            let eye = DVec3::new(0.3, 0.2, side);
            let direction = DVec3::new(0.1, -0.2, -side).normalize();
            let (patch, _) = hierarchy.first(eye, direction).expect("it is hit");
            assert_eq!(mesh[patch].normal, DVec3::Z * side, "the side that looks at the eye");
            assert_eq!(cast(&hierarchy, eye, &[direction])[0].0, patch.0, "in a packet");
        }
    }
}

#[test]
fn a_scene_without_patches_lets_all_rays_pass() {
    let hierarchy = PatchHierarchy::new(&[]);
    assert!(hierarchy.first(DVec3::ZERO, DVec3::X).is_none());
    assert_eq!(cast(&hierarchy, DVec3::ZERO, &[DVec3::X])[0].0, NOTHING);
}
