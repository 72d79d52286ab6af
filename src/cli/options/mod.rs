//! Options that subcommands share, grouped as the help shows them.

mod accuracy;
mod checkpoint;
mod lights;
mod limits;
mod report;
mod scene;
pub(crate) mod values;
mod view;
mod writing;

pub(crate) use accuracy::{AccuracyOptions, MethodOptions};
pub(crate) use checkpoint::CheckpointOptions;
pub(crate) use lights::HINT;
pub(crate) use limits::{LimitOptions, TimeOptions};
pub(crate) use report::{ReportOptions, TalkOptions};
pub(crate) use scene::SceneOptions;
pub(crate) use view::{CameraChoice, Elsewhere, PictureOptions, display};
pub(crate) use writing::WritingOptions;
