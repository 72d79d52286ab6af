//! `radiosity info`: what would be solved, without solving it.

use clap::Args;
use radiosity::mesh::Mesh;
use radiosity::surfaces_of;

use super::console;
use super::facts::Facts;
use super::failure::Failure;
use super::options::{AccuracyOptions, ReportOptions, SceneOptions};

/// Show what would be solved: surfaces, materials, emitters, size in metres, repairs
///
/// Nothing is computed: options of accuracy are those of `solve`, but only sizes of patches and of uniform elements show. Look at the size first: a room of 300 metres wants `--units cm`, and one as high as a house is long, `--up z`.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  radiosity info scenes/office.obj --quality high")]
pub(crate) struct Info {
    #[command(flatten)]
    scene: SceneOptions,

    #[command(flatten)]
    accuracy: AccuracyOptions,

    #[command(flatten)]
    report: ReportOptions,
}

impl Info {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let settings = self.accuracy.settings();
        settings.validate()?;
        self.report.talk.use_threads()?;
        let (scene, added) = self.scene.read()?;
        if added.is_err() {
            scene.notes.iter().for_each(|note| console::tell(&format!("note: {note}")));
        }
        added?;
        let surfaces = surfaces_of(&scene);
        settings.validate_for(surfaces.divided_area(), surfaces.extent)?;
        let mesh = Mesh::new(&surfaces, &settings);
        let facts = Facts::new(self.scene.path, &scene, &surfaces, &mesh);
        match (self.report.json, self.report.talk.quiet) {
            (true, _) => console::print_json(&facts)?,
            (false, true) => (),
            (false, false) => console::print(&facts.to_string())?,
        }
        Ok(())
    }
}
