//! The parameters of the routine that is being called.

use gen_lsp_types::SignatureHelp;
use serde_json::{Value, json};

use super::call::{Argument, Call, call};
use super::comment::comment_of;
use super::cursor::Cursor;
use super::scope::Scope;
use super::signature::{Parameter, Signature, signature};
use super::workspace::View;

/// The signature of the routine around a byte, with the parameter of the argument there.
pub(super) fn signature_help(view: View<'_>, byte: u32) -> Option<SignatureHelp> {
    let cursor = Cursor::new(view.project.module(view.file), byte);
    let call = call(&cursor)?;
    let scope = Scope::new(view, byte)?;
    let one = scope.declared(scope.routine(&cursor.text(call.callee))?);
    let Signature { text, parameters } = signature(view.project, one);
    let active = active(&cursor, &call, &parameters);
    let units = |end: usize| view.workspace.units.length(text.get(..end).unwrap_or_default());
    let shown: Vec<Value> = parameters
        .iter()
        .map(|parameter| json!({ "label": [units(parameter.start), units(parameter.end)] }))
        .collect();
    let whole = one.declaration().whole;
    let own = !one.names.is_predefined(one.id);
    let comment = own.then(|| comment_of(view.project.module(whole.file), whole)).flatten();
    let mut signature = json!({ "label": text, "parameters": shown });
    if let Some(comment) = comment {
        signature["documentation"] = json!(comment);
    }
    let mut help = json!({ "signatures": [signature], "activeSignature": 0 });
    // Without the key the first parameter would be marked.
    help["activeParameter"] = json!(active.unwrap_or(parameters.len()));
    serde_json::from_value(help).ok()
}

/// The number of the parameter of the argument at the cursor.
fn active(cursor: &Cursor<'_>, call: &Call, parameters: &[Parameter]) -> Option<usize> {
    match call.argument {
        Argument::Position(wanted) => {
            let required = parameters.iter().enumerate().filter(|(_, one)| !one.optional);
            required.map(|(index, _)| index).nth(wanted)
        }
        Argument::Named(word) => {
            let key = cursor.text(word);
            parameters.iter().position(|one| one.key == key)
        }
        Argument::Unnamed => {
            let typed = cursor.typed();
            let starts = |one: &Parameter| one.optional && one.key.starts_with(&typed);
            let given: Vec<String> = call.given.iter().map(|word| cursor.text(*word)).collect();
            parameters.iter().position(|one| starts(one) && !given.contains(&one.key))
        }
    }
}
