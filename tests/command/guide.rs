//! The guide and the README: their commands run, their links lead somewhere, their pictures are made by commands they name.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use tempfile::TempDir;

/// Commands that no test here runs, by how they begin, and why.
const NOT_RUN: [(&str, &str); 7] = [
    ("cargo test fuzz::", "runs for as long as one likes"),
    ("cargo test", "is what runs this"),
    ("cargo install --path .", "would install what the tests have built"),
    ("cargo doc --no-deps --open", "opens a browser; .ci/run makes the documentation"),
    ("cargo run --release --example", ".ci/run runs all examples"),
    ("cargo bench --bench error_curve", "takes minutes"),
    ("cargo bench --bench hemicube", "takes minutes"),
];

/// The most that README may hold, bytes: two minutes.
const README_BYTES: usize = 9000;

/// Options that quick runs have instead of the page's own: of each subcommand, and of adaptive meshes.
const QUICK: [&str; 3] = ["--hemicube-resolution=32", "--stop=50%", "--patch-size=5"];
const QUICK_ADAPTIVE: [&str; 3] = ["--quality=draft", "--max-level=0", "--shadow-rays=1"];
const QUICK_COMPARISON: [&str; 2] = ["--uniform=2", "--adaptive=50%"];
const QUICK_REFERENCE: [&str; 3] = ["--noise=50%", "--places=200", "--budget=5s"];

/// What follows these is the name of a file that is written.
const WRITES: [&str; 9] = [
    "-o",
    "--output",
    "--image",
    "--html",
    "--grid-csv",
    "--history",
    "--csv",
    "--figures",
    "--save-reference",
];

/// Stands for the office, which takes long: its materials, by name, in an empty room.
const OFFICE: &str = "mtllib office.mtl\n\
    v 0 0 0\nv 4 0 0\nv 4 0 5\nv 0 0 5\nv 0 3 0\nv 4 3 0\nv 4 3 5\nv 0 3 5\n\
    v 1 2.9 1\nv 3 2.9 1\nv 3 2.9 4\nv 1 2.9 4\n\
    v 0.1 1 1\nv 0.1 2 1\nv 0.1 2 4\nv 0.1 1 4\n\
    v 2 1 2\nv 2.2 1 2\nv 2.2 1 2.2\nv 2 1 2.2\n\
    usemtl wall\nf 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\n\
    usemtl panel\nf 9 10 11 12\nusemtl window\nf 13 14 15 16\nusemtl bulb\nf 17 18 19 20\n";

/// Stands for the bare room: its materials in a room that is open in the north.
const BARE_ROOM: &str = "mtllib bare-room.mtl\n\
    v 0 0 0\nv 4 0 0\nv 4 0 5\nv 0 0 5\nv 0 3 0\nv 4 3 0\nv 4 3 5\nv 0 3 5\n\
    v 2 2 2\nv 2.2 2 2\nv 2.2 2 2.2\nv 2 2 2.2\n\
    usemtl floor\nf 4 3 2 1\nusemtl ceiling\nf 5 6 7 8\n\
    usemtl wall\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nusemtl lamp shade\nf 9 10 11 12\n";

/// Stands for all scenes of comparisons, whose pictures take long.
const SQUARES: &str = "scenes/facing-squares.obj";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Paths of the README and of the guide's pages, from the root.
fn texts() -> Vec<String> {
    let pages = fs::read_dir(root().join("src/guide")).expect("the guide");
    let names = pages.map(|entry| entry.expect("a page").file_name().into_string().expect("UTF-8"));
    let pages = names.filter(|name| name.ends_with(".md")).map(|name| format!("src/guide/{name}"));
    let mut texts: Vec<String> = pages.chain(["README.md".to_owned()]).collect();
    texts.sort();
    assert!(texts.len() > 12, "{texts:?}");
    texts
}

/// A text between fences, and the word after the first one.
struct Block {
    language: String,
    lines: Vec<String>,
}

