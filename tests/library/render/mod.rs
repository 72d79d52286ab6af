//! Pictures show what the mesh carries, whoever computes them.

mod emission;
mod final_gather;
mod first_look;
mod views;

use std::f64::consts::PI;
use std::path::Path;

use glam::DVec3;
use radiosity::colour::{Rgb, linear_from_srgb, luminance};
use radiosity::reconstruct::MeshPart;
use radiosity::render::{Display, Picture, RenderOptions, View, automatic_camera, render, save};
use radiosity::scene::{Camera, Light, Sampler, Sky, Texture, Wrap};
use radiosity::{Error, TriMesh};

/// Adds a parallelogram of `cells` × `cells` squares, seen from where `u` turns left to `v`.
fn add_grid(mesh: &mut TriMesh, [origin, u, v]: [DVec3; 3], cells: u32, radiosity: Rgb) {
    let first_vertex = mesh.positions.len() as u32;
    let first_triangle = mesh.triangles.len();
    for row in 0..=cells {
        for column in 0..=cells {
            let [s, t] = [column, row].map(|index| f64::from(index) / f64::from(cells));
            mesh.positions.push(origin + s * u + t * v);
            mesh.normals.push(u.cross(v).normalize().as_vec3());
            mesh.uvs.push(glam::DVec2::new(s, t).as_vec2());
            mesh.radiosity.push(radiosity);
            mesh.texture_mean.push(Rgb::ONE);
        }
    }
    for row in 0..cells {
        for column in 0..cells {
            let a = first_vertex + row * (cells + 1) + column;
            let above = a + cells + 1;
            mesh.triangles.extend([[a, a + 1, above + 1], [a, above + 1, above]]);
        }
    }
    let triangles = first_triangle..mesh.triangles.len();
    mesh.parts.push(MeshPart {
        name: "grid".to_owned(),
        triangles,
        texture: None,
        cutoff: None,
        object: None,
    });
}

/// A square of 2 m in the plane z = 0 that faces +z, around the origin.
fn square(cells: u32, radiosity: f64) -> TriMesh {
    let mut mesh = TriMesh::default();
    let corner = DVec3::new(-1.0, -1.0, 0.0);
    add_grid(&mut mesh, [corner, 2.0 * DVec3::X, 2.0 * DVec3::Y], cells, Rgb::splat(radiosity));
    mesh
}

/// The inside of a box from 0 to `size`, without the side at z = 0 if `open`; its floor is brightest.
fn room(size: DVec3, open: bool) -> TriMesh {
    let mut mesh = TriMesh::default();
    let [x, y, z] = [size.x * DVec3::X, size.y * DVec3::Y, size.z * DVec3::Z];
    let wall = Rgb::splat(1.0);
    add_grid(&mut mesh, [DVec3::ZERO, z, x], 8, Rgb::splat(2.0));
    add_grid(&mut mesh, [y, x, z], 8, wall);
    add_grid(&mut mesh, [z, y, x], 8, wall);
    add_grid(&mut mesh, [DVec3::ZERO, y, z], 8, wall);
    add_grid(&mut mesh, [x, z, y], 8, wall);
    if !open {
        add_grid(&mut mesh, [DVec3::ZERO, x, y], 8, wall);
    }
    mesh
}

/// From `distance` m in front of the origin, of a height of 2 m there.
fn camera_in_front(distance: f64) -> Camera {
    Camera {
        name: String::new(),
        eye: distance * DVec3::Z,
        target: DVec3::ZERO,
        up: DVec3::Y,
        vertical_fov: 2.0 * (1.0 / distance).atan(),
    }
}

fn small(width: u32, height: u32) -> RenderOptions {
    RenderOptions { width, height, samples: 2, ..RenderOptions::default() }
}

fn shown(picture: &Picture, display: &Display) -> image::RgbImage {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    save(picture, &path, display).unwrap();
    image::open(path).unwrap().into_rgb8()
}

const EXPOSED: Display = Display { scale: 1.0, range: None };

#[test]
fn radiosity_pi_is_radiance_one_and_the_rest_is_background() {
    let options = RenderOptions { background: Rgb::splat(0.25), ..small(40, 20) };
    let picture = render(&square(3, PI), &camera_in_front(5.0), &options);
    for y in 0..20 {
        for x in 0..40 {
            let expected = if (10..30).contains(&x) { 1.0 } else { 0.25 };
            let radiance = picture.values[y * 40 + x];
            assert!((radiance - expected).abs().max_element() < 1e-6, "{x} {y}: {radiance}");
        }
    }
}

