//! All numbers of the method that were chosen: each with its unit and where it comes from.
//!
//! `blind sensitivity` changes each of them and counts the cases whose verdict changes.

/// One number: its name, unit, origin, and access to it.
pub struct Tunable {
    /// Name of the field.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Where the value comes from.
    pub origin: &'static str,
    /// The field.
    pub of: fn(&mut Tunables) -> &mut f64,
}

macro_rules! tunables {
    ($($(#[doc = $what:literal])+ $name:ident = $value:expr, $unit:literal, $origin:literal;)+) => {
        /// The numbers of the method that were chosen.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Tunables {
            $($(#[doc = $what])+ pub $name: f64,)+
        }

        impl Tunables {
            /// The values that are used.
            pub const DEFAULT: Tunables = Tunables { $($name: $value,)+ };
            /// All numbers.
            pub const ALL: &[Tunable] = &[
                $(Tunable {
                    name: stringify!($name),
                    unit: $unit,
                    origin: $origin,
                    of: |all| &mut all.$name,
                },)+
            ];
        }
    };
}

tunables! {
    /// Share of the largest speed below which speeds are resolved linearly.
    slow = 0.03, "1", "derived: Stribeck speeds are 1 to 10 % of the largest one";
    /// Half waves at which the amplitude of a smooth error is halved.
    halved = 2.0, "1", "derived: everyday errors are smooth over the range of a joint";
    /// Angle in which everyday friction builds up after a reversal.
    fade_angle = 0.002, "rad", "EFFECTS.md F11: 1 to 20 mrad";
    /// Time in which the torque path follows a jump.
    fade_time = 0.004, "s", "EFFECTS.md C8: 1 to 15 ms";
    /// Everyday lag of all torques.
    lag = 0.0025, "s", "derived: an effect is named from 12 ms on, where its evidence is 8 nats and its cost";
    /// Delay whose difference from a lag is the form of the lag: a filter of second order.
    lag_form = 0.01, "s", "derived: a corner frequency of 25 Hz";
    /// Everyday lag of one joint beyond that of all.
    joint_lag = 0.001, "s", "chosen on data/gap_cases";
    /// Inertia of the rotor that a model lacks, of the inertia of the joint.
    missing_rotor = 10.0, "1", "derived: the rotor of a wrist has several times the inertia of a bare flange";
    /// Errors of friction, as shares of it, over errors of the bodies, as shares of the torque.
    of_friction = 5.0, "1", "derived: --trust has 1 % for masses and 5 % for friction";
    /// Median of a smooth everyday error, of the torque.
    smooth = 0.003, "1", "derived: 0.2 to 3 % of the torque in all";
    /// Its spread.
    smooth_spread = 0.8, "ln", "derived: a factor of 15 between the 5 % and the 95 % quantile";
    /// Median of everyday friction after a reversal, of Coulomb friction.
    reversal = 1.0, "1", "derived: friction builds up from its other sign";
    /// Its spread.
    reversal_spread = 1.0, "ln", "derived";
    /// Median of the change of friction from log to log, of the friction.
    log_friction = 0.01, "1", "EFFECTS.md: 1 to 3 % from day to day";
    /// Its spread.
    log_friction_spread = 0.7, "ln", "derived";
    /// Median of the change of friction, as a function, from day to day, of the torque.
    day = 0.0005, "1", "chosen on data/gap_cases";
    /// The same after a reversal, of Coulomb friction.
    day_reversal = 0.03, "1", "derived: a tenth of the everyday size";
    /// Spread of both.
    day_spread = 0.5, "ln", "chosen on data/gap_cases";
    /// Median of the error that no function explains, of the torque in a range of frequencies.
    error = 0.001, "1", "derived: a third of a smooth error";
    /// Its spread.
    error_spread = 1.0, "ln", "derived";
    /// Median of the noise of a log that does not repeat, of the torque.
    white = 0.01, "1", "derived: 0.5 to 1 % of the range";
    /// Its spread.
    white_spread = 1.5, "ln", "derived";
    /// Median of the deviation of a law's form, of the law.
    form = 0.1, "1", "derived: forms in the literature differ by 5 to 20 %";
    /// Its spread, and that of what no form explains.
    form_spread = 0.6, "ln", "chosen on data/gap_cases";
    /// Median of what no form of a law explains, of the law.
    law_error = 0.03, "1", "derived: a third of a form";
    /// Spread of an effect's amplitude about its usual one.
    amplitude_spread = 1.0, "ln", "derived: effects are usual within a factor of 3";
    /// How many times more than it is trusted a link may have changed.
    link_change = 5.0, "1", "derived: from commissioned to cad";
    /// Cost of an effect.
    effect_cost = 3.0, "nats", "derived: one of 20 effects";
    /// Cost of a joint.
    joint_cost = 1.2, "nats", "derived: three of ten joints";
    /// Least evidence of an effect.
    least_nats = 25.0, "nats", "chosen on world C, seed 3101 (120 cases): 5 of 12 wrong effects have 20 to 23, 1 of 45 right ones less than 33";
    /// Least evidence of a further joint.
    joint_nats = 3.8, "nats", "derived: 1 to 7";
    /// Evidence within which effects are told together.
    class_nats = 8.6, "nats", "derived: 1 to 100";
    /// Least size of an effect, of a joint's torque.
    least_share = 0.01, "1", "chosen on data/gap_cases";
    /// The same of a change since the baseline.
    least_change = 0.005, "1", "chosen on data/gap_cases";
    /// The same, of the everyday error of the joint.
    over_everyday = 2.0, "1", "chosen on worlds A and B, seed 31, and data/gap_cases";
    /// The same at most, of what is left where that is more than any everyday error.
    over_unexplained = 3.0, "1", "derived: nine tenths of the squares are explained";
    /// Largest everyday error, of the torque.
    usual_error = 0.03, "1", "derived: 0.2 to 3 % of the torque";
    /// Noise over that of the baseline that is a finding.
    noise_ratio = 3.0, "1", "chosen on data/gap_cases";
    /// Size of an effect, of a larger one with which it may be confused at the same joint.
    of_confused = 0.35, "1", "derived: three times the usual deviation of a form";
    /// What is left of the gap in held-out data with an effect.
    left_in_heldout = 0.9, "1", "derived: 1 to 0.5";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_at_most_forty() {
        assert!(Tunables::ALL.len() <= 40);
        let mut all = Tunables::DEFAULT;
        let values: Vec<f64> = Tunables::ALL.iter().map(|of| *(of.of)(&mut all)).collect();
        assert!(values.iter().all(|value| *value > 0.0));
    }
}
