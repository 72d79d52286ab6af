//! `radiosity solve`: from a scene to a lit mesh and its picture.

use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::Args;
use radiosity::colour::Rgb;
use radiosity::export::{self, Stamp};
use radiosity::light::Direct;
use radiosity::reconstruct::mesh_pictures;
use radiosity::render::{self, Solved, Subject};
use radiosity::solver::Stop;
use radiosity::tone::Exposure;
use radiosity::{Error, Scene, Settings, Solution, Surfaces, surfaces_of};

use super::console;
use super::estimate::CostEstimate;
use super::failure::Failure;
use super::grid::GridOptions;
use super::interrupt::Interrupt;
use super::lighting::{Lighting, LitScene, RelightOptions};
use super::lightmap::{LightmapOptions, PlannedLightmap};
use super::memory::Needs;
use super::meter::Meter;
use super::options::{
    AccuracyOptions, CameraChoice, CheckpointOptions, Elsewhere, HINT, LimitOptions,
    PictureOptions, ReportOptions, SceneOptions, WritingOptions, display,
};
use super::outputs::Outputs;
use super::page::{PageOptions, SolutionPage};
use super::pictures::Pictures;
use super::record::{SettingsRecord, stamped};
use super::streams::Streams;
use super::summary::{Outcome, Summary};

/// Light a scene and write the mesh that carries its light, and pictures of it
///
/// Surfaces are diffuse. Light straight from emitters is exact and refines the mesh where shadows
/// and gradients ask for it; reflected light is exchanged between patches until almost nothing is
/// left unshot. Ctrl-C, SIGTERM and --time-limit end the work early and still write everything, with exit code 3.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Solve {
    #[command(flatten)]
    scene: SceneOptions,

    /// Mesh to write: .glb for viewers, .obj or .ply for other tools; may be repeated
    ///
    /// A GLB shows the light in any viewer, keeps radiosity in W/m² beside it, and can be drawn again
    /// by `radiosity render`.
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    output: Vec<PathBuf>,

    /// Picture to write: .png as seen, .hdr or .exr with linear radiance; may be repeated
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    image: Vec<PathBuf>,

    /// How the exchange of reflected light converged: residual and unshot share, patch by patch
    ///
    /// Columns: shots so far, the patch that was next, the largest residual in W/m², and the unshot
    /// share of the emitted power.
    #[arg(long, value_name = "FILE.csv", help_heading = "Writing")]
    history: Option<PathBuf>,

    #[command(flatten)]
    writing: WritingOptions,

    #[command(flatten)]
    relight: RelightOptions,

    #[command(flatten)]
    lightmap: LightmapOptions,

    #[command(flatten)]
    grid: GridOptions,

    #[command(flatten)]
    page: PageOptions,

    #[command(flatten)]
    accuracy: AccuracyOptions,

    #[command(flatten)]
    limits: LimitOptions,

    #[command(flatten)]
    checkpoint: CheckpointOptions,

    #[command(flatten)]
    picture: PictureOptions,

    #[command(flatten)]
    report: ReportOptions,

    /// Take options from a TOML file: `tolerance = 0.02`, `image = "room.png"`, `final-gather = true`
    ///
    /// Keys are the long options without dashes in front. What the command line gives wins.
    #[arg(long, value_name = "FILE.toml", help_heading = "Reporting")]
    pub(crate) config: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  radiosity solve scenes/cornell-box.obj -o cornell.glb --image cornell.png
  radiosity solve kitchen.obj --units cm --quality draft --image first-look.png
  radiosity solve room.glb -o room-lit.ply --image mesh.png --view wireframe --tolerance 1.5%
  radiosity solve kitchen.obj --image final.png --image mesh.png --view light,reason --final-gather
  radiosity solve scenes/office.obj --quality draft --html office.html --snapshots 1,2,24,100
  radiosity solve scenes/office.obj -o office.glb --lightmap 2048
  radiosity solve scenes/bare-room.obj --emit 'lamp*=800lm' --sky cie-overcast --image lit.png
  radiosity solve scenes/two-rooms.obj --relightable -o rooms.glb
  radiosity solve hall.glb -o lit.glb --quality high --checkpoint hall.work --resume
  radiosity solve room.obj --ies spot.ies@2,2.6,3 --grid 0.75,0.5 --grid-csv desk.csv
  radiosity solve scenes/blocker.obj --uniform 0.1 --image uniform.png --eye 1,2,3 --target 0,0,0";