#[test]
fn the_sky_stands_behind_the_mesh_and_adds_up_to_its_irradiance() {
    for sky in [Sky::Uniform, Sky::Overcast] {
        let irradiance = Rgb::new(3.0, 2.0, 1.0);
        let light = Light::Sky { sky, irradiance };
        // ∫ L cos θ dω over the upper half, by rings of equal height.
        let rings = 1000;
        let ring = |k: i32| {
            let y = (f64::from(k) + 0.5) / f64::from(rings);
            let direction = DVec3::new((1.0 - y * y).sqrt(), y, 0.0);
            light.radiance(direction) * y * 2.0 * PI / f64::from(rings)
        };
        let sum: Rgb = (0..rings).map(ring).sum();
        assert!((sum - irradiance).abs().max_element() < 1e-5, "{sum}");
        for (view, seen) in [(View::Light, true), (View::Radiosity, false)] {
            let options = RenderOptions { view, sky: vec![light.clone().into()], ..small(40, 20) };
            let picture = render(&square(3, PI), &camera_in_front(5.0), &options);
            let [top, bottom] = [picture.values[0], picture.values[19 * 40]];
            assert_eq!(top.x > 0.2, seen, "{top}");
            assert!(bottom == glam::Vec3::ZERO, "{bottom}");
            assert!((picture.values[10 * 40 + 20].x - 1.0).abs() < 1e-6);
        }
    }
    let sun = Light::sun(90.0, 30.0, 50_000.0);
    let Light::Sun { direction, irradiance } = sun else { panic!("{sun:?}") };
    let half = 0.2666f64.to_radians();
    let disc = sun.radiance(-direction) * PI * half.sin().powi(2);
    assert!((disc / irradiance - Rgb::ONE).abs().max_element() < 1e-9);
    let beside = (-direction + direction.any_orthonormal_vector() * 0.006).normalize();
    assert_eq!(sun.radiance(beside), Rgb::ZERO);
}

#[test]
fn an_edge_through_a_pixel_is_graded_by_area() {
    let options = RenderOptions { samples: 4, ..small(33, 11) };
    let picture = render(&square(1, PI), &camera_in_front(5.0), &options);
    let row: f32 = picture.values[5 * 33..6 * 33].iter().map(|radiance| radiance.x).sum();
    assert!((row - 11.0).abs() < 0.26, "{row}");
}

#[test]
fn backs_are_not_seen() {
    let camera = Camera { eye: -5.0 * DVec3::Z, ..camera_in_front(5.0) };
    let picture = render(&square(3, PI), &camera, &small(8, 8));
    assert!(picture.coverage.iter().all(|&coverage| coverage == 0.0));
}

#[test]
fn no_ray_slips_between_triangles_met_at_their_edges() {
    // Pixel centres lie on the grid's lines, near and far, with the mesh moved far out.
    for (offset, distance) in [(0.0, 2.0), (0.0, 1024.0), (1e4, 16.0)] {
        let mut mesh = square(16, PI);
        let shift = DVec3::splat(offset);
        mesh.positions.iter_mut().for_each(|position| *position += shift);
        let camera = camera_in_front(distance);
        let camera = Camera { eye: camera.eye + shift, target: shift, ..camera };
        for pixels in [31, 63] {
            let options = RenderOptions { samples: 1, ..small(pixels, pixels) };
            let picture = render(&mesh, &camera, &options);
            let gaps = picture.coverage.iter().filter(|&&coverage| coverage < 1.0).count();
            assert_eq!(gaps, 0, "at {distance} m, offset {offset} m, {pixels} pixels");
        }
    }
}

#[test]
fn one_and_four_threads_agree_bit_for_bit() {
    let mesh = room(DVec3::new(4.0, 3.0, 5.0), false);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let options = RenderOptions { view: View::Wireframe, ..small(40, 30) };
            render(&mesh, &automatic_camera(&mesh, 4.0 / 3.0), &options)
        })
    };
    assert_eq!(with(1), with(4));
}

