//! Pictures, and things side by side.

use maud::{Markup, html};

use super::base64::png_address;

/// A picture, the bytes of a PNG, that `alt` describes for those who do not see it, with a caption
/// below unless that is empty.
pub fn picture(png: &[u8], alt: &str, caption: &str) -> Markup {
    html! {
        figure.picture {
            (image(png, alt))
            @if !caption.is_empty() { figcaption { (caption) } }
        }
    }
}

/// Things side by side where the page is wide enough, else below each other.
pub fn columns(items: &[Markup]) -> Markup {
    html! {
        div.columns { @for item in items { div { (item) } } }
    }
}

/// Things side by side, two of them however narrow the page.
pub fn halves(items: &[Markup; 2]) -> Markup {
    html! {
        div.halves { @for item in items { div { (item) } } }
    }
}

/// Things side by side where the page is wide enough, else in a strip that scrolls.
pub fn strip(items: &[Markup]) -> Markup {
    html! {
        div.row tabindex="0" { @for item in items { div { (item) } } }
    }
}

/// Pairs side by side, each below the other, where the page is wide enough; else pairs below each other, each side by
/// side.
pub fn pairs(pairs: &[[Markup; 2]]) -> Markup {
    html! {
        div.pairs { @for item in pairs.iter().flatten() { div { (item) } } }
    }
}

/// The picture alone.
pub(super) fn image(png: &[u8], alt: &str) -> Markup {
    let [width, height] = size_of(png).map(|size| size.map(Some)).unwrap_or_default();
    html! { img src=(png_address(png)) alt=(alt) width=[width] height=[height]; }
}

/// Width and height, pixels, as the header of a PNG has them: so the page need not move when the
/// picture is there.
fn size_of(png: &[u8]) -> Option<[u32; 2]> {
    let number = |at: usize| Some(u32::from_be_bytes(png.get(at..at + 4)?.try_into().ok()?));
    Some([number(16)?, number(20)?])
}
