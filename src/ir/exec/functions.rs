//! RAPID's own functions, and calls of the program's.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use super::super::convert;
use super::super::hir::{Arg, ArgKind, Expr, Ident};
use super::super::program::Symbol;
use super::super::value::{Datum, Dependence, Origin, Value};
use super::Executor;
use super::eval::declared_twice;
use super::flow::Flow;

impl Executor<'_> {
    /// The value of `name(args)`.
    pub(super) fn function(&mut self, expr: &Expr, name: &Ident, args: &[Arg]) -> Value {
        if let Some(Symbol::Routine(id)) = self.program.resolve(self.frame().module, &name.key) {
            return match self.call_routine(id, args, expr.span) {
                Flow::Return(Some(value)) => value,
                _ => Value::unknown(format!("'{}' returned no value", name.text), expr.span),
            };
        }
        if self.program.resolve(self.frame().module, &name.key) == Some(Symbol::Ambiguous) {
            return Value::unknown(declared_twice(&name.text), expr.span);
        }
        match name.key.as_str() {
            "present" => return self.present(args),
            "cjointt" => return self.joint_position(expr),
            "isfile" | "opmode" | "robos" | "runmode" | "gettime" | "cdate" | "ctime" => {
                return Value::unknown(
                    format!("{} depends on the controller", name.text),
                    expr.span,
                );
            }
            _ => {}
        }
        let mut origin = Origin::default();
        let mut values = Vec::new();
        let mut turn = [0.0; 3];
        for arg in args {
            match &arg.kind {
                ArgKind::Positional(inner) | ArgKind::Named(_, inner) => {
                    let value = self.eval(inner);
                    origin.join(&value.origin);
                    values.push(value);
                }
                ArgKind::Optional(option, Some(inner)) => {
                    let value = self.eval(inner);
                    origin.join(&value.origin);
                    let axis = ["rx", "ry", "rz"].iter().position(|r| *r == option.key);
                    match (axis, value.datum.num()) {
                        (Some(axis), Some(x)) => turn[axis] = x,
                        // `Sin(x \…)` and the like have no other option that changes a value.
                        _ => values.push(value),
                    }
                }
                ArgKind::Optional(_, None) | ArgKind::Conditional(..) => {}
            }
        }
        if matches!(
            name.key.as_str(),
            "dinput" | "doutput" | "ginput" | "goutput" | "ainput" | "aoutput" | "testdi"
        ) && let Some(value) = values.pop()
        {
            return self.level(value);
        }
        for value in &mut values {
            if matches!(value.datum, Datum::Signal(_)) {
                let Datum::Signal(signal) = &value.datum else { continue };
                value.datum = Datum::unknown(
                    format!("'{signal}' is not declared in the files given"),
                    expr.span,
                );
            }
        }
        if let Some(unknown) = values.iter().find_map(|v| v.datum.first_unknown()) {
            let datum = Datum::Unknown(unknown.clone());
            return Value { datum, type_key: "".into(), origin };
        }
        let data: Vec<&Datum> = values.iter().map(|v| &v.datum).collect();
        let known = numeric(&name.key, &data)
            .map(|datum| (datum, "num"))
            .or_else(|| geometric(&name.key, &data, turn))
            .or_else(|| textual(&name.key, &data));
        if let Some((datum, type_key)) = known {
            return Value { datum, type_key: type_key.into(), origin };
        }
        let robot = ["crobt", "cpos", "ctool", "cwobj", "calcrobt", "calcjointt"];
        let reason = if robot.contains(&name.key.as_str()) {
            format!("{} depends on where the robot is", name.text)
        } else {
            format!("the function '{}' is not known", name.text)
        };
        Value::unknown(reason, expr.span)
    }

    fn present(&mut self, args: &[Arg]) -> Value {
        let given = args.first().is_some_and(|arg| match &arg.kind {
            ArgKind::Positional(Expr { kind: super::super::hir::ExprKind::Ref(name), .. }) => {
                self.frame().present.contains(&name.key)
            }
            _ => false,
        });
        Value::constant(Datum::Bool(given), "bool")
    }

    fn joint_position(&mut self, expr: &Expr) -> Value {
        let Some(q) = self.machine.joints() else {
            return Value::unknown("the robot's position is not known here", expr.span);
        };
        let joints = q.map(|x| Datum::Num(x.to_degrees())).to_vec();
        Value {
            datum: Datum::List(vec![Datum::List(joints), Datum::List(vec![Datum::Num(9e9); 6])]),
            type_key: "jointtarget".into(),
            origin: Origin::of(Dependence::RobotState),
        }
    }
}

