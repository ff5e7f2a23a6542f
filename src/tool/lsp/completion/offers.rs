//! The entries for what may stand at the cursor.

use super::item::{Entry, Rank, What};
use super::keywords::{DECLARATIONS, STATEMENTS, VALUES};
use super::wanted::{Wanted, is_function};
use crate::rapid::builtins::{self, function, instruction, routine_names};
use crate::rapid::names::{Basic, DeclarationId, Kind, Mode, Names, RoutineKind, ValueType};
use crate::rapid::syntax::TokenKind;
use crate::tool::lsp::cursor::Cursor;
use crate::tool::lsp::scope::{Fit, Scope};
use crate::tool::lsp::signature::name;
use crate::tool::lsp::tokens::token_at;

pub(super) fn offers(scope: &Scope<'_>, cursor: &Cursor<'_>, wanted: &Wanted) -> Vec<Entry> {
    let offers = Offers { scope, cursor };
    match wanted {
        Wanted::Nothing => Vec::new(),
        Wanted::These(ids) => ids.iter().map(|id| offers.option_or_component(*id)).collect(),
        Wanted::Type(words) => {
            let types = offers.declared(|kind| match kind {
                Kind::Record | Kind::Alias => true,
                Kind::Basic(basic) => !matches!(basic, Basic::Any | Basic::Number),
                _ => false,
            });
            types.into_iter().chain(keywords(words)).collect()
        }
        Wanted::Words(words) => {
            let mut entries: Vec<Entry> = keywords(words).collect();
            if words.contains(&"THEN") {
                entries.extend(offers.procedures());
            }
            entries
        }
        Wanted::Label => offers.declared(|kind| kind == Kind::Label),
        Wanted::Trap => offers.declared(|kind| kind == Kind::Routine(RoutineKind::Trap)),
        Wanted::Statement => {
            let mut entries = offers.procedures();
            let data = |kind| matches!(kind, Kind::Data(_) | Kind::Parameter(_));
            entries.extend(offers.declared(data));
            let words = STATEMENTS.iter();
            entries.extend(words.map(|(word, snippet)| Entry::keyword(word, Some(snippet))));
            entries
        }
        Wanted::Value(of_type) => offers.values(*of_type),
    }
}

