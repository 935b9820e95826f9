//! Lists of functions on the command line.

use articulated_codegen::function_groups::{ALL, Group, MOTION, functions_of};
use articulated_codegen::{FunctionSpec, resolve_synonym};
use articulated_core::algorithm::{Function, function, functions};
use articulated_core::step::{beside_the_table, step};

/// The functions that one word of the command line names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Names(Vec<String>);

/// Functions of the table and groups of them, with commas between.
pub(crate) fn known(text: &str) -> Result<Names, String> {
    each(text, &of_table)
}

/// As [`known`], with functions beside the table, as steps are, and the generator's syntax:
/// `name = first + second(a = 0)`, and `motion` of a scene.
pub(crate) fn requested(text: &str) -> Result<Names, String> {
    each(text, &|entry| match entry.contains(['=', '+', '(']) {
        true => FunctionSpec::parse(entry).map(|_| vec![entry.to_owned()]).map_err(|e| e.to_string()),
        // A group may have functions that the robot lacks: it stays one word.
        false if entry == MOTION || functions_of(entry).is_some() => Ok(vec![entry.to_owned()]),
        false if step::<f64>(entry).is_some() || function::<f64>(entry).is_some() => Ok(vec![entry.to_owned()]),
        false => Err(unknown(entry, beside_the_table(), &Group::BESIDE)),
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

fn of_table(name: &str) -> Result<Vec<String>, String> {
    if function::<f64>(name).is_some() {
        return Ok(vec![name.to_owned()]);
    }
    if Group::BESIDE.iter().any(|group| group.name() == name) || step::<f64>(name).is_some() {
        return Err("a function beside the table, as steps are: `articulated rollout` runs steps, `articulated generate` \
                    generates them"
            .to_owned());
    }
    functions_of(name).ok_or_else(|| unknown(name, [].into_iter(), &[]))
}

/// The error about a name, with these functions and groups beside those of the table.
fn unknown(name: &str, beside: impl Iterator<Item = &'static Function<f64>>, groups: &[Group]) -> String {
    let groups: Vec<&str> = Group::ALL.iter().chain(groups).map(|group| group.name()).collect();
    let all = functions::<f64>().iter().chain(beside).map(|f| f.name).chain(groups.iter().copied()).chain([ALL]);
    let near = resolve_synonym(name, all).map(|n| format!("did you mean {n}? ")).unwrap_or_default();
    let groups = groups.join(", ");
    format!("{near}there are the groups {groups} and {ALL}, and the functions that `articulated functions` lists")
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
    fn steps_are_requested_and_not_evaluated() {
        for name in ["step_rk4", "actuated_step_rk4", "actuator_torques", "steps", "actuators"] {
            assert_eq!(requested(name), list(&[name]));
            assert!(known(name).unwrap_err().contains("articulated rollout"), "{name}");
        }
        assert!(requested("step_rk").unwrap_err().contains("did you mean step_rk4?"));
        assert!(requested("step").unwrap_err().contains("steps"));
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
