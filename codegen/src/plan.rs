//! A request, checked: its robot, its parameters and its functions. All findings come from one
//! pass, which reports invalid entries and leaves them out.

use std::collections::BTreeMap;

use articulated_core::Scalar;
use articulated_core::algorithm::{Dim, Function, Group, Needs, functions};
use articulated_core::description::Description;
use articulated_core::diagnostic::{At, Code, Diagnostic, Diagnostics, Place, Spanned, quote};
use articulated_core::effect::Effect;
use articulated_core::model::Model;
use articulated_formats::world::{Loop, Unread, World};
use articulated_formats::{LeaveOut, OnLockedJoint};
use articulated_scene::{BuiltRobot, Why, smooth_in_file};

use crate::function_spec::{FunctionSpec, wrong_entry};
use crate::language::refuses_port;
use crate::parameters::Parameter;
use crate::{Options, Request, Sym, function_groups, parameters, size};

/// Robots with more degrees of freedom get no code: a workspace has room for a matrix of their
/// number squared.
pub const MOST_FREEDOMS: usize = 10_000;

/// A request without errors.
pub(crate) struct Plan {
    pub(crate) robot: BuiltRobot,
    /// The model with the requested frames, without the constants that stay inputs.
    pub(crate) model: Model<f64>,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) functions: Vec<FunctionSpec>,
}

/// A readable entry of the list of functions, with its index.
pub(crate) type Entry = (usize, FunctionSpec);

/// Checks the request before programs are built. `None`: there is an error. `members`: the
/// functions that the request has through a group, with its name.
pub(crate) fn plan(request: &Request, members: &BTreeMap<String, String>, log: &mut Diagnostics) -> Option<Plan> {
    let options = &request.options;
    // Checks without the robot come first: they also run if the robot cannot be read.
    let entries = words(options, log);
    let mut robot = request.robot().build_into(log)?;
    if robot.model.nv() > MOST_FREEDOMS {
        let expected = format!("at most {MOST_FREEDOMS} to write code for");
        let found = format!("{} degrees of freedom", robot.model.nv());
        log.push(Diagnostic::error(&request.file, Place::DOCUMENT, Code::TooLarge, found, expected));
        return None;
    }
    // Mass that stays an input counts as mass.
    let massless = massless(&robot.model);
    let parameters = parameters::parse(options, &mut robot, log);
    let model = robot.framed(match parameters.is_empty() {
        true => robot.model.clone(),
        // Without the inertias that became inputs.
        false => request.robot().model_of(&robot).unwrap_or_else(|| robot.model.clone()),
    });
    let mut without = Vec::new();
    let entries = fitting(request, &model, &massless, entries, (members, &mut without), log);
    robot.reading.warnings.extend(without);
    let has_group = |group: Group| entries.iter().any(|(_, function)| function.parts.iter().any(|part| part.function.group == group));
    let touches = has_group(Group::Constraints) || has_group(Group::GivenContacts);
    if touches {
        let of_robot = (&robot.reading.description, &robot.reading.world, &robot.model);
        let warnings = unread_constraints(&request.file, of_robot, log);
        robot.reading.warnings.extend(warnings);
    }
    if has_group(Group::Actuators) || touches {
        let warnings = locked_actuators(&request.file, &robot.reading.world, &robot.model);
        let of_file = forces_of_the_file(&request.file, &robot);
        robot.reading.warnings.extend(warnings.into_iter().chain(of_file));
    }
    let names: Vec<String> = entries.iter().map(|(_, function)| function.name.clone()).collect();
    let derived = |(k, function): Entry| options.target.with_derivatives(function, &names).into_iter().map(move |f| (k, f));
    let entries: Vec<Entry> = entries.into_iter().flat_map(derived).collect();
    size::within_limit(request, &model, &entries, log);
    options.target.check_names(&model, request, log);
    let functions = entries.into_iter().map(|(_, function)| function).collect();
    log.is_ok().then_some(Plan { robot, model, parameters, functions })
}

/// Warnings of actuators on joints that the robot no longer has.
pub fn locked_actuators(file: &str, world: &World, model: &Model<f64>) -> Vec<Diagnostic> {
    let warning = |OnLockedJoint { actuator, joint }: OnLockedJoint| {
        let found = format!("the actuator {} on joint {}, which is locked", quote(&actuator), quote(&joint));
        let expected = "a joint that moves: it has no force there";
        Diagnostic::error(file, (Default::default(), "actuator"), Code::LostDynamics, found, expected).into_warning()
    };
    world.actuators_of(model).1.into_iter().map(warning).collect()
}

