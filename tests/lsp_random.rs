//! Properties of the language server on the shipped programs: a rename changes names and nothing else,
//! and a session with many edits answers like a new one.

#![cfg(feature = "lsp")]
#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod lsp_client;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use fastrand::Rng;
use joulepath::rapid::check::{Extent, Task, check};
use joulepath::rapid::ir::lower;
use joulepath::rapid::names::{Meaning, Names, SourceText};
use joulepath::rapid::syntax::{self, Parse};
use joulepath::rapid::text::{FileId, SourceFile};
use serde_json::{Value, json};

use lsp_client::{Client, Memory, Place, edited, uri};

/// Renames in each program.
const RENAMES: usize = 6;
/// Edits of the random session, and after how many of them it is compared with a new one.
const EDITS: usize = 5_000;
const COMPARED_AFTER: usize = 250;

/// The modules below a folder of `fixtures`.
fn modules(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        if path.is_dir() {
            modules(&path, found);
        } else if ["mod", "sys", "prg", "modx", "sysx"].iter().any(|known| extension == *known) {
            found.push(path);
        }
    }
}

/// Programs: each file alone, and the files of a folder together where they are one program.
fn programs() -> Vec<Memory> {
    let mut programs = Vec::new();
    for folder in ["hard", "lint", "syntax/ok", "syntax/err", "coverage", "check"] {
        let mut found = Vec::new();
        modules(&Path::new("fixtures").join(folder), &mut found);
        programs.extend(found.into_iter().map(|path| memory(&[path])));
    }
    for folder in ["pick_place", "paper", "backup/RAPID"] {
        let mut found = Vec::new();
        let folder = Path::new("fixtures").join(folder);
        if folder.is_dir() {
            modules(&folder, &mut found);
            programs.push(memory(&found));
        }
    }
    programs
}

fn memory(paths: &[PathBuf]) -> Memory {
    let file = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_str().unwrap().replace(' ', "_");
        (name, fs::read(path).unwrap())
    };
    Memory { files: paths.iter().map(file).collect(), ..Memory::default() }
}

/// A program with its parses and names.
struct Read {
    files: Vec<SourceFile>,
    parses: Vec<Parse>,
    names: Names,
}

fn read(files: Vec<SourceFile>) -> Read {
    let parses: Vec<Parse> = files.iter().map(|file| syntax::parse(&file.bytes)).collect();
    let names = Names::new(&sources(&files, &parses));
    Read { files, parses, names }
}

fn sources<'s>(files: &'s [SourceFile], parses: &'s [Parse]) -> Vec<SourceText<'s>> {
    files.iter().zip(parses).map(|(file, parse)| SourceText { file, parse }).collect()
}

impl Read {
    fn new(memory: &Memory) -> Read {
        let file = |(index, (name, bytes)): (usize, &(String, Vec<u8>))| {
            SourceFile::new(FileId(index as u32), name.clone(), bytes.clone())
        };
        read(memory.files.iter().enumerate().map(file).collect())
    }

    /// The files with the edits of a client.
    fn with(&self, edits: &BTreeMap<String, Vec<Value>>) -> Read {
        let file = |file: &SourceFile| match edits.get(&file.path) {
            None => file.clone(),
            Some(edits) => {
                let bytes = file.charset.encode(&edited(&decoded(file), edits)).unwrap();
                let mark: &[u8] = if file.charset.bom { b"\xEF\xBB\xBF" } else { b"" };
                let bytes = file.stored(&[mark, &bytes].concat()).into_owned();
                let new = SourceFile::new(file.id, file.path.clone(), bytes);
                assert_eq!(new.charset, file.charset, "{}", file.path);
                new
            }
        };
        read(self.files.iter().map(file).collect())
    }

    /// The role and meaning of every identifier. Declarations have numbers by their order.
    fn meanings(&self) -> String {
        let mut text = String::new();
        for file in &self.files {
            for one in self.names.uses(file.id) {
                writeln!(text, "{:?} {:?}", one.role, one.meaning).unwrap();
            }
        }
        text
    }

    /// The plain program of all files, in lower case.
    fn lowered(&self) -> String {
        let lowered = self.files.iter().zip(&self.parses);
        let lowered = lowered.map(|(file, parse)| lower(file.id, parse, &file.bytes));
        format!("{:?}", lowered.collect::<Vec<_>>()).to_lowercase()
    }

    fn duplicates(&self) -> usize {
        let sources = sources(&self.files, &self.parses);
        let task = Task { files: &sources, extent: &Extent::Task, entry: "main" };
        let duplicate =
            |code: &Option<String>| code.as_ref().is_some_and(|code| code == "duplicate-name");
        check(&task).into_iter().filter(|it| duplicate(&it.code)).count()
    }