/// The blocks of a text; and its other lines.
fn parts(text: &str) -> (Vec<Block>, Vec<&str>) {
    let (mut blocks, mut prose) = (Vec::new(), Vec::new());
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let Some(language) = line.strip_prefix("```") else {
            prose.push(line);
            continue;
        };
        let inside = lines.by_ref().take_while(|line| *line != "```").map(str::to_owned);
        blocks.push(Block { language: language.to_owned(), lines: inside.collect() });
    }
    (blocks, prose)
}

/// The commands of a block, continued lines joined.
fn commands(block: &Block) -> Vec<String> {
    let text = block.lines.join("\n").replace("\\\n", " ");
    text.lines().map(|line| line.trim().to_owned()).filter(|line| !line.is_empty()).collect()
}

/// Words of a command; those in single quotes are one.
fn words(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for c in command.chars() {
        match c {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            _ => words.last_mut().expect("there is one").push(c),
        }
    }
    assert!(!quoted, "a quote is not closed: {command}");
    words.retain(|word| !word.is_empty());
    words
}

/// Why a command is not run here, if it is not.
fn why_not(command: &str) -> Option<&'static str> {
    NOT_RUN.iter().find(|(start, _)| command.starts_with(start)).map(|(_, reason)| *reason)
}

/// The words after `radiosity`, however it is called.
fn arguments(command: &str) -> Vec<String> {
    let words = words(command);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words[..] {
        ["radiosity", ref rest @ ..] | ["cargo", "run", "--release", "--", ref rest @ ..] => {
            rest.iter().copied().map(str::to_owned).collect()
        }
        _ => {
            panic!("no test runs {command}: make it one of radiosity's, or an exception in NOT_RUN")
        }
    }
}

/// The same with settings that make it a matter of a moment, and small pictures.
fn quick(mut arguments: Vec<String>) -> Vec<String> {
    if arguments[0] == "compare" {
        arguments[1] = SQUARES.to_owned();
    }
    let has = |name: &str| arguments.iter().any(|word| word == name);
    let mut given = Vec::new();
    match arguments[0].as_str() {
        "solve" => {
            given.extend(QUICK);
            match has("--uniform") {
                true => given.push("--uniform=2"),
                false => given.extend(QUICK_ADAPTIVE),
            }
        }
        "compare" => {
            given.extend(QUICK.iter().chain(&QUICK_ADAPTIVE).chain(&QUICK_COMPARISON));
            given.extend(QUICK_REFERENCE.iter().filter(|_| !has("--reference")));
        }
        _ => {}
    }
    if has("--image") || arguments[0] == "render" {
        given.push("--size=32x24");
    }
    for option in given {
        let name = option.split('=').next().expect("a name");
        if let Some(at) = arguments.iter().position(|word| word == name) {
            arguments.drain(at..at + 2);
        }
        arguments.push(option.to_owned());
    }
    arguments
}

/// A folder with the scenes to run commands in.
fn stage() -> TempDir {
    let stage = tempfile::tempdir().expect("a temporary folder");
    let scenes = stage.path().join("scenes");
    fs::create_dir(&scenes).expect("a folder");
    for entry in fs::read_dir(root().join("scenes")).expect("the scenes") {
        let path = entry.expect("a scene").path();
        fs::copy(&path, scenes.join(path.file_name().expect("a name"))).expect("a copy");
    }
    for (name, text) in [("office.obj", OFFICE), ("bare-room.obj", BARE_ROOM)] {
        fs::write(scenes.join(name), text).expect("a scene");
    }
    stage
}

