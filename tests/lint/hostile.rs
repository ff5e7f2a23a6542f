//! Extreme programs: damaged, deeply nested, with endless loops.

use std::fs;
use std::time::{Duration, Instant};

use crate::Fixture;
use crate::planted::planted_faults;

/// Far above the expected time, far below that of a quadratic algorithm.
const LONGEST: Duration = Duration::from_secs(40);

/// Truncated, with invalid bytes, and with exchanged halves.
#[test]
fn damaged_programs_are_linted_without_a_panic() {
    let mut random = fastrand::Rng::with_seed(12_345);
    let mut below = |limit: usize| random.usize(..limit.max(1));
    for planted in planted_faults().into_iter().filter(|planted| planted.name.starts_with("Fires"))
    {
        let mut fixture = planted.fixture;
        let whole = fixture.files[0].bytes.clone();
        let start = whole.iter().position(|byte| *byte == b'M').unwrap();
        for _ in 0..3 {
            let mut bytes = whole[start..].to_vec();
            match below(3) {
                0 => bytes.truncate(below(bytes.len())),
                1 => {
                    for _ in 0..8 {
                        let at = below(bytes.len());
                        bytes[at] = below(256) as u8;
                    }
                }
                _ => bytes.rotate_left(below(whole.len() - start)),
            }
            let file = &fixture.files[0];
            fixture.files[0] =
                joulepath::rapid::text::SourceFile::new(file.id, file.path.clone(), bytes);
            fixture.report();
        }
    }
}

fn assert_linted_in_time(main: &str, robot: &str) {
    let shared = fs::read_to_string("fixtures/lint/plants/Shared.mod").unwrap();
    let shared = if robot.is_empty() { shared.replace("! robot:", "!") } else { shared };
    let text = format!(
        "MODULE M\nPROC main()\nMoveJ pA,v1000,fine,tGripper;\n{main}\nENDPROC\nENDMODULE\n"
    );
    let fixture = Fixture::from_texts("M.mod".into(), &[text, shared]);
    assert_eq!(fixture.model.is_some(), !robot.is_empty());
    let before = Instant::now();
    fixture.report();
    assert!(before.elapsed() < LONGEST, "{:?} for {main}", before.elapsed());
}

#[test]
fn long_loops_are_linted_in_bounded_time() {
    for body in [
        "MoveJ pBUp,v1000,z10,tGripper;\nMoveJ pAUp,v1000,fine,tGripper;",
        "WaitTime 0.1;",
        "Set do1;",
        "Set do1;\nReset do1;",
        "Set do1;\nMoveJ pBUp,v1000,fine,tGripper;\nSet do2;\nMoveJ pAUp,v1000,fine,tGripper;",
        "WaitTime 5;\nMoveL Offs(pA,0,0,2),v100,fine,tGripper;\nWaitTime 5;\nMoveL pA,v100,fine,tGripper;",
    ] {
        for robot in ["", "known"] {
            assert_linted_in_time(&format!("FOR i FROM 1 TO 100000000 DO\n{body}\nENDFOR"), robot);
        }
    }
}

#[test]
fn deep_nesting_is_linted_in_bounded_time() {
    let depth = 3_000;
    let nested = "IF TRUE THEN\n".repeat(depth) + "WaitTime 1;\n" + &"ENDIF\n".repeat(depth);
    assert_linted_in_time(&nested, "known");
    assert_linted_in_time(&format!("x:={}1{};", "(".repeat(depth), ")".repeat(depth)), "known");
}
