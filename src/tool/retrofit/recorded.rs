//! RAPID cannot read back the load and some settings. The program records them itself, after each
//! statement that changes them.

use super::files::Source;
use super::guards::one_line;
use crate::rapid::builtins::{self, Effect, Setting, instruction};
use crate::rapid::ir::hir::{Arg, Block, Call, Callee, Expr, Routine, Stmt, StmtKind};
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
    let mut found: Vec<(Place, Vec<Change>)> = Vec::new();
    for (id, routine) in program.routines() {
        let mut collector = StateChangeCollector { program, module: id.module, routine, found };
        for block in routine.blocks() {
            collector.block(block);
        }
        found = collector.found;
    }
    let mut switches: Vec<&'static str> = Vec::new();
    for change in found.iter().flat_map(|(_, changes)| changes) {
        if let Change::Switch(name, true) = change
            && !switches.contains(name)
        {
            switches.push(name);
        }
    }
    let charsets: Vec<Charset> = files.iter().map(|file| charset(&file.file.bytes)).collect();
    let mut recorded = Recorded { switches, load: false, compared: Vec::new(), edits: Vec::new() };
    for (place, changes) in &found {
        let texts = changes.iter().filter_map(|change| match change {
            Change::Load(load) => {
                recorded.load = true;
                Some(format!(" {}Load:={};", names.prefix, one_line(files, *load)))
            }
            Change::Switch(name, on) if recorded.switches.contains(name) => {
                Some(format!(" {}{name}:={};", names.prefix, if *on { "TRUE" } else { "FALSE" }))
            }
            // A setting that is never on needs no record.
            Change::Switch(..) => None,
        });
        let text: String = texts.collect();
        if text.is_empty() {
            continue;
        }
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
    routine: &'p Routine,
    found: Vec<(Place, Vec<Change>)>,
}

impl StateChangeCollector<'_> {
    fn block(&mut self, block: &Block) {
        for stmt in block {
            self.statement(stmt, None);
            if let Some((condition, only)) = stmt.compact() {
                self.statement(only, Some(condition.span));
                continue;
            }
            for inner in stmt.kind.blocks() {
                self.block(inner);
            }
        }
    }

    fn statement(&mut self, stmt: &Stmt, compact: Option<Span>) {
        if let StmtKind::Call(call) = &stmt.kind
            && let Callee::Name(name) = &call.callee
            && self.program.resolve(self.module, &name.key).is_none()
        {
            let changes = self.changes(&name.key, call);
            self.found.push((Place { end: stmt.span, compact }, changes));
        }
    }

    /// The effects of an instruction.
    fn changes(&self, key: &str, call: &Call) -> Vec<Change> {
        let Some(instruction) = instruction(key) else { return Vec::new() };
        let first = call.args.iter().find_map(Arg::positional);
        let name = first.and_then(Expr::base).map(|name| name.key.as_str());
        let switch = |on: bool| vec![Change::Switch(instruction.name, on)];
        match (instruction.effect, first) {
            (Effect::Setting(Setting::GripLoad), Some(load)) => vec![Change::Load(load.span)],
            // The name of the object is computed.
            (Effect::Setting(Setting::SystemData), _) if call.args.len() > 1 => switch(true),
            (Effect::Setting(Setting::SystemData), Some(data)) => {
                match name.and_then(|name| self.type_of(name)) {
                    Some("loaddata") => vec![Change::Load(data.span)],
                    Some("tooldata" | "wobjdata") => Vec::new(),
                    _ => switch(true),
                }
            }
            (Effect::Setting(Setting::MotionProcessMode), _) => {
                switch(name != Some("optimal_cycle_time_mode"))
            }
            (Effect::Unmodelled, _) => switch(true),
            (Effect::Ends(ended), _) => {
                let ended = ended.iter().filter_map(|key| builtins::instruction(key));
                ended.map(|ended| Change::Switch(ended.name, false)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The type of data: names of the routine hide those of the module.
    fn type_of(&self, name: &str) -> Option<&str> {
        let param = self.routine.params.iter().find(|param| param.name.key == name);
        let local = self.routine.data.iter().find(|data| data.name.key == name);
        let own = param.map(|it| &it.type_name).or(local.map(|it| &it.type_name));
        own.map(|own| own.key.as_str()).or_else(|| match self.program.resolve(self.module, name) {
            Some(Symbol::Data(id)) => Some(self.program.data(id).type_name.key.as_str()),
            Some(_) => None,
            None => builtins::predefined(name).map(|data| data.type_name),
        })
    }
}
