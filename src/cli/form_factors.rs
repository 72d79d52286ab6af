//! `radiosity form-factors`: the matrix itself.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use glam::DVec3;
use radiosity::export::{FactorPatch, FactorTable, save_factors};
use radiosity::form_factor::{self, Assembled, assemble, factors_at};
use radiosity::mesh::Mesh;
use radiosity::visibility::Occluders;
use radiosity::{Error, Length, Settings, Surfaces, faces_of};

use super::console;
use super::enclosure::Enclosure;
use super::failure::Failure;
use super::interrupt::Interrupt;
use super::meter::Meter;
use super::options::{ReportOptions, SceneOptions, values};
use super::outputs;

/// Most bytes that a matrix may take, if all its factors were above zero.
const MOST_BYTES: f64 = 16e9;

/// Bytes of a factor: 64 bits of value, 32 of column.
const FACTOR_BYTES: f64 = 12.0;

/// Compute the form factors (view factors) between all patches, and from a point
///
/// F[i][j] is the share of the light leaving patch i that arrives at patch j. Faces are not joined: with a
/// patch size above the scene's, each polygon of the file is one patch. Nothing needs to emit light.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct FormFactors {
    #[command(flatten)]
    scene: SceneOptions,

    /// File to write: .json (patches and matrix), .csv (factors above zero) or .npy (matrix); may be repeated
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,

    /// How to find what is hidden; where nothing is, all methods use the exact formula
    #[arg(long, value_enum, default_value_t = Method::Contour)]
    method: Method,

    /// Longest side of a patch, in metres (default: 1/14 of the scene)
    #[arg(long, value_name = "METRES", value_parser = values::number)]
    patch_size: Option<f64>,

    /// Form factors from this point and normal, too: x,y,z,nx,ny,nz
    #[arg(long, value_name = "X,Y,Z,NX,NY,NZ", value_parser = values::place)]
    #[arg(allow_hyphen_values = true)]
    at: Option<(DVec3, DVec3)>,

    /// Make the matrix reciprocal and, in a closed scene, its rows sum to one, to within 1e-12
    #[arg(long)]
    enforce: bool,

    /// Cells along a hemicube's edge: even, 32 to 1024
    #[arg(long, value_name = "CELLS", default_value_t = 256)]
    hemicube_resolution: u32,

    /// Rays from each point (64 to 16777216)
    #[arg(long, value_name = "N", default_value_t = 65_536)]
    rays: u32,

    #[command(flatten)]
    report: ReportOptions,
}

const EXAMPLES: &str = "\
Examples:
  radiosity form-factors scenes/furnace.obj --patch-size 1 -o F.json
  radiosity form-factors room.obj --method hemicube --enforce -o F.npy
  radiosity form-factors scenes/blocker.obj --at 0,0,0,0,1,0 --patch-size 9 -o sky.csv";

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Method {
    /// Sums over the cells of hemicubes
    Hemicube,
    /// Exactly: occluders are cut out, and the rest integrated
    Contour,
    /// One ray through each cell of a hemisphere
    Rays,
}

impl FormFactors {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let (settings, method) = (self.settings()?, self.method()?);
        outputs::check_factors(&self.scene.path, &self.output)?;
        self.report.talk.use_threads()?;
        let interrupt = Interrupt::listen();
        let mut meter = Meter::new(&self.report.talk);
        meter.begin("reading");
        let scene = self.scene.load(|line| meter.tell(line))?;
        let surfaces = patches_from(faces_of(&scene), &settings);
        settings.validate_for(surfaces.divided_area(), surfaces.extent)?;
        let mesh = Mesh::new(&surfaces, &settings);
        tell_memory(&mesh, &meter)?;
        let occluders = Occluders::new(&surfaces);
        let assembled = assemble(&mesh.patches, &occluders, method, |done| {
            meter.advance("form factors", done);
            interrupt.flow()
        });
        let at = self.at.map(|place| factors_at(&mesh.patches, &occluders, method, place));

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
        match (self.report.json, self.report.talk.quiet) {
            (true, _) => console::print_json(&enclosure)?,
            (false, true) => (),
            (false, false) => console::print(&enclosure.to_string())?,
        }
        Ok(())
    }

    fn settings(&self) -> Result<Settings, Error> {
        let settings = Settings::medium();
        let settings = Settings {
            patch_size: self.patch_size.map_or(settings.patch_size, Length::Metres),
            hemicube_resolution: self.hemicube_resolution,
            ..settings
        };
        settings.validate()?;
        Ok(settings)
    }

    fn method(&self) -> Result<form_factor::Method, Error> {
        if !(64..=1 << 24).contains(&self.rays) {
            let message = format!("{} is out of range; use 64 to {}", self.rays, 1 << 24);
            return Err(Error::Setting { name: "rays", message });
        }
        Ok(match self.method {
            Method::Hemicube => form_factor::Method::Hemicube(self.hemicube_resolution),
            Method::Contour => form_factor::Method::Contour,
            Method::Rays => form_factor::Method::Rays(self.rays),
        })
    }
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
        let is_whole = |surface: u32| {
            let (low, high) = surfaces.list[surface as usize].bounds();
            low.distance(high) <= size
        };
        let mut whole = Self { patches: Vec::new(), group: Vec::new() };
        for (k, piece) in mesh.patches.iter().enumerate() {
            let surface = &surfaces.list[piece.surface as usize];
            let centre = mesh.centre(piece.root, &surface.plane);
            let continues = k > 0 && mesh.patches[k - 1].surface == piece.surface;
            match whole.patches.last_mut() {
                Some(patch) if continues && is_whole(piece.surface) => {
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
                    material: surfaces.materials[surface.material as usize].name.clone(),
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