impl Solve {
    pub(crate) fn run(mut self) -> Result<(), Failure> {
        let streams = self.prepare()?;
        let interrupt = Interrupt::listen().within(self.limits.time.time_limit);
        let mut meter = Meter::new(&self.report.talk);
        self.warn_of_nothing(&meter);

        let (mut scene, camera) = self.read(&mut meter)?;
        let needs = self.needs(&scene);
        let surfaces = surfaces(&mut scene, &mut meter);
        let grid = self.grid.plan(&surfaces)?;
        let lightmap = self.lightmap.plan(&surfaces, &self.output)?;
        let settings = self.settings(&surfaces, needs, &meter)?;
        let settings_record = SettingsRecord::new(&settings, surfaces.extent);
        let lighting = Lighting {
            surfaces: &surfaces,
            settings: &settings,
            checkpoint: &self.checkpoint,
            relight: &self.relight,
            snapshots: &self.page.snapshots(),
        };
        let LitScene { solution, snapshots, mesh } = lighting.run(&interrupt, &mut meter)?;
        judge(&solution, &meter)?;

        let (camera, exposure) = self.picture.look(&camera, &mesh, Exposure::Automatic);
        let record = stamped(&settings_record, &scene);
        let finished = solution.stop == Stop::Converged;
        let stamp = Stamp { exposure, settings: record, finished };
        let solved = Solved { surfaces: &surfaces, settings: &settings, solution: &solution };
        let subject = Subject { mesh: &mesh, solved: Some(solved) };
        self.write_meshes(&subject, lightmap.as_ref(), &stamp, &mut meter)?;
        let pictures = Pictures::of_solution(subject, &camera, exposure);
        self.write_pictures(&pictures, &interrupt, &mut meter)?;
        if let Some(path) = &self.history {
            export::save_history(&solution.history, path)?;
        }
        let grid = grid.map(|grid| grid.read(solved, &interrupt, &mut meter)).transpose()?;
        let mut summary = Summary::new(&surfaces, &solution, &mesh);
        let account = SolutionPage {
            path: &self.scene.path,
            scene: &scene,
            mesh: &mesh,
            solved,
            snapshots: &snapshots,
            camera: &camera,
            display: display(&mesh, exposure),
            summary: &summary,
            settings: &settings_record,
        };
        self.page.write(&account, &self.picture, &interrupt, &mut meter)?;
        summary.finished &= interrupt.is_whole();
        let outcome = Outcome {
            scene: self.scene.path.clone(),
            photometric: scene.photometric,
            summary,
            grid: grid.flatten(),
            settings: settings_record,
            seconds: meter.into_timings(),
            written: self.written().map(|path| streams.name(&path)).collect(),
            notes: scene.notes,
        };
        self.report_on(&outcome, &streams)?;
        interrupt.ending()
    }

    /// The settings, with as many elements as there is room for; tells what is asked for, and what to expect of it.
    fn settings(
        &self,
        surfaces: &Surfaces,
        needs: Needs,
        meter: &Meter,
    ) -> Result<Settings, Error> {
        let memory = self.limits.memory();
        let limited =
            |needs| Settings { max_elements: memory.elements(&needs), ..self.accuracy.settings() };
        let settings = limited(needs);
        settings.validate_for(surfaces.area(), surfaces.extent)?;
        meter.explain(&SettingsRecord::new(&settings, surfaces.extent).to_string());
        let estimate = CostEstimate::new(surfaces, &settings, needs);
        memory.check_needs(&estimate.least(), "for the patches of the scene")?;
        meter.tell(&estimate.to_string());
        Ok(limited(estimate.least()))
    }

    /// What takes memory before there are patches, and at the end.
    fn needs(&self, scene: &Scene) -> Needs {
        // Textures may share texels.
        let texels = scene.textures.iter().map(|texture| texture.texels.memory());
        let texels: BTreeMap<usize, u64> = texels.collect();
        let encoded = scene.textures.iter().map(|t| (t.encoded.as_ptr().addr(), t.encoded.len()));
        let encoded: BTreeMap<usize, usize> = encoded.collect();
        Needs {
            faces: scene.faces.len(),
            pixels: if self.image.is_empty() { 0 } else { self.picture.pixels() },
            texels: self.lightmap.texels(),
            texture_bytes: texels.values().sum::<u64>() + encoded.values().sum::<usize>() as u64,
            ..Needs::default()
        }
    }

    fn read(&self, meter: &mut Meter) -> Result<(Scene, CameraChoice), Failure> {
        meter.begin("reading");
        let memory = self.limits.memory();
        memory.check_file(self.scene.bytes())?;
        let scene = self.scene.load_lit(|line| meter.tell(line))?;
        memory.check_needs(&self.needs(&scene), "for the scene's faces")?;
        let camera = self.picture.choose_camera(&scene.cameras)?;
        self.outputs().check(&scene.files, &mesh_pictures(&scene))?;
        Ok((scene, camera))
    }

    /// Whether what is asked for makes sense; files are put in the place of outputs that are none.
    fn prepare(&mut self) -> Result<Streams, Failure> {
        self.accuracy.settings().validate()?;
        let streams = self.divert()?;
        self.check(&streams)?;
        self.report.talk.use_threads()?;
        Ok(streams)
    }

