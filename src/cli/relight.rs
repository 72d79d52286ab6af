//! `radiosity relight`: other strengths and colours for the lights of a solved GLB.

use std::path::PathBuf;

use clap::Args;
use radiosity::colour::Rgb;
use radiosity::reconstruct::{Dimming, LightShare};
use radiosity::scene::NamedLight;
use radiosity::surface::LightGroup;
use radiosity::{Error, export, render};
use serde_json::json;

use super::console;
use super::failure::Failure;
use super::interrupt::Interrupt;
use super::meter::Meter;
use super::options::{Elsewhere, PictureOptions, ReportOptions, WritingOptions};
use super::outputs::Outputs;
use super::pictures::Pictures;
use super::record::{cameras, keep_lights, lights};
use super::streams::Streams;

/// Dim and colour the lights of a solved GLB, without solving again
///
/// The GLB was written by `radiosity solve --relightable`. The light is what a fresh solution with these lights, and with
/// --relightable, would be. Without --light, says which lights there are.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Relight {
    /// A GLB written by `radiosity solve --relightable`
    #[arg(value_name = "FILE.glb")]
    path: PathBuf,

    /// What becomes of a light: off, 50%, x2, x1,0.8,0.6, a strength in its unit, 800lm, 60cd or 20000lx
    ///
    /// Names may have * for any text and ? for any character. May be repeated; the last one counts.
    #[arg(long, value_name = "NAME=AMOUNT", value_parser = dimming)]
    light: Vec<(String, Dimming)>,

    /// Mesh to write: .glb, .obj or .ply; may be repeated
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,

    /// Picture to write: .png as seen, .hdr or .exr with linear radiance; may be repeated
    #[arg(long, value_name = "FILE")]
    image: Vec<PathBuf>,

    #[command(flatten)]
    writing: WritingOptions,

    #[command(flatten)]
    picture: PictureOptions,

    #[command(flatten)]
    report: ReportOptions,
}

const EXAMPLES: &str = "\
Examples:
  radiosity solve office.obj --relightable -o office.glb
  radiosity relight office.glb
  radiosity relight office.glb --light 'ceiling*=30%' --light desk=800lm -o evening.glb --image evening.png";

impl Relight {
    pub(crate) fn run(mut self) -> Result<(), Failure> {
        let streams = self.divert()?;
        let outputs = self.outputs();
        self.check(&outputs)?;
        self.report.talk.use_threads()?;
        let interrupt = Interrupt::listen();
        let mut meter = Meter::new(&self.report.talk);
        meter.begin("reading");
        let (mut mesh, mut stamp) = export::load_solved(&self.path)?;
        outputs.check(std::slice::from_ref(&self.path), &mesh.textures)?;
        let mut sky = lights(&stamp.settings);
        for (name, dimming) in &self.light {
            let before: Vec<Rgb> = mesh.lights.iter().map(|light| light.group.strength).collect();
            mesh.dim(name, *dimming)?;
            for (LightShare { group, .. }, before) in mesh.lights.iter().zip(before) {
                sky.iter_mut().for_each(|sky| dim_sky(sky, group, before));
            }
        }
        keep_lights(&mut stamp.settings, &sky);
        interrupt.worth_writing();
        let choice = self.picture.choose_camera(&cameras(&stamp.settings))?;
        let (camera, exposure) = self.picture.look(&choice, &mesh, stamp.exposure);
        stamp.exposure = exposure;
        if !self.output.is_empty() {
            meter.begin("writing");
        }
        for path in &self.output {
            export::save(&mesh, path, &stamp)?;
        }
        if !self.image.is_empty() {
            meter.begin("picture");
            let pictures = Pictures::of_file(&mesh, &sky, &camera, &stamp);
            pictures.write(&self.picture, &self.image, &interrupt, &mut meter)?;
        }
        streams.deliver()?;
        let seconds = meter.into_timings();
        let lights = mesh.lights.iter().map(|light| &light.group);
        if self.report.json {
            let written: Vec<PathBuf> =
                outputs.files.iter().map(|path| streams.name(path)).collect();
            let lights: Vec<_> = lights.collect();
            console::print_json(&json!({
                "finished": stamp.finished && interrupt.is_whole(),
                "lights": lights,
                "written": written,
                "seconds": seconds,
            }))?;
        } else if !self.report.talk.quiet {
            for light in lights {
                streams.print(&format!("light \"{}\": {light}", light.name))?;
            }
            if mesh.lights.is_empty() {
                streams.print("lights are not kept apart; solve with --relightable")?;
            }
        }
        interrupt.ending()
    }

    /// Puts files in the place of outputs that are none.
    fn divert(&mut self) -> Result<Streams, Error> {
        let mut streams = Streams::default();
        let all = self.output.iter_mut().chain(&mut self.image);
        streams.divert(all, &self.writing, self.report.json)?;
        Ok(streams)
    }

    fn outputs(&self) -> Outputs {
        let files = self.output.iter().chain(&self.image).cloned().collect();
        Outputs { files, force: self.writing.force }
    }

    /// Whether what is asked for can be written, and makes sense.
    fn check(&self, outputs: &Outputs) -> Result<(), Error> {
        outputs.check(std::slice::from_ref(&self.path), &[])?;
        self.output.iter().try_for_each(|path| export::check_writable(path))?;
        self.image.iter().try_for_each(|path| render::check_writable(path))?;
        self.picture.views(&self.image)?;
        let has_mesh = !self.output.is_empty();
        let elsewhere = if has_mesh { Elsewhere::Colours } else { Elsewhere::Nothing };
        self.picture.check_use(&self.image, elsewhere)?;
        self.picture.check_for_file()
    }
}

/// What is seen of a sky follows its light, which was `before`.
fn dim_sky(sky: &mut NamedLight, group: &LightGroup, before: Rgb) {
    if !group.holds(&sky.name) {
        return;
    }
    if let Some(irradiance) = sky.light.strength() {
        let dimmed =
            Rgb::select(before.cmpgt(Rgb::ZERO), irradiance / before, Rgb::ONE) * group.strength;
        sky.light = sky.light.clone().with_strength(dimmed);
    }
}

/// `lamp=50%`.
fn dimming(text: &str) -> Result<(String, Dimming), String> {
    let (name, amount) = text.rsplit_once('=').ok_or("write NAME=AMOUNT, as in lamp=50%")?;
    Ok((name.to_owned(), amount.parse()?))
}
