//! System data and functions of the controller.

use nalgebra::Isometry3;

use super::executor::Executor;
use crate::rapid::ir::convert;
use crate::rapid::ir::hir::{Arg, ArgKind, Expr};
use crate::rapid::ir::value::{Datum, Dependence, Origin, Value};
use crate::rapid::text::Span;

/// RAPID's value of an axis that does not exist.
pub(super) const NO_AXIS: f64 = 9e9;
/// Value of a limit that is off.
const OFF: f64 = -1.0;

impl Executor<'_> {
    /// The system data with this name in lower case.
    pub(super) fn system_data(&self, key: &str, span: Span) -> Option<Value> {
        match key {
            "c_progdisp" => Some(Value::constant(self.displacement(), "progdisp")),
            "c_motset" => Some(Value::constant(self.motion_settings(span), "motsetdata")),
            _ => None,
        }
    }

    fn displacement(&self) -> Datum {
        let shift = self.settings.displacement.unwrap_or_else(Isometry3::identity);
        Datum::List(vec![convert::pose_datum(&shift), Datum::nums([0.0; 6])])
    }

    fn motion_settings(&self, span: Span) -> Datum {
        let settings = &self.settings;
        let percent = |share: f64| (100.0 * share).round();
        let [override_percent, max, acceleration, ramp] = settings.limits();
        let area = settings.sing_area.as_deref().unwrap_or_default().to_lowercase();
        let sing = ["\\wrist", "\\lockaxis4", "\\arm", "\\base"];
        let limit = |limit: f64| {
            let is_on = limit.is_finite();
            [Datum::Bool(is_on), Datum::Num(if is_on { limit } else { OFF })]
        };
        let [along, back] = settings.path_acceleration.map(limit);
        let on = Datum::Bool(true);
        let conf = [Datum::Bool(settings.conf_joint), Datum::Bool(settings.conf_linear)];
        let zeros = [0.0; 3].map(Datum::Num);
        let mut all = vec![
            Datum::nums([override_percent, max]),
            Datum::nums([acceleration, ramp, percent(settings.fine_point_ramp)]),
            Datum::List(sing.map(|kind| Datum::Bool(area.ends_with(kind))).to_vec()),
            Datum::List(conf.into_iter().chain(zeros).collect()),
            settings.path_resolution.map_or_else(
                || Datum::unknown("PathResol with a value that is not known", span),
                |share| Datum::Num(percent(share)),
            ),
            on.clone(),
            Datum::Num(100.0),
        ];
        all.extend(along.into_iter().chain(back));
        all.push(Datum::Num(f64::from(settings.circle_mode)));
        all.extend(limit(settings.world_acceleration));
        all.push(on);
        Datum::List(all)
    }

    /// `CSpeedOverride()`: the operator's override; with `\\CTask` the value of `SpeedRefresh`.
    pub(super) fn speed_override(&self, args: &[Arg], expr: &Expr) -> Value {
        let asks = |arg: &Arg| matches!(&arg.kind, ArgKind::Optional(n, _) if n.key == "ctask");
        let percent = if !args.iter().any(asks) {
            self.machine.override_percent()
        } else if self.settings.other.iter().any(|name| name.eq_ignore_ascii_case("speedrefresh")) {
            return Value::unknown("SpeedRefresh with a value that is not known", expr.span);
        } else {
            (100.0 * self.settings.refresh).round()
        };
        Value::constant(Datum::Num(percent), "num")
    }

    /// `GetSysInfo(\\RobotType)`: the robot type that the controller reports.
    pub(super) fn system_info(&self, options: &[(&str, Option<Value>)], expr: &Expr) -> Value {
        let asked = options.first().map_or("", |(option, _)| *option);
        match self.machine.robot_type().filter(|_| asked == "robottype") {
            Some(name) => Value::constant(Datum::Text(name.into()), "string"),
            None => Value::unknown("GetSysInfo depends on the controller", expr.span),
        }
    }

    /// `CalcRobT(joints, tool [\\WObj])`: the target of the tool, without its configuration.
    pub(super) fn robtarget_at(
        &mut self,
        values: &[Value],
        options: &[(&str, Option<Value>)],
        expr: &Expr,
    ) -> Value {
        match self.pose_at(values, options) {
            Ok(at) => {
                let [trans, rot] = convert::pose_parts(&at);
                let (conf, external) = (Datum::nums([0.0; 4]), Datum::nums([NO_AXIS; 6]));
                Value {
                    datum: Datum::List(vec![trans, rot, conf, external]),
                    type_key: "robtarget".into(),
                    origin: Origin::of(Dependence::RobotState),
                }
            }
            Err(why) => Value::unknown(why, expr.span),
        }
    }

    fn pose_at(
        &mut self,
        values: &[Value],
        options: &[(&str, Option<Value>)],
    ) -> Result<Isometry3<f64>, String> {
        let [joints, tool, ..] = values else { return Err("CalcRobT has no tool".into()) };
        let tool = convert::tool(&tool.datum, "tool")?;
        let wobj = options.iter().find(|(option, _)| *option == "wobj");
        let wobj = wobj.and_then(|(_, value)| value.as_ref());
        let wobj = wobj.map(|value| convert::work_object(&value.datum)).transpose()?;
        if !tool.robhold || wobj.as_ref().is_some_and(|wobj| wobj.robhold || !wobj.fixed) {
            return Err("CalcRobT of a tool or work object that is held otherwise".into());
        }
        let flange = self.machine.flange(&convert::jointtarget(&joints.datum)?);
        let at = flange.ok_or("CalcRobT needs the robot's kinematics")? * tool.frame;
        let at = wobj.map_or(at, |wobj| wobj.frame.inverse() * at);
        Ok(self.settings.displacement.map_or(at, |shift| shift.inverse() * at))
    }
}
