//! Errors of wrong scenes: the key, the line, what was found, what was expected; all at once.

mod robot;

use articulated_core::diagnostic::Code;
use articulated_scene::Scene;

/// All messages.
fn wrong(text: &str) -> Vec<String> {
    Scene::read("s.toml", text).map(|_| ()).unwrap_err().errors.iter().map(ToString::to_string).collect()
}

fn one(text: &str) -> String {
    let errors = wrong(text);
    assert_eq!(errors.len(), 1, "{errors:#?}");
    errors[0].clone()
}

#[test]
fn an_unknown_key_is_told_with_the_nearest() {
    let expected = "s.toml:1: gravty: found a key that is not known, expected one of summary, robot, urdf, file, base, gravity, functions, parameters, \
                    frames, wrenches_in, coupling, lock, payload, append, rename, args, packages, allow_unphysical_inertia, first_of_duplicates, leave_out, given_contacts, allow_unknown_version, snap_angles, limbs, batch, level, \
                    forbid_unsafe, max_code_size, effects, simulation, initial, control, impact; did you mean \"gravity\"?";
    assert_eq!(one("gravty = [0, 0, -9.81]"), expected);
    let expected = "s.toml:2: effects.dampign: found a key that is not known, expected one of armature, damping, polynomial_damping, friction, spring, polynomial_spring, limit, motor, \
                    drag, box_drag, ellipsoid_drag, buoyancy, gravity_compensation, tether, added_mass, contact, shaft, *; did you mean \"damping\"?";
    assert_eq!(one("\n[effects.dampign]\nelbow = 1"), expected);
    let expected = "s.toml:3: effects.spring.elbow.stifness: found a key that is not known, expected one of stiffness, rest, from; did you mean \"stiffness\"?";
    assert_eq!(one("[effects.spring]\n\nelbow = { stifness = 1 }"), expected);
    let expected = "s.toml:4: effects.contact.foot.frction: found a key that is not known, expected one of radius, stiffness, damping, friction, \
                    speed, normal, height, damping_time, xyz, rpy, from, plane; did you mean \"friction\"?";
    assert_eq!(one("[effects.contact.foot]\nradius = 0.1\nstiffness = 1\nfrction = 1\n"), expected);
}

#[test]
fn a_value_of_another_type_is_told() {
    assert_eq!(one("gravity = [0, 0]"), "s.toml:1: gravity: found a list of 2 numbers, expected a list of 3 finite numbers");
    assert_eq!(one("gravity = 9.81"), "s.toml:1: gravity: found 9.81, expected a list of 3 finite numbers");
    assert_eq!(one("base = true"), "s.toml:1: base: found true, expected one of \"fixed\", \"floating\"");
    assert_eq!(
        one("base = \"floatign\""),
        "s.toml:1: base: found \"floatign\", expected one of \"fixed\", \"floating\"; did you mean \"floating\"?"
    );
    assert_eq!(
        one("[effects.damping]\nelbow = true"),
        "s.toml:2: effects.damping.elbow: found true, expected a number (damping, N·m·s/rad|N·s/m), a table with damping, \"urdf\" or \"off\""
    );
    assert_eq!(
        one("[effects.drag]\nelbow = \"urdf\""),
        "s.toml:2: effects.drag.elbow: found \"urdf\", which has no numbers for it, expected a number (coefficient, N·s²/m²), a table with coefficient or \"off\""
    );
    assert_eq!(one("effects = 1979-05-27"), "s.toml:1: effects: found the date 1979-05-27, expected a table of effects, or \"file\"");
}

