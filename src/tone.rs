//! From radiosity to what a screen can show: exposure, then a tone curve.
//!
//! Exposure is that of the whole mesh, moved as far as a camera needs that sees a much brighter or darker part of it;
//! an exported mesh and its pictures agree by one [`Exposure`].

use std::f64::consts::PI;

use crate::colour::{LUMENS_PER_WATT, Rgb, luminance};
use crate::reconstruct::TriMesh;

/// Exposed luminance that [`Exposure::Automatic`] gives to the mesh's log-average.
///
/// 0.18 as in photography makes rooms look like evening, 0.4 washes out the wall beside a lamp.
const KEY: f64 = 0.22;

/// Share of the mean luminance below which a surface counts as unlit and is left out of the average.
pub(crate) const UNLIT: f64 = 1e-3;

/// How far, EV, a view's exposure may be from what it alone asks for.
const LEEWAY: f64 = 2.0 / 3.0;

/// Largest magnitude of an exposure value; beyond it factors would leave the range of numbers.
const EV_LIMIT: f64 = 200.0;

/// Exposed radiosity up to which [`tone_map`] changes nothing.
const SHOULDER: f64 = 0.4;

/// How fast colours brighter than a screen fade to white.
const DESATURATION: f64 = 0.15;

/// Exposed radiosity beyond which no difference is seen.
const BRIGHTEST: f64 = 1e9;

/// How much light the film gets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Exposure {
    /// Brings the log-average luminance of the mesh to a middle grey.
    #[default]
    Automatic,
    /// The photographer's exposure value at ISO 100; one more halves the brightness.
    Ev(f64),
    /// An exposure value that was found for a camera, by what it sees; a file says of it what it says of
    /// `Automatic`, so that other cameras find their own.
    Found(f64),
}

/// Factor on radiosity, m²/W, that comes before [`tone_map`].
///
/// `Ev(v)`: 683/π / (1.2 · 2^v), so that a luminance of 1.2 · 2^v cd/m² becomes 1, after
/// [Lagarde and de Rousiers 2014], section 5.1.2.
///
/// `Automatic`: 0.22 / exp(Σ A ln Y / Σ A) over the triangles' areas A and mean luminances Y, the
/// log-average of [Reinhard et al. 2002]. Triangles darker than a thousandth of the mean are left
/// out; a lamp of a hundredth of the area weighs a hundredth, however bright it is. A mesh
/// without light gets 1.
///
/// [Lagarde and de Rousiers 2014]: https://seblagarde.wordpress.com/2015/07/14/siggraph-2014-moving-frostbite-to-physically-based-rendering/
/// [Reinhard et al. 2002]: https://doi.org/10.1145/566654.566575
pub fn exposure_scale(mesh: &TriMesh, exposure: Exposure) -> f64 {
    match exposure {
        Exposure::Ev(ev) | Exposure::Found(ev) => scale_of_ev(ev),
        Exposure::Automatic => match log_average_luminance(mesh) {
            Some(average) => (KEY / average).clamp(scale_of_ev(EV_LIMIT), scale_of_ev(-EV_LIMIT)),
            None => 1.0,
        },
    }
}

/// The exposure of `mesh` for a camera that sees a log-average luminance of radiosity of `seen`, W/m², or nothing lit.
///
/// [`Exposure::Automatic`], moved by as little as it takes for what is seen to be within 2/3 EV of middle grey:
/// views of one evenly lit room keep one exposure, and what no camera sees cannot darken a picture.
pub(crate) fn exposure_of_view(mesh: &TriMesh, seen: Option<f64>) -> Exposure {
    let whole = exposure_value(exposure_scale(mesh, Exposure::Automatic));
    let wanted = |luminance: f64| exposure_value(KEY / luminance);
    let ev = seen.map(wanted).filter(|ev| ev.is_finite());
    Exposure::Found(ev.map_or(whole, |ev| whole.clamp(ev - LEEWAY, ev + LEEWAY)))
}

/// The exposure value, EV at ISO 100, whose [`exposure_scale`] is `scale`, a positive number.
pub fn exposure_value(scale: f64) -> f64 {
    (scale_of_ev(0.0) / scale).log2().clamp(-EV_LIMIT, EV_LIMIT)
}

