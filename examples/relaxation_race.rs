//! A race of the relaxations on the office: what is left of the residual after so many rows, and how
//! far from the direct solution it all ends. Writes a plot to `out/relaxation-race.svg`.

#[path = "common/plot.rs"]
mod plot;

use std::path::Path;
use std::time::Instant;

use plot::{Curve, Plot};
use radiosity::form_factor::FormFactors;
use radiosity::form_factor::contour::point_to_polygon;
use radiosity::form_factor::hemicube::{DeltaFactors, Hemicube};
use radiosity::mesh::Mesh;
use radiosity::settings::Method;
use radiosity::solver::relaxation::{Criteria, Relaxation, Step, System};
use radiosity::visibility::Occluders;
use radiosity::{Length, Settings, load, surfaces_of};

/// Longest side of a patch, m: about a thousand patches.
const PATCH: f64 = 0.6;

const RACERS: [(Method, f64); 7] = [
    (Method::Jacobi, 1.0),
    (Method::GaussSeidel, 1.0),
    (Method::GaussSeidel, 1.2),
    (Method::Southwell, 1.0),
    (Method::Southwell, 1.2),
    (Method::Progressive, 1.0),
    (Method::Progressive, 1.2),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let system = office()?;
    let n = system.len();
    let start = Instant::now();
    let truth = system.solve_directly()?;
    println!("{n} patches, LU factors in {:.1} s", start.elapsed().as_secs_f64());
    println!("rows relaxed until there is left of    residual         unshot power   error at the");
    println!("{:<22}{:>9}{:>9}{:>12}{:>9}   end, W/m²", "", "1e-3", "1e-6", "1e-3", "1e-6");
    let mut curves = Vec::new();
    for (method, omega) in RACERS {
        let criteria = Criteria { residual: 0.0, change: 0.0, max_shots: 40 * n };
        let relaxed = system.relax(Relaxation::new(method, omega)?, &criteria);
        let steps = relaxed.history;
        let start = steps[0];
        let first = |is_there: &dyn Fn(&Step) -> bool| {
            let found = steps.iter().find(|step| is_there(step));
            found.map_or("-".to_owned(), |step| step.shots.to_string())
        };
        let residual = |share: f64| first(&|step| step.residual <= share * start.residual);
        let unshot = |share: f64| first(&|step| step.unshot <= share * start.unshot);
        let name = format!("{}, ω = {omega}", method.name());
        let errors = relaxed.radiosity.iter().zip(&truth).map(|(b, t)| (*b - *t).length());
        println!(
            "{name:<22}{:>9}{:>9}{:>12}{:>9}   {:.0e}",
            residual(1e-3),
            residual(1e-6),
            unshot(1e-3),
            unshot(1e-6),
            errors.fold(0.0, f64::max),
        );
        let every = if matches!(method, Method::Jacobi | Method::GaussSeidel) { n } else { n / 10 };
        let points = steps.iter().step_by(every).map(|s| (s.shots as f64, s.residual)).collect();
        curves.push(Curve { name, dashed: omega != 1.0, colour: method as usize, points });
    }
    let plot = Plot {
        title: format!("Relaxation of the office, {n} patches"),
        across: "rows relaxed".to_owned(),
        up: "largest residual, W/m²".to_owned(),
        least: 1e-6,
        curves,
    };
    plot.save(Path::new("out/relaxation-race.svg"))
}

/// The office's patches and the form factors between them, by a hemicube over the centre of each.
fn office() -> radiosity::Result<System> {
    let surfaces = surfaces_of(&load(Path::new("scenes/office.obj"), &Default::default())?);
    let settings =
        Settings { patch_size: Length::Metres(PATCH), max_level: 0, ..Settings::medium() };
    let mesh = Mesh::new(&surfaces, &settings);
    let occluders = Occluders::new(&surfaces);
    let delta = DeltaFactors::new(settings.hemicube_resolution as usize);
    let mut hemicube = Hemicube::new(&delta, &occluders);
    let rows = mesh.patches.iter().map(|patch| {
        let centre = patch.corners.iter().sum::<glam::DVec3>() / patch.corners.len() as f64;
        let sights = hemicube.look(&mesh.patches, (centre, patch.normal), 0.0);
        let seen = sights.into_iter().filter(|sight| sight.front);
        let factor = |sight: radiosity::form_factor::hemicube::Sight| {
            let corners = &mesh[sight.patch].corners;
            (sight.patch.0, sight.visible * point_to_polygon(centre, patch.normal, corners))
        };
        seen.map(factor).collect::<Vec<_>>()
    });
    let areas = mesh.patches.iter().map(|patch| patch.area).collect();
    let factors = FormFactors::from_rows(areas, rows);
    let reflectance = mesh.patches.iter().map(|patch| patch.reflectance).collect();
    let exitance = mesh.patches.iter().map(|patch| patch.exitance).collect();
    System::new(factors, reflectance, exitance)
}
