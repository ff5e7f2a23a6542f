//! A client of the language server in process, and a workspace in memory.

#![allow(
    dead_code,
    clippy::allow_attributes,
    reason = "each test uses its part of this module; an expectation would fail in the others"
)]

#[path = "../marks/mod.rs"]
mod marks;

use std::collections::BTreeMap;
use std::path::Path;
use std::thread::JoinHandle;
use std::time::Duration;

use joulepath::rapid::check::Extent;
use joulepath::rapid::format::Style;
use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::tool::lint::Programs;
use joulepath::tool::lsp::{
    ChangedFile, Host, LspError, Options, ProjectFiles, TaskFiles, serve_on,
};
use lsp_server::{Connection, Message, Notification, Request, ResponseError};
use marks::unmarked;
use serde_json::{Value, json};

/// The folder of the workspace.
const FOLDER: &str = "/cell";
/// A user who pauses for this long waits for diagnostics.
const PAUSE: Duration = Duration::from_millis(100);

/// Files in memory.
#[derive(Clone, Default)]
pub(crate) struct Memory {
    /// Names and bytes.
    pub(crate) files: Vec<(String, Vec<u8>)>,
    /// Which files are loaded together; all of them where this is empty.
    pub(crate) tasks: Vec<Vec<usize>>,
    pub(crate) style: Option<Style>,
}

impl Memory {
    pub(crate) fn new(files: &[(&str, &str)]) -> Memory {
        let owned = |(name, text): &(&str, &str)| ((*name).to_owned(), text.as_bytes().to_vec());
        Memory { files: files.iter().map(owned).collect(), ..Memory::default() }
    }
}

impl Host for Memory {
    fn project(&self, _: &Options, folder: &Path) -> ProjectFiles {
        if folder != Path::new(FOLDER) {
            return ProjectFiles::default();
        }
        let file = |(index, (name, bytes)): (usize, &(String, Vec<u8>))| {
            SourceFile::new(FileId(index as u32), format!("{FOLDER}/{name}"), bytes.clone())
        };
        let all = || vec![(0..self.files.len()).collect()];
        let tasks = if self.tasks.is_empty() { all() } else { self.tasks.clone() };
        let task = |files| TaskFiles {
            files,
            extent: Extent::Program,
            entry: "main".to_owned(),
            controller: 0,
        };
        ProjectFiles {
            files: self.files.iter().enumerate().map(file).collect(),
            tasks: tasks.into_iter().map(task).collect(),
        }
    }

    fn programs(&self, _: &Options, _: &Path) -> Programs {
        Programs::default()
    }

    fn style(&self, _: &Path) -> Result<Style, String> {
        Ok(self.style.unwrap_or_default())
    }

    fn with_stream(&self, _: &Options, _: &Path, _: u32) -> Result<Vec<ChangedFile>, String> {
        Err("these files are in memory".to_owned())
    }

    fn until_pause(&self, connection: &Connection) -> Result<Option<Message>, LspError> {
        match connection.receiver.recv_timeout(PAUSE) {
            Ok(message) => Ok(Some(message)),
            Err(error) if error.is_timeout() => Ok(None),
            Err(_) => Err(LspError::Closed),
        }
    }
}

/// A session with the server.
pub(crate) struct Client {
    connection: Connection,
    server: Option<JoinHandle<Result<(), LspError>>>,
    next: i32,
    /// What the server said at the start.
    pub(crate) capabilities: Value,
    /// The last published diagnostics by file.
    pub(crate) published: BTreeMap<String, Value>,
    /// The methods of the requests of the server.
    pub(crate) asked: Vec<String>,
}

/// The URI of a file of the workspace.
pub(crate) fn uri(name: &str) -> String {
    format!("file://{FOLDER}/{name}")
}

/// The name of a file in the workspace.
pub(crate) fn name(uri: &Value) -> String {
    let prefix = format!("file://{FOLDER}/");
    uri.as_str().unwrap().strip_prefix(&prefix).unwrap().to_owned()
}