#[test]
fn numbers_that_mean_nothing_are_told() {
    assert_eq!(
        one("[effects.spring]\nelbow = { stiffness = -1.0 }"),
        "s.toml:2: effects.spring.elbow.stiffness: found -1.0, expected a finite number, at least 0"
    );
    assert_eq!(one("[effects]\ndamping = nan"), "s.toml:2: effects.damping: found NaN, expected a finite number, at least 0");
    assert_eq!(one("gravity = [0, 0, -inf]"), "s.toml:1: gravity[2]: found -inf, expected a finite number");
    assert_eq!(one("gravity = [0, 0, -1e999]"), "s.toml:1: gravity[2]: found -inf, expected a finite number");
    assert_eq!(
        one("[effects.limit]\nelbow = { lower = 1, upper = 1, stiffness = 1e4 }"),
        "s.toml:2: effects.limit.elbow.upper: found 1.0, expected a number above the lower bound"
    );
    assert_eq!(
        one("[effects.friction]\nelbow = { friction = 1, speed = 0 }"),
        "s.toml:2: effects.friction.elbow.speed: found 0.0, expected a finite number, at least 1e-15"
    );
    assert_eq!(
        one("[effects.motor.elbow]\ntorque = 1\nspeed = 1\nefficiency = 1.5"),
        "s.toml:4: effects.motor.elbow.efficiency: found 1.5, expected a finite number above 0, at most 1"
    );
    assert_eq!(
        one("[effects.shaft.hosel]\nsegments = 0\nstiffness = 1"),
        "s.toml:2: effects.shaft.hosel.segments: found 0.0, expected a whole number from 1 to 100"
    );
}

#[test]
fn an_added_mass_that_gives_energy_is_told_of_the_numbers_that_are_written() {
    let told = |numbers: &str| wrong(&format!("[effects.added_mass.bob]\n{numbers}"));
    let line = |line: u32, key: &str, found: &str, others: &str| {
        let matrix = format!("expected with {others} a 6×6 matrix that is positive semidefinite");
        format!("s.toml:{line}: effects.added_mass.bob.{key}: found {found}, {matrix}")
    };
    let (good, bad, shown) = ("[1, 0, 0, 1, 0, 1]", "[-1, 0, 0, 1, 0, 1]", "-1.0, 0.0, 0.0, 1.0, 0.0, 1.0");
    let angular = line(2, "angular", shown, "coupling and linear");
    let linear = line(3, "linear", shown, "angular and coupling");
    assert_eq!(told(&format!("angular = {bad}\nlinear = {good}")), [&*angular]);
    assert_eq!(told(&format!("angular = {good}\nlinear = {bad}")), [&*linear]);
    assert_eq!(told(&format!("angular = {bad}\nlinear = {bad}")), [angular, linear]);
    let coupling = line(4, "coupling", "2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0", "angular and linear");
    assert_eq!(told(&format!("angular = {good}\nlinear = {good}\ncoupling = [2, 0, 0, 0, 0, 0, 0, 0, 0]")), [coupling]);
}

#[test]
fn a_law_of_a_follower_that_cannot_be_is_told() {
    let told = |law: &str| one(&format!("coupling = {{ wing = {{ {law} }} }}"));
    let line = |found: &str, expected: &str| format!("s.toml:1: coupling.wing: found {found}, expected {expected}");
    assert_eq!(told("joint = ['a']"), line("neither coefficients nor polynomial", "one of them"));
    assert_eq!(told("joint = ['a'], coefficients = [1], polynomial = [0, 1]"), line("coefficients and polynomial", "one of them"));
    assert_eq!(
        told("joint = ['a', 'b'], polynomial = [0, 1, 2]"),
        line("a polynomial and 2 joints", "one joint that is followed by a polynomial")
    );
    assert_eq!(
        told("joint = ['a'], polynomial = [0, 1, 2], offset = 1"),
        line("offset beside polynomial", "the number of power zero in polynomial, and no offset")
    );
    assert_eq!(
        told("joint = ['a'], coefficients = [1], reference = 1"),
        line("reference without polynomial", "the key polynomial, or no reference")
    );
    let long = told("joint = ['a'], polynomial = [0, 1, 2, 3, 4, 5]");
    assert!(long.contains("found 6 coefficients of a polynomial, expected one to five"), "{long}");
}

