//! Places in the text of a test that are marked with a number: `<1>name`.

/// The text without its marks, and the number and byte of each.
pub(crate) fn unmarked(text: &str) -> (String, Vec<(u32, usize)>) {
    let (mut plain, mut marks, mut rest) = (String::new(), Vec::new(), text);
    while let Some(at) = rest.find('<') {
        let mark = rest[at + 1..].split_once('>');
        let mark = mark.and_then(|(number, behind)| Some((number.parse().ok()?, behind)));
        let Some((number, behind)) = mark else {
            plain.push_str(&rest[..=at]);
            rest = &rest[at + 1..];
            continue;
        };
        plain.push_str(&rest[..at]);
        marks.push((number, plain.len()));
        rest = behind;
    }
    plain.push_str(rest);
    (plain, marks)
}