fn scale_of_ev(ev: f64) -> f64 {
    LUMENS_PER_WATT / PI / (1.2 * ev.clamp(-EV_LIMIT, EV_LIMIT).exp2())
}

/// Area-weighted log-average of the luminance of radiosity, W/m², over the lit triangles.
pub(crate) fn log_average_luminance(mesh: &TriMesh) -> Option<f64> {
    let samples: Vec<(f64, f64)> =
        mesh.triangles.iter().map(|corners| sample(mesh, corners)).collect();
    let area: f64 = samples.iter().map(|(area, _)| area).sum();
    let power: f64 = samples.iter().map(|(area, value)| area * value).sum();
    let threshold = UNLIT * power / area;

    let mut lit_area = 0.0;
    let mut logarithms = 0.0;
    for (area, value) in samples {
        if value > threshold {
            lit_area += area;
            logarithms += area * value.ln();
        }
    }
    (lit_area > 0.0).then(|| (logarithms / lit_area).exp())
}

/// Area, m², and mean luminance of radiosity, W/m², of a triangle.
fn sample(mesh: &TriMesh, corners: &[u32; 3]) -> (f64, f64) {
    let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
    let [x, y, z] = corners.map(|corner| mesh.radiosity[corner as usize]);
    ((b - a).cross(c - a).length() / 2.0, luminance(x + y + z) / 3.0)
}

/// Linear colour on a screen, 0..=1 per channel, of an exposed radiosity (linear, 0 and up).
///
/// With m the largest channel and s = 0.4: unchanged up to m = s; above, the colour is scaled so
/// that its largest channel becomes m' = 1 − (1 − s)² / (m + 1 − 2s), then mixed with white of
/// value m' by 1 − 1 / (0.15 (m − m') + 1). This is the [Khronos PBR Neutral] tone mapper without
/// its correction for Fresnel reflection, which diffuse surfaces lack, and with a longer shoulder.
/// Smooth; more exposure never darkens a channel; hue is kept exactly.
///
/// [Khronos PBR Neutral]: https://github.com/KhronosGroup/ToneMapping/tree/main/PBR_Neutral
pub fn tone_map(exposed_radiosity: Rgb) -> Rgb {
    let lit = Rgb::from_array(exposed_radiosity.to_array().map(|channel| channel.max(0.0)));
    let colour = lit.min(Rgb::splat(BRIGHTEST));
    let peak = colour.max_element();
    if peak <= SHOULDER {
        return colour;
    }
    let range = 1.0 - SHOULDER;
    let mapped = 1.0 - range * range / (peak + range - SHOULDER);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - mapped) + 1.0);
    (colour * (mapped / peak)).lerp(Rgb::splat(mapped), white).clamp(Rgb::ZERO, Rgb::ONE)
}