#[test]
fn a_simulation_that_cannot_be_is_told() {
    assert_eq!(one("[simulation]\nstart = 2\nend = 1"), "s.toml:3: simulation.end: found 1, expected a time after start = 2, s");
    assert_eq!(one("[simulation]\nend = 1\nstep = 0"), "s.toml:3: simulation.step: found 0, expected a finite number above 0, s");
    assert_eq!(
        one("[simulation]\nend = 1\nintegrator = \"rk5\"\nstep = 0.1"),
        "s.toml:3: simulation.integrator: found \"rk5\", expected one of \"semi_implicit_euler\", \"rk4\", \"dopri5\", \"dop853\", \"rodas4\", \
         \"lie_midpoint\"; did you mean \"rk4\"?"
    );
    assert_eq!(
        one("[simulation]\nend = 1\nintegrator = \"rk4\""),
        "s.toml:3: simulation.step: found nothing, expected the length of its steps, s: rk4 has no error estimate"
    );
    assert_eq!(
        one("[simulation]\nrtol = 1e-3"),
        "s.toml:1: simulation: found no end, expected end: number, s, time at the end, after the start"
    );
    assert_eq!(
        one("[control]\nkind = \"torque\"\nkp = 1"),
        "s.toml:3: control.kp: found a key that control of kind \"torque\" does not have, expected one of torque"
    );
    assert_eq!(
        one("[control]\nkind = \"table\"\ncolumns = [\"a\"]\nrows = [[0, 1], [0, 2]]"),
        "s.toml:4: control.rows[1]: found the time 0.0 after 0.0, expected times in order"
    );
    assert_eq!(
        one("[initial]\nbase = { quaternion = [1, 1, 0, 0] }"),
        "s.toml:2: initial.base.quaternion: found a quaternion of norm 1.4142, expected norm one, in the order x, y, z, w"
    );
    assert_eq!(
        one("[impact]\nlink = \"head\"\nnormal = [0, 0, 0]\nmass = 1\nrestitution = 0.8\ntime = 1"),
        "s.toml:3: impact.normal: found no direction, expected three numbers that are not all 0"
    );
}

#[test]
fn what_would_be_passed_over_is_told() {
    assert_eq!(
        wrong("[simulation]\nend = 1\nstep = 0.1\nmax_step = 0.2\nmin_step = 1e-6\nfirst_step = 0.01\nrtol = 1e-3\natol = 1e-3"),
        [("4", "max_step"), ("5", "min_step"), ("6", "first_step"), ("7", "rtol"), ("8", "atol")].map(|(line, key)| format!(
            "s.toml:{line}: simulation.{key}: found a fixed step and what is for steps by tolerance, expected no step, or no such key"
        ))
    );
    assert!(Scene::read("s.toml", "[simulation]\nend = 1\nmax_step = 0.2\nmin_step = 1e-6\nfirst_step = 0.01").is_ok());
    let cases = [
        ("q = [0, 0, 1, 0, 0, 0, 1, 0.5]", "rpy = [0, 0, 2]", "initial.q: found numbers of the base, and initial.base.rpy"),
        ("v = [0, 0, 0, 0, 0, 0, 1]", "linear = [0, 0, 2]", "initial.v: found numbers of the base, and initial.base.linear"),
        (
            "v = { __floating_base__ = [0, 0, 0, 0, 0, 1] }",
            "linear = [0, 0, 2]",
            "initial.v: found numbers of the base, and initial.base.linear",
        ),
    ];
    for (numbers, base, said) in cases {
        assert_eq!(one(&format!("[initial]\n{numbers}\n[initial.base]\n{base}")), format!("s.toml:2: {said}, expected one of them"));
    }
    assert!(Scene::read("s.toml", "[initial]\nq = [0, 0, 1, 0, 0, 0, 1]\nbase = { linear = [0, 0, 2] }").is_ok());
    assert!(Scene::read("s.toml", "[initial]\nq = { elbow = 1 }\nbase = { xyz = [0, 0, 2] }").is_ok());
    assert_eq!(
        one("[control]\nkind = \"table\"\ncolumns = [\"a\", \"b\", \"a\"]\nrows = [[0, 1, 2, 3]]"),
        "s.toml:3: control.columns[2]: found the column \"a\" twice, expected each once"
    );
}