    /// Whether what is asked for can be written.
    fn check(&self, streams: &Streams) -> Result<(), Failure> {
        let inputs: Vec<PathBuf> =
            self.scene.files().into_iter().chain(self.config.clone()).collect();
        self.outputs().check(&inputs, &[])?;
        self.output.iter().try_for_each(|path| export::check_writable(path))?;
        self.image.iter().try_for_each(|path| render::check_writable(path))?;
        self.tables().try_for_each(|path| export::check_history(path))?;
        self.checkpoint.check()?;
        self.lightmap.check(&self.output, streams)?;
        self.page.check()?;
        self.relight.check(&self.output)?;
        self.picture.views(&self.image)?;
        let elsewhere = match (&self.page.html, self.output.is_empty()) {
            (Some(_), _) => Elsewhere::Picture,
            (None, false) => Elsewhere::Colours,
            (None, true) => Elsewhere::Nothing,
        };
        Ok(self.picture.check_use(&self.image, elsewhere)?)
    }

    fn divert(&mut self) -> Result<Streams, Error> {
        let mut streams = Streams::default();
        let tables = self.history.iter_mut().chain(&mut self.grid.grid_csv);
        let all = self.output.iter_mut().chain(&mut self.image).chain(tables);
        streams.divert(all.chain(&mut self.page.html), &self.writing, self.report.json)?;
        Ok(streams)
    }

    fn outputs(&self) -> Outputs {
        let files = self.written().chain(self.checkpoint.checkpoint.clone()).collect();
        Outputs { files, force: self.writing.force }
    }

    fn warn_of_nothing(&self, meter: &Meter) {
        if self.written().next().is_none() && self.grid.grid.is_none() {
            meter.tell("nothing will be written; -o FILE.glb, --image FILE.png and --html FILE.html do that");
        }
    }

    /// The files to write.
    fn written(&self) -> impl Iterator<Item = PathBuf> {
        let meshes_and_pictures = self.output.iter().chain(&self.image);
        let all = meshes_and_pictures.chain(self.tables()).chain(&self.page.html);
        all.cloned().chain(self.lightmap.files(&self.output))
    }

    fn tables(&self) -> impl Iterator<Item = &PathBuf> {
        self.history.iter().chain(&self.grid.grid_csv)
    }

    /// Sends on what goes elsewhere than into files, and tells what came of it all.
    fn report_on(&self, outcome: &Outcome, streams: &Streams) -> Result<(), Failure> {
        streams.deliver()?;
        match (self.report.json, self.report.talk.quiet) {
            (true, _) => console::print_json(outcome)?,
            (false, true) => (),
            (false, false) => streams.print(&outcome.to_string())?,
        }
        Ok(())
    }

    fn write_meshes(
        &self,
        subject: &Subject<'_>,
        lightmap: Option<&PlannedLightmap>,
        stamp: &Stamp,
        meter: &mut Meter,
    ) -> Result<(), Failure> {
        if !self.output.is_empty() {
            meter.begin("writing");
        }
        for path in &self.output {
            export::save(subject.mesh, path, stamp)?;
        }
        if let Some(lightmap) = lightmap {
            lightmap.write(subject, stamp, meter)?;
        }
        Ok(())
    }

    fn write_pictures(
        &self,
        pictures: &Pictures<'_>,
        interrupt: &Interrupt,
        meter: &mut Meter,
    ) -> Result<(), Failure> {
        if self.image.is_empty() {
            return Ok(());
        }
        meter.begin("picture");
        pictures.write(&self.picture, &self.image, interrupt, meter)
    }
}

/// The surfaces of a scene; what there is to be told of them is told, and stands among the scene's notes.
fn surfaces(scene: &mut Scene, meter: &mut Meter) -> Surfaces {
    meter.begin("surfaces");
    let surfaces = surfaces_of(scene);
    surfaces.notes.iter().for_each(|note| meter.tell(&format!("note: {note}")));
    scene.notes.extend_from_slice(&surfaces.notes);
    surfaces
}

/// Refuses a solution without light, and tells if it is coarser than was asked for.
fn judge(solution: &Solution, meter: &Meter) -> Result<(), Error> {
    refuse_darkness(solution)?;
    if solution.mesh.is_full() {
        meter.tell("note: memory has ended the refinement; --max-memory allows more");
    }
    Ok(())
}

/// Of the light that could arrive, a smaller share is rounding: what a sky sends through the edges of a closed room.
const ROUNDING: f64 = 1e-9;

/// Whether any light arrives at all.
fn refuse_darkness(solution: &Solution) -> Result<(), Error> {
    let direct = || solution.vertex_light.all_direct();
    let most = |light: &dyn Fn(Direct) -> Rgb| {
        direct().map(|direct| light(direct).max_element()).fold(0.0, f64::max)
    };
    let arriving = most(&|direct| direct.irradiance);
    if arriving > ROUNDING * most(&|direct| direct.unoccluded) {
        return Ok(());
    }
    Err(Error::Scene(format!(
        "all is black: light arrives at the front of no surface; if surfaces face away, try --two-sided on, or {HINT}"
    )))
}