/// Reports constraints of the file that are not computed: errors, or the warnings that are returned
/// where an option leaves them out.
pub fn unread_constraints(
    file: &str,
    (description, world, model): (&Description, &World, &Model<f64>),
    log: &mut Diagnostics,
) -> Vec<Diagnostic> {
    let mut unread = world.constraints_of(description, model).1;
    let place = At::Nowhere;
    let of_loop = |own: &Loop| format!("{} {}", own.kind, quote(&own.name));
    let loops = world.loops.iter().filter(|own| !own.is_computed);
    unread.extend(loops.map(|own| Unread { kind: LeaveOut::Constraint, what: of_loop(own), place }));
    let left_out = world.touching.as_ref().map(|touching| touching.left_out.clone()).unwrap_or_default();
    let mut warnings = Vec::new();
    // One finding for each kind: a file may have thousands of pairs.
    for kind in [LeaveOut::Constraint, LeaveOut::Solver, LeaveOut::Contact] {
        let own: Vec<String> = unread.iter().filter(|own| own.kind == kind).map(|own| own.what.clone()).collect();
        let Some(first) = own.first() else { continue };
        let found = if own.len() == 1 { first.clone() } else { format!("{first}, and {} more", own.len() - 1) };
        let is_left_out = left_out.contains(&kind);
        let expected = match is_left_out {
            true => format!("constraints that are computed: `leave_out` has {}, and the motion is that without it", quote(kind.name())),
            false => {
                let given = "; with the key `given_contacts` (`--given-contact`, method `Build::given_contact`) a caller finds contacts";
                let given = if kind == LeaveOut::Contact { given } else { "" };
                format!("constraints that are computed; {} leaves it out{given}", kind.option())
            }
        };
        let finding = Diagnostic::error(file, (At::Nowhere, kind.name()), Code::Unsupported, found, expected);
        if is_left_out { warnings.push(finding.into_warning()) } else { log.push(finding) }
    }
    warnings
}

/// A warning of smooth forces of the file that do not act, although its actuators do.
pub fn forces_of_the_file(file: &str, robot: &BuiltRobot) -> Option<Diagnostic> {
    let off = &robot.resolved.report.off;
    let is_chosen = |row: &Effect| {
        robot.effects.iter().any(|own| own.effect == row.id) || off.iter().any(|own| own.effect == row.name && own.why != Why::NotAsked)
    };
    let in_file = smooth_in_file(&robot.reading.description.joints, &robot.reading.world);
    let names: Vec<&str> = in_file.filter(|row| !is_chosen(row)).map(|row| row.name).collect();
    (!names.is_empty()).then(|| {
        let found = format!("{} in the file, turned off, beside its actuators", names.join(", "));
        let expected =
            "`--effects file` (key `effects = \"file\"`, method `Build::file_effects`), which turns them on, or \"off\" in a scene";
        Diagnostic::error(file, (Default::default(), "effects"), Code::LostDynamics, found, expected).into_warning()
    })
}

/// What is wrong with the names of a user's function and of its ports.
fn wrong_ports(function: &Function<Sym>, lacks_result: bool) -> Option<String> {
    let is_group = function_groups::functions_of(function.name).is_some() || function.name == function_groups::MOTION;
    if is_group || functions::<Sym>().iter().any(|other| other.name == function.name) {
        return Some("is a name of the table of functions, or of a group: expected a name of its own".into());
    }
    let mut names: Vec<&str> = function.takes.iter().map(|argument| argument.name()).collect();
    names.extend(function.outputs.iter().map(|output| output.name));
    for (k, name) in names.iter().enumerate() {
        if let Some(reason) = refuses_port(name) {
            return Some(format!("`{name}` {reason}"));
        }
        if names[..k].contains(name) {
            return Some(format!("two arguments or results are called `{name}`: expected names of their own"));
        }
    }
    lacks_result.then(|| "found no result, expected one at least".into())
}

