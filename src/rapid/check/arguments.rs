//! Arguments of calls.

use super::context::{Context, Place};
use super::fault::{error, with_place};
use super::parameters::{Argument, Parameter, call, parameters};
use super::suggest::nearest;
use super::types::{Type, stated};
use super::values::compare;
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{Access, DeclarationId, Kind, Meaning, RoutineKind, Storage};
use crate::rapid::syntax::NodeKind;

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    for place in context.nodes() {
        let called = match place.kind() {
            NodeKind::CallStatement => RoutineKind::Proc,
            NodeKind::FunctionCall => RoutineKind::Func,
            _ => continue,
        };
        let Some((callee, arguments)) = call(place) else { continue };
        // A routine of another kind is reported elsewhere.
        let routine = context
            .declared(callee)
            .filter(|id| context.names.declaration(*id).kind == Kind::Routine(called));
        if let Some(routine) = routine
            && !place.is_broken()
        {
            Call { context, routine, callee, parameters: parameters(context, routine) }
                .check(&arguments, out);
        }
    }
}

struct Call<'c, 'a> {
    context: &'c Context<'a>,
    routine: DeclarationId,
    callee: Place<'a>,
    parameters: Vec<Parameter>,
}

impl Call<'_, '_> {
    fn check(&self, arguments: &[Argument<'_>], out: &mut Vec<Diagnostic>) {
        let placeholder = |one: &Argument<'_>| one.whole.kind() == NodeKind::Placeholder;
        if arguments.iter().any(placeholder) {
            return;
        }
        let required: Vec<Parameter> =
            self.parameters.iter().filter(|one| one.group.is_none()).copied().collect();
        let mut given = 0;
        let mut seen: Vec<Parameter> = Vec::new();
        for argument in arguments {
            if argument.is_optional() {
                self.optional(argument, &mut seen, out);
            } else {
                let parameter = match argument.name {
                    Some(name) => self.named(name, out),
                    None => required.get(given).copied(),
                };
                given += 1;
                if let (Some(parameter), Some(value)) = (parameter, argument.value) {
                    self.value(parameter, value, out);
                }
            }
        }
        if given != required.len() {
            self.wrong_number(&required, given, arguments, out);
        }
    }

    fn name(&self) -> String {
        self.callee.text()
    }

    fn shown(&self, parameter: Parameter) -> String {
        self.context.shown(parameter.id)
    }

    fn wrong_number(
        &self,
        required: &[Parameter],
        given: usize,
        arguments: &[Argument<'_>],
        out: &mut Vec<Diagnostic>,
    ) {
        let count = required.len();
        let plural = if count == 1 { "" } else { "s" };
        let few = if given < count { "few" } else { "many" };
        let message = format!(
            "too {few} arguments: {} needs {count} argument{plural}, this call gives {given}",
            self.name()
        );
        let names: Vec<String> = required.iter().map(|one| self.shown(*one)).collect();
        let help = match names.as_slice() {
            [] => "call it without arguments".to_owned(),
            names => format!("give {}", names.join(", ")),
        };
        let extra = arguments.iter().filter(|one| !one.is_optional()).nth(count);
        let span = extra.map_or(self.callee.span(), |one| one.whole.span());
        out.push(self.declared_here(error("arguments", span, message, help)));
    }

    fn declared_here(&self, finding: Diagnostic) -> Diagnostic {
        if self.context.names.is_predefined(self.routine) {
            return finding;
        }
        let name = self.context.names.declaration(self.routine).name;
        with_place(finding, name, "declared here")
    }

    /// The parameter that an argument names.
    fn parameter(&self, name: Place<'_>) -> Option<Parameter> {
        let id = self.context.declared(name)?;
        self.parameters.iter().find(|one| one.id == id).copied()
    }

    fn named(&self, name: Place<'_>, out: &mut Vec<Diagnostic>) -> Option<Parameter> {
        let parameter = self.parameter(name);
        match parameter {
            None => out.push(self.unknown(name, false)),
            Some(parameter) if parameter.group.is_some() => out.push(error(
                "arguments",
                name.span(),
                format!("{} is an optional argument of {}", name.text(), self.name()),
                format!("write \\{} := …", self.shown(parameter)),
            )),
            Some(_) => {}
        }
        parameter
    }

    fn unknown(&self, name: Place<'_>, optional: bool) -> Diagnostic {
        let kind = if optional { "optional argument" } else { "argument" };
        let known: Vec<String> = self
            .parameters
            .iter()
            .filter(|one| one.group.is_some() == optional)
            .map(|one| self.shown(*one))
            .collect();
        let slash = if optional { "\\" } else { "" };
        let help = match nearest(&name.text(), known.iter().map(String::as_str)) {
            Some(near) => format!("did you mean {slash}{near}?"),
            None if known.is_empty() => format!("{} has no {kind}s", self.name()),
            None => format!("it has {slash}{}", known.join(&format!(", {slash}"))),
        };
        let message = format!("unknown {kind}: {} has no {slash}{}", self.name(), name.text());
        self.declared_here(error("unknown-argument", name.span(), message, help))
    }

    fn optional(
        &self,
        argument: &Argument<'_>,
        seen: &mut Vec<Parameter>,
        out: &mut Vec<Diagnostic>,
    ) {
        let Some(name) = argument.name else { return };
        let Some(parameter) = self.parameter(name).filter(|one| one.group.is_some()) else {
            if !self.context.names.has_other_parameters(self.routine) {
                out.push(self.unknown(name, true));
            }
            return;
        };
        if !argument.is_conditional() {
            let group = |one: &&Parameter| one.group == parameter.group;
            if let Some(other) = seen.iter().find(group) {
                let (one, two) = (self.shown(*other), self.shown(parameter));
                let (message, help) = if other.id == parameter.id {
                    (format!("\\{two} is given twice"), "remove one".to_owned())
                } else {
                    let message = format!("\\{one} and \\{two} exclude each other");
                    (message, format!("give \\{one} or \\{two}"))
                };
                out.push(error("arguments", argument.whole.span(), message, help));
            }
            seen.push(parameter);
        }
        match argument.value {
            Some(value) => self.value(parameter, value, out),
            None if argument.is_conditional() || self.is_switch(parameter) => {}
            None => out.push(error(
                "arguments",
                argument.whole.span(),
                format!("\\{} needs a value", self.shown(parameter)),
                format!("write \\{} := …", self.shown(parameter)),
            )),
        }
    }

    fn is_switch(&self, parameter: Parameter) -> bool {
        let ty = stated(&self.context.names, self.context.names.declaration(parameter.id).value);
        matches!(ty, Type::Unknown)
            || Some(ty) == self.context.basics.switch.map(|id| Type::Of(id, 0))
    }

    fn value(&self, parameter: Parameter, value: Place<'_>, out: &mut Vec<Diagnostic>) {
        if value.kind() == NodeKind::AnyPosition || self.is_switch(parameter) {
            return;
        }
        let wanted = match parameter.access {
            Access::In => None,
            Access::InOut => Some("a variable or persistent"),
            Access::Var => Some("a variable"),
            Access::Pers => Some("a persistent"),
        };
        if let Some(wanted) = wanted
            && let Some(found) = self.is_no_target(parameter.access, value)
        {
            let name = self.shown(parameter);
            let message = format!(
                "the argument {name} of {} has to be {wanted}, this is {found}",
                self.name()
            );
            let keyword = if parameter.access == Access::Pers { "PERS" } else { "VAR" };
            let help = format!("declare it as {keyword}, or give one that is");
            out.push(error("access", value.span(), message, help));
            return;
        }
        let ty = stated(&self.context.names, self.context.names.declaration(parameter.id).value);
        let what = format!("the argument {} of {}", self.shown(parameter), self.name());
        compare(self.context, &what, ty, value, out);
    }

    /// What an argument is, if it cannot be passed by reference.
    fn is_no_target(&self, access: Access, value: Place<'_>) -> Option<&'static str> {
        let mut at = value;
        while matches!(at.kind(), NodeKind::FieldAccess | NodeKind::IndexAccess) {
            at = at.children().next()?;
        }
        match at.kind() {
            NodeKind::Reference => {}
            NodeKind::NumberLiteral | NodeKind::StringLiteral | NodeKind::BoolLiteral => {
                return Some("a literal");
            }
            NodeKind::Aggregate => return Some("a list in brackets"),
            NodeKind::FunctionCall => return Some("the value of a function"),
            NodeKind::UnaryExpression | NodeKind::BinaryExpression => return Some("an expression"),
            _ => return None,
        }
        match self.context.use_at(at)?.meaning {
            Meaning::Predefined(_) => Some("a constant"),
            Meaning::Declared(id) => match (self.context.names.declaration(id).kind, access) {
                (Kind::Data(Storage::Const), _) => Some("a constant"),
                (Kind::Data(Storage::Var), Access::Pers) => Some("a variable"),
                (Kind::Data(Storage::Pers), Access::Var) => Some("a persistent"),
                (Kind::Counter, _) => Some("the counter of a FOR"),
                (Kind::Parameter(mode), Access::Pers) if mode.access == Access::In => {
                    Some("a parameter that is passed by value")
                }
                (Kind::Parameter(mode), Access::Pers) if mode.access == Access::Var => {
                    Some("a variable")
                }
                (Kind::Parameter(mode), Access::Var) if mode.access == Access::Pers => {
                    Some("a persistent")
                }
                _ => None,
            },
            _ => None,
        }
    }
}
