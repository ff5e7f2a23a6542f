//! RAPID cannot read back the load and some settings. The program records them itself, after each
//! statement that changes them.

use super::files::Source;
use super::guards::one_line;
use crate::rapid::builtins::{self, Effect, Setting, instruction};
use crate::rapid::ir::hir::{Arg, ArgKind, Block, Call, Callee, Expr, Routine, Stmt, StmtKind};
use crate::rapid::ir::program::{Program, Symbol};
use crate::rapid::text::{Charset, Edit, Span, charset};
use crate::tool::emit::{Names, Recorded};

/// The effect of a statement.
enum Change {
    /// Turns a setting on or off.
    Switch(&'static str, bool),
    /// Sets the load.
    Load(Span),
}

/// The insertions that record these effects.
pub(super) fn recorded(program: &Program, files: &[Source], names: &Names) -> Recorded {
    let mut found = StateChangeCollector { program, module: 0, changes: Vec::new() };
    for (m, module) in program.modules.iter().enumerate() {
        found.module = m;
        for block in module.routines.iter().flat_map(Routine::blocks) {
            found.block(block);
        }
    }
    let mut switches: Vec<&'static str> = Vec::new();
    for (_, change) in &found.changes {
        if let Change::Switch(name, true) = change
            && !switches.contains(name)
        {
            switches.push(name);
        }
    }
    let charsets: Vec<Charset> = files.iter().map(|file| charset(&file.file.bytes)).collect();
    let mut recorded = Recorded { switches, load: false, edits: Vec::new() };
    for (place, change) in &found.changes {
        let text = match change {
            Change::Load(load) => {
                recorded.load = true;
                format!(" {}Load:={};", names.prefix, one_line(files, *load))
            }
            Change::Switch(name, on) if recorded.switches.contains(name) => {
                format!(" {}{name}:={};", names.prefix, if *on { "TRUE" } else { "FALSE" })
            }
            // A setting that is never on needs no record.
            Change::Switch(..) => continue,
        };
        let charset = charsets[place.end.file.0 as usize];
        let insertion = |at: u32, text: String| Edit {
            span: Span { start: at, end: at, ..place.end },
            text: charset.encode(&text).unwrap_or_else(|| text.into_bytes()),
        };
        if let Some(condition) = place.compact {
            recorded.edits.push(insertion(condition.end, " THEN".to_owned()));
            recorded.edits.push(insertion(place.end.end, format!("{text} ENDIF")));
        } else {
            recorded.edits.push(insertion(place.end.end, text));
        }
    }
    recorded
}

/// The place of a record.
struct Place {
    /// The statement.
    end: Span,
    /// The condition of the enclosing compact IF, which holds only one statement.
    compact: Option<Span>,
}

struct StateChangeCollector<'p> {
    program: &'p Program,
    module: usize,
    changes: Vec<(Place, Change)>,
}

impl StateChangeCollector<'_> {
    fn block(&mut self, block: &Block) {
        for stmt in block {
            self.statement(stmt, None);
            match &stmt.kind {
                // A compact IF ends with its statement, the long form with ENDIF.
                StmtKind::If { branches, otherwise: None }
                    if branches.len() == 1
                        && branches[0].1.last().is_some_and(|l| l.span.end == stmt.span.end) =>
                {
                    for inner in &branches[0].1 {
                        self.statement(inner, Some(branches[0].0.span));
                    }
                }
                other => {
                    for inner in other.blocks() {
                        self.block(inner);
                    }
                }
            }
        }
    }

    fn statement(&mut self, stmt: &Stmt, compact: Option<Span>) {
        if let StmtKind::Call(call) = &stmt.kind
            && let Callee::Name(name) = &call.callee
            && self.program.resolve(self.module, &name.key).is_none()
        {
            for change in changes(self.program, self.module, &name.key, call) {
                self.changes.push((Place { end: stmt.span, compact }, change));
            }
        }
    }
}

/// The effects of an instruction of `module`.
fn changes(program: &Program, module: usize, key: &str, call: &Call) -> Vec<Change> {
    let Some(instruction) = instruction(key) else { return Vec::new() };
    let first = call.args.iter().find_map(Arg::positional);
    let name = first.and_then(Expr::base).map(|name| name.key.as_str());
    match instruction.effect {
        Effect::Setting(Setting::GripLoad) => {
            let data = match name.and_then(|name| program.resolve(module, name)) {
                Some(Symbol::Data(id)) => Some(program.data(id).type_name.key.as_str()),
                _ => name.filter(|name| *name == "load0").map(|_| "loaddata"),
            };
            let is_by_name = call.args.iter().any(|arg| matches!(arg.kind, ArgKind::Optional(..)));
            match (instruction.name, data, first) {
                // The name of the object is computed.
                _ if is_by_name => vec![Change::Switch(instruction.name, true)],
                ("GripLoad", _, Some(load)) | (_, Some("loaddata"), Some(load)) => {
                    vec![Change::Load(load.span)]
                }
                (_, Some("tooldata" | "wobjdata"), _) => Vec::new(),
                _ => vec![Change::Switch(instruction.name, true)],
            }
        }
        Effect::Setting(Setting::MotionProcessMode) => {
            let is_on = name != Some("optimal_cycle_time_mode");
            vec![Change::Switch(instruction.name, is_on)]
        }
        Effect::Unmodelled => vec![Change::Switch(instruction.name, true)],
        Effect::Ends(ended) => {
            let ended = ended.iter().filter_map(|key| builtins::instruction(key));
            ended.map(|ended| Change::Switch(ended.name, false)).collect()
        }
        _ => Vec::new(),
    }
}