#[test]
fn a_texture_replaces_its_mean() {
    let mut mesh = square(1, PI / 2.0);
    mesh.texture_mean.fill(Rgb::splat(0.5));
    mesh.textures.push(Texture {
        width: 2,
        height: 1,
        texels: vec![[0.0; 3], [1.0; 3]].into(),
        sampler: Sampler { wrap: [Wrap::Clamp; 2], nearest: false },
        ..Texture::default()
    });
    mesh.parts[0].texture = Some(0);
    let picture = render(&mesh, &camera_in_front(5.0), &small(16, 16));
    let row = &picture.values[8 * 16..9 * 16];
    assert!(row[1].x < 1e-6 && (row[14].x - 1.0).abs() < 1e-6, "{row:?}");
}

#[test]
fn a_picture_of_one_grey_is_shown_as_a_plain_surface_and_darker_texels_in_proportion() {
    let mut mesh = square(1, PI * 0.8);
    let plain = shown(&render(&mesh, &camera_in_front(5.0), &small(16, 16)), &EXPOSED);
    mesh.textures.push(Texture {
        width: 2,
        height: 1,
        texels: vec![[0.1; 3], [0.2; 3]].into(),
        sampler: Sampler { wrap: [Wrap::Clamp; 2], nearest: false },
        ..Texture::default()
    });
    mesh.texture_mean.fill(Rgb::splat(0.2));
    mesh.parts[0].texture = Some(0);
    let picture = shown(&render(&mesh, &camera_in_front(5.0), &small(16, 16)), &EXPOSED);
    let linear = |image: &image::RgbImage, x| {
        linear_from_srgb(f64::from(image.get_pixel(x, 8).0[0]) / 255.0)
    };
    assert_eq!(picture.get_pixel(14, 8), plain.get_pixel(14, 8));
    let ratio = linear(&picture, 1) / linear(&picture, 14);
    assert!((ratio - 0.5).abs() < 0.01, "{ratio}");
}

#[test]
fn a_ray_goes_through_the_holes_of_a_cut_out() {
    let mut mesh = square(1, PI);
    mesh.textures.push(Texture {
        width: 2,
        height: 1,
        texels: vec![[1.0; 3]; 2].into(),
        alpha: vec![100, 200],
        sampler: Sampler { wrap: [Wrap::Clamp; 2], nearest: true },
        ..Texture::default()
    });
    mesh.parts[0].texture = Some(0);
    let seen = |cutoff| {
        mesh.parts[0].cutoff = cutoff;
        let picture = render(&mesh, &camera_in_front(5.0), &small(16, 16));
        [5, 10].map(|column| picture.coverage[8 * 16 + column])
    };
    assert_eq!([None, Some(0.5), Some(0.9)].map(seen), [[1.0; 2], [0.0, 1.0], [0.0; 2]]);
}

#[test]
fn the_automatic_camera_looks_into_a_room_from_its_open_side() {
    let camera = automatic_camera(&room(DVec3::splat(0.55), true), 1.0);
    assert!(camera.eye.z < 0.0 && camera.target.z > camera.eye.z, "{camera:?}");
}

#[test]
fn the_automatic_camera_sees_a_closed_room_from_inside() {
    let size = DVec3::new(5.0, 2.7, 4.0);
    let camera = automatic_camera(&room(size, false), 4.0 / 3.0);
    assert!(camera.eye.cmpgt(DVec3::ZERO).all() && camera.eye.cmplt(size).all(), "{camera:?}");
}

#[test]
fn the_automatic_camera_looks_down_on_a_floor_past_its_lamp() {
    let mut mesh = TriMesh::default();
    let corner = DVec3::new(-2.0, 0.0, -2.0);
    add_grid(&mut mesh, [corner, 4.0 * DVec3::Z, 4.0 * DVec3::X], 8, Rgb::ONE);
    let lamp = DVec3::new(-0.5, 2.0, -0.5);
    add_grid(&mut mesh, [lamp, DVec3::X, DVec3::Z], 1, Rgb::splat(50.0));
    let camera = automatic_camera(&mesh, 1.0);
    assert!(camera.eye.y > 1.0, "{camera:?}");
    let picture = render(&mesh, &camera, &small(32, 32));
    let filled = picture.coverage.iter().filter(|&&coverage| coverage > 0.5).count();
    assert!(filled > 32 * 32 / 4, "{filled}");
}

#[test]
fn a_mesh_of_nothing_has_a_camera_and_a_picture() {
    let mesh = TriMesh::default();
    let camera = automatic_camera(&mesh, f64::NAN);
    assert!(camera.eye.is_finite() && camera.eye != camera.target);
    let picture = render(&mesh, &camera, &small(200, 120));
    shown(&picture, &EXPOSED);
}

