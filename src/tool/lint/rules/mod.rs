//! The rules, one a file.

/// The rule of a file: code, name, family, what it needs, severity, the file itself.
macro_rules! rule {
    ($code:literal, $name:literal, $family:ident, $needs:ident, $severity:ident, $file:literal) => {
        pub(crate) static RULE: crate::tool::lint::rule::Rule = crate::tool::lint::rule::Rule {
            code: $code,
            name: $name,
            family: crate::tool::lint::rule::Family::$family,
            needs: crate::tool::lint::rule::Needs::$needs,
            severity: crate::rapid::diagnostics::Severity::$severity,
            source: include_str!($file),
            check,
        };
    };
}

pub(super) mod accelerated_to_wait;
pub(super) mod brakes_never_close;
pub(super) mod busy_loop;
pub(super) mod conf_off_jump;
pub(super) mod dead_procedure;
pub(super) mod detour;
pub(super) mod duplicated_target;
pub(super) mod dwell_at_heavy_pose;
pub(super) mod energy_signal_unused;
pub(super) mod far_via_point;
pub(super) mod fixed_wait;
pub(super) mod grip_in_passing;
pub(super) mod gripping_without_payload;
pub(super) mod line_in_free_air;
pub(super) mod long_way_round;
pub(super) mod lowered_acceleration;
pub(super) mod lowered_speed;
pub(super) mod micro_move_in_dwell;
pub(super) mod move_to_same_place;
pub(super) mod near_singular_line;
pub(super) mod needless_home_run;
pub(super) mod payload_never_reset;
pub(super) mod polling_wait;
pub(super) mod racing_to_wait;
pub(super) mod reorientation_limited_line;
pub(super) mod setting_never_restored;
pub(super) mod slack_before_wait;
pub(super) mod slow_travel;
pub(super) mod stop_for_output;
pub(super) mod stop_in_line;
pub(super) mod target_out_of_reach;
pub(super) mod there_and_back;
pub(super) mod tiny_zone;
pub(super) mod tool0_while_gripping;
pub(super) mod tool_without_mass;
pub(super) mod unneeded_stop_point;
pub(super) mod unreachable_move;
pub(super) mod unreached_speed;
pub(super) mod unresolved_movement;
pub(super) mod unused_suppression;
