//! Entries of a list of completions.

use gen_lsp_types::{
    CompletionItem, CompletionItemKind, CompletionItemTextEdit, InsertTextFormat, TextEdit,
};

use crate::rapid::names::{Declaration, DeclarationId, Kind, RoutineKind, Storage};
use crate::rapid::text::Span;
use crate::tool::lsp::cursor::Cursor;
use crate::tool::lsp::scope::Scope;
use crate::tool::lsp::signature::signature;

/// A completion.
pub(super) struct Entry {
    pub(super) label: String,
    pub(super) rank: Rank,
    pub(super) what: What,
    /// What is inserted: text, and the same with places to fill in.
    pub(super) snippet: Option<String>,
}

/// Whether the client can fill in the places of a snippet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::tool::lsp) enum Form {
    /// It can.
    Snippet,
    /// It inserts text.
    #[default]
    Plain,
}

/// What a completion is.
pub(super) enum What {
    /// A declaration of a file or a predefined one.
    Declared(DeclarationId),
    /// A predefined constant.
    Constant,
    /// An instruction whose declaration is not known.
    Instruction,
    /// A function whose declaration is not known.
    Function,
    /// A reserved word.
    Keyword,
}

/// The order of completions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Rank {
    /// What has the type that is needed.
    Fitting,
    /// What has a type that stands for the same.
    Alike,
    /// What has one of these types and is predefined.
    FittingBuiltIn,
    /// Names of the program.
    Own,
    /// Reserved words.
    Keyword,
    /// Predefined names.
    BuiltIn,
}

impl Entry {
    pub(super) fn keyword(word: &str, snippet: Option<&str>) -> Entry {
        Entry {
            label: word.to_owned(),
            rank: Rank::Keyword,
            what: What::Keyword,
            snippet: snippet.filter(|snippet| *snippet != word).map(str::to_owned),
        }
    }

    pub(super) fn order(&self) -> (String, Rank) {
        (self.label.to_lowercase(), self.rank)
    }

    /// The item of the protocol, which replaces the word at the cursor.
    pub(super) fn item(self, scope: &Scope<'_>, cursor: &Cursor<'_>, form: Form) -> CompletionItem {
        let span = Span { file: scope.view.file, start: cursor.start, end: cursor.byte };
        let range = scope.view.positions().range(span);
        let snippet = self.snippet.filter(|_| form == Form::Snippet);
        let format = snippet.as_ref().map(|_| InsertTextFormat::Snippet);
        let detail = match self.what {
            What::Declared(id) => Some(signature(scope.view.project, scope.declared(id)).text),
            _ => None,
        };
        let new_text = snippet.unwrap_or_else(|| self.label.clone());
        CompletionItem {
            kind: Some(match self.what {
                What::Declared(id) => kind(scope.names.declaration(id)),
                What::Constant => CompletionItemKind::Constant,
                What::Instruction | What::Function => CompletionItemKind::Function,
                What::Keyword => CompletionItemKind::Keyword,
            }),
            sort_text: Some(format!("{}{}", self.rank as u8, self.label.to_lowercase())),
            label: self.label,
            detail,
            insert_text_format: format,
            text_edit: Some(CompletionItemTextEdit::TextEdit(TextEdit { range, new_text })),
            ..CompletionItem::default()
        }
    }
}

fn kind(declaration: &Declaration) -> CompletionItemKind {
    match declaration.kind {
        Kind::Module => CompletionItemKind::Module,
        Kind::Record | Kind::Alias | Kind::Basic(_) => CompletionItemKind::Struct,
        Kind::Component => CompletionItemKind::Field,
        Kind::Data(Storage::Const) => CompletionItemKind::Constant,
        Kind::Data(Storage::Pers | Storage::Var) | Kind::Parameter(_) | Kind::Counter => {
            CompletionItemKind::Variable
        }
        Kind::Routine(RoutineKind::Trap) => CompletionItemKind::Event,
        Kind::Routine(RoutineKind::Func | RoutineKind::Proc) => CompletionItemKind::Function,
        Kind::Label => CompletionItemKind::Reference,
    }
}
