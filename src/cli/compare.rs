//! `radiosity compare`: uniform and adaptive meshes of a scene side by side.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use radiosity::compare::{self, Comparison, ComparisonPlan, Effort, ReferenceSource};
use radiosity::{Error, Scene, page};
use serde_json::{Value, json};

use super::compared::table;
use super::console;
use super::failure::Failure;
use super::interrupt::Interrupt;
use super::meter::Meter;
use super::options::{
    MethodOptions, ReportOptions, SceneOptions, TimeOptions, WritingOptions, values,
};
use super::outputs;
use super::outputs::Outputs;
use super::record::SettingsRecord;
use super::report::{self, ReportSubject};
use super::streams::Streams;

/// Solve a scene on uniform and on adaptive meshes and say which is worth its cost
///
/// Errors are against a reference that no mesh has had a part in: at some 9000 places, direct light exactly and
/// reflected light by paths, with a standard error. All runs share solver, direct light and threads. Ctrl-C, SIGTERM
/// and --time-limit end the work and report the runs that are done, with exit code 3; before the first is, there is
/// nothing to write.
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

    /// Most time for an automatic reference: 90s, 2min (default: 60s)
    #[arg(long, value_name = "TIME", value_parser = values::duration, help_heading = "Comparison")]
    budget: Option<Duration>,

    /// An automatic reference with so small a standard error is good enough: 0.002 or 0.2%
    ///
    /// Of the mean radiosity, root mean square. Default: so small that by chance the smallest error of all runs is wrong
    /// by less than 5 %, half of what is a tie. Reached before the budget, results are the same each time.
    #[arg(long, value_name = "SHARE", value_parser = values::share, help_heading = "Comparison")]
    noise: Option<f64>,

    /// Places of an automatic reference on all surfaces (default: 6000); half as many more along the edges of shadows
    #[arg(long, value_name = "N", help_heading = "Comparison")]
    #[arg(value_parser = clap::value_parser!(u32).range(100..=1_000_000))]
    places: Option<u32>,

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

    /// All figures to write, as --json prints them: settings, runs, verdict, profile across a shadow's edge
    #[arg(long, value_name = "FILE.json", help_heading = "Writing")]
    figures: Option<PathBuf>,

    /// The reference to write, so that it can be used again with --reference
    #[arg(long, value_name = "FILE.csv", help_heading = "Writing")]
    save_reference: Option<PathBuf>,

    #[command(flatten)]
    writing: WritingOptions,

    #[command(flatten)]
    method: MethodOptions,

    #[command(flatten)]
    time: TimeOptions,

    #[command(flatten)]
    report: ReportOptions,
}

const EXAMPLES: &str = "\
Examples:
  radiosity compare scenes/cornell-box.obj -o report.html
  radiosity compare scenes/two-rooms.obj --csv runs.csv
  radiosity compare scenes/blocker.obj --uniform 0.4,0.2,0.1 --adaptive 10%,5%,2% --budget 2min
  radiosity compare scenes/office.obj --quality draft --save-reference office.csv --figures office.json
  radiosity compare scenes/office.obj --reference office.csv --adaptive 1% --uniform 0.05";

