//! Things by their names, or by patterns of them.

use super::Scene;

/// Names that a message about an unknown one offers, at most.
const OFFERED: usize = 12;

impl Scene {
    /// The materials whose names are `pattern`, in which `*` stands for any text and `?` for any character.
    pub(super) fn materials_named(&self, pattern: &str) -> Result<Vec<usize>, String> {
        let names = self.materials.iter().map(|material| material.name.as_str());
        named("material", pattern, names)
    }
}

/// The numbers of the names that are `pattern`, or, if none is, of those that it describes; there must be some, or
/// the message says which `kind` of thing is missing, and what there is.
pub(crate) fn named<'n>(
    kind: &str,
    pattern: &str,
    names: impl Iterator<Item = &'n str> + Clone,
) -> Result<Vec<usize>, String> {
    let numbers = |is_meant: &dyn Fn(&str) -> bool| -> Vec<usize> {
        let meant = names.clone().enumerate().filter(|(_, name)| is_meant(name));
        meant.map(|(number, _)| number).collect()
    };
    // A name may itself have a star in it.
    let mut found = numbers(&|name| name == pattern);
    if found.is_empty() {
        found = numbers(&|name| matches(pattern, name));
    }
    if found.is_empty() { Err(unknown(kind, pattern, names)) } else { Ok(found) }
}

fn unknown<'n>(kind: &str, pattern: &str, names: impl Iterator<Item = &'n str>) -> String {
    let mut names: Vec<(usize, &str)> = names.map(|name| (distance(pattern, name), name)).collect();
    names.sort();
    names.dedup();
    let more = names.len().saturating_sub(OFFERED);
    let shown: Vec<String> =
        names.iter().take(OFFERED).map(|(_, name)| format!("\"{name}\"")).collect();
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("no {kind} \"{pattern}\"; there are {}{more}", shown.join(", "))
}

/// Whether a name is what a pattern describes.
pub(crate) fn matches(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) =
        (pattern.chars().collect(), name.chars().collect());
    let (mut p, mut n) = (0, 0);
    // Where the last star was, and where in the name what it stands for ends so far.
    let mut star: Option<(usize, usize)> = None;
    while n < name.len() {
        if pattern.get(p) == Some(&'*') {
            star = Some((p, n));
            p += 1;
        } else if pattern.get(p).is_some_and(|&c| c == '?' || c == name[n]) {
            (p, n) = (p + 1, n + 1);
        } else if let Some((at, end)) = star {
            star = Some((at, end + 1));
            (p, n) = (at + 1, end + 1);
        } else {
            return false;
        }
    }
    pattern[p..].iter().all(|&c| c == '*')
}

/// How many characters have to be changed, added or left out to make one name of another, whatever their
/// case (Levenshtein).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.to_lowercase().chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, c) in a.to_lowercase().chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, &d) in b.iter().enumerate() {
            let changed = diagonal + usize::from(c != d);
            diagonal = row[j + 1];
            row[j + 1] = changed.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;

    #[test]
    fn stars_stand_for_any_text() {
        for (pattern, name) in
            [("lamp*", "lamp"), ("*", ""), ("*a*b", "xaybab"), ("l?mp", "lämp"), ("a**", "a")]
        {
            assert!(matches(pattern, name), "{pattern} {name}");
        }
        for (pattern, name) in [("lamp*", "clamp"), ("?", ""), ("*a", "ab"), ("", "a"), ("a?", "a")]
        {
            assert!(!matches(pattern, name), "{pattern} {name}");
        }
    }

    #[test]
    fn an_unknown_name_is_answered_with_those_most_like_it() {
        let named = |name: String| Material { name, ..Material::default() };
        let mut materials: Vec<Material> = (0..30).map(|k| named(format!("wall {k}"))).collect();
        materials.push(named("Lamp".to_owned()));
        let scene = Scene { materials, ..Scene::default() };
        let message = scene.materials_named("lmap").unwrap_err();
        assert!(message.contains("there are \"Lamp\", \"wall 0\""), "{message}");
        assert!(message.ends_with("and 19 more"), "{message}");
        assert_eq!(scene.materials_named("wall 1*").unwrap().len(), 11);
    }
}
