//! The values that a guard compares: the arguments of the replaced movements, evaluated at the
//! start of the stream as the movements would evaluate them.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use super::files::Source;
use super::interrupts::data_of_interrupts;
use super::settings::{Form, Settings};
use super::statements::calls;
use crate::rapid::builtins::{Instruction, instruction, is_controller_specific, is_movement};
use crate::rapid::ir::hir::{Arg, ArgKind, DataKind, Expr, ExprKind, Scope, UnaryOp};
use crate::rapid::ir::movement::Argument;
use crate::rapid::ir::program::{DataId, Program, RoutineId};
use crate::rapid::ir::reads::{Reads, reads};
use crate::rapid::ir::value::Datum;
use crate::rapid::syntax::tokenize;
use crate::rapid::text::Span;
use crate::retime::motion::timeline::Run;
use crate::retime::optimize::reason::Reason;
use crate::tool::emit::{Now, Parameter};

/// The arguments of all movements and waits of a program.
pub(super) struct Guards<'p> {
    program: &'p Program,
    files: &'p [Source],
    arguments: BTreeMap<Span, (RoutineId, &'p Expr)>,
    /// Data that interrupt routines or other tasks may write at any time.
    meanwhile: BTreeSet<DataId>,
    /// Data that interrupt routines may read at any time.
    read_by_interrupts: BTreeSet<DataId>,
    /// Data that other tasks may read; `None`: all global `PERS` data.
    read_elsewhere: Option<BTreeSet<String>>,
    /// Whether movements with inline targets may be replaced.
    inline_targets: bool,
    known: RefCell<BTreeMap<Span, Reads>>,
}

