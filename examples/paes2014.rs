//! Compares figures 4 and 5 and table 3 of Paes et al., "Energy efficient trajectories for an
//! industrial ABB robot", Procedia CIRP 15 (2014) 105–110, with computed values: `cargo run
//! --example paes2014`. `docs/paes2014.md` explains each difference; `fixtures/paper/README.md`
//! describes the assumed points and poses.

#![expect(clippy::print_stdout, reason = "an example shows something")]

use joulepath::arm::dynamics::Load;
use joulepath::arm::robot::{Model, find};
use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::retime::energy::{EnergyParts, account};
use joulepath::retime::motion::timeline::{Run, What};
use joulepath::retime::motion::{Options, Simulation, simulate};
use joulepath::retime::optimize::cost::Cost;
use joulepath::retime::optimize::freedom::{Bound, Freedom};
use joulepath::retime::optimize::retime::{Goal, Task, retime};
use joulepath::retime::optimize::standstill::standing;
use joulepath::tool::retrofit::{Source, read_program};

const PROGRAM: &str = include_str!("../fixtures/paper/Paper.mod");
const POSES: &str = include_str!("../fixtures/paper/standstill.csv");
const SPEEDS: [&str; 6] = ["v300", "v600", "v1000", "v1500", "v2000", "vmax"];
/// Durations of C over that of the fastest joint move.
const FACTORS: [f64; 6] = [0.97, 1.0, 1.1, 1.3, 1.6, 2.2];
/// Tolerance of C in m: practically unlimited.
const ANYWHERE: f64 = 1.0;

/// One measured move.
#[derive(Clone, Copy)]
struct Point {
    /// Duration in s.
    time: f64,
    /// Motion energy in J, without base power and brakes, as in the paper.
    energy: f64,
}

/// A run with its energy.
struct Measured<'a> {
    run: &'a Run,
    energy: EnergyParts,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = find("IRB1600-10/1.45")?;
    let simulation = simulation(&model)?;
    let [a, b, d] = [("rRightAngle", 4), ("rStraightLine", 2), ("rJointMove", 2)]
        .map(|(routine, size)| measured(&model, &simulation, routine, size));
    println!("figures 4 and 5: time (s) and motion energy (J) of the moves between P and Q");
    println!("{:8}{:>22}{:>22}{:>22}", "", "A right angle", "B straight line", "D joint move");
    let [a_points, b_points, d_points] = [&a, &b, &d].map(|moves| points(moves));
    for (i, speed) in SPEEDS.iter().enumerate() {
        let row: Vec<String> = [&a_points, &b_points, &d_points]
            .iter()
            .map(|points| points.get(i).map_or_else(String::new, shown))
            .collect();
        println!("{speed:8}{:>22}{:>22}{:>22}", row[0], row[1], row[2]);
    }
    let fastest = d.last().and_then(|runs| runs.first()).ok_or("the program has a joint move")?;
    let [Some(a_fast), Some(b_fast), Some(d_fast)] =
        [&a_points, &b_points, &d_points].map(|points| points.last().copied())
    else {
        return Err("the program has moves".into());
    };
    let (time_optimal, c_points) = computed(&model, fastest, d_fast);
    println!("time-optimal, on the joint move's path {}", shown(&time_optimal));
    println!("C energy-optimal, free path:");
    for (factor, point) in FACTORS.iter().zip(&c_points) {
        let text = point.as_ref().map_or("not possible".to_owned(), shown);
        println!("  {factor:4} × the time of D  {text}");
    }
    compare(a_fast, b_fast, d_fast, &a_points, &b_points, &c_points);
    table_3(&model)
}

fn shown(point: &Point) -> String {
    format!("{:6.3} s {:7.1} J", point.time, point.energy)
}

fn simulation(model: &Model) -> Result<Simulation, Box<dyn std::error::Error>> {
    let name = "Paper.mod".to_owned();
    let file = SourceFile::new(FileId(0), name.clone(), PROGRAM.as_bytes().to_vec());
    let (program, entry) = read_program(&[Source { file, relative: name }], "main")?;
    Ok(simulate(&program, entry, model, &Options::default()))
}

/// The moves of a routine at each speed; the last run of each speed is the way back.
fn measured<'a>(
    model: &Model,
    simulation: &'a Simulation,
    routine: &str,
    size: usize,
) -> Vec<Vec<Measured<'a>>> {
    let account = account(model, simulation);
    let runs = simulation.events.iter().zip(&account.events);
    let of_routine: Vec<(&Run, EnergyParts)> = runs
        .filter_map(|(event, parts)| match &event.what {
            What::Run(run) if &*run.moves.first()?.movement.routine == routine => {
                Some((&**run, parts.iter().fold(EnergyParts::default(), |sum, part| sum + *part)))
            }
            _ => None,
        })
        .collect();
    of_routine
        .chunks(size)
        .map(|chunk| {
            let forth = chunk.iter().take(size - 1);
            forth.map(|(run, energy)| Measured { run, energy: *energy }).collect()
        })
        .collect()
}