fn keywords<'w>(words: &'w [&'w str]) -> impl Iterator<Item = Entry> + 'w {
    words.iter().map(|word| {
        let known = DECLARATIONS.iter().find(|(known, _)| known == word);
        Entry::keyword(word, known.map(|(_, snippet)| *snippet))
    })
}

struct Offers<'o, 'v> {
    scope: &'o Scope<'v>,
    cursor: &'o Cursor<'o>,
}

impl Offers<'_, '_> {
    /// The visible declarations of some kinds, then the predefined ones.
    fn declared(&self, wanted: impl Fn(Kind) -> bool) -> Vec<Entry> {
        let names = self.scope.names;
        let own = self.scope.visible.iter().copied();
        own.chain(names.built_ins())
            .filter(|id| wanted(names.declaration(*id).kind) && !names.key(*id).is_empty())
            .map(|id| self.entry(id, None))
            .collect()
    }

    fn entry(&self, id: DeclarationId, snippet: Option<String>) -> Entry {
        let built_in = self.scope.names.is_predefined(id);
        Entry {
            label: name(self.scope.view.project, self.scope.declared(id)),
            rank: if built_in { Rank::BuiltIn } else { Rank::Own },
            what: What::Declared(id),
            snippet,
        }
    }

    fn option_or_component(&self, id: DeclarationId) -> Entry {
        let declaration = self.scope.names.declaration(id);
        let is_option = matches!(declaration.kind, Kind::Parameter(_));
        let switch = declaration.value.declaration == Names::predefined("switch");
        let mut entry = self.entry(id, None);
        if is_option && !switch {
            entry.snippet = Some(format!("{}:=${{1}}", entry.label));
        }
        Entry { rank: Rank::Fitting, ..entry }
    }

    /// The procedures, with their required arguments.
    fn procedures(&self) -> Vec<Entry> {
        let mut entries = self.declared(|kind| kind == Kind::Routine(RoutineKind::Proc));
        let whole = self.cursor.is_at_line_end();
        for entry in &mut entries {
            if let What::Declared(id) = entry.what
                && whole
            {
                entry.snippet = Some(call(&entry.label, &self.required(id)));
            }
        }
        for label in routine_names() {
            let Some(known) = instruction(&label.to_lowercase()) else { continue };
            let required: Vec<String> =
                (0..).map_while(|n| known.parameter(n)).map(str::to_owned).collect();
            entries.push(Entry {
                label: label.to_owned(),
                rank: Rank::BuiltIn,
                what: What::Instruction,
                snippet: whole.then(|| call(label, &required)),
            });
        }
        entries
    }

    /// The names of the required parameters.
    fn required(&self, routine: DeclarationId) -> Vec<String> {
        let names = self.scope.names;
        let is_required = |id: &DeclarationId| {
            matches!(names.declaration(*id).kind, Kind::Parameter(Mode { group: None, .. }))
        };
        let required = names.inside(routine).filter(is_required);
        required.map(|id| name(self.scope.view.project, self.scope.declared(id))).collect()
    }

    /// Data, functions and words that form values. Those of the type that is needed come first.
    fn values(&self, of_type: ValueType) -> Vec<Entry> {
        let names = self.scope.names;
        let is_value = |kind| {
            is_function(kind) || matches!(kind, Kind::Data(_) | Kind::Parameter(_) | Kind::Counter)
        };
        let mut entries = self.declared(is_value);
        let before_list = self.next() == Some(TokenKind::LeftParen);
        for entry in &mut entries {
            let What::Declared(id) = entry.what else { continue };
            let declaration = names.declaration(id);
            entry.rank = fitting(entry.rank, self.scope.fit(of_type, declaration.value));
            if is_function(declaration.kind) && !before_list {
                entry.snippet = Some(function_call(&entry.label, &self.required(id)));
            }
        }
        entries.extend(self.constants(of_type));
        for label in routine_names().filter(|name| function(&name.to_lowercase()).is_some()) {
            entries.push(Entry {
                label: label.to_owned(),
                rank: Rank::BuiltIn,
                what: What::Function,
                snippet: (!before_list).then(|| format!("{label}($1)")),
            });
        }
        entries.extend(VALUES.iter().map(|word| Entry::keyword(word, None)));
        entries
    }

    /// The predefined speeds and zones.
    fn constants(&self, of_type: ValueType) -> impl Iterator<Item = Entry> {
        let speeds = builtins::speeds().map(|speed| format!("v{speed}"));
        let zones = builtins::zones().map(|(zone, _)| zone.to_owned());
        let others = ["fine", "vmax", "tool0", "wobj0", "load0", "pi"].map(str::to_owned);
        speeds.chain(zones).chain(others).map(move |label| {
            let type_name = builtins::predefined(&label).map_or("", |data| data.type_name);
            let fit = self.scope.fit(of_type, self.scope.of_type(type_name));
            let rank = fitting(Rank::BuiltIn, fit);
            Entry { label, rank, what: What::Constant, snippet: None }
        })
    }

    /// The kind of the token behind the cursor.
    fn next(&self) -> Option<TokenKind> {
        let tokens = self.cursor.module.parse().tree.tokens();
        let at = token_at(tokens, self.cursor.byte);
        (at < tokens.count()).then(|| tokens.kind(at))
    }
}

fn fitting(rank: Rank, fit: Fit) -> Rank {
    match (rank, fit) {
        (rank, Fit::Other) => rank,
        (Rank::BuiltIn, _) => Rank::FittingBuiltIn,
        (_, Fit::Same) => Rank::Fitting,
        (_, Fit::Alike) => Rank::Alike,
    }
}

/// A call with places for its arguments.
fn call(name: &str, required: &[String]) -> String {
    if required.is_empty() { format!("{name};") } else { format!("{name} {};", places(required)) }
}

fn function_call(name: &str, required: &[String]) -> String {
    format!("{name}({})", places(required))
}

fn places(required: &[String]) -> String {
    let places = required.iter().enumerate().map(|(n, name)| format!("${{{}:{name}}}", n + 1));
    places.collect::<Vec<_>>().join(", ")
}