/// The readable functions. Reports invalid words of the options, which do not depend on the robot.
fn words(options: &Options, log: &mut Diagnostics) -> Vec<Entry> {
    options.target.check(options, log);
    for function in options.users.iter() {
        if let Some(reason) = wrong_ports(function, options.users.lacks_result(function)) {
            log.push(wrong_entry(function.name, &reason));
        }
    }
    let read = |(k, text): (usize, &Spanned<String>)| match FunctionSpec::parse_with(text, &options.users) {
        Ok(function) => Some((k, function)),
        Err(error) => {
            log.push(error.at(text));
            None
        }
    };
    let entries: Vec<Entry> = options.functions.iter().enumerate().filter_map(read).collect();
    let others: Vec<&FunctionSpec> = entries.iter().map(|(_, function)| function).collect();
    let refused = |(k, function): &Entry| {
        let reason = options.target.refuses_name(function, &others)?;
        Some((*k, wrong_entry(&options.functions[*k], &format!("`{}` {reason}", function.name))))
    };
    let refused: Vec<(usize, Diagnostic)> = entries.iter().filter_map(refused).collect();
    let is_left = |entry: &Entry| refused.iter().all(|(k, _)| *k != entry.0);
    let entries = entries.into_iter().filter(is_left).collect();
    refused.into_iter().for_each(|(k, error)| log.push(error.at(&options.functions[k])));
    entries
}

/// Reports errors of a request that do not depend on the robot, such as unknown functions, for
/// requests whose robot is unreadable.
pub fn check_words(request: &Request, log: &mut Diagnostics) {
    words(&request.normalized().options, log);
}

/// Reports the functions, parameters and names that a robot does not have.
pub fn check_names(request: &Request, robot: &BuiltRobot, log: &mut Diagnostics) {
    let request = &*request.normalized();
    let entries = words(&request.options, log);
    parameters::parse(&request.options, &mut robot.clone(), log);
    // If a frame is refused, the set of frames is not known.
    let frames_are_known = robot.frames.as_ref().map(Vec::len) == request.options.robot.frames.as_ref().map(Vec::len);
    let model = if frames_are_known { robot.framed(robot.model.clone()) } else { robot.model.clone() };
    for (k, function) in &entries {
        if let Err(error) = function.check(&model) {
            log.push(error.at(&request.options.functions[*k]));
        }
    }
    request.options.target.check_names(&model, request, log);
}

/// The functions that the robot has, each with a unique name.
/// Members of a group that it lacks are left out with a warning, unless there is no other function.
fn fitting(
    request: &Request,
    model: &Model<f64>,
    massless: &[String],
    entries: Vec<Entry>,
    (members, warnings): (&BTreeMap<String, String>, &mut Vec<Diagnostic>),
    log: &mut Diagnostics,
) -> Vec<Entry> {
    let mut fitting: Vec<Entry> = Vec::new();
    let mut undefined = Vec::new();
    for (k, function) in entries {
        let defined = || function.parts.iter().try_for_each(|part| defined(&request.file, model, massless, part.function));
        let at = &request.options.functions[k];
        match function.check(model).and_then(|()| own_name(&function, &fitting)) {
            Ok(()) => match (defined(), members.get(&at.value)) {
                (Ok(()), _) => fitting.push((k, function)),
                (Err(error), Some(group)) => undefined.push((error.at(at), group)),
                (Err(error), None) => log.push(error.at(at)),
            },
            Err(error) => log.push(error.at(at)),
        }
    }
    if fitting.is_empty() {
        undefined.into_iter().for_each(|(error, _)| log.push(error));
    } else {
        warnings.extend(undefined.into_iter().map(|(mut error, group)| {
            error.expected += &format!("; the group `{group}` is generated without it");
            error.into_warning()
        }));
    }
    fitting
}

/// Whether no other function, type of results or form of a function has the name.
fn own_name(function: &FunctionSpec, others: &[Entry]) -> Result<(), Diagnostic> {
    let same_type = |f: &FunctionSpec| f.group().is_some() && f.group() == function.group();
    let is_form = |f: &FunctionSpec, other: &FunctionSpec| {
        ["_into", "_blocks", "_batch_f64", "_batch_f32", "_blocks_f64", "_blocks_f32"]
            .iter()
            .any(|form| f.name.strip_suffix(form) == Some(other.name.as_str()))
    };
    let clash = others.iter().find_map(|(_, f)| {
        let is_same = f.name == function.name || same_type(f) || is_form(function, f);
        // A form of this one has the name of the other.
        if is_same { Some(&function.name) } else { is_form(f, function).then_some(&f.name) }
    });
    clash.map_or(Ok(()), |name| {
        let sentence = format!("two are called `{name}`; give one another name, as in other = {name}");
        Err(Diagnostic::refusal("", (Default::default(), "functions"), Code::SameName, sentence))
    })
}

