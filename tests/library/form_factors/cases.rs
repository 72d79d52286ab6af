//! View factors with known values, each by every method; a table of them all goes to
//! `form-factors.md` in the build directory.

use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;

use glam::DVec3;
use radiosity::form_factor::contour::point_to_polygon;
use radiosity::form_factor::pair::{exchange, visible_exchange};
use radiosity::form_factor::{FormFactorMethod, assemble, factors_at};
use radiosity::geometry::PlanarPolygon;
use radiosity::mesh::{Mesh, Patch};
use radiosity::visibility::{Occluders, SurfacePoint};
use radiosity::{Length, Settings, faces_of};
use serde::Deserialize;

use crate::common::Stage;

type Corners = Vec<DVec3>;

#[derive(Deserialize)]
struct Suite {
    cases: Vec<Case>,
    strips: Vec<Strip>,
    enclosures: Vec<Enclosure>,
}

/// A pair with its factor from receiver to source, from closed forms or exact visibility events.
#[derive(Deserialize)]
struct Case {
    id: String,
    receiver: Receiver,
    #[serde(deserialize_with = "corners")]
    source: Corners,
    #[serde(deserialize_with = "polygons")]
    blockers: Vec<Corners>,
    value: f64,
    /// The factor from the receiver's centroid, if that is not on another polygon.
    centre_value: Option<f64>,
    /// The worst error against it of plain hemicubes with 256 cells, in eight turns.
    hemicube_256: Option<f64>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Receiver {
    Polygon { polygon: Vec<[f64; 3]> },
    Point { point: [f64; 3], normal: [f64; 3] },
}

/// Infinitely long in y; ends as (x, z), the front to the left of the way from the first to the second.
#[derive(Deserialize)]
struct Strip {
    id: String,
    receiver: [[f64; 2]; 2],
    source: [[f64; 2]; 2],
    value: f64,
}

#[derive(Deserialize)]
struct Enclosure {
    id: String,
    #[serde(deserialize_with = "polygons")]
    patches: Vec<Corners>,
    #[serde(rename = "F")]
    factors: Vec<Vec<f64>>,
}

fn corners<'de, D: serde::Deserializer<'de>>(from: D) -> Result<Corners, D::Error> {
    Ok(Vec::<[f64; 3]>::deserialize(from)?.into_iter().map(DVec3::from).collect())
}

fn polygons<'de, D: serde::Deserializer<'de>>(from: D) -> Result<Vec<Corners>, D::Error> {
    let polygons = Vec::<Vec<[f64; 3]>>::deserialize(from)?;
    Ok(polygons.into_iter().map(|p| p.into_iter().map(DVec3::from).collect()).collect())
}

fn suite() -> Suite {
    serde_json::from_str(include_str!("cases.json")).unwrap()
}

fn facet(corners: &[DVec3]) -> PlanarPolygon<'_> {
    PlanarPolygon::new(corners, normal(corners))
}

fn normal(corners: &[DVec3]) -> DVec3 {
    let doubled = |k: usize| (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]);
    (1..corners.len() - 1).map(doubled).sum::<DVec3>().normalize()
}

fn area(corners: &[DVec3]) -> f64 {
    let doubled = |k: usize| (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]);
    (1..corners.len() - 1).map(doubled).sum::<DVec3>().length() / 2.0
}

/// By exact formulas, with the visible part cut out where something blocks.
fn by_contour(case: &Case) -> f64 {
    let blockers: Vec<&[DVec3]> = case.blockers.iter().map(Vec::as_slice).collect();
    let occluders = Occluders::from_polygons(&blockers, 1e-9);
    let source = facet(&case.source);
    match &case.receiver {
        Receiver::Polygon { polygon } => {
            let receiver: Corners = polygon.iter().copied().map(DVec3::from).collect();
            visible_exchange(&occluders, facet(&receiver), source, 1e-5) / area(&receiver)
        }
        Receiver::Point { point, normal } => {
            let (eye, normal) = (DVec3::from(*point), DVec3::from(*normal));
            let pieces = occluders.visible_part(eye, &case.source, source.plane.normal).unwrap();
            pieces.iter().map(|piece| point_to_polygon(eye, normal, piece)).sum()
        }
    }
}

