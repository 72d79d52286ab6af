//! `radiosity compare`: uniform and adaptive meshes of a scene side by side.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use radiosity::Scene;
use radiosity::compare::{self, Comparison, Effort, Plan, Source};
use serde_json::{Value, json};

use super::compared::table;
use super::failure::Failure;
use super::interrupt::Interrupt;
use super::meter::Meter;
use super::options::{MethodOptions, SceneOptions, TalkOptions, values};
use super::record::SettingsRecord;
use super::report::{self, Subject};
use super::{console, outputs};

/// Solve a scene on uniform and on adaptive meshes and say which is worth its cost
///
/// Errors are against a reference that no mesh has had a part in: at some 9000 places, direct light exactly and
/// reflected light by paths, with a standard error. All runs share solver, direct light and threads. Ctrl-C ends
/// the work and reports the runs that are done.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Compare {
    #[command(flatten)]
    scene: SceneOptions,

    /// Sizes of uniform elements, in metres: 0.4,0.2,0.1,0.05
    ///
    /// Default: some that fit the scene, up to about four times the elements of the finest adaptive mesh.
    #[arg(long, value_name = "METRES", value_parser = values::number, value_delimiter = ',')]
    #[arg(help_heading = "Comparison")]
    uniform: Option<Vec<f64>>,

    /// Tolerances of adaptive meshes
    #[arg(long, value_name = "SHARES", value_parser = values::share, value_delimiter = ',')]
    #[arg(default_value = "0.2,0.1,0.05,0.02", help_heading = "Comparison")]
    adaptive: Vec<f64>,

    /// The truth: auto, or a .csv or .npz with radiosity at places of its own
    ///
    /// CSV has the columns x,y,z,nx,ny,nz,r,g,b (W/m²) and, if it likes, `se_r,se_g,se_b` (standard errors),
    /// set (0 all surfaces, 1 edges of shadows) and weight. NPZ has the arrays `pos`, `nrm`, `B` and the like.
    #[arg(long, value_name = "auto|FILE", default_value = "auto", help_heading = "Comparison")]
    reference: PathBuf,

    /// Most time for an automatic reference: 120s, 2min
    #[arg(long, value_name = "TIME", default_value = "120s", value_parser = values::duration)]
    #[arg(help_heading = "Comparison")]
    budget: Duration,

    /// An automatic reference with so small a standard error is good enough: 0.002 or 0.2%
    ///
    /// Of the mean radiosity, root mean square. Reached before the budget, results are the same each time.
    #[arg(long, value_name = "SHARE", default_value = "0.2%", value_parser = values::share)]
    #[arg(help_heading = "Comparison")]
    noise: f64,

    /// Places of an automatic reference on all surfaces; half as many more along the edges of shadows
    #[arg(long, value_name = "N", default_value_t = 6000, help_heading = "Comparison")]
    #[arg(value_parser = clap::value_parser!(u32).range(100..=1_000_000))]
    places: u32,

    /// Compare costs at this error, as a share of the mean (default: the smallest that both reach)
    #[arg(long, value_name = "SHARE", value_parser = values::share, help_heading = "Comparison")]
    error: Option<f64>,

    /// Page to write: verdict, pictures, errors, curves and both meshes in 3D, in one file
    ///
    /// It needs no network and no other file, and can be read and printed without scripts.
    #[arg(short, long, value_name = "FILE.html", help_heading = "Writing")]
    output: Option<PathBuf>,

    /// Table to write, a row a run
    #[arg(long, value_name = "FILE.csv", help_heading = "Writing")]
    csv: Option<PathBuf>,

    /// All figures to write: settings, runs, verdict, profile across a shadow's edge
    #[arg(long, value_name = "FILE.json", help_heading = "Writing")]
    json: Option<PathBuf>,

    /// The reference to write, so that it can be used again with --reference
    #[arg(long, value_name = "FILE.csv", help_heading = "Writing")]
    save_reference: Option<PathBuf>,

    #[command(flatten)]
    method: MethodOptions,

    #[command(flatten)]
    talk: TalkOptions,
}

const EXAMPLES: &str = "\
Examples:
  radiosity compare scenes/cornell-box.obj -o report.html
  radiosity compare scenes/two-rooms.obj --csv runs.csv
  radiosity compare scenes/blocker.obj --uniform 0.4,0.2,0.1 --adaptive 10%,5%,2% --budget 2min
  radiosity compare scenes/office.obj --quality draft --save-reference office.csv --json office.json
  radiosity compare scenes/office.obj --reference office.csv --adaptive 1% --uniform 0.05";

impl Compare {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let plan = self.plan();
        plan.validate()?;
        self.check_outputs()?;
        self.talk.use_threads()?;
        let interrupt = Interrupt::listen();
        let mut meter = Meter::new(&self.talk);
        meter.begin("reading");
        let scene = self.scene.load_lit(|line| meter.tell(line))?;
        let comparison = compare::compare(&scene, &plan, &mut |progress| {
            meter.advance(&progress.phase, progress.done);
            interrupt.flow()
        })?;
        comparison.surfaces.notes.iter().for_each(|note| meter.tell(&format!("note: {note}")));
        meter.end();
        self.write(&scene, &comparison, &plan)?;
        if !self.talk.quiet {
            console::print(&table(&self.scene.path, &comparison, self.written()))?;
        }
        Ok(())
    }

    fn plan(&self) -> Plan {
        let effort = Effort {
            area_points: self.places as usize,
            shadow_points: self.places as usize / 2,
            budget: self.budget,
            noise: self.noise,
            ..Effort::default()
        };
        let reference = if self.reference == Path::new("auto") {
            Source::Traced(effort)
        } else {
            Source::File(self.reference.clone())
        };
        Plan {
            settings: self.method.settings(),
            uniform: self.uniform.clone(),
            adaptive: self.adaptive.clone(),
            reference,
            error: self.error,
            ..Plan::default()
        }
    }

    fn check_outputs(&self) -> Result<(), Failure> {
        let inputs = [self.scene.path.as_path(), self.reference.as_path()];
        outputs::check_compared(&inputs, self.output.as_deref(), &self.figures())?;
        let csv = [&self.csv, &self.save_reference];
        outputs::check_endings(csv.into_iter().flatten(), ".csv")?;
        outputs::check_endings(&self.json, ".json")?;
        Ok(())
    }

    /// The files to write.
    fn written(&self) -> impl Iterator<Item = &Path> {
        self.output.as_deref().into_iter().chain(self.figures())
    }

    fn figures(&self) -> Vec<&Path> {
        let files = [&self.csv, &self.json, &self.save_reference];
        files.into_iter().flatten().map(PathBuf::as_path).collect()
    }

    fn write(&self, scene: &Scene, comparison: &Comparison, plan: &Plan) -> Result<(), Failure> {
        let settings = SettingsRecord::new(&plan.settings, comparison.surfaces.extent);
        let about = self.about(&settings);
        if let Some(output) = &self.output {
            let path = &self.scene.path;
            let subject = Subject { path, scene, comparison, settings: &settings, about: &about };
            report::write(&subject, output)?;
        }
        for path in [&self.csv, &self.json].into_iter().flatten() {
            compare::save(comparison, &about, path)?;
        }
        if let Some(path) = &self.save_reference {
            comparison.reference.save(path)?;
        }
        Ok(())
    }

    /// What a file has to say about where its figures come from.
    fn about(&self, settings: &SettingsRecord) -> Value {
        json!({
            "scene": self.scene.path,
            "version": env!("CARGO_PKG_VERSION"),
            "threads": rayon::current_num_threads(),
            "settings": settings,
        })
    }
}
