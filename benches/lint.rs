//! Lints folders with a robot: files and megabytes per second. Each file is a different
//! pick-and-place program with about 120 lines and 55 movements.

use std::fmt::Write as _;
use std::path::Path;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use joulepath::arm::effects;
use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::retime::motion::Options;
use joulepath::tool::lint::{Group, Job, Settings, lint};

/// Tool, load and targets within reach of an IRB 1600-10/1.45.
const DATA: &str = "\
    PERS tooldata tGripper:=[TRUE,[[58,0,172.46],[0.965925826,0,0.258819045,0]],
        [3.1,[31.5,0,78.2],[1,0,0,0],0.018,0.022,0.009]];
    PERS loaddata loadPart:=[2.4,[0,0,22],[1,0,0,0],0.0041,0.0041,0.0063];
    CONST jointtarget jHome:=[[0,-12,14,20,105,-136],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pA:=[[820,-390,350],[0,0.843391446,-0.537299608,0],[-1,0,-2,0],
        [9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pB:=[[690,600,350],[0,0.843391446,-0.537299608,0],[0,0,-2,0],
        [9E9,9E9,9E9,9E9,9E9,9E9]];
";

/// Reproducible pseudo-random numbers.
struct Numbers(u64);

impl Numbers {
    /// From 0 to `most` − 1.
    fn below(&mut self, most: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        (self.0 >> 33) % most
    }

    fn one_of<'a>(&mut self, choices: &[&'a str]) -> &'a str {
        choices[self.below(choices.len() as u64) as usize]
    }
}

/// A program that picks and places parts.
fn program(index: usize) -> String {
    let mut numbers = Numbers(index as u64);
    let mut text = format!("MODULE Cell{index}\n{DATA}    PROC main()\n");
    text += "        MoveAbsJ jHome,v1000,fine,tGripper;\n";
    for part in 0..9 {
        let speed = numbers.one_of(&["v300", "v500", "v800", "v1000", "v1500", "v2000"]);
        let slow = numbers.one_of(&["v100", "v200", "v300"]);
        for (target, grip) in [("pA", "GripLoad loadPart"), ("pB", "GripLoad load0")] {
            let (x, y) = (numbers.below(110), numbers.below(90));
            let zone = numbers.one_of(&["fine", "z5", "z10", "z10", "z20", "z50"]);
            let over = format!("Offs({target},{x}-55,{y}-45,150)");
            let _ = write!(
                text,
                "        MoveJ {over},{speed},{zone},tGripper;
        MoveL Offs({target},{x}-55,{y}-45,0),{slow},fine,tGripper;
        SetDO doGrip,{part} MOD 2;
        WaitTime 0.3;
        {grip};
        MoveL {over},{speed},{zone},tGripper;
"
            );
        }
    }
    text + "    ENDPROC\nENDMODULE\n"
}

/// A folder of `count` programs.
fn folder(count: usize) -> Vec<SourceFile> {
    let file = |i: usize| {
        let path = Path::new("plant").join(format!("{i}.mod")).display().to_string();
        SourceFile::new(FileId(i as u32), path, program(i).into_bytes())
    };
    (0..count).map(file).collect()
}

fn bench(criterion: &mut Criterion) {
    let Ok(model) = effects::load("IRB1600-10/1.45") else { return };
    let settings = Settings::default();
    let mut group = criterion.benchmark_group("lint");
    group.sample_size(10);
    for count in [75, 150, 300, 600] {
        let files = folder(count);
        let bytes: usize = files.iter().map(|file| file.bytes.len()).sum();
        let job = Job {
            files: &files,
            groups: vec![Group {
                files: (0..count).collect(),
                entry: "main".to_owned(),
                system: None,
            }],
            model: Some(&model),
            options: Options::default(),
            settings: &settings,
        };
        group.throughput(Throughput::ElementsAndBytes {
            elements: count as u64,
            bytes: bytes as u64,
        });
        group.bench_with_input(BenchmarkId::from_parameter(count), &job, |bencher, job| {
            bencher.iter(|| lint(job));
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