/// The polygons as a scene of one patch each.
fn patches_of(polygons: &[&Corners]) -> (Vec<Patch>, Occluders) {
    let mut stage = Stage::default();
    let grey = stage.material(0.5, 0.0);
    for polygon in polygons {
        stage.polygon(grey, polygon);
    }
    let surfaces = faces_of(&stage.scene);
    let whole = Settings { patch_size: Length::OfScene(2.0), ..Settings::draft() };
    let mesh = Mesh::new(&surfaces, &whole);
    (mesh.patches, Occluders::new(&surfaces))
}

/// From the receiver's centre by another method; the source is the first patch.
fn from_centre(case: &Case, method: FormFactorMethod) -> f64 {
    let polygons: Vec<&Corners> = std::iter::once(&case.source).chain(&case.blockers).collect();
    let (patches, occluders) = patches_of(&polygons);
    let place = match &case.receiver {
        Receiver::Polygon { polygon } => {
            let receiver: Corners = polygon.iter().copied().map(DVec3::from).collect();
            SurfacePoint::new(centroid(&receiver), normal(&receiver))
        }
        Receiver::Point { point, normal } => {
            SurfacePoint::new(DVec3::from(*point), DVec3::from(*normal))
        }
    };
    let surface = patches[0].surface;
    let factors = factors_at(&patches, &occluders, method, place);
    patches.iter().zip(factors).filter(|(p, _)| p.surface == surface).map(|(_, f)| f).sum()
}

fn centroid(corners: &[DVec3]) -> DVec3 {
    let triangles = (1..corners.len() - 1).map(|k| [corners[0], corners[k], corners[k + 1]]);
    let weighted = triangles.map(|[a, b, c]| ((a + b + c) / 3.0, (b - a).cross(c - a).length()));
    let (sum, total) =
        weighted.fold((DVec3::ZERO, 0.0), |(sum, total), (p, w)| (sum + p * w, total + w));
    sum / total
}

/// What hemicubes and rays may err by: a third of a plain hemicube's error.
fn allowed(case: &Case) -> f64 {
    /// Exact formulas have rounding, too.
    const ROUNDING: f64 = 1e-9;
    case.hemicube_256.unwrap_or(0.0) / 3.0 + ROUNDING
}

