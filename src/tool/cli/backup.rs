//! Controller backups: tasks, robots and options.
//!
//! A backup is a folder with `RAPID/TASKn/PROGMOD|SYSMOD`. `BACKINFO/backinfo.txt` lists the tasks
//! and options, `SYSPAR/SYS.cfg` the tasks that move a robot, `SYSPAR/MOC.cfg` the robots. If one
//! is missing, the folder names are used.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::arm::robot::system_parameters::{Entry, section};
use crate::rapid::text;

/// The folder of the modules that all tasks share.
const SHARED: &str = "TASK0";
/// Folders of a task that contain its modules.
const MODULE_FOLDERS: [&str; 2] = ["PROGMOD", "SYSMOD"];

/// The content of a backup that describes its controller.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(super) struct Backup {
    /// Version of `RobotWare`.
    pub(super) robotware: Option<String>,
    /// Products and options, as listed.
    pub(super) options: Vec<String>,
    /// The tasks, by folder.
    pub(super) tasks: Vec<Task>,
}

/// A task of a controller.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Task {
    /// Its folder below `RAPID`.
    pub(super) folder: String,
    /// Its name, `T_ROB1` …; the folder name if unknown.
    pub(super) name: String,
    /// Whether it moves a robot.
    pub(super) motion: bool,
    /// Type name of its robot on the controller.
    pub(super) robot: Option<String>,
    /// The routine that starts it, if stated.
    pub(super) entry: Option<String>,
}

impl Backup {
    /// Name of the task with this folder; the folder name if there is none.
    pub(super) fn task_name<'n>(&'n self, folder: &'n str) -> &'n str {
        let task = self.tasks.iter().find(|task| task.folder == folder);
        task.map_or(folder, |task| &task.name)
    }

    /// A summary in one line.
    pub(super) fn summary(&self) -> String {
        let version = self.robotware.as_deref().unwrap_or("of unknown version");
        let tasks = self.tasks.iter().map(|task| {
            let robot = task.robot.as_deref().map(|robot| format!(", {robot}"));
            let motion = if task.motion { ", motion" } else { "" };
            format!("{} ({}{motion}{})", task.name, task.folder, robot.unwrap_or_default())
        });
        let tasks: Vec<String> = tasks.collect();
        format!("backup, RobotWare {version}, tasks {}", tasks.join("; "))
    }
}

/// The backup and the task's folder that contain a module.
pub(super) fn place(path: &Path) -> Option<(PathBuf, String)> {
    let modules = path.parent()?;
    let task = modules.parent()?;
    let rapid = task.parent()?;
    let is_task = MODULE_FOLDERS.iter().any(|name| is_named(modules, name));
    (is_task && is_named(rapid, "RAPID")).then_some(())?;
    let root = rapid.parent()?.to_path_buf();
    Some((root, task.file_name()?.to_string_lossy().into_owned()))
}

/// The file of the motion configuration of the backup at `root`.
pub(super) fn motion_configuration(root: &Path) -> Option<PathBuf> {
    child(&child(root, "SYSPAR")?, "MOC.cfg")
}

/// The file that lists the modules of the backup at `root`.
pub(super) fn information(root: &Path) -> Option<PathBuf> {
    child(&child(root, "BACKINFO")?, "backinfo.txt")
}

/// Reads the backup at `root`; missing and broken parts are skipped.
pub(super) fn read(root: &Path) -> Backup {
    let file = |folder: &str, name: &str| {
        let path = child(&child(root, folder)?, name)?;
        fs::read(path).ok().map(|bytes| text::decode(&bytes).text)
    };
    let info = file("BACKINFO", "backinfo.txt").unwrap_or_default();
    let system = file("SYSPAR", "SYS.cfg").unwrap_or_default();
    let motion = file("SYSPAR", "MOC.cfg").unwrap_or_default();
    let parameters = Parameters {
        tasks: section(&system, "CAB_TASKS"),
        groups: section(&system, "MECHANICAL_UNIT_GROUP"),
        robots: section(&motion, "ROBOT"),
    };
    let products: Vec<&str> = block(&info, "PRODUCTS_ID").collect();
    let version = |line: &str| line.strip_prefix("RobotWare Version:").map(|v| v.trim().to_owned());
    let robotware = products.iter().find_map(|line| version(line));
    let options: Vec<String> =
        products.iter().filter(|line| version(line).is_none()).map(|l| (*l).to_owned()).collect();
    let names: Vec<(String, String)> = info.lines().filter_map(named_task).collect();
    let tasks = task_folders(root)
        .into_iter()
        .filter(|folder| !is_shared(folder))
        .map(|folder| {
            let known = names.iter().find(|(known, _)| known.eq_ignore_ascii_case(&folder));
            let name = known.map_or_else(|| folder.clone(), |(_, name)| name.clone());
            let motion = parameters.moves(&name);
            let robot = motion.then(|| parameters.robot(&name).or_else(|| variant(&options)));
            let entry = named(&parameters.tasks, &name).and_then(|task| task.get("entry")).cloned();
            Task { folder, name, motion, robot: robot.flatten(), entry }
        })
        .collect();
    Backup { robotware, options, tasks }
}

/// Whether all tasks share the modules of this folder.
pub(super) fn is_shared(folder: &str) -> bool {
    folder.eq_ignore_ascii_case(SHARED)
}

struct Parameters {
    tasks: Vec<Entry>,
    groups: Vec<Entry>,
    robots: Vec<Entry>,
}

impl Parameters {
    fn moves(&self, task: &str) -> bool {
        match named(&self.tasks, task) {
            Some(entry) => entry.contains_key("motiontask"),
            // The default name of motion tasks.
            None => self.tasks.is_empty() && task.to_ascii_uppercase().starts_with("T_ROB"),
        }
    }

