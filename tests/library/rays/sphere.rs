//! Laws of the sphere of rays, against exact form factors and the hemicube.

use glam::DVec3;
use radiosity::form_factor::contour::point_to_polygon;
use radiosity::form_factor::hemicube::{self, DeltaFactors, Hemicube, HemicubeScene};
use radiosity::form_factor::rays::{Rays, Sphere};
use radiosity::mesh::{Mesh, Patch};
use radiosity::surfaces_of;
use radiosity::visibility::packet::RAYS;
use radiosity::visibility::{Occluders, PatchHierarchy, SurfacePoint};

use super::patches::{blocks, mesh_of};
use crate::common::furnished_room;

/// The k-th of some triangles above the plane z = 0, large and small.
fn triangle(k: usize) -> [DVec3; 3] {
    let share = |step: f64| 2.0 * ((k as f64 + 1.0) * step).fract() - 1.0;
    let middle = DVec3::new(2.0 * share(0.618_034), 2.0 * share(0.754_878), 1.5 + share(0.569_84));
    let size = if k.is_multiple_of(2) { 0.4 } else { 0.1 };
    [[0.819_17, 0.671_04, 0.549_7], [0.856_67, 0.733_89, 0.628_71], [0.880_27, 0.774_88, 0.682_1]]
        .map(|steps| middle + size * DVec3::from(steps.map(share)))
}

/// Root of the mean squared error of the form factors of triangles.
fn error(sphere: &Sphere, turn: f64) -> f64 {
    const TRIANGLES: usize = 200;
    let directions: Vec<DVec3> = sphere.directions().map(|d| d.rotate_z(turn)).collect();
    let squared = (0..TRIANGLES).map(|k| {
        let [a, b, c] = triangle(k);
        let sign = a.cross(b).dot(c).signum();
        let normals = [a.cross(b), b.cross(c), c.cross(a)].map(|normal| normal * sign);
        let inside = |d: &&DVec3| normals.iter().all(|normal| normal.dot(**d) >= 0.0);
        let share = directions.iter().filter(inside).count() as f64 * sphere.delta();
        (share - point_to_polygon(DVec3::ZERO, DVec3::Z, &[a, b, c])).powi(2)
    });
    (squared.sum::<f64>() / TRIANGLES as f64).sqrt()
}

#[test]
fn delta_factors_sum_to_one_and_rays_point_up() {
    for count in [1, 100, 4096, 50_001] {
        let sphere = Sphere::new(count);
        assert!((count..count + RAYS).contains(&sphere.rays()), "{} for {count}", sphere.rays());
        assert!((sphere.delta() * sphere.rays() as f64 - 1.0).abs() < 1e-12);
        assert!(sphere.directions().all(|d| (d.length() - 1.0).abs() < 1e-6 && d.z > 0.0));
    }
}

#[test]
fn rays_are_spread_by_the_cosine() {
    let sphere = Sphere::new(40_000);
    let count = |inside: &dyn Fn(DVec3) -> bool| {
        sphere.directions().filter(|&d| inside(d)).count() as f64 * sphere.delta()
    };
    // Shares of the unit disc: rings, and sectors.
    for k in 1..10 {
        let radius = f64::from(k) / 10.0;
        let ring = count(&|d| d.truncate().length() < radius);
        assert!((ring - radius * radius).abs() < 1e-4, "{ring} within {radius}");
        let sector = count(&|d| d.y.atan2(d.x).abs() < radius);
        assert!((sector - radius / std::f64::consts::PI).abs() < 5e-4, "{sector} within {radius}");
    }
}

#[test]
fn errors_fall_faster_than_with_random_rays() {
    // Random rays would be off by about 0.1 / √n.
    for (count, most) in [(1 << 10, 2.5e-3), (1 << 14, 3.0e-4), (1 << 18, 4.0e-5)] {
        let sphere = Sphere::new(count);
        for turn in [0.0, 0.4] {
            let found = error(&sphere, turn);
            assert!(found < most, "{found:e} with {count} rays, turned by {turn}");
        }
    }
}

/// Places on the floor between the blocks.
fn eyes() -> impl Iterator<Item = DVec3> {
    (0..12)
        .map(|k| {
            let share = |step: f64| 0.05 + 0.9 * (f64::from(k) * step).fract();
            DVec3::new(4.0 * share(0.618_034), 0.0, 5.0 * share(0.754_878))
        })
        .filter(|&eye| !blocks()[0].covers(eye, -0.05))
}

#[test]
fn nothing_escapes_from_a_closed_room() {
    let mesh = mesh_of(&furnished_room(&blocks()), 17.0);
    let hierarchy = PatchHierarchy::new(&mesh.patches);
    let sphere = Sphere::new(30_000);
    let mut rays = Rays::new(&sphere, &hierarchy);
    for (k, eye) in eyes().enumerate() {
        let sights = rays.look(&mesh.patches, SurfacePoint::new(eye, DVec3::Y), k as f64);
        assert_eq!(rays.escaping(), 0.0, "at {eye}");
        let sum: f64 = sights.iter().map(|sight| sight.delta).sum();
        assert!((sum - 1.0).abs() < 1e-9, "{sum} at {eye}");
        assert!(sights.iter().all(|sight| sight.front), "a closed room shows no backs at {eye}");
        assert!(sights.is_sorted_by_key(|sight| sight.patch), "sights come in order");
    }
}

