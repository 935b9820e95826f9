//! From a scene to a request.

use std::path::{Path, PathBuf};

use articulated_core::description::Base;
use articulated_core::diagnostic::{At, Code, Diagnostics};
use articulated_scene::{BuiltRobot, Opened, RobotInWorld, folder_of, open_in_into, open_into, open_table};

pub use articulated_scene::{self, Bundled, Loader, Scene, beside};

use crate::{Options, Request, Target, check_names, check_words};

/// A scene and its request.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The scene.
    pub scene: Scene,
    /// The robot, its edits and its effects.
    pub request: Request,
    /// The robot as the request has it.
    pub robot: BuiltRobot,
    /// The files that were read: the scene, the robot, and those appended.
    pub files: Vec<PathBuf>,
}

/// The scene at `path` with its robot. `bundled` are the robots that it may name; names of files
/// are relative to its folder.
///
/// # Errors
/// All findings about the files, the robot, and entries of the scene that do not fit it, as far as
/// they can be read.
pub fn open(path: &Path, bundled: &[Bundled<'_>]) -> Result<Prepared, Diagnostics> {
    let mut log = Diagnostics::new(&path.display().to_string());
    let opened = open_into(path, bundled, &mut log);
    whole(opened, folder_of(path), log)
}

/// A scene that was read, with its robot. `bundled` are the robots that it may name; names of files
/// are relative to `folder`.
///
/// # Errors
/// As [`open`].
pub fn open_in(scene: Scene, folder: &Path, bundled: &[Bundled<'_>]) -> Result<Prepared, Diagnostics> {
    let mut log = Diagnostics::new(&scene.file);
    let opened = open_in_into(scene, folder, bundled, &mut log);
    whole(opened, folder, log)
}

/// The request of an opened scene, or its errors and those of the rest of the scene.
fn whole(opened: Result<Opened, Option<Box<Scene>>>, folder: &Path, mut log: Diagnostics) -> Result<Prepared, Diagnostics> {
    match opened {
        Ok(opened) => prepared(opened, Some(folder), log),
        Err(scene) => {
            if let Some(scene) = scene {
                let mut request = Request::new("", []);
                fill(&mut request.options, &scene);
                check_words(&request, &mut log);
                scene.check_table(None, &mut |name| open_table(folder, name), &mut log);
            }
            Err(log.result(()).err().unwrap_or_default())
        }
    }
}

/// The request of a scene for the robot in `document`; `append` are the documents that it appends.
/// No file is opened. `base` applies if the scene has none.
///
/// # Errors
/// All errors of the document; if there are none, all entries of the scene that do not fit the
/// robot, except tables of control in files.
pub fn prepare(scene: Scene, file: &str, document: Vec<u8>, base: Base, append: Vec<Vec<u8>>) -> Result<Prepared, Diagnostics> {
    let log = Diagnostics::new(&scene.file);
    prepared(Opened::new(scene, file, document, base, append), None, log)
}

/// `folder`: that of the scene's files. A table of control in one of them is checked only if the
/// scene has other mistakes.
fn prepared(opened: Opened, folder: Option<&Path>, mut log: Diagnostics) -> Result<Prepared, Diagnostics> {
    let robot = opened.robot().build_into(&mut log);
    let Opened { scene, file, document, options, files } = opened;
    let mut request = Request { scene: Some(scene.clone()), ..Request::new(file, document) };
    fill(&mut request.options, &scene);
    request.options.robot = options;
    match &robot {
        Some(robot) => check_names_of(&scene, &request, robot, &mut log),
        None => check_words(&request, &mut log),
    }
    if let Some(folder) = folder.filter(|_| !log.is_ok()) {
        let in_world = robot.as_ref().map(|robot| RobotInWorld { model: &robot.model, world: &robot.reading.world });
        scene.check_table(in_world, &mut |name| open_table(folder, name), &mut log);
    }
    match robot {
        Some(robot) => log.result(Prepared { scene, request, robot, files }),
        None => Err(log.result(()).err().unwrap_or_default()),
    }
}

/// Reports the names of a scene's request that its robot does not have.
fn check_names_of(scene: &Scene, request: &Request, robot: &BuiltRobot, log: &mut Diagnostics) {
    let mut names = log.apart();
    check_names(request, robot, &mut names);
    // Default names that clash concern only the targets that use them.
    names.errors.retain(|error| error.code != Code::NameClash || error.span.at != At::Nowhere);
    scene.keep_certain(&mut names);
    log.take(names);
}

/// Reports errors of a request, except those of its scene's text, which were left out.
/// `is_complete`: its documents are present.
pub fn check_rest(request: &Request, is_complete: bool, log: &mut Diagnostics) {
    // Names that the robot does not have are findings of the scene's file.
    let mut own = Diagnostics::new(request.scene.as_ref().map_or(&request.file, |scene| &scene.file));
    let robot = if is_complete { request.robot().build_into(&mut own) } else { None };
    match (&request.scene, &robot) {
        (Some(scene), Some(robot)) => check_names_of(scene, request, robot, &mut own),
        (None, Some(robot)) => check_names(request, robot, &mut own),
        (_, None) => check_words(request, &mut own),
    }
    log.take(own);
}

/// Copies the scene's entries into the options: all except the effects, which need the robot, and
/// the documents of the robots to append.
pub fn fill(options: &mut Options, scene: &Scene) {
    let (code, places) = (scene.code.clone(), &scene.code.places);
    let put = |said: Option<bool>, into: &mut bool| *into = said.unwrap_or(*into);
    scene.fill_robot(&mut options.robot);
    if let Some(functions) = code.functions {
        options.functions = scene.spanned(functions, &places.functions);
    }
    options.motion = scene.calls().names().map(str::to_owned).collect();
    options.parameters = scene.spanned(code.parameters.unwrap_or_default(), &places.parameters);
    options.rename = scene.spanned(code.rename, &places.rename);
    put(code.limbs, &mut options.limbs);
    options.batch = code.batch.unwrap_or_default();
    options.level = code.level.unwrap_or(options.level);
    // It concerns Rust alone.
    if let Target::Rust(rust) = &mut options.target {
        put(code.forbid_unsafe, &mut rust.forbid_unsafe);
    }
    options.max_code_size = code.max_code_size.unwrap_or(options.max_code_size);
}

#[cfg(test)]
mod tests {
    use articulated_core::description::Shaft;
    use articulated_core::diagnostic::Spanned;
    use articulated_core::effect::EffectId;
    use articulated_scene::Why;

    use super::*;

    const ARM: &str = r#"<robot name="arm"><link name="base"/>
        <link name="upper"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <link name="fore"><inertial><origin xyz="0 0 -0.3"/><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
          <collision><geometry><sphere radius="1"/></geometry></collision></link>
        <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
          <limit lower="-1" upper="2" effort="5" velocity="3"/><dynamics damping="0.3" friction="0.1"/></joint>
        <joint name="elbow" type="continuous"><parent link="upper"/><child link="fore"/><origin xyz="0 0 -0.5"/><axis xyz="1 0 0"/>
          <limit effort="5" velocity="3"/></joint>
        <transmission name="t"><type>simple</type></transmission></robot>"#;

    fn prepared(scene: &str) -> Prepared {
        let scene = Scene::read("s.toml", scene).unwrap();
        let mut prepared = prepare(scene, "arm.urdf", ARM.into(), Base::Fixed, Vec::new()).unwrap_or_else(|e| panic!("{e}"));
        prepared.request.options.functions = ["inverse_dynamics", "forward_dynamics", "dissipation"].map(Into::into).into();
        prepared
    }

    fn source(scene: &str) -> String {
        crate::generate(&prepared(scene).request).unwrap().source
    }

    #[test]
    fn an_effect_that_is_off_costs_nothing() {
        let plain = source("");
        for effect in articulated_core::effect::effects() {
            assert_eq!(source(&format!("[effects]\n{} = 'off'", effect.name)), plain, "{}", effect.name);
        }
        let zeros = [
            "armature = 0",
            "damping = 0",
            "friction = { '*' = 0 }",
            "spring = { elbow = { stiffness = 0, rest = 1 } }",
            "limit = { from = 'urdf', stiffness = 0 }",
            "drag = { fore = 0 }",
            "box_drag = { fore = { linear = [0, 0, 0], angular = [0, 0, 0] } }",
            "buoyancy = { fore = { volume = 0 } }",
            "added_mass = { fore = { linear = [0, 0, 0, 0, 0, 0], angular = [0, 0, 0, 0, 0, 0] } }",
            "contact = { fore = { radius = 1, stiffness = 0, damping = 0, friction = 1 } }",
            "damping = { '*' = 0.3, elbow = 'off', shoulder = 0 }",
        ];
        for zero in zeros {
            assert_eq!(source(&format!("[effects]\n{zero}")), plain, "{zero}");
        }
        assert_ne!(source("[effects]\ndamping = 0.1"), plain);
    }

    #[test]
    fn the_order_of_a_scene_does_not_matter() {
        let one = "[effects]\ndamping = { shoulder = 0.2, elbow = 0.1 }\ndrag = { fore = 2, upper = 1 }\narmature = 0.1";
        let other =
            "[effects]\narmature = 0.1\n[effects.drag]\nupper = 1\nfore = 2\n[effects.damping]\n'*' = 0.1\nshoulder = { damping = 0.2 }";
        assert_eq!(source(one), source(other));
    }

    /// Contact of geometry is that of the points that the geometry has.
    #[test]
    fn contact_of_collision_geometry_is_that_of_its_points() {
        let law = "stiffness = 100, damping = 1, friction = 0.5";
        let shape = format!("[effects]\ncontact = {{ '*' = {{ from = 'collision', {law} }} }}");
        assert_eq!(source(&shape), source(&format!("[effects]\ncontact = {{ fore = {{ radius = 1, {law} }} }}")));
        let unused = |scene: &str| {
            let prepared = prepared(scene);
            [prepared.robot.resolved.report.ignored, prepared.robot.reading.unused]
                .map(|list| list.iter().filter(|u| u.tag == "collision").count())
        };
        assert_eq!((unused(""), unused(&shape)), ([1, 1], [0, 0]));
        // All generated code gets the warnings about links that make no contact beside others.
        let mesh = ARM.replace("<sphere radius=\"1\"/>", "<mesh filename=\"fore.stl\"/>");
        let beside = shape.replace("{ '*'", &format!("{{ upper = {{ radius = 1, {law} }}, '*'"));
        let scene = Scene::read("s.toml", &beside).unwrap();
        let prepared = prepare(scene.clone(), "arm.urdf", mesh.clone().into(), Base::Fixed, Vec::new()).unwrap();
        let mut request = Request::new("arm.urdf", mesh);
        fill(&mut request.options, &scene);
        request.scene = Some(scene);
        for request in [prepared.request, request] {
            let warnings = crate::generate(&request).unwrap().warnings;
            let told = warnings
                .iter()
                .filter(|w| w.to_string().contains("link \"fore\": effects.contact.\"*\": found a mesh that makes no contact"));
            assert_eq!(told.count(), 1, "{warnings:?}");
        }
    }

    #[test]
    fn what_the_urdf_says_of_effects_is_used_or_reported() {
        let ignored = |scene: &str| -> Vec<String> {
            prepared(scene)
                .robot
                .resolved
                .report
                .ignored
                .iter()
                .map(|u| u.to_string().split_once(": ").map_or(String::new(), |(_, rest)| rest.into()))
                .collect()
        };
        let has = |list: &[String], tag: &str, joint: &str| list.iter().any(|line| line.contains(tag) && (line.contains(joint)));
        let plain = ignored("");
        let tags = ["dynamics damping", "dynamics friction", "limit lower", "limit upper", "limit effort", "limit velocity"];
        assert!(tags.iter().all(|tag| prepared("").robot.resolved.report.ignored.iter().any(|u| u.tag == *tag)), "{plain:#?}");
        assert!(has(&plain, "transmission", "") && has(&plain, "collision", ""), "{plain:#?}");
        let used = |scene: &str| -> Vec<&str> {
            let report = prepared(scene).robot.resolved.report;
            tags.into_iter().filter(|tag| !report.ignored.iter().any(|u| u.tag == *tag)).collect()
        };
        assert_eq!(used("[effects]\ndamping = 'urdf'"), ["dynamics damping"]);
        assert_eq!(used("[effects]\nfriction = { shoulder = { from = 'urdf', speed = 0.1 } }"), ["dynamics friction"]);
        assert_eq!(used("[effects]\nlimit = { from = 'urdf', stiffness = 100 }"), ["limit lower", "limit upper"]);
        assert_eq!(used("[effects]\nmotor = 'urdf'"), ["limit effort", "limit velocity"]);
        // Numbers of its own: those of the file are not used.
        assert_eq!(used("[effects]\ndamping = 0.5"), [""; 0]);
    }

    #[test]
    fn numbers_are_those_of_the_joint_then_of_all_then_of_the_urdf_then_defaults() {
        let numbers = |scene: &str| -> Vec<(String, Vec<f64>)> {
            prepared(scene).robot.resolved.effects.iter().map(|a| (a.on.clone(), a.parameters.clone())).collect()
        };
        let is = |on: &str, x: &[f64]| (on.to_owned(), x.to_vec());
        assert_eq!(numbers("[effects]\ndamping = 'urdf'"), [is("shoulder", &[0.3])]);
        assert_eq!(numbers("[effects]\ndamping = { '*' = 'urdf', elbow = 0.7 }"), [is("shoulder", &[0.3]), is("elbow", &[0.7])]);
        let limit = "[effects.limit]\n'*' = { from = 'urdf', stiffness = 10, damping = 1 }\nshoulder = { upper = 0.5 }";
        assert_eq!(numbers(limit), [is("shoulder", &[-1.0, 0.5, 10.0, 1.0])]);
        assert_eq!(numbers("[effects]\nmotor = { elbow = 'urdf' }"), [is("elbow", &[5.0, 3.0, 1.0, 1.0, 1e-3])]);
        let report = prepared("[effects]\ndamping = 'urdf'\nspring = 'off'").robot.resolved.report;
        let why = |name: &str| report.off.iter().find(|off| off.effect == name).map(|off| off.why);
        assert_eq!(
            [why("spring"), why("damping"), why("drag"), why("shaft")],
            [Some(Why::SaidSo), None, Some(Why::NotAsked), Some(Why::NotAsked)]
        );
        assert!(
            report.to_string().contains("damping on joint \"shoulder\": damping 0.3 N·m·s/rad|N·s/m (file: dynamics damping)"),
            "{report}"
        );
    }

    #[test]
    fn everything_that_does_not_fit_the_robot_is_told_at_once() {
        let scene = "functions = ['no_such', 'mass_matrix', 'x = inverse_dynamics(b = 0)']
            parameters = ['payload(nowhere)']
            lock = { elbo = 1 }
            [effects]
            damping = { shouder = 1 }
            limit = { shoulder = { lower = 0, upper = 1, stiffness = 1 }, elbw = 'off' }
            [initial]
            q = { elbow = [1, 2], wrist = 0 }
            base = {}
            [control]
            kind = 'pd'
            kp = { sholder = 1 }
            kd = [1, 2, 3]";
        let scene = Scene::read("s.toml", scene).unwrap();
        let error = prepare(scene.clone(), "arm.urdf", ARM.into(), Base::Fixed, Vec::new()).unwrap_err();
        let told = error.to_string();
        let keys = [
            "lock.elbo",
            "no_such",
            "inverse_dynamics(b = 0)",
            "nowhere",
            "damping.shouder",
            "limit.elbw",
            "q.elbow",
            "q.wrist",
            "initial.base",
            "kp.sholder",
            "kd",
        ];
        assert!(keys.iter().all(|key| told.lines().any(|line| line.contains(key))), "{told}");
        assert_eq!(told.lines().count(), keys.len(), "{told}");
        // Those of the file with their lines, in its order.
        let lines: Vec<usize> = told.lines().filter_map(|l| l.strip_prefix("s.toml:")?.split(':').next()?.parse().ok()).collect();
        assert!(lines.is_sorted() && lines.len() > 7, "{told}");
        // The same of a request and its scene for callers that generate, start and control
        // separately.
        let mut request = prepared("").request;
        fill(&mut request.options, &scene);
        request.scene = Some(scene.clone());
        let told = crate::generate(&request).unwrap_err().to_string();
        assert!(["elbo", "no_such", "b = 0", "nowhere", "shouder", "elbw"].iter().all(|key| told.contains(key)), "{told}");
        // Of a robot that cannot be read the document is reported, and words that are wrong for
        // any.
        let told = prepare(scene, "arm.urdf", ARM.replace("parent link=\"base\"", "parent link=\"bse\"").into(), Base::Fixed, Vec::new());
        let told = told.unwrap_err().errors;
        let (document, words): (Vec<_>, Vec<_>) = told.iter().partition(|error| error.file() == "arm.urdf");
        assert!(!document.is_empty() && words.len() == 2 && words.iter().all(|error| error.field == "functions"), "{told:?}");
    }

    /// A build script's own functions, frames and names replace the scene's.
    #[test]
    fn what_is_not_the_scenes_is_not_blamed_on_it() {
        let told = |scene: &str, change: &dyn Fn(&mut Options)| {
            let scene = Scene::read("s.toml", scene).unwrap();
            let mut request = Request::new("arm.urdf", ARM);
            fill(&mut request.options, &scene);
            change(&mut request.options);
            request.scene = Some(scene);
            crate::generate(&request).unwrap_err().to_string()
        };
        assert!(
            told("functions = ['mass_matrix']", &|o| o.functions = vec!["no_such".into()])
                .starts_with("functions: unknown function `no_such`")
        );
        assert!(told("frames = ['fore']", &|o| o.robot.set_frames(["none"])).starts_with("arm.urdf: frames: "));
        assert!(
            told("rename = { fore = 'X' }", &|o| o.rename = vec![("none".to_owned(), "X".to_owned()).into()])
                .starts_with("arm.urdf: rename ")
        );
    }

    /// Names that are equal in Rust are no errors of a scene that has none of them.
    #[test]
    fn names_are_asked_for_where_the_scene_gives_them() {
        let urdf = ARM.replace(
            "</robot>",
            "<link name='a-b'/><link name='a_b'/>\
            <joint name='one' type='fixed'><parent link='fore'/><child link='a-b'/></joint>\
            <joint name='two' type='fixed'><parent link='fore'/><child link='a_b'/></joint></robot>",
        );
        let told = |scene: &str| {
            let scene = Scene::read("s.toml", scene).unwrap();
            prepare(scene, "arm.urdf", urdf.clone().into(), Base::Fixed, Vec::new()).map(|_| ()).map_err(|e| e.to_string())
        };
        assert_eq!(told("rename = { fore = 'FORE' }"), Ok(()));
        assert!(told("rename = { a-b = 'A_B' }").unwrap_err().starts_with("s.toml:1: rename.a-b: "));
    }

    #[test]
    fn a_scene_takes_the_angles_that_a_request_takes() {
        let read = |most: f64| Scene::read("s.toml", &format!("snap_angles = {most}")).is_ok();
        assert!(read(crate::MOST_SNAPPED) && !read(crate::MOST_SNAPPED * 1.01) && !read(0.0));
    }

    /// A scene may name any file, and a device never ends.
    #[test]
    fn of_files_larger_than_any_robot_nothing_is_read() {
        let folder = std::env::temp_dir().join(format!("articulated-vast-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = |name: &str| folder.join(name);
        std::fs::File::create(path("vast")).unwrap().set_len(1 << 40).unwrap();
        std::fs::write(path("arm.urdf"), ARM).unwrap();
        std::fs::write(path("of.toml"), "urdf = 'vast'").unwrap();
        std::fs::write(path("with.toml"), "urdf = 'arm.urdf'\nappend = { urdf = 'vast', at = 'fore', prefix = 'x' }").unwrap();
        let opened = ["vast", "of.toml", "with.toml"].map(|name| open(&path(name), &[]).map(drop).map_err(|e| e.to_string()));
        let built =
            [crate::Build::new(path("vast")), crate::Build::scene(path("vast"))].map(|b| b.generate().map(drop).map_err(|e| e.to_string()));
        std::fs::remove_dir_all(&folder).unwrap();
        let told = format!("{}: found 1099511627776 bytes, expected at most 67108864 bytes", path("vast").display());
        let [scene, of, with] = opened;
        [scene].into_iter().chain(built).for_each(|result| assert_eq!(result, Err(told.clone())));
        let (of, with) = (of.unwrap_err(), with.unwrap_err());
        assert!(of.contains(&format!("of.toml:1: urdf: {told}")), "{of}");
        assert!(with.contains(&format!("with.toml:2: append.urdf: {told}")), "{with}");
    }

    #[test]
    fn a_shaft_of_the_request_leaves_the_scene_its_effects() {
        let club = |name: &str| {
            format!(
                r#"<link name="{name}"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
                <joint name="{name}_fixed" type="fixed"><parent link="fore"/><child link="{name}"/><origin xyz="0 0 -0.5"/></joint>"#
            )
        };
        let urdf = ARM.replace("</robot>", &format!("{}{}</robot>", club("club"), club("other")));
        let scene = Scene::read(
            "s.toml",
            "[effects]\ndamping = { elbow = 0.1 }\n[effects.shaft.club_fixed]\nsegments = 2\nstiffness = 3\nmass = 0.2",
        )
        .unwrap();
        let settled = |more: Option<Shaft>| {
            let mut request = Request::new("arm.urdf", urdf.clone());
            fill(&mut request.options, &scene);
            request.options.robot.shafts.extend(more.map(Spanned::from));
            request.scene = Some(scene.clone());
            request.build_robot().unwrap_or_else(|e| panic!("{e}")).effects
        };
        let alone = settled(None);
        assert!([EffectId::damping, EffectId::spring].iter().all(|name| alone.iter().any(|a| a.effect == *name)), "{alone:?}");
        let own = Shaft { joint: "other_fixed".into(), ..scene.shafts[0].shaft.clone() };
        assert_eq!(settled(Some(own)), alone);
    }

    #[test]
    fn mistakes_that_only_the_robot_shows_have_their_lines() {
        let wrong = |scene: &str| {
            let scene = Scene::read("s.toml", scene).unwrap();
            let equal = ARM.replace(r#"lower="-1" upper="2""#, r#"lower="1" upper="1""#);
            prepare(scene, "arm.urdf", equal.into(), Base::Fixed, Vec::new()).map(|_| ()).unwrap_err().to_string()
        };
        let limit = wrong("\n[effects]\nlimit = { from = 'urdf', stiffness = 100 }");
        assert_eq!(limit, "s.toml:3: effects.limit: limit on joint \"shoulder\": upper: found 1, expected a number above the lower bound");
        assert_eq!(wrong("\nlock = { elbo = 1 }"), "s.toml:2: lock.elbo: the robot has no joint \"elbo\", did you mean \"elbow\"?");
        let named = [
            ("\nfunctions = ['mass_matrix',\n 'no_such']", "s.toml:3: functions: unknown function `no_such`"),
            ("functions = ['bias_forces',\n'motion']", "s.toml:2: functions: `motion`: it stands for what the motion of a scene calls"),
            ("\nfunctions = ['x = inverse_dynamics(b = 0)']", "s.toml:2: functions: `x = inverse_dynamics(b = 0)`: "),
            ("parameters = [\n'payload(for)']", "s.toml:2: parameters: `payload(for)`: "),
            ("frames = ['fore',\n'upper',\n'for']", "s.toml:3: frames: the robot has no link or frame \"for\", did you mean \"fore\"?"),
            ("frames = ['for']\nrename = { fore = 'X' }", "s.toml:1: frames: the robot has no link or frame \"for\", did you mean"),
            ("frames = ['fore',\n'fore']", "s.toml:2: frames: \"fore\" is listed twice"),
            ("\nrename = { elbo = 'X' }", "s.toml:2: rename.elbo: to `X`: no joint that moves"),
            ("[rename]\nfore = 'X'\nelbow = 'fn'", "s.toml:3: rename.elbow: to `fn`: this is not an identifier of Rust"),
            (
                "[rename]\nfore = 'X'\nupper = 'X'",
                "s.toml:2: rename.fore: links \"upper\" and \"fore\" are both `X` in Rust; give one another name",
            ),
        ];
        for (scene, told) in named {
            let found = wrong(scene);
            assert!(found.starts_with(told) && found.lines().count() == 1, "{found}");
        }
        let beside = wrong(
            "[effects]\ndamping = { elbow_1 = 1, elbow_x = 1 }\nshaft = { elbow = { segments = 1, stiffness = 1 } }\n[initial]\nq = { elbow_1 = 1, sholder = 1 }",
        );
        let told = ["s.toml:2: effects.damping.elbow_x: ", "s.toml:3: effects.shaft.elbow: ", "s.toml:5: initial.q.sholder: "];
        assert!(beside.lines().count() == told.len() && beside.lines().zip(told).all(|(line, told)| line.starts_with(told)), "{beside}");
        let shaft = wrong("[effects.shaft.elbow]\nsegments = 1\nstiffness = 1");
        assert_eq!(
            shaft,
            "s.toml:1: effects.shaft.elbow: shaft at joint \"elbow\": found a continuous joint, expected a fixed one, whose rigid offset is to bend"
        );
    }
}
