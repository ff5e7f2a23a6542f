//! Calls of functions: built into RAPID or declared in the program.

use super::eval::declared_twice;
use super::executor::Executor;
use super::flow::Flow;
use super::system::NO_AXIS;
use crate::rapid::builtins::{self, Source};
use crate::rapid::ir::functions::{self, EvaluatedArguments};
use crate::rapid::ir::hir::{Arg, ArgKind, Expr, ExprKind, Ident};
use crate::rapid::ir::program::Symbol;
use crate::rapid::ir::value::{Datum, Dependence, Origin, Value};

impl Executor<'_> {
    /// The value of `name(args)`.
    pub(super) fn function(&mut self, expr: &Expr, name: &Ident, args: &[Arg]) -> Value {
        match self.program.resolve(self.frame().module, &name.key) {
            Some(Symbol::Routine(id)) => {
                return match self.call_routine(id, args, expr.span) {
                    Flow::Return(Some(value)) => value,
                    _ => Value::unknown(format!("'{}' returned no value", name.text), expr.span),
                };
            }
            Some(Symbol::Ambiguous) => {
                return Value::unknown(declared_twice(&name.text), expr.span);
            }
            _ => {}
        }
        let value = self.built_in_function(expr, name, args);
        match builtins::function(&name.key) {
            Some(function) => {
                let how = format!("is written by {}", name.text);
                self.mark_unknown_if(args, &how, |place, _| function.writes_to(place));
            }
            None => self.mark_changed_outside(&name.text, args),
        }
        value
    }

    fn built_in_function(&mut self, expr: &Expr, name: &Ident, args: &[Arg]) -> Value {
        match name.key.as_str() {
            "present" => return self.present(args),
            "cjointt" => return self.joint_position(expr),
            "cspeedoverride" => return self.speed_override(args, expr),
            _ => {}
        }
        let source = builtins::function(&name.key).map(|function| function.source);
        if source == Some(Source::Controller) {
            let reason = format!("{} depends on the controller", name.text);
            return Value::unknown(reason, expr.span);
        }
        let (mut values, mut options) = self.values_of(args);
        if source == Some(Source::Signal)
            && let Some(value) = values.pop()
        {
            return self.level(value);
        }
        let mut origin = Origin::default();
        for value in values.iter_mut().chain(options.iter_mut().filter_map(|(_, v)| v.as_mut())) {
            origin.join(&value.origin);
            if let Datum::Signal(signal) = &value.datum {
                let reason = format!("'{signal}' is not declared in the files given");
                value.datum = Datum::unknown(reason, expr.span);
            }
        }
        let all = values.iter().chain(options.iter().filter_map(|(_, value)| value.as_ref()));
        if let Some(unknown) = all.into_iter().find_map(|v| v.datum.first_unknown()) {
            let datum = Datum::Unknown(unknown.clone());
            return Value { datum, type_key: "".into(), origin };
        }
        match name.key.as_str() {
            "calcrobt" => return self.robtarget_at(&values, &options, expr),
            "getsysinfo" => return self.system_info(&options, expr),
            _ => {}
        }
        let Some(function) = functions::lookup(&name.key) else {
            return Value::unknown(not_known(name, source), expr.span);
        };
        let evaluated = EvaluatedArguments {
            args: values.iter().map(|value| &value.datum).collect(),
            options: options.iter().map(|(k, v)| (*k, v.as_ref().map(|v| &v.datum))).collect(),
        };
        match function(&evaluated) {
            Some((datum, type_key)) => Value { datum, type_key: type_key.into(), origin },
            None => Value::unknown(
                format!("'{}' has no value for these arguments", name.text),
                expr.span,
            ),
        }
    }

    /// The values of the arguments in order, and those of the options by lower-case name.
    fn values_of<'e>(&mut self, args: &'e [Arg]) -> (Vec<Value>, Vec<(&'e str, Option<Value>)>) {
        let mut values = Vec::new();
        let mut options: Vec<(&str, Option<Value>)> = Vec::new();
        for arg in args {
            match &arg.kind {
                ArgKind::Positional(inner) | ArgKind::Named(_, inner) => {
                    values.push(self.eval(inner));
                }
                ArgKind::Optional(option, inner) => {
                    options.push((&option.key, inner.as_ref().map(|inner| self.eval(inner))));
                }
                ArgKind::Conditional(option, outer) if self.given(outer).is_some() => {
                    options.push((&option.key, Some(self.eval(outer))));
                }
                ArgKind::Conditional(..) => {}
            }
        }
        (values, options)
    }

    fn present(&mut self, args: &[Arg]) -> Value {
        let parameter = args.first().and_then(Arg::positional);
        let given = parameter.and_then(|parameter| self.given(parameter));
        Value::constant(Datum::Bool(given.is_some()), "bool")
    }

    /// The name of an optional parameter, if the call of the routine states it.
    pub(super) fn given<'e>(&self, parameter: &'e Expr) -> Option<&'e Ident> {
        match &parameter.kind {
            ExprKind::Ref(name) if self.frame().present.contains(&name.key) => Some(name),
            _ => None,
        }
    }

    fn joint_position(&mut self, expr: &Expr) -> Value {
        let Some(q) = self.machine.joints() else {
            return Value::unknown("CJointT depends on where the robot is", expr.span);
        };
        let joints = Datum::nums(q.map(f64::to_degrees));
        Value {
            datum: Datum::List(vec![joints, Datum::nums([NO_AXIS; 6])]),
            type_key: "jointtarget".into(),
            origin: Origin::of(Dependence::RobotState),
        }
    }
}

/// Why the value of a function is unknown.
fn not_known(name: &Ident, source: Option<Source>) -> String {
    match source {
        Some(Source::Position) => format!("{} depends on where the robot is", name.text),
        Some(Source::Kinematics) => format!("{} needs the robot's kinematics", name.text),
        Some(Source::State) => format!("{} depends on what ran before", name.text),
        Some(_) => format!("{} is not calculated", name.text),
        None => format!("the function '{}' is not known", name.text),
    }
}
