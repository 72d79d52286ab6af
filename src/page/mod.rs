//! Self-contained HTML pages: pictures, tables and lit meshes that can be turned, in one file.
//!
//! | component | with scripts | without |
//! |---|---|---|
//! | [`viewer()`] | a lit mesh in 3D: light on pictures or without them, false colours, levels, reasons, errors, the mesh itself | its picture |
//! | [`wipe()`] | pictures on top of each other, a border to drag between two of them | side by side |
//! | [`table()`] | rows sort by a click on a header; download as CSV | a table |
//! | [`plot()`] | curves on axes | the same |
//! | [`sections`] | parts under headings, and contents that lead to them | the same |
//! | [`folded`] | what few look for, unfolded by a click | the same |
//! | [`board()`], [`facts`], [`picture`], [`columns`], [`halves`], [`strip`], [`pairs`] | | the same |
//! | [`data()`] | JSON for whoever reads the page by program | |
//!
//! [`document()`] makes a page of them, [`save`] writes it. A page opens from a disk, asks for nothing
//! over a network and is not able to: its content security policy forbids it.
//!
//! | what | where |
//! |---|---|
//! | whole pages | `document`, `data` |
//! | without scripts | `section`, `table`, `plot` on axes of `axis_spec`, `image` |
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

mod axis_spec;
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
mod section;
mod table;
mod textured;
mod viewer;
mod wipe;

pub use data::data;
pub use document::{check_writable, document, save};
pub use image::{columns, halves, pairs, picture, strip};
pub use maud::{Markup, html};
pub use model::Model;
pub use plot::{Axis, CURVE_COLOURS, Curve, Plot, Stroke, plot};
pub use section::{Section, folded, sections};
pub use table::{Board, BoardRow, Cell, Fact, Table, board, facts, table};
pub use viewer::{Step, Viewer, viewer};
pub use wipe::{WipePicture, wipe};