/// Runs one command, and looks for what it was asked to write.
fn run(stage: &Path, command: &str) {
    let mut arguments = arguments(command);
    let redirected = arguments.iter().position(|word| word == ">").map(|at| {
        let file = arguments[at + 1].clone();
        arguments.truncate(at);
        file
    });
    let arguments = quick(arguments);
    let mut process = Command::new(env!("CARGO_BIN_EXE_radiosity"));
    process.args(&arguments).current_dir(stage).stderr(Stdio::piped());
    let output = process.output().expect("the command runs");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command}\n{arguments:?}\n{told}");
    if let Some(file) = redirected {
        fs::write(stage.join(file), &output.stdout).expect("a file");
    }
    for pair in words(command).windows(2) {
        let written = stage.join(&pair[1]);
        assert!(
            !WRITES.contains(&pair[0].as_str()) || written.exists(),
            "{command}: no {}",
            pair[1]
        );
    }
}

/// Runs the commands of a text in their order, with the files that it shows.
fn run_all(path: &str) {
    let stage = stage();
    let text = read(path);
    let (blocks, _) = parts(&text);
    for block in &blocks {
        match block.language.as_str() {
            "sh" => {
                let commands = commands(block);
                let runs = commands.iter().filter(|command| why_not(command).is_none());
                runs.for_each(|command| run(stage.path(), command));
            }
            "toml" => {
                let name = block.lines[0].strip_prefix("# ").expect("its first line is its name");
                fs::write(stage.path().join(name), block.lines.join("\n")).expect("a file");
            }
            // These are tests of the documentation.
            language => assert_eq!(language, "rust,no_run", "in {path}"),
        }
    }
}

macro_rules! commands_of {
    ($($name:ident: $path:literal,)*) => {
        $(
            #[test]
            fn $name() {
                run_all($path);
            }
        )*

        #[test]
        fn every_text_is_run() {
            let run: BTreeSet<&str> = [$($path),*].into();
            let texts = texts();
            assert_eq!(run, texts.iter().map(String::as_str).collect());
        }
    };
}

commands_of! {
    readme: "README.md",
    accuracy: "src/guide/accuracy.md",
    changes: "src/guide/changes.md",
    compare: "src/guide/compare.md",
    files: "src/guide/files.md",
    form_factors: "src/guide/form_factors.md",
    lightmaps: "src/guide/lightmaps.md",
    lights: "src/guide/lights.md",
    long_runs: "src/guide/long_runs.md",
    method: "src/guide/method.md",
    pages: "src/guide/pages.md",
    pictures: "src/guide/pictures.md",
    relight: "src/guide/relight.md",
    rust: "src/guide/rust.md",
    scripts: "src/guide/scripts.md",
    solvers: "src/guide/solvers.md",
    work_plane: "src/guide/work_plane.md",
}

#[test]
fn commands_in_sentences_are_run_in_a_block_too_or_are_exceptions() {
    for path in texts() {
        let text = read(&path);
        let (blocks, prose) = parts(&text);
        let in_blocks: Vec<String> = blocks.iter().flat_map(commands).collect();
        let prose = prose.join(" ");
        let spans = prose.split('`').skip(1).step_by(2);
        for span in
            spans.filter(|span| span.starts_with("cargo ") || span.starts_with("radiosity "))
        {
            // `radiosity help solve` and the like need no scene.
            let help = span.starts_with("radiosity help ");
            let known =
                help || why_not(span).is_some() || in_blocks.iter().any(|line| line == span);
            assert!(known, "{path}: {span}");
        }
    }
}

#[test]
fn exceptions_are_still_there() {
    let all: String = texts().iter().map(|path| read(path)).collect();
    for (start, reason) in NOT_RUN {
        assert!(all.contains(start), "{start}, which {reason}, is on no page");
    }
}

/// Where links of a text lead: `](…)`, `src="…"`, and definitions `[…]: …`.
fn targets(text: &str) -> Vec<String> {
    let (_, prose) = parts(text);
    let prose = prose.join("\n");
    let until = |start: &str, end: char| -> Vec<String> {
        prose
            .split(start)
            .skip(1)
            .filter_map(|rest| rest.split(end).next())
            .map(str::to_owned)
            .collect()
    };
    let definitions = prose
        .lines()
        .filter(|line| line.starts_with('['))
        .filter_map(|line| line.split_once("]: "));
    let definitions = definitions.map(|(_, target)| target.to_owned());
    [until("](", ')'), until("src=\"", '"')].concat().into_iter().chain(definitions).collect()
}

