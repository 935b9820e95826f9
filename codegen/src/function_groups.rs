//! Groups of the functions of the table: for printed lists, and to request several by one word.

pub use articulated_core::algorithm::Group;
use articulated_core::diagnostic::Spanned;

/// The word for all functions that the motion of a scene calls.
pub const MOTION: &str = "motion";

/// The list with each group's name, and `motion`, replaced by their functions; each entry once.
pub(crate) fn expanded(list: &[Spanned<String>], motion: &[String]) -> Vec<Spanned<String>> {
    let mut all: Vec<Spanned<String>> = Vec::new();
    for entry in list {
        let names: Vec<String> = match Group::named(entry) {
            Some(group) => group.functions().map(str::to_owned).collect(),
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
    }
}
