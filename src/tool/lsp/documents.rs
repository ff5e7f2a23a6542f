//! The open documents.

use std::collections::BTreeMap;

use gen_lsp_types::{
    TextDocumentContentChangeEvent, TextDocumentContentChangePartial as Partial,
    TextDocumentContentChangeWholeDocument as Whole,
};

use super::position::{Positions, Units};
use super::uri::{path_of, shown, uri_of};
use crate::rapid::text::{FileId, SourceFile};

/// The open documents by path.
#[derive(Default)]
pub(super) struct Documents {
    open: BTreeMap<String, Document>,
}

/// A document with the URI that the client gave it.
struct Document {
    uri: String,
    file: SourceFile,
}

impl Documents {
    pub(super) fn open(&mut self, uri: &str, text: String) {
        let path = shown(&path_of(uri));
        let file = SourceFile::new(FileId(0), path.clone(), text.into_bytes());
        self.open.insert(path, Document { uri: uri.to_owned(), file });
    }

    pub(super) fn close(&mut self, uri: &str) {
        self.open.remove(&shown(&path_of(uri)));
    }

    /// Changes a range of a document, or the whole text if the range ends before its start.
    pub(super) fn change(
        &mut self,
        uri: &str,
        change: TextDocumentContentChangeEvent,
        units: Units,
    ) {
        let Some(Document { file, .. }) = self.open.get_mut(&shown(&path_of(uri))) else { return };
        let bytes = match change {
            TextDocumentContentChangeEvent::TextDocumentContentChangePartial(Partial {
                range,
                text,
                ..
            }) => {
                let positions = Positions::new(file, units);
                let (start, end) = (positions.byte(range.start), positions.byte(range.end));
                if start <= end {
                    let before = &file.bytes[..start as usize];
                    [before, text.as_bytes(), &file.bytes[end as usize..]].concat()
                } else {
                    text.into_bytes()
                }
            }
            TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(Whole {
                text,
            }) => text.into_bytes(),
        };
        *file = SourceFile::new(FileId(0), file.path.clone(), bytes);
    }

    pub(super) fn get(&self, uri: &str) -> Option<&SourceFile> {
        self.open.get(&shown(&path_of(uri))).map(|document| &document.file)
    }

    /// The open documents with their URIs, in the order of their paths.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, &SourceFile)> {
        self.open.values().map(|document| (document.uri.as_str(), &document.file))
    }

    /// The URI of a file: as the client gave it, if it is open.
    pub(super) fn uri(&self, path: &str) -> String {
        self.open.get(path).map_or_else(|| uri_of(path), |document| document.uri.clone())
    }
}
