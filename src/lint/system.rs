//! What a backup says of its controller, as far as rules ask for it.

use crate::robot::system_parameters::section;
use crate::text::{FileId, SourceFile, Span};

/// The configuration of a controller.
#[derive(Clone, Debug)]
pub struct System {
    /// `EIO.cfg`, with its place among the files.
    pub io: Option<FileId>,
    /// Text of `MOC.cfg`, if the backup has one.
    pub motion: Option<String>,
}

/// A signal of `EIO.cfg`.
#[derive(Clone, Debug)]
pub struct ConfiguredSignal {
    /// Its name.
    pub name: String,
    /// Its label.
    pub label: String,
    /// Where its name stands.
    pub span: Span,
}

impl System {
    /// The signals of the configuration.
    pub fn signals(&self, files: &[SourceFile]) -> Vec<ConfiguredSignal> {
        let Some(file) = self.io.map(|id| &files[id.0 as usize]) else { return Vec::new() };
        let text = file.charset.decode(&file.bytes);
        let entries = section(&text, "EIO_SIGNAL");
        let signal = |entry: &crate::robot::system_parameters::Entry| {
            let name = entry.get("name")?.clone();
            let label = entry.get("label").cloned().unwrap_or_default();
            let at = file.bytes.windows(name.len()).position(|w| w == name.as_bytes())?;
            let span = Span { file: file.id, start: at as u32, end: (at + name.len()) as u32 };
            Some(ConfiguredSignal { name, label, span })
        };
        entries.iter().filter_map(signal).collect()
    }

    /// How often the configuration names a signal.
    pub fn mentions(&self, files: &[SourceFile], name: &str) -> usize {
        let Some(file) = self.io.map(|id| &files[id.0 as usize]) else { return 0 };
        let quoted = format!("\"{name}\"");
        file.bytes.windows(quoted.len()).filter(|w| *w == quoted.as_bytes()).count()
    }
}
