//! The rules, one a file.

pub(super) mod racing_to_wait;
pub(super) mod stop_in_line;
pub(super) mod unneeded_stop_point;
pub(super) mod unused_suppression;