    /// A random identifier of a declaration of a file: its name, and its place.
    fn identifier(&self, rng: &mut Rng) -> Option<(String, Place)> {
        let mut all = Vec::new();
        for file in &self.files {
            let declared = self.names.uses(file.id).iter().filter(|one| match one.meaning {
                Meaning::Declared(id) => !self.names.is_predefined(id),
                _ => false,
            });
            all.extend(declared.map(|one| (file, *one)));
        }
        let (file, one) = *rng.choice(&all)?;
        let before = file.bytes[..one.start as usize].to_vec();
        let text = decoded(file);
        let start = decoded_bytes(file, &before).len();
        let name = decoded_bytes(file, &file.bytes[one.start as usize..one.end as usize]);
        Some((name, Place::of(&file.path, &text, start)))
    }

    fn words(&self) -> BTreeSet<String> {
        let mut words = BTreeSet::new();
        for file in &self.files {
            for one in self.names.uses(file.id) {
                let bytes = &file.bytes[one.start as usize..one.end as usize];
                words.insert(decoded_bytes(file, bytes).to_lowercase());
            }
        }
        words
    }
}

/// The text as an editor has it: without a byte order mark.
fn decoded(file: &SourceFile) -> String {
    decoded_bytes(file, &file.bytes)
}

fn decoded_bytes(file: &SourceFile, bytes: &[u8]) -> String {
    file.charset.decode(bytes).trim_start_matches('\u{FEFF}').to_owned()
}

/// A name with this many letters that nothing has.
fn fresh(rng: &mut Rng, length: usize, words: &BTreeSet<String>) -> Option<String> {
    (0..100).find_map(|_| {
        let name: String =
            (0..length).map(|_| *rng.choice(&['a', 'b', 'q', 'w', 'x', 'z']).unwrap()).collect();
        let reserved = syntax::tokenize(name.as_bytes()).kind(0).is_keyword();
        let used = words.contains(&name) || joulepath::rapid::builtins::is_known(&name);
        (!reserved && !used).then_some(name)
    })
}

/// After a rename to a new name of the same length the plain program is the same but for this name.
#[test]
fn renames_leave_the_program_as_it_is() {
    let mut rng = Rng::with_seed(1);
    let mut done = 0;
    for memory in programs() {
        let before = Read::new(&memory);
        let words = before.words();
        let lowered = before.lowered();
        let mut client = Client::start(memory, &json!({}));
        for _ in 0..RENAMES {
            let Some((old, place)) = before.identifier(&mut rng) else { continue };
            let Some(new) = fresh(&mut rng, old.len(), &words) else { continue };
            if old.len() > 32 || !old.is_ascii() || old.eq_ignore_ascii_case("main") {
                continue;
            }
            let context = format!("{place:?}: {old} -> {new}");
            let edits = match client.try_rename(&place, &new) {
                Ok(edits) => edits,
                // A new name is refused only where the old one may mean more.
                Err(reason) => {
                    assert!(reason.contains("may mean it, too"), "{context}: {reason}");
                    continue;
                }
            };
            let after = before.with(&edits);
            assert_eq!(after.meanings(), before.meanings(), "{context}");
            // The places of both are equal, because the names are equally long.
            let quoted = |name: &str| format!("\"{}\"", name.to_lowercase());
            let renamed = after.lowered();
            let back = renamed.replace(&quoted(&new), &quoted(&old));
            assert!(back == lowered.replace(&quoted(&new), &quoted(&old)), "{context}");
            for (old, new) in before.parses.iter().zip(&after.parses) {
                assert_eq!(old.errors, new.errors, "{context}");
            }
            done += 1;
        }
    }
    assert!(done > 500, "only {done} renames");
}

/// A rename to a name that the program has is refused, or leaves every meaning as it is and declares
/// nothing twice.
#[test]
fn renames_to_names_of_the_program_change_no_meaning() {
    let mut rng = Rng::with_seed(2);
    let (mut accepted, mut refused) = (0, 0);
    for memory in programs() {
        let before = Read::new(&memory);
        let words: Vec<String> = before.words().into_iter().collect();
        let duplicates = before.duplicates();
        let mut client = Client::start(memory, &json!({}));
        for _ in 0..RENAMES {
            let Some((old, place)) = before.identifier(&mut rng) else { continue };
            let Some(new) = rng.choice(&words) else { continue };
            let answer = client.try_rename(&place, new);
            let Ok(edits) = answer else {
                refused += 1;
                continue;
            };
            let after = before.with(&edits);
            assert_eq!(after.meanings(), before.meanings(), "{place:?}: {old} -> {new}");
            assert!(after.duplicates() <= duplicates, "{place:?}: {old} -> {new}");
            accepted += 1;
        }
    }
    assert!(accepted > 20 && refused > 200, "{accepted} accepted, {refused} refused");
}

/// Parts of programs, whole and broken.
const PARTS: [&str; 16] = [
    "",
    " ",
    "\n",
    "\r\n",
    ";",
    "nCount",
    "nÖffnung := 1;\r\n",
    "! 🙂 comment\n",
    "PROC rNew(num nCount \\switch Fast)\nENDPROC\n",
    "ENDPROC\n",
    "VAR num nCount;\n",
    "LOCAL PERS num nShared := 1;\n",
    "rWork nCount \\Fast;\n",
    "IF bDone THEN\n",
    "ENDIF\n",
    "MoveJ p10, v100, fine, tool0;\n",
];

