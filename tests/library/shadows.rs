//! Laws of shadows: lines where geometry says, no small shadow overlooked, cuts that lose nothing.

use crate::common::{Block, Stage, assert_sane, coarse, mesh_of, shipped, solve};
use glam::DVec3;
use proptest::prelude::*;
use radiosity::direct::{DirectLight, Emitters};
use radiosity::mesh::{Crossing, ElementId, Mesh, PatchId, Reason, Split, Vertex};
use radiosity::scene::MaterialId;
use radiosity::visibility::Occluders;
use radiosity::{Length, Scene, Settings, Surfaces, surfaces_of};

/// A floor of 4 × 4 m under a square lamp of 0.2 m at 2 m, with something between.
fn floor_with(add: impl FnOnce(&mut Stage, MaterialId)) -> Surfaces {
    let mut stage = Stage::default();
    let [grey, black, light] =
        [(0.5, 0.0), (0.0, 0.0), (0.0, 100.0)].map(|(rho, l)| stage.material(rho, l));
    let corners = [(-2.0, -2.0), (-2.0, 2.0), (2.0, 2.0), (2.0, -2.0)];
    stage.polygon(grey, &corners.map(|(x, z)| DVec3::new(x, 0.0, z)));
    stage.lamp(light, DVec3::new(-0.1, 2.0, -0.1), DVec3::new(0.1, 2.0, 0.1));
    add(&mut stage, black);
    surfaces_of(&stage.scene)
}

/// A black square of 0.4 m at half the lamp's height.
fn square(stage: &mut Stage, black: MaterialId) {
    let corners = [(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2)];
    stage.polygon(black, &corners.map(|(x, z)| DVec3::new(x, 1.0, z)));
}

#[test]
fn lines_bound_umbra_and_penumbra() {
    let surfaces = floor_with(square);
    let mesh = Mesh::new(&surfaces, &Settings { patch_size: Length::Metres(9.0), ..coarse() });
    let (emitters, occluders) = (Emitters::new(&surfaces, &mesh), Occluders::new(&surfaces));
    let lines = DirectLight::new(emitters, occluders, &mesh).lines(&mesh, PatchId(0), 0.0);
    let lines: Vec<[DVec3; 2]> = lines.iter().map(|line| line.ends).collect();
    assert!(lines.iter().flatten().all(|p| p.y.abs() < 1e-12), "lines lie on the floor");
    // At half the height, an edge at x throws its shadow from a lamp at u to 2x - u.
    let has = |x: f64| lines.iter().any(|line| line.iter().all(|p| (p.x - x).abs() < 1e-12));
    for x in [-0.5, -0.3, 0.3, 0.5] {
        assert!(has(x), "no line at {x} m");
    }
    assert!(!has(0.0) && !has(0.4), "lines where there is no event");
    let reach = lines.iter().flatten().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    assert!((reach - 0.5).abs() < 1e-12, "the penumbra ends at 0.5 m, lines at {reach} m");
}

#[test]
fn elements_are_cut_along_the_border_of_a_sharp_shadow() {
    let surfaces = floor_with(square);
    let settings = Settings { tolerance: 0.02, max_level: 8, ..coarse() };
    // Cuts end at sixteenths of edges.
    let near_umbra = |settings: &Settings| {
        let mesh = solve(&surfaces, settings).mesh;
        let place = |v: &Vertex| surfaces[v.surface].plane.lift(v.position);
        let is_near = |p: &DVec3| p.y == 0.0 && p.z.abs() < 0.25 && (p.x.abs() - 0.3).abs() < 0.004;
        mesh.vertices.iter().map(place).filter(is_near).count()
    };
    let without = near_umbra(&Settings { discontinuity_lines: false, ..settings.clone() });
    let with = near_umbra(&settings);
    assert!(with >= without + 6, "{with} vertices along the umbra, {without} without lines");
}

