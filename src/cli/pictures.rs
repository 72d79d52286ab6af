//! Pictures as files: all views that are asked for, from one camera, at one exposure.

use std::path::PathBuf;

use radiosity::render::{self, Subject, render_solved};
use radiosity::scene::{Camera, NamedLight};
use radiosity::tone::Exposure;

use super::failure::Failure;
use super::interrupt::Interrupt;
use super::meter::Meter;
use super::options::{PictureOptions, display};
use super::record::CameraRecord;

/// What the pictures are of, and how they are taken.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pictures<'a> {
    pub(crate) subject: Subject<'a>,
    /// Lights of which skies and suns are seen behind it.
    pub(crate) sky: &'a [NamedLight],
    pub(crate) camera: &'a Camera,
    pub(crate) exposure: Exposure,
    /// False if the subject itself cannot tell that its light is unfinished, but it is.
    pub(crate) finished: bool,
}

impl Pictures<'_> {
    /// Makes the pictures, and writes each to its file.
    pub(crate) fn write(
        &self,
        options: &PictureOptions,
        files: &[PathBuf],
        interrupt: &Interrupt,
        meter: &mut Meter,
    ) -> Result<(), Failure> {
        meter.explain(&format!("camera {}", CameraRecord::from(self.camera)));
        let display = display(self.subject.mesh, self.exposure);
        for (view, files) in options.views(files)? {
            let drawing = options.drawing(view, self.sky);
            let mut picture = render_solved(self.subject, self.camera, &drawing, |done| {
                meter.advance("picture", done);
                interrupt.flow()
            });
            picture.unfinished |= !self.finished || !interrupt.is_whole();
            for file in files {
                render::save(&picture, file, &display)?;
            }
        }
        Ok(())
    }
}
