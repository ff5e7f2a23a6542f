//! Table 3 of Paes et al. 2014 beside ours: the power that standing still takes.
//!
//! `cargo run --example paper_standstill`; the poses are ours, see
//! `fixtures/paper/README.md`.

#![expect(clippy::print_stdout, reason = "an example shows something")]

use joulepath::dynamics::Load;
use joulepath::optimize::standstill::standing;
use joulepath::robot::find;

const POSES: &str = include_str!("../fixtures/paper/standstill.csv");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = find("IRB1600-10/1.45")?;
    println!("holding power in W of joints 1 + 2 + 3 = sum, and what the brake has to beat");
    println!("{:4}{:>28}{:>20}{:>28}{:>14}", "", "pose (deg)", "paper", "ours", "brake pays");
    for line in POSES.lines().skip(1) {
        let (name, figures) = line.split_once(',').ok_or("a pose has figures")?;
        let figures: Vec<f64> = figures.split(',').map(str::parse).collect::<Result<_, _>>()?;
        let (q, paper) = figures.split_at(6);
        let q: [f64; 6] = std::array::from_fn(|joint| q[joint].to_radians());
        let ours = standing(&model, &Load::none(), &q, 0.0);
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
