//! Pictures to compare by a border that is dragged across them.

use maud::{Markup, html};

use super::base64::png_address;
use super::image::image;

/// One of the pictures.
#[derive(Clone, Copy, Debug)]
pub struct WipePicture<'a> {
    /// Its name, a word or two.
    pub label: &'a str,
    /// The picture, a PNG of the same size as the others.
    pub png: &'a [u8],
    /// What it shows, for those who do not see it.
    pub alt: &'a str,
    /// The same picture with the mesh drawn over it, a PNG, for a switch to show instead.
    pub mesh: Option<&'a [u8]>,
}

/// Pictures of one size on top of each other: a border to drag shows one of them on its left and
/// another on its right; of three or more, buttons choose which. Without scripts, and on paper, they
/// stand side by side.
pub fn wipe(pictures: &[WipePicture<'_>], caption: &str) -> Markup {
    html! {
        figure.wipe {
            div.stage {
                @for picture in pictures {
                    div.pane {
                        div.plain { (image(picture.png, picture.alt)) }
                        @if let Some(mesh) = picture.mesh {
                            img.mesh src=(png_address(mesh)) alt=(picture.alt);
                        }
                        div.name { (picture.label) }
                    }
                }
            }
            @if !caption.is_empty() { figcaption { (caption) } }
        }
    }
}
