//! `radiosity render`: a picture of a solved GLB, from anywhere.

use std::path::PathBuf;

use clap::Args;
use radiosity::export;
use radiosity::render;
use serde_json::json;

use super::console;
use super::failure::Failure;
use super::interrupt::Interrupt;
use super::meter::Meter;
use super::options::{Elsewhere, PictureOptions, ReportOptions, WritingOptions};
use super::outputs::Outputs;
use super::pictures::Pictures;
use super::record::{CameraRecord, cameras, lights};
use super::streams::Streams;

/// Make a picture of a solved GLB, from anywhere
///
/// The light is in the file: nothing is computed again, any view is ready in a moment. Ctrl-C and SIGTERM leave edges
/// unsmoothed; the exit code is 3 then.
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
    writing: WritingOptions,

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
    pub(crate) fn run(mut self) -> Result<(), Failure> {
        let mut streams = Streams::default();
        streams.divert(&mut self.output, &self.writing, self.report.json)?;
        let outputs = Outputs { files: self.output.clone(), force: self.writing.force };
        outputs.check(std::slice::from_ref(&self.path), &[])?;
        self.output.iter().try_for_each(|path| render::check_writable(path))?;
        self.picture.views(&self.output)?;
        self.picture.check_use(&self.output, Elsewhere::Nothing)?;
        self.picture.check_for_file()?;
        self.report.talk.use_threads()?;
        let interrupt = Interrupt::listen();
        let mut meter = Meter::new(&self.report.talk);
        meter.begin("reading");
        let (mesh, mut stamp) = export::load_solved(&self.path)?;
        let choice = self.picture.choose_camera(&cameras(&stamp.settings))?;
        if !stamp.finished {
            meter.tell("the solution was stopped before it was done");
        }
        let lights = lights(&stamp.settings);
        meter.begin("picture");
        let (camera, exposure) = self.picture.look(&choice, &mesh, stamp.exposure);
        stamp.exposure = exposure;
        interrupt.worth_writing();
        let pictures = Pictures::of_file(&mesh, &lights, &camera, &stamp);
        pictures.write(&self.picture, &self.output, &interrupt, &mut meter)?;
        streams.deliver()?;
        let camera = CameraRecord::from(&camera);
        let written: Vec<PathBuf> = self.output.iter().map(|path| streams.name(path)).collect();
        let seconds = meter.into_timings();
        if self.report.json {
            console::print_json(&json!({
                "finished": stamp.finished && interrupt.is_whole(),
                "camera": camera,
                "written": written,
                "seconds": seconds,
            }))?;
        } else if !self.report.talk.quiet {
            let names: Vec<String> =
                written.iter().map(|path| path.display().to_string()).collect();
            streams.print(&format!("written: {}", names.join(", ")))?;
        }
        interrupt.ending()
    }
}
