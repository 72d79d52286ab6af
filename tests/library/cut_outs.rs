//! Laws of faces whose pictures have holes: they cover what their pictures cover, and light goes through the rest.

use std::f64::consts::PI;

use crate::common::{self, Stage, coarse, mesh_of, solve};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use radiosity::geometry::polygon::contains;
use radiosity::scene::{MaterialId, Sampler, Wrap};
use radiosity::{Scene, Settings, surfaces_of};

/// Where the corners of a picture lie on a card: counter-clockwise, from the bottom left.
const WHOLE: [DVec2; 4] = [DVec2::Y, DVec2::ONE, DVec2::X, DVec2::ZERO];

const STEPS: Sampler = Sampler { wrap: [Wrap::Repeat; 2], nearest: true };

/// A horizontal card that faces down, of `half` its width around (0, height, 0).
fn card(stage: &mut Stage, material: MaterialId, [half, height]: [f64; 2], uvs: [DVec2; 4]) {
    let corners = [(-half, half), (-half, -half), (half, -half), (half, half)];
    stage.polygon(material, &corners.map(|(x, z)| DVec3::new(x, height, z))).uvs =
        uvs.as_slice().into();
}

/// A floor under a lamp.
fn lit_floor() -> Stage {
    let mut stage = Stage::default();
    let [grey, light] = [(0.5, 0.0), (0.0, 10.0)].map(|(rho, l)| stage.material(rho, l));
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    stage.polygon(grey, &corners.map(|(x, z)| DVec3::new(x, 0.0, z)));
    stage.lamp(light, DVec3::new(-0.5, 2.0, -0.5), DVec3::new(0.5, 2.0, 0.5));
    stage
}

/// Mean and extremes of radiosity on the floor, W/m².
fn floor_light(scene: &Scene) -> [f64; 3] {
    let settings = Settings { tolerance: 0.02, ..coarse() };
    let mesh = mesh_of(scene, &settings);
    let floor = mesh.triangles.iter().filter(|triangle| {
        triangle.iter().all(|&corner| mesh.positions[corner as usize].y.abs() < 1e-9)
    });
    let [mut power, mut area, mut least, mut most] = [0.0, 0.0, f64::MAX, 0.0_f64];
    for &triangle in floor {
        let own = common::triangle_area(common::corners(&mesh, triangle));
        for light in common::radiosities(&mesh, triangle) {
            power += own * light / 3.0;
            (least, most) = (least.min(light), most.max(light));
        }
        area += own;
    }
    [power / area, least, most]
}

#[test]
fn a_checkered_card_lets_half_of_the_light_of_a_large_lamp_through() {
    let clear = floor_light(&lit_floor().scene);
    for (cells, wanted) in [([1, 1], 0.5), ([3, 1], 0.25)] {
        let mut stage = lit_floor();
        // Of each cells[0] + 1 texels along either diagonal pattern, cells[0] are opaque.
        let period = f64::from(cells[0] + cells[1]);
        let opacity = |at: DVec2| {
            let texel = (at * 16.0).floor();
            let number = (texel.x + 2.0 * texel.y * f64::from(u8::from(period > 2.0)) + texel.y)
                .rem_euclid(period);
            f64::from(u8::from(number < f64::from(cells[0])))
        };
        let black = stage.cut_out([0.0, 0.0], (16, STEPS), opacity);
        card(&mut stage, black, [0.8, 1.6], WHOLE);
        let found = floor_light(&stage.scene.build().unwrap());
        let share = found[0] / clear[0];
        assert!((share / wanted - 1.0).abs() < 0.02, "{share} of the light, {wanted} of the card");
    }
}

