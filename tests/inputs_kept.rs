//! No command writes its output over a file that it was given.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;

use command::{IRB1600, joulepath_in, stderr};

/// A motion of all joints, 100 rows.
fn log() -> String {
    let row = |row: i32| {
        let t = 0.01 * f64::from(row);
        let q = (1..=6).map(|j| format!("{:.6}", 0.3 * (f64::from(j) * t).sin()));
        format!("{t},{},1,2,3,4,5,6", q.collect::<Vec<_>>().join(","))
    };
    let header = "t,q1,q2,q3,q4,q5,q6,tau1,tau2,tau3,tau4,tau5,tau6".to_owned();
    std::iter::once(header).chain((0..100).map(row)).collect::<Vec<_>>().join("\n") + "\n"
}

#[test]
fn inputs_are_never_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let program = fs::read_to_string("fixtures/lint/EW101_unneeded_stop_point.mod").unwrap();
    let robot = "extends = \"IRB1600-10/1.45\"\nname = \"own\"\n";
    let inputs = [
        ("p.mod", program),
        ("log.csv", log()),
        ("own.toml", robot.to_owned()),
        ("joulepath.toml", "entry = \"main\"\n".to_owned()),
        ("arm.urdf", "<robot name=\"arm\"/>".to_owned()),
    ];
    for (name, text) in &inputs {
        fs::write(folder.path().join(name), text).unwrap();
    }
    for command in [
        "simulate p.mod --robot own.toml --trajectory p.mod",
        "simulate p.mod --robot own.toml --report own.toml",
        "simulate p.mod --robot own.toml --report new.html --trajectory new.html",
        "optimize p.mod --robot own.toml --report ./p.mod",
        "optimize p.mod --robot own.toml --report own.toml",
        "optimize p.mod --robot own.toml --report joulepath.toml",
        "simulate p.mod --robot own.toml --trajectory joulepath.toml",
        "lint p.mod --robot own.toml --write-baseline joulepath.toml",
        "diagnose --robot own.toml --log log.csv --program p.mod --report p.mod",
        "diagnose --robot own.toml --log log.csv --program . --report p.mod",
        "calibrate p.mod --robot own.toml --log log.csv --out joulepath.toml",
        "robots import arm.urdf --out arm.urdf",
        "lint p.mod --robot own.toml --write-baseline p.mod",
        "lint p.mod --robot own.toml --write-baseline own.toml",
        "predict --robot own.toml --log log.csv --out log.csv",
        "predict --robot own.toml --log log.csv --out own.toml",
        "identify --robot own.toml --log log.csv --out log.csv",
        "identify --robot own.toml --log log.csv --report log.csv",
        "diagnose --robot own.toml --log log.csv --out own.toml",
        "calibrate p.mod --robot own.toml --log log.csv --out p.mod",
    ] {
        let args: Vec<&str> = command.split(' ').collect();
        let output = joulepath_in(folder.path(), &args);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{command}: {message}");
        assert!(message.contains("give another name"), "{command}: {message}");
        for (name, text) in &inputs {
            assert_eq!(&fs::read_to_string(folder.path().join(name)).unwrap(), text, "{command}");
        }
        assert!(!folder.path().join("new.html").exists(), "{command}");
    }
    // With another name they run.
    let run = ["simulate", "p.mod", "--robot", IRB1600, "--trajectory", "new.csv"];
    assert_eq!(joulepath_in(folder.path(), &run).status.code(), Some(0));
}
