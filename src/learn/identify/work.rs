//! The whole identification: free parameters, fit, a consistent model.

use nalgebra::{DMatrix, DVector};

use crate::arm::dynamics::{
    BaseParameters, JOINT, Load, RIGID, base_parameters_among, link_of, link_parameters,
    parameters, pseudo_inertia,
};
use crate::arm::robot::{Model, Motors, Origin, Provenance};

use super::consistent::{BODY, Piece, Target, consistent, margin};
use super::equations::{Equations, Known};
use super::error::IdentifyError;
use super::factors::Factors;
use super::fit::{Fit, Weighting, fit, reweighted};
use super::guess::{at_flange, prior, small_body};
use super::least_squares::{Solution, solve};
use super::misses::Misses;
use super::quality::{Quality, explained, quality, surely_negative};
use super::samples::{Samples, Source};
use super::wrist::wrist_coupling;

/// What is to be identified.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Free {
    /// Rigid bodies, rotors, friction, offsets.
    All,
    /// Friction and offsets; rigid bodies and rotors as the model has them.
    Friction,
    /// What is fixed to the flange; all else as the model has it.
    Payload,
}

/// How an identification is done.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What is free.
    pub free: Free,
    /// How joints are weighted.
    pub weighting: Weighting,
    /// Who says so, for the identified numbers of the model.
    pub source: String,
}

/// The result.
#[derive(Clone, Debug)]
pub struct Identified {
    /// The model, with identified parameters.
    pub model: Model,
    /// The free base parameters.
    pub base: BaseParameters,
    /// The fit without constraints.
    pub fit: Fit,
    /// All free parameters of the model, in the order of `among`.
    pub parameters: Vec<f64>,
    /// Their indices among all, as [`parameter_name`](crate::arm::dynamics::parameter_name) counts them.
    pub among: Vec<usize>,
    /// The coupling of the wrist that was found in the data, where the model stated none.
    pub coupling: Option<f64>,
    /// Errors of the model on the samples that it was fitted to.
    pub training: Misses,
    /// The same on those that it was not.
    pub validation: Option<Misses>,
    /// Errors of the fit without constraints on these.
    pub unconstrained_validation: Option<Misses>,
    /// Root mean square of each joint's residuals \[Nm\] with consistent models of the other parts
    /// of the data, which are those of the fit's `cross_rms`.
    pub cross_rms: Vec<f64>,
    /// Whether every link is a body that can be.
    pub physically_consistent: bool,
    /// Base parameters that the data do not determine.
    pub undetermined: Vec<usize>,
    /// What was added at the flange, where that was free.
    pub payload: Option<Load>,
    /// Joints that were not excited, from 0.
    pub resting: Vec<usize>,
    /// Where the rates come from.
    pub source: Source,
    /// How much the model explains.
    pub quality: Quality,
}

