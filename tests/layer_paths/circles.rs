//! Import cycles: sets of files each of which imports all others, directly or indirectly.

use std::collections::{BTreeMap, BTreeSet};

use super::{module, named};
use crate::rust_source::SourceFile;

/// The cycles, largest first; each in the order of the files. A file imports the file in which a
/// path that it names ends. `mod` lines import nothing, so a `mod.rs` may name its children if none
/// of them names it.
pub(crate) fn circles(sources: &[SourceFile]) -> Vec<Vec<&str>> {
    let by_module: BTreeMap<Vec<String>, usize> = sources
        .iter()
        .enumerate()
        .filter(|(_, file)| file.path != "src/main.rs")
        .map(|(i, file)| (module(&file.path, &[]), i))
        .collect();
    let reached: Vec<BTreeSet<usize>> = reached(&edges(sources, &by_module));
    let mut found: Vec<Vec<&str>> = Vec::new();
    for i in 0..sources.len() {
        let circle: Vec<usize> =
            reached[i].iter().copied().filter(|j| reached[*j].contains(&i)).collect();
        if circle.len() > 1 && circle[0] == i {
            found.push(circle.iter().map(|i| sources[*i].path.as_str()).collect());
        }
    }
    found.sort_by_key(|circle| std::cmp::Reverse(circle.len()));
    found
}

/// For each file, the files that it imports.
fn edges(sources: &[SourceFile], by_module: &BTreeMap<Vec<String>, usize>) -> Vec<BTreeSet<usize>> {
    let imports = |file: &SourceFile| {
        let own = module(&file.path, &[]);
        let target = |path: Vec<String>| {
            let absolute = match path.first().map(String::as_str) {
                Some("crate") => path[1..].to_vec(),
                // A child module, or a name from elsewhere, which resolves to the file itself.
                _ => own.iter().cloned().chain(path).collect(),
            };
            (0..=absolute.len()).rev().find_map(|n| by_module.get(&absolute[..n]).copied())
        };
        named(&file.path, &file.text)
            .into_iter()
            .filter_map(|named| target(named.path))
            .filter(|to| sources[*to].path != file.path)
            .collect()
    };
    sources.iter().map(imports).collect()
}

/// For each file, the file itself and all files reachable from it.
fn reached(edges: &[BTreeSet<usize>]) -> Vec<BTreeSet<usize>> {
    let from = |start: usize| {
        let mut seen = BTreeSet::from([start]);
        let mut open = vec![start];
        while let Some(i) = open.pop() {
            open.extend(edges[i].iter().copied().filter(|to| seen.insert(*to)));
        }
        seen
    };
    (0..edges.len()).map(from).collect()
}
