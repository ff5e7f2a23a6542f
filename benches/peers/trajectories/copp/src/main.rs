//! COPP on the paths of the example `peer_paths`: the same nodes, coefficients and limits, on one
//! thread. Each problem is solved from the coefficients of the nodes, as joulepath's is.

mod nodes;
mod solve;

use std::collections::BTreeMap;
use std::hint::black_box;
use std::time::Instant;

use nodes::{Nodes, numbers};
use serde_json::Value;
use solve::Given;

/// Repetitions of a time measurement, of which the least value is used; as in `peer_paths`.
const REPEATS: usize = 15;
const FEW: usize = 3;
/// Programs of a jerk-limited problem, as in COPP's example.
const PASSES: usize = 2;

/// Figures by name and number of intervals.
type Figures = BTreeMap<(&'static str, usize), Vec<f64>>;

/// The least time of the repetitions in s.
fn least_s<T>(repeats: usize, mut work: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64()
    };
    (0..repeats).map(once).fold(f64::INFINITY, f64::min)
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    if n == 0 { f64::NAN } else { 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]) }
}

/// One path on one grid.
struct Case<'a> {
    name: String,
    intervals: usize,
    own: &'a Value,
    given: Given<'a>,
    nodes: &'a Nodes,
}

impl Case<'_> {
    fn own(&self, name: &str) -> f64 {
        self.own[name].as_f64().unwrap_or(f64::NAN)
    }

    fn fastest(&self, figures: &mut Figures) {
        let solved = self.given.robot().and_then(|robot| {
            let b = self.given.fastest(&robot)?;
            let without = least_s(REPEATS, || self.given.fastest(&robot));
            Ok((b, without))
        });
        let (b, without) = match solved {
            Ok(solved) => solved,
            Err(error) => return println!("{}: COPP failed: {error}", self.name),
        };
        let whole = || self.given.fastest(&self.given.robot()?);
        let seconds = least_s(REPEATS, whole);
        let own_b = numbers(&self.own["fastest_b"]);
        let [own_time, time] = [&own_b, &b].map(|b| self.nodes.duration(b));
        let (own, own_without) = (self.own("fastest_s"), self.own("fastest_without_set_up_s"));
        println!(
            "{}: {:.3} {:.3} {:.2}; {:.3} {:.3} {:.2}; {time:.5} {own_time:.5}; {:.6} {:.6}",
            self.name,
            1e3 * seconds,
            1e3 * own,
            own / seconds,
            1e3 * without,
            1e3 * own_without,
            own_without / without,
            self.nodes.worst(&b),
            self.nodes.worst(&own_b),
        );
        let mut add = |name, value| figures.entry((name, self.intervals)).or_default().push(value);
        add("time-optimal, time over COPP's", own / seconds);
        add("time-optimal without set-up, time over COPP's", own_without / without);
        add("time-optimal, duration over COPP's", own_time / time);
    }

    fn least(&self, figures: &mut Figures) {
        let per_second = self.own("marginal_w");
        let b = match self.given.least(per_second) {
            Ok(b) => b,
            Err(error) => return println!("{}: COPP failed: {error}", self.name),
        };
        let seconds = least_s(FEW, || self.given.least(per_second));
        let own_b = numbers(&self.own["least_b"]);
        let own = self.own("least_s");
        let [own_time, time] = [&own_b, &b].map(|b| self.nodes.duration(b));
        let cost =
            |b: &[f64], at: f64| per_second * self.nodes.duration(b) + self.nodes.thermal(b, at);
        let excess = |at: f64| cost(&own_b, at) / cost(&b, at) - 1.0;
        println!(
            "{}: {:.1} {:.1} {:.2}; {time:.5} {own_time:.5}; {:.3} {:.3}; {:+.4} {:+.4}; {:.6} \
             {:.6}{}",
            self.name,
            1e3 * seconds,
            1e3 * own,
            own / seconds,
            self.nodes.thermal(&b, 0.5),
            self.nodes.thermal(&own_b, 0.5),
            100.0 * excess(0.0),
            100.0 * excess(0.5),
            self.nodes.worst(&b),
            self.nodes.worst(&own_b),
            if self.own["converged"] == true { "" } else { " (own not converged)" },
        );
        let mut add = |name, value| figures.entry((name, self.intervals)).or_default().push(value);
        add("least energy, time over COPP's", own / seconds);
        add("least energy, ms", 1e3 * own);
        add("least energy of COPP, ms", 1e3 * seconds);
        add("least energy, objective over COPP's, its rule", 1.0 + excess(0.0));
        add("least energy, objective over COPP's, own rule", 1.0 + excess(0.5));
    }

    fn smooth(&self, figures: &mut Figures) {
        let per_second = self.own("marginal_w");
        let mut row = format!("{}:", self.name);
        for passes in 1..=PASSES {
            let result = match self.given.smooth(per_second, passes) {
                Ok(result) => result,
                Err(error) => return println!("{row} COPP failed in pass {passes}: {error}"),
            };
            let seconds = least_s(FEW, || self.given.smooth(per_second, passes));
            row += &format!(
                " {:.1} ms, {:.3}, {:.5} s;",
                1e3 * seconds,
                result.objective,
                result.duration
            );
            if passes == PASSES {
                let name = ("jerk-limited least energy of COPP, ms", self.intervals);
                figures.entry(name).or_default().push(1e3 * seconds);
                row += &format!(" {:.6}", self.nodes.worst(&result.a));
            }
        }
        println!("{row}");
    }
}

