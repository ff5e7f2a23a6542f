//! Trial.
use crate::gap::design::{Design, piece_rows};
use crate::gap::nuisance::Trust;
use crate::gap::record::Record;
use crate::arm::effects::Effect;
use super::search::{Found, Search};
use std::time::Instant;

fn describe(found: &Found) -> String {
    found.effects.iter().map(|of| {
        let joints: Vec<String> = of.pieces.iter().map(|p| p.joint.map_or("R".into(), |j| (j+1).to_string())).collect();
        format!("{}[{}]({})", of.effect.id, joints.join(","), of.pieces.iter().map(|p| p.shape.iter().zip(p.effect.coordinates).filter(|(_, c)| !matches!(c.role, crate::arm::effects::Role::Linear)).map(|(x,_)| format!("{x:.4}")).collect::<Vec<_>>().join(",")).collect::<Vec<_>>().join(" "))
    }).collect::<Vec<_>>().join(" + ")
}
fn sizes(found: &Found) -> String {
    found.fit.sizes.iter().map(|s| {
        let groups: Vec<String> = s.groups.iter().map(|(g, v)| format!("{}{:.2}", match g { crate::gap::design::Group::Smooth(c) => format!("{c:?}").chars().filter(|c| c.is_uppercase()).collect::<String>(), crate::gap::design::Group::OtherPosition => "O".into(), crate::gap::design::Group::Day(c) => format!("D{c:?}").chars().filter(|c| c.is_uppercase()).collect::<String>(), crate::gap::design::Group::LogFriction=>"F".into(), crate::gap::design::Group::Form(k)=>format!("form{k}"), crate::gap::design::Group::Fixed=>"".into()}, 100.0*v.value)).collect();
        format!("[{} e{:.2}/{:.2}]", groups.join(" "), 100.0*s.error[0].value, 100.0*s.error[2].value)
    }).collect::<Vec<_>>().join("\n      ")
}
pub fn trial(records: &[Record<'_>], effects: &[&'static Effect], trust: Trust) {
    let t = Instant::now();
    let lap = |what: &str| eprintln!("  {what} {:.2}s", t.elapsed().as_secs_f64());
    let design = Design::new(records, trust, &crate::gap::tunables::Tunables::DEFAULT);
    lap(&format!("design rows {} columns {} cells {}", design.joints[0].y.len(), design.joints[0].base.ncols(), design.joints[0].cells.len()));
    let mut pieces = piece_rows(records, effects);
    if let Some(e) = effects.iter().find(|e| e.id == "link_parameters") { pieces.extend(crate::gap::design::link_pieces(records, &design, e)); }
    lap(&format!("pieces {} columns {}", pieces.len(), pieces.iter().map(|p| p.prior.len()*p.rows.len()).sum::<usize>()));
    let n = design.joints.len();
    let whole: Vec<crate::gap::design::Whole> = effects.iter().filter(|e| super::window::has_window(e)).flat_map(|e| { let js: Vec<usize> = if e.id == "contact" { vec![0] } else { (0..n).collect() }; js.into_iter().filter_map(|j| crate::gap::design::Whole::new(records, e, j)) }).collect();
    let search = Search { records, design: &design, pieces: &pieces, whole: &whole };
    let Some(none) = search.none() else { eprintln!("no fit"); return };
    lap("none");
    let shares: Vec<String> = (0..design.joints.len()).map(|j| format!("{:.2}", 100.0 * none.fit.everyday(&design, j))).collect();
    eprintln!("      everyday % {}", shares.join(" "));
        let j: usize = j.parse().unwrap();
        for r in records.iter().filter(|r| r.kind != crate::gap::record::RecordKind::Drift) {
            let m = &r.motion;
            println!("# {:?} rows {} step {} rms {}", r.kind, m.rows(), m.step(), design.joints[j].torque);
            for i in 0..m.rows() { println!("{:.4} {:.5} {:.5} {:.4} {:.4} {:.4} {:.0}", m.t[i], m.q[j][i], m.rates[j][i], m.qdd[j][i], m.torque[j][i], r.measured[j][i], r.window[j][i]); }
        }
        return;
    }
        for p in pieces.iter().filter(|p| p.effect.id == id) {
            for k in [0.5, 1.0, 1.5] {
                let mut shape = p.shape.clone(); shape[0] *= k;
                let q = p.reshaped(records, &shape);
                let c = super::search::Candidate { effect: q.effect, pieces: vec![q], cost: 5.0 };
                if let Some(f) = search.with(&none, vec![c], none.fit.sizes.clone()) {
                    let n = design.parameters.count();
                    eprintln!("   {} {:.1} tangent {:?} e {:?}", describe(&f), f.score, f.fit.mean.rows(n, f.fit.mean.len()-n).iter().collect::<Vec<_>>(), f.fit.sizes.iter().map(|s| (1e4*s.error[0].value).round()/100.0).collect::<Vec<_>>());
                }
            }
        }
        return;
    }
    let mut all: Vec<(f64, String)> = vec![(0.0, "-".into())];
    let mut best: Option<Found> = None;
    for round in 0..3 {
        let next = search.next(&none, best.as_ref().unwrap_or(&none));
        for found in &next { all.push((found.score, describe(found))); }
        lap("round");
        for found in next.iter().take(4) { eprintln!("    {round} {:9.1} {}", found.score, describe(found)); }
        let before = best.as_ref().map_or(0.0, |b| b.score);
        let Some(first) = next.into_iter().next() else { break };
        if first.score < before + 5.0 { break }
        let shares: Vec<String> = (0..design.joints.len()).map(|j| format!("{:.2}", 100.0 * first.fit.everyday(&design, j))).collect();
        eprintln!("      everyday % {}", shares.join(" "));
        best = Some(first);
    }
}

