//! `radiosity render`: a picture of a solved GLB, from anywhere.

use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;
use radiosity::render::{self, Subject};
use radiosity::scene::NamedLight;
use radiosity::tone::Exposure;
use radiosity::{TriMesh, export};
use serde_json::json;

use super::failure::Failure;
use super::meter::Meter;
use super::options::{CameraChoice, PictureOptions, ReportOptions, display};
use super::record::{CameraRecord, cameras, lights};
use super::{console, outputs};

/// Make a picture of a solved GLB, from anywhere
///
/// The light is in the file: nothing is computed again, any view is ready in a moment.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Render {
    /// A GLB written by `radiosity solve`
    #[arg(value_name = "FILE.glb")]
    path: PathBuf,

    /// Picture to write: .png as seen, .hdr or .exr with linear radiance; may be repeated
    #[arg(short, long, value_name = "FILE", required = true)]
    output: Vec<PathBuf>,

    #[command(flatten)]
    picture: PictureOptions,

    #[command(flatten)]
    report: ReportOptions,
}

const EXAMPLES: &str = "\
Examples:
  radiosity render cornell.glb -o mesh.png --view wireframe
  radiosity render cornell.glb -o corner.png --eye 0.1,0.5,-0.2 --target 0.3,0.2,0.3 --fov 60
  radiosity render office.glb -o a.png -o b.png --view light,radiosity --size 1600x900";

impl Render {
    pub(crate) fn run(self) -> Result<(), Failure> {
        outputs::check(&self.path, &[], &self.output, &[])?;
        self.picture.views(&self.output)?;
        self.picture.check_for_file()?;
        self.report.talk.use_threads()?;
        let mut meter = Meter::new(&self.report.talk);
        meter.begin("reading");
        let (mesh, stamp) = export::load_solved(&self.path)?;
        let choice = self.picture.choose_camera(&cameras(&stamp.settings))?;
        if !stamp.finished {
            meter.tell("the solution was stopped before it was done");
        }
        let exposure = self.picture.exposure.unwrap_or(stamp.exposure);
        let lights = lights(&stamp.settings);
        let camera =
            draw((&mesh, &lights), (&self.picture, &self.output), (&choice, exposure), &mut meter)?;
        let seconds = meter.into_timings();
        if self.report.json {
            let written = &self.output;
            console::print_json(
                &json!({ "camera": camera, "written": written, "seconds": seconds }),
            )?;
        } else if !self.report.talk.quiet {
            let names: Vec<String> =
                self.output.iter().map(|path| path.display().to_string()).collect();
            console::print(&format!("written: {}", names.join(", ")))?;
        }
        Ok(())
    }
}

/// Makes pictures of a mesh that was read from a file and the sky behind it, and returns from where.
pub(crate) fn draw(
    (mesh, sky): (&TriMesh, &[NamedLight]),
    (options, paths): (&PictureOptions, &[PathBuf]),
    (choice, exposure): (&CameraChoice, Exposure),
    meter: &mut Meter,
) -> Result<CameraRecord, Failure> {
    meter.begin("picture");
    let camera = options.camera(choice, mesh);
    let record = CameraRecord::from(&camera);
    meter.explain(&format!("camera {record}"));
    let display = display(mesh, exposure);
    let subject = Subject { mesh, solved: None };
    for (view, paths) in options.views(paths)? {
        let picture = options.picture(view, subject, (&camera, sky), |done| {
            meter.advance("picture", done);
            ControlFlow::Continue(())
        });
        for path in paths {
            render::save(&picture, path, &display)?;
        }
    }
    Ok(record)
}
