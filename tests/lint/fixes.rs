//! Fixes: applied once and for all, and nothing else of a file is touched.

use joulepath::lint::engine::cycles;
use joulepath::lint::{Applicability, Fixed, fix};

use crate::{Fixture, fixtures};

fn energy(fixture: &Fixture) -> f64 {
    cycles(&fixture.job())[0].as_ref().unwrap().account.total.energy_j()
}

/// Twice is the same as once, and the cycle takes less.
#[test]
fn fixes_are_final_and_save() {
    for most in [Applicability::Safe, Applicability::Unsafe] {
        let mut applied_to = 0;
        for fixture in fixtures().into_iter().filter(|fixture| fixture.model.is_some()) {
            let Fixed { files, applied, .. } = fix(&fixture.job(), most);
            let text = String::from_utf8(files[0].bytes.clone()).unwrap();
            let fixed = Fixture::new(fixture.path.clone(), &text);
            let again = fix(&fixed.job(), most);
            assert_eq!(again.files[0].bytes, files[0].bytes, "{:?}", fixture.path);
            if applied > 0 {
                applied_to += 1;
                assert!(energy(&fixed) <= energy(&fixture) + 1e-6, "{:?}", fixture.path);
            } else {
                assert_eq!(fixture.files[0].bytes, files[0].bytes);
            }
        }
        assert!(applied_to >= 2, "{most:?}: {applied_to}");
    }
}

/// A safe fix changes the zone and no other byte.
#[test]
fn every_other_byte_stays() {
    let all = fixtures();
    let fixture = all.iter().find(|it| it.path.ends_with("EW102_stop_in_line.mod")).unwrap();
    let fixed = fix(&fixture.job(), Applicability::Safe);
    let (old, new) = (&fixture.files[0].bytes, &fixed.files[0].bytes);
    let (old, new) = (String::from_utf8_lossy(old), String::from_utf8_lossy(new));
    let changed: Vec<(&str, &str)> =
        old.lines().zip(new.lines()).filter(|(old, new)| old != new).collect();
    let [(before, after)] = changed.as_slice() else { panic!("{changed:?}") };
    assert!(before.contains("v500,fine,tGripper; !~ EW102"), "{before}");
    assert_eq!(before.replace("v500,fine", "v500,z20"), *after);
    assert_eq!(old.len() - "fine".len() + "z20".len(), new.len());
}
