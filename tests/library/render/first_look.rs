//! First looks: where the automatic camera stands, how bright its picture is, and what a picture says of
//! unfinished light.

use glam::DVec3;
use radiosity::TriMesh;
use radiosity::colour::Rgb;
use radiosity::render::{automatic_camera, exposure_seen, render, save};
use radiosity::scene::Camera;
use radiosity::tone::{Exposure, exposure_scale, exposure_value};

use super::{EXPOSED, add_grid, camera_in_front, room, shown, small, square};

const ASPECT: f64 = 4.0 / 3.0;

/// Adds some of the sides of a box, which are 0 to 5 at low x, high x, low y, high y, low z and high z.
fn add_box(
    mesh: &mut TriMesh,
    (low, high): (DVec3, DVec3),
    sides: &[usize],
    inward: bool,
    value: f64,
) {
    let size = high - low;
    let axes = [DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z];
    for &side in sides {
        let (axis, is_high) = (side / 2, side % 2 == 1);
        let origin = if is_high { low + axes[axis] } else { low };
        let (u, v) = (axes[(axis + 1) % 3], axes[(axis + 2) % 3]);
        let corners = if is_high == inward { [origin, v, u] } else { [origin, u, v] };
        add_grid(mesh, corners, 6, Rgb::splat(value));
    }
}

const ALL: [usize; 6] = [0, 1, 2, 3, 4, 5];
const WITHOUT_LID: [usize; 5] = [0, 1, 2, 4, 5];
const WALLS: [usize; 4] = [0, 1, 4, 5];

fn box_at(low: [f64; 3], high: [f64; 3]) -> (DVec3, DVec3) {
    (DVec3::from(low), DVec3::from(high))
}

fn is_within(point: DVec3, (low, high): (DVec3, DVec3)) -> bool {
    point.cmpgt(low).all() && point.cmplt(high).all()
}

const LIVING_ROOM: [[f64; 3]; 2] = [[-3.0, 0.05, -2.5], [3.0, 2.65, 2.5]];

/// A dim room in a house with a sunlit lawn all around.
fn house() -> TriMesh {
    let mut mesh = TriMesh::default();
    add_grid(
        &mut mesh,
        [DVec3::new(-20.0, 0.0, -20.0), 40.0 * DVec3::Z, 40.0 * DVec3::X],
        8,
        Rgb::splat(300.0),
    );
    let [low, high] = LIVING_ROOM;
    add_box(&mut mesh, box_at([-3.3, 0.01, -2.8], [3.3, 3.0, 2.8]), &ALL, false, 300.0);
    add_box(&mut mesh, box_at(low, high), &ALL, true, 1.0);
    mesh
}

#[test]
fn in_a_furnished_room_the_eye_stands_free() {
    let size = DVec3::new(5.0, 2.7, 4.0);
    let mut mesh = room(size, false);
    let furniture = [
        box_at([0.0, 0.0, 0.0], [0.7, 2.2, 1.2]),
        box_at([4.2, 0.0, 2.9], [5.0, 2.0, 4.0]),
        box_at([1.8, 0.0, 1.6], [3.4, 0.8, 2.4]),
    ];
    for block in furniture {
        add_box(&mut mesh, block, &ALL, false, 1.5);
    }
    let camera = automatic_camera(&mesh, ASPECT);
    assert!(is_within(camera.eye, (DVec3::ZERO, size)), "{camera:?}");
    assert!((1.2..2.0).contains(&camera.eye.y), "not at eye height: {camera:?}");
    for (low, high) in furniture {
        let around = (low - DVec3::splat(0.1), high + DVec3::splat(0.1));
        assert!(!is_within(camera.eye, around), "in or at furniture: {camera:?}");
    }
}

#[test]
fn in_a_courtyard_without_a_roof_the_eye_is_between_its_walls() {
    let mut mesh = TriMesh::default();
    let (inner, outer) =
        (box_at([-6.0, 0.0, -8.0], [6.0, 6.0, 8.0]), box_at([-8.0, 0.0, -10.0], [8.0, 6.0, 10.0]));
    add_box(&mut mesh, inner, &WITHOUT_LID, true, 1.0);
    add_box(&mut mesh, outer, &WALLS, false, 2.0);
    // The roofs all around.
    for (low, high) in [
        ([-8.0, 6.0, -10.0], [8.0, 6.0, -8.0]),
        ([-8.0, 6.0, 8.0], [8.0, 6.0, 10.0]),
        ([-8.0, 6.0, -8.0], [-6.0, 6.0, 8.0]),
        ([6.0, 6.0, -8.0], [8.0, 6.0, 8.0]),
    ] {
        add_box(&mut mesh, box_at(low, high), &[3], false, 2.0);
    }
    let camera = automatic_camera(&mesh, ASPECT);
    assert!(is_within(camera.eye, inner) && camera.eye.y < 3.0, "{camera:?}");
}

