//! Laws of surfaces and meshes: nothing is lost, and nothing straddles a line where light jumps.

use std::f64::consts::TAU;

use crate::common::{Block, Stage, area_of, coarse, furnished_room, shipped, solve};
use glam::{DAffine3, DVec2, DVec3};
use proptest::prelude::*;
use radiosity::geometry::cut::{Cuts, convex_pieces};
use radiosity::geometry::polygon::{Ring, Segment, area, edges};
use radiosity::mesh::{ElementId, Mesh, Reason, Split};
use radiosity::surface::Contact;
use radiosity::{Length, Scene, Settings, Surfaces, surfaces_of};

/// A star-shaped ring about `centre`: counter-clockwise, in general not convex.
fn star(centre: DVec2, radii: &[f64]) -> Ring {
    let angle = |k: usize| k as f64 / radii.len() as f64 * TAU;
    radii.iter().enumerate().map(|(k, &r)| centre + DVec2::from_angle(angle(k)) * r).collect()
}

/// A star with two holes in it.
fn region() -> impl Strategy<Value = Vec<Ring>> {
    let radii = |range: std::ops::Range<f64>| prop::collection::vec(range, 3..9);
    (radii(2.0..4.0), radii(0.1..0.45), radii(0.1..0.45)).prop_map(|(outer, first, second)| {
        let outer = if outer.len() < 5 { [outer.clone(), outer].concat() } else { outer };
        let hole = |centre, radii: &[f64]| star(centre, radii).into_iter().rev().collect();
        let apart = DVec2::X * 0.5;
        vec![star(DVec2::ZERO, &outer), hole(-apart, &first), hole(apart, &second)]
    })
}

fn segments() -> impl Strategy<Value = Vec<Segment>> {
    let place = || (-2.0..2.0, -2.0..2.0).prop_map(DVec2::from);
    prop::collection::vec((place(), place()).prop_map(|(a, b)| [a, b]), 0..4)
}

/// Length of the part of a segment more than `margin` inside a convex polygon.
fn length_inside(polygon: &[DVec2], [a, b]: Segment, margin: f64) -> f64 {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for [p, q] in edges(polygon) {
        let normal = (q - p).normalize_or_zero().perp();
        let (start, end) = ((a - p).dot(normal) - margin, (b - p).dot(normal) - margin);
        if start < 0.0 && end < 0.0 {
            return 0.0;
        }
        let crossing = start / (start - end);
        from = if start < 0.0 { from.max(crossing) } else { from };
        to = if end < 0.0 { to.min(crossing) } else { to };
    }
    (to - from).max(0.0) * a.distance(b)
}