fn points(moves: &[Vec<Measured<'_>>]) -> Vec<Point> {
    let sum = |runs: &Vec<Measured<'_>>| Point {
        time: runs.iter().map(|m| m.run.duration()).sum(),
        energy: runs.iter().map(|m| m.energy.motion_energy_j()).sum(),
    };
    moves.iter().map(sum).collect()
}

/// The time-optimal move on the path of D, and C for several durations.
fn computed(model: &Model, d: &Measured<'_>, fastest: Point) -> (Point, Vec<Option<Point>>) {
    let freedom = |deviation: f64| Freedom {
        deviation,
        tcp: Bound::Robot,
        joints: Bound::Robot,
        ..Freedom::default()
    };
    let (kept, free) = (freedom(0.0), freedom(ANYWHERE));
    let solve = |freedom: &Freedom, goal: Goal| {
        let task = Task {
            model,
            run: d.run,
            energy_before: d.energy,
            spacing_s: 0.05,
            closest_s: 0.04,
            freedom,
            cost: Cost::Electrical,
        };
        let retiming = retime(&task, goal).ok()?;
        Some(Point { time: retiming.duration_s, energy: retiming.energy.motion_energy_j() })
    };
    let time_optimal = solve(&kept, Goal::Fastest).unwrap_or(fastest);
    let at = |factor: &f64| solve(&free, Goal::Exactly(factor * fastest.time));
    (time_optimal, FACTORS.iter().map(at).collect())
}

fn compare(
    a: Point,
    b: Point,
    d: Point,
    a_points: &[Point],
    b_points: &[Point],
    c_points: &[Option<Point>],
) {
    let percent = |from: f64, to: f64| format!("{:+.1} %", 100.0 * (to / from - 1.0));
    let slowed = |points: &[Point]| {
        let least = points.iter().map(|p| p.energy).fold(f64::INFINITY, f64::min);
        let most = points.last().map_or(f64::NAN, |p| p.energy);
        percent(most, least)
    };
    let c = |index: usize| {
        let point: Option<Point> = c_points.get(index).copied().flatten();
        point.map_or("not possible".to_owned(), |point| percent(d.energy, point.energy))
    };
    println!();
    println!("{:58}{:>12}{:>14}", "", "paper", "ours");
    let rows = [
        ("time of D over B at vmax", "-12 %", percent(b.time, d.time)),
        ("time of B over A at vmax", "", percent(a.time, b.time)),
        ("energy of C over D at vmax, in 3 % less time", "-4 %", c(0)),
        ("energy of C over D at vmax, in the same time", "", c(1)),
        ("energy of C over D at vmax, in 10 % more time", "", c(2)),
        ("energy saved by slowing A, at most", "steep", slowed(a_points)),
        ("energy saved by slowing B, at most", "steep", slowed(b_points)),
    ];
    for (what, paper, ours) in rows {
        println!("{what:58}{paper:>12}{ours:>14}");
    }
}

/// The power at standstill.
fn table_3(model: &Model) -> Result<(), Box<dyn std::error::Error>> {
    println!();
    println!("table 3: holding power (W) of joints 1 + 2 + 3 = sum, and what a brake has to beat");
    println!("{:4}{:>28}{:>20}{:>28}{:>14}", "", "pose (deg)", "paper", "ours", "brake pays");
    for line in POSES.lines().skip(1) {
        let (name, figures) = line.split_once(',').ok_or("a pose has figures")?;
        let figures: Vec<f64> = figures.split(',').map(str::parse).collect::<Result<_, _>>()?;
        let (q, paper) = figures.split_at(6);
        let q: [f64; 6] = std::array::from_fn(|joint| q[joint].to_radians());
        let ours = standing(model, None, &Load::none(), &q, 0.0);
        let shown = q.map(|angle| format!("{:.0}", angle.to_degrees())).join(" ");
        let sum = |watts: &[f64], digits: usize| {
            let each: Vec<String> = watts.iter().map(|w| format!("{w:.digits$}")).collect();
            format!("{} = {:.digits$}", each.join(" + "), watts.iter().sum::<f64>())
        };
        println!(
            "{name:4}{shown:>28}{:>20}{:>28}{:>12.2} s",
            sum(paper, 0),
            sum(&ours.per_joint_w[..3], 1),
            ours.break_even_s.unwrap_or(f64::NAN)
        );
    }
    Ok(())
}
