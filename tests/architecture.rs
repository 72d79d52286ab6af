//! The house itself: data flows one way, files are small and say what they are for.

use std::fs;
use std::path::{Path, PathBuf};

/// The library's modules in flow order; those in one entry do not use each other.
const FLOW: [&[&str]; 21] = [
    &["colour"],
    &["error"],
    &["file"],
    &["settings"],
    &["watch"],
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
