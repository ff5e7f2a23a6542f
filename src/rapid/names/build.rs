//! Builds the index.

use std::collections::HashMap;

use super::collect::{Bytes, Collected};
use super::declaration::{DeclarationId, Kind, Reach, ValueType};
use super::index::Names;
use super::keys::KeyMap;
use super::predefined::PREDEFINED;
use super::resolve;
use crate::rapid::syntax::Parse;
use crate::rapid::text::SourceFile;

/// A parsed file.
#[derive(Clone, Copy, Debug)]
pub struct SourceText<'a> {
    /// The file.
    pub file: &'a SourceFile,
    /// Its parse.
    pub parse: &'a Parse,
}

impl Names {
    /// Resolves the names of the files of one task. Of several declarations with one name in one
    /// scope the first is taken.
    #[must_use]
    pub fn new(files: &[SourceText<'_>]) -> Names {
        let mut collected: Collected = PREDEFINED.collected.clone();
        let predefined = collected.declarations.len() as u32;
        let mut ranges = Vec::new();
        for source in files {
            let first = collected.declarations.len();
            collected.add(bytes_of(source), source.parse);
            ranges.push(first..collected.declarations.len());
        }
        let Collected { keys, declarations, stated } = collected;
        let mut names = Names {
            keys,
            declarations,
            global: KeyMap::new(),
            local: HashMap::new(),
            uses: Vec::new(),
            predefined,
        };
        names.fill_scopes();
        for (id, key) in stated {
            let found = names.find_type(names.module_of(id), key);
            names.declarations[id.0 as usize].value.declaration = found;
        }
        let num = Names::predefined("num");
        for declaration in &mut names.declarations {
            if declaration.kind == Kind::Counter {
                declaration.value = ValueType { declaration: num, dimensions: 0 };
            }
        }
        for (source, own) in files.iter().zip(ranges) {
            let uses = resolve::uses(&mut names, bytes_of(source), source.parse, own);
            names.uses.push((source.file.id, uses));
        }
        names
    }

    fn fill_scopes(&mut self) {
        for index in self.predefined..self.declarations.len() as u32 {
            let id = DeclarationId(index);
            let declaration = &self.declarations[index as usize];
            let Some(parent) = declaration.parent else { continue };
            if self.declarations[parent.0 as usize].kind != Kind::Module {
                continue;
            }
            self.local.entry((parent, declaration.key)).or_insert(id);
            if declaration.reach != Reach::Local {
                self.global.insert_first(declaration.key, id);
            }
        }
    }
}

fn bytes_of<'a>(source: &SourceText<'a>) -> Bytes<'a> {
    Bytes { file: source.file.id, content: &source.file.bytes, charset: source.file.charset }
}
