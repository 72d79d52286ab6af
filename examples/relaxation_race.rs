//! A race of the relaxations on the office: what is left of the residual after so many rows, and how
//! far from the direct solution it all ends. Writes a plot to `out/relaxation-race.svg`.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use radiosity::form_factor::{self, assemble};
use radiosity::light::Optics;
use radiosity::mesh::Mesh;
use radiosity::page::{Axis, Curve, Plot, Stroke};
use radiosity::settings::Method;
use radiosity::solver::relaxation::{Criteria, Relaxation, RelaxationStep, System};
use radiosity::visibility::Occluders;
use radiosity::{Length, Settings, load, surfaces_of};

/// Some of Okabe and Ito's colours, which nobody mistakes for each other, by method.
const COLOURS: [[u8; 3]; 4] = [[0, 0, 0], [230, 159, 0], [0, 114, 178], [213, 94, 0]];

/// Least residual shown, W/m².
const LEAST: f64 = 1e-6;

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
        let first = |is_there: &dyn Fn(&RelaxationStep) -> bool| {
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
        let shown = steps.iter().step_by(every).take_while(|step| step.residual >= LEAST);
        let points = shown.map(|step| (step.shots as f64, step.residual)).collect();
        let stroke = if omega == 1.0 { Stroke::Line } else { Stroke::Dashed };
        curves.push(Curve { name, colour: COLOURS[method as usize], stroke, points });
    }
    let plot = Plot {
        size: [900, 560],
        across: Axis { name: "rows relaxed", logarithmic: false },
        up: Axis { name: "largest residual, W/m²", logarithmic: true },
        curves,
    };
    std::fs::create_dir_all("out")?;
    std::fs::write("out/relaxation-race.svg", plot.svg())?;
    Ok(())
}

/// The office's patches and the form factors between them, by hemicubes.
fn office() -> radiosity::Result<System> {
    let surfaces = surfaces_of(&load(Path::new("scenes/office.obj"), &Default::default())?);
    let settings = Settings { patch_size: Length::Metres(PATCH), ..Settings::medium() };
    let mesh = Mesh::new(&surfaces, &settings);
    let Optics { reflectance, exitance } = Optics::new(&surfaces, &mesh);
    let method = form_factor::FormFactorMethod::Hemicube(settings.hemicube_resolution);
    let go_on = |_| ControlFlow::Continue(());
    let factors = assemble(&mesh.patches, &Occluders::new(&surfaces), method, go_on).factors;
    System::new(factors, reflectance, exitance)
}
