//! How often a text names something, where the syntax tree is of no use.

use crate::rapid::text::SourceFile;

/// How often a file names something (lower case) outside of its comments.
pub(super) fn in_file(file: &SourceFile, key: &str) -> usize {
    let text = file.charset.decode(&file.bytes);
    text.lines().map(|line| count(line.split('!').next().unwrap_or(line), key)).sum()
}

/// How often a text holds a word (lower case), whatever its case.
pub(super) fn count(text: &str, key: &str) -> usize {
    let apart = |c: char| !c.is_alphanumeric() && c != '_';
    text.split(apart).filter(|word| word.to_lowercase() == key).count()
}
