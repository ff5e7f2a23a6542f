//! Movement instructions: from arguments to a [`Movement`].

use super::arguments::Arguments;
use super::executor::Executor;
use crate::rapid::builtins::{self, MoveForm, MoveKind, MoveSignature};
use crate::rapid::ir::convert;
use crate::rapid::ir::hir::{Expr, ExprKind, Stmt};
use crate::rapid::ir::movement::{Argument, Movement, Speed, Stop, Target, Tool, Unresolved, Zone};
use crate::rapid::ir::predefined;
use crate::rapid::ir::program::Symbol;
use crate::rapid::ir::value::{Datum, Dependence, Origin, Value};

/// Options whose effect on a movement is modelled, or that have none.
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

/// The evaluated arguments of a movement.
#[derive(Default)]
struct MovementArguments {
    origin: Origin,
    arguments: Vec<Argument>,
}

/// The arguments of a movement by meaning.
struct Parts<'e> {
    via: Option<&'e Expr>,
    target: &'e Expr,
    speed: &'e Expr,
    zone: Option<&'e Expr>,
    tool: &'e Expr,
}

impl<'e> Parts<'e> {
    fn new(
        text: &str,
        signature: MoveSignature,
        arguments: &Arguments<'e>,
    ) -> Result<Parts<'e>, String> {
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
        Ok(Parts { via, target, speed, zone, tool: take("tool", "tool")? })
    }
}