#[test]
fn a_card_of_which_the_picture_shows_a_half_is_half_a_card() {
    let light = |add: &dyn Fn(&mut Stage)| {
        let mut stage = lit_floor();
        add(&mut stage);
        let surfaces = surfaces_of(&stage.scene.clone().build().unwrap());
        (surfaces.area(), floor_light(&stage.scene))
    };
    let masked = |sampler: Sampler| {
        light(&move |stage| {
            let black =
                stage.cut_out([0.3, 0.0], (8, sampler), |at| f64::from(u8::from(at.x > 0.5)));
            card(stage, black, [0.4, 1.0], WHOLE);
        })
    };
    let halved = light(&|stage| {
        let black = stage.material(0.3, 0.0);
        let corners = [(-0.4, 0.4), (-0.4, 0.0), (0.4, 0.0), (0.4, 0.4)];
        stage.polygon(black, &corners.map(|(x, z)| DVec3::new(x, 1.0, z)));
    });
    // u = 0 is at z = 0.4, which is a hole; by turning the picture, it is not.
    let turned = light(&|stage| {
        let black = stage.cut_out([0.3, 0.0], (8, STEPS), |at| f64::from(u8::from(at.x < 0.5)));
        card(stage, black, [0.4, 1.0], WHOLE);
    });
    let mixed = Sampler { wrap: [Wrap::Clamp; 2], nearest: false };
    for (area, light) in [masked(STEPS), masked(mixed), turned] {
        assert!((area - halved.0).abs() < 1e-9, "{area} m², not {}", halved.0);
        for (light, halved) in light.into_iter().zip(halved.1) {
            assert!((light / halved - 1.0).abs() < 0.02, "{light}, not {halved} W/m²");
        }
    }
}

/// Opacity of a disc around the middle of a picture, its border as wide as a texel.
fn disc(radius: f64, size: u32) -> impl Fn(DVec2) -> f64 {
    move |at| 0.5 + (radius - at.distance(DVec2::splat(0.5))) * f64::from(size)
}

/// A lamp of one cut-out card.
fn cut_card(
    (size, sampler): (u32, Sampler),
    uvs: [DVec2; 4],
    opacity: impl Fn(DVec2) -> f64,
) -> Scene {
    let mut stage = Stage::default();
    let lamp = stage.cut_out([0.5, 1.0], (size, sampler), opacity);
    card(&mut stage, lamp, [0.5, 0.0], uvs);
    stage.scene
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_disc_covers_its_area(size in 16_u32..200, radius in 0.25..0.45, times in 1_u8..4, turn in 0.0..6.3, wrap in 0..2_usize) {
        let wrap = [Wrap::Repeat, Wrap::Mirror][wrap];
        let sampler = Sampler { wrap: [wrap; 2], nearest: size % 2 == 0 };
        // Squares of texels are as much of a disc as there are texels with their middle in it.
        let opacity = disc(radius, size);
        let there = (0..size * size).filter(|texel| {
            let texel = DVec2::new((texel % size).into(), (texel / size).into());
            opacity((texel + 0.5) / f64::from(size)) >= 0.5
        });
        let exact = match sampler.nearest {
            true => there.count() as f64 / f64::from(size * size),
            false => PI * radius * radius,
        };
        let straight = surfaces_of(&cut_card((size, sampler), WHOLE.map(|uv| uv * f64::from(times)), &opacity));
        prop_assert!((straight.area() / exact - 1.0).abs() < 0.01, "{} of {exact} m²", straight.area());
        // Turned about the middle of the picture, the disc stays on the card.
        let turned = WHOLE.map(|uv| DVec2::splat(0.5) + DVec2::from_angle(turn).rotate(uv - 0.5));
        let clamped = Sampler { wrap: [Wrap::Clamp; 2], ..sampler };
        let turned = surfaces_of(&cut_card((size, clamped), turned, &opacity));
        prop_assert!((turned.area() / exact - 1.0).abs() < 0.01, "{} of {exact} m²", turned.area());
        prop_assert_eq!(turned.list.len(), 1);
    }
}

/// A leaf with five fingers.
fn fingers(at: DVec2) -> f64 {
    let offset = at - 0.5;
    let radius = 0.3 + 0.15 * (5.0 * offset.to_angle()).cos();
    0.5 + 20.0 * (radius - offset.length())
}

#[test]
fn what_is_seen_of_a_leaf_is_what_light_falls_on() {
    let mixed = Sampler::default();
    let surfaces = surfaces_of(&cut_card((256, mixed), WHOLE, fingers));
    let [leaf] = &surfaces.list[..] else { panic!("{} surfaces", surfaces.list.len()) };
    let uv = leaf.uv.unwrap();
    let places = (0..200 * 200).map(|k| DVec2::new(f64::from(k % 200), f64::from(k / 200)) / 200.0);
    let wrong = places.filter(|&place| {
        let is_there = contains(&leaf.rings, uv.inverse().transform_point2(place));
        is_there != (fingers(place) >= 0.5)
    });
    let share = wrong.count() as f64 / (200.0 * 200.0) / leaf.area();
    assert!(share < 0.01, "{share} of the leaf is not where it is seen");
    assert!(leaf.rings[0].len() < 80, "{} corners", leaf.rings[0].len());
}