/// Identifies a model from `training`; `validation` is only predicted.
///
/// # Errors
/// Too few equations, or a model that lacks what is not free.
pub fn identify(
    model: &Model,
    training: &Samples,
    validation: &[Samples],
    settings: &Settings,
) -> Result<Identified, IdentifyError> {
    if settings.free != Free::All && !model.has_dynamics() {
        return Err(IdentifyError::NoDynamics { name: model.name.clone() });
    }
    let n = model.dof;
    let rigid = RIGID * n;
    let (among, known): (Vec<usize>, Known) = match settings.free {
        Free::All => ((0..rigid + JOINT * n).collect(), Known::Nothing),
        Free::Friction => (
            (rigid..rigid + JOINT * n).filter(|i| !(i - rigid).is_multiple_of(JOINT)).collect(),
            Known::Rigid,
        ),
        Free::Payload => ((rigid - RIGID..rigid).collect(), Known::All),
    };
    let mut nominal = model.clone();
    let among_base = |model: &Model| base_parameters_among(model, &among);
    let mut coupling = None;
    if settings.free == Free::All && nominal.wrist.coupling == 0.0 {
        coupling = wrist_coupling(&nominal, &among_base(&nominal), training);
        nominal.wrist.coupling = coupling.unwrap_or(0.0);
    }
    let base = among_base(&nominal);
    let equations = Equations { model: &nominal, base: &base, known };
    let fit = fit(&equations, training, settings.weighting)?;
    let undetermined: Vec<usize> =
        fit.solution.dependent.iter().map(|(column, _)| *column).collect();

    let pieces = pieces(&nominal, settings.free, &fit, &base, &among);
    let written = Written { pieces: &pieces, base: &base, fit: &fit, among: &among };
    let found = written.of(&fit.factors).ok_or(IdentifyError::Inconsistent)?;
    let of_parts = |part: &Factors| -> DVector<f64> {
        match written.of(part) {
            Some(found) => {
                let all = spread(found.as_slice(), &among, rigid + JOINT * n);
                DVector::from_vec(base.of_parameters(&all))
            }
            None => reweighted(part, settings.weighting, base.rank()).0.beta,
        }
    };
    let cross_rms = fit.held_out.rms(&fit.factors, &of_parts);
    let values: Vec<f64> = found.iter().copied().collect();

    let all = spread(&values, &among, rigid + JOINT * n);
    let of_model = DVector::from_vec(base.of_parameters(&all));
    let held_out: Vec<Factors> =
        validation.iter().map(|samples| Factors::of(&equations, samples, 1)).collect();
    let training_misses = Misses::of(&of_model, std::slice::from_ref(&fit.factors));
    let on_held_out =
        |beta: &DVector<f64>| (!held_out.is_empty()).then(|| Misses::of(beta, &held_out));
    let validation_misses = on_held_out(&of_model);

    let giving = |joint: &usize| {
        let name = format!("fc{}", joint + 1);
        let all = fit.solution.determined.iter().enumerate();
        all.filter(|(_, row)| base.name(**row) == name)
            .any(|(k, row)| surely_negative(fit.solution.beta[*row], fit.covariance[(k, k)].sqrt()))
    };
    let giving_power = (0..n).filter(giving).collect();
    let fitted = explained(std::slice::from_ref(training), &training_misses);
    let predicted = match &validation_misses {
        Some(misses) => Some(explained(validation, misses)),
        None if fit.over_repetitions => None,
        None => {
            let misses = training_misses.with_rms(&cross_rms);
            Some(explained(std::slice::from_ref(training), &misses))
        }
    };
    let quality = quality(
        &equations,
        training,
        [&training_misses.rms, &fit.rms],
        (fitted, predicted),
        giving_power,
        &fit.whiteness,
    );
    let (mut identified, payload) = assembled(
        &nominal,
        settings,
        &values,
        training,
        (coupling, &told_links(&base, &fit.solution)),
    );
    // They are in the numbers now.
    identified.effects.clear();
    let physically_consistent =
        identified.links.iter().all(|link| margin(&link_parameters(link)) > BODY);
    Ok(Identified {
        model: identified,
        parameters: values,
        among,
        coupling,
        training: training_misses,
        validation: validation_misses,
        unconstrained_validation: on_held_out(&fit.solution.beta),
        cross_rms,
        physically_consistent,
        undetermined,
        payload,
        resting: training.resting.clone(),
        source: training.source.clone(),
        quality,
        base,
        fit,
    })
}

/// How the free parameters of a model that can be are found; sizes are those of the fit of all
/// data.
struct Written<'a> {
    pieces: &'a [Piece],
    base: &'a BaseParameters,
    fit: &'a Fit,
    among: &'a [usize],
}

impl Written<'_> {
    /// The parameters nearest to the free solution of some equations.
    fn of(&self, factors: &Factors) -> Option<DVector<f64>> {
        // In units of each joint's residuals, also where joints were not weighted; data without
        // noise would ask for more digits than there are.
        let fit = self.fit;
        let weights: Vec<f64> = fit
            .rms
            .iter()
            .zip(&fit.relative_rms)
            .map(|(rms, relative)| 1.0 / rms.max(DIGITS * rms / relative).max(f64::MIN_POSITIVE))
            .collect();
        let weighted = solve(&factors.stacked(&weights, self.base.rank()));
        let beta = DVector::from_iterator(
            weighted.determined.len(),
            weighted.determined.iter().map(|k| weighted.beta[*k]),
        );
        let target = Target {
            combination: &combination(self.base, &weighted, self.among),
            factor: &weighted.factor,
            beta: &beta,
            least: factors.rows_without(None).iter().sum::<usize>() as f64,
        };
        let found = consistent(self.pieces, &target)?;
        Some(with_apparent(self.pieces, &target, found, (fit, self.base), self.among))
    }
}