/// The names of the joints that have no inertia of their own.
pub fn massless(model: &Model<f64>) -> Vec<String> {
    let mut names: Vec<String> = model.massless_joints().into_iter().map(|i| model.bodies()[i].name.clone()).collect();
    // A joint of several degrees of freedom is several bodies, which follow one another.
    names.dedup();
    names
}

/// Whether the robot has what the function needs; `massless`: the result of [`massless`] for it.
///
/// # Errors An error whose `found` names what the robot lacks.
pub fn defined<S: Scalar>(file: &str, model: &Model<f64>, massless: &[String], function: &Function<S>) -> Result<(), Diagnostic> {
    let name = function.name;
    let lacks = |code, found: String, expected: &str| Err(Diagnostic::error(file, (Default::default(), name), code, found, expected));
    if function.needs == Needs::Mass && model.moving_mass() == 0.0 {
        return lacks(Code::NoMass, "no moving link with mass".into(), "a link with mass that moves");
    }
    if function.group == Group::Actuators && model.actuators().is_empty() {
        let expected = "a file with actuators or tendons (MJCF), or functions with torques as an argument";
        return lacks(Code::NoActuators, "no actuator".into(), expected);
    }
    let given = model.constraints().pair_of_given().count();
    if function.group == Group::Constraints && given > 0 {
        let expected = "functions of the group `given_contacts`, which take them, or no `given_contacts`";
        return lacks(Code::Unsupported, format!("{given} contacts that a caller gives"), expected);
    }
    if function.group == Group::GivenContacts && given == 0 {
        let expected = "the key `given_contacts` (`--given-contact`, method `Build::given_contact`) with pairs of geoms, or functions without contacts as argument";
        return lacks(Code::NoConstraints, "no contact that a caller gives".into(), expected);
    }
    if function.group == Group::Constraints && model.constraints().is_empty() {
        let expected = "a file with limits, dry friction or contacts (MJCF), or functions without constraints";
        return lacks(Code::NoConstraints, "no constraint".into(), expected);
    }
    if function.gives.contains(&Dim::Contacts) && model.constraints().contacts() == 0 {
        let expected = "a file with geoms that may touch each other (MJCF), or functions without contacts";
        return lacks(Code::NoConstraints, "no pair of shapes that may touch".into(), expected);
    }
    if function.inverts_mass_matrix() && !massless.is_empty() {
        let found = format!("no inertia of its own for joint {}", massless.join(", joint "));
        let expected = format!(
            "a link behind it with an inertia, an armature, one joint fewer, or functions without {name}: nothing behind the joint resists \
             its motion, or another joint moves the same mass in the same way, so the mass matrix is singular in every configuration"
        );
        return lacks(Code::SingularMassMatrix, found, &expected);
    }
    let bound = |f: &articulated_core::model::Frame<f64>| {
        let n = model.freedoms_of(f.body).len();
        (n < 6).then(|| format!("link {:?} ({n})", f.name))
    };
    let frames: Vec<String> = match function.needs {
        Needs::FreeFrames => model.frames().iter().filter_map(bound).collect(),
        _ => Vec::new(),
    };
    if frames.is_empty() {
        return Ok(());
    }
    let expected = match model.outward().any(|i| model.freedoms_of(i).len() >= 6) {
        true => {
            "six for each frame; choose others with `--frames` (key `frames`, method `Build::frames`), or take operational_space_inertia_inverse"
        }
        false => "six for each frame, which no link of this robot has; take operational_space_inertia_inverse",
    };
    lacks(Code::BoundFrames, format!("fewer than six degrees of freedom for {}", frames.join(", ")), expected)
}

/// What a robot lacks for a function, if that is the only error.
#[must_use]
pub fn undefined(findings: &Diagnostics) -> Option<&str> {
    let lacks = |d: &Diagnostic| {
        matches!(
            d.code,
            Code::SingularMassMatrix | Code::NoMass | Code::NoActuators | Code::NoConstraints | Code::BoundFrames | Code::TooMuchCode
        )
    };
    findings.errors.first().filter(|_| findings.errors.iter().all(lacks)).map(|first| first.found.as_str())
}

#[cfg(test)]
mod tests;
