//! Instructions that change how movements run.

use std::sync::Arc;

use super::arguments::Arguments;
use super::executor::Executor;
use crate::rapid::builtins::Setting;
use crate::rapid::ir::convert;
use crate::rapid::ir::hir::Stmt;
use crate::rapid::ir::movement::Settings;
use crate::rapid::ir::value::{Datum, Value};

/// Smallest limit of `PathAccLim` and `WorldAccLim`, m/s²; smaller values are raised to it.
const LEAST_ACCELERATION: f64 = 0.1;

/// Largest override of `VelSet`, %.
const MOST_OVERRIDE: f64 = 200.0;

/// Why a setting is not applied.
enum NotSet {
    /// Its value is not known.
    Unknown,
    /// The controller stops with an error at this value.
    Refused(String),
    /// The value stops all movements.
    StopsMovements,
}

impl Executor<'_> {
    pub(super) fn setting(
        &mut self,
        stmt: &Stmt,
        text: &str,
        setting: Setting,
        arguments: &Arguments<'_>,
    ) {
        match setting {
            Setting::PDispOn if arguments.has_option("exep") => {
                self.displace(stmt, text, arguments);
            }
            Setting::PDispOn => self.unmodelled(stmt, text),
            Setting::PathAccLim => self.path_acceleration(stmt, text, arguments),
            Setting::WorldAccLim => self.world_acceleration(stmt, text, arguments),
            Setting::SingArea => self.sing_area(text, arguments),
            Setting::PathResol => self.path_resolution(stmt, text, arguments),
            Setting::MotionProcessMode => self.process_mode(stmt, text, arguments),
            Setting::CirPathMode => self.circle_mode(stmt, text, arguments),
            Setting::AccSet
            | Setting::ConfJ
            | Setting::ConfL
            | Setting::GripLoad
            | Setting::PDispOff
            | Setting::PDispSet
            | Setting::SpeedRefresh
            | Setting::SystemData
            | Setting::VelSet => self.apply_setting(stmt, text, setting, arguments),
        }
    }

    /// Applies a setting that consists of the values of its arguments.
    fn apply_setting(
        &mut self,
        stmt: &Stmt,
        text: &str,
        setting: Setting,
        arguments: &Arguments<'_>,
    ) {
        let mut values = Vec::new();
        for expr in &arguments.positional {
            values.push(self.eval_level(expr));
        }
        match self.change_setting(setting, &values, arguments) {
            Ok(()) => self.clear_unmodelled(&[&text.to_lowercase()]),
            Err(NotSet::Unknown) => self.not_known(stmt, text),
            Err(NotSet::Refused(what)) => self.refused(stmt, text, &what),
            Err(NotSet::StopsMovements) => {
                let reason = format!("{text} 0 stops all movements: taken as if it were not there");
                self.unresolved(stmt.span, reason);
            }
        }
    }

    fn change_setting(
        &mut self,
        setting: Setting,
        values: &[Value],
        arguments: &Arguments<'_>,
    ) -> Result<(), NotSet> {
        let num = |i: usize| values.get(i).and_then(|v| v.datum.num()).ok_or(NotSet::Unknown);
        let first = || values.first().map(|value| &value.datum).ok_or(NotSet::Unknown);
        let on = arguments.has_option("on");
        match setting {
            Setting::VelSet => set_speed(self.settings_mut(), num(0)?, num(1)?)?,
            Setting::AccSet => {
                let (acceleration, ramp) = (num(0)?, num(1)?);
                let fine = arguments.option_value("finepointramp");
                let fine = fine.and_then(|expr| self.eval(expr).datum.num());
                let settings = self.settings_mut();
                // The controller raises lower values to 20 % and 10 %.
                settings.fine_point_ramp = fine.unwrap_or(100.0).clamp(10.0, 100.0) / 100.0;
                settings.acceleration = acceleration.clamp(20.0, 100.0) / 100.0;
                settings.ramp = ramp.clamp(10.0, 100.0) / 100.0;
            }
            Setting::SpeedRefresh => match num(0)? {
                percent if percent > 0.0 && percent <= 100.0 => {
                    self.settings_mut().refresh = percent / 100.0;
                }
                0.0 => return Err(NotSet::StopsMovements),
                percent => return Err(NotSet::Refused(format!("{percent} % of the speed"))),
            },
            Setting::ConfJ => self.settings_mut().conf_joint = on,
            Setting::ConfL => self.settings_mut().conf_linear = on,
            Setting::GripLoad => {
                let datum = first()?;
                let load = convert::load(datum).map_err(|why| {
                    self.explain_argument(arguments.positional[0], datum, &why);
                    NotSet::Unknown
                })?;
                let settings = self.settings_mut();
                settings.grip_load = Some(load);
                settings.grip_load_data = Some(datum.clone());
                self.clear_unmodelled(&["gripload", "setsysdata"]);
            }
            Setting::SystemData => match values.first().map(|value| &*value.type_key) {
                // The name of the object is computed.
                _ if arguments.has_option("objectname") => return Err(NotSet::Unknown),
                // Movements name their own.
                Some("tooldata" | "wobjdata") => {}
                _ => return self.change_setting(Setting::GripLoad, values, arguments),
            },
            Setting::PDispSet => {
                let pose = convert::pose(first()?, "the displacement");
                self.settings_mut().displacement = Some(pose.map_err(|_| NotSet::Unknown)?);
            }
            _ => {
                self.settings_mut().displacement = None;
                self.clear_unmodelled(&["pdispon"]);
            }
        }
        Ok(())
    }

    pub(super) fn settings_mut(&mut self) -> &mut Settings {
        Arc::make_mut(&mut self.settings)
    }

    /// Reports a value at which the controller stops with an error.
    fn refused(&mut self, stmt: &Stmt, text: &str, what: &str) {
        self.unresolved(
            stmt.span,
            format!(
                "the controller stops with an error here: {text} with {what}; taken as if it were \
                 not there"
            ),
        );
        self.mark_unmodelled(text);
    }

    fn not_known(&mut self, stmt: &Stmt, text: &str) {
        self.mark_unmodelled(text);
        let reason = format!("{text} with a value that is not known: simulated as before it");
        self.unresolved(stmt.span, reason);
    }

    fn sing_area(&mut self, text: &str, arguments: &Arguments<'_>) {
        self.settings_mut().sing_area = arguments
            .optional
            .iter()
            .find(|(name, _)| name.key != "off")
            .map(|(name, _)| format!("{text}\\{}", name.text).into());
    }

    /// `PathAccLim AccLim [\AccMax], DecelLim [\DecelMax]`.
    fn path_acceleration(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let mut limits = [f64::INFINITY; 2];
        let mut known = arguments.positional.len() == 2;
        let options = ["accmax", "decelmax"];
        for (i, (expr, option)) in arguments.positional.iter().zip(options).enumerate() {
            match self.eval(expr).datum {
                Datum::Bool(false) => {}
                Datum::Bool(true) => {
                    let value = arguments.option_value(option);
                    match value.and_then(|expr| self.eval(expr).datum.num()) {
                        Some(limit) => limits[i] = self.raised_to_least(stmt, text, limit),
                        None => known = false,
                    }
                }
                _ => known = false,
            }
        }
        if known {
            self.clear_unmodelled(&["pathacclim"]);
            self.settings_mut().path_acceleration = limits;
        } else {
            self.not_known(stmt, text);
        }
    }

    /// An acceleration limit, raised to [`LEAST_ACCELERATION`] if it is smaller.
    fn raised_to_least(&mut self, stmt: &Stmt, text: &str, limit: f64) -> f64 {
        if limit < LEAST_ACCELERATION {
            let reason = format!(
                "{text} with {limit} m/s², less than the controller takes: simulated with \
                 {LEAST_ACCELERATION} m/s²"
            );
            self.unresolved(stmt.span, reason);
        }
        limit.max(LEAST_ACCELERATION)
    }

    /// `WorldAccLim \On := m/s²` or `\Off`.
    fn world_acceleration(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let on = arguments.option_value("on").map(|expr| self.eval(expr).datum.num());
        let limit = match on {
            None if arguments.has_option("off") => f64::INFINITY,
            Some(Some(limit)) => self.raised_to_least(stmt, text, limit),
            _ => return self.not_known(stmt, text),
        };
        self.clear_unmodelled(&["worldacclim"]);
        self.settings_mut().world_acceleration = limit;
    }

    /// Records a setting whose effect on movements is not modelled.
    pub(super) fn unmodelled(&mut self, stmt: &Stmt, text: &str) {
        self.unresolved(
            stmt.span,
            format!("{text} is not simulated: what follows runs as if it were not there"),
        );
        self.mark_unmodelled(text);
    }

    /// Adds an instruction to those whose effect is not modelled, as the last one.
    pub(super) fn mark_unmodelled(&mut self, text: &str) {
        self.clear_unmodelled(&[&text.to_lowercase()]);
        self.settings_mut().other.push(text.into());
    }

    /// Removes instructions (lower case) from those whose effect is not modelled.
    pub(super) fn clear_unmodelled(&mut self, keys: &[&str]) {
        let other = &mut self.settings_mut().other;
        other.retain(|name| !keys.contains(&name.to_lowercase().as_str()));
    }
}

/// `VelSet`: % of the programmed speeds, and the largest TCP speed in mm/s.
fn set_speed(settings: &mut Settings, percent: f64, max: f64) -> Result<(), NotSet> {
    if !(percent > 0.0 && percent <= MOST_OVERRIDE) {
        return Err(NotSet::Refused(format!("{percent} % of the programmed speed")));
    }
    if max <= 0.0 {
        return Err(NotSet::Refused(format!("a largest speed of {max} mm/s")));
    }
    settings.speed_override = percent / 100.0;
    settings.speed_max = max * 1e-3;
    Ok(())
}
