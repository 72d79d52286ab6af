//! `radiosity form-factors`: the matrix itself.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use glam::DVec3;
use radiosity::export::{FactorPatch, FactorTable, check_writable_factors, save_factors};
use radiosity::form_factor::{self, Assembled, assemble, factors_at};
use radiosity::mesh::Mesh;
use radiosity::surface::Surface;
use radiosity::visibility::{Occluders, SurfacePoint};
use radiosity::{Error, Length, Settings, Surfaces, faces_of};
use serde::Serialize;

use super::console;
use super::enclosure::Enclosure;
use super::failure::Failure;
use super::interrupt::Interrupt;
use super::meter::{Meter, Timing};
use super::options::{ReportOptions, SceneOptions, TimeOptions, WritingOptions, values};
use super::outputs::Outputs;
use super::streams::Streams;

/// Most bytes that a matrix may take, if all its factors were above zero.
const MOST_BYTES: f64 = 16e9;

/// Bytes of a factor: 64 bits of value, 32 of column.
const FACTOR_BYTES: f64 = 12.0;

/// Cells along a hemicube's edge if nothing is said of it.
const CELLS: u32 = 256;

/// Rays from each point if nothing is said of them.
const RAYS: u32 = 65_536;

/// Compute the form factors (view factors) between all patches, and from a point
///
/// F[i][j] is the share of the light leaving patch i that arrives at patch j. Faces are not joined: with a
/// patch size above the scene's, each polygon of the file is one patch. Nothing needs to emit light. Ctrl-C, SIGTERM and
/// --time-limit end the work early: the rows that are done are written, the others are empty, and the exit code is 3.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct FormFactorsCommand {
    #[command(flatten)]
    scene: SceneOptions,

    /// File to write: .json (patches and matrix), .csv (factors above zero) or .npy (matrix); may be repeated
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,

    #[command(flatten)]
    writing: WritingOptions,

    /// How to find what is hidden; where nothing is, all methods but hemicube-sum use the exact formula
    #[arg(long, value_enum, default_value_t = AssemblyMethod::Contour)]
    method: AssemblyMethod,

    /// Longest side of a patch, in metres (default: 1/14 of the scene)
    #[arg(long, value_name = "METRES", value_parser = values::number)]
    patch_size: Option<f64>,

    /// Form factors from this point and normal, too, in a .json or .csv: x,y,z,nx,ny,nz
    #[arg(long, value_name = "X,Y,Z,NX,NY,NZ", value_parser = values::place)]
    #[arg(allow_hyphen_values = true, requires = "output")]
    at: Option<(DVec3, DVec3)>,

    /// Make the matrix reciprocal and, in a closed scene, its rows sum to one, to within 1e-12
    #[arg(long)]
    enforce: bool,

    /// Cells along a hemicube's edge, with --method hemicube or hemicube-sum: even, 32 to 1024 (default: 256)
    #[arg(long, value_name = "CELLS")]
    hemicube_resolution: Option<u32>,

    /// Rays from each point, with --method rays: 64 to 16777216 (default: 65536)
    #[arg(long, value_name = "N")]
    rays: Option<u32>,

    #[command(flatten)]
    time: TimeOptions,

    #[command(flatten)]
    report: ReportOptions,
}

const EXAMPLES: &str = "\
Examples:
  radiosity form-factors scenes/furnace.obj --patch-size 1 -o F.json
  radiosity form-factors room.obj --method hemicube --enforce -o F.npy
  radiosity form-factors scenes/blocker.obj --at 0,0,0,0,1,0 --patch-size 9 -o sky.csv";

#[derive(Clone, Copy, Debug, ValueEnum)]
enum AssemblyMethod {
    /// Visibility by the cells of hemicubes over four points or more of a patch, amounts by the exact formula
    Hemicube,
    /// The classical hemicube: from the centre of a patch, plain sums of the cells' delta form factors, aliasing and all
    HemicubeSum,
    /// Exactly: occluders are cut out, and the rest integrated
    Contour,
    /// One ray through each cell of a hemisphere
    Rays,
}

