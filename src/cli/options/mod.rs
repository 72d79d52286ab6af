//! Options that subcommands share, grouped as the help shows them.

mod accuracy;
mod report;
mod scene;
pub(crate) mod values;
mod view;

pub(crate) use accuracy::AccuracyOptions;
pub(crate) use report::ReportOptions;
pub(crate) use scene::SceneOptions;
pub(crate) use view::{CameraChoice, PictureOptions, display};
