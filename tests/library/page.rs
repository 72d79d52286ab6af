//! Pages hold what they were given, in few bytes, and ask for nothing else.

use crate::common;
use base64::Engine as _;
use glam::{DVec3, Vec2};
use proptest::prelude::*;
use radiosity::TriMesh;
use radiosity::colour::Rgb;
use radiosity::page::{
    self, Axis, Board, BoardRow, CURVE_COLOURS, Cell, Curve, Fact, Markup, Model, Plot, Section,
    Step, Stroke, Table, Viewer, WipePicture, columns, facts, html,
};
use radiosity::reconstruct::MeshPart;
use radiosity::scene::{Camera, Sampler, Texture, Wrap};
use serde_json::{Value, json};

/// A PNG of one pixel: its header is all that pages read.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x05\0\0\0\x04\x08\x02\0\0\0";

fn camera() -> Camera {
    let (eye, target) = (DVec3::new(0.5, 3.0, 0.5), DVec3::ZERO);
    Camera { name: String::new(), eye, target, up: DVec3::Y, vertical_fov: 0.7 }
}

/// A square of so many cells a side in waves, each of two triangles, lit from dark to bright.
fn waves(side: u32) -> TriMesh {
    let mut mesh = TriMesh::default();
    for row in 0..=side {
        for column in 0..=side {
            let [x, z] = [column, row].map(|number| f64::from(number) / f64::from(side));
            mesh.positions.push(DVec3::new(x, 0.1 * (9.0 * x).sin() * (7.0 * z).cos(), z));
            mesh.radiosity.push(Rgb::new(x * x, (x * z).sqrt() * 30.0, (5.0 * z).exp()));
            if row < side && column < side {
                let first = row * (side + 1) + column;
                let [right, below, across] = [first + 1, first + side + 1, first + side + 2];
                mesh.triangles.extend([[first, below, right], [right, below, across]]);
            }
        }
    }
    mesh
}

fn viewer(steps: &[Step], text: &str) -> Markup {
    page::viewer(&Viewer {
        steps,
        camera: &camera(),
        exposure: 1.0,
        group: text,
        alt: text,
        caption: text,
        still: Some(PNG),
    })
}

fn step(label: &str, model: Model) -> Step {
    Step { label: label.to_owned(), model }
}

/// A page with every component, and `text` wherever text can be.
fn everything(text: &str) -> String {
    let mesh = waves(2);
    let model = Model::of_mesh(&mesh).with_errors(&[0.1; 9]);
    let picture = WipePicture { label: text, png: PNG, alt: text, mesh: Some(PNG) };
    let rows =
        vec![vec![Cell::text(text), Cell::number(1.5, 2)], vec![Cell::Empty, Cell::count(3)]];
    let body = html! {
        h1 { (text) }
        (columns(&[viewer(&[step(text, model)], text), page::picture(PNG, text, text)]))
        (page::wipe(&[picture, picture, picture], text))
        (page::table(&Table { caption: text, header: &[text, "n"], rows, file: text }))
        (facts(&[Fact { name: text, value: text.to_owned() }]))
        (page::board(&Board {
            caption: text,
            header: &[text],
            rows: vec![BoardRow { name: text.to_owned(), cells: vec![text.to_owned()] }],
        }))
        (page::sections(&[Section { title: text, body: page::folded(text, &html! { (text) }) }]))
        (page::data("data", &json!({ text: [text, 1.5] })))
    };
    page::document(text, &body).into_string()
}

/// The text of the first script element after `start`.
fn script_after<'a>(page: &'a str, start: &str) -> &'a str {
    let (_, rest) = page.split_once(start).expect("it is in the page");
    rest.split_once("</script>").expect("it ends").0
}

fn json_after(page: &str, start: &str) -> Value {
    serde_json::from_str(script_after(page, start)).expect("it is JSON")
}

/// What the scripts of a page with one viewer get.
fn record(steps: &[Step]) -> Value {
    json_after(&viewer(steps, "x").into_string(), "<script type=\"application/json\">")
}

