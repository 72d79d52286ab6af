//! What a report says beyond the comparison itself.

use serde_json::Value;

use crate::page::Fact;
use crate::render::Display;
use crate::scene::Camera;

/// What a report says beyond the comparison itself.
#[derive(Clone, Copy, Debug)]
pub struct Account<'a> {
    /// Above everything: what the scene is called.
    pub title: &'a str,
    /// What has been compared, when, on what machine and by which command.
    pub identity: &'a [Fact<'a>],
    /// What was repaired or assumed when the scene was read.
    pub notes: &'a [String],
    /// Where the figures come from, for those who read the page by program.
    pub about: &'a Value,
    /// From where pictures are taken.
    pub camera: &'a Camera,
    /// How they are shown.
    pub display: Display,
}
