//! The house itself: data flows one way, files are small and say what they are for.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The library's modules in flow order; those in one entry do not use each other.
const FLOW: [&[&str]; 23] = [
    &["colour"],
    &["error"],
    &["file"],
    &["ids"],
    &["settings"],
    &["watch"],
    &["geometry"],
    &["scene"],
    &["surface"],
    &["mesh"],
    &["light"],
    &["visibility"],
    &["form_factor"],
    &["direct"],
    &["refine"],
    &["solver"],
    &["reconstruct"],
    &["lightmap"],
    &["tone"],
    &["export", "render"],
    &["page"],
    &["compare"],
    &["guide"],
];

/// Longest file, lines.
const LONGEST: usize = 400;

/// Words that mark unfinished work.
const UNFINISHED: [&str; 3] = ["todo!", "dbg!", "unimplemented!"];

fn sources() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut open = vec![root.clone()];
    let mut found = Vec::new();
    while let Some(directory) = open.pop() {
        for entry in fs::read_dir(directory).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                found.push((path.strip_prefix(&root).unwrap().to_owned(), text));
            }
        }
    }
    assert!(found.len() > 40, "only {} source files", found.len());
    found
}

/// The module that a file belongs to, as a name after `crate::`.
fn module(path: &Path) -> String {
    let first = path.iter().next().unwrap().to_string_lossy();
    first.trim_end_matches(".rs").to_owned()
}

fn rank(module: &str) -> Option<usize> {
    FLOW.iter().position(|stage| stage.contains(&module))
}

/// Names that follow `crate::` in a text, those in braces included.
fn uses(text: &str) -> Vec<String> {
    let name = |part: &str| -> String {
        part.trim_start().chars().take_while(|&c| c.is_alphanumeric() || c == '_').collect()
    };
    text.split("crate::")
        .skip(1)
        .flat_map(|rest| match rest.strip_prefix('{') {
            Some(list) => top_level(list).iter().map(|part| name(part)).collect(),
            None => vec![name(rest)],
        })
        .filter(|name| !name.is_empty())
        .collect()
}