/// The bytes of a list of a step.
fn list(record: &Value, step: usize, name: &str) -> Vec<u8> {
    let chunk = record["steps"][step]["lists"][name].as_u64().expect("there is such a list");
    let text = record["chunks"][chunk as usize].as_str().expect("a chunk is a text");
    base64::engine::general_purpose::STANDARD.decode(text).expect("it is base64")
}

fn numbers<const N: usize, T>(bytes: &[u8], number: impl Fn([u8; N]) -> T) -> Vec<T> {
    bytes.chunks_exact(N).map(|chunk| number(chunk.try_into().expect("it has N bytes"))).collect()
}

#[test]
fn a_page_needs_nothing_but_itself() {
    let page = everything("A room");
    for address in ["http:", "https:", "src=\"/", "url(", "@import", "import(", "fetch(", "XMLHttp"]
    {
        assert!(!page.contains(address), "{address}");
    }
    let sources = page.split("src=\"").skip(1);
    assert!(sources.clone().count() >= 8 && sources.clone().all(|rest| rest.starts_with("data:")));
    let policy = page.find("Content-Security-Policy").expect("there is a policy");
    assert!(page.contains("default-src 'none'; img-src data: blob:;"));
    assert!(["<style", "<script", "<link"].iter().all(|tag| policy < page.find(tag).unwrap()));
}

#[test]
fn a_page_is_readable_without_scripts() {
    let page = everything("A room");
    let visible = page.split("<script").next().unwrap();
    for part in [
        "<html lang=\"en\">",
        "<h1>A room</h1>",
        "<noscript>",
        "alt=\"A room\"",
        "width=\"5\" height=\"4\"",
    ] {
        assert!(visible.contains(part), "{part}");
    }
}

#[test]
fn what_the_scripts_get_is_the_mesh() {
    let mesh = waves(12);
    let errors: Vec<f64> = mesh.radiosity.iter().map(|light| light.x - 0.5).collect();
    let record = record(&[step("only", Model::of_mesh(&mesh).with_errors(&errors))]);
    let field = |name: &str| &record["steps"][0][name];
    let vector =
        |name: &str| DVec3::from_array([0, 1, 2].map(|axis| field(name)[axis].as_f64().unwrap()));
    let (low, size) = (vector("low"), vector("size"));
    let shares = numbers(&list(&record, 0, "positions"), u16::from_le_bytes);
    for (position, q) in mesh.positions.iter().zip(shares.chunks_exact(3)) {
        let found = low + size * DVec3::new(q[0].into(), q[1].into(), q[2].into()) / 65535.0;
        assert!(((found - position).abs() - size / 65535.0).max_element() <= 0.0);
    }
    let unit = field("unit").as_f64().unwrap();
    let colours = numbers(&list(&record, 0, "radiosity"), u32::from_le_bytes);
    for (light, bits) in mesh.radiosity.iter().zip(&colours) {
        let step = unit * 2.0_f64.powi((bits >> 27) as i32 - 24);
        let found = Rgb::from_array([0, 9, 18].map(|shift| f64::from(bits >> shift & 511) * step));
        let error = (found - light).abs().max_element();
        assert!(error <= light.max_element() / 512.0, "{found} {light}");
    }
    let corners = numbers(&list(&record, 0, "corners"), u16::from_le_bytes);
    assert!(
        mesh.triangles.iter().flatten().eq(corners
            .iter()
            .map(|&c| u32::from(c))
            .collect::<Vec<_>>()
            .iter())
    );
    let found = numbers(&list(&record, 0, "errors"), i16::from_le_bytes);
    let error_step = field("errorStep").as_f64().unwrap();
    assert!(
        errors.iter().zip(found).all(|(e, q)| (e - f64::from(q) * error_step).abs() < error_step)
    );
    assert_eq!((shares.len(), colours.len()), (3 * mesh.positions.len(), mesh.positions.len()));
}

