//! How the values of options are written.

use std::time::Duration;

use glam::DVec3;
use radiosity::tone::Exposure;

/// Most pixels along a side of a picture.
const MOST_PIXELS: u32 = 16_384;

/// Pixels of a picture, across and down.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

/// `960x720`.
pub(crate) fn size(text: &str) -> Result<Size, String> {
    let pixels = |text: &str| text.parse().ok().filter(|count| (1..=MOST_PIXELS).contains(count));
    let parts = text.split_once(['x', 'X']);
    let size = parts.and_then(|(width, height)| Some((pixels(width)?, pixels(height)?)));
    let (width, height) =
        size.ok_or_else(|| format!("write WIDTHxHEIGHT, each 1 to {MOST_PIXELS} pixels"))?;
    Ok(Size { width, height })
}

/// `1.5,-2,0`.
pub(crate) fn vector(text: &str) -> Result<DVec3, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| number(part.trim()).ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err("write three numbers x,y,z in metres, without spaces".to_owned()),
    }
}

/// A point and a direction, `0,0,0,0,1,0`; the direction is made a unit vector.
pub(crate) fn place(text: &str) -> Result<(DVec3, DVec3), String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| number(part.trim()).ok()).collect();
    let Some(&[x, y, z, nx, ny, nz]) = numbers.as_deref() else {
        return Err("write six numbers: a point x,y,z in metres and a normal x,y,z".to_owned());
    };
    let normal = DVec3::new(nx, ny, nz).try_normalize();
    let normal = normal.ok_or("the normal, the last three numbers, has no direction")?;
    Ok((DVec3::new(x, y, z), normal))
}

/// `0.001` or `0.1%`.
pub(crate) fn share(text: &str) -> Result<f64, String> {
    match text.strip_suffix('%') {
        Some(percent) => Ok(number(percent.trim_end())? / 100.0),
        None => number(text),
    }
}

/// `90`, `90s`, `2min` or `1h`.
pub(crate) fn duration(text: &str) -> Result<Duration, String> {
    let units = [("min", 60.0), ("h", 3600.0), ("s", 1.0)];
    let found = units.iter().find_map(|(name, unit)| Some((text.strip_suffix(name)?, *unit)));
    let (amount, unit) = found.unwrap_or((text, 1.0));
    let seconds = number(amount.trim_end()).ok().map(|amount| amount * unit);
    seconds
        .filter(|seconds| *seconds > 0.0)
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "write a time above zero such as 90s or 2min".to_owned())
}

/// `500MB`, `4GB` or bytes.
pub(crate) fn memory(text: &str) -> Result<u64, String> {
    let units = [("kB", 1e3), ("MB", 1e6), ("GB", 1e9), ("B", 1.0)];
    let found = units.iter().find_map(|(name, unit)| Some((text.strip_suffix(name)?, *unit)));
    let (amount, unit) = found.unwrap_or((text, 1.0));
    let bytes = number(amount.trim_end()).ok().map(|amount| amount * unit);
    let sound = bytes.filter(|bytes| (1.0..1e18).contains(bytes));
    sound.map(|bytes| bytes as u64).ok_or_else(|| "write a size such as 500MB or 4GB".to_owned())
}

/// A unit's name, or metres per unit.
pub(crate) fn units(text: &str) -> Result<f64, String> {
    match text {
        "m" => Ok(1.0),
        "cm" => Ok(0.01),
        "mm" => Ok(0.001),
        "in" => Ok(0.0254),
        "ft" => Ok(0.3048),
        _ => number(text)
            .ok()
            .filter(|&factor| factor > 0.0)
            .ok_or_else(|| "write m, cm, mm, in, ft, or how many metres a unit has".to_owned()),
    }
}

/// `auto` or an exposure value.
pub(crate) fn exposure(text: &str) -> Result<Exposure, String> {
    match text {
        "auto" => Ok(Exposure::Automatic),
        _ => number(text)
            .map(Exposure::Ev)
            .map_err(|_| "write auto, or an exposure value such as 7.5".to_owned()),
    }
}

/// An angle of view, degrees.
pub(crate) fn angle(text: &str) -> Result<f64, String> {
    let angle = number(text)?;
    if (1.0..=170.0).contains(&angle) {
        return Ok(angle);
    }
    Err("an angle of view has 1 to 170 degrees".to_owned())
}

/// A finite number.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| "not a number".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_may_be_written_in_per_cent() {
        assert_eq!(share("0.25"), Ok(0.25));
        assert_eq!(share("25%"), Ok(0.25));
        assert!(share("a%").is_err());
    }

    #[test]
    fn times_have_units() {
        assert_eq!(duration("2min"), Ok(Duration::from_secs(120)));
        assert_eq!(duration("1.5 s"), duration("1.5"));
        assert_eq!(duration("1h"), duration("3600s"));
        assert!(duration("0s").is_err() && duration("-1").is_err() && duration("1e300h").is_err());
    }

    #[test]
    fn vectors_may_be_negative_and_must_have_three_numbers() {
        assert_eq!(vector("-1,2.5,3e-1"), Ok(DVec3::new(-1.0, 2.5, 0.3)));
        assert!(vector("1,2").is_err() && vector("1,2,3,4").is_err() && vector("1,2,inf").is_err());
    }

    #[test]
    fn a_place_has_a_normal_of_length_one() {
        assert_eq!(place("1,2,3,0,0,-4"), Ok((DVec3::new(1.0, 2.0, 3.0), DVec3::NEG_Z)));
        assert!(place("1,2,3").is_err() && place("1,2,3,0,0,0").is_err());
    }

    #[test]
    fn units_are_named_or_counted() {
        assert_eq!(units("ft"), Ok(0.3048));
        assert_eq!(units("2.5"), Ok(2.5));
        assert!(units("0").is_err() && units("-1").is_err() && units("yard").is_err());
    }

    #[test]
    fn sizes_have_two_sides_of_bearable_length() {
        assert!(size("960x720").is_ok_and(|size| (size.width, size.height) == (960, 720)));
        assert!(size("960").is_err() && size("0x10").is_err() && size("99999x1").is_err());
    }
}
