//! `compare -o`: the page of a comparison.

use std::fs;
use std::io;
use std::path::Path;

use radiosity::compare::{self, Account, Comparison};
use radiosity::page::{self, Fact};
use radiosity::render::{Display, automatic_camera, exposure_seen};
use radiosity::tone::exposure_scale;
use radiosity::{Error, Result, Scene, TriMesh};
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::record::SettingsRecord;

/// Width over height of a report's pictures.
const ASPECT: f64 = 4.0 / 3.0;

/// What has been compared, and how.
pub(crate) struct ReportSubject<'a> {
    pub(crate) path: &'a Path,
    pub(crate) scene: &'a Scene,
    pub(crate) comparison: &'a Comparison,
    pub(crate) settings: &'a SettingsRecord,
    /// Where the figures come from.
    pub(crate) about: &'a Value,
}

/// Writes the page.
pub(crate) fn write(subject: &ReportSubject<'_>, output: &Path) -> Result<()> {
    let ReportSubject { path, scene, comparison, about, .. } = subject;
    let finest = comparison.shown.and_then(|[_, run]| comparison.runs[run].lit.as_ref());
    let mesh = finest.map(|lit| &lit.mesh);
    let camera = match (scene.cameras.first(), mesh) {
        (Some(camera), _) => camera.clone(),
        (None, Some(mesh)) => automatic_camera(mesh, ASPECT),
        (None, None) => automatic_camera(&TriMesh::default(), ASPECT),
    };
    let seen = |mesh| exposure_scale(mesh, exposure_seen(mesh, &camera, ASPECT));
    let scale = mesh.map_or(1.0, seen);
    let title = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
    let account = Account {
        title: &title,
        identity: &identity(subject)?,
        notes: &[scene.notes.as_slice(), &comparison.surfaces.notes].concat(),
        about,
        camera: &camera,
        display: Display::exposed(scale),
    };
    page::save(&compare::report(comparison, &account), output)
}

fn identity(subject: &ReportSubject<'_>) -> Result<[Fact<'static>; 7]> {
    let ReportSubject { path, scene, comparison, settings, .. } = subject;
    let emitters = comparison.surfaces.list.iter().filter(|surface| surface.is_emitter()).count();
    let facts = [
        ("Scene", format!("{}, SHA-256 {}", path.display(), hash(path)?)),
        (
            "Geometry",
            format!(
                "{} faces in {} surfaces, {:.2} m², {} materials",
                scene.faces.len(),
                comparison.surfaces.list.len(),
                comparison.surfaces.area(),
                scene.materials.len()
            ),
        ),
        ("Lights", format!("emitting surfaces {emitters}, others {}", scene.lights.len())),
        ("Settings", format!("{settings}; tolerance and size by run")),
        ("Machine", machine()),
        ("Made", format!("{} by radiosity {}", now(), env!("CARGO_PKG_VERSION"))),
        ("Command", command()),
    ];
    Ok(facts.map(|(name, value)| Fact { name, value }))
}

/// Of the scene's file itself; materials and textures beside it are not in it.
fn hash(path: &Path) -> Result<String> {
    let mut hasher = Sha256::new();
    let copied = fs::File::open(path).and_then(|mut file| io::copy(&mut file, &mut hasher));
    copied.map_err(Error::io(path))?;
    Ok(hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}

fn machine() -> String {
    let about = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = about.lines().find_map(|line| line.strip_prefix("model name")?.split(": ").nth(1));
    let threads = rayon::current_num_threads();
    let system = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
    format!("{}, {threads} threads, {system}", model.unwrap_or("unknown processor"))
}

fn now() -> String {
    jiff::Timestamp::now().strftime("%Y-%m-%d %H:%M UTC").to_string()
}

/// As it could be typed again.
fn command() -> String {
    let quoted = |argument: String| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=:%+@".contains(c);
        if !argument.is_empty() && argument.chars().all(plain) {
            argument
        } else {
            format!("'{}'", argument.replace('\'', r"'\''"))
        }
    };
    let name = |_| "radiosity".to_owned();
    let mut arguments = std::env::args_os().map(|argument| argument.to_string_lossy().into_owned());
    let program = arguments.next().map_or_else(String::new, name);
    [program].into_iter().chain(arguments.map(quoted)).collect::<Vec<_>>().join(" ")
}
