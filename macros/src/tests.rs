//! The macro against the other ways to the same code. Its error messages are in the workspace's
//! `tests/ui`.

use articulated_codegen::scene::Scene;
use articulated_codegen::{Base, Build, LeaveOut, Origin, Payload, Reference, Request, generate};
use proc_macro2::TokenStream;
use quote::{ToTokens, quote};
use syn::{Item, ItemMod};

use crate::expand::expand;

const URDF: &str = "../tests/ui/urdf/clash.urdf";

fn module(input: TokenStream) -> ItemMod {
    syn::parse2(expand(input)).expect("one module")
}

fn items(module: ItemMod) -> Vec<Item> {
    module.content.expect("a module with a body").1
}

#[test]
fn macro_build_script_and_library_give_the_same_tokens() {
    let rename = [("a-b", "A_MINUS_B"), ("j-1", "J_MINUS_1")].map(|(from, to)| (from.to_owned(), to.to_owned()));
    let build = Build::new(URDF).floating().gravity([0.0, 1.5, -9.0]).functions(["gravity_torque", "placements"]);
    let build = rename
        .iter()
        .fold(build.snap_angles(1e-9).leave_out([LeaveOut::Flex]), |build, (from, to)| build.rename(from, to))
        .generate()
        .unwrap();

    let mut request = Request::new(URDF, std::fs::read(URDF).unwrap());
    request.options.robot.base = Base::Floating;
    request.options.robot.gravity = Some([0.0, 1.5, -9.0]);
    request.options.functions = vec!["gravity_torque".into(), "placements".into()];
    request.options.rename = rename.iter().cloned().map(Into::into).collect();
    request.options.robot.snap_angles = Some(1e-9);
    request.options.rust_mut().runtime = Some("::articulated".into());
    assert_eq!(generate(&request).unwrap().source, build.source);

    let mut items = items(module(quote! {
        mod clash {
            urdf = #URDF,
            base = floating,
            gravity = [0, 1.5, -9.0],
            functions = [gravity_torque, placements],
            rename = { "a-b" = A_MINUS_B, "j-1" = J_MINUS_1 },
            snap_angles = 1e-9,
            leave_out = [flex],
        }
    }));
    items.pop();
    assert_eq!(quote!(#(#items)*).to_string(), syn::parse2::<syn::File>(build.tokens()).unwrap().to_token_stream().to_string());
}

#[test]
fn defaults_are_those_of_the_build_script() {
    let urdf = "../tests/ui/urdf/arm.urdf";
    let mut items = items(module(quote!(mod arm { urdf = #urdf })));
    items.pop();
    let build = Build::new(urdf).generate().unwrap().tokens();
    assert_eq!(quote!(#(#items)*).to_string(), syn::parse2::<syn::File>(build).unwrap().to_token_stream().to_string());
}

#[test]
fn edits_are_those_of_the_build_script_and_every_file_is_mentioned() {
    let (urdf, gripper) = ("../tests/ui/urdf/three.urdf", "../tests/ui/urdf/gripper.urdf");
    let origin = Origin::new([0.0, 0.0, 0.1], [0.0, 0.5, 0.0]);
    let payload = Payload { link: "grip_palm".into(), mass: 0.5, inertia: [1e-3, 0.0, 0.0, 1e-3, 0.0, 1e-3], ..Payload::default() };
    let build = Build::new(urdf)
        .append(gripper, "tool", "grip_", origin)
        .payload(payload)
        .lock("elbow", [-0.5])
        .lock("grip_close", [0.02])
        .frames(["grip_left thumb", "tool"])
        .wrenches_in(Reference::World);
    let build = build.generate().unwrap();
    for words in ["Appended: gripper.urdf", "Payload: 0.5 kg", "joint \"elbow\" at [-0.5]", "Frames: grip_left", "Wrenches in: world"] {
        assert!(build.source.contains(words), "{words}");
    }
    let mut items = items(module(quote! {
        mod arm {
            urdf = #urdf,
            append = { urdf = #gripper, at = tool, prefix = "grip_", xyz = [0, 0, 0.1], rpy = [0, 0.5, 0] },
            payload = { link = grip_palm, mass = 0.5, inertia = [1e-3, 0, 0, 1e-3, 0, 1e-3] },
            lock = { elbow = -0.5, "grip_close" = [0.02] },
            frames = ["grip_left thumb", tool],
            wrenches_in = world,
        }
    }));
    let mentioned: Vec<String> = items.split_off(items.len() - 2).iter().map(|item| item.to_token_stream().to_string()).collect();
    assert!(mentioned[0].contains("three.urdf") && mentioned[1].contains("gripper.urdf"), "{mentioned:?}");
    assert_eq!(quote!(#(#items)*).to_string(), syn::parse2::<syn::File>(build.tokens()).unwrap().to_token_stream().to_string());
}

/// A warning is the use of a constant whose deprecation is the text.
#[test]
fn warnings_are_items_of_which_the_compiler_warns() {
    let file = std::env::temp_dir().join(format!("articulated-odd-{}.urdf", std::process::id()));
    let arm = std::fs::read_to_string("../tests/ui/urdf/arm.urdf").unwrap();
    std::fs::write(&file, arm.replace("effort=\"10\"", "effort=\"0\"").replace("xyz=\"0 1 0\"", "xyz=\"0 3 0\"")).unwrap();
    let name = file.to_str().unwrap();
    let out = module(quote!(mod arm { urdf = #name })).to_token_stream().to_string();
    std::fs::remove_file(&file).unwrap();
    assert_eq!(out.matches("deprecated (note = ").count(), 2, "{out}");
    assert!(out.contains("limit effort: found zero") && out.contains("of length 3.0000") && out.contains("(and 1 more: joint"), "{out}");
    let sound = module(quote!(mod arm { urdf = "../tests/ui/urdf/arm.urdf" })).to_token_stream().to_string();
    assert!(!sound.contains("deprecated"));
}

fn errors(text: &str) -> Vec<String> {
    let out = expand(text.parse().unwrap()).to_string();
    out.split("compile_error !").skip(1).map(|rest| rest.split("; }").next().unwrap_or_default().to_owned()).collect()
}

#[test]
fn a_key_with_a_colon_is_one_mistake() {
    let told = errors("mod arm { urdf: \"../tests/ui/urdf/arm.urdf\" }");
    assert!(told.len() == 1 && told[0].contains("expected `=` after `urdf`"), "{told:?}");
}

#[test]
fn a_missing_file_is_told_with_the_nearest_and_with_the_other_mistakes() {
    let told = errors("mod arm { urdf = \"../tests/ui/urdf/amr.urdf\", functions = [mass_matrx, no_such], floating = true }").concat();
    for part in ["did you mean \\\"arm.urdf\\\"?", "`mass_matrx`", "`no_such`", "base = \\\"floating\\\""] {
        assert_eq!(told.matches(part).count(), 1, "{part} in {told}");
    }
}

#[test]
fn the_module_says_how_another_function_is_had() {
    let out = module(quote!(mod arm { urdf = "../tests/ui/urdf/arm.urdf" })).to_token_stream().to_string();
    assert!(out.contains("add it to `functions`"), "{out}");
}

#[test]
fn standalone_code_names_no_crate() {
    let urdf = "../tests/ui/urdf/arm.urdf";
    let module = module(quote!(mod arm { urdf = #urdf, standalone = true }));
    // Texts contain the path of the file, whose folders may have any name.
    fn identifiers(tokens: proc_macro2::TokenStream, found: &mut Vec<String>) {
        for token in tokens {
            match token {
                proc_macro2::TokenTree::Ident(name) => found.push(name.to_string()),
                proc_macro2::TokenTree::Group(group) => identifiers(group.stream(), found),
                _ => {}
            }
        }
    }
    let mut found = Vec::new();
    items(module).iter().for_each(|item| identifiers(item.to_token_stream(), &mut found));
    assert!(found.iter().any(|name| name == "inverse_dynamics"), "{found:?}");
    assert!(!found.iter().any(|name| name.starts_with("articulated")), "{found:?}");
}

#[test]
fn attributes_and_visibility_are_the_modules() {
    let urdf = "../tests/ui/urdf/arm.urdf";
    let module = module(quote!(#[doc = "An arm."] #[cfg(all())] pub(crate) mod arm { urdf = #urdf }));
    // Before them is what the macro allows, after them its own documentation.
    let (attributes, visibility) = (&module.attrs[1..module.attrs.len() - 1], &module.vis);
    assert_eq!(quote!(#(#attributes)* #visibility).to_string(), quote!(#[doc = "An arm."] #[cfg(all())] pub(crate)).to_string());
}

#[test]
fn the_compiler_is_told_of_the_urdf_even_if_it_is_broken() {
    let urdf = "../tests/ui/urdf/broken.urdf";
    let items = items(module(quote!(mod broken { urdf = #urdf })));
    let text = items.last().to_token_stream().to_string();
    assert!(text.contains("include_bytes") && text.contains("broken.urdf"), "{text}");
}

#[test]
fn a_scene_gives_the_same_tokens_by_macro_build_script_and_request() {
    let file = "../tests/ui/scenes/three.toml";
    let build = Build::scene(file).generate().unwrap();
    for words in
        ["Effect: damping on \"elbow\"", "Effect: spring on \"grip_palm_mount_1\"", "Payload: 0.5 kg", "Appended: gripper.urdf", "Bends: "]
    {
        assert!(build.source.contains(words), "{words} in {}", build.source.lines().take(30).collect::<Vec<_>>().join("\n"));
    }
    let mut opened = articulated_codegen::scene::open(std::path::Path::new(file), &[]).unwrap().request;
    opened.options.rust_mut().runtime = Some("::articulated".into());
    assert_eq!(generate(&opened).unwrap().source, build.source);

    let mut items = items(module(quote!(mod arm { scene = #file })));
    let mentioned: Vec<String> = items.split_off(items.len() - 3).iter().map(|item| item.to_token_stream().to_string()).collect();
    assert!(
        mentioned[0].contains("three.toml") && mentioned[1].contains("three.urdf") && mentioned[2].contains("gripper.urdf"),
        "{mentioned:?}"
    );
    assert_eq!(quote!(#(#items)*).to_string(), syn::parse2::<syn::File>(build.tokens()).unwrap().to_token_stream().to_string());
}

#[test]
fn what_the_invocation_says_stands_in_place_of_what_the_scene_says() {
    let file = "../tests/ui/scenes/three.toml";
    let build = Build::scene(file).floating().gravity([0.0, 0.0, -1.62]).functions(["gravity_torque"]).generate().unwrap();
    let mut items =
        items(module(quote!(mod arm { scene = #file, base = floating, gravity = [0, 0, -1.62], functions = [gravity_torque] })));
    items.truncate(items.len() - 3);
    assert_eq!(quote!(#(#items)*).to_string(), syn::parse2::<syn::File>(build.tokens()).unwrap().to_token_stream().to_string());
}

/// With effects too, and beside a scene.
#[test]
fn groups_of_functions_stand_for_the_same_everywhere() {
    let text = |module: ItemMod| quote!(#module).to_string();
    let (file, urdf) = ("../tests/ui/scenes/three.toml", "../tests/ui/urdf/three.urdf");
    let own = text(module(quote!(mod arm { scene = #file, functions = [effects, gravity_torque] })));
    let names = quote!(effect_forces, dissipation, motor_torques, gravity_torque);
    assert_eq!(own, text(module(quote!(mod arm { scene = #file, functions = [#names] }))));
    let build = Build::scene(file).functions(["effects", "gravity_torque"]).generate().unwrap();
    assert!(own.contains("fn dissipation ") && build.source.contains("fn dissipation("));
    let moved = text(module(quote!(mod arm { scene = #file, functions = [motion, bias_forces] })));
    let names = quote!(forward_dynamics, integrate, kinetic_energy, potential_energy, centroidal_momentum, dissipation, motor_torques);
    assert_eq!(moved, text(module(quote!(mod arm { scene = #file, functions = [#names, bias_forces] }))));
    let build = Build::scene(file).functions(["motion"]).generate().unwrap();
    assert!(build.source.contains("fn forward_dynamics(") && build.source.contains("fn centroidal_momentum("));
    let effects = quote!(effects = { damping = { "*" = 0.1 } });
    let own = text(module(quote!(mod arm { urdf = #urdf, functions = [effects], #effects })));
    assert_eq!(own, text(module(quote!(mod arm { urdf = #urdf, functions = [effect_forces, dissipation, motor_torques], #effects }))));
}

#[test]
fn effects_in_the_invocation_are_those_of_a_scene() {
    let urdf = "../tests/ui/urdf/three.urdf";
    let mut items = items(module(quote! {
        mod arm {
            urdf = #urdf,
            functions = [effect_forces],
            effects = { damping = { "*" = 0.1, elbow = off }, spring = { wrist = { stiffness = 2, rest = -0.5 } }, limit = { from = urdf, stiffness = 1e3 } },
        }
    }));
    items.pop();
    let scene = "[effects]\ndamping = { '*' = 0.1, elbow = 'off' }\nlimit = { from = 'urdf', stiffness = 1000 }\n[effects.spring.wrist]\nstiffness = 2\nrest = -0.5";
    let mut request = Request::new(urdf, std::fs::read(urdf).unwrap());
    request.options.functions = vec!["effect_forces".into()];
    request.options.rust_mut().runtime = Some("::articulated".into());
    request.scene = Some(Scene::read("s", scene).unwrap());
    assert_eq!(request.build_robot().unwrap().effects.len(), 2 + 1 + 3);
    let tokens = generate(&request).unwrap().tokens();
    assert_eq!(quote!(#(#items)*).to_string(), syn::parse2::<syn::File>(tokens).unwrap().to_token_stream().to_string());
}

#[test]
fn a_number_with_a_unit_behind_it_is_refused() {
    let refused = |entry: &str| {
        let text = format!("mod arm {{ urdf = \"../tests/ui/urdf/three.urdf\", functions = [gravity_torque], {entry} }}");
        let out = expand(text.parse().unwrap()).to_string();
        out.contains("compile_error") && out.contains("expected")
    };
    for entry in [
        "lock = { elbow = 90deg }",
        "lock = { elbow = -90deg }",
        "lock = { elbow = [0.5rad] }",
        "gravity = [0, 0, -9.81m]",
        "payload = { link = tool, mass = 500g }",
        "payload = { link = tool, mass = 1, center_of_mass = [0, 0, -70cm] }",
        "effects = { damping = 5mNms }",
        "effects = { damping = { elbow = 1.5f32 } }",
        "leave_out = flex",
        "leave_out = [flexible]",
        "snap_angles = 1u8",
        "snap_angles = 2",
        "snap_angles = 0",
        "snap_angles = 0.0",
    ] {
        assert!(refused(entry), "{entry}");
    }
    assert!(!refused("lock = { elbow = 0.5f64 }, gravity = [0, 0, -9.81_f64]"));
}

#[test]
fn of_a_file_larger_than_any_robot_nothing_is_read() {
    let file = std::env::temp_dir().join(format!("articulated-vast-{}.urdf", std::process::id()));
    std::fs::File::create(&file).unwrap().set_len(1 << 40).unwrap();
    let name = file.to_str().unwrap();
    let out = expand(quote!(mod arm { urdf = #name })).to_string();
    std::fs::remove_file(&file).unwrap();
    assert!(out.contains(&format!("{name}: found 1099511627776 bytes, expected at most 67108864 bytes")), "{out}");
}

#[test]
fn empty_lists_stand_in_place_of_those_of_the_scene_too() {
    let file = "../tests/ui/scenes/three.toml";
    let empty = |o: &mut articulated_codegen::Options| {
        (o.robot.payloads, o.parameters, o.batch) = (Vec::new(), Vec::new(), Vec::new());
        (o.robot.lock, o.rename) = (Vec::new(), Vec::new());
    };
    let build = Build::scene(file).options(empty).generate().unwrap();
    assert!(!build.source.contains("Payload: "));
    let mut items = items(module(quote!(mod arm { scene = #file, payload = [], parameters = [], batch = [], lock = {}, rename = {} })));
    items.truncate(items.len() - 3);
    assert_eq!(quote!(#(#items)*).to_string(), syn::parse2::<syn::File>(build.tokens()).unwrap().to_token_stream().to_string());
}

#[test]
fn names_are_words_or_stand_in_quotation_marks() {
    let urdf = "../tests/ui/urdf/three.urdf";
    let word = items(module(quote!(mod arm { urdf = #urdf, rename = { tool = TCP } })));
    let quoted = items(module(quote!(mod arm { urdf = #urdf, rename = { "tool" = TCP } })));
    assert_eq!(quote!(#(#word)*).to_string(), quote!(#(#quoted)*).to_string());
    assert!(quote!(#(#word)*).to_string().contains("TCP"));
}

#[test]
fn a_group_of_functions_and_a_crate_without_std_are_asked_for_as_elsewhere() {
    let urdf = "../tests/ui/urdf/arm.urdf";
    let mut items = items(module(quote!(mod arm { urdf = #urdf, functions = [momentum, gravity_torque], no_std = true })));
    items.pop();
    let build = Build::new(urdf).functions(["momentum", "gravity_torque"]).no_std().generate().unwrap();
    assert!(build.source.contains("pub fn center_of_mass_jacobian(") && build.source.contains("libm::"));
    assert_eq!(quote!(#(#items)*).to_string(), syn::parse2::<syn::File>(build.tokens()).unwrap().to_token_stream().to_string());
}

#[test]
fn an_expression_is_written_as_it_is_or_as_a_text() {
    let urdf = "../tests/ui/urdf/three.urdf";
    let word = module(quote!(mod arm { urdf = #urdf, functions = [hold = inverse_dynamics(v = 0, a = 0)], level = f64 + fast_10 }));
    let text = module(quote!(mod arm { "urdf" = #urdf, functions = ["hold = inverse_dynamics(v = 0, a = 0)"], level = "f64 + fast_10" }));
    assert_eq!(quote!(#word).to_string(), quote!(#text).to_string());
    assert!(quote!(#word).to_string().contains("fn hold"));
}

#[test]
fn of_what_cannot_be_read_each_is_told_and_the_rest_is_read() {
    let told = |keys: &str| expand(format!("mod arm {{ urdf = \"../tests/ui/urdf/three.urdf\", {keys} }}").parse().unwrap()).to_string();
    for (keys, words) in [
        ("frames = [left foot]", &["names that are no words stand in quotation marks"][..]),
        ("frames = [left-foot], lock = { left-foot = 1 }", &["names that are no words", "expected `=` after `left`"]),
        ("base = floating functions = [mass_matrix], gravity = [0, 0]", &["expected `,`", "gravity: found a list of 2 numbers"]),
        ("lock = { = 1, elbow 2 }, gravity = [0,, 0]", &["expected a name", "after `elbow`", "nothing before the comma"]),
        ("parameters = [payload(nowhere)], crate = here, standalone = (true)", &["nowhere", "absolute path", "expected true or false"]),
    ] {
        let told = told(keys);
        assert!(words.iter().all(|word| told.contains(word)) && !told.contains("is missing"), "{keys}: {words:?} in {told}");
    }
}

/// Mistakes of a scene's text do not hide names that its robot does not have, nor the invocation's.
#[test]
fn mistakes_of_a_scene_and_of_the_invocation_come_together() {
    let folder = std::env::temp_dir().join(format!("articulated-macro-mistakes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let scene = folder.join("three.toml");
    let urdf = std::path::absolute("../tests/ui/urdf/three.urdf").unwrap().display().to_string();
    let told = |file: &str| {
        std::fs::write(&scene, format!("file = {file:?}\nsumary = ''\nframes = ['tol']\neffects = {{ damping = {{ elbw = 1 }} }}"))
            .unwrap();
        let file = scene.display().to_string();
        expand(quote!(mod arm { scene = #file, functions = [mass_matrx] })).to_string()
    };
    let all = told(&urdf);
    for part in ["three.toml:2: sumary", "three.toml:3: frames", "three.toml:4: effects.damping.elbw", "mass_matrx"] {
        assert!(all.contains(part), "{part}: {all}");
    }
    let without = told(&urdf.replace("three.urdf", "tree.urdf"));
    for part in ["three.toml:1: urdf", "did you mean", "three.toml:2: sumary", "mass_matrx"] {
        assert!(without.contains(part), "{part}: {without}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}
