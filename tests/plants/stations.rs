//! Made-up programs for plants.

use joulepath::examine::plant::{Script, Step};

/// A program of several stations: ways there, an output, a wait, sometimes a time, ways back.
pub(crate) fn script(seed: u64) -> Script {
    let mut draws = fastrand::Rng::with_seed(seed);
    let mut steps = Vec::new();
    let mut line = 10;
    let file = || "main.mod".to_owned();
    for station in 0..draws.usize(3..8) {
        let mut go = |steps: &mut Vec<Step>, draws: &mut fastrand::Rng| {
            for last in [false, true] {
                line += 1;
                let duration_s = 0.4 + 2.5 * draws.f64();
                let energy_j = 60.0 * duration_s * (0.5 + draws.f64());
                steps.push(Step::Move { file: file(), line, duration_s, energy_j, stops: last });
            }
            line += 1;
            line
        };
        let at = go(&mut steps, &mut draws);
        if draws.bool() {
            let signal = format!("doStation{station}");
            steps.push(Step::Output { file: file(), line: at, signal, level: 1 });
        }
        let signal = format!("diStation{station}");
        steps.push(Step::Wait { file: file(), line: at + 1000, signal });
        if draws.bool() {
            let seconds = 0.2 + draws.f64();
            steps.push(Step::Pause { file: file(), line: at + 2000, seconds });
        }
        go(&mut steps, &mut draws);
    }
    Script::single(steps)
}
