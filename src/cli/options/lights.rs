//! Light for files that have none.

use std::f64::consts::PI;
use std::path::PathBuf;

use clap::Args;
use glam::DVec3;
use radiosity::colour::{LUMENS_PER_WATT, Rgb};
use radiosity::scene::{Amount, AreaLight, DESIGN_SKY, Light, NamedLight, Sky, clear_sun};
use radiosity::{Error, Scene};

use super::values::{number, vector};

/// What to do about a scene without light.
pub(crate) const HINT: &str =
    "light it by --emit MATERIAL=800lm, --area-light, --point-light, --ies, --sun or --sky";

/// What is added to a scene, and what is changed about it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Light and materials")]
pub(crate) struct LightOptions {
    /// Make a material emit: a radiance in W/(m² sr), one number or r,g,b, or all its lumens: 800lm
    ///
    /// A name may have * for any text and ? for any character; lumens are those of all faces of all materials that
    /// match. A texture of the emission is left out. May be repeated.
    #[arg(long, value_name = "MATERIAL=AMOUNT", value_parser = emission)]
    emit: Vec<(String, Amount)>,

    /// Add a lamp: a black rectangle that shines down, or along a direction; may be repeated
    ///
    /// `2,2.4,3=1.2x0.3=3000lm` has its middle at x,y,z, 1.2 m along X and 0.3 m along Z. `=0,0,1` after that makes
    /// it shine along +Z; its width is horizontal then.
    #[arg(long, value_name = "X,Y,Z=WxD=AMOUNT[=NX,NY,NZ]", value_parser = area_light)]
    #[arg(allow_hyphen_values = true)]
    area_light: Vec<AreaLight>,

    /// Add a light without size, even in all directions: lumens, candela or W/sr; may be repeated
    #[arg(long, value_name = "X,Y,Z=800lm|60cd|W/SR", value_parser = point_light)]
    #[arg(allow_hyphen_values = true)]
    point_light: Vec<(Light, bool)>,

    /// Add a luminaire from an IES file (LM-63, type C), aimed down; may be repeated
    ///
    /// Its light comes from a point. Horizontal angle 0 is along +X, turned by DEGREES counter-clockwise seen from above.
    #[arg(long, value_name = "FILE.ies@X,Y,Z[,DEGREES]", value_parser = luminaire)]
    ies: Vec<Luminaire>,

    /// Let the sun shine: degrees clockwise from north (-Z; east is +X), degrees over the horizon, lux facing it
    ///
    /// Of a file read with --up z, north is its +Y. It is 0.53° wide, so shadows have borders. Without LUX, that of clear air: 127500 exp(-0.21 / sin elevation), 95 000 lx at 45°.
    #[arg(long, value_name = "AZIMUTH,ELEVATION[,LUX]", value_parser = sun)]
    #[arg(allow_hyphen_values = true)]
    sun: Option<Light>,

    /// Let a sky shine from above the horizon: uniform or cie-overcast, and its lux on open ground
    ///
    /// Without LUX, 10 000: daylight factors in per cent are a hundredth of the lux then. Exact through openings.
    #[arg(long, value_name = "KIND[,LUX]", value_parser = sky)]
    sky: Option<Light>,

    /// Change materials as a TOML file says: ["wall*"] with reflectance, emission, `double_sided`, removed below it
    ///
    /// `reflectance = 0.7` or `[0.7, 0.6, 0.5]`, `emission = "800lm"`, 15 or `[17, 12, 4]`. They replace textures.
    /// `removed = true` leaves the faces out: open windows, without the glass that would keep some of the light.
    #[arg(long, value_name = "FILE.toml")]
    materials: Option<PathBuf>,
}

/// An IES file, where it hangs, m, and how it is turned, degrees.
#[derive(Clone, Debug, PartialEq)]
struct Luminaire {
    file: PathBuf,
    position: DVec3,
    rotation: f64,
}

impl LightOptions {
    /// Whether lamps with a surface are added.
    pub(crate) fn adds_faces(&self) -> bool {
        !self.area_light.is_empty()
    }

