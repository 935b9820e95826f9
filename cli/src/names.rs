//! Lists of functions on the command line.

use articulated_codegen::{FunctionSpec, resolve_synonym};
use articulated_core::algorithm::{function, functions};

use articulated_codegen::function_groups::{ALL, Group, MOTION, functions_of};

/// The functions that one word of the command line names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Names(Vec<String>);

/// Functions of the table and groups of them, with commas between.
pub(crate) fn known(text: &str) -> Result<Names, String> {
    each(text, &known_one)
}

/// As [`known`], with the generator's syntax: `name = first + second(a = 0)`, and `motion` of a
/// scene.
pub(crate) fn requested(text: &str) -> Result<Names, String> {
    each(text, &|entry| match entry.contains(['=', '+', '(']) {
        true => FunctionSpec::parse(entry).map(|_| vec![entry.to_owned()]).map_err(|e| e.to_string()),
        // A group may have functions that the robot lacks: it stays one word.
        false if entry == MOTION || functions_of(entry).is_some() => Ok(vec![entry.to_owned()]),
        false => known_one(entry),
    })
}

/// All of several words.
pub(crate) fn flat(words: &[Names]) -> Vec<String> {
    words.iter().flat_map(|w| w.0.iter().cloned()).collect()
}

fn each(text: &str, one: &dyn Fn(&str) -> Result<Vec<String>, String>) -> Result<Names, String> {
    let mut names = Vec::new();
    for entry in entries(text) {
        names.extend(one(entry.trim())?);
    }
    Ok(Names(names))
}

/// The text between the commas that are in no brackets.
fn entries(text: &str) -> impl Iterator<Item = &str> {
    let mut depth = 0;
    text.split(move |c| {
        depth += match c {
            '(' | '[' => 1,
            ')' | ']' => -1,
            _ => 0,
        };
        c == ',' && depth == 0
    })
}

fn known_one(name: &str) -> Result<Vec<String>, String> {
    if function::<f64>(name).is_some() {
        return Ok(vec![name.to_owned()]);
    }
    if let Some(functions) = functions_of(name) {
        return Ok(functions);
    }
    let all = || functions::<f64>().iter().map(|f| f.name).chain(Group::ALL.map(Group::name)).chain([ALL]);
    let near = resolve_synonym(name, all()).map(|n| format!("did you mean {n}? ")).unwrap_or_default();
    let groups = Group::ALL.map(Group::name).join(", ");
    Err(format!("{near}there are the groups {groups} and {ALL}, and the functions that `articulated functions` lists"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(names: &[&str]) -> Result<Names, String> {
        Ok(Names(names.iter().map(|n| (*n).to_owned()).collect()))
    }

    #[test]
    fn a_misspelt_function_is_guessed() {
        assert!(known("inverse_dynamic").unwrap_err().contains("did you mean inverse_dynamics?"));
        assert!(known("kinematic").unwrap_err().contains("did you mean kinematics?"));
        assert!(known("rnea").unwrap_err().starts_with("did you mean inverse_dynamics?"));
        assert!(known("inverse_kinematics").unwrap_err().starts_with("there are the groups"));
        assert!(known("x = mass_matrix").is_err() && requested("x = mass_matrx").is_err());
    }

    #[test]
    fn groups_are_their_functions() {
        assert_eq!(
            known("operational_space, placements"),
            list(&["operational_space_inertia", "operational_space_inertia_inverse", "placements"])
        );
    }

    #[test]
    fn commas_within_brackets_do_not_part() {
        let one = "slow = inverse_dynamics(v = 0, a = [0, 1])";
        assert_eq!(requested(&format!("{one},mass_matrix")), list(&[one, "mass_matrix"]));
    }
}