#[test]
fn every_case_has_its_value_by_every_method() {
    let mut table =
        "| case | value | contour | from the centre | hemicube 512 | rays 1 M | allowed |\n\
                     |---|---|---|---|---|---|---|\n"
            .to_owned();
    let mut wrong = Vec::new();
    for case in suite().cases {
        let contour = by_contour(&case) - case.value;
        let tolerance = if case.blockers.is_empty() { 1e-6 } else { 1e-4 };
        if contour.abs() > tolerance {
            wrong.push(format!("{} by contour: {contour:+e}", case.id));
        }
        write!(table, "| {} | {:.9} | {contour:+.1e} |", case.id, case.value).unwrap();
        if let Some(centre) = case.centre_value {
            let methods = [FormFactorMethod::Hemicube(512), FormFactorMethod::Rays(1_000_000)];
            let errors = methods.map(|method| from_centre(&case, method) - centre);
            for (error, name) in errors.iter().zip(["hemicube", "rays"]) {
                if error.abs() > allowed(&case) {
                    wrong.push(format!("{} by {name}: {error:+e}", case.id));
                }
            }
            let [cells, rays] = errors;
            write!(table, " {centre:.9} | {cells:+.1e} | {rays:+.1e} | {:.1e} |", allowed(&case))
                .unwrap();
        }
        table.push('\n');
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("form-factors.md");
    std::fs::write(&path, &table).unwrap();
    println!("{table}");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn endless_strips_have_the_factors_of_crossed_strings() {
    for strip in suite().strips {
        let polygon = |[from, to]: [[f64; 2]; 2], half: f64| {
            let at = |[x, z]: [f64; 2], y: f64| DVec3::new(x, y, z);
            vec![at(from, -half), at(to, -half), at(to, half), at(from, half)]
        };
        let (receiver, source) = (polygon(strip.receiver, 0.5), polygon(strip.source, 2e3));
        let exchange = exchange(facet(&receiver), facet(&source));
        let factor = exchange / area(&receiver);
        assert!((factor - strip.value).abs() < 1e-6, "{}: {factor} for {}", strip.id, strip.value);
    }
}

#[test]
fn enclosures_have_their_matrices_by_every_method() {
    for enclosure in suite().enclosures {
        let (patches, occluders) = patches_of(&enclosure.patches.iter().collect::<Vec<_>>());
        assert_eq!(patches.len(), enclosure.patches.len(), "{}: whole polygons", enclosure.id);
        let methods = [
            (FormFactorMethod::Contour, 1e-4),
            (FormFactorMethod::Hemicube(128), 0.02),
            (FormFactorMethod::Rays(4096), 0.02),
        ];
        for (method, tolerance) in methods {
            let go_on = |_| ControlFlow::Continue(());
            let factors = assemble(&patches, &occluders, method, go_on).factors;
            for (i, row) in enclosure.factors.iter().enumerate() {
                for (j, &expected) in row.iter().enumerate() {
                    let (factor, id) = (factors.get(i, j), &enclosure.id);
                    let error = (factor - expected).abs();
                    assert!(error < tolerance, "{id} {method:?} {i} {j}: {factor} for {expected}");
                }
            }
        }
    }
}

/// Cases with a factor from the receiver's centre, and the differences from it by a method.
fn errors_from_centre(method: FormFactorMethod) -> Vec<(Case, f64)> {
    let error = |case: Case| {
        let centre = case.centre_value?;
        let error = (from_centre(&case, method) - centre).abs();
        Some((case, error))
    };
    suite().cases.into_iter().filter_map(error).collect()
}

#[test]
fn plain_sums_over_cells_err_as_hemicubes_are_known_to_and_converge() {
    for (case, error) in errors_from_centre(FormFactorMethod::HemicubeSum(256)) {
        // The known error is the worst of eight turns; this is one more turn.
        let known = 2.0 * case.hemicube_256.unwrap_or(0.0) + 1e-5;
        assert!(error <= known, "{}: off by {error}, known for {known}", case.id);
    }
    let total = |method| errors_from_centre(method).iter().map(|(_, error)| error).sum::<f64>();
    let [coarse, middle, fine] = [64, 256, 1024].map(FormFactorMethod::HemicubeSum).map(total);
    assert!(middle < coarse / 3.0 && fine < middle / 3.0, "{coarse}, {middle}, {fine}");
    let corrected = total(FormFactorMethod::Hemicube(256));
    assert!(corrected < middle / 10.0, "{corrected} where amounts are exact, {middle} by cells");
}

#[test]
fn of_what_is_smaller_than_a_cell_a_whole_one_is_seen_or_nothing() {
    const CELLS: u32 = 64;
    let side = 0.5 / f64::from(CELLS);
    let eye = SurfacePoint::new(DVec3::ZERO, DVec3::Y);
    let mut seen = 0;
    for k in 0..150 {
        let at = |step: f64| (f64::from(k) * step).fract() - 0.5;
        let low = DVec3::new(at(0.618_034), 1.0, at(0.754_878));
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.0, 1.0), DVec3::Z];
        let (patches, occluders) = patches_of(&[&square.map(|p| low + side * p).to_vec()]);
        let [exact, sum] = [FormFactorMethod::Contour, FormFactorMethod::HemicubeSum(CELLS)]
            .map(|method| factors_at(&patches, &occluders, method, eye).iter().sum::<f64>());
        assert!(exact > 0.0 && (sum == 0.0 || sum > 10.0 * exact), "{sum} for {exact}");
        seen += u32::from(sum > 0.0);
    }
    assert!((1..50).contains(&seen), "{seen} of 150 cover the centre of a cell");
}