impl Compare {
    pub(crate) fn run(mut self) -> Result<(), Failure> {
        let plan = self.plan()?;
        plan.validate()?;
        let streams = self.divert()?;
        self.check_outputs()?;
        self.report.talk.use_threads()?;
        let interrupt = Interrupt::listen().within(self.time.time_limit);
        let mut meter = Meter::new(&self.report.talk);
        meter.begin("reading");
        let scene = self.scene.load_lit(|line| meter.tell(line))?;
        self.outputs().check(&scene.files, &[])?;
        meter.begin("surfaces");
        let comparison = compare::compare(&scene, &plan, &mut |progress| {
            if progress.runs > 0 {
                interrupt.worth_writing();
            }
            meter.advance(&progress.phase, progress.done);
            interrupt.go_on()
        });
        let comparison = comparison.map_err(|error| interrupt.blamed(error))?;
        comparison.surfaces.notes.iter().for_each(|note| meter.tell(&format!("note: {note}")));
        meter.begin("writing");
        let settings = SettingsRecord::new(&plan.settings, comparison.surfaces.extent);
        self.write(&scene, &comparison, &settings)?;
        meter.end();
        streams.deliver()?;
        let written: Vec<PathBuf> = self.written().map(|path| streams.name(path)).collect();
        if self.report.json {
            let mut figures = compare::figures(&comparison, &self.about(&settings));
            figures["finished"] = json!(interrupt.is_whole());
            figures["written"] = json!(written);
            figures["seconds"] = json!(meter.into_timings());
            console::print_json(&figures)?;
        } else if !self.report.talk.quiet {
            streams.print(&table(&self.scene.path, &comparison, &written))?;
        }
        interrupt.ending()
    }

    fn plan(&self) -> Result<ComparisonPlan, Error> {
        let effort = self.effort();
        let reference = if self.reference == Path::new("auto") {
            ReferenceSource::Traced(effort)
        } else if effort == Effort::default() {
            ReferenceSource::File(self.reference.clone())
        } else {
            let message =
                "a file needs no --budget, --noise or --places; leave them out".to_owned();
            return Err(Error::Setting { name: "reference", message });
        };
        Ok(ComparisonPlan {
            settings: self.method.settings(),
            uniform: self.uniform.clone(),
            adaptive: self.adaptive.clone(),
            reference,
            error: self.error,
            ..ComparisonPlan::default()
        })
    }

    /// What an automatic reference may cost.
    fn effort(&self) -> Effort {
        let usual = Effort::default();
        Effort {
            area_points: self.places.map_or(usual.area_points, |places| places as usize),
            shadow_points: self.places.map_or(usual.shadow_points, |places| places as usize / 2),
            budget: self.budget.unwrap_or(usual.budget),
            noise: self.noise,
            ..usual
        }
    }

    fn check_outputs(&self) -> Result<(), Failure> {
        let mut inputs = self.scene.files();
        inputs.push(self.reference.clone());
        self.outputs().check(&inputs, &[])?;
        self.output.as_deref().map_or(Ok(()), page::check_writable)?;
        self.tables().into_iter().try_for_each(compare::check_writable)?;
        let csv = [&self.csv, &self.save_reference];
        outputs::check_endings(csv.into_iter().flatten(), ".csv")?;
        outputs::check_endings(&self.figures, ".json")?;
        Ok(())
    }

    /// Puts files in the place of outputs that are none.
    fn divert(&mut self) -> Result<Streams, Error> {
        let mut streams = Streams::default();
        let tables = self.csv.iter_mut().chain(&mut self.figures).chain(&mut self.save_reference);
        streams.divert(self.output.iter_mut().chain(tables), &self.writing, self.report.json)?;
        Ok(streams)
    }

    fn outputs(&self) -> Outputs {
        let files = self.written().map(Path::to_owned).collect();
        Outputs { files, force: self.writing.force }
    }

    /// The files to write.
    fn written(&self) -> impl Iterator<Item = &Path> {
        self.output.as_deref().into_iter().chain(self.tables())
    }

    fn tables(&self) -> Vec<&Path> {
        let files = [&self.csv, &self.figures, &self.save_reference];
        files.into_iter().flatten().map(PathBuf::as_path).collect()
    }

    fn write(
        &self,
        scene: &Scene,
        comparison: &Comparison,
        settings: &SettingsRecord,
    ) -> Result<(), Failure> {
        let about = self.about(settings);
        if let Some(output) = &self.output {
            let path = &self.scene.path;
            let subject = ReportSubject { path, scene, comparison, settings, about: &about };
            report::write(&subject, output)?;
        }
        for path in [&self.csv, &self.figures].into_iter().flatten() {
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
