//! Parameters of the model, which may be off by what the model is trusted.

use nalgebra::DMatrix;

use crate::arm::effects::Response;
use crate::gap::nuisance::{Trust, model_parameters};
use crate::gap::tunables::Tunables;
use crate::gap::record::{Record, RecordKind};

/// What one standard deviation of each parameter changes.
pub struct Parameters {
    /// Names, such as `link 3 mass`.
    pub names: Vec<String>,
    /// Standard deviations, in the units of the parameters.
    pub deviations: Vec<f64>,
    /// Changes of the standard parameters for one deviation of each.
    pub mixing: DMatrix<f64>,
    /// By record, by parameter: joints that it reaches, with their torques \[Nm\].
    series: Vec<Vec<Vec<(usize, Vec<f64>)>>>,
}

/// What a lag of all torques changes, and by how much a delay differs from it.
fn lags(record: &Record<'_>, tunables: &Tunables) -> [Vec<(usize, Vec<f64>)>; 2] {
    let (lag, form) = (tunables.lag, tunables.lag_form);
    let motion = &record.motion;
    let of = |response: Response| -> Vec<Vec<f64>> {
        (0..motion.model.dof).map(|joint| response.behind(motion, joint, &motion.torque[joint])).collect()
    };
    let lagged = of(Response { delay: 0.0, lag });
    let [slow, delayed] =
        [Response { delay: 0.0, lag: form }, Response { delay: form, lag: 0.0 }].map(of);
    let less = |a: &[Vec<f64>], b: &[Vec<f64>]| -> Vec<(usize, Vec<f64>)> {
        let pairs = a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect());
        pairs.enumerate().collect()
    };
    [less(&lagged, &motion.torque), less(&delayed, &slow)]
}

impl Parameters {
    pub(super) fn new(
        records: &[Record<'_>],
        trust: Trust,
        tunables: &Tunables,
    ) -> Parameters {
        let mut of = Parameters {
            names: Vec::new(),
            deviations: Vec::new(),
            mixing: DMatrix::zeros(0, 0),
            series: Vec::new(),
        };
        for record in records {
            let (names, deviations, mixing, series) = model_parameters(records, record, trust);
            let (mut names, mut deviations, mut series) = (names, deviations, series);
            let is_drift = record.kind == RecordKind::Drift;
            for (name, of) in ["lag of the torques", "form of the lag"].into_iter().zip(lags(record, tunables)) {
                names.push(name.to_owned());
                deviations.push(tunables.lag);
                series.push(of);
            }
            of.series.push(if is_drift { vec![Vec::new(); names.len()] } else { series });
            (of.names, of.deviations, of.mixing) = (names, deviations, mixing);
        }
        of
    }

    /// Number of parameters.
    #[must_use]
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// The series of a parameter at a joint by record; empty where it does not reach the joint.
    pub(super) fn series(&self, joint: usize, k: usize) -> Vec<&[f64]> {
        let mut all = Vec::with_capacity(self.series.len());
        for record in &self.series {
            let found = record[k].iter().find(|(of, _)| *of == joint);
            all.push(found.map_or(&[][..], |(_, series)| series.as_slice()));
        }
        all
    }
}
