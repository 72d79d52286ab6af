//! Lines of text files from many exporters.

use std::borrow::Cow;
use std::fs;
use std::path::Path;

use crate::error::{Error, Result};

/// The file's text, UTF-8 or UTF-16 with a byte order mark; what is neither becomes replacement characters.
pub(crate) fn read(path: &Path) -> Result<String> {
    Ok(decoded(&fs::read(path).map_err(Error::io(path))?))
}

/// The text of a file's bytes, its lines ended by line feeds.
pub(crate) fn decoded(bytes: &[u8]) -> String {
    let wide = |from: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].chunks_exact(2).map(|b| from([b[0], b[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    in_lines(match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        _ => {
            let text = String::from_utf8_lossy(bytes);
            text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned()
        }
    })
}

/// The text with lines that end in a line feed where some end in a carriage return alone.
fn in_lines(text: String) -> String {
    let mut rest = text.bytes().peekable();
    while let Some(byte) = rest.next() {
        if byte == b'\r' && rest.peek() != Some(&b'\n') {
            return text.replace("\r\n", "\n").replace('\r', "\n");
        }
    }
    text
}

/// A name without a comment after it, be it glued to its sign or not: `wood # oak`, but `Material #25` is a name, too.
pub(crate) fn without_comment(name: &str) -> Option<&str> {
    let start = name.match_indices('#').map(|(start, _)| start);
    let mut before =
        start.map(|start| &name[..start]).filter(|name| name.ends_with(char::is_whitespace));
    before.next().map(str::trim_end).filter(|name| !name.is_empty())
}

/// The same where the comment is plainly one, its sign between spaces.
pub(crate) fn name(rest: &str) -> &str {
    let end = rest.split_once("# ").map_or(rest.strip_suffix('#'), |(name, _)| Some(name));
    let end = end.filter(|name| name.ends_with(char::is_whitespace)).map(str::trim_end);
    end.filter(|name| !name.is_empty()).unwrap_or(rest)
}

/// Trimmed lines with the number of their first physical line, counted from 1.
///
/// Lines that end in `\` are joined with the next one; comments and empty lines are left out.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut physical = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (index, line) = physical.next()?;
        let mut line = Cow::Borrowed(line.trim());
        while let Some(start) = line.strip_suffix('\\').filter(|start| !start.starts_with('#')) {
            let next = physical.next().map_or("", |(_, next)| next.trim());
            line = Cow::Owned(format!("{start} {next}"));
        }
        Some((index + 1, line))
    })
    .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

/// The first word of a line and what follows it, trimmed.
pub(crate) fn keyword(line: &str) -> (&str, &str) {
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    (word, rest.trim())
}

/// The words of `rest` up to a comment at the line's end.
pub(crate) fn words(rest: &str) -> impl Iterator<Item = &str> {
    rest.split_whitespace().take_while(|word| !word.starts_with('#'))
}

/// The words of `rest` as finite numbers, or the first word that is none.
pub(crate) fn numbers(rest: &str) -> std::result::Result<Vec<f64>, &str> {
    let number = |word: &'_ str| word.parse().ok().filter(|x: &f64| x.is_finite());
    words(rest).map(|word| number(word).ok_or(word)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn continued_lines_are_joined_and_counted() {
        let text = "v 1 \\\r\n 2 3\n# note \\\n\n\tf 1\\\n";
        let found: Vec<_> = lines(text).collect();
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].0, words(&found[0].1).count()), (1, 4));
        assert_eq!((found[1].0, found[1].1.trim()), (5, "f 1"));
    }

    #[test]
    fn text_of_two_bytes_a_letter_is_text() {
        let big: Vec<u8> = "\u{feff}v 1 \u{e4}".encode_utf16().flat_map(u16::to_be_bytes).collect();
        let little: Vec<u8> =
            "\u{feff}v 1 \u{e4}".encode_utf16().flat_map(u16::to_le_bytes).collect();
        for bytes in [&big[..], &little, "\u{feff}v 1 \u{e4}".as_bytes()] {
            assert_eq!(decoded(bytes), "v 1 \u{e4}");
        }
    }

    #[test]
    fn only_finite_numbers_are_numbers() {
        assert_eq!(numbers("1 -2e-3 # 5"), Ok(vec![1.0, -0.002]));
        for wrong in ["nan", "inf", "1e999", "1,5", "x"] {
            assert_eq!(numbers(wrong), Err(wrong));
        }
    }
}