    /// Whether lights without a surface are given in lumens, candela or lux; of surfaces, the scene knows.
    fn is_photometric(&self) -> bool {
        self.point_light.iter().any(|(_, is_photometric)| *is_photometric)
            || !self.ies.is_empty()
            || self.sun.is_some()
            || self.sky.is_some()
    }

    /// The files that are read.
    pub(super) fn files(&self) -> impl Iterator<Item = PathBuf> {
        let luminaires = self.ies.iter().map(|luminaire| &luminaire.file);
        luminaires.chain(&self.materials).cloned()
    }

    /// Adds to a scene what was asked for.
    pub(super) fn apply(&self, scene: &mut Scene) -> Result<(), Error> {
        if let Some(file) = &self.materials {
            scene.override_materials(file)?;
        }
        for (material, amount) in &self.emit {
            scene.emit(material, *amount)?;
        }
        self.area_light.iter().try_for_each(|lamp| scene.add_area_light(lamp))?;
        for Luminaire { file, position, rotation } in &self.ies {
            scene.add_luminaire(file, *position, *rotation)?;
        }
        let points = self.point_light.iter().map(|(light, _)| light);
        let lights = points.chain(&self.sun).chain(&self.sky);
        scene.lights.extend(lights.cloned().map(NamedLight::from));
        scene.photometric |= self.is_photometric();
        Ok(())
    }
}

/// `lamp*=800lm`.
fn emission(text: &str) -> Result<(String, Amount), String> {
    let (material, amount) = text.rsplit_once('=').ok_or("write MATERIAL=AMOUNT")?;
    Ok((material.to_owned(), amount.parse()?))
}

/// `2,2.4,3=1.2x0.3=3000lm=0,-1,0`.
fn area_light(text: &str) -> Result<AreaLight, String> {
    let parts: Vec<&str> = text.split('=').collect();
    let (&[centre, size, amount], rest) = parts
        .split_first_chunk()
        .ok_or("write X,Y,Z=WIDTHxDEPTH=AMOUNT, as in 2,2.4,3=1.2x0.3=3000lm")?;
    let side = |text: &str| number(text).ok().filter(|metres| *metres > 0.0);
    let sides = size.split_once('x').and_then(|(w, d)| Some([side(w)?, side(d)?]));
    let direction = match rest {
        [] => DVec3::NEG_Y,
        [direction] => vector(direction)?,
        _ => return Err("more than a position, a size, an amount and a direction".to_owned()),
    };
    if direction.try_normalize().is_none() {
        return Err("the direction has no length".to_owned());
    }
    Ok(AreaLight {
        centre: vector(centre)?,
        size: sides.ok_or("write the size as WIDTHxDEPTH in metres, as in 1.2x0.3")?,
        direction,
        amount: amount.parse()?,
    })
}

/// `1,2,1=800lm`, and whether it is in photometric units.
fn point_light(text: &str) -> Result<(Light, bool), String> {
    const WANTED: &str = "write X,Y,Z=800lm, X,Y,Z=60cd, or W/sr without a unit";
    let (position, amount) = text.split_once('=').ok_or(WANTED)?;
    let (amount, unit) = match (amount.strip_suffix("lm"), amount.strip_suffix("cd")) {
        (Some(lumens), _) => (lumens, 1.0 / (4.0 * PI * LUMENS_PER_WATT)),
        (_, Some(candela)) => (candela, 1.0 / LUMENS_PER_WATT),
        _ => (amount, 1.0),
    };
    let intensity = Rgb::splat(positive(amount.trim_end()).ok_or(WANTED)? * unit);
    Ok((Light::Point { position: vector(position)?, intensity }, unit != 1.0))
}

/// `lamp.ies@1,2,3,90`.
fn luminaire(text: &str) -> Result<Luminaire, String> {
    const WANTED: &str = "write FILE.ies@X,Y,Z or FILE.ies@X,Y,Z,DEGREES";
    let (file, place) = text.rsplit_once('@').ok_or(WANTED)?;
    let (x, y, z, rotation) = match *numbers(place).ok_or(WANTED)? {
        [x, y, z] => (x, y, z, 0.0),
        [x, y, z, rotation] => (x, y, z, rotation),
        _ => return Err(WANTED.to_owned()),
    };
    Ok(Luminaire { file: PathBuf::from(file), position: DVec3::new(x, y, z), rotation })
}

