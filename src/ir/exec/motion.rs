//! Movement instructions: from arguments to a [`Movement`].

use super::super::convert;
use super::super::hir::{Arg, ArgKind, Expr, ExprKind, Stmt};
use super::super::instructions::{MoveForm, MoveSignature};
use super::super::movement::{LocalValue, Movement, Stop, Target, Unresolved, Zone};
use super::super::processes;
use super::super::program::Symbol;
use super::super::value::{Datum, Dependence, Origin, Value};
use super::instruction::Arguments;
use super::{Cell, Executor};
use std::fmt::Write;
use std::sync::Arc;

/// Options that a movement may have without changing where or how fast it goes.
const KNOWN_OPTIONS: &[&str] = &[
    "conc",
    "v",
    "t",
    "z",
    "wobj",
    "tload",
    "tool",
    "speed",
    "zone",
    "topoint",
    "tojointpos",
    "cirpoint",
    "noeoffs",
];

impl Executor<'_> {
    pub(super) fn movement(
        &mut self,
        stmt: &Stmt,
        text: &str,
        signature: MoveSignature,
        arguments: &Arguments<'_>,
        args: &[Arg],
    ) {
        if signature.form == MoveForm::ExternalJoint {
            self.external(stmt, text, signature, arguments);
            return;
        }
        let movement = self.resolve(stmt, text, signature, arguments);
        let movement = movement.map_err(|reason| {
            self.unresolved(stmt.span, reason.clone());
            Unresolved { span: stmt.span, reason, moves: true }
        });
        let key = text.to_lowercase();
        if key.starts_with("search") {
            self.forget_written(args, &key, "is found by a search");
            self.unresolved(
                stmt.span,
                "where the search finds its signal is not known: it runs to its end point",
            );
        }
        if let Some(what) = processes::unmodelled(&key) {
            self.unresolved(stmt.span, what);
        }
        self.moves += 1;
        self.machine.moves(movement);
    }

    fn resolve(
        &mut self,
        stmt: &Stmt,
        text: &str,
        signature: MoveSignature,
        arguments: &Arguments<'_>,
    ) -> Result<Movement, String> {
        let mut origin = Origin::default();
        let mut positional = arguments.positional.iter().copied().skip(signature.before);
        let mut take = |name: &str, what: &str| {
            arguments
                .option_value(name)
                .or_else(|| positional.next())
                .ok_or_else(|| format!("{text} has no {what}"))
        };
        let via = match signature.form {
            MoveForm::Circular => Some(take("cirpoint", "circle point")?),
            _ => None,
        };
        let target = take("topoint", "target")?;
        let speed = take("speed", "speed")?;
        for _ in 0..signature.between {
            take("", "trigger")?;
        }
        let zone = if signature.zone { Some(take("zone", "zone")?) } else { None };
        let tool = take("tool", "tool")?;

        let via = match via {
            Some(expr) => {
                let value = self.argument(expr, &mut origin);
                Some(convert::robtarget(&value.datum)?)
            }
            None => None,
        };
        let target_value = self.argument(target, &mut origin);
        let external = convert::external(&target_value.datum);
        let target = match signature.form {
            MoveForm::AbsJ => Target::Joints(convert::jointtarget(&target_value.datum)?),
            _ => Target::Pose(convert::robtarget(&target_value.datum)?),
        };
        let speed_value = self.argument(speed, &mut origin);
        let mut speed = convert::speed(&speed_value.datum)?;
        let zone = match zone {
            Some(expr) => {
                let value = self.argument(expr, &mut origin);
                convert::zone(&value.datum)?
            }
            None => Zone { fine: true, tcp: 0.0, orientation: 0.0, angle: 0.0 },
        };
        let zone = self.zone_options(zone, arguments, &mut origin)?;
        let stop = match arguments.option_value("inpos") {
            Some(expr) => {
                let value = self.argument(expr, &mut origin);
                convert::stop(&value.datum)?
            }
            None => Stop::Fine,
        };
        let tool_value = self.argument(tool, &mut origin);
        let tool_name = match &tool.kind {
            ExprKind::Ref(name) => name.text.as_str(),
            _ => "tool",
        };
        let named = tool;
        let tool = convert::tool(&tool_value.datum, tool_name)
            .map_err(|why| self.blame(named, &tool_value.datum, &why))?;
        let wobj = match arguments.option_value("wobj") {
            Some(expr) => self.argument(expr, &mut origin),
            None => super::super::predefined::lookup("wobj0")
                .unwrap_or_else(|| Value::unknown("wobj0", stmt.span)),
        };
        let wobj = convert::work_object(&wobj.datum)?;
        let total_load = match arguments.option_value("tload") {
            Some(expr) => {
                let value = self.argument(expr, &mut origin);
                Some(convert::load(&value.datum)?)
            }
            None => None,
        };
        if let Some(expr) = arguments.option_value("v") {
            let value = self.argument(expr, &mut origin);
            speed.tcp = convert::num(&value.datum, "\\V")? * 1e-3;
            if speed.tcp <= 0.0 {
                return Err("\\V is not positive".into());
            }
        }
        let time = match arguments.option_value("t") {
            Some(expr) => {
                let value = self.argument(expr, &mut origin);
                let time = convert::num(&value.datum, "\\T")?;
                if time <= 0.0 {
                    return Err("\\T is not positive".into());
                }
                Some(time)
            }
            None => None,
        };
        for dependence in origin.iter() {
            if let Dependence::TrustedPersistent(name) = dependence {
                let text = format!("PERS {name} has its value of the source");
                if !self.execution.assumed.contains(&text) {
                    self.execution.assumed.push(text);
                }
            }
        }
        let history = self.history(&origin);
        origin.join(&history);
        let mut locals = self.locals(&origin);
        let options = arguments.optional.iter().filter_map(|(_, _, expr)| *expr);
        for expr in arguments.positional.iter().copied().chain(options) {
            self.references(expr, &mut locals);
        }
        let other_arguments = arguments
            .optional
            .iter()
            .filter(|(key, _, _)| !KNOWN_OPTIONS.contains(key))
            .map(|(_, text, _)| (*text).into())
            .collect();
        Ok(Movement {
            instruction: text.into(),
            form: signature.form,
            plain: signature.plain,
            span: stmt.span,
            routine: self.frame().routine.clone(),
            called_at: self.frame().called_at,
            via,
            target,
            external,
            speed,
            time,
            zone,
            stop,
            tool,
            tool_span: named.span,
            wobj,
            wobj_span: arguments.option_value("wobj").map(|expr| expr.span),
            total_load,
            settings: self.settings.clone(),
            concurrent: arguments.has_option("conc"),
            other_arguments,
            origin,
            locals,
        })
    }

    /// What the data in an origin that have a name here are at this moment.
    fn locals(&self, origin: &Origin) -> Vec<LocalValue> {
        origin.iter().filter_map(|dependence| self.local(dependence)).collect()
    }

    fn local(&self, dependence: &Dependence) -> Option<LocalValue> {
        let base = dependence.base();
        let (name, cell) = match base {
            Dependence::Local(name) => {
                let key = name.to_lowercase();
                let names = &self.frame().names;
                let (_, cell) = names.iter().rev().find(|(known, _)| *known == key)?;
                (name, &self.cells[*cell])
            }
            Dependence::Variable(name) => (name, self.module_data(name, base, dependence != base)?),
            _ => return None,
        };
        let (mut datum, mut text) = (&cell.value.datum, name.to_string());
        if let Dependence::Element(_, at) = dependence {
            for index in at {
                let Datum::List(items) = datum else { return None };
                datum = items.get(*index as usize - 1)?;
            }
            let at: Vec<String> = at.iter().map(u32::to_string).collect();
            let _ = write!(text, "{{{}}}", at.join(","));
        }
        Some(LocalValue {
            name: text.into(),
            type_key: cell.value.type_key.clone(),
            datum: datum.clone(),
            alias: if dependence == base { cell.alias.clone() } else { None },
            of: dependence.clone(),
        })
    }

    /// The cell of module data on which something depends, if its name means it and nothing else
    /// here, and a condition can tell its value, or that of an `element`.
    fn module_data(&self, name: &str, dependence: &Dependence, element: bool) -> Option<&Cell> {
        let key = name.to_lowercase();
        let frame = self.frame();
        if frame.names.iter().any(|(known, _)| *known == key) {
            return None;
        }
        let Some(Symbol::Data(id)) = self.program.resolve(frame.module, &key) else { return None };
        let data = self.program.modules.iter().flat_map(|module| &module.data);
        let is_alone = data.filter(|data| data.name.key == key).count() == 1;
        let whole = self.program.data(id).dims.is_empty() != element;
        let cell = &self.cells[*self.globals.get(&id)?];
        let told = matches!(&*cell.value.type_key, "num" | "bool" | "robtarget" | "jointtarget");
        let is_it = cell.reading == Origin::of(dependence.clone());
        (is_alone && whole && told && is_it).then_some(cell)
    }

    /// Adds the parameters in an expression that stand for module data themselves: at another call
    /// they may stand for others.
    fn references(&self, expr: &Expr, locals: &mut Vec<LocalValue>) {
        match &expr.kind {
            ExprKind::Ref(name) => {
                let names = &self.frame().names;
                let Some((_, cell)) = names.iter().rev().find(|(key, _)| *key == name.key) else {
                    return;
                };
                let data = self.globals.iter().find(|(_, known)| *known == cell);
                let Some((id, _)) = data else { return };
                if locals.iter().any(|local| local.name.eq_ignore_ascii_case(&name.text)) {
                    return;
                }
                let declared = &self.program.data(*id).name;
                let global = self.program.resolve_global(&declared.key) == Some(Symbol::Data(*id));
                let value = &self.cells[*cell].value;
                let own: Arc<str> = name.text.as_str().into();
                locals.push(LocalValue {
                    name: own.clone(),
                    type_key: value.type_key.clone(),
                    datum: value.datum.clone(),
                    alias: global.then(|| declared.text.as_str().into()),
                    of: Dependence::Local(own),
                });
            }
            ExprKind::Field(base, _) => self.references(base, locals),
            ExprKind::Index(base, indices) => {
                self.references(base, locals);
                for index in indices {
                    self.references(index, locals);
                }
            }
            ExprKind::Aggregate(items) => {
                for item in items {
                    self.references(item, locals);
                }
            }
            ExprKind::Unary(_, operand) => self.references(operand, locals),
            ExprKind::Binary(_, left, right) => {
                self.references(left, locals);
                self.references(right, locals);
            }
            ExprKind::Call(_, args) => {
                for arg in args {
                    if let ArgKind::Positional(expr)
                    | ArgKind::Named(_, expr)
                    | ArgKind::Optional(_, Some(expr)) = &arg.kind
                    {
                        self.references(expr, locals);
                    }
                }
            }
            _ => {}
        }
    }

    /// Why an argument can't be used, with the name of the data; where their value is known but
    /// wrong, the declaration gets a note.
    pub(super) fn blame(&mut self, argument: &Expr, datum: &Datum, why: &str) -> String {
        let ExprKind::Ref(name) = &argument.kind else { return why.to_owned() };
        if datum.first_unknown().is_some() {
            return why.to_owned();
        }
        let quoted = format!("'{}'", name.text);
        let why =
            if why.starts_with(&quoted) { why.to_owned() } else { format!("{quoted}: {why}") };
        let frame = self.frame();
        if !frame.names.iter().any(|(key, _)| *key == name.key)
            && let Some(Symbol::Data(id)) = self.program.resolve(frame.module, &name.key)
        {
            let data = self.program.data(id);
            self.unresolved(data.name.span, format!("{} {why}", data.type_name.text));
        }
        why
    }

    fn zone_options(
        &mut self,
        mut zone: Zone,
        arguments: &Arguments<'_>,
        origin: &mut Origin,
    ) -> Result<Zone, String> {
        if let Some(expr) = arguments.option_value("z") {
            let value = self.argument(expr, origin);
            let size = convert::num(&value.datum, "\\Z")?.max(0.0) * 1e-3;
            // The other sizes keep their proportion to the TCP zone.
            let scale = if zone.tcp > 0.0 { size / zone.tcp } else { 1.5 };
            zone = Zone {
                fine: false,
                tcp: size,
                orientation: if zone.tcp > 0.0 { zone.orientation * scale } else { size * scale },
                angle: zone.angle * scale,
            };
        }
        if arguments.has_option("inpos") {
            zone.fine = true;
        }
        Ok(zone)
    }

    fn argument(&mut self, expr: &Expr, origin: &mut Origin) -> Value {
        let value = self.eval(expr);
        origin.join(&value.origin);
        value
    }
}