#[test]
fn one_mistake_of_a_table_does_not_hide_another() {
    let told = |text: &str| wrong(text).len();
    assert_eq!(told("[simulation]\nend = -1\nsteps = 3"), 2);
    assert_eq!(told("[simulation]\nend = -1\nstep = -1"), 2);
    assert_eq!(told("[simulation]\nend = 'x'\nrtol = 0\natol = 0\nmin_step = 2\nmax_step = 1\nevents = 3"), 4);
    assert_eq!(told("[simulation]\nend = 1\nrtol = 2\nmax_step = 1e-300\noutput = [0.5, 0.2]"), 3);
    assert_eq!(
        told("[control]\nkind = 'table'\ninterpolation = 'square'\nperiod = 0\nkp = 1\ncolumns = ['a', 'a']\nrows = [[0, 1, 2], [0, 1]]"),
        6
    );
    assert_eq!(told("[control]\nkind = 'pd'\nkp = 'x'\nfile = 'a.csv'\nrows = [[0]]\ntarget = [1]"), 3);
    assert_eq!(told("[control]\nkp = 1\ntorque = 'x'"), 2);
    assert_eq!(wrong("impact = 1"), ["s.toml:1: impact: found 1.0, expected a table"]);
    let ball = "[impact]\nlink = \"tip\"\nnormal = [1, 0, 0]\nrestitution = 1\n";
    assert_eq!([told(&format!("{ball}mass = -0.5")), told(&format!("{ball}mass = 1\nbal = [0, 0, 0]"))], [2, 1]);
}

#[test]
fn settings_that_the_library_would_refuse_are_told_with_their_lines() {
    let part = |x: &str, found: &str| {
        let told = one(&format!("[simulation]\nend = 1\nrtol = {x}"));
        assert_eq!(told, format!("s.toml:3: simulation.rtol: found {found}, expected 0, or at least 1e-15 and below 1"));
    };
    [("5", "5"), ("-1", "-1"), ("1", "1"), ("1e-16", "1e-16"), ("nan", "NaN")].iter().for_each(|(x, found)| part(x, found));
    assert!(Scene::read("s.toml", "[simulation]\nend = 1\nrtol = 0").is_ok());
    assert!(Scene::read("s.toml", "[simulation]\nend = 1\nrtol = 1e-15").is_ok());
    assert_eq!(
        one("[simulation]\nend = 1\natol = 0\nrtol = 0"),
        "s.toml:4: simulation.rtol: found 0, expected one of rtol and atol greater than 0"
    );
    assert_eq!(
        one("[simulation]\nend = 1e6\nintegrator = \"rk4\"\nstep = 1e-10\noutput = \"ends\""),
        "s.toml:4: simulation.step: found 1e-10, expected at least 3.6e-9 s, sixteen units of rounding of the time"
    );
    assert_eq!(
        one("[simulation]\nend = 1\noutput = 1e-10"),
        "s.toml:3: simulation.output: found 1e-10, expected at least 1.2e-8 s, for no more than 1e9 numbers in all, 12 per record"
    );
    assert_eq!(
        one("[simulation]\nend = 1e8"),
        "s.toml:2: simulation.output: found 0.01, expected at least 1.2 s, for no more than 1e9 numbers in all, 12 per record"
    );
    assert_eq!(
        one("[simulation]\nend = 1\nevents = [\"limits\", \"stick_slip\", \"limits\"]"),
        "s.toml:3: simulation.events[2]: found \"limits\" once more, expected each of them once"
    );
    let sampled =
        |period: &str| one(&format!("[control]\nkind = \"pd\"\nkp = 1\nperiod = {period}\n[simulation]\nend = 1\nmax_steps = 1000"));
    assert_eq!(
        sampled("1e-20"),
        "s.toml:4: control.period: found 1e-20, expected at least 3.6e-15 s, sixteen units of rounding of the time"
    );
    assert_eq!(
        sampled("1e-4"),
        "s.toml:4: control.period: found 0.0001, expected at least 0.001 s, for no more samples than max_steps = 1000"
    );
    assert!(Scene::read("s.toml", "[simulation]\nend = 1\nmin_step = 1e-3\nmax_step = 1e-3\nevent_tolerance = 0").is_ok());
    for (value, found) in [("0.6", "0.6"), ("0", "0.0"), ("-1e-9", "-1e-9"), ("nan", "NaN"), ("true", "true")] {
        let expected = "expected a finite number above 0, at most 0.5 rad; leave it out to snap none";
        assert_eq!(one(&format!("snap_angles = {value}")), format!("s.toml:1: snap_angles: found {found}, {expected}"));
    }
    assert!(Scene::read("s.toml", "snap_angles = 0.5").is_ok());
}