/// The documents of a session as the test knows them.
struct Session {
    memory: Memory,
    open: BTreeMap<String, String>,
}

impl Session {
    fn start(&self) -> Client {
        let client = Client::start(self.memory.clone(), &capabilities());
        for (file, text) in &self.open {
            client.open(file, text);
        }
        client
    }

    /// The files with the texts that count.
    fn texts(&self) -> BTreeMap<String, String> {
        let stored = |(file, bytes): &(String, Vec<u8>)| {
            (file.clone(), String::from_utf8(bytes.clone()).unwrap())
        };
        let mut texts: BTreeMap<String, String> = self.memory.files.iter().map(stored).collect();
        texts.extend(self.open.clone());
        texts
    }

    /// All answers about all files.
    fn answers(&self, client: &mut Client, rng: &mut Rng) -> Vec<Value> {
        let mut answers = Vec::new();
        for (file, text) in self.texts() {
            let file = &file;
            for method in ["semanticTokens/full", "documentSymbol", "foldingRange", "formatting"] {
                answers.push(client.about(method, file));
            }
            if self.open.contains_key(file) {
                answers.push(client.about("diagnostic", file));
            }
            for _ in 0..8 {
                let place = place(rng, file, &text).1;
                for method in ["definition", "hover", "completion", "signatureHelp"] {
                    answers.push(client.at(method, &place));
                }
                answers.push(client.request("textDocument/references", place.params()));
                let renamed = client.try_rename(&place, "nFreshName");
                answers.push(renamed.map_or_else(|refusal| json!(refusal), |edits| json!(edits)));
            }
        }
        answers.push(client.request("workspace/symbol", json!({ "query": "n" })));
        answers
    }
}

/// Diagnostics are asked for, so that they are compared, too.
fn capabilities() -> Value {
    json!({ "textDocument": { "diagnostic": {} } })
}

/// A random place between two characters, not inside a line end.
fn place(rng: &mut Rng, file: &str, text: &str) -> (usize, Place) {
    let mut at = rng.usize(..=text.len());
    while !text.is_char_boundary(at) || text[..at].ends_with('\r') && text[at..].starts_with('\n') {
        at -= 1;
    }
    (at, Place::of(file, text, at))
}

#[test]
fn a_long_session_answers_like_a_new_one() {
    let main = "MODULE Main\nPERS num nShared := 1;\nVAR bool bDone;\nCONST robtarget p10 := [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nPROC main()\nrWork nShared;\nENDPROC\nENDMODULE\n";
    let work = "MODULE Work\r\nLOCAL VAR num nCount;\r\nPROC rWork(num nTimes \\switch Fast)\r\nnCount := nTimes;\r\nMoveJ p10, v100, fine, tool0;\r\nENDPROC\r\nENDMODULE\r\n";
    let other = "MODULE Other\nPERS num nShared := 1;\nPROC main()\nnShared := 2;\nrWork 1;\nENDPROC\nENDMODULE\n";
    let mut memory = Memory::new(&[("Main.mod", main), ("Work.mod", work), ("Other.mod", other)]);
    memory.tasks = vec![vec![0, 1], vec![2, 1]];
    let mut session = Session { memory, open: BTreeMap::new() };
    let mut client = session.start();
    let mut rng = Rng::with_seed(3);
    for edit in 1..=EDITS {
        let files = ["Main.mod", "Work.mod", "Other.mod", "New.mod"];
        let file = *rng.choice(&files).unwrap();
        if rng.u8(..20) == 0 && session.open.remove(file).is_some() {
            let document = json!({ "textDocument": { "uri": uri(file) } });
            client.notify("textDocument/didClose", document);
        }
        if !session.open.contains_key(file) {
            let stored = session.memory.files.iter().find(|(name, _)| name == file);
            let text = stored
                .map_or_else(String::new, |(_, bytes)| String::from_utf8(bytes.clone()).unwrap());
            client.open(file, &text);
            session.open.insert(file.to_owned(), text);
        }
        let text = session.open.get_mut(file).unwrap();
        let (start, first) = place(&mut rng, file, text);
        let mut end = start + rng.usize(..12);
        while end > text.len()
            || !text.is_char_boundary(end)
            || text[..end].ends_with('\r') && text[end..].starts_with('\n')
        {
            end = if end > text.len() { text.len() } else { end - 1 };
        }
        let (end, last) =
            if end < start { (start, first.clone()) } else { (end, Place::of(file, text, end)) };
        let new = *rng.choice(&PARTS).unwrap();
        let at = |place: &Place| json!({ "line": place.line, "character": place.character });
        let range = json!({ "start": at(&first), "end": at(&last) });
        client.change(file, &[json!({ "range": range, "text": new })]);
        text.replace_range(start..end, new);
        if edit % COMPARED_AFTER == 0 {
            let seed = rng.u64(..);
            let own = session.answers(&mut client, &mut Rng::with_seed(seed));
            let fresh = session.answers(&mut session.start(), &mut Rng::with_seed(seed));
            for (own, fresh) in own.iter().zip(&fresh) {
                assert_eq!(own, fresh, "after {edit} edits");
            }
        }
    }
}