/// `135,45` or `135,45,90000`.
fn sun(text: &str) -> Result<Light, String> {
    const WANTED: &str = "write AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,LUX: degrees clockwise from north, \
                          above 0 to 90 degrees over the horizon, lux above 0";
    let (azimuth, elevation, lux) = match *numbers(text).ok_or(WANTED)? {
        [azimuth, elevation] => (azimuth, elevation, clear_sun(elevation)),
        [azimuth, elevation, lux] => (azimuth, elevation, lux),
        _ => return Err(WANTED.to_owned()),
    };
    let is_up = elevation > 0.0 && elevation <= 90.0 && (0.0..=BRIGHTEST).contains(&lux);
    if is_up && lux > 0.0 {
        Ok(Light::sun(azimuth, elevation, lux))
    } else {
        Err(WANTED.to_owned())
    }
}

/// `cie-overcast` or `uniform,5000`.
fn sky(text: &str) -> Result<Light, String> {
    const WANTED: &str =
        "write uniform or cie-overcast, or uniform,LUX with the lux on open ground above 0";
    let (kind, lux) = match text.split_once(',') {
        Some((kind, lux)) => (kind, positive(lux).filter(|lux| *lux > 0.0).ok_or(WANTED)?),
        None => (text, DESIGN_SKY),
    };
    let kind = match kind {
        "uniform" => Sky::Uniform,
        "cie-overcast" => Sky::Overcast,
        _ => return Err(WANTED.to_owned()),
    };
    Ok(Light::sky(kind, lux))
}

/// More of anything than this is a mistake.
const BRIGHTEST: f64 = 1e12;

fn positive(text: &str) -> Option<f64> {
    number(text).ok().filter(|x| (0.0..=BRIGHTEST).contains(x))
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',').map(|part| number(part.trim()).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lamps_shine_down_unless_told_otherwise() {
        let lamp = area_light("2,2.4,-3=1.2x0.3=3000lm").expect("it is right");
        assert_eq!((lamp.size, lamp.direction), ([1.2, 0.3], DVec3::NEG_Y));
        assert_eq!(lamp.amount, Amount::Flux(3000.0));
        assert_eq!(area_light("0,0,0=1x1=5=0,0,2").map(|lamp| lamp.direction), Ok(DVec3::Z * 2.0));
        for wrong in ["", "0,0,0", "0,0,0=1x1", "0,0,0=1=5", "0,0,0=1x0=5", "0,0,0=1x1=5=0,0,0"] {
            assert!(area_light(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn lumens_of_a_point_are_shared_by_all_directions() {
        let intensity = |text| match point_light(text) {
            Ok((Light::Point { intensity, .. }, _)) => intensity.x * LUMENS_PER_WATT,
            other => panic!("{other:?}"),
        };
        assert!((intensity("1,2,3=800lm") - 800.0 / (4.0 * PI)).abs() < 1e-9);
        assert!((intensity("1,2,3=60cd") - 60.0).abs() < 1e-9);
        assert!((intensity("1,2,3=2") - 2.0 * LUMENS_PER_WATT).abs() < 1e-9);
        assert!(point_light("1,2=60cd").is_err() && point_light("1,2,3=-60cd").is_err());
    }

    #[test]
    fn the_sun_is_up_and_the_sky_has_a_name() {
        assert!(sun("0,90").is_ok() && sun("-30,12.5,40000").is_ok());
        assert!(sun("0,0").is_err() && sun("0").is_err() && sun("0,45,nan").is_err());
        assert!(sky("uniform").is_ok() && sky("cie-overcast,5000").is_ok());
        assert!(sky("clear").is_err() && sky("uniform,-1").is_err() && sky("uniform,").is_err());
    }

    #[test]
    fn files_of_luminaires_may_have_an_at_sign_in_their_names() {
        let found = luminaire("a@b.ies@1,2,3,90").expect("it is right");
        assert_eq!((found.file, found.rotation), (PathBuf::from("a@b.ies"), 90.0));
        assert!(luminaire("a.ies").is_err() && luminaire("a.ies@1,2").is_err());
    }
}
