//! Wording shared by the lines that tell what was repaired or ignored.

/// `"1 face"` or `"3 faces"`: a count with its noun, the plural made by an `s`.
pub(crate) fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// Adds `"<count> <noun>s <rest>"` to `notes` unless the count is zero.
pub(crate) fn note_count(notes: &mut Vec<String>, count: usize, noun: &str, rest: &str) {
    if count > 0 {
        notes.push(format!("{} {rest}", counted(count, noun)));
    }
}

/// The first few of `names`, quoted, and how many more there are.
pub(crate) fn listed(names: &[String]) -> String {
    const SHOWN: usize = 8;
    let shown: Vec<String> = names.iter().take(SHOWN).map(|name| format!("\"{name}\"")).collect();
    let more = names.len().saturating_sub(SHOWN);
    let tail = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("{}{tail}", shown.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_of_names_are_cut_short() {
        let names: Vec<String> = (0..10).map(|index| format!("m{index}")).collect();
        assert!(listed(&names).ends_with("\"m7\" and 2 more"));
        assert_eq!(listed(&names[..2]), "\"m0\", \"m1\"");
    }
}
