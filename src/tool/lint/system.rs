//! The controller configuration in a backup, as far as rules need it.

use crate::arm::robot::system_parameters::section;
use crate::rapid::text::{FileId, SourceFile, Span};

/// The configuration of a controller.
#[derive(Clone, Debug)]
pub struct System {
    /// `EIO.cfg`, as one of the files.
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
    /// Span of its name.
    pub span: Span,
}

impl System {
    /// The signals of the configuration.
    pub fn signals(&self, files: &[SourceFile]) -> Vec<ConfiguredSignal> {
        let Some(file) = self.io.map(|id| &files[id.0 as usize]) else { return Vec::new() };
        let text = file.charset.decode(&file.bytes);
        let entries = section(&text, "EIO_SIGNAL");
        let signal = |entry: &crate::arm::robot::system_parameters::Entry| {
            let name = entry.get("name")?.clone();
            let label = entry.get("label").cloned().unwrap_or_default();
            let quoted = format!("\"{name}\"");
            let at = file.bytes.windows(quoted.len()).position(|w| w == quoted.as_bytes())? + 1;
            let span = Span { file: file.id, start: at as u32, end: (at + name.len()) as u32 };
            Some(ConfiguredSignal { name, label, span })
        };
        entries.iter().filter_map(signal).collect()
    }

    /// Whether the configuration uses a signal outside its declaration.
    pub fn is_tied(&self, files: &[SourceFile], name: &str) -> bool {
        let Some(file) = self.io.map(|id| &files[id.0 as usize]) else { return false };
        let quoted = format!("\"{}\"", name.to_lowercase());
        let text = file.charset.decode(&file.bytes).to_lowercase();
        let mut declares = false;
        text.lines().map(str::trim).any(|line| {
            if line.starts_with('#') {
                declares = false;
            } else if line == "eio_signal:" {
                declares = true;
            }
            !declares && line.contains(&quoted)
        })
    }
}
