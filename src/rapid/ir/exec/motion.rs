//! Movement instructions: from arguments to a [`Movement`].

use super::super::convert;
use super::super::hir::{Arg, Expr, ExprKind, Stmt};
use super::super::instructions::{MoveForm, MoveSignature};
use super::super::movement::{Argument, Movement, Stop, Target, Unresolved, Zone};
use super::super::processes;
use super::super::program::Symbol;
use super::super::value::{Datum, Dependence, Origin, Value};
use super::Executor;
use super::instruction::Arguments;

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

/// The arguments of a movement as far as they are evaluated.
#[derive(Default)]
struct Given {
    origin: Origin,
    arguments: Vec<Argument>,
}

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
        let mut given = Given::default();
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
                let value = self.argument(expr, "robtarget", &mut given);
                Some(convert::robtarget(&value.datum)?)
            }
            None => None,
        };
        let target_type = match signature.form {
            MoveForm::AbsJ => "jointtarget",
            _ => "robtarget",
        };
        let target_value = self.argument(target, target_type, &mut given);
        let external = convert::external(&target_value.datum);
        let target = match signature.form {
            MoveForm::AbsJ => Target::Joints(convert::jointtarget(&target_value.datum)?),
            _ => Target::Pose(convert::robtarget(&target_value.datum)?),
        };
        let speed_value = self.argument(speed, "speeddata", &mut given);
        let mut speed = convert::speed(&speed_value.datum)?;
        let zone = match zone {
            Some(expr) => {
                let value = self.argument(expr, "zonedata", &mut given);
                convert::zone(&value.datum)?
            }
            None => Zone { fine: true, tcp: 0.0, orientation: 0.0, angle: 0.0 },
        };
        let zone = self.zone_options(zone, arguments, &mut given)?;
        let stop = match arguments.option_value("inpos") {
            Some(expr) => {
                let value = self.argument(expr, "stoppointdata", &mut given);
                convert::stop(&value.datum)?
            }
            None => Stop::Fine,
        };
        let tool_value = self.argument(tool, "tooldata", &mut given);
        let tool_name = match &tool.kind {
            ExprKind::Ref(name) => name.text.as_str(),
            _ => "tool",
        };
        let named = tool;
        let tool = convert::tool(&tool_value.datum, tool_name)
            .map_err(|why| self.blame(named, &tool_value.datum, &why))?;
        let wobj = match arguments.option_value("wobj") {
            Some(expr) => self.argument(expr, "wobjdata", &mut given),
            None => super::super::predefined::lookup("wobj0")
                .unwrap_or_else(|| Value::unknown("wobj0", stmt.span)),
        };
        let wobj = convert::work_object(&wobj.datum)?;
        let total_load = match arguments.option_value("tload") {
            Some(expr) => {
                let value = self.argument(expr, "loaddata", &mut given);
                Some(convert::load(&value.datum)?)
            }
            None => None,
        };
        if let Some(expr) = arguments.option_value("v") {
            let value = self.argument(expr, "num", &mut given);
            speed.tcp = convert::num(&value.datum, "\\V")? * 1e-3;
            if speed.tcp <= 0.0 {
                return Err("\\V is not positive".into());
            }
        }
        let time = match arguments.option_value("t") {
            Some(expr) => {
                let value = self.argument(expr, "num", &mut given);
                let time = convert::num(&value.datum, "\\T")?;
                if time <= 0.0 {
                    return Err("\\T is not positive".into());
                }
                Some(time)
            }
            None => None,
        };
        let mut origin = given.origin;
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
        let other_arguments = arguments
            .optional
            .iter()
            .filter(|(key, _, _)| !KNOWN_OPTIONS.contains(key))
            .map(|(_, text, _)| (*text).into())
            .chain(arguments.conditional.iter().map(|text| text.as_str().into()))
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
            total_load,
            settings: self.settings.clone(),
            concurrent: arguments.has_option("conc"),
            other_arguments,
            origin,
            arguments: given.arguments,
        })
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
        given: &mut Given,
    ) -> Result<Zone, String> {
        if let Some(expr) = arguments.option_value("z") {
            let value = self.argument(expr, "num", given);
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

    fn argument(&mut self, expr: &Expr, type_name: &'static str, given: &mut Given) -> Value {
        let value = self.eval(expr);
        given.origin.join(&value.origin);
        given.arguments.push(Argument { span: expr.span, type_name, datum: value.datum.clone() });
        value
    }
}
