//! Everything that is wrong with a request, not only the first of it: what was refused is left out, and the rest tried again.

use articulated_scene::Tried;

use crate::function_groups::Group;
use crate::{Error, Options, Request};

/// Attempts the request, and again without what was refused, until nothing is or nothing can be left out.
pub(crate) fn tried<T>(request: &Request, attempt: impl Fn(&Request) -> Result<T, Error>) -> Tried<Request, T, Error> {
    articulated_scene::tried(request, attempt, |error, request| leave_out(error, &mut request.options))
}

/// The value of an attempt of which nothing was refused, or all that was.
pub(crate) fn all<T>(request: &Request, attempt: impl Fn(&Request) -> Result<T, Error>) -> Result<T, Error> {
    // Nothing is copied where nothing is wrong.
    attempt(request).map_err(|first| {
        let Tried { errors, .. } = tried(request, attempt);
        Error::of(errors).unwrap_or(first)
    })
}

/// Which of the entries of a list of functions an error is about that calls it by this name: the last that is called so, or else the last that has a function of this name in it.
pub fn entry_of<'a>(entries: impl IntoIterator<Item = &'a str>, name: &str) -> Option<usize> {
    let entries: Vec<&str> = entries.into_iter().collect();
    let called = |entry: &&str| entry.trim() == name || entry.split(['=', '(', '+']).next().is_some_and(|own| own.trim() == name);
    entries.iter().rposition(called).or_else(|| entries.iter().rposition(|entry| mentions(entry, name)))
}

/// Whether an entry is the function, or its group, or has it in it.
fn mentions(entry: &str, function: &str) -> bool {
    let of_group = Group::named(entry.trim()).is_some_and(|group| group.functions().any(|f| f == function));
    entry.trim() == function || of_group || entry.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == function)
}

/// Takes out of the options what `error` is about, or names it otherwise; whether there was such a thing.
fn leave_out(error: &Error, options: &mut Options) -> bool {
    let before = options.clone();
    take_out(error, options);
    *options != before
}