#[test]
fn integrators_of_others_are_told_as_those_for_the_same_problems() {
    let nearest = |name: &str| {
        let errors = Scene::read("s.toml", &format!("[simulation]\nend = 1\nintegrator = {name:?}")).unwrap_err().errors;
        assert_eq!((errors.len(), errors[0].code), (1, Code::Word), "{name}");
        errors[0].hint.as_ref().map(|hint| hint.split('"').nth(1).unwrap_or_default().to_owned())
    };
    let meant = [
        ("dopri5", &["rk45", "RK45", "ode45", "Dormand-Prince", "Tsit5", "dopri"][..]),
        ("dop853", &["DOP853", "ode113", "Vern9"]),
        ("rodas4", &["Radau", "BDF", "ode15s", "ode23s", "LSODA", "rodas5P"]),
        ("semi_implicit_euler", &["euler", "symplectic_euler"]),
        ("lie_midpoint", &["implicit_midpoint"]),
        ("rk4", &["rk5"]),
    ];
    for (ours, theirs) in meant {
        theirs.iter().for_each(|name| assert_eq!(nearest(name).as_deref(), Some(ours), "{name}"));
    }
    assert_eq!(nearest("something"), None);
}

#[test]
fn rows_of_a_table_have_their_own_lines() {
    let table =
        "[control]\nkind = \"table\"\n\ncolumns = [\n\"elbow\",\n\"elbow\",\n\"elbo\"]\nrows = [\n[0, 1, 2, 3],\n[2, 1],\n[1, 1, 2, 3]]";
    assert_eq!(
        wrong(table),
        [
            "s.toml:6: control.columns[1]: found the column \"elbow\" twice, expected each once",
            "s.toml:10: control.rows[1]: found 2 numbers, expected 4 numbers: the time and one for each of the columns",
            "s.toml:11: control.rows[2]: found the time 1.0 after 2.0, expected times in order",
        ]
    );
    assert_eq!(
        one("[control]\nkind = \"table\"\nrows = [[0, 1],\n[1, 2]]"),
        "s.toml:3: control: found rows without columns, expected columns: the names of the numbers after the time"
    );
}

#[test]
fn no_gain_is_negative() {
    let told = wrong("[control]\nkind = \"pd\"\nkp = [1, -2]\nkd = { \"*\" = -1, b = -3 }\ntorque = { a = -1 }");
    let line = |key: &str, x: &str| format!("{key}: found {x}, expected a finite number, at least 0");
    assert_eq!(
        told,
        [("s.toml:3: control.kp[1]", "-2.0"), ("s.toml:4: control.kd.\"*\"", "-1.0"), ("s.toml:4: control.kd.b", "-3.0")]
            .map(|(key, x)| line(key, x))
    );
}

