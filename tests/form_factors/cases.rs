//! View factors with known values, each by every method; a table of them all goes to
//! `form-factors.md` in the build directory.

use std::fmt::Write;
use std::path::Path;

use glam::DVec3;
use radiosity::form_factor::contour::point_to_polygon;
use radiosity::form_factor::pair::visible_exchange;
use radiosity::visibility::{Facet, Occluders};
use serde::Deserialize;

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

fn facet(corners: &[DVec3]) -> Facet<'_> {
    Facet::new(corners, normal(corners))
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

#[test]
fn every_case_has_its_value_by_every_method() {
    let mut table = "| case | value | contour |\n|---|---|---|\n".to_owned();
    let mut wrong = Vec::new();
    for case in suite().cases {
        let contour = by_contour(&case);
        let tolerance = if case.blockers.is_empty() { 1e-6 } else { 1e-4 };
        if (contour - case.value).abs() > tolerance {
            wrong.push(format!("{} contour {contour} for {}", case.id, case.value));
        }
        writeln!(table, "| {} | {:.9} | {:+.1e} |", case.id, case.value, contour - case.value)
            .unwrap();
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("form-factors.md");
    std::fs::write(&path, &table).unwrap();
    println!("{table}");
    assert!(wrong.is_empty(), "{wrong:#?}");
}
