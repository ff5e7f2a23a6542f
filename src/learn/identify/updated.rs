//! A model with identified parameters.

use crate::arm::dynamics::{BaseParameters, JOINT, Load, RIGID, link_of, link_parameters};
use crate::arm::robot::{Model, Motors, Origin, Provenance};

use super::consistent::{BODY, margin};
use super::guess::at_flange;
use super::least_squares::Solution;
use super::settings::{Free, Settings};

/// Identified values.
pub(super) struct Estimates<'a> {
    /// The free parameters.
    pub(super) values: &'a [f64],
    /// The wrist coupling, if it was identified.
    pub(super) coupling: Option<f64>,
    /// Whether the data determine a parameter of each link.
    pub(super) informed: &'a [bool],
    /// Joints that never move, from 0.
    pub(super) resting: &'a [usize],
}

/// A model while identified parameters are written into it.
struct Update<'a> {
    nominal: &'a Model,
    settings: &'a Settings,
    estimates: &'a Estimates<'a>,
    model: Model,
    /// Tables of the robot file that are identified.
    tables: Vec<String>,
}

/// `nominal` with the estimates, and the payload if it was free.
pub(super) fn updated(
    nominal: &Model,
    settings: &Settings,
    estimates: &Estimates<'_>,
) -> (Model, Option<Load>) {
    let model = nominal.clone();
    let mut update = Update { nominal, settings, estimates, model, tables: Vec::new() };
    let values = estimates.values;
    let mut payload = None;
    match settings.free {
        Free::All => {
            let (links, joints) = values.split_at(RIGID * nominal.dof);
            update.links(links);
            update.joints(joints);
        }
        Free::Friction => update.joints(values),
        Free::Payload => payload = Some(update.payload(values)),
    }
    update.origins();
    (update.model, payload)
}

