//! Linear RGB; sRGB only where pictures and textures are read or written.

use glam::DVec3;

/// A quantity per channel, linear RGB with the primaries of Rec. 709.
pub type Rgb = DVec3;

/// Luminous power of one watt, lm/W, by which photometric and radiometric units are exchanged.
///
/// The value that glTF exporters use for `KHR_lights_punctual`, so that lights from such files keep
/// their lux.
pub const LUMENS_PER_WATT: f64 = 683.0;

/// Mean magnitude of the channels.
pub fn strength(colour: Rgb) -> f64 {
    colour.abs().element_sum() / 3.0
}

/// Relative luminance of a linear colour, in the colour's unit ([Rec. 709] weights).
///
/// [Rec. 709]: https://www.itu.int/rec/R-REC-BT.709
pub fn luminance(colour: Rgb) -> f64 {
    colour.dot(Rgb::new(0.2126, 0.7152, 0.0722))
}

/// The linear value, 0..=1, of an sRGB-coded one, 0..=1 (IEC 61966-2-1).
pub fn linear_from_srgb(coded: f64) -> f64 {
    if coded <= 0.04045 { coded / 12.92 } else { ((coded + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB-coded value, 0..=1, of a linear one, which is clamped to 0..=1 (IEC 61966-2-1).
pub fn srgb_from_linear(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_coding_is_undone_by_decoding() {
        for step in 0..=255 {
            let coded = f64::from(step) / 255.0;
            assert!((srgb_from_linear(linear_from_srgb(coded)) - coded).abs() < 1e-6, "{coded}");
        }
    }

    #[test]
    fn white_has_luminance_one() {
        assert!((luminance(Rgb::ONE) - 1.0).abs() < 1e-12);
    }
}