#[test]
fn rays_see_what_a_hemicube_sees() {
    let surfaces = surfaces_of(&furnished_room(&blocks()));
    let mesh = mesh_of(&furnished_room(&blocks()), 6.0);
    let occluders = Occluders::new(&surfaces);
    let (hierarchy, sphere) = (PatchHierarchy::new(&mesh.patches), Sphere::new(200_000));
    let delta = DeltaFactors::new(256);
    let targets = HemicubeScene::new(&mesh.patches);
    let mut hemicube = Hemicube::new(&delta, &targets, &occluders);
    let mut rays = Rays::new(&sphere, &hierarchy);
    for eye in eyes().take(4) {
        let mut factors = vec![0.0; mesh.patches.len()];
        for sight in hemicube.look(SurfacePoint::new(eye, DVec3::Y), 0.2).visible_patches() {
            factors[sight.patch.index()] = sight.delta;
        }
        for sight in rays.look(&mesh.patches, SurfacePoint::new(eye, DVec3::Y), 0.7) {
            factors[sight.patch.index()] -= sight.delta;
        }
        let worst = factors.iter().fold(0.0, |worst: f64, f| worst.max(f.abs()));
        assert!(worst < 1e-3, "{worst} at {eye}");
    }
}

/// Root of the mean squared error of the form factors of an empty room's patches.
fn error_in_room(mesh: &Mesh, eye: DVec3, sights: impl Iterator<Item = (usize, f64)>) -> f64 {
    let exact = |patch: &Patch| {
        let in_plane = patch.corners.iter().all(|corner| corner.y == eye.y);
        if in_plane { 0.0 } else { point_to_polygon(eye, DVec3::Y, &patch.corners) }
    };
    let mut errors: Vec<f64> = mesh.patches.iter().map(exact).collect();
    sights.for_each(|(patch, delta)| errors[patch] -= delta);
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

#[test]
fn a_million_rays_err_a_third_of_a_plain_hemicube_at_most() {
    let mut room = crate::common::Stage::default();
    let grey = room.material(0.5, 0.0);
    room.room(grey, DVec3::ZERO, DVec3::new(4.0, 3.0, 5.0));
    let mesh = mesh_of(&room.scene, 8.0);
    let occluders = Occluders::new(&surfaces_of(&room.scene));
    let (hierarchy, sphere) = (PatchHierarchy::new(&mesh.patches), Sphere::new(1_000_000));
    let delta = DeltaFactors::new(256);
    let targets = HemicubeScene::new(&mesh.patches);
    let mut hemicube = Hemicube::new(&delta, &targets, &occluders);
    let mut rays = Rays::new(&sphere, &hierarchy);
    let (mut by_cells, mut by_rays) = (0.0, 0.0);
    for (k, eye) in eyes().take(3).enumerate() {
        let from = SurfacePoint::new(eye, DVec3::Y);
        let cells = hemicube.look(from, k as f64).visible_patches();
        by_cells += error_in_room(&mesh, eye, cells.map(|s| (s.patch.index(), s.delta)));
        let sights = rays.look(&mesh.patches, from, k as f64).into_iter();
        by_rays += error_in_room(&mesh, eye, sights.map(|s| (s.patch.index(), s.delta)));
    }
    assert!(by_rays < by_cells / 3.0, "{by_rays:e} for {by_cells:e}");
    assert!(by_rays / 3.0 < 1e-4, "{by_rays:e}");
}

#[test]
fn a_hemicube_of_fewer_cells_than_patches_looks_by_rays() {
    let scene = furnished_room(&blocks());
    let mesh = mesh_of(&scene, 130.0);
    let coarse = mesh_of(&scene, 6.0);
    let (occluders, delta) = (Occluders::new(&surfaces_of(&scene)), DeltaFactors::new(32));
    assert!(mesh.patches.len() > 4 * 3 * 32 * 32, "only {} patches", mesh.patches.len());
    let (fine, rough) = (HemicubeScene::new(&mesh.patches), HemicubeScene::new(&coarse.patches));
    let by_surface = |mesh: &Mesh, sights: &[hemicube::VisiblePatch]| {
        let mut factors = vec![0.0; 1 + mesh.patches.last().map_or(0, |p| p.surface.index())];
        sights.iter().for_each(|s| factors[mesh[s.patch].surface.index()] += s.delta);
        factors
    };
    for eye in eyes().take(4) {
        let mut by_rays = Hemicube::new(&delta, &fine, &occluders);
        let seen = by_rays
            .look(SurfacePoint::new(eye, DVec3::Y), 0.3)
            .visible_patches()
            .collect::<Vec<_>>();
        let mut drawn = Hemicube::new(&delta, &rough, &occluders);
        let expected =
            drawn.look(SurfacePoint::new(eye, DVec3::Y), 0.3).visible_patches().collect::<Vec<_>>();
        assert_eq!(by_rays.escaping(), 0.0, "at {eye}");
        assert!(seen.is_sorted_by_key(|sight| sight.patch) && seen.iter().all(|s| s.front));
        // Cells do not know how surfaces are cut into patches.
        let (seen_of, expected_of) = (by_surface(&mesh, &seen), by_surface(&coarse, &expected));
        for (f, e) in seen_of.iter().zip(&expected_of) {
            assert!((f - e).abs() < 2e-3, "{f} for {e} at {eye}");
        }
        let sum: f64 = seen
            .iter()
            .map(|s| s.visible * point_to_polygon(eye, DVec3::Y, &mesh[s.patch].corners))
            .sum();
        assert!((sum - 1.0).abs() < 1e-4, "shares of form factors add up to {sum} at {eye}");
    }
}
