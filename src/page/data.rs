//! JSON inside a page.

use maud::{Markup, PreEscaped, html};
use serde::Serialize;
use serde_json::Value;

/// `value` as JSON in the page, to be read by `JSON.parse(document.getElementById(id).textContent)`.
///
/// Whatever texts it holds, it ends nothing but itself: `<`, `>` and `&` are escaped.
pub fn data(id: &str, value: &Value) -> Markup {
    html! { script type="application/json" id=(id) { (inert(value)) } }
}

/// JSON without the letters by which HTML could end a script, begin a comment or name a character:
/// within JSON they stand in texts only, where an escape means the same.
pub(super) fn inert(value: &impl Serialize) -> PreEscaped<String> {
    let json = serde_json::to_string(value).unwrap_or_else(|_| "null".to_owned());
    let escaped = json.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026");
    PreEscaped(escaped)
}