/// Rms of what an effect adds to a joint, of the joint's torque.
fn share(design: &Design, found: &Found, number: usize, joint: usize) -> f64 {
    let mut from = design.parameters.count();
    let (mut sum, mut n) = (nalgebra::DVector::<f64>::zeros(design.joints[joint].y.len()), 0);
    let mut k = 0;
    for (e, of) in found.effects.iter().enumerate() {
        for _ in &of.pieces {
            let member = &found.fit.hypothesis.members[k];
            let count = member.piece.prior.len();
            if e == number && let Some((_, rows)) = member.piece.rows.iter().find(|(at, _)| *at == joint) {
                let own = member.piece.own; sum += rows.columns(0, own) * found.fit.mean.rows(from, own);
            }
            from += count; k += 1;
        }
    }
    let d = &design.joints[joint];
    let (mut a, mut b) = (0.0, 0.0);
    for c in d.cells.iter().filter(|c| c.set == crate::gap::design::Set::Now) {
        a += sum.rows(c.rows.start, c.rows.len()).norm_squared(); b += c.power * c.rows.len() as f64;
        n += c.rows.len();
    }
    let _ = n;
    (a / b.max(1e-300)).sqrt()
}

/// Verdict with simple gates, as JSON.
pub fn decide(records: &mut [Record<'_>], effects: &[&'static Effect], trust: Trust) -> String {
    let t = Instant::now();
    let design = carried(records, trust);
    let records: &[Record<'_>] = records;
    let mut pieces = piece_rows(records, effects);
    if let Some(e) = effects.iter().find(|e| e.id == "link_parameters") { pieces.extend(crate::gap::design::link_pieces(records, &design, e)); }
    let n = design.joints.len();
    let whole: Vec<crate::gap::design::Whole> = effects.iter().filter(|e| super::window::has_window(e)).flat_map(|e| { let js: Vec<usize> = if e.id == "contact" { vec![0] } else { (0..n).collect() }; js.into_iter().filter_map(|j| crate::gap::design::Whole::new(records, e, j)) }).collect();
    let search = Search { records, design: &design, pieces: &pieces, whole: &whole };
    let Some(none) = search.none() else { return "{\"verdict\":\"failed\"}".into() };
    let none_shares: Vec<f64> = (0..n).map(|j| none.fit.everyday(&design, j)).collect();
    let mut best: Option<Found> = None;
    let mut log = Vec::new();
    for _ in 0..3 {
        let next = search.next(&none, best.as_ref().unwrap_or(&none));
        log.push(next.iter().take(4).map(|f| format!("{:.1} {}", f.score, describe(f))).collect::<Vec<_>>());
        let before = best.as_ref().map_or(0.0, |b| b.score);
        let Some(first) = next.into_iter().next() else { break };
        if first.score < before + 8.0 { break }
        best = Some(first);
    }
    let pruned = best.map(|best| pruned(&search, &none, best));
    let found = pruned.as_ref().unwrap_or(&none);
    let shares: Vec<f64> = (0..n).map(|j| found.fit.everyday(&design, j)).collect();
    let list: Vec<String> = found.effects.iter().enumerate().map(|(k, e)| {
        let js: Vec<String> = e.pieces.iter().map(|p| p.joint.map_or("0".into(), |j| (j + 1).to_string())).collect();
        let sh: Vec<String> = (0..n).map(|j| format!("{:.4}", share(&design, found, k, j))).collect();
        format!("{{\"id\":\"{}\",\"joints\":[{}],\"shares\":[{}]}}", e.effect.id, js.join(","), sh.join(","))
    }).collect();
    let noise: Vec<String> = design.joints.iter().map(|d| {
        let of = |set| { let (a, b) = d.cells.iter().filter(|c| c.set == set).fold((0.0, 0.0), |(a, b), c| (a + c.noise * c.rows.len() as f64, b + c.power * c.rows.len() as f64)); (a / f64::max(b, 1e-300)).sqrt() };
        format!("[{:.5},{:.5}]", of(crate::gap::design::Set::Now), of(crate::gap::design::Set::Baseline))
    }).collect();
    format!("{{\"score\":{:.1},\"effects\":[{}],\"none\":{:?},\"left\":{:?},\"noise\":[{}],\"log\":{:?},\"time\":{:.2},\"rows\":{}}}", found.score, list.join(","), none_shares, shares, noise.join(","), log, t.elapsed().as_secs_f64(), design.joints[0].y.len())
}

/// Laws go by the loads of the gears as the logs show them: those of a drawing may be off by a third.
fn carried(records: &mut [Record<'_>], trust: Trust) -> Design {
    use crate::arm::dynamics::{RIGID, link_of, link_parameters};
    let design = Design::new(records, trust, &crate::gap::tunables::Tunables::DEFAULT);
    let Some(fit) = crate::gap::posterior::fitted(&design, Default::default(), crate::gap::posterior::usual(&design), 8, false) else { return design };
    let Some(model) = records.first().map(|r| r.motion.model.clone()) else { return design };
    let count = design.parameters.mixing.ncols();
    let change = &design.parameters.mixing * fit.mean.rows(0, count);
    let mut other = model;
    for (number, link) in other.links.iter_mut().enumerate() {
        let mut all = link_parameters(link);
        for (k, x) in all.iter_mut().enumerate() { *x += change[RIGID * number + k]; }
        *link = link_of(&all);
    }
    for record in records.iter_mut() { record.motion.carry(&other); }
    Design::new(records, trust, &crate::gap::tunables::Tunables::DEFAULT)
}

/// The set without joints that hardly matter.
fn pruned(search: &Search<'_>, none: &Found, mut found: Found) -> Found {
    let mut e = 0;
    while e < found.effects.len() {
        let mut k = 0;
        while k < found.effects[e].pieces.len() && found.effects[e].pieces.len() > 1 {
            let mut effects = found.effects.clone();
            let piece = effects[e].pieces.remove(k);
            effects[e].cost -= 1.2 + (piece.choices.max(1) as f64).ln();
            match search.with(none, effects, none.fit.sizes.clone()) {
                Some(less) if less.score > found.score - 2.0 => found = less,
                _ => k += 1,
            }
        }
        e += 1;
    }
    found
}
