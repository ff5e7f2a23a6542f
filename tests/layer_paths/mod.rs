//! The paths in a source, relative to the crate's root.

pub(crate) mod circles;

use crate::rust_source::tokens::{Token, tokens};

/// A path with expanded `use` groups and resolved `self` and `super`.
pub(crate) struct Named {
    /// From 1.
    pub(crate) line: usize,
    /// `crate`, `std` or a crate's name first; for glob imports `*` last.
    pub(crate) path: Vec<String>,
}

/// The paths of at least two names, and crates that `use` names alone.
pub(crate) fn named(file: &str, source: &str) -> Vec<Named> {
    let tokens = tokens(source);
    let mut found = Vec::new();
    // Open inline modules, each with the brace depth outside it.
    let mut inline: Vec<(String, usize)> = Vec::new();
    let mut depth = 0;
    let mut i = 0;
    while i < tokens.len() {
        let token = tokens[i];
        let text_at = |k: usize| tokens.get(k).map_or("", |token| token.text);
        match token.text {
            "{" => depth += 1,
            "}" => {
                depth = depth.max(1) - 1;
                inline.retain(|(_, outside)| *outside < depth);
            }
            "mod" if text_at(i + 2) == "{" => {
                inline.push((text_at(i + 1).to_owned(), depth));
                i += 1;
            }
            _ => {}
        }
        let continues = i > 0 && matches!(tokens[i - 1].text, "::" | ".");
        // `pub(in path)` names the modules that may import: it imports nothing.
        let is_visibility = i > 1 && tokens[i - 1].text == "in" && tokens[i - 2].text == "(";
        let names_path = is_name(token) && text_at(i + 1) == "::" && !is_visibility;
        let names_crate = i > 0 && tokens[i - 1].text == "use" && is_name(token);
        if (names_path || names_crate) && !continues {
            let module = module(file, &inline);
            let mut paths = Vec::new();
            i = tree(&tokens, i, &[], &mut paths);
            found.extend(paths.into_iter().filter_map(|(line, path)| {
                resolve(&module, path).map(|path| Named { line, path })
            }));
        } else {
            i += 1;
        }
    }
    found
}

/// Also true for keywords.
fn is_name(token: Token<'_>) -> bool {
    token.text.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// The module of a place, relative to the crate's root.
fn module(file: &str, inline: &[(String, usize)]) -> Vec<String> {
    let inner = file.trim_start_matches("src/").trim_end_matches(".rs");
    let parts = inner.split('/').filter(|part| !matches!(*part, "mod" | "lib" | "main"));
    parts.map(str::to_owned).chain(inline.iter().map(|(name, _)| name.clone())).collect()
}

/// Reads a path or a group of paths that starts at `i`; returns its end.
fn tree(
    tokens: &[Token<'_>],
    mut i: usize,
    prefix: &[String],
    found: &mut Vec<(usize, Vec<String>)>,
) -> usize {
    let text_at = |k: usize| tokens.get(k).map_or("", |token| token.text);
    let mut path = prefix.to_vec();
    let line = tokens[i].line;
    loop {
        if text_at(i) == "{" {
            i += 1;
            while i < tokens.len() && text_at(i) != "}" {
                let is_item = is_name(tokens[i]) || matches!(text_at(i), "{" | "*");
                i = if is_item { tree(tokens, i, &path, found) } else { i + 1 };
            }
            return i + 1;
        }
        let is_part = i < tokens.len() && (is_name(tokens[i]) || text_at(i) == "*");
        if is_part {
            path.push(text_at(i).to_owned());
            i += 1;
            if text_at(i) == "::" {
                i += 1;
                continue;
            }
        }
        // `{self, …}` names the path of the group.
        if path.len() > 1 && path.last().is_some_and(|name| name == "self") {
            path.pop();
        }
        found.push((line, path));
        // The name after `as` is not a path.
        return if text_at(i) == "as" { i + 2 } else { i };
    }
}

/// A path relative to the root; `None` for names that stay in the module.
fn resolve(module: &[String], path: Vec<String>) -> Option<Vec<String>> {
    let ups = path.iter().take_while(|name| *name == "super").count();
    let from = match path.first()?.as_str() {
        "self" => module.to_vec(),
        "super" => module[..module.len().saturating_sub(ups)].to_vec(),
        _ => return Some(path),
    };
    let skipped = ups.max(1);
    let root = std::iter::once("crate".to_owned());
    let absolute: Vec<String> = root.chain(from).chain(path.into_iter().skip(skipped)).collect();
    // `use super::{self}` and similar imports name the module itself.
    (absolute.len() > 1).then_some(absolute)
}