impl Executor<'_> {
    pub(super) fn movement(
        &mut self,
        stmt: &Stmt,
        text: &str,
        signature: MoveSignature,
        arguments: &Arguments<'_>,
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
        if signature.kind == MoveKind::Search
            && let Some(instruction) = builtins::instruction(&text.to_lowercase())
        {
            let how = "is found by a search";
            self.mark_unknown_if(arguments.all, how, |place, _| instruction.may_write_to(place));
        }
        if let Some(what) = not_simulated(signature.kind) {
            self.unresolved(stmt.span, what);
        }
        self.moves += 1;
        self.machine.on_movement(movement);
    }

    fn resolve(
        &mut self,
        stmt: &Stmt,
        text: &str,
        signature: MoveSignature,
        arguments: &Arguments<'_>,
    ) -> Result<Movement, String> {
        let parts = Parts::new(text, signature, arguments)?;
        let mut evaluated = MovementArguments::default();
        let via = parts.via.map(|expr| self.argument(expr, "robtarget", &mut evaluated));
        let via = via.map(|value| convert::robtarget(&value.datum)).transpose()?;
        let to_joints = signature.form == MoveForm::AbsJ;
        let target_type = if to_joints { "jointtarget" } else { "robtarget" };
        let target_value = self.argument(parts.target, target_type, &mut evaluated);
        let external = convert::external(&target_value.datum);
        let target = if to_joints {
            Target::Joints(convert::jointtarget(&target_value.datum)?)
        } else {
            Target::Pose(convert::robtarget(&target_value.datum)?)
        };
        let speed_value = self.argument(parts.speed, "speeddata", &mut evaluated);
        let mut speed = convert::speed(&speed_value.datum)?;
        let fine = Zone { fine: true, tcp: 0.0, orientation: 0.0, angle: 0.0 };
        let zone = parts.zone.map(|expr| self.argument(expr, "zonedata", &mut evaluated));
        let zone = zone.map_or(Ok(fine), |value| convert::zone(&value.datum))?;
        let zone = self.zone_options(zone, arguments, &mut evaluated)?;
        let stop = self.option(arguments, "inpos", "stoppointdata", &mut evaluated);
        let stop = stop.map_or(Ok(Stop::Fine), |value| convert::stop(&value.datum))?;
        let tool = self.tool(parts.tool, &mut evaluated)?;
        let wobj = self
            .option(arguments, "wobj", "wobjdata", &mut evaluated)
            .or_else(|| predefined::lookup("wobj0"))
            .unwrap_or_else(|| Value::unknown("wobj0", stmt.span));
        let wobj = convert::work_object(&wobj.datum)?;
        let total_load = self.option(arguments, "tload", "loaddata", &mut evaluated);
        let total_load = total_load.map(|value| convert::load(&value.datum)).transpose()?;
        let time = self.speed_options(&mut speed, arguments, &mut evaluated)?;
        let other_arguments = arguments
            .optional
            .iter()
            .filter(|(name, _)| !KNOWN_OPTIONS.contains(&name.key.as_str()))
            .map(|(name, _)| name.text.as_str().into())
            .chain(arguments.conditional.iter().map(|text| text.as_str().into()))
            .collect();
        Ok(Movement {
            instruction: text.into(),
            form: signature.form,
            plain: signature.kind == MoveKind::Plain,
            span: stmt.span,
            routine: self.frame().routine.clone(),
            call: self.frame().call.clone(),
            via,
            target,
            external,
            speed,
            time,
            zone,
            stop,
            tool,
            tool_span: parts.tool.span,
            wobj,
            total_load,
            settings: self.settings.clone(),
            concurrent: arguments.has_option("conc"),
            other_arguments,
            origin: self.origin_of_movement(evaluated.origin),
            arguments: evaluated.arguments,
        })
    }

    /// The direct and indirect dependences of the arguments. Trusted data are noted as assumed.
    fn origin_of_movement(&mut self, mut origin: Origin) -> Origin {
        for dependence in origin.iter() {
            if let Dependence::TrustedPersistent(name) = dependence {
                self.assume(format!("PERS {name} has its value of the source"));
            }
        }
        let history = self.history(&origin);
        origin.join(&history);
        origin
    }

    fn tool(&mut self, expr: &Expr, evaluated: &mut MovementArguments) -> Result<Tool, String> {
        let value = self.argument(expr, "tooldata", evaluated);
        let name = match &expr.kind {
            ExprKind::Ref(name) => name.text.as_str(),
            _ => "tool",
        };
        convert::tool(&value.datum, name)
            .map_err(|why| self.explain_argument(expr, &value.datum, &why))
    }

    /// Replaces the TCP speed by `\V`; returns the time `\T`, s.
    fn speed_options(
        &mut self,
        speed: &mut Speed,
        arguments: &Arguments<'_>,
        evaluated: &mut MovementArguments,
    ) -> Result<Option<f64>, String> {
        if let Some(value) = self.option(arguments, "v", "num", evaluated) {
            speed.tcp = convert::num(&value.datum, "\\V")? * 1e-3;
            if speed.tcp <= 0.0 {
                return Err("\\V is not positive".into());
            }
        }
        let Some(value) = self.option(arguments, "t", "num", evaluated) else { return Ok(None) };
        let time = convert::num(&value.datum, "\\T")?;
        if time <= 0.0 {
            return Err("\\T is not positive".into());
        }
        Ok(Some(time))
    }

    /// Adds the name of the data to the reason why an argument is unusable. A value that is known
    /// but invalid is noted at its declaration.
    pub(super) fn explain_argument(&mut self, argument: &Expr, datum: &Datum, why: &str) -> String {
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
        evaluated: &mut MovementArguments,
    ) -> Result<Zone, String> {
        if let Some(value) = self.option(arguments, "z", "num", evaluated) {
            let size = convert::num(&value.datum, "\\Z")?.max(0.0) * 1e-3;
            // The other sizes keep their ratio to the TCP zone.
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

    /// The value of an option, if the call states it.
    fn option(
        &mut self,
        arguments: &Arguments<'_>,
        key: &str,
        type_name: &'static str,
        evaluated: &mut MovementArguments,
    ) -> Option<Value> {
        arguments.option_value(key).map(|expr| self.argument(expr, type_name, evaluated))
    }

    fn argument(
        &mut self,
        expr: &Expr,
        type_name: &'static str,
        evaluated: &mut MovementArguments,
    ) -> Value {
        let value = self.eval(expr);
        evaluated.origin.join(&value.origin);
        evaluated.arguments.push(Argument {
            span: expr.span,
            type_name,
            datum: value.datum.clone(),
        });
        value
    }
}

/// The part of a combined movement instruction that is not simulated.
fn not_simulated(kind: MoveKind) -> Option<&'static str> {
    match kind {
        MoveKind::Search => {
            Some("where the search finds its signal is not known: it runs to its end point")
        }
        MoveKind::ArcWeld => Some(
            "how fast it welds and how long the arc takes to start is said by its seam and weld \
             data: it is simulated at its speed argument, without waiting",
        ),
        MoveKind::Application => Some(
            "how fast the process runs and how long it takes to start is said by its process data: \
             it is simulated at its speed argument, without waiting",
        ),
        MoveKind::SpotWeld => Some("how long the spot weld takes is not known: it counts 0 s"),
        MoveKind::Plain | MoveKind::Event | MoveKind::Transfer | MoveKind::Dispense => None,
    }
}
