//! The guide: one page a task.
//!
//! | to | read |
//! |---|---|
//! | light a file that brings no light | [`lights`] |
//! | make pictures, and see why the mesh is as it is | [`pictures`] |
//! | know how bright it is on the desk | [`work_plane`] |
//! | dim and colour lights without solving again | [`relight`] |
//! | choose between speed and accuracy | [`accuracy`] |
//! | see whether an adaptive mesh is worth it | [`compare`] |
//! | light a game or a viewer | [`lightmaps`] |
//! | send the result to somebody | [`pages`] |
//! | solve for hours, and stop at any time | [`long_runs`] |
//! | have the matrix of form factors | [`form_factors`] |
//! | choose the order in which patches shoot | [`solvers`] |
//! | know what is read and written, and what is repaired | [`files`] |
//! | call the command from scripts | [`scripts`] |
//! | call the library | [`rust`] |
//! | know the method | [`method`] |
//! | know what is new | [`changes`] |
//!
//! Commands are as in a checkout of the project, whose `scenes` they light. A test runs them.

/// Where names in links lead in this documentation. Pages end with the same names, for readers of the files
/// themselves; of two definitions the first counts.
macro_rules! links {
    () => {
        "[accuracy]: crate::guide::accuracy
[changes]: crate::guide::changes
[compare]: crate::guide::compare
[files]: crate::guide::files
[form_factors]: crate::guide::form_factors
[lightmaps]: crate::guide::lightmaps
[lights]: crate::guide::lights
[long_runs]: crate::guide::long_runs
[method]: crate::guide::method
[pages]: crate::guide::pages
[pictures]: crate::guide::pictures
[relight]: crate::guide::relight
[rust]: crate::guide::rust
[scripts]: crate::guide::scripts
[solvers]: crate::guide::solvers
[work_plane]: crate::guide::work_plane
[api-compare]: crate::compare
[api-form-factor]: crate::form_factor
[api-page]: crate::page
[api-relaxation]: crate::solver::relaxation
[api-scene]: crate::scene
[api-solver]: crate::solver
[api]: crate
"
    };
}

/// Makes a module of each page.
macro_rules! pages {
    ($($name:ident: $file:literal,)*) => {
        $(
            #[doc = links!()]
            #[doc = include_str!($file)]
            pub mod $name {}
        )*
    };
}

pages! {
    lights: "lights.md",
    pictures: "pictures.md",
    work_plane: "work_plane.md",
    relight: "relight.md",
    accuracy: "accuracy.md",
    compare: "compare.md",
    lightmaps: "lightmaps.md",
    pages: "pages.md",
    long_runs: "long_runs.md",
    form_factors: "form_factors.md",
    solvers: "solvers.md",
    files: "files.md",
    scripts: "scripts.md",
    rust: "rust.md",
    method: "method.md",
    changes: "changes.md",
}

/// The README's Rust is compiled as the pages' is.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
mod readme {}