fn is_convex(polygon: &[DVec2]) -> bool {
    let n = polygon.len();
    let turn = |k: usize| {
        let (a, b, c) = (polygon[k], polygon[(k + 1) % n], polygon[(k + 2) % n]);
        (b - a).normalize_or_zero().perp_dot((c - b).normalize_or_zero())
    };
    (0..n).all(|k| turn(k) >= -1e-6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn convex_pieces_keep_the_area_and_cross_no_line(rings in region(), lines in segments()) {
        let cuts = Cuts { segments: &lines, size: 1.0, epsilon: 1e-6 };
        let pieces = convex_pieces(&rings, &cuts);
        let whole: f64 = rings.iter().map(|ring| area(ring)).sum();
        let sum: f64 = pieces.iter().map(|piece| area(piece)).sum();
        prop_assert!((sum - whole).abs() < 1e-4 * whole, "{sum} m² of {whole}");
        for piece in &pieces {
            prop_assert!(is_convex(piece), "{piece:?}");
            for line in rings.iter().flat_map(|ring| edges(ring)).chain(lines.iter().copied()) {
                let inside = length_inside(piece, line, 1e-5);
                prop_assert!(inside < 1e-4, "{inside} m of {line:?} inside {piece:?}");
            }
        }
    }

    #[test]
    fn every_split_keeps_the_area(rings in region(), choices in prop::collection::vec(0_usize..3, 60)) {
        let mut stage = Stage::default();
        let grey = stage.material(0.5, 0.0);
        let corners: Vec<DVec3> = rings[0].iter().map(|p| DVec3::new(p.x, 0.0, -p.y)).collect();
        stage.polygon(grey, &corners);
        let surfaces = surfaces_of(&stage.scene);
        let mut mesh = Mesh::new(&surfaces, &coarse());
        for choice in choices {
            let leaves = mesh.leaves().filter(|&leaf| mesh.sides(leaf).into_iter().all(|s| s > 0.05));
            let leaves: Vec<ElementId> = leaves.collect();
            let leaf = leaves[choice * (leaves.len() - 1) / 2];
            let halves = mesh[leaf].corners.len() == 4 && choice < 2;
            let split = if halves { Split::Halves(choice) } else { Split::Quarters };
            mesh.split(leaf, split, Reason::Gradient);
        }
        mesh.validate();
        let sum: f64 = mesh.leaves().map(|leaf| mesh[leaf].area).sum();
        let whole = area(&rings[0]);
        prop_assert!((sum - whole).abs() < 1e-5 * whole, "{sum} m² of {whole}");
    }
}

#[test]
fn patches_cover_the_scene() {
    for name in ["cornell-box.obj", "office.obj", "two-rooms.obj"] {
        let scene = shipped(name);
        let mesh = Mesh::new(&surfaces_of(&scene), &coarse());
        mesh.validate();
        let share = mesh.patches.iter().map(|patch| patch.area).sum::<f64>() / area_of(&scene);
        assert!((share - 1.0).abs() < 1e-6, "{name}: {share}");
    }
}

#[test]
fn uniform_elements_are_no_longer_than_asked() {
    let settings = Settings { uniform: Some(0.2), ..coarse() };
    let mesh = Mesh::new(&surfaces_of(&furnished_room(&[])), &settings);
    mesh.validate();
    for leaf in mesh.leaves() {
        let [width, height] = mesh.sides(leaf);
        assert!(width.max(height) < 0.2001, "{width} × {height} m");
    }
}

/// The surface at the height `y` whose front looks along `up`.
fn horizontal(surfaces: &Surfaces, y: f64, up: f64) -> &radiosity::surface::Surface {
    let at = |s: &&radiosity::surface::Surface| {
        (s.plane.origin.y - y).abs() < 1e-9 && s.plane.normal.y * up > 0.999
    };
    surfaces.list.iter().find(at).unwrap()
}

#[test]
fn coplanar_faces_of_one_material_are_one_surface_with_a_hole() {
    let surfaces = surfaces_of(&shipped("two-rooms.obj"));
    let ceilings = surfaces.list.iter().filter(|s| {
        s.plane.normal.y < -0.999 && !s.is_emitter() && (s.plane.origin.y - 2.5).abs() < 1e-9
    });
    let rings: Vec<usize> = ceilings.map(|ceiling| ceiling.rings.len()).collect();
    assert_eq!(rings, [2], "one ceiling with one hole, by number of rings");
    let ceiling = horizontal(&surfaces, 2.5, -1.0);
    assert!((ceiling.area() - (8.2 * 3.0 - 1.2 * 0.6)).abs() < 1e-9);
}

#[test]
fn a_concave_polygon_is_one_surface() {
    let mut stage = Stage::default();
    let grey = stage.material(0.5, 0.0);
    let ell = [(0.0, 0.0), (0.0, 2.0), (1.0, 2.0), (1.0, 1.0), (2.0, 1.0), (2.0, 0.0)];
    stage.polygon(grey, &ell.map(|(x, z)| DVec3::new(x, 0.0, z)));
    let surfaces = surfaces_of(&stage.scene);
    assert_eq!(surfaces.list.len(), 1);
    assert!((surfaces.list[0].area() - 3.0).abs() < 1e-12);
    let mesh = Mesh::new(&surfaces, &coarse());
    assert!((mesh.patches.iter().map(|patch| patch.area).sum::<f64>() - 3.0).abs() < 1e-9);
}

fn contact_length(surface: &radiosity::surface::Surface) -> f64 {
    // The side and the base of a box both meet a floor along the same line.
    let mut lines: Vec<Segment> = Vec::new();
    for &Contact { segment: [a, b], .. } in &surface.contacts {
        let known = |&[p, q]: &Segment| {
            let near = |x: DVec2, y: DVec2| x.distance(y) < 1e-5;
            (near(p, a) && near(q, b)) || (near(p, b) && near(q, a))
        };
        if !lines.iter().any(known) {
            lines.push([a, b]);
        }
    }
    lines.iter().map(|[a, b]| a.distance(*b)).sum()
}

fn turned_block(y: f64) -> Block {
    Block { base: DVec3::new(2.0, y, 2.5), size: DVec3::new(0.8, 1.0, 0.6), turn: 0.3 }
}

#[test]
fn a_box_leaves_its_outline_on_the_floor_it_stands_on() {
    let surfaces = surfaces_of(&furnished_room(&[turned_block(0.0)]));
    let length = contact_length(horizontal(&surfaces, 0.0, 1.0));
    assert!((length - 2.8).abs() < 1e-4, "{length} m");
}

#[test]
fn a_box_leaves_its_outline_on_the_ceiling_it_hangs_under() {
    let surfaces = surfaces_of(&furnished_room(&[turned_block(2.0)]));
    let length = contact_length(horizontal(&surfaces, 3.0, -1.0));
    assert!((length - 2.8).abs() < 1e-4, "{length} m");
    assert!(horizontal(&surfaces, 0.0, 1.0).contacts.is_empty());
}

#[test]
fn a_box_in_mid_air_touches_nothing() {
    let surfaces = surfaces_of(&furnished_room(&[turned_block(0.5)]));
    let room = surfaces.list.iter().filter(|s| s.reflectance.x == 0.6);
    assert!(room.into_iter().all(|wall| wall.contacts.is_empty()));
}

#[test]
fn a_leaning_panel_touches_the_wall_along_its_top_and_the_floor_along_its_foot() {
    let mut stage = Stage { scene: furnished_room(&[]) };
    let both = stage.double_sided(0.5, 0.0);
    let panel = [(0.0, 1.0, 2.0), (0.0, 1.0, 1.0), (0.6, 0.0, 1.0), (0.6, 0.0, 2.0)];
    stage.polygon(both, &panel.map(DVec3::from));
    let surfaces = surfaces_of(&stage.scene);
    let wall = surfaces.list.iter().find(|s| s.plane.normal.x > 0.999).unwrap();
    assert!((contact_length(wall) - 1.0).abs() < 1e-5);
    assert!((contact_length(horizontal(&surfaces, 0.0, 1.0)) - 1.0).abs() < 1e-5);
}

#[test]
fn a_plate_that_pierces_a_wall_leaves_its_section_there() {
    let mut stage = Stage { scene: furnished_room(&[]) };
    let both = stage.double_sided(0.5, 0.0);
    let plate = [(-0.5, 1.0), (-0.5, 2.5), (0.7, 2.5), (0.7, 1.0)];
    stage.polygon(both, &plate.map(|(x, z)| DVec3::new(x, 1.2, z)));
    let surfaces = surfaces_of(&stage.scene);
    let wall = surfaces.list.iter().find(|s| s.plane.normal.x > 0.999).unwrap();
    assert!((contact_length(wall) - 1.5).abs() < 1e-5);
}

/// Asserts that no leaf has a part of a contact line inside it.
fn assert_no_straddling(scene: &Scene) {
    let surfaces = surfaces_of(scene);
    let mesh = solve(&surfaces, &coarse()).mesh;
    mesh.validate();
    for leaf in mesh.leaves() {
        let outline = mesh.outline(leaf);
        for &Contact { segment: line, .. } in &surfaces[mesh.surface_of(leaf)].contacts {
            let inside = length_inside(&outline, line, 10.0 * surfaces.epsilon);
            assert!(inside < 1e-4 * surfaces.extent, "{inside} m of {line:?} in {outline:?}");
        }
    }
}

#[test]
fn no_element_lies_on_both_sides_of_a_contact_line() {
    assert_no_straddling(&furnished_room(&[turned_block(0.0), turned_block(2.0)]));
    assert_no_straddling(&shipped("cornell-box.obj"));
    assert_no_straddling(&shipped("two-rooms.obj"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn contact_lines_are_kept_wherever_a_box_stands(x in 0.6..3.4, z in 0.6..4.4, turn in 0.0..TAU, sunk in 0.0_f64..0.2) {
        let block = Block { base: DVec3::new(x, -sunk, z), turn, ..turned_block(0.0) };
        let scene = furnished_room(&[block]);
        assert_no_straddling(&scene);
        let settings = Settings { patch_size: Length::Metres(0.4), ..coarse() };
        let surfaces = surfaces_of(&scene);
        let floor = horizontal(&surfaces, 0.0, 1.0);
        prop_assert!((contact_length(floor) - 2.8).abs() < 1e-4, "{:?}", floor.contacts);
        let area: f64 = Mesh::new(&surfaces, &settings).patches.iter().map(|p| p.area).sum();
        prop_assert!((area / area_of(&scene) - 1.0).abs() < 1e-6, "{area} m²");
    }
}

#[test]
fn surfaces_of_a_turned_scene_are_the_turned_surfaces() {
    let scene = furnished_room(&[turned_block(0.0)]);
    let turn = DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.9);
    let positions = scene.positions.iter().map(|&p| turn.transform_point3(p)).collect();
    let there = surfaces_of(&Scene { positions, ..scene.clone() });
    let here = surfaces_of(&scene);
    assert_eq!(here.list.len(), there.list.len());
    for (a, b) in here.list.iter().zip(&there.list) {
        assert!((a.area() - b.area()).abs() < 1e-9, "{} m² for {}", b.area(), a.area());
        assert_eq!(a.contacts.len(), b.contacts.len());
    }
}

#[test]
fn walls_of_triangles_are_divided_as_walls_of_four_corners() {
    let whole = furnished_room(&[Block {
        base: DVec3::new(1.5, 0.0, 2.2),
        size: DVec3::new(0.9, 1.1, 0.5),
        turn: 0.7,
    }]);
    let mut halved = whole.clone();
    halved.faces = whole
        .faces
        .iter()
        .flat_map(|face| {
            let half = |corners: [usize; 3]| {
                let vertices = corners.map(|k| face.vertices[k]).as_slice().into();
                radiosity::scene::Face { vertices, ..face.clone() }
            };
            [half([0, 1, 2]), half([2, 3, 0])]
        })
        .collect();
    let [whole, halved] = [whole, halved].map(|scene| {
        let mesh = solve(&surfaces_of(&scene), &coarse()).mesh;
        (mesh.patches.len(), mesh.leaves().count())
    });
    assert_eq!(whole, halved);
}
