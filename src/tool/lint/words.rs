//! Counts names in text without a syntax tree.

use crate::rapid::text::SourceFile;

/// Number of occurrences of a lower-case name in a file outside comments.
pub(super) fn in_file(file: &SourceFile, key: &str) -> usize {
    let text = file.charset.decode(&file.bytes);
    text.lines().map(|line| count(line.split('!').next().unwrap_or(line), key)).sum()
}

/// Number of occurrences of a lower-case word in a text, ignoring case.
pub(super) fn count(text: &str, key: &str) -> usize {
    let apart = |c: char| !c.is_alphanumeric() && c != '_';
    text.split(apart).filter(|word| word.to_lowercase() == key).count()
}
