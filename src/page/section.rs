//! Parts of a page under headings, and the list that leads to them.

use maud::{Markup, html};

/// A part of a page under a heading of its own.
#[derive(Clone, Debug)]
pub struct Section<'a> {
    /// Its heading, another than those of all others.
    pub title: &'a str,
    /// What it holds.
    pub body: Markup,
}

impl Section<'_> {
    /// What links to it name: letters and digits of the title, hyphens between words.
    fn anchor(&self) -> String {
        let title = self.title.to_lowercase();
        let words = title.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
        words.collect::<Vec<_>>().join("-")
    }
}

/// Contents that lead to sections, and these, in their order.
pub fn sections(sections: &[Section<'_>]) -> Markup {
    html! {
        nav.contents aria-label="Contents" {
            ul {
                @for section in sections {
                    li { a href=(format!("#{}", section.anchor())) { (section.title) } }
                }
            }
        }
        @for section in sections {
            section id=(section.anchor()) { h2 { (section.title) } (section.body) }
        }
    }
}

/// Something that is unfolded by a click on its summary, and open on paper.
pub fn folded(summary: &str, body: &Markup) -> Markup {
    html! { details { summary { (summary) } (body) } }
}