#[test]
fn a_thing_on_its_own_is_seen_from_outside() {
    let bounds = box_at([0.0, 0.0, 0.0], [2.0, 3.0, 2.0]);
    let mut mesh = TriMesh::default();
    add_box(&mut mesh, bounds, &ALL, false, 1.0);
    assert!(!is_within(automatic_camera(&mesh, ASPECT).eye, bounds));
    // Its inside is there, but dark.
    add_box(&mut mesh, bounds, &ALL, true, 0.0);
    assert!(!is_within(automatic_camera(&mesh, ASPECT).eye, bounds));
}

#[test]
fn of_a_house_on_a_lawn_the_room_is_seen() {
    let [low, high] = LIVING_ROOM;
    let camera = automatic_camera(&house(), ASPECT);
    assert!(is_within(camera.eye, box_at(low, high)), "{camera:?}");
}

#[test]
fn exposure_is_by_what_the_camera_sees() {
    let mesh = house();
    let ev = |camera: &Camera| match exposure_seen(&mesh, camera, ASPECT) {
        Exposure::Found(ev) => ev,
        other => panic!("{other:?}"),
    };
    let inside = ev(&automatic_camera(&mesh, ASPECT));
    let outside = ev(&Camera { eye: DVec3::new(0.0, 8.0, 25.0), ..camera_in_front(1.0) });
    // Of an evenly lit room, 0.22 is middle grey.
    let wanted = exposure_value(0.22);
    assert!((inside - wanted).abs() < 0.7, "{inside} {wanted}");
    assert!((outside - inside - 300.0_f64.log2()).abs() < 1.4, "{outside} {inside}");
}

#[test]
fn cameras_in_one_evenly_lit_room_have_one_exposure() {
    let mesh = room(DVec3::new(5.0, 2.7, 4.0), false);
    let whole = exposure_value(exposure_scale(&mesh, Exposure::Automatic));
    for target in [DVec3::ZERO, DVec3::new(5.0, 2.0, 3.0), DVec3::new(0.0, 1.0, 4.0)] {
        let eye = DVec3::new(2.5, 1.5, 2.0);
        let camera = Camera { eye, target, vertical_fov: 1.2, ..camera_in_front(1.0) };
        assert_eq!(exposure_seen(&mesh, &camera, ASPECT), Exposure::Found(whole), "{target}");
    }
}

#[test]
fn a_lamp_in_the_picture_does_not_set_its_exposure() {
    let with_lamp = |radiosity: f64| {
        let mut mesh = square(4, 1.0);
        let corner = DVec3::new(-0.3, -0.3, 0.01);
        add_grid(&mut mesh, [corner, 0.6 * DVec3::X, 0.6 * DVec3::Y], 2, Rgb::splat(radiosity));
        exposure_scale(&mesh, exposure_seen(&mesh, &camera_in_front(5.0), 1.0))
    };
    let stops = (with_lamp(1.0) / with_lamp(1e5)).log2();
    assert!((0.0..1.0).contains(&stops), "{stops}");
}

#[test]
fn unfinished_light_is_told_in_a_corner_of_a_png_and_nowhere_else() {
    let folder = tempfile::tempdir().unwrap();
    for radiosity in [0.0, 0.3, 1e3] {
        let done = render(&square(2, radiosity), &camera_in_front(1.0), &small(200, 120));
        let mut undone = done.clone();
        undone.unfinished = true;
        let [one, other] = [&done, &undone].map(|picture| shown(picture, &EXPOSED));
        let differing =
            one.enumerate_pixels().filter(|&(x, y, pixel)| other.get_pixel(x, y) != pixel);
        let places: Vec<(u32, u32)> = differing.map(|(x, y, _)| (x, y)).collect();
        assert!(places.len() > 200 && places.iter().all(|&(x, y)| x < 100 && y < 30));
        let corner = || other.enumerate_pixels().filter(|&(x, y, _)| x < 80 && y < 20);
        let [bright, dark] = [true, false]
            .map(|bright| corner().filter(|(_, _, pixel)| (pixel.0[0] > 200) == bright).count());
        assert!(bright > 100 && dark > 500, "{bright} bright and {dark} dark pixels");
        let files = [("done.exr", &done), ("undone.exr", &undone)].map(|(name, picture)| {
            let path = folder.path().join(name);
            save(picture, &path, &EXPOSED).unwrap();
            std::fs::read(path).unwrap()
        });
        assert!(files[0] == files[1], "linear values have no letters in them");
    }
}