/// Where the time of joulepath's whole energy result goes.
fn stages(data: &Value, figures: &mut Figures) {
    const STAGES: [(&str, &str); 4] = [
        ("set_up", "whole energy result, set-up, ms"),
        ("time_optimal", "whole energy result, time_optimal, ms"),
        ("energy_bound", "whole energy result, energy_bound, ms"),
        ("minimize_energy", "whole energy result, minimize_energy, ms"),
    ];
    for path in data["paths"].as_array().into_iter().flatten() {
        for size in path["sizes"].as_array().into_iter().flatten() {
            let intervals = numbers(&size["grid"]["s"]).len();
            let label = if intervals < 500 { 100 } else { 1000 };
            for (stage, name) in STAGES {
                let ms = 1e3 * size["stages_s"][stage].as_f64().unwrap_or(f64::NAN);
                figures.entry((name, label)).or_default().push(ms);
            }
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("give the file of the paths")?;
    let data: Value = serde_json::from_str(&std::fs::read_to_string(file)?)?;
    let mut problems = Vec::new();
    for path in data["paths"].as_array().ok_or("no paths")? {
        for (size, intervals) in path["sizes"].as_array().into_iter().flatten().zip([100, 1000]) {
            let own = &size["nodes"];
            let name = path["name"].as_str().unwrap_or("?");
            let nodes = Nodes::new(own);
            problems.push((format!("{name}, {}", nodes.s.len()), intervals, own, nodes));
        }
    }
    let cases: Vec<Case> = problems
        .iter()
        .map(|(name, intervals, own, nodes)| Case {
            name: name.clone(),
            intervals: *intervals,
            own,
            given: Given::new(nodes),
            nodes,
        })
        .collect();
    let mut figures = Figures::new();
    println!(
        "time-optimal, path, nodes: COPP ms, joulepath ms, ratio; the same without set-up; \
         durations s; worst share of a limit of both"
    );
    cases.iter().for_each(|case| case.fastest(&mut figures));
    println!(
        "least energy, path, nodes: COPP ms, joulepath ms, ratio; durations s; thermal energies \
         J; objective over COPP's by its rule and by joulepath's, %; worst shares"
    );
    cases.iter().for_each(|case| case.least(&mut figures));
    println!(
        "jerk-limited least energy of COPP, path, nodes: time, objective, duration after one and \
         two programs; worst share of a limit other than jerk"
    );
    let large = cases.iter().filter(|case| case.intervals == 1000);
    large.for_each(|case| case.smooth(&mut figures));
    stages(&data, &mut figures);
    println!("figure, N: median, least, most, paths");
    for ((name, intervals), values) in &figures {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        println!(
            "{name}, {intervals}: {:.5}, {least:.5}, {most:.5}, {}",
            median(values),
            values.len()
        );
    }
    Ok(())
}
