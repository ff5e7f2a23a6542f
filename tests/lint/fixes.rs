//! Fixes are idempotent and change nothing else in a file.

use joulepath::rapid::text::SourceFile;
use joulepath::retime::motion::timeline::What;
use joulepath::tool::lint::engine::cycles;
use joulepath::tool::lint::known::Known;
use joulepath::tool::lint::{Applicability, Fixed, fix};

use crate::planted::planted_faults;
use crate::{Fixture, fixtures};

const UNNEEDED_STOP: &str = "EW101_unneeded_stop_point.mod";

/// Energy (J), actions and end position (rad) of a cycle.
fn cycle(fixture: &Fixture) -> (f64, Vec<String>, Option<[f64; 6]>) {
    let cycles = cycles(&fixture.job(), fixture.model.as_ref().map(Known::new).as_ref());
    let cycle = cycles[0].as_ref().unwrap();
    let mut done = Vec::new();
    let mut end = None;
    for event in &cycle.simulation.events {
        match &event.what {
            What::Run(run) => end = Some(run.end),
            What::Wait(wait) => {
                let stated = wait.wait.duration;
                done.push(format!("{} {:?} {stated:?}", wait.wait.instruction, wait.wait.signal));
            }
            What::Output(output, _) => done.push(format!("{} {}", output.signal, output.value)),
            What::Left(left) => done.push(left.reason.clone()),
        }
    }
    (cycle.account.total.energy_j(), done, end)
}

fn programs() -> impl Iterator<Item = Fixture> {
    let planted = planted_faults().into_iter().map(|planted| planted.fixture);
    fixtures().into_iter().filter(|fixture| fixture.model.is_some()).chain(planted)
}

/// Fixing twice equals fixing once; the cycle takes no more energy, has the same actions in the
/// same order, and the same end.
#[test]
fn fixes_are_idempotent_and_take_no_more_energy() {
    for most in [Applicability::Safe, Applicability::Unsafe] {
        let mut applied_to = 0;
        for fixture in programs() {
            let Fixed { files, applied, .. } = fix(&fixture.job(), most);
            let text = String::from_utf8(files[0].bytes.clone()).unwrap();
            let fixed = fixture.with_text(text);
            let place = format!("{most:?} {:?}\n{}", fixture.path, fixed.text());
            assert_eq!(fix(&fixed.job(), most).files[0].bytes, files[0].bytes, "{place}");
            if applied == 0 {
                assert_eq!(fixture.files[0].bytes, files[0].bytes, "{place}");
                continue;
            }
            applied_to += 1;
            let (energy, done, end) = cycle(&fixture);
            let (energy_after, done_after, end_after) = cycle(&fixed);
            assert!(energy_after <= energy + 1e-6, "{energy} J, then {energy_after} J: {place}");
            assert_eq!(done, done_after, "{place}");
            let (end, end_after) = (end.unwrap(), end_after.unwrap());
            let near = (0..6).all(|axis| (end[axis] - end_after[axis]).abs() < 1e-4);
            assert!(near, "{end:?}, then {end_after:?}: {place}");
        }
        let least = if most == Applicability::Safe { 4 } else { 40 };
        assert!(applied_to >= least, "{most:?}: {applied_to}");
    }
}

/// Line ends, tabs and bytes of another encoding do not change.
#[test]
fn fixes_keep_line_ends_tabs_and_encoding() {
    let other = |text: &[u8]| -> Vec<u8> {
        let text = String::from_utf8(text.to_vec()).unwrap();
        let text = text.replace("    ", "\t ").replace('\n', "\r\n");
        [b"! caf\xE9\r\n", text.as_bytes()].concat()
    };
    for planted in planted_faults().into_iter().filter(|planted| planted.name.starts_with("Fires"))
    {
        let plain = fix(&planted.fixture.job(), Applicability::Unsafe);
        let mut fixture = planted.fixture;
        let file = &fixture.files[0];
        fixture.files[0] = SourceFile::new(file.id, file.path.clone(), other(&file.bytes));
        let fixed = fix(&fixture.job(), Applicability::Unsafe);
        assert_eq!(plain.applied, fixed.applied, "{} {}", planted.code, planted.name);
        let (expected, found) = (other(&plain.files[0].bytes), &fixed.files[0].bytes);
        let show = |bytes: &[u8]| bytes.escape_ascii().to_string();
        assert_eq!(show(&expected), show(found), "{} {}", planted.code, planted.name);
    }
}

/// The fix of a stop point changes only the bytes of the zone.
#[test]
fn the_fix_of_a_stop_point_changes_only_the_zone() {
    let all = fixtures();
    let mut fixture = all.into_iter().find(|it| it.path.ends_with(UNNEEDED_STOP)).unwrap();
    fixture.settings.select = vec!["EW101".to_owned()];
    let fixed = fix(&fixture.job(), Applicability::Unsafe);
    let (old, new) = (&fixture.files[0].bytes, &fixed.files[0].bytes);
    let (old, new) = (String::from_utf8_lossy(old), String::from_utf8_lossy(new));
    let changed: Vec<(&str, &str)> =
        old.lines().zip(new.lines()).filter(|(old, new)| old != new).collect();
    assert_eq!(old.lines().count(), new.lines().count());
    assert_eq!(changed.len(), fixed.applied, "{changed:?}");
    assert!(!changed.is_empty());
    for (before, after) in changed {
        assert!(before.ends_with(",fine,tGripper; !~ EW101"), "{before}");
        let zone = after.split(',').find(|part| part.starts_with('z')).unwrap();
        assert_eq!(before.replace(",fine,", &format!(",{zone},")), after);
    }
}