impl Client {
    pub(crate) fn start(memory: Memory, capabilities: &Value) -> Client {
        let (own, servers) = Connection::memory();
        let server = std::thread::spawn(move || serve_on(servers, Options::default(), memory));
        let mut client = Client {
            connection: own,
            server: Some(server),
            next: 0,
            capabilities: Value::Null,
            published: BTreeMap::new(),
            asked: Vec::new(),
        };
        let folder = json!({ "uri": format!("file://{FOLDER}"), "name": "cell" });
        let params = json!({ "capabilities": capabilities, "workspaceFolders": [folder] });
        client.capabilities = client.request("initialize", params)["capabilities"].clone();
        client.notify("initialized", json!({}));
        client
    }

    pub(crate) fn notify(&self, method: &str, params: Value) {
        let notification = Notification { method: method.to_owned(), params };
        self.connection.sender.send(Message::Notification(notification)).unwrap();
    }

    pub(crate) fn request(&mut self, method: &str, params: Value) -> Value {
        self.answer(method, params).unwrap_or_else(|error| panic!("{method}: {error:?}"))
    }

    /// The message of the error in the answer to a request.
    pub(crate) fn refusal(&mut self, method: &str, params: Value) -> String {
        self.answer(method, params).expect_err(method).message
    }

    fn answer(&mut self, method: &str, params: Value) -> Result<Value, ResponseError> {
        self.next += 1;
        let request = Request::new(self.next.into(), method.to_owned(), params);
        let id = request.id.clone();
        self.connection.sender.send(Message::Request(request)).unwrap();
        loop {
            match self.connection.receiver.recv().unwrap() {
                Message::Response(response) if response.id == id => {
                    return response.response_result;
                }
                other => self.note(other),
            }
        }
    }

    fn note(&mut self, message: Message) {
        match message {
            Message::Notification(one) if one.method == "textDocument/publishDiagnostics" => {
                let file = name(&one.params["uri"]);
                self.published.insert(file, one.params["diagnostics"].clone());
            }
            Message::Request(request) => self.asked.push(request.method),
            _ => {}
        }
    }

    /// Waits for the next message that is no answer.
    pub(crate) fn wait(&mut self) {
        let message = self.connection.receiver.recv().unwrap();
        self.note(message);
    }

    pub(crate) fn open(&self, file: &str, text: &str) {
        let document =
            json!({ "uri": uri(file), "languageId": "rapid", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    pub(crate) fn change(&self, file: &str, changes: &[Value]) {
        let document = json!({ "uri": uri(file), "version": 2 });
        let params = json!({ "textDocument": document, "contentChanges": changes });
        self.notify("textDocument/didChange", params);
    }

    /// A request about a place.
    pub(crate) fn at(&mut self, method: &str, place: &Place) -> Value {
        self.request(&format!("textDocument/{method}"), place.params())
    }

    /// A request about a document.
    pub(crate) fn about(&mut self, method: &str, file: &str) -> Value {
        let params = json!({ "textDocument": { "uri": uri(file) } });
        self.request(&format!("textDocument/{method}"), params)
    }

    /// The edits of a rename by file, or why it is refused.
    pub(crate) fn try_rename(
        &mut self,
        place: &Place,
        new: &str,
    ) -> Result<BTreeMap<String, Vec<Value>>, String> {
        let answer = self.answer("textDocument/rename", place.renaming(new));
        answer.map(|answer| edits(&answer)).map_err(|error| error.message)
    }

    /// The edits of a rename by file.
    pub(crate) fn rename(&mut self, place: &Place, new: &str) -> BTreeMap<String, Vec<Value>> {
        let answer = self.request("textDocument/rename", place.renaming(new));
        edits(&answer)
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        // After a failed test the server may be gone already.
        if std::thread::panicking() {
            return;
        }
        self.request("shutdown", Value::Null);
        self.notify("exit", Value::Null);
        self.server.take().unwrap().join().unwrap().unwrap();
    }
}

/// The edits of a workspace edit by file, in the order of the text.
pub(crate) fn edits(answer: &Value) -> BTreeMap<String, Vec<Value>> {
    let changes = answer["changes"].as_object().unwrap();
    let sorted = |edits: &Value| {
        let mut edits = edits.as_array().unwrap().clone();
        edits.sort_by_key(|edit| position(&edit["range"]["start"]));
        edits
    };
    changes.iter().map(|(uri, edits)| (name(&json!(uri)), sorted(edits))).collect()
}

fn position(value: &Value) -> (u64, u64) {
    (value["line"].as_u64().unwrap(), value["character"].as_u64().unwrap())
}

/// The byte of a text at a position in UTF-16 units.
pub(crate) fn byte_at(text: &str, value: &Value) -> usize {
    let (line, character) = position(value);
    let mut start = 0;
    for _ in 0..line {
        let rest = &text[start..];
        let end = rest.find(['\r', '\n']).unwrap();
        start += end + if rest[end..].starts_with("\r\n") { 2 } else { 1 };
    }
    let mut left = character as usize;
    let mut at = start;
    for sign in text[start..].chars() {
        if left == 0 {
            break;
        }
        left = left.checked_sub(sign.len_utf16()).unwrap();
        at += sign.len_utf8();
    }
    at
}

/// A text with edits, which do not overlap.
pub(crate) fn edited(text: &str, edits: &[Value]) -> String {
    let mut out = text.to_owned();
    let mut sorted: Vec<&Value> = edits.iter().collect();
    sorted.sort_by_key(|edit| position(&edit["range"]["start"]));
    for edit in sorted.into_iter().rev() {
        let range = &edit["range"];
        let (start, end) = (byte_at(text, &range["start"]), byte_at(text, &range["end"]));
        out.replace_range(start..end, edit["newText"].as_str().unwrap());
    }
    out
}

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) file: String,
    pub(crate) line: u32,
    pub(crate) character: u32,
}

impl Place {
    /// The place of a byte of a text, in UTF-16 units.
    pub(crate) fn of(file: &str, text: &str, byte: usize) -> Place {
        let bytes = text.as_bytes();
        let ends = |at: &usize| {
            bytes[*at] == b'\n' || bytes[*at] == b'\r' && bytes.get(at + 1) != Some(&b'\n')
        };
        let last = (0..byte).rev().find(ends);
        Place {
            file: file.to_owned(),
            line: (0..byte).filter(|at| ends(at)).count() as u32,
            character: text[last.map_or(0, |at| at + 1)..byte].encode_utf16().count() as u32,
        }
    }

