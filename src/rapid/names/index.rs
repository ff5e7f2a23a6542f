//! The index of names.

use std::collections::HashMap;

use super::declaration::{Declaration, DeclarationId, Kind, Reach};
use super::keys::{Key, KeyMap, Keys};
use super::predefined::{self, PREDEFINED};
use super::uses::{Meaning, Use};
use crate::rapid::builtins::OTHERS;
use crate::rapid::text::{FileId, Span};

/// What the names of the files of one task mean.
pub struct Names {
    pub(super) keys: Keys,
    pub(super) declarations: Vec<Declaration>,
    /// The first declaration in each name's scope.
    pub(super) global: KeyMap<DeclarationId>,
    /// The names of each module, LOCAL and global ones.
    pub(super) local: HashMap<(DeclarationId, Key), DeclarationId>,
    /// The identifiers of each file, in the order of the text.
    pub(super) uses: Vec<(FileId, Vec<Use>)>,
    /// The number of predefined declarations, which come first.
    pub(super) predefined: u32,
}

impl Names {
    /// A declaration.
    #[must_use]
    pub fn declaration(&self, id: DeclarationId) -> &Declaration {
        &self.declarations[id.0 as usize]
    }

    /// The name of a declaration in lower case.
    #[must_use]
    pub fn key(&self, id: DeclarationId) -> &str {
        self.keys.text(self.declaration(id).key)
    }

    /// The name of a predefined declaration as RAPID writes it; `None` for one of a file.
    #[must_use]
    pub fn predefined_name(&self, id: DeclarationId) -> Option<&'static str> {
        self.is_predefined(id).then(|| predefined::text(self.declaration(id).name))
    }

    /// Whether a routine is predefined and may have optional parameters that are not declared.
    #[must_use]
    pub fn has_other_parameters(&self, routine: DeclarationId) -> bool {
        self.is_predefined(routine) && self.inside(routine).any(|id| self.key(id) == OTHERS)
    }

    /// Whether it is predefined and has no place in a file.
    #[must_use]
    pub fn is_predefined(&self, id: DeclarationId) -> bool {
        id.0 < self.predefined
    }

    /// The predefined types, data and routines.
    #[cfg(feature = "lsp")]
    pub fn built_ins(&self) -> impl Iterator<Item = DeclarationId> + '_ {
        self.siblings(0, self.predefined).flat_map(|module| self.inside(module))
    }

    /// The text of a whole predefined declaration; `None` for one of a file.
    #[cfg(feature = "lsp")]
    #[must_use]
    pub fn built_in_text(&self, id: DeclarationId) -> Option<&'static str> {
        self.is_predefined(id).then(|| predefined::text(self.declaration(id).whole))
    }

    /// The modules of all files, in order; of a file with declarations outside modules, the file.
    pub fn modules(&self) -> impl Iterator<Item = DeclarationId> + '_ {
        self.siblings(self.predefined, self.declarations.len() as u32)
    }

    /// The declarations directly inside another, in the order of the text.
    pub fn inside(&self, id: DeclarationId) -> impl Iterator<Item = DeclarationId> + '_ {
        self.siblings(id.0 + 1, self.declaration(id).end)
    }

    fn siblings(&self, first: u32, end: u32) -> impl Iterator<Item = DeclarationId> + '_ {
        let mut next = first;
        std::iter::from_fn(move || {
            let id = DeclarationId(next);
            (next < end).then(|| {
                next = self.declaration(id).end;
                id
            })
        })
    }

    /// The identifiers of a file, in the order of the text.
    #[must_use]
    pub fn uses(&self, file: FileId) -> &[Use] {
        let found = self.uses.iter().find(|(id, _)| *id == file);
        found.map_or(&[], |(_, uses)| uses)
    }

    /// The identifier at a byte of a file.
    #[must_use]
    pub fn at(&self, file: FileId, byte: u32) -> Option<&Use> {
        let uses = self.uses(file);
        let after = uses.partition_point(|one| one.start <= byte);
        uses.get(after.checked_sub(1)?).filter(|one| byte < one.end)
    }

    /// All places where a declaration is named, its own included, in the order of the files.
    #[cfg(feature = "internals")]
    pub fn references(&self, id: DeclarationId) -> impl Iterator<Item = Span> + '_ {
        self.uses.iter().flat_map(move |(file, uses)| {
            let named = uses.iter().filter(move |one| one.meaning == Meaning::Declared(id));
            named.map(|one| Span { file: *file, start: one.start, end: one.end })
        })
    }

    /// The declarations of the files that are visible at a byte, from the innermost scope. A hidden
    /// one is not among them.
    #[must_use]
    pub fn visible(&self, file: FileId, byte: u32) -> Vec<DeclarationId> {
        let around = |id: &DeclarationId| {
            let Span { file: own, start, end } = self.declaration(*id).whole;
            own == file && start <= byte && byte < end
        };
        let module = self.modules().find(around);
        let routine = module.and_then(|id| self.inside(id).find(around));
        let of_routine: Vec<DeclarationId> =
            routine.into_iter().flat_map(|id| self.inside(id)).collect();
        let (counters, others): (Vec<DeclarationId>, Vec<DeclarationId>) =
            of_routine.into_iter().partition(|id| self.declaration(*id).kind == Kind::Counter);
        // The innermost loop begins last.
        let counters = counters.into_iter().rev().filter(around);
        let in_routine = counters.chain(others);
        let in_module = module.into_iter().flat_map(|id| self.inside(id));
        let elsewhere = self.modules().filter(|id| Some(*id) != module);
        let global = elsewhere.flat_map(|id| self.inside(id));
        let global = global.filter(|id| self.declaration(*id).reach != Reach::Local);
        let mut seen = std::collections::HashSet::new();
        let mut all: Vec<DeclarationId> = in_routine.chain(in_module).chain(global).collect();
        all.retain(|id| seen.insert(self.declaration(*id).key));
        all
    }

    /// The predefined declaration of a name in lower case.
    #[must_use]
    pub fn predefined(name: &str) -> Option<DeclarationId> {
        let key = PREDEFINED.collected.keys.find(name)?;
        PREDEFINED.by_name.get(key)
    }

    /// The module that contains a declaration.
    #[must_use]
    pub fn module_of(&self, id: DeclarationId) -> Option<DeclarationId> {
        let mut at = id;
        while let Some(parent) = self.declaration(at).parent {
            at = parent;
        }
        (self.declaration(at).kind == Kind::Module).then_some(at)
    }

    /// The type of this name in a module.
    pub(super) fn find_type(
        &self,
        module: Option<DeclarationId>,
        key: Key,
    ) -> Option<DeclarationId> {
        let local = module.and_then(|module| self.local.get(&(module, key)).copied());
        let found = [local, self.global.get(key), PREDEFINED.by_name.get(key)];
        found.into_iter().flatten().find(|id| {
            matches!(self.declaration(*id).kind, Kind::Record | Kind::Alias | Kind::Basic(_))
        })
    }

    /// What a type stands for: a record or a basic type. `None` for an unknown one and for aliases
    /// that form a circle.
    #[must_use]
    pub fn base(&self, id: DeclarationId) -> Option<DeclarationId> {
        let mut at = id;
        // More steps than declarations are a circle.
        for _ in 0..self.declarations.len() {
            let declaration = self.declaration(at);
            match declaration.kind {
                Kind::Alias => at = declaration.value.declaration?,
                Kind::Record | Kind::Basic(_) => return Some(at),
                _ => return None,
            }
        }
        None
    }
}