/// Linear colour on a screen, 0..=1 per channel, of what a picture on a surface sends, `exposed`, where a texel as
/// bright as its brightest channel in all channels would send `white`; both linear, 0 and up.
///
/// The white is [tone mapped](tone_map), and what is sent keeps its ratio to it: so a colour at each vertex times the
/// picture is what is seen, in all programs that multiply them. A picture of one grey looks like a plain surface.
pub fn tone_map_picture(exposed: Rgb, white: Rgb) -> Rgb {
    let share = Rgb::select(white.cmpgt(Rgb::ZERO), exposed / white, Rgb::ONE);
    (tone_map(white) * share).clamp(Rgb::ZERO, Rgb::ONE)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;

    /// Squares side by side, each given by its side, m, and its radiosity, W/m².
    fn squares(squares: &[(f64, f64)]) -> TriMesh {
        let mut mesh = TriMesh::default();
        for &(side, value) in squares {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(
                [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
                    .map(|(x, y)| DVec3::new(x, y, 0.0)),
            );
            mesh.radiosity.extend([Rgb::splat(value); 4]);
            mesh.triangles.push([first, first + 1, first + 2]);
            mesh.triangles.push([first, first + 2, first + 3]);
        }
        mesh
    }

    #[test]
    fn one_ev_more_halves_the_exposure() {
        let mesh = TriMesh::default();
        let at = |ev| exposure_scale(&mesh, Exposure::Ev(ev));
        assert!((at(7.0) / at(8.0) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn ev_exposes_its_saturation_luminance_to_one() {
        let luminance = 1.2 * 10.0_f64.exp2();
        let radiosity = luminance * PI / LUMENS_PER_WATT;
        let scale = exposure_scale(&TriMesh::default(), Exposure::Ev(10.0));
        assert!((radiosity * scale - 1.0).abs() < 1e-12);
        assert!((exposure_value(scale) - 10.0).abs() < 1e-12);
    }

    #[test]
    fn automatic_exposure_does_not_depend_on_the_unit_of_light() {
        let dim = squares(&[(1.0, 0.1), (2.0, 0.3)]);
        let bright = squares(&[(1.0, 10.0), (2.0, 30.0)]);
        let [dim, bright] = [dim, bright].map(|mesh| exposure_scale(&mesh, Exposure::Automatic));
        assert!((dim / bright - 100.0).abs() < 1e-9);
    }

    #[test]
    fn a_small_lamp_and_unlit_walls_leave_automatic_exposure_alone() {
        let wall = exposure_scale(&squares(&[(1.0, 2.0)]), Exposure::Automatic);
        let room = squares(&[(1.0, 2.0), (0.1, 200.0), (1.0, 0.0)]);
        let ratio = exposure_scale(&room, Exposure::Automatic) / wall;
        assert!((0.95..=1.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn darkness_and_nothing_at_all_have_a_finite_exposure() {
        assert_eq!(exposure_scale(&squares(&[(1.0, 0.0)]), Exposure::Automatic), 1.0);
        assert_eq!(exposure_scale(&TriMesh::default(), Exposure::Automatic), 1.0);
        let faint = exposure_scale(&squares(&[(1.0, 1e-300)]), Exposure::Automatic);
        assert!(faint.is_finite());
    }

    #[test]
    fn numbers_beyond_all_light_are_shown_all_the_same() {
        for value in [f64::NAN, f64::INFINITY, -1.0, f64::MAX] {
            let shown = tone_map(Rgb::new(value, 0.5, 0.0));
            assert!(shown.min_element() >= 0.0 && shown.max_element() <= 1.0, "{value}: {shown}");
        }
    }

    proptest! {
        #[test]
        fn more_exposure_never_darkens(
            colour in prop::array::uniform3(0.0..1e4_f64),
            factor in 1.0..100.0_f64,
        ) {
            let colour = Rgb::from_array(colour);
            let (less, more) = (tone_map(colour), tone_map(colour * factor));
            prop_assert!((more - less).min_element() >= -1e-12, "{} {}", less, more);
            prop_assert!(more.min_element() >= 0.0 && more.max_element() <= 1.0);
        }

        #[test]
        fn darks_are_not_changed(colour in prop::array::uniform3(0.0..SHOULDER)) {
            prop_assert_eq!(tone_map(Rgb::from_array(colour)), Rgb::from_array(colour));
        }

        #[test]
        fn a_picture_of_one_grey_looks_like_a_plain_surface_and_darker_texels_keep_their_ratio(
            light in prop::array::uniform3(0.0..10.0_f64),
            white in 0.01..1.0_f64,
            texel in prop::array::uniform3(0.0..1.0_f64),
        ) {
            let (light, texel) = (Rgb::from_array(light), Rgb::from_array(texel));
            let plain = tone_map(light * white);
            prop_assert!(tone_map_picture(light * white, light * white).abs_diff_eq(plain, 1e-12));
            let shown = tone_map_picture(light * white * texel, light * white);
            prop_assert!(shown.abs_diff_eq(plain * texel, 1e-9), "{} {}", shown, plain * texel);
        }

        #[test]
        fn channels_keep_their_order(colour in prop::array::uniform3(0.0..1e3_f64)) {
            let shown = tone_map(Rgb::from_array(colour)).to_array();
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                prop_assert!(colour[i] < colour[j] || shown[i] >= shown[j]);
            }
        }

        #[test]
        fn the_curve_has_no_kink(peak in 0.0..3.0_f64) {
            let grey = |value| tone_map(Rgb::splat(value)).x;
            let step = 1e-3;
            let (before, after) = (grey(peak + step) - grey(peak), grey(peak + 2.0 * step) - grey(peak + step));
            prop_assert!((before - after).abs() < 1e-2 * step);
        }
    }
}