#[test]
fn mesh_lines_are_dark_on_bright_surfaces_and_bright_on_dark_ones() {
    for (radiosity, darker) in [(0.9, true), (0.0, false)] {
        let options = RenderOptions { view: View::Wireframe, ..small(64, 64) };
        let with_lines = render(&square(2, radiosity), &camera_in_front(5.0), &options);
        let mut without = with_lines.clone();
        without.lines.clear();
        let (lines, plain) = (shown(&with_lines, &EXPOSED), shown(&without, &EXPOSED));
        let middle = |image: &image::RgbImage| image.get_pixel(32, 16).0[0];
        assert_eq!(middle(&lines) < middle(&plain), darker);
        assert_ne!(middle(&lines), middle(&plain));
        assert_eq!(lines.get_pixel(40, 28), plain.get_pixel(40, 28), "off the lines");
    }
}

#[test]
fn lines_are_about_a_pixel_wide_at_any_distance() {
    for pixels in [64, 256] {
        let options = RenderOptions { view: View::Wireframe, ..small(pixels, pixels) };
        let picture = render(&square(2, 1.0), &camera_in_front(5.0), &options);
        // Between the grid's horizontal lines, across its vertical one in the middle.
        let first = (pixels * pixels / 4 + pixels * 3 / 8) as usize;
        let width: f32 = picture.lines[first..first + pixels as usize / 8 * 2].iter().sum();
        assert!((0.7..3.0).contains(&width), "{width}");
    }
}

#[test]
fn radiance_survives_hdr_and_exr_files() {
    let picture = render(&square(2, 3.0), &camera_in_front(5.0), &small(24, 12));
    let folder = tempfile::tempdir().unwrap();
    for (name, tolerance) in [("picture.exr", 0.0), ("picture.HDR", 0.01)] {
        let path = folder.path().join(name);
        save(&picture, &path, &EXPOSED).unwrap();
        let read = image::open(&path).unwrap().into_rgb32f();
        assert_eq!(read.dimensions(), (24, 12));
        for (pixel, radiance) in read.pixels().zip(&picture.values) {
            assert!((pixel.0[0] - radiance.x).abs() <= tolerance * radiance.x, "{name}");
        }
    }
}

#[test]
fn an_unknown_ending_is_an_error_with_the_path() {
    let picture = Picture::default();
    for name in ["picture.gif", "picture"] {
        let error = save(&picture, Path::new(name), &EXPOSED).unwrap_err();
        assert!(matches!(&error, Error::UnknownFormat { path, .. } if path == Path::new(name)));
    }
}

#[test]
fn a_folder_that_is_not_there_is_made() {
    let picture = render(&square(1, 1.0), &camera_in_front(5.0), &small(4, 4));
    let place = tempfile::tempdir().expect("temporary directories can be made");
    let path = place.path().join("not/there/picture.png");
    save(&picture, &path, &EXPOSED).expect("the folder is made");
    assert!(path.exists());
}

#[test]
fn a_folder_that_cannot_be_made_is_an_error_with_the_path() {
    let picture = render(&square(1, 1.0), &camera_in_front(5.0), &small(4, 4));
    let place = tempfile::NamedTempFile::new().expect("temporary files can be made");
    let error = save(&picture, &place.path().join("picture.png"), &EXPOSED).unwrap_err();
    assert!(error.to_string().contains("picture.png"), "{error}");
}

#[test]
fn false_colours_brighten_with_radiosity_above_a_legend() {
    let mut mesh = square(1, 0.0);
    for (value, position) in mesh.radiosity.iter_mut().zip(&mesh.positions) {
        *value = Rgb::splat(2.0 + position.x);
    }
    let options = RenderOptions { view: View::Radiosity, ..small(200, 200) };
    let picture = render(&mesh, &camera_in_front(5.0), &options);
    let image = shown(&picture, &EXPOSED);
    assert!(image.width() == 200 && image.height() > 200, "the legend is below the picture");
    let at = |x, y| luminance(Rgb::from_array(image.get_pixel(x, y).0.map(f64::from)));
    for x in (10..180).step_by(10) {
        assert!(at(x, 50) < at(x + 10, 50), "{x}");
    }
    let heading = 200..222;
    let inked = (0..200).filter(|&x| heading.clone().any(|y| at(x, y) > 150.0)).count();
    assert!(inked > 50, "{inked} columns with letters");
}