    pub(crate) fn params(&self) -> Value {
        let position = json!({ "line": self.line, "character": self.character });
        json!({ "textDocument": { "uri": uri(&self.file) }, "position": position })
    }

    pub(crate) fn renaming(&self, new: &str) -> Value {
        let mut params = self.params();
        params["newName"] = json!(new);
        params
    }
}

/// A workspace whose identifiers are marked: `<1>name`.
pub(crate) struct Marked {
    pub(crate) memory: Memory,
    marks: BTreeMap<u32, Place>,
}

impl Marked {
    pub(crate) fn new(files: &[(&str, &str)]) -> Marked {
        let mut memory = Memory::default();
        let mut marks = BTreeMap::new();
        for (file, text) in files {
            let (plain, found) = unmarked(text);
            let place = |(number, byte)| (number, Place::of(file, &plain[..byte], byte));
            marks.extend(found.into_iter().map(place));
            memory.files.push(((*file).to_owned(), plain.into_bytes()));
        }
        Marked { memory, marks }
    }

    pub(crate) fn start(&self) -> Client {
        Client::start(self.memory.clone(), &json!({}))
    }

    pub(crate) fn place(&self, mark: u32) -> &Place {
        &self.marks[&mark]
    }

    /// The text of a file as UTF-8.
    pub(crate) fn text(&self, file: &str) -> String {
        let (_, bytes) = self.memory.files.iter().find(|(name, _)| name == file).unwrap();
        String::from_utf8(bytes.clone()).unwrap()
    }

    /// The marks at the starts of ranges, sorted; places without a mark as text.
    pub(crate) fn named(&self, locations: &Value) -> Vec<String> {
        let shown = |location: &Value| {
            let (line, character) = position(&location["range"]["start"]);
            let place = Place {
                file: name(&location["uri"]),
                line: line as u32,
                character: character as u32,
            };
            let mark = self.marks.iter().find(|(_, marked)| **marked == place);
            mark.map_or_else(|| format!("{place:?}"), |(mark, _)| mark.to_string())
        };
        let mut shown: Vec<String> = locations.as_array().unwrap().iter().map(shown).collect();
        shown.sort_by_key(|text| (text.len(), text.clone()));
        shown
    }
}
