//! The immutable model of one robot.

use super::calibration::Calibration;
use super::controller::Controller;
use super::drive::{Brakes, Drive, Standstill};
use super::effect::EffectParameters;
use super::error::RobotError;
use super::fields::{Accepts, Fields};
use super::friction::Friction;
use super::geometry::{Geometry, MAX_DOF};
use super::law::Law;
use super::limits::Limits;
use super::link::{ArmLoad, Link};
use super::motors::Motors;
use super::provenance::{self, Origin, Provenance};
use super::sensors::Sensors;
use super::tree::Node;
use super::wrist::Wrist;

/// Masses of robots \[kg\].
const ROBOT_MASS: Accepts =
    Accepts::Between(1.0, 20_000.0, "at least 1 and at most 20000, in kg, of the whole robot");
/// Payloads \[kg\].
const PAYLOAD: Accepts = Accepts::Between(0.05, 5000.0, "at least 0.05 and at most 5000, in kg");

/// A robot. Every list has one entry for each joint, from the base on.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Name, such as `IRB1600-10/1.45`.
    pub name: String,
    /// The file that it was loaded from; `None` for robots of the catalogue.
    pub file: Option<String>,
    /// The robot whose type it is, where that is not its name: that which its file extends or states.
    pub type_name: Option<String>,
    /// The whole robot \[kg\], where its file states it.
    pub mass: Option<f64>,
    /// The load that it is made for \[kg\], where its file states it.
    pub payload: Option<f64>,
    /// Number of joints, 1 to [`MAX_DOF`].
    pub dof: usize,
    /// The chain from base to flange.
    pub kinematics: Geometry,
    /// What the robot may not exceed.
    pub limits: Limits,
    /// The rigid bodies with what is mounted on them; empty where the robot has no
    /// dynamics.
    pub links: Vec<Link>,
    /// Friction; zero where no source gives it.
    pub friction: Friction,
    /// Motors and gears.
    pub motors: Option<Motors>,
    /// The wrist's gears; uncoupled where no source says otherwise.
    pub wrist: Wrist,
    /// The drive unit; zero power where no source gives it.
    pub drive: Drive,
    /// Holding brakes.
    pub brakes: Option<Brakes>,
    /// Constant power at standstill.
    pub standstill: Standstill,
    /// The motion planner.
    pub controller: Controller,
    /// How its logs differ from it.
    pub sensors: Sensors,
    /// What identification or diagnosis added, as far as the fields above do not contain it.
    pub effects: Vec<EffectParameters>,
    /// The laws of these effects.
    pub laws: Vec<Law>,
    /// Robots that fit what was measured, where the model is one of them.
    pub calibration: Option<Calibration>,
    /// The origin of every number, in the order of the fields above.
    pub origins: Vec<Origin>,
}

impl Model {
    /// What a controller of ABB calls it: the name without `IRB`.
    #[must_use]
    pub fn type_name(&self) -> &str {
        self.name.strip_prefix("IRB").map_or(self.name.as_str(), str::trim_start)
    }

    /// Whether torques and energies can be computed.
    #[must_use]
    pub fn has_dynamics(&self) -> bool {
        !self.links.is_empty()
    }

    /// The assumed numbers, each with its source, as a report lists them.
    #[must_use]
    pub fn assumed(&self) -> Vec<String> {
        provenance::sentences(&self.origins, Provenance::Assumed)
    }

    /// The estimated numbers in the same way.
    #[must_use]
    pub fn estimated(&self) -> Vec<String> {
        provenance::sentences(&self.origins, Provenance::Estimated)
    }

    /// Whether a number is known: stated by the robot's file and neither assumed nor estimated.
    #[must_use]
    pub fn is_known(&self, table: &str, key: &str) -> bool {
        let mut origins = self.origins.iter().filter(|o| o.table == table && o.key == key);
        let rough = [Some(Provenance::Assumed), Some(Provenance::Estimated)];
        origins.next().is_some_and(|origin| !rough.contains(&origin.provenance))
    }

    /// How many numbers or lists are known in this way.
    #[must_use]
    pub fn count(&self, provenance: Provenance) -> usize {
        self.origins.iter().filter(|origin| origin.provenance == Some(provenance)).count()
    }

    /// How a number is known, where its origin says so.
    #[must_use]
    pub fn provenance_of(&self, table: &str, key: &str) -> Option<Provenance> {
        self.origin_of(table, key).and_then(|origin| origin.provenance)
    }

