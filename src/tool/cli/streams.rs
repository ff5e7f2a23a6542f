//! The streams of an earlier retrofit in a program.

use std::path::PathBuf;

use anyhow::bail;
use memchr::memmem;

use super::input::Input;
use super::{backinfo, listing};
use crate::rapid::text::SourceFile;
use crate::tool::retrofit::{
    BRAKE_NOTE, OutputKind, Retrofit, is_streams, prefix, without_streams,
};

/// The additions of a retrofit to a program.
#[derive(Clone, Debug, Default)]
pub(super) struct Streams {
    /// The modules of streams.
    pub(super) modules: Vec<PathBuf>,
    /// Data that the user stated in them: name without prefix, and text.
    stated: Vec<(&'static str, Vec<u8>)>,
}

/// Data of a module of streams that the user states on the controller.
const STATED: [&str; 2] = ["RobotType", "SerialNo"];

/// Removes the streams from a program.
pub(super) fn remove_streams(input: &mut Input) -> anyhow::Result<Streams> {
    let mut streams = Streams::default();
    let mut prefixes: Vec<String> = Vec::new();
    let mut names: Vec<String> = Vec::new();
    for file in input.files.iter().filter(|file| is_streams(&file.source.bytes)) {
        let bytes = &file.source.bytes;
        streams.modules.push(PathBuf::from(&file.source.path));
        names.extend(file.relative.rsplit('/').next().map(str::to_owned));
        prefixes.extend(prefix(bytes).filter(|prefix| !prefixes.contains(prefix)));
        for name in STATED {
            // Text that joulepath itself stated is also in the header of the module.
            let text = string_value(bytes, name).map(|at| bytes[at].to_vec());
            let text = text.filter(|text| !text.is_empty() && !is_in_header(bytes, text));
            streams.stated.extend(text.map(|text| (name, text)));
        }
    }
    if streams.modules.is_empty() {
        bail!(
            "no streams of joulepath are among these files, so there is nothing to refresh: name the \
             folder of a retrofitted program, with its module of streams, or make one with \
             joulepath optimize"
        );
    }
    let beside = |path: &PathBuf| Some(path.parent()?.join(BRAKE_NOTE));
    let notes: Vec<PathBuf> = streams.modules.iter().filter_map(beside).collect();
    streams.modules.extend(notes.into_iter().filter(|note| note.is_file()));
    input.files.retain(|file| !is_streams(&file.source.bytes));
    for file in &mut input.files {
        for prefix in &prefixes {
            let bytes = without_streams(&file.source, prefix);
            let SourceFile { id, path, utf16, .. } = file.source.clone();
            file.source = SourceFile { utf16, ..SourceFile::new(id, path, bytes) };
        }
    }
    for listing in &mut input.listings {
        listing.bytes = listing::without(&listing.bytes, &names);
        listing.modules.retain(|path| !streams.modules.contains(&PathBuf::from(path)));
    }
    for information in &mut input.information {
        information.bytes = backinfo::without(&information.bytes, &names);
    }
    Ok(streams)
}

impl Streams {
    /// Copies the data that the user stated into the new modules.
    pub(super) fn restore_stated_data(&self, result: &mut Retrofit) {
        for file in result.outputs.iter_mut().filter(|file| file.kind == OutputKind::New) {
            for (name, text) in &self.stated {
                if let Some(at) = string_value(&file.bytes, name) {
                    file.bytes.splice(at, text.iter().copied());
                }
            }
        }
    }
}

/// The range of the value of a string datum in a module text.
fn string_value(bytes: &[u8], name: &str) -> Option<std::ops::Range<usize>> {
    let begin = format!("{name}:=\"").into_bytes();
    let start = memmem::find(bytes, &begin)? + begin.len();
    let length = bytes[start..].iter().position(|b| *b == b'"')?;
    Some(start..start + length)
}

/// Whether the header comment of a module contains a text.
fn is_in_header(bytes: &[u8], text: &[u8]) -> bool {
    let lines = bytes.split(|b| *b == b'\n').skip(1);
    let mut head = lines.take_while(|line| line.trim_ascii_start().starts_with(b"!"));
    head.any(|line| memmem::find(line, text).is_some())
}
