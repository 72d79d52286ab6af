//! Pictures as files: all views that are asked for, from one camera, at one exposure.

use std::path::PathBuf;

use radiosity::TriMesh;
use radiosity::export::Stamp;
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
    subject: Subject<'a>,
    /// Lights of which skies and suns are seen behind it.
    sky: &'a [NamedLight],
    camera: &'a Camera,
    exposure: Exposure,
    /// False if the light is unfinished, but the subject cannot tell.
    finished: bool,
}

impl<'a> Pictures<'a> {
    /// Of what has just been solved.
    pub(crate) fn of_solution(
        subject: Subject<'a>,
        camera: &'a Camera,
        exposure: Exposure,
    ) -> Self {
        let sky = subject.solved.map_or(&[][..], |solved| &solved.surfaces.lights);
        Self { subject, sky, camera, exposure, finished: true }
    }

    /// Of a mesh that was read from a file.
    pub(crate) fn of_file(
        mesh: &'a TriMesh,
        sky: &'a [NamedLight],
        camera: &'a Camera,
        stamp: &Stamp,
    ) -> Self {
        let subject = Subject { mesh, solved: None };
        let &Stamp { exposure, finished, .. } = stamp;
        Self { subject, sky, camera, exposure, finished }
    }

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
                interrupt.go_on()
            });
            picture.unfinished |= !self.finished || !interrupt.is_whole();
            for file in files {
                render::save(&picture, file, &display)?;
            }
        }
        Ok(())
    }
}