#[test]
fn items_of_lists_have_their_own_lines() {
    let headers = "[[payload]]\nlink = 'a'\nmass = 1\n\n[[payload]]\nlink = 'a'\n[[effects.contact.a]]\nradius = 1\n\n[[effects.contact.a]]\nradius = -1";
    let line = |error: &String| error.split(": found").next().unwrap_or_default().to_owned();
    let told: Vec<String> = wrong(headers).iter().map(line).collect();
    assert_eq!(told, ["s.toml:5: payload[1]", "s.toml:11: effects.contact.a[1].radius"]);
    let listed = "payload = [\n  { link = 'a', mass = 1 },\n  { link = 'a' },\n]";
    assert_eq!(wrong(listed).iter().map(line).collect::<Vec<_>>(), ["s.toml:3: payload[1]"]);
}

#[test]
fn what_is_not_toml_is_told() {
    assert_eq!(one("robot = \"a\"\nurdf = \"b\""), "s.toml:1: robot: found robot and urdf, expected one of them");
    assert!(one("a = ").starts_with("s.toml:1: found what is not TOML ("));
    assert!(wrong("a = 1\na = 2")[0].starts_with("s.toml:2: found what is not TOML ("));
    let bytes = Scene::read_bytes("s.toml", b"a = 1\nb = \"\xff\"").unwrap_err().to_string();
    assert_eq!(bytes, "s.toml:2: found bytes that are not UTF-8, expected a TOML file");
}

#[test]
fn all_mistakes_of_a_scene_are_told_at_once_in_the_order_of_the_file() {
    let errors = wrong("bse = 1\ngravity = 1\n[effects.damping]\na = -1\nb = nan\n[simulation]\nend = 0\nstep = -1\n[nothing]\n");
    let lines: Vec<&str> = errors.iter().map(|e| e.split_whitespace().next().unwrap()).collect();
    assert_eq!(lines, ["s.toml:1:", "s.toml:2:", "s.toml:4:", "s.toml:5:", "s.toml:7:", "s.toml:8:", "s.toml:9:"]);
    let many = wrong(&(0..3000).map(|i| format!("key_{i} = 1\n")).collect::<String>());
    assert_eq!(many.len(), 1001);
    assert_eq!(many[1000], "s.toml: found 2000 more that are not listed");
}

#[test]
fn sorts_of_mistakes_are_data() {
    let kind = |text| Scene::read("s.toml", text).unwrap_err().errors[0].code;
    assert_eq!(
        [kind("a=1"), kind("base=1"), kind("base='x'"), kind("gravity=[nan,0,0]"), kind("=")],
        [Code::UnknownKey, Code::Type, Code::Word, Code::Number, Code::Syntax]
    );
}

/// The maximum itself is allowed.
#[test]
fn the_most_that_is_expected_is_taken() {
    let taken = |text: &str| Scene::read("s.toml", text).map(drop).map_err(|e| e.to_string());
    let sampled = "[control]\nkind = \"pd\"\nkp = 1\nperiod = 0.1\n[simulation]\nend = 1\nmax_steps = 10";
    let steps = |most: u64| format!("[simulation]\nend = 1\nmax_steps = {most}");
    let segments = |most: u64| format!("[effects.shaft.hosel]\nsegments = {most}\nstiffness = 1");
    for text in [sampled, &steps(1), &steps(1 << 40), &segments(1), &segments(100)] {
        assert_eq!(taken(text), Ok(()), "{text}");
    }
    assert_eq!(one(&segments(101)), "s.toml:2: effects.shaft.hosel.segments: found 101.0, expected a whole number from 1 to 100");
    assert_eq!(
        one(&steps(1 + (1 << 40))),
        "s.toml:3: simulation.max_steps: found 1099511627777.0, expected a whole number from 1 to 1099511627776"
    );
}