impl Update<'_> {
    fn payload(&mut self, values: &[f64]) -> Load {
        if let Some(last) = self.model.links.last_mut() {
            let both: Vec<f64> =
                link_parameters(last).iter().zip(values).map(|(a, b)| a + b).collect();
            *last = link_of(&both);
        }
        self.tables.push(format!("link {}", self.nominal.dof));
        at_flange(self.nominal, &link_of(values))
    }

    fn links(&mut self, values: &[f64]) {
        let informed = self.estimates.informed;
        // A link without information keeps its parameters if they are physically possible.
        let found = values.chunks(RIGID).map(link_of).enumerate();
        self.model.links = found
            .map(|(k, new)| match self.nominal.links.get(k) {
                Some(old) if !informed[k] && margin(&link_parameters(old)) > BODY => old.clone(),
                _ => new,
            })
            .collect();
        let written = (0..self.nominal.dof).filter(|k| informed[*k]);
        self.tables.extend(written.map(|k| format!("link {}", k + 1)));
    }

    /// Writes friction and torque offsets, and rotors if they are among the values.
    fn joints(&mut self, values: &[f64]) {
        let (n, nominal) = (self.nominal.dof, self.nominal);
        let width = values.len() / n;
        let column = |kind: usize| -> Vec<f64> {
            (0..n).map(|joint| values[joint * width + width + kind - JOINT]).collect()
        };
        // The friction of a resting joint is not identified and stays.
        let kept = |new: Vec<f64>, old: &[f64]| -> Vec<f64> {
            let rests = |joint: &usize| self.estimates.resting.contains(joint);
            (0..n).map(|joint| if rests(&joint) { old[joint] } else { new[joint] }).collect()
        };
        let model = &mut self.model;
        let before = &nominal.friction;
        let zero = vec![0.0; n];
        let (viscous, apparent) = split_by_sign(column(1));
        model.friction.viscous = kept(viscous, &before.viscous);
        model.sensors.apparent_viscous = kept(apparent, &zero);
        model.friction.coulomb = kept(column(2), &before.coulomb);
        model.friction.coulomb_asymmetry = None;
        model.sensors.torque_offset = kept(column(3), &zero);
        model.friction.viscous_asymmetry = None;
        model.friction.stribeck = None;
        model.friction.load_friction = None;
        let tables = ["friction", "effects.torque_offset", "effects.apparent_torque"];
        self.tables.extend(tables.map(str::to_owned));
        if width < JOINT {
            return;
        }
        let (inertia, apparent) = split_by_sign(column(0));
        model.sensors.apparent_inertia = kept(apparent, &zero);
        let inertia = match &nominal.motors {
            Some(motors) => {
                let before: Vec<f64> = (0..n).map(|j| motors.reflected_inertia(j)).collect();
                kept(inertia, &before)
            }
            None => inertia,
        };
        model.motors = Some(with_rotors(nominal, &inertia));
        model.sensors.position_offset.fill(0.0);
        model.sensors.torque_error.fill(0.0);
    }

    /// Sets the origins of the parameters.
    fn origins(&mut self) {
        let is_replaced = |origin: &Origin| {
            let part = |table: &String| {
                origin.table == *table || origin.table.starts_with(&format!("{table}."))
            };
            self.tables.iter().any(part) || origin.table.starts_with("arm_load")
        };
        let kept = |origin: &&Origin| !is_replaced(origin);
        let mut origins: Vec<Origin> = self.model.origins.iter().filter(kept).cloned().collect();
        for table in &self.tables {
            let keys: &[&str] = match table.as_str() {
                "friction" => &["coulomb", "viscous"],
                "effects.torque_offset" => &["offset"],
                "effects.apparent_torque" => &["inertia", "viscous"],
                _ => &["mass", "com", "inertia"],
            };
            origins.extend(keys.iter().map(|key| {
                if table.starts_with("link") {
                    origin(table, key, &self.settings.source)
                } else {
                    self.origin_of_joints(table, key)
                }
            }));
        }
        if self.settings.free == Free::All {
            origins.retain(|o| !(o.table == "motors" && o.key == "rotor_inertia"));
            origins.push(self.origin_of_joints("motors", "rotor_inertia"));
            if self.nominal.motors.is_none() {
                origins.push(Origin {
                    table: "motors".into(),
                    key: "ratio".into(),
                    provenance: Some(Provenance::Assumed),
                    source: Some("not known: rotor inertias are given at the joint".into()),
                    sd: None,
                });
            }
        }
        if self.estimates.coupling.is_some() {
            origins.retain(|o| o.table != "wrist");
            origins.push(origin("wrist", "coupling", &self.settings.source));
        }
        self.model.origins = origins;
    }

    /// The origin of a list with a value for each joint, some of which may be resting.
    fn origin_of_joints(&self, table: &str, key: &str) -> Origin {
        let source = &self.settings.source;
        let mut new = origin(table, key, source);
        if self.estimates.resting.is_empty() {
            return new;
        }
        let before = self.nominal.origins.iter().find(|o| o.table == table && o.key == key);
        new.provenance = before.map_or(Some(Provenance::Assumed), |before| before.provenance);
        let resting: Vec<String> =
            self.estimates.resting.iter().map(|joint| (joint + 1).to_string()).collect();
        let was = before.and_then(|before| before.source.as_deref());
        let was = was.map_or_else(String::new, |was| format!(": {was}"));
        new.source = Some(format!(
            "{source}; not identified, as it was, of joints {}, which rest{was}",
            resting.join(", ")
        ));
        new
    }
}

/// Whether some determined base parameter depends on each link.
pub(super) fn informed_links(base: &BaseParameters, solution: &Solution) -> Vec<bool> {
    let mut informed = vec![false; base.dof];
    let mut tell = |index: usize| {
        if let Some(informed) = informed.get_mut(index / RIGID) {
            *informed = true;
        }
    };
    for row in &solution.determined {
        tell(base.independent[*row]);
        for (k, index) in base.dependent.iter().enumerate() {
            if base.grouping[(*row, k)] != 0.0 {
                tell(*index);
            }
        }
    }
    informed
}

/// Splits values into positive and negative ones; the latter exist only in the log.
fn split_by_sign(values: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
    values.into_iter().map(|value| (value.max(0.0), value.min(0.0))).unzip()
}

fn origin(table: &str, key: &str, source: &str) -> Origin {
    Origin {
        table: table.to_owned(),
        key: key.to_owned(),
        provenance: Some(Provenance::Identified),
        source: Some(source.to_owned()),
        sd: None,
    }
}

/// The motors with rotors of the inertias `inertia` at the joints \[kg m²\].
fn with_rotors(nominal: &Model, inertia: &[f64]) -> Motors {
    let mut motors = nominal.motors.clone().unwrap_or_else(|| Motors {
        ratio: vec![1.0; nominal.dof],
        torque_constant: None,
        rotor_inertia: vec![0.0; nominal.dof],
        loss_constant: vec![0.0; nominal.dof],
        peak_current: None,
        rated_current: None,
    });
    motors.rotor_inertia =
        inertia.iter().zip(&motors.ratio).map(|(at_joint, n)| at_joint / (n * n)).collect();
    motors
}
