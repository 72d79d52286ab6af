//! `--html`: a solution as a page to share.

use std::path::{Path, PathBuf};

use clap::Args;
use radiosity::page::{self, Cell, Fact, Markup, Model, Step, Table, Viewer, html};
use radiosity::render::{Display, Solved, Subject, View, png, render_solved};
use radiosity::scene::Camera;
use radiosity::{Result, Scene, Solution, TriMesh, reconstruct};

use super::interrupt::Interrupt;
use super::meter::{Meter, Timing};
use super::options::PictureOptions;
use super::record::SettingsRecord;
use super::summary::{Balance, Summary};

/// The page to write, and what may be seen in it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Writing")]
pub(crate) struct PageOptions {
    /// Page to write: the lit mesh to turn in any browser, its picture and figures, in one file
    ///
    /// It needs no network and no other file. Radiosity in false colours, levels of elements, why they
    /// were made, the triangles, and the light without textures are shown at will.
    #[arg(long, value_name = "FILE.html")]
    pub(crate) html: Option<PathBuf>,

    /// With --html: the light after this many shots too, to step through: 1,2,24,100
    ///
    /// The first shot is that of all lamps, each further one that of the patch with the most unshot
    /// light; the rest is estimated as ambient light.
    #[arg(long, value_name = "SHOTS", value_delimiter = ',', requires = "html")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) snapshots: Vec<u32>,
}

/// What a page tells of a solution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SolutionPage<'a> {
    pub(crate) path: &'a Path,
    pub(crate) scene: &'a Scene,
    pub(crate) mesh: &'a TriMesh,
    pub(crate) solved: Solved<'a>,
    /// The light on its way.
    pub(crate) snapshots: &'a [Solution],
    pub(crate) camera: &'a Camera,
    pub(crate) display: Display,
    pub(crate) summary: &'a Summary,
    pub(crate) settings: &'a SettingsRecord,
}

impl PageOptions {
    /// Numbers of shots of reflected light after which the light is to be shown, rising.
    pub(crate) fn snapshots(&self) -> Vec<usize> {
        let mut snapshots: Vec<usize> =
            self.snapshots.iter().map(|&shots| shots as usize - 1).collect();
        snapshots.sort_unstable();
        snapshots.dedup();
        snapshots
    }

    /// Whether the page could be written.
    pub(crate) fn check(&self) -> Result<()> {
        self.html.as_deref().map_or(Ok(()), page::check_writable)
    }

    /// Writes the page, if one is asked for.
    pub(crate) fn write(
        &self,
        account: &SolutionPage<'_>,
        options: &PictureOptions,
        interrupt: &Interrupt,
        meter: &mut Meter,
    ) -> Result<()> {
        let Some(path) = &self.html else {
            return Ok(());
        };
        meter.begin("page");
        let missing = self.snapshots().len() - account.snapshots.len();
        if missing > 0 {
            let shots = 1 + account.solved.solution.reflected_shots();
            meter.tell(&format!(
                "note: {missing} of the snapshots are left out: all was done after {shots} shots"
            ));
        }
        let mut steps: Vec<Step> = account
            .snapshots
            .iter()
            .map(|snapshot| early_step(&account.solved, snapshot))
            .collect();
        steps.push(last_step(account));
        let subject = Subject { mesh: account.mesh, solved: Some(account.solved) };
        let lights = &account.solved.surfaces.lights;
        let drawing = options.drawing(View::Light, lights);
        let mut picture = render_solved(subject, account.camera, &drawing, |done| {
            meter.advance("page", done);
            interrupt.go_on()
        });
        picture.unfinished |= !interrupt.is_whole();
        let still = png(&picture, &account.display);
        let title = title(account.path);
        let viewer = Viewer {
            steps: &steps,
            camera: account.camera,
            exposure: account.display.scale,
            group: "solution",
            alt: &format!("{title}, lit: {} triangles", account.summary.triangles),
            caption: "",
            still: Some(&still),
        };
        let body = body(account, &viewer, meter.timings());
        page::save(&page::document(&title, &body), path)
    }
}

fn early_step(solved: &Solved<'_>, snapshot: &Solution) -> Step {
    let mesh = reconstruct(solved.surfaces, snapshot);
    let shots = 1 + snapshot.reflected_shots();
    let label = if shots == 1 { "1 shot".to_owned() } else { format!("{shots} shots") };
    Step { label, model: Model::of_solution(&mesh, &snapshot.mesh) }
}

fn last_step(account: &SolutionPage<'_>) -> Step {
    let model = Model::of_solution(account.mesh, &account.solved.solution.mesh);
    Step { label: format!("end: {}", account.summary.stop), model }
}

fn title(path: &Path) -> String {
    path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn body(account: &SolutionPage<'_>, viewer: &Viewer<'_>, seconds: &[Timing]) -> Markup {
    let SolutionPage { path, scene, summary, .. } = account;
    let total: f64 = seconds.iter().map(|timing| timing.seconds).sum();
    html! {
        h1 { (title(path)) }
        p.lead {
            "Lit by adaptive radiosity: " (summary.leaves) " elements, " (summary.triangles)
            " triangles, " (format!("{total:.1}")) " s."
        }
        (page::viewer(viewer))
        @for note in &scene.notes { p { "Note: " (note) } }
        div.columns {
            div { h2 { "Solution" } (page::facts(&facts(account))) }
            div {
                h2 { "Where the power went" } (energy(summary, scene.photometric))
                h2 { "Time" } (times(seconds))
            }
        }
    }
}

fn facts(account: &SolutionPage<'_>) -> [Fact<'static>; 8] {
    let SolutionPage { path, summary, settings, .. } = account;
    [
        ("Scene", path.display().to_string()),
        ("Surfaces", format!("{}, {} patches", summary.surfaces, summary.patches)),
        ("Elements", format!("{}, {} of them leaves", summary.elements, summary.leaves)),
        ("Divided", summary.divided.to_string()),
        ("Mesh", format!("{} triangles, {} vertices", summary.triangles, summary.vertices)),
        ("Shots", format!("{}, {}", summary.shots, summary.stop)),
        ("Settings", settings.to_string()),
        ("Made by", concat!("radiosity ", env!("CARGO_PKG_VERSION")).to_owned()),
    ]
    .map(|(name, value)| Fact { name, value })
}

fn energy(summary: &Summary, photometric: bool) -> Markup {
    let row = |name: &str, power: [f64; 3]| {
        let numbers = match photometric {
            true => vec![Cell::number(Balance::lumens(power), 1)],
            false => power.map(|watts| Cell::number(watts, 4)).to_vec(),
        };
        [Cell::text(name)].into_iter().chain(numbers).collect()
    };
    let powers = &summary.energy;
    page::table(&Table {
        caption: &format!("Imbalance {:.3} % of the emitted power", 100.0 * powers.imbalance),
        header: if photometric { &["Flux", "lm"] } else { &["Power, W", "red", "green", "blue"] },
        rows: vec![
            row("emitted", powers.emitted),
            row("absorbed", powers.absorbed),
            row("on black backs", powers.on_backs),
            row("escaped", powers.escaped),
            row("unshot", powers.unshot),
        ],
        file: "power.csv",
    })
}

fn times(seconds: &[Timing]) -> Markup {
    let row =
        |timing: &Timing| vec![Cell::text(timing.phase.clone()), Cell::number(timing.seconds, 2)];
    page::table(&Table {
        caption: "",
        header: &["Phase", "seconds"],
        rows: seconds.iter().map(row).collect(),
        file: "seconds.csv",
    })
}
