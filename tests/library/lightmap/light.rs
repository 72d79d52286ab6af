//! Laws of the light in a map.

use std::f64::consts::PI;

use fastrand::Rng;
use glam::{DVec3, Vec3};
use radiosity::colour::Rgb;
use radiosity::lightmap::{Atlas, Lightmap, bake};
use radiosity::reconstruct::Irradiance;

use super::scenes::{BALL, Lit, ROOM, halved, lookup, texel_of};
use crate::common::{Stage, coarse, corners, triangle_area};

/// The same scene where every vertex of a surface has the light that `light` says, W/(m² sr).
fn painted(lit: &Lit, light: impl Fn(usize) -> f64) -> Lit {
    let mut painted = lit.clone();
    for triangle in 0..lit.mesh.triangles.len() {
        let direct = Rgb::splat(PI * light(lit.surface(triangle)));
        for corner in lit.mesh.triangles[triangle] {
            painted.mesh.irradiance[corner as usize] =
                Irradiance { direct, ..Irradiance::default() };
        }
    }
    painted
}

fn baked<'a>(lit: &'a Lit, atlas: &'a Atlas) -> Lightmap<'a> {
    bake(&lit.surfaces, atlas, &lit.solution, &lit.mesh)
}

#[test]
fn where_light_is_the_same_everywhere_every_texel_of_a_chart_has_it() {
    for (scene, size) in [(&*BALL, 256), (&*ROOM, 128)] {
        let lit = &painted(scene, |_| 2.5);
        let atlas = Atlas::new(&lit.surfaces, size).unwrap();
        let map = baked(lit, &atlas);
        let mut count = 0;
        for chart in &atlas.charts {
            for y in chart.corner.y..chart.corner.y + chart.texels.y {
                for x in chart.corner.x..chart.corner.x + chart.texels.x {
                    let texel = map.texels[(y * size + x) as usize];
                    assert!(texel.distance(Vec3::splat(2.5)) < 1e-4, "{texel} at {x}, {y}");
                    count += 1;
                }
            }
        }
        assert!(count > size * size / 4, "{count} texels");
    }
}

#[test]
fn black_beside_bright_stays_black_in_two_mip_levels_too() {
    let brightness = |surface: usize| if surface.is_multiple_of(2) { 1e3 } else { 0.0 };
    let lit = &painted(&ROOM, brightness);
    let atlas = Atlas::new(&lit.surfaces, 128).unwrap();
    let mut texels = baked(lit, &atlas).texels;
    for level in 0..3 {
        let size = 128 >> level;
        for (triangle, corners) in lit.mesh.triangles.iter().enumerate() {
            let surface = lit.surface(triangle);
            let chart = &atlas.charts[atlas.chart_of[surface] as usize];
            for corner in corners {
                let texel = chart.texel(lit.mesh.positions[*corner as usize]);
                let found = lookup(&texels, size, texel / f64::from(1 << level));
                let light = Vec3::splat(brightness(surface) as f32);
                assert!(found.distance(light) < 1e-2, "{found} for {light}, level {level}");
            }
        }
        texels = halved(&texels, size);
    }
}

/// Mean distance of lookups from interpolated light, as a share of the mean light.
fn mean_error(lit: &Lit, size: u32) -> f64 {
    let atlas = Atlas::new(&lit.surfaces, size).unwrap();
    let map = baked(lit, &atlas);
    let mut rng = Rng::with_seed(3);
    let (mut error, mut light) = (0.0, 0.0);
    for triangle in 0..lit.mesh.triangles.len() {
        let area = triangle_area(corners(&lit.mesh, lit.mesh.triangles[triangle]));
        let sample = lit.random(&atlas, triangle, &mut rng);
        let found = lookup(&map.texels, size, sample.texel).as_dvec3();
        error += area * found.distance(sample.light);
        light += area * sample.light.length();
    }
    error / light
}

#[test]
fn lookups_agree_with_the_mesh_the_better_the_finer_the_map() {
    for (lit, most) in [(&ROOM, 0.015), (&BALL, 0.02)] {
        let [coarse, fine] = [128, 512].map(|size| mean_error(lit, size));
        assert!(fine < most && fine < 0.5 * coarse, "{fine} with 512 texels, {coarse} with 128");
    }
}

#[test]
fn lookups_are_never_beyond_the_light_within_three_texels() {
    let lit = &*ROOM;
    let atlas = Atlas::new(&lit.surfaces, 256).unwrap();
    let map = baked(lit, &atlas);
    let mut rng = Rng::with_seed(5);
    for triangle in (0..lit.mesh.triangles.len()).step_by(23) {
        let sample = lit.random(&atlas, triangle, &mut rng);
        let chart = &atlas.charts[atlas.chart_of[sample.surface] as usize];
        let (mut least, mut most) = (Rgb::INFINITY, Rgb::ZERO);
        for (other, corners) in lit.mesh.triangles.iter().enumerate() {
            let texels = corners.map(|c| chart.texel(lit.mesh.positions[c as usize]));
            let low = texels.iter().fold(texels[0], |low, &t| low.min(t)) - 3.0;
            let high = texels.iter().fold(texels[0], |high, &t| high.max(t)) + 3.0;
            let is_near = sample.texel.cmpge(low).all() && sample.texel.cmple(high).all();
            if is_near && lit.surface(other) == sample.surface {
                for &corner in corners {
                    (least, most) = (least.min(lit.light(corner)), most.max(lit.light(corner)));
                }
            }
        }
        let found = lookup(&map.texels, 256, sample.texel).as_dvec3();
        let within = found.cmpge(least * (1.0 - 1e-5)).all() && found.cmple(most * 1.00001).all();
        assert!(within, "{found} of {least} to {most}");
    }
}