/// The parts of a list that ends at its unmatched closing brace.
fn top_level(list: &str) -> Vec<&str> {
    let (mut depth, mut start, mut parts) = (0, 0, Vec::new());
    for (at, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => {
                parts.push(&list[start..at]);
                break;
            }
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&list[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts
}

#[test]
fn names_of_modules_are_found_in_every_kind_of_use() {
    let text = "use crate::mesh::{self, Mesh}; let x = crate::tone::map(); use crate::{colour::{Rgb, a}, scene};";
    assert_eq!(uses(text), ["mesh", "tone", "colour", "scene"]);
}

#[test]
fn a_module_uses_only_those_to_its_left() {
    for (path, text) in sources() {
        let own = module(&path);
        let Some(here) = rank(&own) else {
            let outside = ["lib", "main", "cli"].contains(&own.as_str());
            assert!(outside, "{} is no stage of the flow", path.display());
            continue;
        };
        for used in uses(&text) {
            let there = rank(&used);
            let allowed = used == own || there.is_some_and(|there| there < here);
            assert!(allowed, "{} uses crate::{used}", path.display());
        }
    }
}

/// The paths that a text names in its `use` declarations, braces opened.
fn used_paths(text: &str) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    for line in text.split('\n').enumerate().filter_map(|(k, line)| is_use(line).then_some(k)) {
        let rest: String = text.lines().skip(line).collect::<Vec<_>>().join(" ");
        let (_, path) = rest.split_once("use ").unwrap();
        let (path, _) = path.split_once(';').unwrap_or((path, ""));
        open_braces(&[], path, &mut paths);
    }
    paths
}

fn is_use(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with("use ") || line.starts_with("pub(") && line.contains(") use ")
}

fn open_braces(before: &[String], path: &str, paths: &mut Vec<Vec<String>>) {
    let (head, list) = path.split_once('{').map_or((path, None), |(head, list)| (head, Some(list)));
    let names = head.split("::").map(|name| name.split(" as ").next().unwrap().trim());
    let whole: Vec<String> = before
        .iter()
        .cloned()
        .chain(names.filter(|name| !name.is_empty()).map(str::to_owned))
        .collect();
    match list {
        Some(list) => top_level(list).iter().for_each(|part| open_braces(&whole, part, paths)),
        None => paths.push(whole),
    }
}

/// The path of a file's module from the crate's root.
fn module_path(path: &Path) -> Vec<String> {
    let whole = path.with_extension("");
    let names = whole.iter().map(|name| name.to_string_lossy().into_owned());
    names.filter(|name| name != "mod").collect()
}

/// A path as seen from the crate's root, if it does not lead out of it.
fn from_root(here: &[String], path: &[String]) -> Option<Vec<String>> {
    let mut whole: Vec<String> = match path.first()?.as_str() {
        "crate" => Vec::new(),
        "self" | "super" => here.to_vec(),
        _ => return None,
    };
    for name in path {
        match name.as_str() {
            "crate" | "self" => {}
            "super" => drop(whole.pop()),
            name => whole.push(name.to_owned()),
        }
    }
    Some(whole)
}

/// The modules that a `mod.rs` declares, by the paragraph that they are in, and what it defines itself.
fn map_of(text: &str) -> (HashMap<String, usize>, HashSet<String>) {
    let (mut stage, mut stages, mut own) = (0, HashMap::new(), HashSet::new());
    let before = std::iter::once("").chain(text.lines());
    for line in text
        .lines()
        .zip(before)
        .filter(|(_, before)| *before != "#[cfg(test)]")
        .map(|(line, _)| line)
    {
        let words: Vec<&str> = line.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
        let words: Vec<&str> = words
            .into_iter()
            .skip_while(|word| ["pub", "crate", "in", "super", ""].contains(word))
            .collect();
        match words.as_slice() {
            [] => stage += 1,
            ["mod", name, ..] => drop(stages.insert((*name).to_owned(), stage)),
            ["struct" | "enum" | "trait" | "type" | "fn" | "const" | "static", name, ..]
                if !line.starts_with(' ') =>
            {
                own.insert((*name).to_owned());
            }
            _ => {}
        }
    }
    (stages, own)
}

/// Within a room, too, light falls one way: files use those in paragraphs of its `mod.rs` before their own, those in
/// one paragraph not in a circle, and none what is defined in `mod.rs` above them.
#[test]
fn files_of_a_room_use_only_those_named_before_them() {
    let sources = sources();
    for (map, text) in sources.iter().filter(|(path, _)| path.ends_with("mod.rs")) {
        let (stages, own) = map_of(text);
        let room = module_path(map);
        let mut edges: BTreeSet<(String, String)> = BTreeSet::new();
        for (path, text) in &sources {
            let here = module_path(path);
            if here.len() <= room.len() || here[..room.len()] != room {
                continue;
            }
            let user = &here[room.len()];
            for used in used_paths(text.split("#[cfg(test)]").next().unwrap()) {
                let Some(used) = from_root(&here, &used) else { continue };
                if used.len() <= room.len()
                    || used[..room.len()] != room
                    || used[room.len()] == *user
                {
                    continue;
                }
                let used = &used[room.len()];
                // Files of tests alone are in no paragraph.
                let Some(from) = stages.get(user) else { continue };
                assert!(!own.contains(used), "{} uses {used} of {}", path.display(), map.display());
                if let Some(to) = stages.get(used) {
                    assert!(to <= from, "{} uses {used}, which comes later", path.display());
                    edges.insert((user.clone(), used.clone()));
                }
            }
        }
        // What nothing left uses cannot be in a circle.
        loop {
            let used: BTreeSet<String> = edges.iter().map(|(_, used)| used.clone()).collect();
            let before = edges.len();
            edges.retain(|(user, _)| used.contains(user));
            if edges.len() == before {
                break;
            }
        }
        assert!(edges.is_empty(), "{}: a circle among {edges:?}", map.display());
    }
}

#[test]
fn library_names_its_modules_in_flow_order() {
    let text =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs")).unwrap();
    let modules = text.lines().filter_map(|line| line.strip_prefix("pub mod "));
    let ranks: Vec<usize> = modules.map(|line| rank(line.trim_end_matches(';')).unwrap()).collect();
    assert!(ranks.is_sorted() && ranks.len() >= 12, "{ranks:?}");
}

#[test]
fn every_file_says_what_it_is_for_and_is_short() {
    for (path, text) in sources() {
        assert!(text.starts_with("//! "), "{} does not begin with `//!`", path.display());
        let lines = text.lines().count();
        assert!(lines <= LONGEST, "{} has {lines} lines", path.display());
    }
}

#[test]
fn nothing_is_left_unfinished() {
    for (path, text) in sources() {
        for word in UNFINISHED {
            assert!(!text.contains(word), "{} has {word}", path.display());
        }
    }
}

#[test]
fn the_library_is_silent() {
    for (path, text) in sources() {
        if ["main", "cli"].contains(&module(&path).as_str()) {
            continue;
        }
        // Examples in documentation may print.
        let code = || text.lines().filter(|line| !line.trim_start().starts_with("//"));
        for word in ["println!", "eprintln!", "print!("] {
            assert!(!code().any(|line| line.contains(word)), "{} has {word}", path.display());
        }
    }
}
