//! Output in the forms that other programs read.

use joulepath::report::lint::{github, gitlab, json, junit, sarif};
use serde_json::Value;

use crate::fixtures;

/// The JSON has the fields of the contract.
#[test]
fn json_has_the_fields_of_the_contract() {
    let all = fixtures();
    let fixture = all.iter().find(|it| it.path.ends_with("EW102_stop_in_line.mod")).unwrap();
    let value = json::json(&fixture.report(), &fixture.files);
    let finding = &value["findings"][0];
    for key in [
        "code",
        "name",
        "severity",
        "file",
        "line",
        "column",
        "end_line",
        "end_column",
        "message",
        "saving_j",
        "saving_s",
        "saving_low_j",
        "saving_high_j",
        "per",
        "assumptions",
        "fix",
    ] {
        assert!(finding.get(key).is_some(), "{key}");
    }
    let edit = &finding["fix"]["edits"][0];
    let (start, end) = (edit["start"].as_u64().unwrap(), edit["end"].as_u64().unwrap());
    assert_eq!(&fixture.files[0].bytes[start as usize..end as usize], b"fine");
    for key in ["findings", "saving_j", "cycle_energy_j", "unresolved"] {
        assert!(value["totals"].get(key).is_some(), "{key}");
    }
}

/// The others name every finding.
#[test]
fn all_forms_name_all_findings() {
    for fixture in fixtures() {
        let report = fixture.report();
        let count = report.findings.len();
        let text = github::github(&report, &fixture.files);
        assert_eq!(text.lines().count(), count);
        let entries = gitlab::gitlab(&report, &fixture.files);
        let entries = entries.as_array().unwrap();
        let mut prints: Vec<&Value> = entries.iter().map(|entry| &entry["fingerprint"]).collect();
        prints.sort_by_key(ToString::to_string);
        prints.dedup();
        assert_eq!((entries.len(), prints.len()), (count, count));
        let text = junit::junit(&report, &fixture.files);
        let document = roxmltree::Document::parse(&text).unwrap();
        let failures = document.descendants().filter(|node| node.has_tag_name("failure")).count();
        assert_eq!(failures, count);
        let value = sarif::sarif(&report, &fixture.files);
        assert_eq!(value["runs"][0]["results"].as_array().unwrap().len(), count);
    }
}

/// The SARIF is what the official schema allows: types made of that schema read it, and what
/// they write is what they read, so no property is unknown to it.
#[test]
fn sarif_is_what_the_schema_allows() {
    let mut results = 0;
    for fixture in fixtures() {
        let value = sarif::sarif(&fixture.report(), &fixture.files);
        let read: serde_sarif::sarif::Sarif = serde_json::from_value(value.clone()).unwrap();
        results += read.runs[0].results.as_ref().unwrap().len();
        assert_eq!(sorted(serde_json::to_value(&read).unwrap()), sorted(value));
    }
    assert!(results > 30, "{results}");
}

/// Objects with their keys in order.
fn sorted(value: Value) -> Value {
    match value {
        Value::Object(map) => {
            let map: std::collections::BTreeMap<String, Value> =
                map.into_iter().map(|(key, value)| (key, sorted(value))).collect();
            serde_json::to_value(map).unwrap()
        }
        Value::Array(list) => Value::Array(list.into_iter().map(sorted).collect()),
        other => other,
    }
}