impl Identified {
    /// Time, usable torques (not a number where a joint rests) and those of the model, of each
    /// instant of samples, and the rates: `[measured, predicted, rate]` by joint.
    #[must_use]
    pub fn traces(&self, nominal: &Model, samples: &Samples) -> Vec<(f64, [Vec<f64>; 3])> {
        let all = spread(&self.parameters, &self.among, (RIGID + JOINT) * nominal.dof);
        let beta = self.base.of_parameters(&all);
        let known = match self.payload {
            Some(_) => Known::All,
            None if self.among.len() < all.len() => Known::Rigid,
            None => Known::Nothing,
        };
        let mut model = nominal.clone();
        model.wrist = self.model.wrist.clone();
        let equations = Equations { model: &model, base: &self.base, known };
        let layout = equations.layout();
        let mut rows = Vec::new();
        equations.each(samples, &layout, &mut |instant| {
            let n = layout.columns.len();
            let mut parts = [Vec::with_capacity(n), Vec::with_capacity(n), Vec::with_capacity(n)];
            let mut from = 0;
            for (joint, columns) in layout.columns.iter().enumerate() {
                let to = from + columns.len();
                let of = instant.x[from..to].iter().zip(columns);
                let free: f64 = of.map(|(x, column)| x * beta[*column]).sum();
                let predicted = free + instant.tau[joint] - instant.y[joint];
                let shown = |value: f64| if instant.usable[joint] { value } else { f64::NAN };
                parts[0].push(shown(instant.tau[joint]));
                parts[1].push(shown(predicted));
                parts[2].push(instant.qd[joint]);
                from = to;
            }
            rows.push((instant.t, parts));
        });
        rows
    }
}

/// Values at their indices, the rest 0.
fn spread(values: &[f64], among: &[usize], count: usize) -> Vec<f64> {
    let mut all = vec![0.0; count];
    for (index, value) in among.iter().zip(values) {
        all[*index] = *value;
    }
    all
}

/// The determined base parameters as combinations of the free ones. What the data do not
/// tell apart goes together.
fn combination(base: &BaseParameters, solution: &Solution, among: &[usize]) -> DMatrix<f64> {
    let place = |index: usize| among.iter().position(|known| *known == index);
    let row_of = |row: usize| {
        let mut values = vec![0.0; among.len()];
        if let Some(head) = place(base.independent[row]) {
            values[head] = 1.0;
        }
        for (k, index) in base.dependent.iter().enumerate() {
            if let Some(to) = place(*index) {
                values[to] = base.grouping[(row, k)];
            }
        }
        values
    };
    let determined = &solution.determined;
    let mut rows: Vec<Vec<f64>> = determined.iter().map(|row| row_of(*row)).collect();
    for (column, parts) in &solution.dependent {
        let values = row_of(*column);
        for (to, factor) in parts {
            if let Some(row) = determined.iter().position(|known| known == to) {
                for (sum, value) in rows[row].iter_mut().zip(&values) {
                    *sum += factor * value;
                }
            }
        }
    }
    DMatrix::from_fn(rows.len(), among.len(), |row, column| rows[row][column])
}

/// The free parameters with their priors.
fn pieces(
    model: &Model,
    free: Free,
    fit: &Fit,
    base: &BaseParameters,
    among: &[usize],
) -> Vec<Piece> {
    let n = model.dof;
    let rigid = RIGID * n;
    if free == Free::Payload {
        return vec![Piece::Body(pseudo_inertia(&link_parameters(&small_body(model))))];
    }
    let mut pieces = Vec::new();
    if free == Free::All {
        pieces.extend((0..n).map(|joint| Piece::Body(prior(model, joint))));
    }
    let nominal = parameters(model, &Load::none());
    for index in among.iter().filter(|index| **index >= rigid) {
        // What the fit says where it says something of this parameter alone.
        let said = base.independent.iter().position(|known| known == index).and_then(|row| {
            let k = fit.solution.determined.iter().position(|known| *known == row)?;
            Some((fit.solution.beta[row], fit.covariance[(k, k)].sqrt()))
        });
        let kind = (index - rigid) % JOINT;
        if kind == JOINT - 1 {
            let size = said.map_or(1.0, |(value, sd)| value.abs().max(sd));
            pieces.push(Piece::Any(size.max(SMALL)));
        } else {
            let nominal = nominal.get(*index).copied().unwrap_or(0.0);
            let known = said.map_or(0.0, |(value, sd)| value.max(sd));
            pieces.push(Piece::Positive(if nominal > 0.0 { nominal } else { known.max(SMALL) }));
        }
    }
    pieces
}

