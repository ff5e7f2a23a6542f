use super::function::Source;
use super::functions::FUNCTIONS;
use super::index::INSTRUCTIONS;
use super::parameter::positional;
use super::types::TYPES;
use super::*;

fn lower_names() -> Vec<String> {
    let instructions = INSTRUCTIONS.into_iter().flatten().map(|entry| entry.name);
    let functions = FUNCTIONS.iter().map(|entry| entry.name);
    instructions.chain(functions).map(str::to_lowercase).collect()
}

#[test]
fn each_table_is_sorted_and_no_name_is_there_twice() {
    let lower = |name: &&str| name.to_lowercase();
    for table in INSTRUCTIONS {
        let names: Vec<&str> = table.iter().map(|entry| entry.name).collect();
        assert!(names.is_sorted_by_key(lower), "{names:?}");
    }
    let functions: Vec<&str> = FUNCTIONS.iter().map(|entry| entry.name).collect();
    assert!(functions.is_sorted_by_key(lower), "{functions:?}");
    assert!(TYPES.is_sorted_by_key(|entry| entry.name));
    let mut names = lower_names();
    names.sort();
    let all = names.len();
    names.dedup();
    assert_eq!(names.len(), all, "a name is there twice");
}

#[test]
fn movements_have_a_target_and_a_speed() {
    for entry in INSTRUCTIONS.into_iter().flatten().filter(|entry| entry.is_movement()) {
        let signature = entry.movement();
        let Some(signature) = signature else { unreachable!("{} has no target", entry.name) };
        let has_tool = positional(entry.arguments).any(|parameter| parameter.name == "Tool");
        assert_eq!(has_tool, signature.form != MoveForm::ExternalJoint, "{}", entry.name);
        assert!(entry.is_known() && entry.effect == Effect::Nothing, "{}", entry.name);
    }
}

#[test]
fn similar_names_are_not_movements() {
    for name in ["MoveJ", "MOVEABSJ", "triggL", "SearchExtJ", "MoveLDO"] {
        assert!(is_movement(name) && is_of_move_family(name), "{name}");
    }
    for name in ["ArcLStart", "SPOTL", "ArcC2End", "ArcL1"] {
        assert!(is_movement(name) && !is_of_move_family(name), "{name}");
    }
    // Conditions, interrupts and procedures with similar names.
    for name in ["TriggIO", "TriggEquip", "MoveHome", "StartMove", "Search", "ArcL3", "ArcRefresh"]
    {
        assert!(!is_movement(name), "{name}");
    }
}

#[test]
fn ended_settings_are_not_simulated() {
    for entry in INSTRUCTIONS.into_iter().flatten() {
        let Effect::Ends(names) = entry.effect else { continue };
        for name in names {
            assert_eq!(instruction(name).map(|set| set.effect), Some(Effect::Unmodelled));
        }
    }
}

#[test]
fn signals_have_a_kind() {
    for entry in INSTRUCTIONS.into_iter().flatten() {
        let sets = matches!(entry.effect, Effect::Output(_));
        let waits = matches!(entry.effect, Effect::Wait(Wait::Input | Wait::Output));
        assert!(!(sets || waits) || entry.signal().is_some(), "{}", entry.name);
    }
    for entry in FUNCTIONS {
        assert_eq!(entry.signal().is_some(), entry.source == Source::Signal, "{}", entry.name);
    }
}

#[test]
fn components_have_types_of_the_table() {
    for ty in TYPES {
        for (_, component) in ty.components() {
            assert!(data_type(component).is_some(), "{component}");
        }
    }
}

#[test]
fn speeds_and_zones_have_the_values_of_the_reference() {
    let nums = |values: &[f64]| Literal::List(values.iter().map(|x| Literal::Num(*x)).collect());
    let speed = predefined("v1500").map(|data| data.value);
    assert_eq!(speed, Some(nums(&[1500.0, 500.0, 5000.0, 1000.0])));
    assert!(predefined("v1501").is_none());
    let Some(Predefined { value: Literal::List(z50), .. }) = predefined("z50") else {
        unreachable!("z50 is predefined")
    };
    assert_eq!(z50[0], Literal::Bool(false));
    assert_eq!(z50[4], Literal::Num(7.5));
}
