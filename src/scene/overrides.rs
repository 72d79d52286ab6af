//! What a TOML file says about materials, in place of what the scene says.

use std::collections::BTreeMap;
use std::path::Path;

use toml::{Spanned, Value};

use super::adding::Amount;
use super::limits::limit_materials;
use super::notes::{counted, listed};
use super::{Material, Scene};
use crate::colour::Rgb;
use crate::error::{Error, Result};

/// By name or pattern, what is to be changed.
type Tables = BTreeMap<Spanned<String>, BTreeMap<Spanned<String>, Value>>;

/// A message and the byte of the file that it is about.
type OverrideError = (usize, String);

impl Scene {
    /// Changes materials as a TOML file says: a table for each name, or pattern with `*` and `?`, with
    /// `reflectance` (0 to 1, or three such numbers), `emission` (W/(m² sr), or three such numbers, or
    /// `"800lm"` of all faces that the table is about), `double_sided`, and `removed`: its faces are left out, as
    /// a window is open, without what glass would keep.
    ///
    /// A reflectance or an emission replaces its texture. Of tables about the same material, later ones win.
    ///
    /// # Errors
    /// When the file cannot be read or says anything else; the message has the line.
    pub fn override_materials(&mut self, path: &Path) -> Result<()> {
        let text = std::fs::read_to_string(path).map_err(Error::io(path))?;
        self.files.push(path.to_owned());
        self.override_by(&text).map_err(|(start, message)| {
            let line = 1 + text.bytes().take(start).filter(|&byte| byte == b'\n').count();
            Error::at_line(path, line, message)
        })
    }

    fn override_by(&mut self, text: &str) -> std::result::Result<(), OverrideError> {
        let parsed: std::result::Result<Tables, _> = toml::from_str(text);
        let tables = parsed.map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            (start, error.message().to_owned())
        })?;
        let mut tables: Vec<_> = tables.into_iter().collect();
        tables.sort_by_key(|(name, _)| name.span().start);
        for (name, table) in tables {
            let named = self.materials_named(name.get_ref());
            let named = named.map_err(|message| (name.span().start, message))?;
            for (key, value) in order(table) {
                let changed = self.change(&named, key.get_ref(), &value);
                changed.map_err(|message| (key.span().start, message))?;
            }
        }
        limit_materials(self);
        Ok(())
    }

    /// Changes one thing about some materials.
    fn change(
        &mut self,
        named: &[usize],
        key: &str,
        value: &Value,
    ) -> std::result::Result<(), String> {
        let mut each = |change: &dyn Fn(&mut Material)| {
            named.iter().for_each(|&number| change(&mut self.materials[number]));
        };
        match (key, value) {
            ("reflectance", value) => {
                let colour = colour(value).filter(|colour| colour.max_element() <= 1.0);
                let colour = colour.ok_or("reflectance: write 0 to 1, or three such numbers")?;
                each(&|material| (material.reflectance, material.texture) = (colour, None));
            }
            ("emission", value) => {
                let amount = amount(value).ok_or(
                    "emission: write a radiance in W/(m² sr), three of them, or \"800lm\"",
                )?;
                self.emit_from(named, amount)?;
            }
            ("double_sided", &Value::Boolean(both)) => {
                each(&|material| material.double_sided = both);
            }
            ("removed", &Value::Boolean(true)) => self.remove(named)?,
            ("removed", &Value::Boolean(false)) => (),
            ("removed", _) => return Err("removed: write true or false".to_owned()),
            ("double_sided", _) => return Err("double_sided: write true or false".to_owned()),
            _ => {
                let known = "use reflectance, emission, double_sided or removed";
                return Err(format!("unknown key \"{key}\"; {known}"));
            }
        }
        Ok(())
    }

    /// Leaves out the faces of some materials.
    fn remove(&mut self, named: &[usize]) -> std::result::Result<(), String> {
        let names: Vec<String> =
            named.iter().map(|&number| self.materials[number].name.clone()).collect();
        let count = counted(self.leave_out(named), "face");
        self.notes.push(format!("{count} of {} removed: open, not even glass", listed(&names)));
        if self.faces.is_empty() { Err("removed: no face is left".to_owned()) } else { Ok(()) }
    }
}

/// Faces and sides before lumens: how many there are decides what radiance makes a flux.
fn order(table: BTreeMap<Spanned<String>, Value>) -> Vec<(Spanned<String>, Value)> {
    let mut entries: Vec<_> = table.into_iter().collect();
    entries.sort_by_key(|(key, _)| (key.get_ref() == "emission", key.span().start));
    entries
}

fn amount(value: &Value) -> Option<Amount> {
    match value {
        Value::String(text) => text.parse().ok(),
        value => colour(value).map(Amount::Radiance),
    }
}

/// A number for all channels, or one for each; none below zero.
fn colour(value: &Value) -> Option<Rgb> {
    let number = |value: &Value| {
        let number = match *value {
            Value::Integer(number) => number as f64,
            Value::Float(number) => number,
            _ => return None,
        };
        (number.is_finite() && number >= 0.0).then_some(number)
    };
    match value {
        Value::Array(channels) => match channels.as_slice() {
            [r, g, b] => Some(Rgb::new(number(r)?, number(g)?, number(b)?)),
            _ => None,
        },
        value => number(value).map(Rgb::splat),
    }
}
