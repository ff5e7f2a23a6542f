//! Selects the files of the program, and its robot.

use std::path::Path;

use anyhow::bail;

use super::backup::{self, Backup, Task};
use super::input::{Input, InputFile};

/// The files of one program.
#[derive(Debug)]
pub(super) struct Choice<'i> {
    /// The files, in input order.
    pub(super) files: Vec<&'i InputFile>,
    /// Their task, if they belong to a backup.
    pub(super) task: Option<&'i Task>,
    /// The folder of that backup.
    pub(super) backup: Option<&'i Path>,
    /// Notes on the selection for the user.
    pub(super) notes: Vec<String>,
}

/// Selects all files, or of a controller backup one motion task and the files named separately.
///
/// # Errors
/// The files belong to several backups.
pub(super) fn choose(input: &Input) -> anyhow::Result<Choice<'_>> {
    let Some(first) = input.files.iter().find_map(|file| file.place.as_ref()) else {
        let files = input.files.iter().collect();
        return Ok(Choice { files, task: None, backup: None, notes: Vec::new() });
    };
    if let [(one, _), (other, _), ..] = input.backups.as_slice() {
        bail!(
            "the files are of several controllers ('{}', '{}' …): name the backup of one",
            one.display(),
            other.display()
        );
    }
    let (root, backup) = &input.backups[first.backup];
    let mut folders: Vec<&str> = Vec::new();
    for place in input.files.iter().filter_map(|file| file.place.as_ref()) {
        if !backup::is_shared(&place.folder) && !folders.contains(&place.folder.as_str()) {
            folders.push(&place.folder);
        }
    }
    let mut notes = Vec::new();
    let task = task(backup, &folders, &mut notes);
    if input.files.iter().all(|file| file.named) {
        notes.clear();
    }
    let belongs = |file: &&InputFile| match (&file.place, task) {
        _ if file.named => true,
        (Some(place), Some(task)) => {
            place.folder == task.folder || backup::is_shared(&place.folder)
        }
        (place, _) => place.is_some(),
    };
    let files = input.files.iter().filter(belongs).collect();
    Ok(Choice { files, task, backup: Some(root), notes })
}

/// The task to run: the first one that moves a robot.
fn task<'b>(backup: &'b Backup, folders: &[&str], notes: &mut Vec<String>) -> Option<&'b Task> {
    let there: Vec<&Task> =
        backup.tasks.iter().filter(|task| folders.contains(&task.folder.as_str())).collect();
    let mut motion: Vec<&Task> = there.iter().copied().filter(|task| task.motion).collect();
    // T_ROB1 before T_ROB2, whatever their folders.
    motion.sort_by_key(|task| (task.name.len(), task.name.to_lowercase()));
    let shown = |task: &Task| format!("{} (RAPID/{})", task.name, task.folder);
    let task = motion.first().or(there.first()).copied()?;
    let other = if motion.len() > 1 {
        let others: Vec<String> = motion[1..].iter().map(|task| shown(task)).collect();
        Some((format!("it has other motion tasks, {}", others.join(", ")), motion[1]))
    } else if motion.is_empty() && there.len() > 1 {
        Some(("nothing says which task moves the robot".to_owned(), there[1]))
    } else {
        None
    };
    let mut note = format!("the program is task {} of the backup", shown(task));
    if let Some((why, other)) = other {
        let folder = &other.folder;
        note = format!("{note}; {why}: to run another one give its folder, BACKUP/RAPID/{folder}");
    }
    notes.push(note);
    Some(task)
}
