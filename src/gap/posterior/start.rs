//! Where the search for sizes begins.

use super::hypothesis::{Hypothesis, Member};
use super::reduced::Reduced;
use super::sizes::{Size, Sizes, halfway};
use crate::gap::design::Design;

/// What is known of a fit.
#[derive(Clone, Copy)]
pub(in crate::gap) struct Known<'a> {
    pub(super) hypothesis: &'a Hypothesis,
    pub(super) sizes: &'a Sizes,
    pub(super) amplitudes: &'a [Size],
    pub(super) reduced: &'a [Reduced],
}

/// The sizes from which a fit begins.
pub(in crate::gap) struct Start {
    /// Of everyday errors, by joint.
    pub(super) sizes: Sizes,
    /// Amplitudes of the first members.
    pub(super) amplitudes: Vec<f64>,
    /// Joints whose sizes are looked for.
    pub(super) is_open: Vec<bool>,
    /// Products of the joints that the hypothesis does not reach, where they are known.
    pub(super) reduced: Vec<Option<Reduced>>,
}

impl Start {
    /// At sizes, all of which are looked for.
    #[must_use]
    pub(in crate::gap) fn at(sizes: Sizes) -> Start {
        let is_open = vec![true; sizes.len()];
        let reduced = vec![None; sizes.len()];
        Start { sizes, amplitudes: Vec::new(), is_open, reduced }
    }

    /// Near known fits: joints that a hypothesis reaches as one of these does keep the sizes of that.
    #[must_use]
    pub(in crate::gap) fn near(design: &Design, of: &Hypothesis, known: [Known<'_>; 2]) -> Start {
        let [_, near] = known;
        // Sizes that made up for an effect are too large with it, and would shrink slowly.
        let mut start = Start::at(halfway(near.sizes));
        for joint in 0..design.joints.len() {
            let same = known.iter().find(|fit| same_members(fit.hypothesis, of, joint));
            if let Some(fit) = same {
                start.sizes[joint] = fit.sizes[joint].clone();
                start.is_open[joint] = false;
                let parameters = design.parameters.count();
                start.reduced[joint] = (!of.reaches(joint))
                    .then(|| fit.reduced[joint].beside(1 + parameters, of.columns()));
            }
        }
        let members = near.hypothesis.members.iter().zip(&of.members);
        let same = members.take_while(|(a, b)| a.is_same(b)).zip(near.amplitudes);
        start.amplitudes = same.map(|(_, amplitude)| amplitude.value).collect();
        start
    }
}

/// Whether two hypotheses change a joint in the same way, by the same numbers of members.
fn same_members(a: &Hypothesis, b: &Hypothesis, joint: usize) -> bool {
    let reaching = |of: &'_ Hypothesis| -> Vec<usize> {
        (0..of.members.len()).filter(|k| of.members[*k].reaches(joint)).collect()
    };
    let [of_a, of_b] = [a, b].map(reaching);
    of_a == of_b && of_a.iter().all(|k| a.members[*k].is_same(&b.members[*k]))
}

impl Member {
    /// Whether it changes the torque of a joint.
    pub(super) fn reaches(&self, joint: usize) -> bool {
        self.piece.rows.iter().any(|(of, _)| *of == joint)
    }

    fn is_same(&self, other: &Member) -> bool {
        let (a, b) = (&self.piece, &other.piece);
        a.effect.id == b.effect.id && a.joint == b.joint && a.shape == b.shape
    }
}