    fn robot(&self, task: &str) -> Option<String> {
        let robot = named(&self.tasks, task)
            .and_then(|entry| entry.get("usemechanicalunitgroup"))
            .and_then(|group| named(&self.groups, group))
            .and_then(|group| group.get("robot"))
            .and_then(|robot| named(&self.robots, robot));
        let entry = match self.robots.as_slice() {
            [only] => robot.or(Some(only)),
            _ => robot,
        };
        entry?.get("use_robot_type").filter(|name| !name.is_empty()).cloned()
    }
}

fn named<'e>(entries: &'e [Entry], name: &str) -> Option<&'e Entry> {
    let is_it = |entry: &&Entry| entry.get("name").is_some_and(|n| n.eq_ignore_ascii_case(name));
    entries.iter().find(is_it)
}

/// The robot variant among the options, such as `IRB 1600-10/1.45`, if there is only one.
fn variant(options: &[String]) -> Option<String> {
    let is_variant = |option: &&String| option.starts_with("IRB ") && option.contains('-');
    let mut variants = options.iter().filter(is_variant);
    let only = variants.next().filter(|_| variants.next().is_none())?;
    // `Type C` is the generation of the castings.
    Some(only.split(" Type").next().unwrap_or(only).to_owned())
}

/// `>>TASK1: (T_ROB1,program,)` as folder and name.
fn named_task(line: &str) -> Option<(String, String)> {
    let (folder, rest) = line.trim().strip_prefix(">>")?.split_once(':')?;
    let name = rest.trim().strip_prefix('(')?.split([',', ')']).next()?.trim();
    (!name.is_empty()).then(|| (folder.trim().to_owned(), name.to_owned()))
}

/// The lines below `>>name:`, up to the next `>>`.
fn block<'t>(text: &'t str, name: &str) -> impl Iterator<Item = &'t str> {
    let is_head = move |line: &str| {
        line.strip_prefix(">>").is_some_and(|rest| rest.trim_end_matches(':') == name)
    };
    text.lines()
        .map(str::trim)
        .skip_while(move |line| !is_head(line))
        .skip(1)
        .take_while(|line| !line.starts_with(">>"))
        .filter(|line| !line.is_empty())
}

/// The files in the module folders of a task, and of the modules that all tasks share.
pub(super) fn files(root: &Path, task: &str) -> Vec<PathBuf> {
    let folders = [task, SHARED].into_iter().flat_map(|task| {
        let task = child(root, "RAPID").and_then(|rapid| child(&rapid, task));
        MODULE_FOLDERS.iter().filter_map(move |name| child(task.as_deref()?, name))
    });
    let entries = folders.filter_map(|folder| fs::read_dir(folder).ok()).flatten();
    entries.filter_map(Result::ok).map(|entry| entry.path()).collect()
}

fn task_folders(root: &Path) -> Vec<String> {
    let Some(rapid) = child(root, "RAPID") else { return Vec::new() };
    let mut folders: Vec<String> = fs::read_dir(rapid)
        .into_iter()
        .flatten()
        .filter_map(Result::ok)
        .filter(|entry| MODULE_FOLDERS.iter().any(|name| child(&entry.path(), name).is_some()))
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    // TASK2 before TASK10.
    folders.sort_by_key(|name| (name.len(), name.clone()));
    folders
}

/// The file or folder of this name, without regard to case.
pub(super) fn child(folder: &Path, name: &str) -> Option<PathBuf> {
    let exact = folder.join(name);
    if exact.exists() {
        return Some(exact);
    }
    let entries = fs::read_dir(folder).ok()?.filter_map(Result::ok);
    entries.map(|entry| entry.path()).find(|path| is_named(path, name))
}

fn is_named(path: &Path, name: &str) -> bool {
    path.file_name().is_some_and(|own| own.eq_ignore_ascii_case(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fixture() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/backup")
    }

    #[test]
    fn a_backup_tells_its_tasks_its_robot_and_its_options() {
        let backup = read(&fixture());
        assert_eq!(backup.robotware.as_deref(), Some("6.08.01.00"));
        assert!(backup.options.iter().any(|option| option == "623-1 Multitasking"));
        let task = |folder: &str, name: &str, robot: Option<&str>| Task {
            folder: folder.into(),
            name: name.into(),
            motion: robot.is_some(),
            robot: robot.map(str::to_owned),
            entry: robot.is_none().then(|| "main".to_owned()),
        };
        let expected =
            [task("TASK1", "T_WATCH", None), task("TASK2", "T_ROB1", Some("ROB1_1600_1.45_10"))];
        assert_eq!(backup.tasks, expected);
    }

    #[test]
    fn the_robot_may_be_among_the_options_only() {
        let options = ["English", "IRB 4600-40/2.55 Type C"].map(str::to_owned);
        assert_eq!(variant(&options).as_deref(), Some("IRB 4600-40/2.55"));
        assert_eq!(variant(&[options[1].clone(), "IRB 120-3/0.6".into()]), None);
    }

    #[test]
    fn folders_do_where_nothing_else_is_known() {
        let folder = tempfile::tempdir().expect("a folder");
        for task in ["TASK10", "TASK2", "TASK0"] {
            let modules = folder.path().join("rapid").join(task).join("progmod");
            fs::create_dir_all(&modules).expect("a folder");
        }
        let backup = read(folder.path());
        let names: Vec<&str> = backup.tasks.iter().map(|task| task.name.as_str()).collect();
        assert_eq!(names, ["TASK2", "TASK10"]);
        let module = folder.path().join("rapid/TASK2/progmod/a.mod");
        assert_eq!(place(&module), Some((folder.path().to_path_buf(), "TASK2".to_owned())));
    }
}
