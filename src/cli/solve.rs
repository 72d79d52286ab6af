//! `radiosity solve`: from a scene to a lit mesh and its picture.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use radiosity::colour::Rgb;
use radiosity::export::{self, Stamp};
use radiosity::lightmap::Atlas;
use radiosity::mesh::Direct;
use radiosity::render::{self, Solved, Subject};
use radiosity::scene::Camera;
use radiosity::solver::Stop;
use radiosity::tone::Exposure;
use radiosity::{Error, Scene, Settings, Solution, Surfaces, surfaces_of};

use super::estimate::Estimate;
use super::failure::Failure;
use super::grid::GridOptions;
use super::interrupt::Interrupt;
use super::lighting::{Lighting, Lit, RelightOptions};
use super::lightmap::LightmapOptions;
use super::memory::Needs;
use super::meter::Meter;
use super::options::{
    AccuracyOptions, CameraChoice, CheckpointOptions, HINT, LimitOptions, PictureOptions,
    ReportOptions, SceneOptions, display,
};
use super::page::{Account, PageOptions};
use super::record::{CameraRecord, SettingsRecord, stamped};
use super::summary::{Outcome, Summary};
use super::{console, outputs};

/// Light a scene and write the mesh that carries its light, and pictures of it
///
/// Surfaces are diffuse. Light straight from emitters is exact and refines the mesh where shadows
/// and gradients ask for it; reflected light is exchanged between patches until almost nothing is
/// left unshot. Ctrl-C and SIGTERM end the work early and still
/// write everything.
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
    pub(crate) fn run(self) -> Result<(), Failure> {
        self.accuracy.settings().validate()?;
        self.check()?;
        self.report.talk.use_threads()?;
        let interrupt = Interrupt::listen().within(self.limits.time());
        let mut meter = Meter::new(&self.report.talk);
        self.warn_of_nothing(&meter);

        let (mut scene, camera) = self.read(&mut meter)?;
        let needs = self.needs(&scene);
        let surfaces = surfaces(&mut scene, &mut meter);
        let places = self.grid.places(&surfaces)?;
        let atlas = self.lightmap.atlas(&surfaces)?;
        let settings = self.settings(&surfaces, needs, &meter)?;
        let settings_record = SettingsRecord::new(&settings, surfaces.extent);
        let lighting = Lighting {
            surfaces: &surfaces,
            settings: &settings,
            checkpoint: &self.checkpoint,
            relight: &self.relight,
            stages: &self.page.stages(),
        };
        let Lit { solution, stages, mesh } = lighting.run(&interrupt, &mut meter)?;
        refuse_darkness(&solution)?;
        tell_if_full(&solution, &meter);

        let (camera, exposure) = self.picture.look(&camera, &mesh, Exposure::Automatic);
        let stamp = Stamp {
            exposure,
            settings: stamped(&settings_record, &scene),
            finished: solution.stop == Stop::Converged,
        };
        let solved = Solved { surfaces: &surfaces, settings: &settings, solution: &solution };
        let subject = Subject { mesh: &mesh, solved: Some(solved) };
        self.write_meshes(&subject, atlas.as_ref(), &stamp, &mut meter)?;
        self.write_pictures(subject, (&camera, exposure), &interrupt, &mut meter)?;
        if let Some(path) = &self.history {
            export::save_history(&solution.history, path)?;
        }
        let grid = self.grid.read(&places, solved, &interrupt, &mut meter)?;
        let summary = Summary::new(&surfaces, &solution, &mesh);
        let account = Account {
            scene: &self.scene.path,
            mesh: &mesh,
            solved,
            stages: &stages,
            camera: &camera,
            display: display(&mesh, exposure),
            summary: &summary,
            settings: &settings_record,
            notes: &scene.notes,
        };
        self.page.write(&account, &self.picture, &interrupt, &mut meter)?;
        self.report_on(&Outcome {
            scene: self.scene.path.clone(),
            summary,
            grid,
            settings: settings_record,
            seconds: meter.into_timings(),
            written: self.written().collect(),
            notes: scene.notes,
        })
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
        let estimate = Estimate::new(surfaces, &settings, needs);
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
        Ok((scene, camera))
    }

    /// Whether what is asked for can be written.
    fn check(&self) -> Result<(), Failure> {
        let tables: Vec<&Path> = self.tables().map(PathBuf::as_path).collect();
        outputs::check(&self.scene.path, &self.output, &self.image, &tables)?;
        self.checkpoint.check(&self.scene.path)?;
        outputs::check_lightmap(&self.scene.path, &self.lightmap, (&self.output, &self.image))?;
        self.page.check()?;
        self.picture.views(&self.image)?;
        Ok(())
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

    fn report_on(&self, outcome: &Outcome) -> Result<(), Failure> {
        match (self.report.json, self.report.talk.quiet) {
            (true, _) => console::print_json(outcome)?,
            (false, true) => (),
            (false, false) => console::print(&outcome.to_string())?,
        }
        Ok(())
    }

    fn write_meshes(
        &self,
        subject: &Subject<'_>,
        atlas: Option<&Atlas>,
        stamp: &Stamp,
        meter: &mut Meter,
    ) -> Result<(), Failure> {
        if !self.output.is_empty() {
            meter.begin("writing");
        }
        for path in &self.output {
            export::save(subject.mesh, path, stamp)?;
        }
        self.lightmap.write((atlas, &self.output), subject, stamp, meter)?;
        Ok(())
    }

    fn write_pictures(
        &self,
        subject: Subject<'_>,
        (camera, exposure): (&Camera, Exposure),
        interrupt: &Interrupt,
        meter: &mut Meter,
    ) -> Result<(), Failure> {
        if self.image.is_empty() {
            return Ok(());
        }
        meter.begin("picture");
        meter.explain(&format!("camera {}", CameraRecord::from(camera)));
        let display = display(subject.mesh, exposure);
        let lights = subject.solved.map_or(&[][..], |solved| &solved.surfaces.lights);
        for (view, paths) in self.picture.views(&self.image)? {
            let picture = self.picture.picture(view, subject, (camera, lights), |done| {
                meter.advance("picture", done);
                interrupt.flow()
            });
            for path in paths {
                render::save(&picture, path, &display)?;
            }
        }
        Ok(())
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

fn tell_if_full(solution: &Solution, meter: &Meter) {
    if solution.mesh.is_full() {
        meter.tell("note: memory has ended the refinement; --max-memory allows more");
    }
}

/// Of the light that could arrive, a smaller share is rounding: what a sky sends through the edges of a closed room.
const ROUNDING: f64 = 1e-9;

/// Whether any light arrives at all.
fn refuse_darkness(solution: &Solution) -> Result<(), Error> {
    let direct = || solution.mesh.vertices.iter().filter_map(|vertex| vertex.direct);
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
