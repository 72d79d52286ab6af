//! Laws of atlases.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use radiosity::lightmap::{Atlas, BLOCK, PADDING, SIZES};
use radiosity::{Error, Surfaces, surfaces_of};

use super::scenes::{ball, room};
use crate::common::{area_of, shipped, triangle_area};

/// Facets of a ball, around and from pole to pole.
const FACETS: [usize; 2] = [48, 24];

fn surfaces() -> Vec<Surfaces> {
    [room(), ball(FACETS), shipped("two-rooms.obj")].iter().map(surfaces_of).collect()
}

/// Corners in texels and in metres of a surface's triangles.
fn corners(atlas: &Atlas, triangle: [u32; 3]) -> ([DVec2; 3], [DVec3; 3]) {
    let mesh = &atlas.mesh;
    let texel = |v: u32| mesh.light_uvs[v as usize].as_dvec2() * f64::from(atlas.size);
    (triangle.map(texel), triangle.map(|v| mesh.positions[v as usize]))
}

fn doubled([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

#[test]
fn rectangles_of_charts_lie_apart_in_the_atlas_on_whole_blocks() {
    for (surfaces, size) in surfaces().iter().zip([128, 512, 300]) {
        let atlas = Atlas::new(surfaces, size).unwrap();
        let mut owners = vec![None; (size * size) as usize];
        for (number, chart) in atlas.charts.iter().enumerate() {
            assert_eq!((chart.corner % BLOCK, chart.texels % BLOCK), Default::default());
            assert!((chart.corner + chart.texels).max_element() <= size, "{chart:?}");
            for y in chart.corner.y..chart.corner.y + chart.texels.y {
                for x in chart.corner.x..chart.corner.x + chart.texels.x {
                    let owner = owners[(y * size + x) as usize].replace(number);
                    assert_eq!(owner, None, "texel {x}, {y}");
                }
            }
        }
    }
}

#[test]
fn surfaces_keep_away_from_the_border_of_their_rectangle() {
    for surfaces in surfaces() {
        let atlas = Atlas::new(&surfaces, 256).unwrap();
        let padding = DVec2::splat(f64::from(PADDING) - 1e-3);
        for uv in &atlas.mesh.light_uvs {
            assert!(uv.min_element() > 0.0 && uv.max_element() < 1.0, "{uv}");
            let texel = uv.as_dvec2() * 256.0;
            let keeps_away = atlas.charts.iter().any(|chart| {
                let low = chart.corner.as_dvec2() + padding;
                let high = (chart.corner + chart.texels).as_dvec2() - padding;
                texel.cmpge(low).all() && texel.cmple(high).all()
            });
            assert!(keeps_away, "{texel}");
        }
    }
}

#[test]
fn no_place_of_a_map_belongs_to_two_places_of_surfaces() {
    for surfaces in surfaces() {
        let atlas = Atlas::new(&surfaces, 512).unwrap();
        let mut owners: HashMap<[i64; 2], usize> = HashMap::new();
        for (number, &triangle) in atlas.mesh.triangles.iter().enumerate() {
            let (texels, _) = corners(&atlas, triangle);
            let low = texels.iter().fold(DVec2::INFINITY, |low, &t| low.min(t)).floor();
            let high = texels.iter().fold(DVec2::ZERO, |high, &t| high.max(t)).ceil();
            for y in low.y as i64..high.y as i64 {
                for x in low.x as i64..high.x as i64 {
                    let centre = DVec2::new(x as f64, y as f64) + 0.5;
                    let inside = |k: usize| {
                        let (from, to) = (texels[k], texels[(k + 1) % 3]);
                        (to - from).normalize().perp_dot(centre - from) > 1e-3
                    };
                    if (0..3).all(inside) {
                        let owner = owners.insert([x, y], number);
                        assert_eq!(owner, None, "texel {x}, {y}");
                    }
                }
            }
        }
        assert!(owners.len() > 20_000, "{} texels", owners.len());
    }
}

#[test]
fn all_surfaces_are_in_the_mesh_as_finely_as_others() {
    for (surfaces, least) in surfaces().iter().zip([0.999, 0.66, 0.999]) {
        let atlas = Atlas::new(surfaces, 512).unwrap();
        let mut area = 0.0;
        for &triangle in &atlas.mesh.triangles {
            let (texels, places) = corners(&atlas, triangle);
            let own = triangle_area(places);
            area += own;
            let share = doubled(texels) / 2.0 / (own * atlas.density * atlas.density);
            assert!((least..1.001).contains(&share), "{share} of its texels");
        }
        assert!((area / surfaces.area() - 1.0).abs() < 1e-6, "{area} m²");
    }
}

#[test]
fn a_ball_takes_few_charts_and_its_facets_share_vertices() {
    let surfaces = surfaces_of(&ball(FACETS));
    let facets = surfaces.list.len() - 2;
    assert_eq!(facets, 2 * FACETS[0] * (FACETS[1] - 1));
    let atlas = Atlas::new(&surfaces, 512).unwrap();
    assert!(atlas.charts.len() < 24, "{} charts", atlas.charts.len());
    let vertices = atlas.mesh.positions.len();
    assert!(2 * vertices < 2 * facets, "{vertices} vertices of {facets} facets");
}

#[test]
fn the_mesh_of_a_closed_scene_has_no_t_junction() {
    let scene = room();
    let mesh = Atlas::new(&surfaces_of(&scene), 256).unwrap().mesh;
    let bits = |v: u32| mesh.positions[v as usize].to_array().map(f64::to_bits);
    let mut edges: HashMap<_, i32> = HashMap::new();
    for [a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((bits(*from), bits(*to))).or_default() += 1;
            *edges.entry((bits(*to), bits(*from))).or_default() -= 1;
        }
    }
    let open = edges.values().filter(|&&count| count > 0).count();
    // The rectangle of the lamp is closed by a lid of its own.
    assert_eq!(open, 0, "of {} edges", edges.len());
    let area: f64 =
        mesh.triangles.iter().map(|t| triangle_area(t.map(|v| mesh.positions[v as usize]))).sum();
    assert!((area / area_of(&scene) - 1.0).abs() < 1e-9);
}

#[test]
fn a_size_out_of_range_or_too_small_is_refused() {
    let surfaces = surfaces_of(&room());
    for size in [0, SIZES.start() - 1, SIZES.end() + 1, 16] {
        let error = Atlas::new(&surfaces, size).unwrap_err();
        assert!(matches!(error, Error::Setting { name: "lightmap", .. }), "{size}: {error}");
    }
    assert!(Atlas::new(&surfaces, 64).is_ok());
}