#[test]
fn a_furnace_with_leaves_glows_alike_everywhere() {
    let (mut stage, reflectance) = (Stage::default(), 0.6);
    let glowing = stage.material(reflectance, 1.0 / PI);
    stage.room(glowing, DVec3::splat(-1.0), DVec3::ONE);
    let leaf = stage.cut_out([reflectance, 1.0 / PI], (64, Sampler::default()), fingers);
    stage.scene.materials[leaf.index()].double_sided = true;
    card(&mut stage, leaf, [0.6, 0.1], WHOLE);
    let mesh = mesh_of(&stage.scene.build().unwrap(), &coarse());
    for (radiosity, place) in mesh.radiosity.iter().zip(&mesh.positions) {
        let share = radiosity * (1.0 - reflectance);
        // Hemicubes of 64 cells see the leaf's border in steps.
        assert!((share - 1.0).abs().max_element() < 0.01, "{share} at {place}");
    }
}

#[test]
fn a_crowd_of_leaves_has_a_bounded_number_of_corners_and_its_area() {
    let mut stage = Stage::default();
    let leaf = stage.cut_out([0.5, 1.0], (128, Sampler::default()), fingers);
    let count: u32 = 4000;
    for k in 0..count {
        card(&mut stage, leaf, [0.5, f64::from(k)], WHOLE);
        if let Some(face) = stage.scene.faces.last_mut() {
            // Each a little elsewhere on its card.
            face.uvs.iter_mut().for_each(|uv| uv.x += f64::from(k) / f64::from(count) / 50.0);
        }
    }
    // And one mesh of 40 × 40 squares, each with a hole in it, as large as 400 of them.
    let grille = stage.cut_out([0.5, 1.0], (16, STEPS), |at| (at - 0.5).abs().max_element() * 2.0);
    card(&mut stage, grille, [10.0, -1.0], WHOLE.map(|uv| uv * 40.0));
    let exact = surfaces_of(&cut_card((128, Sampler::default()), WHOLE, fingers)).area();
    let surfaces = surfaces_of(&stage.scene);
    let corners: usize = surfaces.list.iter().flat_map(|s| &s.rings).map(Vec::len).sum();
    assert!(corners <= 60_000, "{corners} corners");
    let (grille, leaves) = surfaces.list.split_last().unwrap();
    assert!((grille.area() / 300.0 - 1.0).abs() < 0.02, "{} of 300 m²", grille.area());
    assert!(grille.rings.len() > 100, "{} rings", grille.rings.len());
    for leaf in leaves {
        assert!((leaf.area() / exact - 1.0).abs() < 0.02, "{} of {exact} m²", leaf.area());
    }
    assert!(
        surfaces.notes[0]
            .starts_with("cut-outs: 4001 faces cut along their masks into 4001 pieces"),
        "{:?}",
        surfaces.notes
    );
}

#[test]
fn without_a_place_for_the_picture_most_of_it_decides() {
    for (opaque, left) in [(0.6, 2), (0.4, 1)] {
        let mut stage = lit_floor();
        let leaf = stage.cut_out([0.5, 0.0], (10, STEPS), |at| f64::from(u8::from(at.x < opaque)));
        card(&mut stage, leaf, [0.5, 1.0], [DVec2::splat(0.3); 4]);
        let surfaces = surfaces_of(&stage.scene);
        assert_eq!(surfaces.list.len(), 1 + left);
        assert!(surfaces.notes[0].starts_with("1 face whose cut-out"), "{:?}", surfaces.notes);
    }
    let nothing = surfaces_of(&cut_card((4, STEPS), WHOLE, |_| 0.0));
    assert!(nothing.check().unwrap_err().to_string().contains("cut-outs"), "{:?}", nothing.flaw);
}

#[test]
fn cut_outs_are_the_same_with_any_number_of_threads() {
    let scene = cut_card((64, Sampler::default()), WHOLE.map(|uv| uv * 3.0), fingers);
    let outcome = || {
        let surfaces = surfaces_of(&scene);
        let solution = solve(&surfaces, &coarse());
        format!("{:?} {:?} {:?}", surfaces.list, solution.mesh.vertices, solution.vertex_light)
    };
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert!(alone.install(outcome) == outcome(), "threads change the outlines");
}