#[test]
fn the_shadow_of_a_wire_is_not_overlooked() {
    let wire = |stage: &mut Stage, black: MaterialId| {
        let size = DVec3::new(0.004, 0.6, 0.004);
        stage.block(black, Block { base: DVec3::new(0.613, 0.0, 0.271), size, turn: 0.3 });
    };
    let settings =
        Settings { tolerance: 0.02, max_level: 8, min_element: Length::Metres(0.004), ..coarse() };
    let [without, with] = [floor_with(|_, _| ()), floor_with(wire)].map(|surfaces| {
        let mesh = solve(&surfaces, &settings).mesh;
        let by_shadow = [Some(Reason::ShadowEdge), Some(Reason::Discontinuity)];
        let shadowed = mesh.elements.iter().filter(|e| by_shadow.contains(&e.reason));
        shadowed.count()
    });
    assert_eq!(without, 0, "a bare floor has no shadow");
    assert!(with > 10, "{with} elements were divided for the wire's shadow");
}

#[test]
fn light_is_a_number_in_all_scenes_of_shadows() {
    for name in ["pole.obj", "blind.obj", "table.obj", "coloured.obj"] {
        let scene: Scene = shipped(name);
        let settings = Settings { patch_size: Length::OfScene(0.1), ..coarse() };
        let mesh = mesh_of(&scene, &settings);
        assert_sane(&mesh);
        let is_number = |b: &DVec3| b.is_finite() && b.min_element() >= 0.0;
        assert!(mesh.radiosity.iter().all(is_number), "{name}");
    }
}

/// Mean difference of exact direct light from that by so many rays at the centres of a scene's patches,
/// as a share of the unoccluded.
fn error_of_rays(surfaces: &Surfaces, rays: u32) -> f64 {
    let mesh = Mesh::new(surfaces, &coarse());
    let occluders = Occluders::new(surfaces);
    let emitters = Emitters::new(surfaces, &mesh);
    let by_rays = emitters.clone().seen_by(Some(rays));
    let lit = mesh.patches.iter().filter_map(|patch| {
        let centre = patch.corners.iter().sum::<DVec3>() / patch.corners.len() as f64;
        let [exact, sampled] =
            [&emitters, &by_rays].map(|emitters| emitters.shine(&occluders, centre, patch.normal));
        let all = exact.unoccluded.element_sum();
        let error = (exact.irradiance - sampled.irradiance).element_sum().abs();
        (all > 0.0).then(|| error / all)
    });
    let errors: Vec<f64> = lit.collect();
    assert!(errors.len() > 50, "{} places are lit", errors.len());
    errors.iter().sum::<f64>() / errors.len() as f64
}

#[test]
fn direct_light_by_more_and_more_rays_becomes_the_exact_one() {
    for name in ["cornell-box.obj", "two-rooms.obj", "office.obj"] {
        let surfaces = surfaces_of(&shipped(name));
        let [few, many] = [64, 4096].map(|rays| error_of_rays(&surfaces, rays));
        assert!(many < 0.3 * few && many < 2e-3, "{name}: {few} by few rays, {many} by many");
    }
}

fn crossing() -> impl Strategy<Value = Crossing> {
    (0_usize..4, 0.0..1.0).prop_map(|(edge, share)| {
        let share = if share < 0.2 { 0.0 } else { share * 0.95 };
        Crossing { edge, share }
    })
}

proptest! {
    #[test]
    fn cuts_lose_nothing(from in crossing(), to in crossing(), then in 0_usize..3) {
        // Not along an edge.
        let ahead = |a: Crossing, b: Crossing| {
            let gap = (b.edge + 4 - a.edge) % 4;
            gap > 1 || (gap == 1 && b.share > 0.0)
        };
        prop_assume!(ahead(from, to) && ahead(to, from));
        let surfaces = floor_with(|_, _| ());
        let mut mesh = Mesh::new(&surfaces, &Settings { patch_size: Length::Metres(9.0), ..coarse() });
        let root = ElementId(0);
        mesh.split(root, Split::Along([from, to]), Reason::ShadowEdge);
        prop_assert_eq!(mesh[root].children.len(), 2);
        for part in mesh[root].children.clone() {
            let corners = &mesh[part].corners;
            prop_assert!((3..=5).contains(&corners.len()), "{corners:?}");
            if then == 1 {
                mesh.split(part, mesh.round_split(part), Reason::Gradient);
            }
        }
        mesh.validate();
    }
}
