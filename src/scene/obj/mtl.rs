//! Reading of MTL files: every wrong line costs its own value and a note, never the file.

use std::path::Path;

use glam::DVec2;

use crate::colour::Rgb;
use crate::scene::text::{keyword, lines, name, numbers};
use crate::scene::{Sampler, Wrap};

/// What an MTL file says about a material.
#[derive(Debug, Default)]
pub(super) struct MtlMaterial {
    pub(super) name: String,
    /// Reflectance `Kd`.
    pub(super) reflectance: Option<Rgb>,
    /// Emitted radiance `Ke`, W/(m² sr).
    pub(super) emission: Option<Rgb>,
    /// `map_Kd`.
    pub(super) reflectance_map: Option<TextureMap>,
    /// `map_Ke`.
    pub(super) emission_map: Option<TextureMap>,
    /// `map_d`.
    pub(super) opacity_map: Option<TextureMap>,
    /// True if `d` or, without it, `Tr` says that light comes through.
    pub(super) transparent: bool,
    /// True if `d` has been read.
    has_opacity: bool,
}

/// A picture as a `map_` line names it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TextureMap {
    pub(super) file: String,
    pub(super) scale: DVec2,
    pub(super) offset: DVec2,
    pub(super) clamp: bool,
}

impl TextureMap {
    /// How the picture is read.
    pub(super) fn sampler(&self) -> Sampler {
        let wrap = if self.clamp { Wrap::Clamp } else { Wrap::Repeat };
        Sampler { wrap: [wrap; 2], nearest: false }
    }
}

/// Reads `text`, the content of `path`; what is wrong goes to `notes` with file and line.
pub(super) fn parse(path: &Path, text: &str, notes: &mut Vec<String>) -> Vec<MtlMaterial> {
    let mut materials: Vec<MtlMaterial> = Vec::new();
    for (number, line) in lines(text) {
        let (word, rest) = keyword(&line);
        if word.eq_ignore_ascii_case("newmtl") {
            materials.push(MtlMaterial { name: name(rest).to_owned(), ..MtlMaterial::default() });
            continue;
        }
        let Some(material) = materials.last_mut() else { continue };
        if let Err(why) = set(material, word, rest) {
            notes.push(format!("{}:{number}: {word}: {why}; ignored", path.display()));
        }
    }
    materials
}

/// Opacities above this are 1.
const OPAQUE: f64 = 0.99;

fn set(material: &mut MtlMaterial, word: &str, rest: &str) -> Result<(), String> {
    match word.to_ascii_lowercase().as_str() {
        "kd" => material.reflectance = Some(colour(rest)?),
        "ke" => material.emission = Some(colour(rest)?),
        "map_kd" => material.reflectance_map = Some(map(rest)?),
        "d" => {
            let opacity = numbers(rest.trim_start_matches("-halo"));
            material.transparent = opacity.is_ok_and(|x| x.first().is_some_and(|&d| d < OPAQUE));
            material.has_opacity = true;
        }
        // Some exporters mean `d` by it, so 1 may be either.
        "tr" if !material.has_opacity => {
            let clear = numbers(rest).ok().and_then(|x| x.first().copied()).unwrap_or(0.0);
            material.transparent = clear > 1.0 - OPAQUE && clear < OPAQUE;
        }
        "map_ke" => material.emission_map = Some(map(rest)?),
        "map_d" => material.opacity_map = Some(map(rest)?),
        _ => {}
    }
    Ok(())
}

fn colour(rest: &str) -> Result<Rgb, String> {
    let (first, _) = keyword(rest);
    if ["spectral", "xyz"].iter().any(|other| first.eq_ignore_ascii_case(other)) {
        return Err(format!("\"{first}\" colours are not read, only RGB"));
    }
    let values = numbers(rest).map_err(|word| format!("\"{word}\" is not a finite number"))?;
    match values[..] {
        [grey] => Ok(Rgb::splat(grey)),
        [red, green, blue, ..] => Ok(Rgb::new(red, green, blue)),
        _ => Err(format!("a colour has 1 or 3 numbers, not {}", values.len())),
    }
}

/// Reads `[-option values]... file name with spaces`.
fn map(rest: &str) -> Result<TextureMap, String> {
    let mut map =
        TextureMap { file: String::new(), scale: DVec2::ONE, offset: DVec2::ZERO, clamp: false };
    let mut rest = rest;
    while let Some(option) = rest.strip_prefix('-') {
        let (name, values) = keyword(option);
        rest = match name.to_ascii_lowercase().as_str() {
            "s" => vector(values, &mut map.scale),
            "o" => vector(values, &mut map.offset),
            "t" => vector(values, &mut DVec2::default()),
            "mm" => keyword(keyword(values).1).1,
            "clamp" => {
                let (state, after) = keyword(values);
                map.clamp = state.eq_ignore_ascii_case("on");
                after
            }
            "blendu" | "blendv" | "cc" | "texres" | "bm" | "boost" | "imfchan" | "type"
            | "colorspace" => keyword(values).1,
            _ => break,
        };
    }
    map.file = rest.trim_matches('"').to_owned();
    if map.file.is_empty() { Err("names no file".to_owned()) } else { Ok(map) }
}

/// Takes one to three numbers off `values`, keeps the first two in `target`, returns what follows.
fn vector<'a>(values: &'a str, target: &mut DVec2) -> &'a str {
    let mut rest = values;
    for axis in 0..3 {
        let (word, after) = keyword(rest);
        // A file may be named like a number, but something has to be left for the name.
        let Some(value) = word.parse().ok().filter(|x: &f64| x.is_finite() && !after.is_empty())
        else {
            break;
        };
        if axis < 2 {
            target[axis] = value;
        }
        rest = after;
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> (Vec<MtlMaterial>, Vec<String>) {
        let mut notes = Vec::new();
        let materials = parse(Path::new("m.mtl"), text, &mut notes);
        (materials, notes)
    }

    #[test]
    fn one_number_is_grey() {
        let (materials, notes) = parsed("newmtl a b\n\tKd 0.25\n Ke 1 2 3\nillum 2\nTr 0.5");
        assert_eq!(materials[0].name, "a b");
        assert_eq!(materials[0].reflectance, Some(Rgb::splat(0.25)));
        assert_eq!(materials[0].emission, Some(Rgb::new(1., 2., 3.)));
        assert!(notes.is_empty());
    }

    #[test]
    fn bad_colours_cost_a_note_with_file_and_line_and_nothing_else() {
        for line in
            ["Kd", "Kd 0.5 0.6", "Kd red", "Kd nan 0 0", "Kd spectral f.rfl", "Kd xyz 1 1 1"]
        {
            let (materials, notes) = parsed(&format!("newmtl a\n{line}\nKe 2"));
            assert_eq!(materials[0].reflectance, None, "{line}");
            assert_eq!(materials[0].emission, Some(Rgb::splat(2.0)));
            assert!(notes[0].starts_with("m.mtl:2: Kd: "), "{notes:?}");
        }
    }

    #[test]
    fn map_options_are_read_or_skipped() {
        let line = "-blendu on -mm 0 1 -s 2 3 1 -o 0.5 -clamp on my wood 1.png";
        let expected = TextureMap {
            file: "my wood 1.png".to_owned(),
            scale: DVec2::new(2., 3.),
            offset: DVec2::new(0.5, 0.),
            clamp: true,
        };
        assert_eq!(map(line), Ok(expected));
        assert_eq!(map("-s 2 2 7.png").unwrap().file, "7.png");
        assert!(map("-clamp on").is_err());
    }
}