    /// The origin of a number; the key `""` stands for the first of the table.
    #[must_use]
    pub fn origin_of(&self, table: &str, key: &str) -> Option<&Origin> {
        self.origins.iter().find(|o| o.table == table && o.key == key)
    }

    /// Largest torques that bound how the robot moves \[Nm\]: none that are estimated.
    #[must_use]
    pub fn torque_bounds(&self) -> Option<&Vec<f64>> {
        let estimated = self.provenance_of("limits", "torque") == Some(Provenance::Estimated);
        self.limits.torque.as_ref().filter(|_| self.has_dynamics() && !estimated)
    }

    /// The model of a document whose `extends` has been resolved.
    pub(super) fn read(node: Node) -> Result<Model, RobotError> {
        let mut robot = Fields::new("", node)?;
        let mut origins = Vec::new();
        let name = robot.text("name")?;
        let name = robot.required("name", name)?;
        robot.text("extends")?;
        let type_name = robot.text("type")?;
        let mass = robot.number("mass", ROBOT_MASS)?;
        let payload = robot.number("payload", PAYLOAD)?;

        let joints = robot.tables("joint")?;
        if let Some(beyond) = joints.get(MAX_DOF) {
            return Err(RobotError::Length {
                place: beyond.place(),
                key: "joint".into(),
                found: joints.len(),
                expected: format!("at most {MAX_DOF}"),
            });
        }
        let kinematics = Geometry::read(robot.table("kinematics")?, joints, &mut origins)?;
        let kinematics = robot.required("kinematics.opw or [[joint]]", kinematics)?;
        let dof = kinematics.joints.len();

        let limits = robot.table("limits")?;
        let limits = Limits::read(robot.required("limits", limits)?, dof, &mut origins)?;
        let links = read_links(&mut robot, dof, &mut origins)?;
        let friction = part(&mut robot, "friction", |t| Friction::read(t, dof, &mut origins))?
            .unwrap_or_else(|| Friction::none(dof));
        let motors = part(&mut robot, "motors", |t| Motors::read(t, dof, &mut origins))?;
        let wrist = part(&mut robot, "wrist", |t| Wrist::read(t, dof, &mut origins))?
            .unwrap_or_else(Wrist::uncoupled);
        let drive = part(&mut robot, "drive", |t| Drive::read(t, &mut origins))?
            .unwrap_or_else(Drive::lossless);
        let brakes = part(&mut robot, "brakes", |t| Brakes::read(t, &mut origins))?;
        let standstill =
            part(&mut robot, "standstill", |t| Standstill::read(t, dof, &mut origins))?
                .unwrap_or_else(|| Standstill::none(dof));
        let controller =
            part(&mut robot, "controller", |t| Controller::read(t, dof, &mut origins))?
                .unwrap_or_default();
        let effects =
            part(&mut robot, "effects", |t| EffectParameters::read_all(t, dof, &mut origins))?
                .unwrap_or_default();
        let calibration = part(&mut robot, "calibration", Calibration::read)?;
        // How an identification came to its numbers is for people; nothing is computed from it.
        robot.take("identification");
        origins.extend(robot.finish()?);
        Ok(Model {
            name,
            file: None,
            type_name,
            mass,
            payload,
            dof,
            kinematics,
            limits,
            links,
            friction,
            motors,
            wrist,
            drive,
            brakes,
            standstill,
            controller,
            sensors: Sensors::exact(dof),
            effects,
            laws: Vec::new(),
            calibration,
            origins,
        })
    }
}

/// A part of a robot in a table of its own, where the table is there.
fn part<T>(
    robot: &mut Fields,
    key: &str,
    read: impl FnOnce(Fields) -> Result<T, RobotError>,
) -> Result<Option<T>, RobotError> {
    robot.table(key)?.map(read).transpose()
}

/// The links with the arm loads mounted on them; none, or one for each joint.
fn read_links(
    robot: &mut Fields,
    dof: usize,
    origins: &mut Vec<Origin>,
) -> Result<Vec<Link>, RobotError> {
    let place = robot.place_of("link");
    let tables = robot.tables("link")?.into_iter();
    let mut links =
        tables.map(|table| Link::read(table, origins)).collect::<Result<Vec<_>, _>>()?;
    if !links.is_empty() && links.len() != dof {
        return Err(RobotError::Length {
            place,
            key: "link".into(),
            found: links.len(),
            expected: format!("{dof}, one for each joint, or none"),
        });
    }
    for table in robot.tables("arm_load")? {
        let load = ArmLoad::read(table, dof, origins)?;
        if let Some(link) = links.get_mut(load.joint) {
            *link = link.joined(&load.body);
        }
    }
    Ok(links)
}