/// Functions from numbers to a number; angles in degrees, as in RAPID.
fn numeric(name: &str, args: &[&Datum]) -> Option<Datum> {
    let x = |i: usize| args.get(i).and_then(|d| d.num());
    let value = match name {
        "abs" | "absdnum" => x(0)?.abs(),
        "sin" => x(0)?.to_radians().sin(),
        "cos" => x(0)?.to_radians().cos(),
        "tan" => x(0)?.to_radians().tan(),
        "asin" => x(0)?.asin().to_degrees(),
        "acos" => x(0)?.acos().to_degrees(),
        "atan" => x(0)?.atan().to_degrees(),
        "atan2" => x(0)?.atan2(x(1)?).to_degrees(),
        "sqrt" => x(0)?.sqrt(),
        "pow" => x(0)?.powf(x(1)?),
        "exp" => x(0)?.exp(),
        "round" | "trunc" => {
            let scale = 10_f64.powf(x(1).unwrap_or(0.0));
            let scaled = x(0)? * scale;
            (if name == "round" { scaled.round() } else { scaled.trunc() }) / scale
        }
        "numtodnum" | "dnumtonum" => x(0)?,
        "dim" => {
            let mut datum = *args.first()?;
            for _ in 1..x(1)? as usize {
                let Datum::List(items) = datum else { return None };
                datum = items.first()?;
            }
            let Datum::List(items) = datum else { return None };
            items.len() as f64
        }
        "distance" => (vector(args.first()?)? - vector(args.get(1)?)?).norm(),
        "vectmagn" => vector(args.first()?)?.norm(),
        "dotprod" => vector(args.first()?)?.dot(&vector(args.get(1)?)?),
        "strlen" => match args.first()? {
            Datum::Text(text) => text.chars().count() as f64,
            _ => return None,
        },
        _ => return None,
    };
    value.is_finite().then_some(Datum::Num(value))
}

/// Functions of poses and targets.
fn geometric(name: &str, args: &[&Datum], turn: [f64; 3]) -> Option<(Datum, &'static str)> {
    let x = |i: usize| args.get(i).and_then(|d| d.num());
    let pose = |i: usize| args.get(i).and_then(|d| convert::pose(d, "the pose").ok());
    Some(match name {
        "offs" => (convert::offs(args.first()?, [x(1)?, x(2)?, x(3)?]).ok()?, "robtarget"),
        "reltool" => {
            (convert::rel_tool(args.first()?, [x(1)?, x(2)?, x(3)?], turn).ok()?, "robtarget")
        }
        "posemult" => (convert::pose_datum(&(pose(0)? * pose(1)?)), "pose"),
        "poseinv" => (convert::pose_datum(&pose(0)?.inverse()), "pose"),
        "posevect" => {
            let point = pose(0)? * nalgebra::Point3::from(vector(args.get(1)?)? * 1e-3);
            (list(&(point.coords * 1e3)), "pos")
        }
        "orientzyx" => {
            let [z, y, x] = [x(0)?, x(1)?, x(2)?].map(f64::to_radians);
            let rotation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), z)
                * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), y)
                * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), x);
            let pose = Isometry3::from_parts(Vector3::zeros().into(), rotation);
            let Datum::List(mut parts) = convert::pose_datum(&pose) else { return None };
            (parts.pop()?, "orient")
        }
        _ => return None,
    })
}

/// Functions that make strings.
fn textual(name: &str, args: &[&Datum]) -> Option<(Datum, &'static str)> {
    let text = match (name, args.first()?) {
        ("numtostr" | "dnumtostr", Datum::Num(x)) => {
            let decimals = args.get(1).and_then(|d| d.num()).unwrap_or(0.0).clamp(0.0, 15.0);
            format!("{x:.*}", decimals as usize)
        }
        ("valtostr", Datum::Num(x)) => format!("{x}"),
        ("strpart", Datum::Text(text)) => {
            let from = args.get(1)?.num()?.max(1.0) as usize - 1;
            let length = args.get(2)?.num()?.max(0.0) as usize;
            text.chars().skip(from).take(length).collect()
        }
        _ => return None,
    };
    Some((Datum::Text(text.as_str().into()), "string"))
}

fn vector(datum: &Datum) -> Option<Vector3<f64>> {
    convert::nums::<3>(datum, "the vector").ok().map(Vector3::from)
}

fn list(v: &Vector3<f64>) -> Datum {
    Datum::List(v.iter().copied().map(Datum::Num).collect())
}