/// As GitHub names a heading.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}

#[test]
fn links_lead_to_files_and_headings() {
    let mut count = 0;
    for path in texts().into_iter().chain(["scenes/README.md".to_owned()]) {
        let folder = Path::new(&path).parent().expect("a folder").to_owned();
        for target in targets(&read(&path)).iter().filter(|target| !target.starts_with("https://"))
        {
            let (file, heading) = target.split_once('#').unwrap_or((target, ""));
            let there: PathBuf = root().join(&folder).join(file);
            assert!(there.is_file(), "{path} leads to {target}");
            let text = if heading.is_empty() {
                String::new()
            } else {
                fs::read_to_string(&there).unwrap()
            };
            let mut headings = text.lines().filter(|line| line.starts_with('#'));
            let found = headings.any(|line| anchor(line.trim_start_matches('#').trim()) == heading);
            assert!(heading.is_empty() || found, "{path} leads to {target}");
            count += 1;
        }
    }
    assert!(count > 40, "{count} links");
}

#[test]
fn names_of_links_are_those_of_the_documentation() {
    let module = read("src/guide/mod.rs");
    for path in texts().iter().filter(|path| path.starts_with("src/guide/")) {
        let text = read(path);
        assert!(
            !text.contains("]("),
            "{path}: a link without a name leads nowhere in the documentation"
        );
        for line in text.lines().filter(|line| line.starts_with('[') && line.contains("]: ")) {
            let name = line.split_once("]: ").expect("a definition").0;
            assert!(module.contains(&format!("{name}]: crate")), "{path}: {name}]");
        }
    }
}

#[test]
fn every_page_is_a_module_and_in_the_readme() {
    let (module, readme) = (read("src/guide/mod.rs"), read("README.md"));
    for path in texts().iter().filter(|path| path.starts_with("src/guide/")) {
        let file = path.rsplit('/').next().expect("a name");
        let name = file.trim_end_matches(".md");
        assert!(module.contains(&format!("{name}: \"{file}\",")), "{file} is no module");
        assert!(module.contains(&format!("[`{name}`]")), "{file} is not in the list of pages");
        assert!(readme.contains(path.as_str()), "{file} is not in the README");
    }
}

#[test]
fn the_readme_is_for_two_minutes_and_its_pictures_are_made_by_commands() {
    let readme = read("README.md");
    assert!(readme.len() <= README_BYTES, "{} bytes", readme.len());
    let made: BTreeSet<String> = texts()
        .iter()
        .flat_map(|path| parts(&read(path)).0)
        .filter(|block| block.language == "sh")
        .flat_map(|block| commands(&block))
        .flat_map(|command| {
            let words = words(&command);
            let lightmap = command.contains("--lightmap");
            let files = words.windows(2).filter(|pair| WRITES.contains(&pair[0].as_str()));
            let beside = |file: &String| {
                let map = lightmap.then(|| file.replace(".glb", ".lightmap.png"));
                [Some(file.clone()), map].into_iter().flatten()
            };
            files.flat_map(|pair| beside(&pair[1])).collect::<Vec<_>>()
        })
        .collect();
    let shown: BTreeSet<String> = targets(&readme)
        .iter()
        .filter_map(|target| target.strip_prefix("examples/pictures/"))
        .map(str::to_owned)
        .collect();
    let folder = fs::read_dir(root().join("examples/pictures")).expect("pictures");
    let there =
        folder.map(|entry| entry.expect("a picture").file_name().into_string().expect("UTF-8"));
    assert_eq!(shown, there.collect(), "pictures of the README and of its folder");
    assert!(shown.is_subset(&made), "{shown:?} {made:?}");
}
