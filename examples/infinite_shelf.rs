//! An endless shelf, solved exactly and beside what a lecture prints of it; with `--animate`, how
//! each relaxation gets there.

#[path = "common/shelf.rs"]
mod shelf;

use radiosity::settings::Method;
use radiosity::solver::relaxation::{Criteria, Relaxation, RelaxationStep, System};
use shelf::{ROWS, Row};

/// The strips' names.
const NAMES: [&str; 3] = ["A", "B", "C"];

/// Characters for each power of ten of the residual.
const BAR: f64 = 6.0;

fn main() -> radiosity::Result<()> {
    println!("{:<22} {:<22} {:<24} printed", "reflectance of A, B, C", "exitance", "radiosity");
    for row in &ROWS {
        let radiosity: Vec<f64> = row.system()?.solve_directly()?.iter().map(|b| b.x).collect();
        let slip = |(b, &printed): (&f64, &f64)| (b - printed).abs() > 0.5e-5;
        let slips = radiosity.iter().zip(&row.printed).any(slip);
        println!(
            "{:<22} {:<22} {:<24} {}{}",
            list(&row.reflectance, 3),
            list(&row.exitance, 0),
            list(&radiosity, 5),
            list(&row.printed, 5),
            if slips { "  a slip" } else { "" },
        );
    }
    if std::env::args().any(|argument| argument == "--animate") {
        for method in [Method::Jacobi, Method::GaussSeidel, Method::Southwell, Method::Progressive]
        {
            animate(method, &ROWS[1])?;
        }
    }
    Ok(())
}

/// Shows the residual after each step, a bar for its logarithm.
fn animate(method: Method, row: &Row) -> radiosity::Result<()> {
    let system: System = row.system()?;
    let criteria = Criteria { residual: 1e-6, change: 0.0, max_shots: 1000 };
    let relaxed = system.relax(Relaxation::new(method, 1.0)?, &criteria);
    println!("\n{}: {} steps", method.name(), relaxed.history.len() - 1);
    for RelaxationStep { shots, row, residual, .. } in relaxed.history {
        let name = row.map_or(" ", |row| NAMES[row]);
        let length = BAR * (residual / criteria.residual).log10();
        println!("{shots:>3} {name} {residual:>9.7} {}", "#".repeat(length.max(0.0) as usize));
    }
    Ok(())
}

fn list(values: &[f64], digits: usize) -> String {
    values.iter().map(|value| format!("{value:.digits$}")).collect::<Vec<_>>().join(" ")
}
