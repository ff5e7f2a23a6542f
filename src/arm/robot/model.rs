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
use super::link::{Link, arm_load};
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

/// A robot. Every list has one entry per joint, from the base on.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Name, such as `IRB1600-10/1.45`.
    pub name: String,
    /// Its file; `None` for robots of the catalogue.
    pub file: Option<String>,
    /// Its type if different from its name: from `extends` or stated.
    pub type_name: Option<String>,
    /// Total mass \[kg\], if stated.
    pub mass: Option<f64>,
    /// Rated load \[kg\], if stated.
    pub payload: Option<f64>,
    /// Number of joints, 1 to [`MAX_DOF`].
    pub dof: usize,
    /// The chain from base to flange.
    pub kinematics: Geometry,
    /// Limits of the robot.
    pub limits: Limits,
    /// The links with mounted parts; empty if the robot has no dynamics.
    pub links: Vec<Link>,
    /// Friction; zero without a source.
    pub friction: Friction,
    /// Motors and gears.
    pub motors: Option<Motors>,
    /// The wrist gears; uncoupled without a source.
    pub wrist: Wrist,
    /// The drive unit; zero power without a source.
    pub drive: Drive,
    /// Holding brakes.
    pub brakes: Option<Brakes>,
    /// Constant power at standstill.
    pub standstill: Standstill,
    /// The motion planner.
    pub controller: Controller,
    /// Sensor errors of its logs.
    pub sensors: Sensors,
    /// Effects of identification or diagnosis that the fields above do not contain.
    pub effects: Vec<EffectParameters>,
    /// The laws of these effects.
    pub laws: Vec<Law>,
    /// Draws that fit the measured data, if the model is calibrated.
    pub calibration: Option<Calibration>,
    /// The origin of every number, in the order of the fields above.
    pub origins: Vec<Origin>,
}

impl Model {
    /// Its type in ABB controllers: the name without `IRB`.
    #[must_use]
    pub fn type_name(&self) -> &str {
        self.name.strip_prefix("IRB").map_or(self.name.as_str(), str::trim_start)
    }

    /// Motors whose rotors are known: a URDF has gear ratios at most.
    #[must_use]
    pub fn rotors(&self) -> Option<&Motors> {
        self.motors.as_ref().filter(|motors| motors.has_rotors())
    }

    /// The same, to be changed.
    pub fn rotors_mut(&mut self) -> Option<&mut Motors> {
        self.motors.as_mut().filter(|motors| motors.has_rotors())
    }

    /// Whether torques and energies can be computed.
    #[must_use]
    pub fn has_dynamics(&self) -> bool {
        !self.links.is_empty()
    }

    /// Sentences about the assumed numbers and their sources, for reports.
    #[must_use]
    pub fn assumed(&self) -> Vec<String> {
        provenance::sentences(&self.origins, Provenance::Assumed)
    }

    /// The same for the estimated numbers.
    #[must_use]
    pub fn estimated(&self) -> Vec<String> {
        provenance::sentences(&self.origins, Provenance::Estimated)
    }

    /// Whether a number is stated in the robot file and neither assumed nor estimated.
    #[must_use]
    pub fn is_known(&self, table: &str, key: &str) -> bool {
        let rough = [Some(Provenance::Assumed), Some(Provenance::Estimated)];
        self.origin_of(table, key).is_some_and(|origin| !rough.contains(&origin.provenance))
    }

    /// Number of values with this provenance.
    #[must_use]
    pub fn count(&self, provenance: Provenance) -> usize {
        self.origins.iter().filter(|origin| origin.provenance == Some(provenance)).count()
    }

    /// The provenance of a number, if stated.
    #[must_use]
    pub fn provenance_of(&self, table: &str, key: &str) -> Option<Provenance> {
        self.origin_of(table, key).and_then(|origin| origin.provenance)
    }

    /// The origin of a number; the key `""` denotes the first one of the table.
    #[must_use]
    pub fn origin_of(&self, table: &str, key: &str) -> Option<&Origin> {
        self.origins.iter().find(|o| o.table == table && o.key == key)
    }

    /// Torque limits for motions \[Nm\]; `None` if they are estimated.
    #[must_use]
    pub fn torque_bounds(&self) -> Option<&Vec<f64>> {
        let estimated = self.provenance_of("limits", "torque") == Some(Provenance::Estimated);
        self.limits.torque.as_ref().filter(|_| self.has_dynamics() && !estimated)
    }

    /// The model of a document with resolved `extends`.
    pub(super) fn read(node: Node) -> Result<Model, RobotError> {
        let mut robot = Fields::new("", node)?;
        let name = robot.must("name", Fields::text)?;
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
        let kinematics = Geometry::read(&mut robot, joints)?;
        let kinematics = robot.required("kinematics.opw or [[joint]]", kinematics)?;
        let dof = kinematics.joints.len();

        let limits =
            robot.must("limits", |robot, key| robot.part(key, |t| Limits::read(t, dof)))?;
        let links = read_links(&mut robot, dof)?;
        let friction = robot.part("friction", |t| Friction::read(t, dof))?;
        let motors = robot.part("motors", |t| Motors::read(t, dof))?;
        let wrist = robot.part("wrist", |t| Wrist::read(t, dof))?;
        let drive = robot.part("drive", Drive::read)?;
        let brakes = robot.part("brakes", Brakes::read)?;
        let standstill = robot.part("standstill", |t| Standstill::read(t, dof))?;
        let controller = robot.part("controller", |t| Controller::read(t, dof))?;
        let effects = robot.part("effects", |t| EffectParameters::read_all(t, dof))?;
        let calibration = robot.table("calibration")?.map(Calibration::read).transpose()?;
        // The table `identification` documents its origin; it is not used in computations.
        robot.take("identification");
        let origins = robot.finish()?;
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
            friction: friction.unwrap_or_else(|| Friction::none(dof)),
            motors,
            wrist: wrist.unwrap_or_default(),
            drive: drive.unwrap_or_default(),
            brakes,
            standstill: standstill.unwrap_or_else(|| Standstill::none(dof)),
            controller: controller.unwrap_or_default(),
            sensors: Sensors::exact(dof),
            effects: effects.unwrap_or_default(),
            laws: Vec::new(),
            calibration,
            origins,
        })
    }
}

/// The links with mounted arm loads; none, or one per joint.
fn read_links(robot: &mut Fields, dof: usize) -> Result<Vec<Link>, RobotError> {
    let place = robot.place_of("link");
    let mut links = robot.parts("link", Link::read)?;
    if !links.is_empty() && links.len() != dof {
        return Err(RobotError::Length {
            place,
            key: "link".into(),
            found: links.len(),
            expected: format!("{dof}, one for each joint, or none"),
        });
    }
    for table in robot.tables("arm_load")? {
        let (joint, body) = arm_load(robot, table, dof)?;
        if let Some(link) = links.get_mut(joint) {
            *link = link.joined(&body);
        }
    }
    Ok(links)
}