/// Where a rotor or a viscous friction that can't be below 0 costs the fit much, both as the log
/// shows them: a delay, a filter or elasticity looks like less than nothing.
fn with_apparent(
    pieces: &[Piece],
    target: &Target<'_>,
    mut found: DVector<f64>,
    (fit, base): (&Fit, &BaseParameters),
    among: &[usize],
) -> DVector<f64> {
    let rigid = RIGID * base.dof;
    let kind = |index: usize| index.checked_sub(rigid).map(|k| k % JOINT);
    let free = |index: usize| matches!(kind(index), Some(0 | 1));
    // What deviations the parameters of this kind have.
    let size = |of: usize| -> f64 {
        let all = fit.solution.determined.iter().enumerate();
        all.filter(|(_, row)| kind(base.independent[**row]) == kind(of))
            .map(|(k, _)| fit.covariance[(k, k)].sqrt())
            .fold(SMALL, f64::max)
    };
    let mut pieces = pieces.to_vec();
    let mut missed = target.squares(&found);
    for _ in 0..FREED {
        let mut freed = pieces.clone();
        let mut at = 0;
        for piece in &mut freed {
            let index = among[at];
            let width = piece.width();
            if let Piece::Positive(prior) = piece
                && free(index)
                && found[at] < BOUND * *prior
            {
                *piece = Piece::Any(size(index));
            }
            at += width;
        }
        if freed == pieces {
            break;
        }
        let Some(next) = consistent(&freed, target) else { break };
        let misses = target.squares(&next);
        if misses > (1.0 - WORTH) * missed {
            break;
        }
        (pieces, found, missed) = (freed, next, misses);
    }
    found
}

/// Rounds in which bounds are lifted.
const FREED: usize = 3;
/// A positive number this much below its prior is one that the data want below 0.
const BOUND: f64 = 0.3;
/// Share of the residuals' power that lifting bounds has to take away.
const WORTH: f64 = 0.005;
/// Residuals smaller than this share of the torque are as good as none.
const DIGITS: f64 = 1e-4;
/// Size of a parameter of which nothing is known, in its SI unit.
const SMALL: f64 = 1e-3;