#[test]
fn levels_and_reasons_are_those_of_the_solution() {
    let surfaces = radiosity::surfaces_of(&common::shipped("blocker.obj"));
    let solution = common::solve(&surfaces, &common::coarse());
    let mesh = radiosity::reconstruct(&surfaces, &solution);
    let record = record(&[step("only", Model::of_solution(&mesh, &solution.mesh))]);
    let expected = mesh.leaves.iter().map(|&leaf| solution.mesh[leaf].level as u8);
    assert!(list(&record, 0, "levels").into_iter().eq(expected));
    let reasons = list(&record, 0, "reasons");
    assert_eq!(reasons.len(), mesh.triangles.len());
    let whole = |leaf: radiosity::mesh::ElementId| solution.mesh[leaf].level == 0;
    assert!(mesh.leaves.iter().zip(&reasons).all(|(&leaf, &reason)| whole(leaf) == (reason == 0)));
    assert_eq!(record["modes"], json!(["light", "radiosity", "level", "reason"]));
}

#[test]
fn a_mesh_as_large_as_the_office_takes_little_and_steps_share_what_they_can() {
    let mesh = waves(160);
    assert!(mesh.triangles.len() > 51_000);
    let one = viewer(&[step("a", Model::of_mesh(&mesh))], "x").0.len();
    assert!(one < 1_000_000, "{one}");
    let dim =
        TriMesh { radiosity: mesh.radiosity.iter().map(|c| c / 3.0).collect(), ..mesh.clone() };
    let both = [step("a", Model::of_mesh(&mesh)), step("b", Model::of_mesh(&dim))];
    let two = viewer(&both, "x").0.len();
    assert!(two < one + mesh.positions.len() * 6, "{two} {one}");
}

#[test]
fn meshes_of_many_vertices_have_wide_corners() {
    let mesh = waves(260);
    let record = record(&[step("a", Model::of_mesh(&mesh))]);
    let corners = numbers(&list(&record, 0, "corners"), u32::from_le_bytes);
    assert!(mesh.triangles.iter().flatten().eq(corners.iter()));
}

#[test]
fn nothing_and_no_numbers_are_borne() {
    assert_eq!(viewer(&[], "x").into_string(), "");
    let empty = record(&[step("a", Model::of_mesh(&TriMesh::default()))]);
    assert_eq!(empty["steps"][0]["vertices"], 0);
    let mut mesh = waves(2);
    mesh.radiosity[0] = Rgb::splat(f64::NAN);
    mesh.radiosity[1] = Rgb::splat(f64::INFINITY);
    let model = Model::of_mesh(&mesh).with_errors(&[f64::NAN; 9]);
    let range = record(&[step("a", model)])["range"].clone();
    assert!(range[0].as_f64() > Some(0.0) && range[1].as_f64() > range[0].as_f64(), "{range}");
}

#[test]
fn only_html_is_written() {
    let directory = tempfile::tempdir().unwrap();
    let document = page::document("A room", &html! { p { "light" } });
    assert!(page::save(&document, &directory.path().join("a.txt")).is_err());
    let path = directory.path().join("deep/a.html");
    page::check_writable(&path).unwrap();
    page::save(&document, &path).unwrap();
    assert_eq!(std::fs::read_to_string(path).unwrap(), document.into_string());
}

proptest! {
    #[test]
    fn no_text_ends_a_script_or_begins_an_element(
        text in "([a-z<>/&\"'!\\-\u{2028}]|</script|</SCRIPT >|<!--|<script|]]>|&lt;){0,12}",
    ) {
        let (page, plain) = (everything(&text), everything("x"));
        let marks = |page: &str, mark: &str| page.to_lowercase().matches(mark).count();
        for mark in ["</script", "<script", "<!--", "</style", "<img", "</title"] {
            prop_assert_eq!(marks(&page, mark), marks(&plain, mark), "{}", mark);
        }
        let data = json_after(&page, "id=\"data\">");
        prop_assert_eq!(&data, &json!({ text.as_str(): [text.as_str(), 1.5] }));
        let record = json_after(&page, "<script type=\"application/json\">");
        prop_assert_eq!(record["steps"][0]["label"].as_str(), Some(text.as_str()));
    }
}

