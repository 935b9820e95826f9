//! Unusual files and names: paths that are not UTF-8, files that are not regular, names with
//! control characters.

use std::ffi::OsStr;
use std::path::Path;

use crate::{Ended, File, articulated, end, run};

fn ended<W: AsRef<OsStr>>(words: &[W]) -> Ended {
    let mut command = articulated(&[]);
    command.args(words);
    end(command, b"")
}

const ARM: &str = "<robot name='arm'><link name='base'/><link name='fore'><inertial><origin xyz='0.3 0 0'/><mass value='1'/>
    <inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial></link>
    <joint name='elbow' type='continuous'><parent link='base'/><child link='fore'/><axis xyz='0 1 0'/></joint></robot>";

#[cfg(target_os = "linux")]
#[test]
fn paths_need_not_be_utf_8() {
    use std::os::unix::ffi::{OsStrExt, OsStringExt};
    let name = |bytes: &[u8]| OsStr::from_bytes(bytes).to_owned();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join(name(b"robots\xff"));
    std::fs::create_dir(&folder).unwrap();
    let write = |file: &[u8], text: &str| {
        let path = folder.join(name(file));
        std::fs::write(&path, text).unwrap();
        path.into_os_string()
    };
    let arm = write(b"arm\xfe.urdf", ARM);
    write(b"arm.urdf", ARM);
    write(b"hand.urdf", &ARM.replace("elbow", "wrist").replace("base", "palm").replace("'fore", "'finger"));
    write(b"way.csv", "t,elbow\n0,0.1\n1,0.2\n");
    let scene = "urdf = \"arm.urdf\"\nappend = [{ urdf = \"hand.urdf\", at = \"fore\" }]
        [control]\nkind = \"table\"\nfile = \"way.csv\"\n[simulation]\nend = 0.05\n";
    let scene = write(b"scene\xfe.toml", scene);
    let states = write(b"states\xff.json", r#"[{"q": [0.1]}]"#);
    let (code, out) = (folder.join(name(b"arm\xff.rs")), folder.join(name(b"out\xff")));
    let mut append = folder.join("hand.urdf").into_os_string().into_vec();
    append.extend(b"@fore:left_");
    let append = name(&append);
    let word = OsStr::new;
    let commands: [&[&OsStr]; 8] = [
        &[word("check"), &arm, word("--append"), &append],
        &[word("check"), &scene],
        &[word("generate"), &arm, word("-o"), code.as_os_str()],
        &[word("eval"), &arm, word("--function"), word("gravity_torque"), word("--states"), &states, word("--generic")],
        &[word("functions"), &arm],
        &[word("effects"), &scene],
        &[word("simulate"), &scene, word("-o"), out.as_os_str()],
        &[word("stress"), &arm, word("--states"), &states],
    ];
    for words in commands {
        let ended = ended(words);
        assert_eq!(ended.status, 0, "{words:?}: {}", ended.err);
    }
    assert!(code.is_file() && out.join("recording.csv").is_file());
    let missing = folder.join(name(b"no\xff.urdf"));
    let told = ended(&[word("check"), missing.as_os_str()]);
    assert!(told.status == 1 && told.err.contains("no\u{fffd}.urdf: found neither a file"), "{}", told.err);
}

/// The pipe has no writer: a program that opens it waits forever.
#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).into_os_string().into_string().unwrap();
    for ending in ["urdf", "toml", "json", "csv"] {
        let made = std::process::Command::new("mkfifo").arg(at(&format!("pipe.{ending}"))).status().unwrap();
        assert!(made.success());
    }
    std::fs::create_dir(at("folder.urdf")).unwrap();
    let scene = |name: &str, text: &str| {
        let path = at(name);
        std::fs::write(&path, format!("{text}\n[simulation]\nend = 0.1\n")).unwrap();
        path
    };
    let of_robot = scene("robot.toml", "urdf = \"pipe.urdf\"");
    let of_other = scene("other.toml", "robot = \"simple_pendulum\"\nappend = [{ urdf = \"pipe.urdf\", at = \"bob\" }]");
    let of_table =
        |file: &str| scene("table.toml", &format!("robot = \"simple_pendulum\"\ncontrol = {{ kind = \"table\", file = {file:?} }}"));
    let pipe = "found a pipe, expected a regular file";
    let device = "found a device, expected a regular file";
    let refused = |words: &[&str], expected: &str| {
        let ended = run(words);
        assert!(ended.status == 1 && ended.lines_with(expected) == 1, "{words:?}: {}{}", ended.out, ended.err);
    };
    refused(&["check", &at("pipe.urdf")], pipe);
    refused(&["check", "/dev/zero"], device);
    refused(&["check", &at("folder.urdf")], "found a folder, expected a regular file");
    refused(&["check", "cart_pole", "--append", &format!("{}@cart", at("pipe.urdf"))], pipe);
    refused(&["simulate", &at("pipe.toml")], pipe);
    refused(&["simulate", &of_robot], pipe);
    refused(&["simulate", &of_other], pipe);
    for command in ["simulate", "check"] {
        refused(&[command, &of_table("pipe.csv")], pipe);
        refused(&[command, &of_table("/dev/zero")], device);
    }
    for states in [at("pipe.json"), at("pipe.csv")] {
        refused(&["eval", "simple_pendulum", "--function", "gravity_torque", "--states", &states], pipe);
    }
    refused(&["stress", "simple_pendulum", "--states", "/dev/zero"], device);
    refused(&["simulate", "chain", "--against", &at("pipe.json")], pipe);
}