fn take_out(error: &Error, options: &mut Options) {
    match error {
        Error::UnknownFunction { found: function, .. }
        | Error::Singular { function, .. }
        | Error::BoundFrames { function, .. }
        | Error::NoMass { function, .. }
        | Error::TooMuchCode { function, .. }
        | Error::FunctionSpec { found: function, .. }
        | Error::SameName { name: function } => {
            if let Some(at) = entry_of(options.functions.iter().map(String::as_str), function) {
                options.functions.remove(at);
            }
        }
        Error::BatchTwice { found } => options.rust_mut().batch.retain(|real| real.name() != *found),
        Error::LevelOfTarget { .. } => options.level = crate::Level::default(),
        Error::Prefix { .. } => options.target = crate::Target::default(),
        Error::Parameter { found, .. } => options.parameters.retain(|p| p.trim() != found),
        Error::Rename { from, to, .. } => options.rename.retain(|(f, t)| (f, t) != (from, to)),
        Error::NameClash { second, ident, .. } => {
            let count = options.rename.len();
            options.rename.retain(|(from, _)| from != second);
            options.rename.push((second.clone(), format!("{ident}__{count}")));
        }
        Error::Robot(error) => {
            articulated_scene::leave_out(error, &mut options.robot);
        }
        Error::Several { errors } => errors.iter().for_each(|error| take_out(error, options)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;

    const ARM: &str = "<robot name='arm'><link name='base'/><link name='tip-1'><inertial><mass value='1'/>\
        <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link><link name='tip 1'/><link name='tip.1'/>\
        <joint name='hinge' type='continuous'><parent link='base'/><child link='tip-1'/></joint>\
        <joint name='one' type='fixed'><parent link='base'/><child link='tip 1'/></joint>\
        <joint name='two' type='fixed'><parent link='base'/><child link='tip.1'/></joint></robot>";

    fn told(change: impl Fn(&mut Options)) -> String {
        let mut request = Request::new("arm.urdf", ARM);
        request.options.rename = [("tip-1", "A"), ("tip 1", "B"), ("tip.1", "C")].map(|(from, to)| (from.into(), to.into())).to_vec();
        change(&mut request.options);
        generate(&request).map(|_| String::new()).unwrap_or_else(|e| e.to_string())
    }

    fn each_once(told: &str, words: &[&str]) {
        assert!(words.iter().all(|word| told.lines().filter(|line| line.contains(word)).count() == 1), "{told}");
        assert_eq!(told.lines().count(), words.len(), "{told}");
    }

    #[test]
    fn every_function_that_cannot_be_is_told_once() {
        let list = [
            "mass_matrix",
            "no_such",
            "other = inverse_dynamics(b = 0)",
            "x = no_such_2 + mass_matrix",
            "placements",
            "mass_matrix = placements",
            "placements = placements(q = 0)",
        ];
        let told = told(|o| o.functions = list.map(String::from).to_vec());
        each_once(
            &told,
            &["function `no_such`", "b = 0", "function `no_such_2`", "what another function is called", "two are called `placements`"],
        );
    }

    /// Whatever other entries have the name in them, as a part of a sum or an argument.
    #[test]
    fn each_entry_s_own_mistake_is_told_once() {
        let constant = |name: &str| format!("`{name}`: constant q");
        for (list, names) in [
            (["placements(q = [0, 1])", "x = gravity_torque(q = [0, 1]) + placements"], ["placements", "x"]),
            (["v = placements(q = [0, 1])", "x = bias_forces(v = [0], q = [0, 1])"], ["v", "x"]),
            (["placements(q = [0, 1])", "x = placements(q = [1, 2, 3])"], ["placements", "x"]),
        ] {
            let told = told(|o| o.functions = list.map(String::from).to_vec());
            each_once(&told, &[&constant(names[0]), &constant(names[1])]);
        }
    }

    #[test]
    fn functions_that_nobody_knows_are_told_of_a_robot_that_cannot_be_read_too() {
        let mut request = Request::new("arm.urdf", ARM.replace("mass value='1'", "mass value='one'"));
        request.options.functions = ["no_such", "mass_matrix", "x = inverse_dynamics(b = 0)"].map(String::from).to_vec();
        each_once(&generate(&request).unwrap_err().to_string(), &["`no_such`", "b = 0", "mass value"]);
    }

    #[test]
    fn numbers_that_cannot_be_are_told_once_and_with_all_else() {
        let told = told(|o| {
            o.robot.gravity = [0.0, f64::NAN, 0.0];
            o.robot.snap_angles = Some(2.0);
            o.functions = vec!["no_such".into()];
        });
        each_once(&told, &["gravity: found [0.0, NaN, 0.0], expected", "snap_angles: found 2, expected", "`no_such`"]);
    }

    #[test]
    fn a_type_of_numbers_that_is_there_twice_is_told_once_and_with_all_else() {
        let told = told(|o| {
            o.rust_mut().batch = [crate::Real::F32, crate::Real::F64, crate::Real::F32, crate::Real::F32].to_vec();
            o.functions = vec!["no_such".into()];
        });
        each_once(&told, &["batch: found a type that is there twice, f32, expected each once", "`no_such`"]);
    }

    #[test]
    fn of_a_function_and_a_form_of_another_the_name_that_both_have_is_told() {
        let list = ["gravity_torque_into = placements", "gravity_torque"];
        for list in [list, [list[1], list[0]]] {
            let told = told(|o| o.functions = list.map(String::from).to_vec());
            assert!(told.contains("two are called `gravity_torque_into`"), "{told}");
        }
    }

    #[test]
    fn a_function_is_mentioned_by_whole_words() {
        assert!(mentions(" mass_matrix ", "mass_matrix") && mentions("x = a + mass_matrix(q = 0)", "mass_matrix"));
        assert!(!mentions("mass_matrix_inverse", "mass_matrix") && !mentions("x = my_mass_matrix(q = 0)", "mass_matrix"));
    }

    #[test]
    fn every_name_that_two_have_is_told_and_every_renaming_that_cannot_be() {
        let told_of =
            |rename: &[(&str, &str)]| told(|o| o.rename = rename.iter().map(|(from, to)| ((*from).into(), (*to).into())).collect());
        assert_eq!(told_of(&[("tip 1", "B"), ("tip.1", "C")]), "");
        each_once(&told_of(&[]), &["\"tip 1\"", "\"tip.1\""]);
        each_once(&told_of(&[("tip 1", "B"), ("tip.1", "B"), ("nobody", "C"), ("hinge", "fn")]), &["nobody", "\"hinge\"", "`B`"]);
        each_once(&told_of(&[("tip 1", "B"), ("tip.1", "C"), ("tip 1", "D")]), &["rename \"tip 1\" to `D`: it is renamed twice"]);
    }

    #[test]
    fn every_parameter_and_every_edit_that_cannot_be_is_told_once() {
        each_once(
            &told(|o| o.parameters = [" payload(x)", "origin(hinge)", "inertia(y) "].map(String::from).to_vec()),
            &["\"x\"", "\"y\""],
        );
        let edits = told(|o| {
            o.robot.lock = [("a", 0.0), ("hinge", 0.0), ("b", 0.0)].map(|(name, at)| (name.to_owned(), vec![at])).to_vec();
            o.robot.frames = Some(["tip-1", "c", "tip-1"].map(String::from).to_vec());
            o.functions = vec!["no_such".into()];
            o.robot.shafts =
                ["d", "e"].map(|joint| crate::Shaft { joint: joint.into(), segments: 1, stiffness: 1.0, ..Default::default() }).to_vec();
            o.rename.clear();
        });
        each_once(&edits, &["\"d\"", "\"e\"", "\"a\"", "\"b\"", "\"c\"", "listed twice", "no_such"]);
    }

    #[test]
    fn every_effect_that_cannot_be_is_told_once_and_without_a_robot_nothing_that_needs_it() {
        let damping = |on: &str| crate::Applied {
            effect: articulated_core::effect::EffectId::damping,
            on: on.into(),
            at: crate::Origin::default(),
            parameters: vec![0.1],
        };
        let effects = told(|o| {
            o.robot.effects = ["hinge", "a", "hinge", "b"].map(damping).to_vec();
            o.functions = vec!["no_such".into()];
        });
        each_once(&effects, &["\"a\"", "given twice", "\"b\"", "`no_such`"]);
        let appended = told(|o| {
            let urdf = ARM.replace("'tip", "'top").into_bytes();
            o.robot.append.push(crate::Appended { urdf, file: "hand.urdf".into(), at: "nowhere".into(), ..Default::default() });
            o.robot.payloads.push(crate::Payload { link: "tip-1".into(), mass: -1.0, ..Default::default() });
        });
        each_once(&appended, &["append: ", "payload: "]);
    }
}
