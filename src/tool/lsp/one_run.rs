//! The run with the movement at the cursor as a stream: an action that is worked out once it is chosen.

use gen_lsp_types::{CodeAction, CodeActionKind, Range, Uri, WorkspaceEdit};
use serde_json::{Value, from_value, json};

use super::client::{Client, LateEdits};
use super::documents::Documents;
use super::findings::Analysis;
use super::host::{ChangedFile, Host};
use super::options::Options;
use super::position::{Positions, Units};
use super::uri::{path_of, shown};
use crate::retime::motion::timeline::What;

/// A movement by its line.
#[derive(serde::Deserialize, serde::Serialize)]
pub(super) struct Run {
    uri: Uri,
    /// From 0.
    line: u32,
}

/// The action for the first movement of the simulated cycle that touches a range.
pub(super) fn offer(
    analysis: &Analysis,
    units: Units,
    uri: &Uri,
    range: &Range,
) -> Option<CodeAction> {
    let positions = Positions::new(&analysis.file, units);
    let (start, end) = (positions.byte(range.start), positions.byte(range.end));
    let cycles = analysis.examined.cycles.iter().flatten().filter(|_| analysis.dynamics);
    let events = cycles.flat_map(|cycle| &cycle.simulation.events);
    let spans = events.flat_map(|event| match &event.what {
        What::Run(run) => run.moves.as_slice(),
        _ => &[],
    });
    let mut spans = spans.map(|record| record.movement.span);
    let touches = |file, from: u32, to: u32| file == analysis.file.id && from <= end && start <= to;
    let span = spans.find(|span| touches(span.file, span.start, span.end))?;
    let run = Run { uri: uri.clone(), line: positions.range(span).start.line };
    Some(CodeAction {
        title: "Optimise this run: an energy-optimal stream behind a guard".to_owned(),
        kind: Some(CodeActionKind::RefactorRewrite),
        data: Some(json!(run)),
        ..CodeAction::default()
    })
}

/// The edit of an offered action; why there is none, otherwise. The files on disk are optimised, so open
/// documents have to be saved.
pub(super) fn edit(
    host: &impl Host,
    options: &Options,
    documents: &Documents,
    client: &Client,
    run: &Run,
) -> Result<WorkspaceEdit, String> {
    let changed = host.with_stream(options, &path_of(&run.uri.0), run.line + 1)?;
    let mut changes = Vec::new();
    for ChangedFile { path, before, after } in &changed {
        let path = shown(path);
        let uri = documents.uri(&path);
        let Some(before) = before else {
            changes.push(json!({ "kind": "create", "uri": uri }));
            changes.push(text_edit(&uri, client, "", after));
            continue;
        };
        let open = documents.get(&uri);
        if open.is_some_and(|open| open.bytes != before.as_bytes()) {
            return Err(format!("save {path} first: the files on disk are optimised"));
        }
        changes.push(text_edit(&uri, client, before, after));
    }
    let annotations = json!({ NAME: { "label": "Optimise this run", "needsConfirmation": true } });
    let mut edit = json!({ "documentChanges": changes });
    if client.late_edits == LateEdits::Shown {
        edit["changeAnnotations"] = annotations;
    }
    from_value(edit).map_err(|error| error.to_string())
}

/// Name of the annotation of all edits.
const NAME: &str = "run";

/// The lines that differ.
fn text_edit(uri: &str, client: &Client, before: &str, after: &str) -> Value {
    let [old, new] = [before, after].map(|text| text.split_inclusive('\n').collect::<Vec<_>>());
    let same = |pairs: &mut dyn Iterator<Item = (&&str, &&str)>| {
        pairs.take_while(|(old, new)| old == new).count()
    };
    let first = same(&mut old.iter().zip(&new));
    let last = same(&mut old[first..].iter().rev().zip(new[first..].iter().rev()));
    let mut edit = json!({
        "range": {
            "start": { "line": first, "character": 0 },
            "end": { "line": old.len() - last, "character": 0 },
        },
        "newText": new[first..new.len() - last].concat(),
    });
    if client.late_edits == LateEdits::Shown {
        edit["annotationId"] = json!(NAME);
    }
    json!({ "textDocument": { "uri": uri, "version": null }, "edits": [edit] })
}