/// The model with the free parameters put in.
fn assembled(
    nominal: &Model,
    settings: &Settings,
    values: &[f64],
    samples: &Samples,
    (coupling, told): (Option<f64>, &[bool]),
) -> (Model, Option<Load>) {
    let n = nominal.dof;
    let mut model = nominal.clone();
    let mut payload = None;
    let mut tables = Vec::new();
    if settings.free == Free::Payload {
        let added = link_of(values);
        payload = Some(at_flange(nominal, &added));
        if let Some(last) = model.links.last_mut() {
            let both: Vec<f64> =
                link_parameters(last).iter().zip(values).map(|(a, b)| a + b).collect();
            *last = link_of(&both);
        }
        tables.push(format!("link {n}"));
    }
    let joints = match settings.free {
        Free::All => {
            // A link of which the motion says nothing stays as it was, where it was a body.
            let found = values[..RIGID * n].chunks(RIGID).map(link_of).enumerate();
            model.links = found
                .map(|(k, new)| match nominal.links.get(k) {
                    Some(old) if !told[k] && margin(&link_parameters(old)) > BODY => old.clone(),
                    _ => new,
                })
                .collect();
            tables.extend((0..n).filter(|k| told[*k]).map(|k| format!("link {}", k + 1)));
            &values[RIGID * n..]
        }
        Free::Friction => values,
        Free::Payload => &[],
    };
    if !joints.is_empty() {
        let width = joints.len() / n;
        let column = |kind: usize| -> Vec<f64> {
            (0..n).map(|joint| joints[joint * width + width + kind - JOINT]).collect()
        };
        let rests = |joint: &usize| samples.resting.contains(joint);
        // What a resting joint would take is not known: it stays as it was.
        let kept = |new: Vec<f64>, old: &[f64]| -> Vec<f64> {
            let of = |joint: usize| if rests(&joint) { old[joint] } else { new[joint] };
            (0..n).map(of).collect()
        };
        let before = &nominal.friction;
        let zero = vec![0.0; n];
        let (viscous, apparent) = parted(column(1));
        model.friction.viscous = kept(viscous, &before.viscous);
        model.sensors.apparent_viscous = kept(apparent, &zero);
        model.friction.coulomb = kept(column(2), &before.coulomb);
        model.friction.coulomb_asymmetry = None;
        model.sensors.torque_offset = kept(column(3), &zero);
        model.friction.viscous_asymmetry = None;
        model.friction.stribeck = None;
        model.friction.load_friction = None;
        tables.push("friction".into());
        tables.push("effects.torque_offset".into());
        tables.push("effects.apparent_torque".into());
        if settings.free == Free::All {
            let (inertia, apparent) = parted(column(0));
            model.sensors.apparent_inertia = kept(apparent, &zero);
            let inertia = match &nominal.motors {
                Some(motors) => {
                    let before: Vec<f64> = (0..n).map(|j| motors.reflected_inertia(j)).collect();
                    kept(inertia, &before)
                }
                None => inertia,
            };
            model.motors = Some(with_rotors(nominal, &inertia));
        }
    }
    // Of a list with joints that rest not all is identified.
    let of_joints = |table: &str, key: &str| -> Origin {
        let mut new = origin(table, key, &settings.source);
        if samples.resting.is_empty() {
            return new;
        }
        let before = nominal.origins.iter().find(|o| o.table == table && o.key == key);
        new.provenance = before.map_or(Some(Provenance::Assumed), |before| before.provenance);
        let resting: Vec<String> = samples.resting.iter().map(|j| (j + 1).to_string()).collect();
        let was = before.and_then(|before| before.source.as_deref());
        let was = was.map_or_else(String::new, |was| format!(": {was}"));
        new.source = Some(format!(
            "{}; not identified, as it was, of joints {}, which rest{was}",
            settings.source,
            resting.join(", ")
        ));
        new
    };
    model.origins.retain(|origin| {
        let part = |table: &String| {
            origin.table == *table || origin.table.starts_with(&format!("{table}."))
        };
        !tables.iter().any(part) && !origin.table.starts_with("arm_load")
    });
    for table in &tables {
        let keys: &[&str] = match table.as_str() {
            "friction" => &["coulomb", "viscous"],
            "effects.torque_offset" => &["offset"],
            "effects.apparent_torque" => &["inertia", "viscous"],
            _ => &["mass", "com", "inertia"],
        };
        model.origins.extend(keys.iter().map(|key| {
            if table.starts_with("link") {
                origin(table, key, &settings.source)
            } else {
                of_joints(table, key)
            }
        }));
    }
    if settings.free == Free::All {
        model.origins.retain(|o| !(o.table == "motors" && o.key == "rotor_inertia"));
        model.origins.push(of_joints("motors", "rotor_inertia"));
        if nominal.motors.is_none() {
            model.origins.push(Origin {
                table: "motors".into(),
                key: "ratio".into(),
                provenance: Some(Provenance::Assumed),
                source: Some("not known: rotor inertias are given at the joint".into()),
                sd: None,
            });
        }
        model.sensors.position_offset.fill(0.0);
        model.sensors.torque_error.fill(0.0);
    }
    if coupling.is_some() {
        model.origins.retain(|o| o.table != "wrist");
        model.origins.push(origin("wrist", "coupling", &settings.source));
    }
    (model, payload)
}

/// Links of which a determined base parameter says something.
fn told_links(base: &BaseParameters, solution: &Solution) -> Vec<bool> {
    let mut told = vec![false; base.dof];
    let mut tell = |index: usize| {
        if let Some(told) = told.get_mut(index / RIGID) {
            *told = true;
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
    told
}

/// What a robot can have of numbers, and what only its log can: those below 0.
fn parted(values: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
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

/// The motors with rotors of the inertias `inertia`, at the joints \[kg m²\].
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
