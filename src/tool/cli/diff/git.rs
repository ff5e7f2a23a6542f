//! Files of a git revision, by the `git` command.

use std::ffi::OsStr;
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::{Component, Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, bail};

/// Extensions of files that are read, in lower case: modules, lists of them, and what describes a
/// controller.
const EXTENSIONS: [&str; 8] = ["mod", "sys", "prg", "modx", "sysx", "pgf", "cfg", "txt"];
/// Kinds of files in a tree that have content; links and modules are left out.
const FILES: [&str; 2] = ["100644", "100755"];

/// A repository, seen from one of its folders.
pub(super) struct Repository {
    folder: PathBuf,
}

impl Repository {
    /// The repository that contains a path.
    ///
    /// # Errors
    /// git is not installed, or the path is in no repository.
    pub(super) fn at(path: &Path) -> anyhow::Result<Repository> {
        let mut folder = path.to_owned();
        while !folder.is_dir() && folder.pop() {}
        if folder.as_os_str().is_empty() {
            folder = PathBuf::from(".");
        }
        let repository = Repository { folder };
        repository.run(["rev-parse", "--git-dir"]).map(|_| repository)
    }

    /// Runs git; its standard output.
    fn run<A: AsRef<OsStr>>(&self, args: impl IntoIterator<Item = A>) -> anyhow::Result<Vec<u8>> {
        let output = self.command().args(args).output().map_err(no_git)?;
        if !output.status.success() {
            let message = String::from_utf8_lossy(&output.stderr);
            let message = message.trim().trim_start_matches("fatal: ").to_owned();
            bail!("git says: {message}");
        }
        Ok(output.stdout)
    }

    fn command(&self) -> Command {
        let mut command = Command::new("git");
        command.arg("-C").arg(&self.folder).stdin(Stdio::null());
        command
    }

    /// The tree of a revision.
    ///
    /// # Errors
    /// There is no such revision.
    pub(super) fn tree(&self, revision: &str) -> anyhow::Result<String> {
        if revision.is_empty() || revision.starts_with('-') {
            bail!("'{revision}' is not the name of a revision");
        }
        let tree = self
            .run(["rev-parse", "--verify", "--quiet", &format!("{revision}^{{tree}}")])
            .ok()
            .with_context(|| {
                format!("the repository has no revision '{revision}'; git log shows them")
            })?;
        Ok(String::from_utf8_lossy(&tree).trim().to_owned())
    }

    /// A path as the repository names it.
    pub(super) fn inner_path(&self, path: &Path) -> anyhow::Result<String> {
        let prefix = self.run(["rev-parse", "--show-prefix"])?;
        let prefix = String::from_utf8_lossy(&prefix).trim().to_owned();
        let is_here = self.folder == Path::new(".");
        let rest = if is_here { path } else { path.strip_prefix(&self.folder)? };
        let parts = rest.components().filter_map(|part| match part {
            Component::Normal(part) => Some(part.to_string_lossy()),
            _ => None,
        });
        let rest = parts.collect::<Vec<_>>().join("/");
        Ok(format!("{prefix}{rest}").trim_end_matches('/').to_owned())
    }

    /// The path of `REV:PATH`: from the top, or from the present folder with `./`.
    pub(super) fn resolved(&self, path: &str) -> anyhow::Result<String> {
        let path = path.replace('\\', "/");
        let path = match path.strip_prefix("./") {
            Some(rest) => format!("{}/{rest}", self.inner_path(&self.folder)?),
            None => path,
        };
        Ok(path.trim_matches('/').to_owned())
    }

    /// The files of a tree below a path, with their object names.
    fn files(&self, tree: &str, path: &str) -> anyhow::Result<Vec<(String, PathBuf)>> {
        let mut args = vec!["ls-tree", "-r", "-z", "--full-tree", tree];
        if !path.is_empty() {
            args.extend(["--", path]);
        }
        let listed = self.run(args)?;
        let mut files = Vec::new();
        for entry in listed.split(|byte| *byte == 0).filter(|entry| !entry.is_empty()) {
            let entry = String::from_utf8_lossy(entry);
            let Some((head, name)) = entry.split_once('\t') else { continue };
            let mut head = head.split(' ');
            let (mode, object) = (head.next().unwrap_or_default(), head.nth(1).unwrap_or_default());
            let file = PathBuf::from(name);
            // A tree that was made by hand may have names that lead elsewhere.
            let is_inside = file.components().all(|part| matches!(part, Component::Normal(_)));
            if FILES.contains(&mode) && is_inside && (name == path || is_read(&file)) {
                files.push((object.to_owned(), file));
            }
        }
        Ok(files)
    }
}

fn is_read(path: &Path) -> bool {
    let extension = path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase);
    extension.is_some_and(|extension| EXTENSIONS.contains(&extension.as_str()))
}

fn no_git(error: std::io::Error) -> anyhow::Error {
    if error.kind() == ErrorKind::NotFound {
        return anyhow::anyhow!(
            "the command git is not there: install it, or write the revision into a folder and name that"
        );
    }
    anyhow::Error::new(error).context("cannot run git")
}

/// Writes the files of a tree below a path into a folder.
///
/// # Errors
/// There are none, or they cannot be read or written.
pub(super) fn write(
    repository: &Repository,
    revision: &str,
    tree: &str,
    path: &str,
    folder: &Path,
) -> anyhow::Result<()> {
    let files = repository.files(tree, path)?;
    if files.is_empty() {
        let place = if path.is_empty() { "it".to_owned() } else { format!("'{path}' there") };
        bail!(
            "revision {revision}: no RAPID in {place}; a path of a revision counts from the top of the \
             repository, or from this folder with ./"
        );
    }
    let mut child = repository
        .command()
        .args(["cat-file", "--batch"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .map_err(no_git)?;
    let (Some(mut stdin), Some(mut stdout)) = (child.stdin.take(), child.stdout.take()) else {
        bail!("cannot talk to git");
    };
    let objects: Vec<&str> = files.iter().flat_map(|(object, _)| [object, "\n"]).collect();
    let objects = objects.concat();
    // git answers before it has read everything, so both directions run at once.
    let asked = std::thread::spawn(move || stdin.write_all(objects.as_bytes()));
    let mut answer = Vec::new();
    stdout.read_to_end(&mut answer).context("cannot read what git wrote")?;
    let told = asked.join().is_ok_and(|written| written.is_ok());
    if !told || !child.wait().is_ok_and(|status| status.success()) {
        bail!(
            "git could not read the files of revision {revision}; git fsck checks the repository"
        );
    }
    let mut rest = answer.as_slice();
    for (object, file) in &files {
        let (bytes, after) = content(rest, object).with_context(|| {
            format!("git could not read '{}' of revision {revision}", file.display())
        })?;
        rest = after;
        let target = folder.join(file);
        if let Some(parent) = target.parent() {
            std::fs::create_dir_all(parent)?;
        }
        std::fs::write(&target, bytes)
            .with_context(|| format!("cannot write '{}'", target.display()))?;
    }
    Ok(())
}

/// The content of the first answer `OBJECT blob SIZE`, and the answers after it.
fn content<'a>(answer: &'a [u8], object: &str) -> Option<(&'a [u8], &'a [u8])> {
    let end = answer.iter().position(|byte| *byte == b'\n')?;
    let head = std::str::from_utf8(&answer[..end]).ok()?;
    let size: usize = head.strip_prefix(object)?.strip_prefix(" blob ")?.parse().ok()?;
    let start = end + 1;
    let bytes = answer.get(start..start.checked_add(size)?)?;
    Some((bytes, answer.get(start + size + 1..).unwrap_or_default()))
}
