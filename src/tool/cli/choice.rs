//! Which of the files that were read are the program, and for which robot.

use std::path::Path;

use anyhow::bail;

use super::backup::{self, Backup, Task};
use super::input::{Input, InputFile};

/// The files of one program.
#[derive(Debug)]
pub struct Choice<'i> {
    /// They, in the order of the input.
    pub files: Vec<&'i InputFile>,
    /// The task of a backup that they are of.
    pub task: Option<&'i Task>,
    /// The folder of that backup.
    pub backup: Option<&'i Path>,
    /// What was chosen, for people.
    pub notes: Vec<String>,
}

/// Chooses all files, or of a controller backup the modules of one motion task with what is
/// named beside them.
///
/// # Errors
/// When the files are of several backups.
pub fn choose(input: &Input) -> anyhow::Result<Choice<'_>> {
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

/// The task to run: the one that moves a robot, the first of several.
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