/// Curves of each kind, on logarithmic axes from so much on over so many decades, or on linear ones.
fn chart(logarithmic: bool, [across, up]: [f64; 2], decades: [f64; 2]) -> String {
    let at = |share: f64| {
        let value = |low: f64, decades: f64| low * 10_f64.powf(share * decades);
        (value(across, decades[0]), value(up, decades[1]))
    };
    let strokes =
        [Stroke::Line, Stroke::Dashed, Stroke::Circles, Stroke::Squares, Stroke::Ticks(0)];
    let curve = |(k, stroke): (usize, Stroke)| Curve {
        name: format!("curve {k}"),
        colour: CURVE_COLOURS.get(k).copied().unwrap_or([0; 3]),
        stroke,
        points: [0.0, 0.3, 1.0].map(at).to_vec(),
    };
    let axis = |name| Axis { name, logarithmic };
    let curves = strokes.into_iter().enumerate().map(curve).collect();
    Plot { size: [360, 280], across: axis("elements"), up: axis("error"), curves }.svg()
}

/// Numbers of a drawing whose letters stand like that beside their place.
fn numbers_beside(svg: &str, anchor: &str) -> Vec<f64> {
    let texts = svg.split("<text").skip(1).filter(|text| text.contains(&format!("\"{anchor}\"")));
    let inside = texts.filter_map(|text| text.split_once('>')?.1.split_once('<'));
    inside.filter_map(|(words, _)| words.trim().parse().ok()).collect()
}

proptest! {
    #[test]
    fn every_axis_has_two_round_numbers_at_least(
        logarithmic: bool,
        low in (1e-3..1e3_f64, 1e-3..1e3_f64),
        decades in (0.0..5.0_f64, 0.0..5.0_f64),
    ) {
        let svg = chart(logarithmic, low.into(), decades.into());
        // Those below stand in the middle of their place, those at the left end at it.
        for anchor in ["middle", "end"] {
            let found = numbers_beside(&svg, anchor);
            prop_assert!((2..14).contains(&found.len()), "{anchor}: {found:?}");
            let wide = found.iter().fold(0.0, |most: f64, x| most.max(*x)) > 6.0 * found[0].max(found[1]);
            let leading = |x: &f64| (x / 10_f64.powf(x.log10().floor() + 1e-9)).round();
            let round = found.iter().all(|x| [1.0, 2.0, 5.0, 10.0].contains(&leading(x)));
            prop_assert!(!(logarithmic && wide) || round, "{found:?}");
        }
    }
}

/// What is drawn black on white would be unreadable in the dark scheme.
#[test]
fn pages_have_a_rule_for_every_colour_that_charts_are_drawn_in() {
    let svg = chart(true, [1.0, 1.0], [2.0, 2.0]);
    let page = page::document("A chart", &html! { p { "light" } }).into_string();
    let mut colours = 0;
    for kind in ["fill", "stroke"] {
        for rest in svg.split(&format!("{kind}=\"#")).skip(1) {
            let rule = format!(".plot [{kind}=\"#{}\"]", rest.split('"').next().unwrap());
            assert!(page.contains(&rule), "no {rule}");
            colours += 1;
        }
    }
    assert!(colours > 20 && svg.contains("viewBox") && svg.contains("#0072B2"), "{svg}");
}

#[test]
fn contents_lead_to_every_section() {
    let section = |title| Section { title, body: html! { p { "light" } } };
    let page = page::sections(&[section("All runs"), section("Across a shadow's edge")]);
    let page = page.into_string();
    for anchor in ["all-runs", "across-a-shadow-s-edge"] {
        assert!(page.contains(&format!("href=\"#{anchor}\"")), "{page}");
        assert!(page.contains(&format!("<section id=\"{anchor}\">")), "{page}");
    }
}

/// A square with a picture of red and blue texels on its first half, read as `sampler` says, and holes in it.
fn pictured(sampler: Sampler, side: u32) -> TriMesh {
    let mut mesh = waves(2);
    let count = mesh.positions.len();
    mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(p.x as f32, p.z as f32)).collect();
    mesh.texture_mean = vec![Rgb::new(0.25, 0.5, 0.5); count];
    let colours = [[0.5, 0.0, 0.0], [0.0, 0.0, 0.25]];
    let texels: Vec<[f32; 3]> = (0..side * side).map(|at| colours[(at % 2) as usize]).collect();
    let alpha = (0..side * side).map(|at| (at % 256) as u8).collect();
    let texture = Texture {
        width: side,
        height: side,
        texels: texels.into(),
        alpha,
        sampler,
        ..Texture::default()
    };
    mesh.textures = vec![Texture::default(), texture];
    let on =
        |triangles, texture, cutoff| MeshPart { triangles, texture, cutoff, ..MeshPart::default() };
    mesh.parts = vec![
        on(0..2, None, None),
        on(2..3, Some(1), Some(0.25)),
        on(3..5, Some(1), Some(0.25)),
        on(5..8, Some(1), None),
    ];
    mesh
}