impl FormFactorsCommand {
    pub(crate) fn run(mut self) -> Result<(), Failure> {
        let mut streams = Streams::default();
        streams.divert(&mut self.output, &self.writing, self.report.json)?;
        let (settings, method) = (self.settings()?, self.method()?);
        let outputs = Outputs { files: self.output.clone(), force: self.writing.force };
        outputs.check(&self.scene.files(), &[])?;
        self.output.iter().try_for_each(|path| check_writable_factors(path))?;
        self.report.talk.use_threads()?;
        let interrupt = Interrupt::listen().within(self.time.time_limit);
        let mut meter = Meter::new(&self.report.talk);
        meter.begin("reading");
        let scene = self.scene.load(|line| meter.tell(line))?;
        outputs.check(&scene.files, &[])?;
        let surfaces = patches_from(faces_of(&scene), &settings);
        settings.validate_for(surfaces.divided_area(), surfaces.extent)?;
        let mesh = Mesh::new(&surfaces, &settings);
        tell_memory(&mesh, &meter)?;
        let occluders = Occluders::new(&surfaces);
        let assembled = assemble(&mesh.patches, &occluders, method, |done| {
            interrupt.worth_writing();
            meter.advance("form factors", done);
            interrupt.go_on()
        });
        let at = self.at.map(|(position, normal)| {
            factors_at(&mesh.patches, &occluders, method, SurfacePoint::new(position, normal))
        });

        let whole = Whole::new(&surfaces, &mesh, &settings);
        let enclosure = Enclosure::new(whole.assembled(assembled), &whole.patches);
        let enclosure = if self.enforce { enclosure.enforced() } else { enclosure };
        let at = at.map(|at| whole.sums(&at));
        let table = FactorTable { patches: whole.patches, factors: &enclosure.factors, at };
        if !self.output.is_empty() {
            meter.begin("writing");
        }
        self.output.iter().try_for_each(|path| save_factors(&table, path))?;
        meter.end();
        streams.deliver()?;
        match (self.report.json, self.report.talk.quiet) {
            (true, _) => console::print_json(&EnclosureFigures {
                finished: interrupt.is_whole(),
                scene: self.scene.path,
                enclosure: &enclosure,
                written: self.output.iter().map(|path| streams.name(path)).collect(),
                seconds: meter.into_timings(),
                notes: scene.notes,
            })?,
            (false, true) => (),
            (false, false) => streams.print(&enclosure.to_string())?,
        }
        interrupt.ending()
    }

    fn settings(&self) -> Result<Settings, Error> {
        let settings = Settings::medium();
        let settings = Settings {
            patch_size: self.patch_size.map_or(settings.patch_size, Length::Metres),
            hemicube_resolution: self.cells(),
            ..settings
        };
        settings.validate()?;
        Ok(settings)
    }

    fn method(&self) -> Result<form_factor::FormFactorMethod, Error> {
        let refused = |name, message: String| Err(Error::Setting { name, message });
        if self.rays.is_some() && !matches!(self.method, AssemblyMethod::Rays) {
            return refused("rays", "are those of --method rays; say that, too".to_owned());
        }
        let is_by_hemicubes =
            matches!(self.method, AssemblyMethod::Hemicube | AssemblyMethod::HemicubeSum);
        if self.hemicube_resolution.is_some() && !is_by_hemicubes {
            let message = "is that of --method hemicube or hemicube-sum; say that, too".to_owned();
            return refused("hemicube-resolution", message);
        }
        let rays = self.rays.unwrap_or(RAYS);
        if !(64..=1 << 24).contains(&rays) {
            return refused("rays", format!("{rays} is out of range; use 64 to {}", 1 << 24));
        }
        let is_matrix = |path: &PathBuf| path.extension().is_some_and(|end| end == "npy");
        if self.at.is_some() && self.output.iter().all(is_matrix) {
            let message = "has no place in a .npy; write a .json or .csv, too".to_owned();
            return refused("at", message);
        }
        Ok(match self.method {
            AssemblyMethod::Hemicube => form_factor::FormFactorMethod::Hemicube(self.cells()),
            AssemblyMethod::HemicubeSum => form_factor::FormFactorMethod::HemicubeSum(self.cells()),
            AssemblyMethod::Contour => form_factor::FormFactorMethod::Contour,
            AssemblyMethod::Rays => form_factor::FormFactorMethod::Rays(rays),
        })
    }

