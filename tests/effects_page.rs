//! `docs/effects.md` is what the register says.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::fs;
use std::path::Path;

use joulepath::arm::effects::page;

#[test]
fn the_page_is_fresh() {
    let fresh = page();
    let written = fs::read_to_string("docs/effects.md").unwrap_or_default();
    if fresh != written {
        let to = Path::new(env!("CARGO_TARGET_TMPDIR")).join("effects.md");
        fs::write(&to, fresh).unwrap();
        panic!("docs/effects.md is not what the register says; copy {} there", to.display());
    }
}
