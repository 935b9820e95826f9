use std::process::Command;

use super::{File, articulated, end, run};

const SMALL: [&str; 4] = ["--states", "5", "--repetitions", "31"];

#[test]
fn a_report_has_everything() {
    let ended =
        run(&[&["compare", "double_pendulum", "--functions", "inverse_dynamics,placements", "--format", "json"], &SMALL[..]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let json = ended.json();
    assert_eq!(json["functions"].as_array().unwrap().len(), 2);
    assert_eq!((&json["units"]["functions[].generated"], &json["units"]["gravity"]), (&"ns per call".into(), &"m/s²".into()));
    assert_eq!(without_numbers(&json), Vec::<String>::new());
    for f in json["functions"].as_array().unwrap() {
        let number = |path: &str| f.pointer(path).and_then(serde_json::Value::as_f64).unwrap_or_else(|| panic!("{path}: {f}"));
        assert!(number("/generated/median") > 0.0 && number("/generic/lower_quartile") > 0.0);
        assert!(number("/generation_seconds") > 0.0 && number("/compilation_seconds") > 0.0 && number("/depth") > 0.0);
        assert!((0.0..64.0).contains(&number("/errors/generated")) && (0.0..64.0).contains(&number("/errors/generic")));
        assert_eq!(f["stages"][0]["stage"], "requested");
        assert!(cfg!(not(target_os = "linux")) || number("/code_bytes") > 16.0);
        // Code for any processor is something else only where the command itself is built for this
        // machine.
        if cfg!(all(target_arch = "x86_64", target_feature = "fma")) {
            assert_eq!(f["variants"][0]["variant"], "any processor");
            assert!(number("/variants/0/time/median") > 0.0 && number("/variants/0/largest_difference") < 1e-12);
        }
    }
}

/// Paths of `units` without a number: every item of a non-empty list must have the named field.
fn without_numbers(json: &serde_json::Value) -> Vec<String> {
    let leads = |path: &String| {
        let step = |found: Vec<serde_json::Value>, word: &str| -> Vec<serde_json::Value> {
            let inner = found.iter().map(|v| v[word.trim_end_matches("[]")].clone());
            if word.ends_with("[]") { inner.flat_map(|v| v.as_array().unwrap().clone()).collect() } else { inner.collect() }
        };
        !path.split('.').fold(vec![json.clone()], step).contains(&serde_json::Value::Null)
    };
    json["units"].as_object().unwrap().keys().filter(|path| !leads(path)).cloned().collect()
}

#[test]
fn the_text_begins_with_two_sentences_and_lines_up() {
    let ended = run(&[&["compare", "gripper_arm", "--functions", "gravity_torque"], &SMALL[..]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let (first, rest) = ended.out.split_once("\n\n").unwrap();
    assert_eq!(format!("{first}\n").matches(".\n").count(), 2, "{first}");
    assert!(first.contains("times as long") && first.contains("roundings of one operation"), "{first}");
    assert!(rest.starts_with("gripper_arm.urdf, fixed base: "), "{rest}");
    for part in
        ["requested", "depth", "bytes", "rustc", "ns", "ratio", "units", "  depth: ", "fma_contract: ", "  forward: ", "  generated: "]
    {
        assert!(ended.out.contains(part), "{part}: {}", ended.out);
    }
}

#[test]
fn every_function_is_compared_and_judged_by_a_reference() {
    let ended = run(&[&["compare", "cart_pole", "--format", "json"], &SMALL[..]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let json = ended.json();
    let functions = json["functions"].as_array().unwrap();
    assert_eq!(functions.len(), articulated_core::algorithm::functions::<f64>().len() - 1);
    for f in functions {
        assert!(f["errors"]["generated"].as_f64().is_some_and(|e| e <= 64.0), "{f}");
    }
    let notes = json["notes"].as_array().unwrap();
    let left_out = "operational_space_inertia is left out: fewer than six degrees of freedom carry each tip";
    assert!(notes.len() == 1 && notes[0] == left_out, "{notes:?}");
    assert_eq!((json["frames"].clone(), json["frames_chosen"].clone()), (serde_json::json!(["pole_rod"]), false.into()));
}

#[test]
fn groups_have_headings_and_frames_can_be_chosen() {
    let words = ["compare", "cart_pole", "--functions", "configurations,twists_body", "--frames", "cart,pole_rod"];
    let ended = run(&[&words[..], &SMALL[..]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    for part in
        ["\n  configurations\n    integrate ", "\n  kinematics\n    twists_body ", "functions of frames: cart, pole_rod (as chosen)"]
    {
        assert!(ended.out.contains(part), "{part}: {}", ended.out);
    }
    let bound = run(&["compare", "cart_pole", "--functions", "operational_space_inertia"]);
    assert!(bound.status == 1 && bound.err.contains("fewer than six"), "{}", bound.err);
    assert_eq!(run(&["compare", "cart_pole", "--functions", "twists_body", "--frames", "wheel"]).status, 1);
}

/// A base without mass, free to move like the joint on it: its mass matrix is singular.
const TWICE: &str = r#"<robot name="twice"><link name="a"/><link name="b"><inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="turn" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>"#;

#[test]
fn what_is_singular_everywhere_is_said_and_not_compared() {
    let file = File::new("twice.urdf", TWICE.as_bytes());
    let words = ["compare", file.name(), "--floating", "--functions", "mass_matrix_inverse,mass_matrix"];
    let ended = run(&[&words[..], &SMALL[..]].concat());
    assert_eq!(ended.status, 1, "{}", ended.out);
    assert!(ended.err.contains("mass_matrix_inverse: no inertia of its own for joint __floating_base__"), "{}", ended.err);
}

#[test]
fn an_error_beyond_the_bound_is_status_4() {
    let ended = run(&[&["compare", "double_pendulum", "--functions", "inverse_dynamics", "--bound", "0"], &SMALL[..]].concat());
    assert_eq!(ended.status, 4);
    assert!(ended.err.contains("error: inverse_dynamics"), "{}", ended.err);
    assert!(ended.out.contains("units"));
}

#[test]
fn a_result_that_is_zero_throughout_is_right() {
    let ended = run(&[&["compare", "simple_pendulum", "--functions", "jacobian_rates_body", "--format", "json"], &SMALL[..]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let errors = &ended.json()["functions"][0]["errors"];
    assert!(["generated", "generic"].iter().all(|side| errors[side].as_f64().is_some_and(|e| e < 1.0)), "{errors}");
}

// No user can write there, not even an administrator.
#[cfg(target_os = "linux")]
#[test]
fn a_chart_that_cannot_be_written_does_not_cost_the_report() {
    let early = run(&["compare", "simple_pendulum", "--chart", "/no/such/folder/x.svg"]);
    assert!(early.status == 1 && early.out.is_empty() && early.err.contains("found no such folder"), "{}", early.err);
    let words = ["compare", "simple_pendulum", "--functions", "gravity_torque", "--chart", "/proc/x.svg"];
    let ended = run(&[&words[..], &SMALL[..]].concat());
    assert!(ended.status == 1 && ended.err.contains("error: /proc/x.svg: "), "{}", ended.err);
    assert!(ended.out.contains("gravity_torque"), "{}", ended.out);
    // As JSON the report is the one document.
    let ended = run(&[&words[..], &SMALL[..], &["--format", "json"]].concat());
    assert!(ended.status == 1 && ended.err.contains("error: /proc/x.svg: "), "{}", ended.err);
    assert_eq!(ended.json()["functions"][0]["function"], "gravity_torque");
}

#[test]
fn a_bound_that_is_no_number_is_status_2() {
    for bound in ["nan", "inf", "-1"] {
        let ended = run(&["compare", "simple_pendulum", &format!("--bound={bound}")]);
        assert!(ended.status == 2 && ended.err.contains("expected a finite number, 0 or more"), "{}", ended.err);
    }
}

#[test]
fn without_a_compiler_it_is_status_3() {
    let mut command = articulated(&["compare", "simple_pendulum"]);
    command.env("RUSTC", "/no/such/compiler");
    assert_eq!(end(command, b"").status, 3);
}

/// A peer that knows one pendulum, of 1 kg at 1 m, by heart; it is wrong by the summand WRONG.
const PEER: &str = r#"
use std::ffi::{c_char, c_int, c_void};
#[unsafe(no_mangle)] pub extern "C" fn peer_name() -> *const c_char { c"by heart".as_ptr() }
#[unsafe(no_mangle)] pub extern "C" fn peer_open(_: *const c_char, floating: c_int, _: f64, _: f64, gz: f64) -> *mut c_void {
    if floating != 0 { std::ptr::null_mut() } else { Box::into_raw(Box::new(-gz)).cast() }
}
#[unsafe(no_mangle)] pub unsafe extern "C" fn peer_close(h: *mut c_void) { drop(unsafe { Box::from_raw(h.cast::<f64>()) }) }
#[unsafe(no_mangle)] pub extern "C" fn peer_nq(_: *mut c_void) -> c_int { 1 }
#[unsafe(no_mangle)] pub extern "C" fn peer_nv(_: *mut c_void) -> c_int { 1 }
#[unsafe(no_mangle)] pub extern "C" fn peer_joint_count(_: *mut c_void) -> c_int { 1 }
#[unsafe(no_mangle)] pub extern "C" fn peer_joint_name(_: *mut c_void, _: c_int) -> *const c_char { c"swing".as_ptr() }
#[unsafe(no_mangle)] pub extern "C" fn peer_joint_iq(_: *mut c_void, _: c_int) -> c_int { 0 }
#[unsafe(no_mangle)] pub extern "C" fn peer_joint_iv(_: *mut c_void, _: c_int) -> c_int { 0 }
#[unsafe(no_mangle)] pub extern "C" fn peer_joint_nq(_: *mut c_void, _: c_int) -> c_int { 1 }
#[unsafe(no_mangle)] pub extern "C" fn peer_joint_nv(_: *mut c_void, _: c_int) -> c_int { 1 }
#[unsafe(no_mangle)] pub unsafe extern "C" fn peer_gravity_torque(h: *mut c_void, q: *const f64, tau: *mut f64) {
    unsafe { *tau = *h.cast::<f64>() * (*q).sin() + WRONG }
}
"#;

/// Also its mass matrix, which stays inside until it is read.
const KEEPING: &str = r#"
#[unsafe(no_mangle)] pub extern "C" fn peer_keeps(_: *mut c_void, _: *const c_char) -> c_int {
    1
}
#[unsafe(no_mangle)] pub extern "C" fn peer_mass_matrix(_: *mut c_void, _: *const f64) {}
#[unsafe(no_mangle)] pub unsafe extern "C" fn peer_read(_: *mut c_void, _: *const c_char, out: *mut f64) -> c_int {
    unsafe { *out = 1.001 };
    1
}
"#;

/// A pendulum's torque by an address that the peer hands out, of four states a call; the last lane
/// is wrong by WRONG.
const IN_LANES: &str = r#"
unsafe extern "C" fn torques(h: *mut c_void, q: *const f64, tau: *mut f64) {
    for k in 0..4 {
        unsafe { *tau.add(k) = *h.cast::<f64>() * (*q.add(k)).sin() + if k == 3 { WRONG } else { 0.0 } }
    }
}
#[unsafe(no_mangle)] pub unsafe extern "C" fn peer_entry(_: *mut c_void, name: *const c_char) -> *const c_void {
    let known = unsafe { std::ffi::CStr::from_ptr(name) } == c"gravity_torque";
    if known { torques as *const c_void } else { std::ptr::null() }
}
"#;

fn peer(wrong: &str) -> File {
    peer_of(&PEER.replace("WRONG", wrong))
}

fn peer_of(source: &str) -> File {
    let source = File::new("peer.rs", source.as_bytes());
    let library = File::new("libpeer.so", b"");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let words = ["--edition", "2024", "--crate-type", "cdylib", "-o", library.name(), source.name()];
    assert!(Command::new(rustc).args(words).status().unwrap().success());
    library
}

#[test]
fn a_peer_is_timed_and_must_agree() {
    let right = peer("0.0");
    let words =
        ["compare", "simple_pendulum", "--format", "json", "--functions", "gravity_torque,inverse_dynamics", "--peer", right.name()];
    let ended = run(&[&words[..], &SMALL[..]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let json = ended.json();
    let peers = |f: usize| json["functions"][f]["peers"].as_array().unwrap();
    assert_eq!((peers(0).len(), peers(1).len()), (1, 0));
    assert_eq!(peers(0)[0]["peer"], "by heart");
    assert!(peers(0)[0]["largest_difference"].as_f64().unwrap() < 1e-12);
    assert!(peers(0)[0]["generated_over_peer"]["median"].as_f64().unwrap() > 0.0);
    let wrong = peer("1e-6");
    let words = ["compare", "simple_pendulum", "--functions", "gravity_torque", "--peer", wrong.name()];
    for format in ["text", "json"] {
        let ended = run(&[&words[..], &SMALL[..], &["--format", format]].concat());
        assert_eq!(ended.status, 4, "{}", ended.err);
        assert!(ended.err.contains("by heart"), "{}", ended.err);
        // One document, and that is the report.
        assert!(format == "text" || ended.json()["functions"][0]["peers"][0]["largest_difference"].as_f64().unwrap() > 1e-9);
    }
}

#[test]
fn calls_that_wait_for_each_other_are_timed_too() {
    let library = peer("0.0");
    let words = ["compare", "simple_pendulum", "--functions", "gravity_torque", "--peer", library.name()];
    let json = run(&[&words[..], &SMALL[..], &["--format", "json"]].concat()).json();
    let f = &json["functions"][0];
    for time in [&f["dependent"], &f["peers"][0]["dependent"]] {
        assert!(time["median"].as_f64().unwrap() > 0.0, "{f}");
    }
    let text = run(&[&words[..], &SMALL[..]].concat()).out;
    assert!(text.contains("waits for the result of the call before it") && text.contains("/independent"), "{text}");
}

#[test]
fn a_peer_may_keep_a_square_matrix_until_it_is_read() {
    let library = peer_of(&(PEER.replace("WRONG", "0.0") + KEEPING));
    let words = ["compare", "simple_pendulum", "--functions", "mass_matrix", "--format", "json", "--peer", library.name()];
    let ended = run(&[&words[..], &SMALL[..]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let peer = &ended.json()["functions"][0]["peers"][0];
    assert!(peer["largest_difference"].as_f64().unwrap() < 1e-15, "{peer}");
    assert!(peer["time"]["median"].as_f64().unwrap() > 0.0 && peer["dependent"].is_null(), "{peer}");
}

/// FNV-1a, by which a manifest knows a document.
fn hash(text: &str) -> String {
    let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    format!("{hash:#x}")
}

#[test]
fn what_a_generator_took_is_told_and_drawn() {
    let library = peer("0.0");
    let cost = serde_json::json!({"operations": 3, "code_bytes": 40, "generation_seconds": 5.0, "compilation_seconds": 7.0});
    let urdf = articulated_models::robot("simple_pendulum").unwrap().urdf;
    let code = serde_json::json!({"robot": "any name", "floating": false, "hash": hash(urdf), "functions": {"gravity_torque": cost}});
    let entry = serde_json::json!({"name": "one", "path": library.name(), "engine": "by <heart>", "compiler": "g++", "flags": "-ffast-math",
        "robots": [code]});
    let other = peer("0.0");
    let whole = serde_json::json!({"name": "whole", "path": other.name(), "engine": "for any", "compilation_seconds": 90.0});
    let manifest = File::new("peers.json", serde_json::json!([entry, whole]).to_string().as_bytes());
    let chart = File::new("chart.svg", b"");
    let words = ["compare", "simple_pendulum", "--functions", "gravity_torque,mass_matrix", "--peers-manifest", manifest.name()];
    let more = ["--chart", chart.name()];
    let json = run(&[&words[..], &more, &SMALL, &["--format", "json"]].concat()).json();
    assert_eq!((&json["peers"][0]["flags"], &json["functions"][0]["peers"][0]["cost"]), (&"-ffast-math".into(), &cost));
    let making = &json["making"][0];
    assert_eq!(making["functions"], serde_json::json!(["gravity_torque"]));
    let ours = making["generation_seconds"].as_f64().unwrap() + making["compilation_seconds"].as_f64().unwrap();
    assert!((making["peers"][0]["peer_over_ours"].as_f64().unwrap() * ours / 12.0 - 1.0).abs() < 1e-9, "{making}");
    let any_robot = serde_json::json!({"peer": "whole", "generation_seconds": null, "compilation_seconds": 90.0, "peer_over_ours": null});
    assert_eq!((&making["peers"][1], json["making"].as_array().unwrap().len()), (&any_robot, 1));
    let drawn = std::fs::read_to_string(&chart.path).unwrap();
    assert_eq!(drawn.matches("by &lt;heart&gt; (g++, fast-math)").count(), 1, "{drawn}");
    assert!(drawn.starts_with("<svg ") && drawn.trim_end().ends_with("</svg>") && drawn.matches("mass_matrix").count() == 1);
    let text = run(&[&words[..], &SMALL].concat()).out;
    assert!(text.contains("gravity_torque, all together") && text.contains("  one "), "{text}");
}

#[test]
fn states_of_many_are_timed_beside_the_others_and_must_agree() {
    let library = peer("0.0");
    // Not a multiple of a block.
    let words = ["compare", "simple_pendulum", "--functions", "gravity_torque", "--batch", "f64,f32", "--states", "13"];
    let words = [&words[..], &["--repetitions", "31", "--peer", library.name()]].concat();
    let ended = run(&[&words[..], &["--format", "json"]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let json = ended.json();
    let batches = json["functions"][0]["batches"].as_array().unwrap();
    let kinds: Vec<[&str; 2]> = batches.iter().map(|b| ["numbers", "layout"].map(|k| b[k].as_str().unwrap())).collect();
    assert_eq!(kinds, [["f64", "blocks"], ["f64", "states"], ["f32", "blocks"], ["f32", "states"]]);
    for (b, unit) in batches.iter().zip([f64::EPSILON, f64::EPSILON, f32::EPSILON.into(), f32::EPSILON.into()]) {
        let number = |path: &str| b.pointer(path).and_then(serde_json::Value::as_f64).unwrap_or_else(|| panic!("{path}: {b}"));
        assert!(number("/time/median") > 0.0 && number("/generated_over_batch/median") > 0.0);
        assert!(number("/largest_difference") < 4.0 * unit, "{b}");
        assert!(
            without_numbers(&json).is_empty() && b["peers"][0]["peer"] == "by heart" && number("/peers/0/peer_over_batch/median") > 0.0
        );
    }
    let text = run(&words).out;
    assert!(text.contains("where many are computed at once") && text.contains("by heart/it"), "{text}");
}

#[test]
fn a_peer_may_compute_several_states_a_call() {
    for (wrong, status) in [("0.0", 0), ("1e-6", 4)] {
        // The function that is known by its name is wrong: it must not be called.
        let library = peer_of(&(PEER.replace("WRONG", "1.0") + &IN_LANES.replace("WRONG", wrong)));
        let entry = serde_json::json!([{"name": "four", "path": library.name(), "engine": "by heart", "lanes": 4}]);
        let manifest = File::new("peers.json", entry.to_string().as_bytes());
        let words = ["compare", "simple_pendulum", "--functions", "gravity_torque,inverse_dynamics", "--peers-manifest", manifest.name()];
        // Not a multiple of a call's states.
        let batch = ["--batch", "f64", "--states", "13", "--repetitions", "31"];
        let ended = run(&[&words[..], &batch[..], &["--format", "json"]].concat());
        assert_eq!(ended.status, status, "{}", ended.err);
        let json = ended.json();
        let [first, second] = [0, 1].map(|f| json["functions"][f].clone());
        let own = &first["peers_in_lanes"][0];
        assert!(first["peers"].as_array().unwrap().is_empty() && second["peers_in_lanes"].as_array().unwrap().is_empty(), "{json}");
        assert_eq!((&own["peer"], &own["lanes"]), (&"four".into(), &4.into()));
        assert!(own["time"]["median"].as_f64().unwrap() > 0.0, "{own}");
        assert_eq!(own["largest_difference"].as_f64().unwrap() < 1e-15, status == 0, "{own}");
        assert!(status == 0 || ended.err.contains("peer four differs"), "{}", ended.err);
        let text = run(&[&words[..], &batch[..]].concat()).out;
        assert!(text.contains("computes several states a call") && text.contains("four"), "{text}");
        // Without batches it has no part.
        let json = run(&[&words[..], &SMALL[..], &["--format", "json"]].concat()).json();
        assert!(json["functions"][0]["peers_in_lanes"].as_array().unwrap().is_empty());
    }
}

#[test]
fn a_peer_with_other_joints_is_left_out_with_a_note() {
    let library = peer("0.0");
    let manifest = serde_json::json!([{"name": "one", "path": library.name()}, {"name": "two", "path": "/no/such/library.so"}]);
    let manifest = File::new("peers.json", manifest.to_string().as_bytes());
    let words = ["compare", "double_pendulum", "--functions", "gravity_torque", "--peers-manifest", manifest.name()];
    let ended = run(&[&words[..], &SMALL[..]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    assert!(ended.out.contains("note: peer one is left out: it has 1 joint with 1 coordinate"), "{}", ended.out);
    assert!(ended.out.contains("note: peer two is left out"), "{}", ended.out);
    let broken = File::new("peers.json", b"{");
    assert_eq!(run(&["compare", "double_pendulum", "--peers-manifest", broken.name()]).status, 1);
}

/// By a signal while it compiles.
#[cfg(unix)]
#[test]
fn an_interrupted_command_leaves_no_files_behind() {
    let temporary = tempfile::tempdir().unwrap();
    let files = || std::fs::read_dir(temporary.path()).unwrap().count();
    let mut command = articulated(&["compare", "humanoid"]);
    command.env("TMPDIR", temporary.path()).stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null());
    let mut child = command.spawn().unwrap();
    while files() == 0 {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it made a folder");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    // Not INT, which a shell that runs this test in the background lets it ignore.
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(143));
    assert_eq!(files(), 0);
}

/// A compiler that takes a minute; a signal that the command was started to ignore, and one that it
/// was not.
#[cfg(unix)]
#[test]
fn an_interrupted_command_ends_its_compilers() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let (compiler, running) = (folder.path().join("slow"), folder.path().join("running"));
    let script =
        format!("#!/bin/sh\nif [ \"$1\" = --version ]; then echo slow; exit; fi\necho $$ >> {}\nexec sleep 60\n", running.display());
    std::fs::write(&compiler, script).unwrap();
    std::fs::set_permissions(&compiler, std::fs::Permissions::from_mode(0o755)).unwrap();
    // As by nohup.
    let mut command = Command::new("sh");
    command.args(["-c", "trap '' HUP; exec \"$0\" compare double_pendulum"]).arg(articulated(&[]).get_program());
    command.env("RUSTC", &compiler).stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null());
    let mut child = command.spawn().unwrap();
    let started = || std::fs::read_to_string(&running).unwrap_or_default();
    while !started().ends_with('\n') {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it compiled");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let tell = |signal: &str| assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
    tell("-HUP");
    std::thread::sleep(std::time::Duration::from_millis(200));
    tell("-TERM");
    assert_eq!(child.wait().unwrap().code(), Some(143));
    let runs = |id: &str| Command::new("kill").args(["-0", id]).output().unwrap().status.success();
    assert!(started().lines().all(|id| !runs(id)), "{}", started());
}

/// A compiler that is this script.
#[cfg(unix)]
fn compiler(folder: &std::path::Path, script: &str) -> std::path::PathBuf {
    use std::os::unix::fs::PermissionsExt;
    let compiler = folder.join("compiler");
    std::fs::write(&compiler, format!("#!/bin/sh\n{script}\n")).unwrap();
    std::fs::set_permissions(&compiler, std::fs::Permissions::from_mode(0o755)).unwrap();
    compiler
}

/// As where memory is short.
#[cfg(unix)]
#[test]
fn a_compiler_that_a_signal_ends_is_reported_as_that() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = articulated(&["compare", "double_pendulum", "--functions", "mass_matrix"]);
    command.env("RUSTC", compiler(folder.path(), "[ \"$1\" = --version ] && echo killed && exit\nkill -9 $$"));
    let ended = super::end(command, b"");
    assert!(ended.status == 3 && ended.err.contains("rustc was ended: signal: 9"), "{} {}", ended.status, ended.err);
}

/// Whether the process whose number a script wrote into `file` runs. A process that has ended and
/// waits for its parent does not run.
#[cfg(unix)]
fn runs(file: &std::path::Path) -> bool {
    let id = std::fs::read_to_string(file).unwrap();
    let state = Command::new("ps").args(["-o", "stat=", "-p", id.trim()]).output().unwrap();
    !matches!(state.stdout.first(), None | Some(b'Z'))
}

/// Whether a process that was killed ends, which takes a moment.
#[cfg(unix)]
fn ends(file: &std::path::Path) -> bool {
    (0..500).any(|_| {
        std::thread::sleep(std::time::Duration::from_millis(10));
        !runs(file)
    })
}

#[cfg(unix)]
#[test]
fn a_compiler_that_hangs_is_ended_with_all_that_it_started() {
    let folder = tempfile::tempdir().unwrap();
    let id = folder.path().join("id");
    let hang = format!("sleep 1000 & echo $! > {}; wait", id.display());
    for script in [hang.clone(), format!("[ \"$1\" = --version ] && echo slow && exit\n{hang}")] {
        let mut command = articulated(&["compare", "double_pendulum", "--functions", "mass_matrix"]);
        command.env("RUSTC", compiler(folder.path(), &script)).env("ARTICULATED_RUSTC_SECONDS", "1");
        let ended = super::end(command, b"");
        assert!(ended.status == 3 && ended.err.contains("found no end within 1 s"), "{} {}", ended.status, ended.err);
        assert!(ends(&id));
    }
}

#[cfg(unix)]
/// Whether this process was started with the signal ignored, as shells start background processes;
/// the command then ignores it too.
fn ignores(signal: u32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).map(str::trim);
    mask.and_then(|mask| u64::from_str_radix(mask, 16).ok()).is_some_and(|mask| mask & 1 << (signal - 1) != 0)
}

#[test]
fn a_compiler_asked_for_its_version_ends_with_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let id = folder.path().join("id");
    let script = format!("sleep 1000 & echo $! > {0}.new; mv {0}.new {0}; wait", id.display());
    for (signal, number) in [("-QUIT", 3), ("-TERM", 15)] {
        if ignores(number) {
            println!("not run: {signal}, which this test was started to ignore");
            continue;
        }
        let _ = std::fs::remove_file(&id);
        let mut command = articulated(&["compare", "double_pendulum", "--functions", "mass_matrix"]);
        let mut child = command.env("RUSTC", compiler(folder.path(), &script)).spawn().unwrap();
        while !id.exists() {
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(128 + number as i32));
        assert!(ends(&id));
    }
}

/// The textbook's form knows no effects: it would call right results wrong.
#[test]
fn a_scene_with_effects_is_held_to_the_library_and_that_is_said() {
    let json = run(&["compare", "underwater_arm", "--functions", "gravity_torque", "--repetitions", "31", "--format", "json"]).json();
    assert!(json["notes"].to_string().contains("knows no effects") && json["reference"] == "library", "{}", json["notes"]);
    assert_eq!((json["robot"].as_str(), json["scene"].as_str()), (Some("ur5_like.urdf"), Some("underwater_arm")));
    let errors = &json["functions"][0]["errors"];
    let found = ["generated", "generic"].map(|who| errors[who].as_f64().unwrap());
    assert!(found.iter().all(|units| (0.0..16.0).contains(units)) && found[0] > 0.0, "{errors}");
}

/// They are inputs of a function that its user writes; here they have the values of the file.
#[test]
fn parameters_of_a_scene_are_constants_where_its_functions_are_called() {
    let scene = File::new("loaded.toml", b"robot = \"cart_pole\"\nparameters = [\"payload(pole_rod)\"]\n");
    let states = File::new("states.json", br#"[{"q": [0.3, 0.2], "v": [0, 1], "a": [1, 1]}]"#);
    let accuracy = ["--levels", "f64", "--states", "2", "--repetitions", "1"];
    for words in [&["eval", "--states", states.name()][..], &[&["compare"], &SMALL[..]].concat(), &[&["accuracy"], &accuracy[..]].concat()]
    {
        let ended = run(&[words, &[scene.name(), "--functions", "inverse_dynamics", "--format", "json"]].concat());
        assert_eq!(ended.status, 0, "{words:?}: {}", ended.err);
        assert!(ended.out.contains("parameters: payload(pole_rod): constants here"), "{words:?}: {}", ended.out);
    }
    let out = run(&["stress", scene.name(), "--format", "json"]).out;
    assert!(out.contains("parameters: payload(pole_rod): constants here"), "{out}");
}

/// The frames that these commands choose are the tips: the name of another link is in order.
#[test]
fn a_link_that_is_no_tip_may_be_renamed() {
    let scene = File::new("renamed.toml", b"robot = \"cart_pole\"\nrename = { cart = \"CAR\" }\n");
    let functions = ["--functions", "placements"];
    let accuracy = ["accuracy", scene.name(), "--levels", "f64", "--states", "2", "--repetitions", "1"];
    let renamed = |name: &'static str| [&["compare", "cart_pole", "--rename", name][..], &SMALL].concat();
    let all = [[&["compare", scene.name()][..], &SMALL].concat(), accuracy.to_vec(), renamed("cart=CAR")];
    for words in all {
        let ended = run(&[&words[..], &functions].concat());
        assert_eq!(ended.status, 0, "{words:?}: {}", ended.err);
    }
    assert_eq!(run(&["functions", scene.name()]).status, 0);
    let chosen = [&renamed("cart=CAR")[..], &["--frames", "pole_rod"]].concat();
    for (words, reason) in
        [(renamed("tracc=CAR"), "no link that is a frame"), (renamed("cart=fn"), "not an identifier"), (chosen, "no link that is a frame")]
    {
        let refused = run(&[&words[..], &functions].concat());
        assert!(refused.status == 1 && refused.err.contains(reason), "{words:?}: {}", refused.err);
    }
}