/// The picture that a record's scripts are to show, as it is decoded.
fn picture_of(record: &Value) -> image::DynamicImage {
    let chunk = record["pictures"][0]["chunk"].as_u64().expect("there is a picture");
    let text = record["chunks"][chunk as usize].as_str().expect("a chunk is a text");
    let bytes = base64::engine::general_purpose::STANDARD.decode(text).expect("it is base64");
    image::load_from_memory(&bytes).expect("it is a picture")
}

#[test]
fn pictures_on_surfaces_are_there_with_the_light_that_they_are_multiplied_by() {
    let sampler = Sampler { wrap: [Wrap::Mirror, Wrap::Clamp], nearest: true };
    let mesh = pictured(sampler, 4);
    let record = record(&[step("a", Model::of_mesh(&mesh)), step("b", Model::of_mesh(&mesh))]);
    let runs = json!([
        { "corners": 6, "picture": null, "cutoff": null },
        { "corners": 9, "picture": 0, "cutoff": 0.25 },
        { "corners": 9, "picture": 0, "cutoff": null },
    ]);
    assert_eq!(record["steps"][0]["runs"], runs);
    let pictures = record["pictures"].as_array().expect("a list");
    assert_eq!(pictures.len(), 1);
    let expected = json!({
        "mime": "image/png", "chunk": pictures[0]["chunk"], "white": 0.5, "mean": [0.25, 0.0, 0.125],
        "wrap": ["mirror", "clamp"], "nearest": true,
    });
    assert_eq!(pictures[0], expected);
    // Divided by its white, in sRGB: 1 and 0.5.
    let picture = picture_of(&record).to_rgba8();
    assert_eq!(
        [picture.get_pixel(2, 0).0, picture.get_pixel(3, 0).0],
        [[255, 0, 0, 2], [0, 0, 188, 3]]
    );
    let uvs = numbers(&list(&record, 0, "uvs"), f32::from_le_bytes);
    assert!(uvs.chunks_exact(2).map(Vec2::from_slice).eq(mesh.uvs.iter().copied()));
    let unit = record["steps"][0]["unit"].as_f64().unwrap();
    for (vertex, bits) in
        numbers(&list(&record, 0, "radiosity"), u32::from_le_bytes).iter().enumerate()
    {
        let step = unit * 2.0_f64.powi((bits >> 27) as i32 - 24);
        let found = Rgb::from_array([0, 9, 18].map(|shift| f64::from(bits >> shift & 511) * step));
        let expected = mesh.radiosity[vertex] / mesh.texture_mean[vertex];
        let error = (found - expected).abs().max_element();
        assert!(error <= expected.max_element() / 500.0, "{found} {expected}");
    }
}

#[test]
fn large_pictures_are_kept_small_and_a_page_says_so() {
    let told = |side| {
        let text = viewer(&[step("", Model::of_mesh(&pictured(Sampler::default(), side)))], "")
            .into_string();
        let picture = picture_of(&json_after(&text, "<script type=\"application/json\">"));
        (picture.width(), picture.height(), text.contains("2048 texels a side at most"))
    };
    assert_eq!([told(2048), told(2050)], [(2048, 2048, false), (1025, 1025, true)]);
}

#[test]
fn a_page_without_pictures_on_surfaces_carries_nothing_for_them() {
    let mut mesh = waves(2);
    let plain = viewer(&[step("", Model::of_mesh(&mesh))], "").into_string();
    for part in ["pictures", "runs", "uvs"] {
        assert!(!plain.contains(part), "{part}");
    }
    // What has no texels, or no coordinates, is no picture.
    let triangles = 0..mesh.triangles.len();
    mesh.parts.push(MeshPart { triangles, texture: Some(0), ..MeshPart::default() });
    mesh.textures.push(Texture::default());
    assert_eq!(viewer(&[step("", Model::of_mesh(&mesh))], "").into_string(), plain);
}
