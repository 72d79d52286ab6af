//! Self-contained HTML pages: pictures, tables and lit meshes that can be turned, in one file.
//!
//! | component | with scripts | without |
//! |---|---|---|
//! | [`viewer()`] | a lit mesh in 3D: light on pictures or without them, false colours, levels, reasons, errors, the mesh itself | its picture |
//! | [`wipe()`] | pictures on top of each other, a border to drag between two of them | side by side |
//! | [`table()`] | rows sort by a click on a header; download as CSV | a table |
//! | [`plot()`] | curves on axes | the same |
//! | [`facts`], [`picture`], [`columns`], [`thirds`] | | the same |
//! | [`data()`] | JSON for whoever reads the page by program | |
//!
//! [`document()`] makes a page of them, [`save`] writes it. A page opens from a disk, asks for nothing
//! over a network and is not able to: its content security policy forbids it.
//!
//! | what | where |
//! |---|---|
//! | whole pages | `document`, `data` |
//! | without scripts | `table`, `plot`, `image` |
//! | with scripts | `wipe`, `viewer` |
//! | what a viewer shows | `model`: numbers by `quantise` on scales of `bulk` and in `colour_maps`, runs by `textured`, `pictures` |
//! | as bytes | `chunks`, in `base64` |
//!
//! ```
//! use radiosity::page::{self, Fact, html};
//!
//! let fact = |name, value: &str| Fact { name, value: value.to_owned() };
//! let rows = [fact("elements", "4 120"), fact("time", "1.9 s")];
//! let page = page::document("A room", &html! { h1 { "A room" } (page::facts(&rows)) });
//! assert!(page.into_string().starts_with("<!DOCTYPE html>"));
//! ```

mod base64;
mod bulk;
mod chunks;
pub(crate) mod colour_maps;
mod data;
mod document;
mod image;
mod model;
mod pictures;
mod plot;
mod quantise;
mod table;
mod textured;
mod viewer;
mod wipe;

pub use data::data;
pub use document::{check_writable, document, save};
pub use image::{columns, picture, thirds};
pub use maud::{Markup, html};
pub use model::Model;
pub use plot::{Axis, Curve, Plot, Stroke, plot};
pub use table::{Cell, Fact, Table, facts, table};
pub use viewer::{Step, Viewer, viewer};
pub use wipe::{WipePicture, wipe};
