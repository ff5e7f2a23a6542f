//! All rules.

use super::rule::Rule;
use super::rules as r;

/// All rules, ordered by code.
pub static ALL: [&Rule; 40] = [
    &r::unused_suppression::RULE,
    &r::unneeded_stop_point::RULE,
    &r::stop_in_line::RULE,
    &r::tiny_zone::RULE,
    &r::stop_for_output::RULE,
    &r::grip_in_passing::RULE,
    &r::racing_to_wait::RULE,
    &r::unreached_speed::RULE,
    &r::accelerated_to_wait::RULE,
    &r::reorientation_limited_line::RULE,
    &r::line_in_free_air::RULE,
    &r::slow_travel::RULE,
    &r::dwell_at_heavy_pose::RULE,
    &r::micro_move_in_dwell::RULE,
    &r::polling_wait::RULE,
    &r::slack_before_wait::RULE,
    &r::fixed_wait::RULE,
    &r::busy_loop::RULE,
    &r::move_to_same_place::RULE,
    &r::there_and_back::RULE,
    &r::detour::RULE,
    &r::near_singular_line::RULE,
    &r::long_way_round::RULE,
    &r::needless_home_run::RULE,
    &r::far_via_point::RULE,
    &r::tool_without_mass::RULE,
    &r::gripping_without_payload::RULE,
    &r::payload_never_reset::RULE,
    &r::tool0_while_gripping::RULE,
    &r::setting_never_restored::RULE,
    &r::lowered_acceleration::RULE,
    &r::lowered_speed::RULE,
    &r::conf_off_jump::RULE,
    &r::unreachable_move::RULE,
    &r::dead_procedure::RULE,
    &r::duplicated_target::RULE,
    &r::unresolved_movement::RULE,
    &r::target_out_of_reach::RULE,
    &r::brakes_never_close::RULE,
    &r::energy_signal_unused::RULE,
];

/// The rule of a code or a name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Rule> {
    let name = name.trim();
    ALL.into_iter()
        .find(|rule| rule.code.eq_ignore_ascii_case(name) || rule.name.eq_ignore_ascii_case(name))
}
