//! The figures and source excerpts on the page of a diagnosis.

use std::fs;

use crate::arm::robot::Model;
use crate::gap::{
    Attribution, Diagnosis, Quantity, Record, Verdict, attribution, missed, profile, shapes, trace,
};
use crate::rapid::text::decode;
use crate::tool::report::html::{Excerpt, Line, Pictures};

/// Number of program lines before and after a place.
const AROUND: usize = 4;

pub(super) fn pictures(model: &Model, records: &[Record<'_>], found: &Diagnosis) -> Pictures {
    if records.is_empty() {
        return Pictures { sources: sources(found), ..Pictures::default() };
    }
    let models = [model, &found.refit.applied, &found.improved.applied];
    let missed = models.map(|model| missed(records, model));
    let over = |joint: usize, quantity: Quantity| {
        missed.each_ref().map(|of| profile(records, of, joint, quantity))
    };
    let profiles = (0..model.dof)
        .map(|joint| vec![over(joint, Quantity::Speed), over(joint, Quantity::Position)]);
    let has_gap = found.verdict != Verdict::NoGap;
    let ids: Vec<&'static str> = found.effects.iter().map(|said| said.effect.id).collect();
    Pictures {
        attribution: if has_gap {
            attribution(records, model, [&found.refit, &found.improved], &ids)
        } else {
            Attribution::default()
        },
        trace: trace(records, &missed),
        profiles: profiles.collect(),
        shapes: found.effects.iter().flat_map(|of| shapes(records, &found.improved, of)).collect(),
        sources: sources(found),
    }
}

/// The program lines around the reported places.
fn sources(found: &Diagnosis) -> Vec<Excerpt> {
    let places = found.places.iter().filter_map(|place| place.line.as_ref());
    let excerpt = |(file, line): &(String, usize)| {
        let text = decode(&fs::read(file).ok()?).text;
        let numbered = text.lines().enumerate().map(|(k, text)| (k + 1, text));
        let near = numbered.filter(|(number, _)| number.abs_diff(*line) <= AROUND);
        let lines =
            near.map(|(number, text)| Line { number, text: text.to_owned(), hot: number == *line });
        Some(Excerpt { place: format!("{file}:{line}"), lines: lines.collect() })
    };
    places.filter_map(excerpt).collect()
}