/// A name that contains a line break and text after it, turns the direction of the following text,
/// and sets a colour.
const EVIL: &str = "&#10;FAKE: all is well&#x202e;&#x9b;31m";

/// Neither stream, and no file, has the name's characters as they are.
fn is_harmless(what: &str, text: &str) {
    let evil = |c: char| matches!(c, '\u{202e}' | '\u{9b}');
    assert!(!text.contains(evil) && !text.lines().any(|line| line.starts_with("FAKE")), "{what}: {text:?}");
}

#[test]
fn names_end_no_lines_and_move_no_cursor() {
    let urdf = ARM.replace("'arm'", &format!("'arm{EVIL}'")).replace("'elbow'", &format!("'elbow{EVIL}'"));
    let urdf = urdf.replace("'fore'", &format!("'fore{EVIL}'"));
    let massless = urdf.replace("<mass value='1'/>", "").replace("0.1'", "0'");
    let file = File::new("arm.urdf", urdf.as_bytes());
    let beside = |name: &str, text: &str| {
        let path = file.path.with_file_name(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let name = "elbow\\nFAKE: all is well\\u202e\\u009b31m";
    let link = name.replace("elbow", "fore");
    let states = beside("states.json", &format!("[{{\"q\": {{\"{name}\": 0.1}}, \"tau\": [0]}}]"));
    let wrong_states = beside("wrong.json", &format!("[{{\"q\": {{\"{name}x\": 0.1}}}}, {{\"q\": {{\"{name}\": \"{name}\"}}}}]"));
    let wrong_columns = beside("wrong.csv", "q.\"elbow\nFAKE: \u{202e}\u{9b}\n1\n");
    let massless = beside("massless.urdf", &massless);
    let scene =
        |name: &str, text: &str| beside(name, &format!("urdf = \"arm.urdf\"\n{text}\n[simulation]\nend = 0.05\nevents = [\"limits\"]\n"));
    let moves = format!("effects = {{ damping = {{ \"{name}\" = 0.1 }}, limit = {{ \"{name}\" = {{ lower = -0.1, upper = 0.1, stiffness = 10, damping = 0 }} }} }}
        initial = {{ q = {{ \"{name}\" = 0.3 }} }}");
    let moves = scene("moves.toml", &moves);
    let wrong =
        scene("wrong.toml", &format!("effects = {{ damping = {{ \"{name}x\" = 0.1 }} }}\ninitial = {{ q = {{ \"{name}\" = true }} }}"));
    let ball = format!("impact = {{ link = \"{link}\", normal = [1, 0, 0], mass = 1, restitution = 1, time = 0.01 }}");
    let hits = scene("hits.toml", &ball);
    let out = file.path.with_file_name("out");
    let out = out.to_str().unwrap();
    let frame = "fore\nFAKE: \u{202e}\u{9b}";
    let commands: [&[&str]; 20] = [
        &["check", file.name()],
        &["check", &massless],
        &["check", file.name(), "--frames", frame],
        &["check", file.name(), "--lock", &format!("{frame}=1")],
        &["check", &moves],
        &["check", &wrong],
        &["eval", file.name(), "--function", "gravity_torque,placements", "--states", &states, "--generic"],
        &["eval", &massless, "--function", "forward_dynamics", "--states", &states, "--generic"],
        &["eval", file.name(), "--function", "gravity_torque", "--states", &wrong_states, "--generic"],
        &["eval", file.name(), "--function", "gravity_torque", "--states", &wrong_columns, "--generic"],
        &["effects", &moves],
        &["functions", file.name()],
        &["generate", file.name(), "--functions", "inverse_dynamics"],
        &["simulate", &moves, "-o", out],
        &["simulate", &hits],
        &["stress", file.name()],
        &["check", frame],
        &["simulate", frame],
        &["check", file.name(), "--function", frame],
        &["generate", file.name(), "--parameters", &format!("payload({frame})")],
    ];
    for words in commands {
        let ended = run(words);
        is_harmless(&format!("{words:?}"), &ended.out);
        is_harmless(&format!("{words:?}"), &ended.err);
        let ended = run(&[words, &["--format", "json"]].concat());
        is_harmless(&format!("{words:?}"), &ended.out);
        is_harmless(&format!("{words:?}"), &ended.err);
        if words[0] != "generate" || ended.status != 0 {
            ended.json();
        }
    }
    let table = std::fs::read_to_string(Path::new(out).join("recording.csv")).unwrap();
    is_harmless("recording.csv", &table);
    assert!(table.lines().next().unwrap().contains("q.elbow\\nFAKE: all is well\\u{202e}\\u{9b}31m,"), "{table}");
}

/// The moving mass is zero: an empty sum is zero, and not minus zero.
#[test]
fn the_mass_of_nothing_is_zero() {
    let still = File::new("still.urdf", b"<robot name='still'><link name='base'/></robot>");
    let told = run(&["check", still.name(), "--format", "json"]).json();
    for key in ["mass", "moving_mass"] {
        let mass = told["totals"][key].as_f64().unwrap();
        assert!(mass == 0.0 && mass.is_sign_positive(), "{key}: {mass:?}");
    }
    let text = run(&["check", still.name()]).out;
    assert!(text.contains("mass 0 kg, of which 0 kg move"), "{text}");
}
