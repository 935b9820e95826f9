//! Groups of the functions of the table: for printed lists, and to request several by one word.

use std::collections::BTreeMap;

pub use articulated_core::algorithm::Group;
use articulated_core::diagnostic::Spanned;
use articulated_core::step::of_group;

/// The word for all functions that the motion of a scene calls.
pub const MOTION: &str = "motion";

/// The word for all functions of the table.
pub const ALL: &str = "all";

/// The functions of the group of this name, in the table or beside it; all of the table for `all`.
pub fn functions_of(name: &str) -> Option<Vec<String>> {
    match Group::named(name) {
        Some(group) => Some(group.functions().map(str::to_owned).collect()),
        None if name == ALL => Some(all()),
        None => {
            let group = Group::BESIDE.into_iter().find(|group| group.name() == name)?;
            Some(of_group::<f64>(group).iter().map(|f| f.name.to_owned()).collect())
        }
    }
}

/// The group through which a list has each function that it does not name alone. A robot may lack
/// such a function: it is left out with a warning.
pub(crate) fn members(list: &[Spanned<String>]) -> BTreeMap<String, String> {
    let mut members = BTreeMap::new();
    for entry in list {
        for name in functions_of(entry).into_iter().flatten() {
            members.entry(name).or_insert_with(|| entry.value.clone());
        }
    }
    list.iter().for_each(|entry| _ = members.remove(&entry.value));
    members
}

/// The same list with each group's functions in the place of its name, those of `motion` in the
/// place of that, and each entry once.
pub(crate) fn expanded(list: &[Spanned<String>], motion: &[String]) -> Vec<Spanned<String>> {
    let mut all: Vec<Spanned<String>> = Vec::new();
    for entry in list {
        let names: Vec<String> = match functions_of(entry) {
            Some(names) => names,
            None if entry.value == MOTION && !motion.is_empty() => motion.to_vec(),
            None => vec![entry.value.clone()],
        };
        for name in names {
            if !all.iter().any(|other| other.value == name) {
                all.push(Spanned { value: name, span: entry.span.clone() });
            }
        }
    }
    all
}

/// All functions, group by group.
pub fn all() -> Vec<String> {
    Group::ALL.into_iter().flat_map(Group::functions).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use articulated_core::algorithm::functions;

    use super::*;

    #[test]
    fn every_function_is_in_one_group_and_no_group_is_called_like_a_function() {
        assert_eq!(all().len(), functions::<f64>().len());
        assert!(Group::ALL.into_iter().all(|g| g.functions().next().is_some() && !all().contains(&g.name().to_owned())));
        assert!(!all().contains(&ALL.to_owned()));
    }

    #[test]
    fn a_group_stands_for_its_functions_and_what_is_asked_for_twice_is_there_once() {
        let owned = |list: &[&str]| -> Vec<Spanned<String>> { list.iter().map(|name| (*name).into()).collect() };
        let expanded = |list: &[Spanned<String>], motion: &[String]| {
            super::expanded(list, motion).into_iter().map(|name| name.value).collect::<Vec<_>>()
        };
        let list = owned(&["dissipation", "operational_space", "dissipation", "operational_space_inertia", "x = effects"]);
        assert_eq!(expanded(&list, &[]), ["dissipation", "operational_space_inertia", "operational_space_inertia_inverse", "x = effects"]);
        let of_a_scene = ["forward_dynamics", "integrate"].map(str::to_owned);
        assert_eq!(expanded(&owned(&["integrate", "motion"]), &of_a_scene), ["integrate", "forward_dynamics"]);
        assert_eq!(expanded(&owned(&["motion"]), &[]), ["motion"]);
        assert_eq!(expanded(&owned(&["all"]), &[]), all());
    }

    #[test]
    fn members_of_groups_are_those_that_the_list_does_not_name_alone() {
        let list = ["operational_space", "all", "operational_space_inertia", "x = mass_matrix"].map(Into::into);
        let members = members(&list);
        assert_eq!(members["operational_space_inertia_inverse"], "operational_space");
        assert_eq!((members["mass_matrix"].as_str(), members.get("operational_space_inertia")), ("all", None));
    }
}