#[test]
fn the_power_that_arrives_is_the_mesh_s() {
    for lit in [&*ROOM, &*BALL] {
        let atlas = Atlas::new(&lit.surfaces, 512).unwrap();
        let map = baked(lit, &atlas);
        let triangle_power = |triangle: [u32; 3], light: [DVec3; 3]| {
            triangle_area(corners(&lit.mesh, triangle)) * light.iter().sum::<DVec3>() / 3.0
        };
        let mesh = lit.mesh.triangles.iter();
        let on_mesh: DVec3 = mesh.map(|&t| triangle_power(t, t.map(|v| lit.light(v)))).sum();
        let mut rng = Rng::with_seed(7);
        let mut on_map = DVec3::ZERO;
        for triangle in 0..lit.mesh.triangles.len() {
            let light = [(); 3].map(|()| {
                let sample = lit.random(&atlas, triangle, &mut rng);
                lookup(&map.texels, 512, sample.texel).as_dvec3()
            });
            on_map += triangle_power(lit.mesh.triangles[triangle], light);
        }
        let ratio = on_map.element_sum() / on_mesh.element_sum();
        assert!((ratio - 1.0).abs() < 0.01, "{ratio} of the power");
    }
}

#[test]
fn what_is_seen_is_albedo_times_texel_plus_emission() {
    let lit = &*ROOM;
    let atlas = Atlas::new(&lit.surfaces, 1024).unwrap();
    let map = baked(lit, &atlas);
    let (mut error, mut all) = (0.0, 0.0);
    for part in &atlas.mesh.parts {
        let material = &lit.surfaces[part.material];
        let (reflectance, emission) = (material.reflectance, material.emission);
        for triangle in &atlas.mesh.triangles[part.triangles.clone()] {
            let centre = triangle.map(|v| atlas.mesh.light_uvs[v as usize]).iter().sum();
            let texel = lookup(&map.texels, 1024, texel_of(&map, centre) / 3.0).as_dvec3();
            let places = triangle.map(|v| atlas.mesh.positions[v as usize]);
            let place = places.iter().sum::<DVec3>() / 3.0;
            let normal = (places[1] - places[0]).cross(places[2] - places[0]).normalize();
            let Some(radiosity) = radiosity_at(lit, place, normal) else { continue };
            let seen = reflectance * texel + emission;
            error += (seen - radiosity / PI).length();
            all += (radiosity / PI).length();
        }
    }
    assert!(all > 20.0 && error < 0.02 * all, "{error} of {all}");
}

/// Interpolated radiosity at a place on what faces this way.
fn radiosity_at(lit: &Lit, place: DVec3, facing: DVec3) -> Option<Rgb> {
    lit.mesh.triangles.iter().find_map(|&triangle| {
        let [a, b, c] = corners(&lit.mesh, triangle);
        let normal = (b - a).cross(c - a);
        let weights = [[b, c], [c, a], [a, b]].map(|[from, to]| {
            (to - from).cross(place - from).dot(normal) / normal.length_squared()
        });
        let is_on = (place - a).dot(facing).abs() < 1e-9 && normal.normalize().dot(facing) > 0.999;
        let mix = |(corner, weight): (u32, f64)| lit.mesh.radiosity[corner as usize] * weight;
        let is_in = is_on && weights.iter().all(|&weight| weight >= -1e-9);
        is_in.then(|| triangle.into_iter().zip(weights).map(mix).sum())
    })
}

#[test]
fn each_side_of_a_thin_sheet_has_its_own_light() {
    let mut stage = Stage::default();
    let (sheet, lamp) = (stage.double_sided(0.5, 0.0), stage.material(0.0, 10.0));
    stage.lamp(sheet, DVec3::new(-1.0, 1.0, -1.0), DVec3::new(1.0, 1.0, 1.0));
    stage.lamp(lamp, DVec3::new(-0.5, 2.0, -0.5), DVec3::new(0.5, 2.0, 0.5));
    let lit = &Lit::new(&stage.scene, &coarse());
    let atlas = Atlas::new(&lit.surfaces, 64).unwrap();
    let map = baked(lit, &atlas);
    let middle = |surface: usize| {
        let chart = &atlas.charts[atlas.chart_of[surface] as usize];
        lookup(&map.texels, 64, chart.texel(DVec3::Y)).x
    };
    let upper = usize::from(lit.surfaces.list[0].plane.normal.y < 0.0);
    assert_ne!(atlas.chart_of[0], atlas.chart_of[1]);
    assert!(middle(upper) > 1.0 && middle(1 - upper) == 0.0, "{} {}", middle(0), middle(1));
}
