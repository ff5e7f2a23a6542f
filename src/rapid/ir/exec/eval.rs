//! Expressions.

use std::sync::Arc;

use super::executor::{Cell, CellId, Executor};
use super::operators::{binary, negated};
use crate::rapid::ir::hir::{BinaryOp, Data, DataKind, Expr, ExprKind, Ident, UnaryOp};
use crate::rapid::ir::predefined;
use crate::rapid::ir::program::{DataId, Symbol, Writer};
use crate::rapid::ir::value::{Datum, Dependence, Origin, Value};

/// Largest number of elements of an array; a larger one needs too much memory and time.
const MOST_ELEMENTS: f64 = 1_000_000.0;

impl Executor<'_> {
    /// The value of an expression.
    pub(super) fn eval(&mut self, expr: &Expr) -> Value {
        match &expr.kind {
            ExprKind::Num(x) => Value::constant(Datum::Num(*x), "num"),
            ExprKind::Str(text) => Value::constant(Datum::Text(text.as_str().into()), "string"),
            ExprKind::Bool(b) => Value::constant(Datum::Bool(*b), "bool"),
            ExprKind::Ref(name) => self.read(name),
            ExprKind::Field(base, name) => {
                let base = self.eval(base);
                self.component(&base, name)
            }
            ExprKind::Index(base, indices) => {
                let base = self.eval(base);
                indices.iter().fold(base, |value, index| self.element(value, index))
            }
            ExprKind::Call(name, args) => self.function(expr, name, args),
            ExprKind::Aggregate(items) => {
                let mut origin = Origin::default();
                let mut list = Vec::with_capacity(items.len());
                for item in items {
                    let value = self.eval_level(item);
                    origin.join(&value.origin);
                    list.push(value.datum);
                }
                Value { datum: Datum::List(list), type_key: "".into(), origin }
            }
            ExprKind::Unary(op, operand) => {
                let value = self.eval_level(operand);
                let datum = match (op, value.datum) {
                    (UnaryOp::Plus, datum @ Datum::Num(_)) => datum,
                    (UnaryOp::Minus, Datum::Num(x)) => Datum::Num(-x),
                    (UnaryOp::Minus, Datum::List(items)) => negated(&items, expr),
                    (UnaryOp::Not, Datum::Bool(b)) => Datum::Bool(!b),
                    (UnaryOp::Not, Datum::Num(x)) => Datum::Bool(x == 0.0),
                    (_, unknown @ Datum::Unknown(_)) => unknown,
                    _ => Datum::unknown("the operator does not fit its operand", expr.span),
                };
                Value { datum, type_key: value.type_key, origin: value.origin }
            }
            ExprKind::Binary(op, left, right) => {
                let left = self.eval(left);
                let right = self.eval(right);
                let left = self.level(left);
                let right = self.level(right);
                let mut origin = left.origin.clone();
                origin.join(&right.origin);
                let datum = binary(*op, &left.datum, &right.datum, expr);
                let type_key = match op {
                    BinaryOp::Add | BinaryOp::Sub if &*left.type_key != "num" => left.type_key,
                    BinaryOp::Mul if &*left.type_key == "num" => right.type_key,
                    BinaryOp::Mul => left.type_key,
                    BinaryOp::Add
                    | BinaryOp::Sub
                    | BinaryOp::Div
                    | BinaryOp::IntDiv
                    | BinaryOp::Mod => "num".into(),
                    _ => "bool".into(),
                };
                Value { datum, type_key, origin }
            }
            ExprKind::AnyPosition => {
                Value::unknown("'*' is a position that only the controller knows", expr.span)
            }
            ExprKind::Placeholder => Value::unknown("a placeholder stands here", expr.span),
            ExprKind::Broken => Value::unknown("the expression has a syntax error", expr.span),
        }
    }

    /// The value of an expression; that of a signal is its level.
    pub(super) fn eval_level(&mut self, expr: &Expr) -> Value {
        let value = self.eval(expr);
        self.level(value)
    }

    /// The level of a signal as a number; any other value unchanged.
    pub(super) fn level(&mut self, value: Value) -> Value {
        let Datum::Signal(name) = &value.datum else { return value };
        let key = name.to_lowercase();
        let stated = self.machine.stated_level(&key);
        let level = self.signals.get(&key).copied().or(stated);
        self.seen_input = Some(name.clone());
        if let (None, Some(level)) = (self.signals.get(&key), stated) {
            self.assume(format!("{name} is {level} (stated by --assume)"));
        }
        if level.is_none() {
            self.assume(format!("{name} is 0 (not declared in the program: taken as an input)"));
        }
        Value {
            datum: Datum::Num(level.unwrap_or(0.0)),
            type_key: "num".into(),
            origin: Origin::of(Dependence::Input(name.clone())),
        }
    }

    fn read(&mut self, name: &Ident) -> Value {
        if let Some(cell) = self.cell_of(name) {
            let Cell { value, reading, input, .. } = &self.cells[cell];
            if input.is_some() {
                self.seen_input.clone_from(input);
            }
            // The origin states the name that was read, not the origin of the stored value.
            return Value { origin: reading.clone(), ..value.clone() };
        }
        match self.program.resolve(self.frame().module, &name.key) {
            Some(Symbol::Routine(_)) => {
                Value::unknown(format!("'{}' is a routine", name.text), name.span)
            }
            Some(Symbol::Ambiguous) => Value::unknown(declared_twice(&name.text), name.span),
            _ if name.key == "errno" => Value {
                datum: self.errno.clone().map_or(Datum::Num(0.0), Datum::Text),
                type_key: "errnum".into(),
                origin: Origin::of(Dependence::Variable("ERRNO".into())),
            },
            _ => self
                .system_data(&name.key, name.span)
                .or_else(|| predefined::lookup(&name.key))
                .unwrap_or_else(|| {
                    Value::constant(Datum::Signal(name.text.as_str().into()), "signal")
                }),
        }
    }

    /// The cell of a name: names of the routine hide those of the module, these those of the task.
    pub(super) fn cell_of(&mut self, name: &Ident) -> Option<CellId> {
        let frame = self.frame();
        if let Some((_, cell)) = frame.names.iter().rev().find(|(key, _)| *key == name.key) {
            return Some(*cell);
        }
        match self.program.resolve(frame.module, &name.key)? {
            Symbol::Data(id) => Some(self.global(id)),
            Symbol::Routine(_) | Symbol::Ambiguous => None,
        }
    }

    /// The cell of module data, created at its first use.
    fn global(&mut self, id: DataId) -> CellId {
        if let Some(cell) = self.globals.get(&id) {
            return *cell;
        }
        // Reserved before its value is evaluated, so that a circular definition ends.
        let program = self.program;
        let data = program.data(id);
        let circular = Value::unknown("its value refers to itself", data.span);
        let cell =
            self.new_cell(Cell { read_only: true, ..Cell::new(circular, Origin::default()) });
        self.globals.insert(id, cell);
        self.kept_cells = cell + 1;
        let module = std::mem::replace(&mut self.frame_mut().module, id.module);
        // The initial value is read in the scope of its own module.
        let names = std::mem::take(&mut self.frame_mut().names);
        let value = self.initial_value(data);
        self.frame_mut().names = names;
        self.frame_mut().module = module;
        let name: Arc<str> = data.name.text.as_str().into();
        let trusted = matches!(&*value.type_key, "tooldata" | "wobjdata" | "loaddata");
        let reading = match (data.kind, program.writer(id)) {
            (DataKind::Const, _) | (DataKind::Var, None) => value.origin.clone(),
            // Instructions of controller options only read the tools and frames they get.
            (DataKind::Pers, None | Some(Writer::UnknownCall(_))) if trusted => {
                Origin::of(Dependence::TrustedPersistent(name))
            }
            (DataKind::Pers, _) if !trusted => Origin::of(Dependence::Persistent(name)),
            (_, Some(Writer::UnknownCall(call))) => {
                Origin::of(Dependence::Exposed(name, call.clone()))
            }
            (DataKind::Var, _) => Origin::of(Dependence::Variable(name)),
            (DataKind::Pers, _) => Origin::of(Dependence::Persistent(name)),
        };
        let read_only = data.kind == DataKind::Const;
        self.cells[cell] = Cell { read_only, ..Cell::new(value, reading) };
        cell
    }

    /// The declared value, or the default of the type.
    pub(super) fn initial_value(&mut self, data: &Data) -> Value {
        let mut value = match &data.init {
            Some(expr) => self.eval(expr),
            None if data.kind == DataKind::Pers => Value::unknown(
                format!("'{}' has no value in the source", data.name.text),
                data.name.span,
            ),
            None if !data.dims.is_empty() => {
                let mut datum = self.default_datum(&data.type_name.key, 0);
                let mut elements = 1.0;
                for dim in data.dims.iter().rev() {
                    let n = self.eval(dim).datum.num().unwrap_or(0.0);
                    elements *= n;
                    if !(0.0..=MOST_ELEMENTS).contains(&elements) {
                        return Value::unknown("the array is too large", dim.span);
                    }
                    datum = Datum::List(vec![datum; n as usize]);
                }
                Value::constant(datum, &data.type_name.key)
            }
            None => {
                let datum = self.default_datum(&data.type_name.key, 0);
                Value::constant(datum, &data.type_name.key)
            }
        };
        value.type_key = data.type_name.key.as_str().into();
        value
    }

    /// RAPID's default: 0, FALSE, "", or these in each component.
    fn default_datum(&self, type_key: &str, depth: usize) -> Datum {
        const MAX_RECORD_DEPTH: usize = 16;
        match type_key {
            "bool" => Datum::Bool(false),
            "string" => Datum::Text("".into()),
            _ => match self.program.components(type_key) {
                Some(parts) if depth < MAX_RECORD_DEPTH => Datum::List(
                    parts.iter().map(|(_, ty)| self.default_datum(ty, depth + 1)).collect(),
                ),
                _ => Datum::Num(0.0),
            },
        }
    }

    fn component(&mut self, base: &Value, name: &Ident) -> Value {
        if let Datum::Unknown(_) = base.datum {
            return base.clone();
        }
        let parts = self.program.components(&base.type_key).unwrap_or_default();
        let position = parts.iter().position(|(part, _)| *part == name.key);
        match (&base.datum, position) {
            (Datum::List(items), Some(i)) if i < items.len() => Value {
                datum: items[i].clone(),
                type_key: parts[i].1.as_str().into(),
                origin: base.origin.clone(),
            },
            _ => Value {
                origin: base.origin.clone(),
                ..Value::unknown(format!("no component '{}'", name.text), name.span)
            },
        }
    }

    /// The element of an array.
    fn element(&mut self, base: Value, index: &Expr) -> Value {
        let at = self.eval(index);
        let mut origin = base.origin;
        origin.join(&at.origin);
        let datum = match (base.datum, at.datum) {
            (Datum::List(items), Datum::Num(x)) => {
                let i = x.round();
                if i >= 1.0 && (i as usize) <= items.len() {
                    items[i as usize - 1].clone()
                } else {
                    Datum::unknown(format!("index {i} is outside 1..{}", items.len()), index.span)
                }
            }
            (unknown @ Datum::Unknown(_), _) | (_, unknown @ Datum::Unknown(_)) => unknown,
            _ => Datum::unknown("the index does not fit", index.span),
        };
        Value { datum, type_key: base.type_key, origin }
    }

    /// `target := value`; a target that can't be written stays unchanged and gets a note.
    pub(super) fn assign(&mut self, target: &Expr, value: Value) {
        let value = self.level(value);
        let history = self.history(&value.origin);
        let input = self.seen_input.take().or_else(|| self.deciding.last().cloned());
        let Some(name) = target.base() else {
            return self.unresolved(target.span, "the left side is not data");
        };
        let Some(cell) = self.cell_of(name) else {
            let reason = match self.program.resolve(self.frame().module, &name.key) {
                Some(Symbol::Ambiguous) => declared_twice(&name.text),
                _ => format!("'{}' is not declared", name.text),
            };
            return self.unresolved(name.span, reason);
        };
        if self.cells[cell].read_only {
            return self.unresolved(name.span, format!("'{}' is read only", name.text));
        }
        let changed = self.write(cell, target, value.datum);
        self.cells[cell].input = input;
        if matches!(target.kind, ExprKind::Ref(_)) {
            self.cells[cell].history = history;
        } else {
            self.cells[cell].history.join(&history);
        }
        if changed {
            self.record_change(Some(cell));
        }
    }

    /// The inputs, stored values and robot positions that a value depends on, directly or through
    /// other data.
    pub(super) fn history(&self, origin: &Origin) -> Origin {
        let mut history = Origin::default();
        for dependence in origin.iter() {
            match dependence {
                Dependence::Local(name) | Dependence::Variable(name) => {
                    let key = name.to_lowercase();
                    let names = &self.frame().names;
                    let own = names.iter().rev().find(|(known, _)| *known == key);
                    let cell = own.map(|(_, cell)| *cell).or_else(|| {
                        match self.program.resolve(self.frame().module, &key) {
                            Some(Symbol::Data(id)) => self.globals.get(&id).copied(),
                            _ => None,
                        }
                    });
                    if let Some(cell) = cell {
                        history.join(&self.cells[cell].history);
                    }
                }
                Dependence::Input(_)
                | Dependence::RobotState
                | Dependence::Persistent(_)
                | Dependence::Exposed(..) => history.join(&Origin::of(dependence.clone())),
                Dependence::Inner(_) | Dependence::TrustedPersistent(_) => {}
            }
        }
        history
    }

    /// Writes the part of a cell that `target` names; true if this changed it. A part that is not known
    /// makes all of it unknown.
    pub(super) fn write(&mut self, cell: CellId, target: &Expr, datum: Datum) -> bool {
        let type_key = self.cells[cell].value.type_key.clone();
        let place = self.place(target, &type_key);
        let slot = &mut self.cells[cell].value.datum;
        let changed = if let Some((indices, _)) = place {
            store(slot, &indices, datum)
        } else {
            let name = target.base().map_or("", |name| name.text.as_str());
            let reason = format!("it was written at a place in '{name}' not known");
            *slot = Datum::unknown(reason, target.span);
            true
        };
        self.mark_other_names(cell);
        changed
    }

    /// The component indices of a part of data of this type, outermost first, and its type.
    pub(super) fn place(&mut self, target: &Expr, type_key: &str) -> Option<(Vec<usize>, String)> {
        match &target.kind {
            ExprKind::Field(base, name) => {
                let (mut place, key) = self.place(base, type_key)?;
                let parts = self.program.components(&key)?;
                let i = parts.iter().position(|(part, _)| *part == name.key)?;
                place.push(i);
                Some((place, parts[i].1.clone()))
            }
            ExprKind::Index(base, indices) => {
                let (mut place, key) = self.place(base, type_key)?;
                for index in indices {
                    let i = self.eval(index).datum.num().filter(|i| i.round() >= 1.0)?;
                    place.push(i.round() as usize - 1);
                }
                Some((place, key))
            }
            _ => Some((Vec::new(), type_key.to_owned())),
        }
    }

    /// The first signal that an expression names.
    pub(super) fn first_signal(&mut self, expr: &Expr) -> Option<Arc<str>> {
        match &expr.kind {
            ExprKind::Ref(name) => match self.read(name).datum {
                Datum::Signal(signal) => Some(signal),
                _ => None,
            },
            _ => expr.operands().into_iter().find_map(|operand| self.first_signal(operand)),
        }
    }
}

/// Why a name has no meaning.
pub(super) fn declared_twice(name: &str) -> String {
    format!("'{name}' is declared more than once")
}

/// Writes a part of a value; true if this changed it.
pub(super) fn store(slot: &mut Datum, indices: &[usize], value: Datum) -> bool {
    match indices {
        [] if *slot == value => false,
        [] => {
            *slot = value;
            true
        }
        [first, rest @ ..] => match slot {
            Datum::List(items) => {
                items.get_mut(*first).is_some_and(|item| store(item, rest, value))
            }
            _ => false,
        },
    }
}