impl<'p> Guards<'p> {
    pub(super) fn new(
        program: &'p Program,
        files: &'p [Source],
        settings: &Settings,
    ) -> Guards<'p> {
        let elsewhere = &settings.written_elsewhere;
        let inline_targets = settings.inline_targets || settings.form == Form::Speeds;
        let mut arguments = BTreeMap::new();
        let [mut meanwhile, read_by_interrupts] = data_of_interrupts(program);
        for (m, module) in program.modules.iter().enumerate() {
            for (index, routine) in module.routines.iter().enumerate() {
                let id = RoutineId { module: m, index };
                for block in routine.blocks() {
                    for (_, name, call) in calls(block) {
                        if is_movement(&name.key)
                            || instruction(&name.key).is_some_and(Instruction::waits_for_time)
                        {
                            let args = call.args.iter();
                            let own = args.filter(|a| !matches!(a.kind, ArgKind::Conditional(..)));
                            let own = own.filter_map(Arg::value);
                            arguments.extend(own.map(|expr| (expr.span, (id, expr))));
                        }
                    }
                }
            }
            for (index, data) in module.data.iter().enumerate() {
                let is_shared = data.kind == DataKind::Pers && data.scope == Scope::Global;
                if is_shared && elsewhere.contains(&data.name.key) {
                    meanwhile.insert(DataId { module: m, index });
                }
            }
        }
        let known = RefCell::default();
        let read_elsewhere = settings.read_elsewhere.clone();
        Guards {
            program,
            files,
            arguments,
            meanwhile,
            read_by_interrupts,
            read_elsewhere,
            inline_targets,
            known,
        }
    }

    /// Why no guard can ensure that a run moves as in the original.
    pub(super) fn refusal(&self, run: &Run) -> Option<Reason> {
        run.moves.iter().enumerate().find_map(|(index, record)| {
            let mut arguments = record.movement.arguments.iter();
            arguments.find_map(|argument| self.objection(argument, index > 0))
        })
    }

    /// Whether a run of several movements has an argument that may raise an error, which would skip
    /// all of them.
    pub(super) fn may_raise(&self, run: &Run) -> bool {
        let arguments = run.moves.iter().flat_map(|record| &record.movement.arguments);
        let may_raise =
            |argument: &Argument| self.reads(argument.span).is_some_and(|reads| reads.may_raise);
        run.moves.len() > 1 && arguments.into_iter().any(may_raise)
    }

    pub(super) fn files(&self) -> &'p [Source] {
        self.files
    }

    /// Whether an interrupt routine or another task may read or write these data at any time.
    pub(super) fn is_seen_meanwhile(&self, id: DataId) -> bool {
        let is_seen = self.meanwhile.contains(&id) || self.read_by_interrupts.contains(&id);
        is_seen || self.is_read_elsewhere(id)
    }

    /// Whether another task may read these data at any time.
    pub(super) fn is_read_elsewhere(&self, id: DataId) -> bool {
        let data = self.program.data(id);
        let is_shared = data.kind == DataKind::Pers && data.scope == Scope::Global;
        is_shared && self.read_elsewhere.as_ref().is_none_or(|names| names.contains(&data.name.key))
    }

    /// Whether the value of an expression in a routine is the same before and during a movement, and
    /// its evaluation changes nothing.
    pub(super) fn is_steady(&self, routine: RoutineId, expr: &Expr) -> bool {
        let reads = reads(self.program, routine, expr);
        reads.effect.is_none()
            && reads.signals.is_empty()
            && reads.data.is_disjoint(&self.meanwhile)
            && (!reads.by_reference || self.meanwhile.is_empty())
    }

    /// Whether the evaluation of an expression in a routine may end in an error.
    pub(super) fn may_raise_at(&self, routine: RoutineId, expr: &Expr) -> bool {
        reads(self.program, routine, expr).may_raise
    }

    /// Why an argument prevents a stream. `later`: it is evaluated during the run, when its value
    /// may differ from the one that the guard compared.
    fn objection(&self, argument: &Argument, later: bool) -> Option<Reason> {
        let Some(reads) = self.reads(argument.span) else {
            return Some(Reason::NotConstant("an argument of it stands in no routine".into()));
        };
        let is_target = matches!(argument.type_name, "robtarget" | "jointtarget");
        if is_target && reads.fixed && !self.inline_targets {
            return Some(Reason::InlineTarget);
        }
        if let Some(effect) = reads.effect {
            return Some(Reason::NotConstant(format!("an argument of it {effect}")));
        }
        if !later {
            return None;
        }
        let meanwhile = |what: &str| {
            Some(Reason::Meanwhile(format!("it depends on {what}, while the robot moves already")))
        };
        if let Some(signal) = reads.signals.iter().next() {
            return meanwhile(&format!("the signal {signal}"));
        }
        if let Some(id) = reads.data.intersection(&self.meanwhile).next() {
            let name = &self.program.data(*id).name.text;
            return meanwhile(&format!("{name}, which an interrupt or another task may write"));
        }
        if reads.by_reference && !self.meanwhile.is_empty() {
            return meanwhile("data of its caller, which an interrupt or another task may write");
        }
        None
    }

    /// The parameters that the guard of a variant compares, with their values; the same parameters
    /// for all variants of a site.
    pub(super) fn parameters(&self, arguments: &[Argument]) -> Vec<(Parameter, Datum)> {
        let mut parameters: Vec<(Parameter, Datum)> = Vec::new();
        for argument in arguments {
            let Some((_, expr)) = self.arguments.get(&argument.span) else { continue };
            if differs_by_controller(expr) {
                continue;
            }
            let text = one_line(self.files, argument.span);
            let parameter = Parameter {
                label: text.clone(),
                now: Now::Argument(text),
                type_name: argument.type_name,
                is_computed: is_computed(expr),
            };
            if !parameters.iter().any(|(known, _)| *known == parameter) {
                parameters.push((parameter, argument.datum.clone()));
            }
        }
        parameters
    }

    fn reads(&self, span: Span) -> Option<Reads> {
        if let Some(known) = self.known.borrow().get(&span) {
            return Some(known.clone());
        }
        let (routine, expr) = self.arguments.get(&span)?;
        let found = reads(self.program, *routine, expr);
        self.known.borrow_mut().insert(span, found.clone());
        Some(found)
    }
}

/// Whether the value of a name depends on the controller.
fn differs_by_controller(expr: &Expr) -> bool {
    let ExprKind::Ref(name) = &expr.kind else { return false };
    is_controller_specific(&name.key)
}

/// Whether the controller computes the value instead of reading it.
fn is_computed(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Ref(_) | ExprKind::Num(_) | ExprKind::Str(_) | ExprKind::Bool(_) => false,
        ExprKind::Field(base, _) | ExprKind::Index(base, _) => is_computed(base),
        ExprKind::Unary(UnaryOp::Minus, number) => !matches!(number.kind, ExprKind::Num(_)),
        ExprKind::Aggregate(items) => items.iter().any(is_computed),
        _ => true,
    }
}

/// The text of an expression without comments and line breaks.
pub(super) fn one_line(files: &[Source], span: Span) -> String {
    let text = files[span.file.0 as usize].file.text(span);
    let tokens = tokenize(text.as_bytes());
    let mut line = String::new();
    for index in (0..tokens.count()).filter(|i| !tokens.kind(*i).is_trivia()) {
        let range = tokens.range(index);
        let word = &text[range.start as usize..range.end as usize];
        let is_word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
        if is_word(line.chars().next_back()) && is_word(word.chars().next()) {
            line.push(' ');
        }
        line.push_str(word);
    }
    line
}