    fn cells(&self) -> u32 {
        self.hemicube_resolution.unwrap_or(CELLS)
    }
}

/// A matrix in figures, with what the command knows beside it.
#[derive(Debug, Serialize)]
struct EnclosureFigures<'a> {
    finished: bool,
    scene: PathBuf,
    #[serde(flatten)]
    enclosure: &'a Enclosure,
    written: Vec<PathBuf>,
    seconds: Vec<Timing>,
    notes: Vec<String>,
}

/// Without contact lines if patches may be as large as the scene: then polygons stay whole.
fn patches_from(mut surfaces: Surfaces, settings: &Settings) -> Surfaces {
    if settings.patch_length(surfaces.extent) >= surfaces.extent {
        surfaces.list.iter_mut().for_each(|surface| surface.contacts.clear());
    }
    surfaces
}

fn tell_memory(mesh: &Mesh, meter: &Meter) -> Result<(), Error> {
    let patches = mesh.patches.len();
    let bytes = (patches as f64).powi(2) * FACTOR_BYTES;
    if bytes > MOST_BYTES {
        let message = format!(
            "{patches} patches have up to {:.0} GB of form factors; use larger ones",
            bytes / 1e9
        );
        return Err(Error::Setting { name: "patch-size", message });
    }
    meter.tell(&format!("{patches} patches: up to {:.1} MB of form factors", bytes / 1e6));
    Ok(())
}

/// Patches as the user sees them: a concave polygon within the patch size is one, though computed in
/// convex pieces.
struct Whole {
    patches: Vec<FactorPatch>,
    /// By piece: the patch it is part of.
    group: Vec<usize>,
}

impl Whole {
    fn new(surfaces: &Surfaces, mesh: &Mesh, settings: &Settings) -> Self {
        let size = settings.patch_length(surfaces.extent);
        let is_whole = |surface: &Surface| surface.extent() <= size;
        let mut whole = Self { patches: Vec::new(), group: Vec::new() };
        for (k, piece) in mesh.patches.iter().enumerate() {
            let surface = &surfaces[piece.surface];
            let centre = mesh.centre(piece.root, &surface.plane);
            let continues = k > 0 && mesh.patches[k - 1].surface == piece.surface;
            match whole.patches.last_mut() {
                Some(patch) if continues && is_whole(surface) => {
                    let area = patch.area + piece.area;
                    let mean = DVec3::from(patch.centre).lerp(centre, piece.area / area);
                    (patch.area, patch.centre) = (area, mean.to_array());
                }
                _ => whole.patches.push(FactorPatch {
                    object: surfaces
                        .objects
                        .get(surface.object as usize)
                        .cloned()
                        .unwrap_or_default(),
                    material: surfaces[surface.material].name.clone(),
                    area: piece.area,
                    centre: centre.to_array(),
                    normal: piece.normal.to_array(),
                }),
            }
            whole.group.push(whole.patches.len() - 1);
        }
        whole
    }

    fn assembled(&self, pieces: Assembled) -> Assembled {
        if self.patches.len() == self.group.len() {
            return pieces;
        }
        let areas = pieces.factors.areas().to_vec();
        let power: Vec<f64> =
            pieces.on_backs.iter().zip(&areas).map(|(b, area)| b * area).collect();
        let on_backs = self.sums(&power).into_iter().zip(&self.patches);
        Assembled {
            factors: pieces.factors.grouped(&self.group, self.patches.len()),
            on_backs: on_backs.map(|(power, patch)| power / patch.area).collect(),
            rows: self.group.get(pieces.rows).copied().unwrap_or(self.patches.len()),
        }
    }

    /// Sums over the pieces of each patch.
    fn sums(&self, values: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.patches.len()];
        values.iter().zip(&self.group).for_each(|(value, &patch)| sums[patch] += value);
        sums
    }
}
