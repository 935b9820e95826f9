//! Files of xacro: their expansions, and the places of their errors.

use std::collections::BTreeMap;
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

use articulated_core::description::{Description, LinkId};
use articulated_core::diagnostic::{Code, Diagnostics};
use articulated_formats::{NoFiles, Options, Reading, Sources, included, read_with};

/// Files by their names; packages and variables of the environment after them.
#[derive(Default)]
struct Files {
    files: BTreeMap<PathBuf, Vec<u8>>,
    packages: Vec<(&'static str, &'static str)>,
    variables: Vec<(&'static str, &'static str)>,
}

impl Files {
    fn of(files: &[(&str, &str)]) -> Self {
        let files = files.iter().map(|(name, text)| (PathBuf::from(name), text.as_bytes().to_vec())).collect();
        Self { files, ..Self::default() }
    }
}

impl Sources for Files {
    fn read(&self, path: &Path) -> Result<Vec<u8>> {
        self.files.get(path).cloned().ok_or_else(|| Error::new(ErrorKind::NotFound, "no such file"))
    }

    fn list(&self, folder: &Path) -> Result<Vec<String>> {
        let inside = self.files.keys().filter(|path| path.parent() == Some(folder));
        Ok(inside.filter_map(|path| Some(path.file_name()?.to_str()?.to_owned())).collect())
    }

    fn package(&self, name: &str) -> Option<PathBuf> {
        self.packages.iter().find(|(own, _)| *own == name).map(|(_, folder)| folder.into())
    }

    fn variable(&self, name: &str) -> Option<String> {
        self.variables.iter().find(|(own, _)| *own == name).map(|(_, value)| (*value).to_owned())
    }
}

const FILE: &str = "robots/urdf/arm.xacro";

fn options(arguments: &[(&str, &str)]) -> Options {
    let arguments = arguments.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    Options { file: FILE.to_owned(), arguments, ..Options::default() }
}

fn result(files: &Files, body: &str, arguments: &[(&str, &str)]) -> std::result::Result<Reading, Diagnostics> {
    let text = format!("<robot name='arm' xmlns:xacro='http://www.ros.org/wiki/xacro'>\n{body}\n</robot>");
    let options = options(arguments);
    let reading = read_with(files, text.as_bytes(), &options);
    // A recorded reading is repeated without the files.
    let kept = included(files, Path::new(""), text.as_bytes(), &options);
    let again = read_with(&kept, text.as_bytes(), &options);
    match (&reading, &again) {
        (Ok(one), Ok(two)) => assert_eq!((&one.description, &one.warnings), (&two.description, &two.warnings)),
        (one, two) => assert_eq!(one.as_ref().err().map(ToString::to_string), two.as_ref().err().map(ToString::to_string)),
    }
    reading
}

fn expanded(files: &Files, body: &str, arguments: &[(&str, &str)]) -> Reading {
    result(files, body, arguments).unwrap_or_else(|found| panic!("{found}\n{body}"))
}

/// The names of links, and each mass.
fn links(body: &str) -> String {
    shown(&expanded(&Files::default(), body, &[]).description)
}

fn shown(description: &Description) -> String {
    let mass = |mass: f64| format!(" {mass:?}");
    let links = description.links.iter().map(|l| format!("{}{}", l.name, l.inertial.as_ref().map(|i| mass(i.mass)).unwrap_or_default()));
    links.collect::<Vec<_>>().join(", ")
}

/// A link of this mass on the link `base`.
fn link(name: &str, mass: &str) -> String {
    format!(
        "<link name='{name}'><inertial><mass value=\"{mass}\"/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\
         <joint name='{name}_joint' type='fixed'><parent link='base'/><child link='{name}'/></joint>"
    )
}

/// The masses of a link for each expression.
fn values(before: &str, expressions: &[(&str, f64)]) {
    let all: String = expressions.iter().enumerate().map(|(k, (text, _))| link(&format!("k{k}"), text)).collect();
    let reading = expanded(&Files::default(), &format!("<link name='base'/>{before}{all}"), &[]);
    for (link, (text, value)) in reading.description.links.iter().skip(1).zip(expressions) {
        let mass = link.inertial.as_ref().unwrap().mass;
        assert!(mass == *value, "{text}: {mass:?}, not {value:?}");
    }
}

#[test]
fn expressions_have_the_values_of_python() {
    let before =
        "<xacro:property name='a' value='2'/><xacro:property name='b' value='${a * 1.5}'/><xacro:property name='v' value='${[1, 2, 3.5]}'/>
        <xacro:property name='d' value=\"${dict(x=4, y=dict(z='5'))}\"/><xacro:property name='t' value='1 2.5'/>";
    values(
        before,
        &[
            ("${a}", 2.0),
            ("${b + a**3 // 3 % 4}", 5.0),
            ("${-7 // 2 + 10}", 6.0),
            ("${-7 % 3}", 2.0),
            ("${-7.5 % 3}", 1.5),
            ("${2**-1}", 0.5),
            ("${-2**2 + 5}", 1.0),
            ("${7 / 2}", 3.5),
            ("${v[0] + v[-1]}", 4.5),
            ("${sum([x * 2 for x in v if x > 1])}", 11.0),
            ("${d['x'] + d.x}", 8.0),
            ("${float(d.y.z) + int('3')}", 8.0),
            ("${1 if a == 2 and not b &lt; 3 else 9}", 1.0),
            ("${3 if 'x' in d and a in [2, 4] else 9}", 3.0),
            ("${len(t.split()) + float(t.split(' ')[1])}", 4.5),
            ("${round(2.5) + round(0.125, 2)}", 2.0 + 0.12),
            ("${max(1, a, b) + min([4, 5]) + abs(-1)}", 8.0),
            ("${cos(0) + math.sqrt(4) + radians(180) - pi}", 3.0),
            ("${hypot(3, 4) + floor(2.9) + fabs(-1)}", 8.0),
        ],
    );
    values(
        before,
        &[("1${'%03d' % a}", 1002.0), ("${str(a) + '5'}", 25.0), ("1${1 &lt; 2 and 5}", 15.0), ("${'3.5' if True else ''}", 3.5)],
    );
    values("", &[("${python.sum(range(4)) + xacro.tokenize('1 2')[1].count('2')}", 7.0), ("${1e-5 * 2}", 2e-5), ("$(eval 3 * 4)", 12.0)]);
}

#[test]
fn macros_take_parameters_defaults_and_blocks() {
    let body = "<link name='base'/>
      <xacro:property name='side' value='left'/>
      <xacro:macro name='part' params='name mass:=${1 + 1} side:=^ tail:=^|_end *block **more'>
        <link name='${side}_${name}${tail}'><inertial><mass value='${mass}'/><xacro:insert_block name='block'/></inertial></link>
        <joint name='${side}_${name}' type='fixed'><child link='${side}_${name}${tail}'/><xacro:insert_block name='more'/></joint>
      </xacro:macro>
      <xacro:macro name='pair' params='side'>
        <xacro:part name='a'><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/><x><parent link='base'/><origin xyz='${0 * len(side)} 0 0'/></x></xacro:part>
        <xacro:call macro='${\"par\" + \"t\"}' name='b' mass='3'><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/><x><parent link='base'/></x></xacro:call>
      </xacro:macro>";
    let text = format!(
        "{body}<xacro:pair side='right'/><xacro:part name='c' mass='4'><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/><x><parent link='base'/></x></xacro:part>"
    );
    assert_eq!(links(&text), "base, right_a_end 2.0, right_b_end 3.0, left_c_end 4.0");
}

#[test]
fn macros_call_themselves_until_a_condition_holds() {
    let chain = |count| {
        format!(
            "<link name='base'/><xacro:macro name='chain' params='k from'><link name='l${{k}}'/>
              <joint name='j${{k}}' type='fixed'><parent link='${{from}}'/><child link='l${{k}}'/></joint>
              <xacro:if value='${{k &lt; {count}}}'><xacro:chain k='${{k + 1}}' from='l${{k}}'/></xacro:if></xacro:macro><xacro:chain k='1' from='base'/>"
        )
    };
    assert_eq!(expanded(&Files::default(), &chain(300), &[]).description.links.len(), 301);
    let error = result(&Files::default(), &chain(1_000_000), &[]).unwrap_err();
    assert_eq!(error.errors.iter().map(|e| e.code).collect::<Vec<_>>(), [Code::TooLarge], "{error}");
}

#[test]
fn scopes_of_properties_are_those_of_xacro() {
    let body = "<link name='base'/><xacro:property name='a' value='1'/>
      <xacro:macro name='set' params=''><xacro:property name='a' value='2'/><xacro:property name='b' value='${a}' scope='parent'/>
        <xacro:property name='c' value='${a + 1}' scope='global'/></xacro:macro>
      <xacro:set/><xacro:property name='lazy' value='${later * 2}'/><xacro:property name='later' value='4'/>
      <xacro:property name='a' default='9'/><xacro:property name='new' default='9'/>
      <xacro:property name='eager' value='${later}' lazy_eval='false'/><xacro:property name='later' value='5'/>
      <xacro:property name='gone' value='1'/><xacro:property name='gone' remove='true'/><xacro:property name='gone' default='7'/>";
    values(
        body.strip_prefix("<link name='base'/>").unwrap(),
        &[("${a}", 1.0), ("${b}", 2.0), ("${c}", 3.0), ("${new}", 9.0), ("${eager}", 4.0), ("${lazy}", 10.0), ("${gone}", 7.0)],
    );
}

#[test]
fn conditions_elements_attributes_and_property_blocks() {
    let inertial = "<xacro:property name='i'><inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></xacro:property>";
    let body = format!(
        "{inertial}<xacro:arg name='sim' default='false'/><link name='base'/>
         <xacro:if value='$(arg sim)'><link name='nothing'/></xacro:if>
         <xacro:unless value='$(arg sim)'><xacro:element xacro:name='${{\"li\" + \"nk\"}}'><xacro:attribute name='name' value='a${{1}}'/>
           <xacro:insert_block name='i'/></xacro:element></xacro:unless>
         <joint name='j' type='fixed' xacro:note='x'><parent link='base'/><child link='a1'/></joint>"
    );
    assert_eq!(links(&body), "base, a1 2.0");
    let reading = expanded(&Files::default(), "<link name='$${x}'/><xacro:property name='unused' value='${unknown}'/>", &[]);
    assert_eq!(reading.description.links[LinkId(0)].name, "${x}");
}

#[test]
fn files_packages_and_yaml_are_found_and_keep_their_names() {
    let mut files = Files::of(&[
        (
            "robots/urdf/inc/part.xacro",
            "<robot><xacro:property name='size' value='3'/><xacro:macro name='part' params='name'>\n<link name='${name}'/>
          <joint name='j_${name}' type='fixed'><parent link='base'/><child link='${name}'/></joint></xacro:macro></robot>",
        ),
        ("robots/package.xml", "<package><name>my_robot</name></package>"),
        ("robots/config/limits.yaml", "joints:\n  - {name: a, upper: !degrees 90}\nmass: 2.5\n"),
        ("other/share/x.xacro", "<robot><xacro:include filename='y.xacro'/></robot>"),
        ("other/share/y.xacro", "<robot><link name='deep'/></robot>"),
        ("robots/urdf/glob/2.xacro", "<robot><xacro:property name='last' value='2'/></robot>"),
        ("robots/urdf/glob/1.xacro", "<robot><xacro:property name='last' value='1'/></robot>"),
    ]);
    files.packages.push(("other", "other/share"));
    files.variables.push(("SIDE", "left"));
    let body = "<link name='base'/><xacro:include filename='inc/part.xacro' ns='p'/><xacro:p.part name='$(env SIDE)${p.size}$(optenv NONE x)'/>
      <xacro:include filename='nothing.xacro' optional='true'/><xacro:include filename='glob/*.xacro'/>
      <xacro:property name='c' value=\"${xacro.load_yaml('$(find my_robot)/config/limits.yaml')}\"/>
      <link name='l${last}'><visual><geometry><mesh filename='file://$(find my_robot)/a.stl'/></geometry></visual></link>
      <joint name='${c.joints[0].name}' type='revolute'><parent link='base'/><child link='l2'/><axis xyz='0 0 1'/><limit lower='0' upper=\"${c['joints'][0]['upper']}\" effort='${c.mass}' velocity='1'/></joint>
      <xacro:include filename='$(find other)/x.xacro'/><joint name='k' type='fixed'><parent link='base'/><child link='deep'/></joint>";
    let reading = expanded(&files, body, &[]);
    assert_eq!(shown(&reading.description), "base, left3x, l2, deep");
    let joint = &reading.description.joints[reading.description.joint("a").unwrap()];
    assert_eq!(joint.limit.map(|l| (l.upper, l.effort)), Some((std::f64::consts::FRAC_PI_2, 2.5)));
    assert!(format!("{:?}", reading.description.links[LinkId(2)].visual).contains("package://my_robot/a.stl"));
}

#[test]
fn arguments_come_from_the_caller_or_have_defaults() {
    let body = "<xacro:arg name='name' default='base'/><xacro:arg name='n' default='1'/><link name='$(arg name)${int(xacro.arg(\"n\")) + 1}$(eval n * 2)'/>".replace("\"n\"", "&quot;n&quot;");
    assert_eq!(links(&body), "base22");
    let plain = expanded(&Files::default(), "<link name='base'/>", &[("x", "1")]);
    assert_eq!(plain.warnings.len(), 1);
    let reading = expanded(&Files::default(), &body, &[("name", "root"), ("nam", "x"), ("n", "3")]);
    assert_eq!(shown(&reading.description), "root46");
    assert_eq!(
        reading.warnings.iter().map(|w| w.message()).collect::<Vec<_>>(),
        ["args: found the argument \"nam\", which the file does not have, expected one of its arguments (did you mean \"name\"?)"]
    );
}

/// The file, line and column of each error, and words of its message.
fn errors(files: &Files, body: &str) -> Vec<String> {
    let found = result(files, body, &[]).unwrap_err();
    found.errors.iter().map(ToString::to_string).collect()
}

#[test]
fn mistakes_have_the_line_of_the_source_file() {
    let files = Files::of(&[
        ("robots/urdf/part.xacro", "<robot>\n<xacro:macro name='part' params='name mass'>\n<link name='${name}'>\n<inertial><mass value='${mass}'/>
<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='${1}'/></inertial></link>\n<joint name='j' type='fixed'><parent link='nowhere'/><child link='${nam}'/></joint></xacro:macro></robot>"),
        ("robots/urdf/bad.xacro", "<robot>\n<link name='x'></robot>"),
        ("robots/urdf/bad.yaml", "a: 1\nb: [1, 2\n"),
    ]);
    let found = errors(&files, "<link name='base'/>\n<xacro:include filename='part.xacro'/>\n<xacro:part name='a' mass='x'/>");
    assert!(found[0].starts_with("robots/urdf/part.xacro:6: joint \"j\": child link: found the xacro expression \"${nam}\" with the unknown name \"nam\", expected a property, a parameter or a function (did you mean \"name\"?); in the macro part that robots/urdf/arm.xacro:4 calls"), "{found:#?}");
    assert!(found[1].starts_with("robots/urdf/part.xacro:4: link \"a\": mass value: found \"x\""), "{found:#?}");
    assert!(found[2].starts_with("robots/urdf/part.xacro:6: joint \"j\": parent: found \"nowhere\""), "{found:#?}");
    assert_eq!(found.len(), 3, "{found:#?}");

    let found = errors(&files, "<link name='base'/>\n\n<xacro:include filename='bad.xacro'/><xacro:include filename='missing.xacro'/>\n<xacro:if value='${x.y}'/>\n<xacro:nothing/>
        <xacro:property name='p' value=\"${load_yaml('bad.yaml')}\"/><link name='${p.a}'/>");
    let starts = [
        "robots/urdf/bad.xacro:2: XML: found",
        "robots/urdf/arm.xacro:4: xacro:include filename: found \"robots/urdf/missing.xacro\": no such file, expected a file",
        "robots/urdf/arm.xacro:5: xacro:if value: found the xacro expression \"${x.y}\" with the unknown name \"x\"",
        "robots/urdf/arm.xacro:6: xacro: found the tag <xacro:nothing>, which is no macro",
        "robots/urdf/bad.yaml:2: yaml: found a bracket that is not closed",
    ];
    assert_eq!(found.len(), starts.len(), "{found:#?}");
    for (found, start) in found.iter().zip(starts) {
        assert!(found.starts_with(start), "{found}\n{start}");
    }
}

/// The working folder is the one that names of files start from, whatever the folder of the file
/// is.
#[test]
fn the_working_folder_and_classes_in_patterns_are_read() {
    let files = Files::of(&[
        ("parts/arm_1.xacro", "<robot><link name='one'/></robot>"),
        ("parts/arm_2.xacro", "<robot><link name='two'/></robot>"),
        ("parts/arm_3.xacro", "<robot><link name='three'/></robot>"),
        ("robots/urdf/base.xacro", "<robot><link name='base'/></robot>"),
    ]);
    let joints =
        ["one", "three"].map(|name| format!("<joint name='{name}' type='fixed'><parent link='base'/><child link='{name}'/></joint>"));
    let body = format!(
        "<xacro:include filename='$(dirname)/base.xacro'/><xacro:include filename='$(cwd)/parts/arm_[13].xacro'/>{}\
         <link name='mesh'><visual><geometry><mesh filename='$(cwd)/m.stl'/></geometry></visual></link>\
         <joint name='m' type='fixed'><parent link='base'/><child link='mesh'/></joint>",
        joints.concat()
    );
    let reading = expanded(&files, &body, &[]);
    assert_eq!(shown(&reading.description), "base, one, three, mesh");
    assert!(format!("{:?}", reading.description.links[LinkId(3)].visual).contains("\"./m.stl\""));
    let found = errors(&files, "<link name='base'/><xacro:include filename='$(cwd)/p[ab]rts/x.xacro'/><link name='$(cwd x)'/>");
    assert!(
        found.len() == 2 && found[0].contains("[…] in the name of the file alone") && found[1].contains("none behind dirname and cwd"),
        "{found:?}"
    );
}

/// The expected texts are those of Python 3.
#[test]
fn texts_have_the_prefixes_and_escapes_of_python() {
    let body = |expression: &str| format!("<xacro:property name='größe' value='ü'/><link name=\"${{{expression}}}\"/>");
    for (expression, name) in [
        ("u'arm_' + U'ä'", "arm_ä"),
        ("'gelenk_' + größe", "gelenk_ü"),
        (r"'\x41\u00e9\U0001f916\101\50z'", "Aé🤖A(z"),
        (r"r'a\x41' + '\q'", r"a\x41\q"),
        (r"'\u00fc'.upper() + u'日本'[1]", "Ü本"),
    ] {
        let reading = expanded(&Files::default(), &body(expression), &[]);
        assert_eq!(reading.description.links[LinkId(0)].name, name, "{expression}");
    }
    for (expression, words) in [
        (r"'\x4'", r"the text \x4"),
        (r"'\ud800'", r"the text \ud800, expected the number of a character, of 4 digits"),
        (r"'\N{DEGREE SIGN}'", r"\N, the name of a character"),
        ("b'a'", "the text b'…'"),
        ("u'a", "a text without its closing quotation mark"),
    ] {
        let found = errors(&Files::default(), &body(expression));
        assert!(found.len() == 1 && found[0].contains(words), "{words}: {found:?}");
    }
    let files = Files::of(&[("robots/urdf/n.yaml", "a: \"\\u00fc\\x41\\/\"\nb: 'é'\n")]);
    let named = "<xacro:property name='n' value=\"${xacro.load_yaml('n.yaml')}\"/><link name='${n.a}${n.b}'/>";
    assert_eq!(shown(&expanded(&files, named, &[]).description), "üA/é");
}

/// As the program `xacro` does: of builtins and of all that `math` has.
#[test]
fn a_redefined_name_of_every_file_is_a_warning() {
    let told = |body: &str| {
        let reading = expanded(&Files::default(), &format!("{body}<link name='base'/>"), &[]);
        assert!(reading.warnings.iter().all(|w| w.code == Code::Xacro), "{:?}", reading.warnings);
        reading.warnings.iter().map(|w| format!("{} {}", w.line().unwrap(), w.found.split('"').nth(1).unwrap())).collect::<Vec<_>>()
    };
    assert_eq!(
        told("<xacro:property name='pi' value='3.2'/>\n<xacro:property name='gamma' value='1' scope='global'/>"),
        ["2 pi", "3 gamma"]
    );
    assert_eq!(told("<xacro:macro name='m' params='e len:=3 a'/>\n<xacro:m e='1' a='2'/>"), ["3 e", "3 len"]);
    assert_eq!(told("<xacro:property name='tau' remove='true'/>"), ["2 tau"]);
    // A default of a built-in name is left out; other names, and blocks, are not built in.
    assert_eq!(
        told("<xacro:property name='pi' default='3'/><xacro:property name='abs' value='1'/><xacro:property name='mass' value='1'/>"),
        [""; 0]
    );
    values("<xacro:property name='pi' value='3.25'/>", &[("${pi}", 3.25), ("${math.pi}", std::f64::consts::PI)]);
}

#[test]
fn every_mistake_is_an_error_of_its_own() {
    let cases: &[(&str, &str)] = &[
        (
            "<xacro:property name='a' value='${b}'/><xacro:property name='b' value='${a}'/><link name='${a}'/>",
            "property b: found the xacro expression \"${a}\" with the property \"a\", which refers to itself",
        ),
        ("<xacro:macro name='m' params='a'/><xacro:m a='1' b='1'/>", "found \"b\", which is no parameter of the macro"),
        ("<xacro:macro name='m' params='a'/><xacro:m/>", "found none for the parameter \"a\""),
        ("<xacro:macro name='m' params='*a'/><xacro:m/>", "found no tag for the block \"*a\""),
        ("<xacro:macro name='m' params=''/><xacro:m><x/></xacro:m>", "found <x>, for which the macro has no block"),
        ("<xacro:insert_block name='x'/>", "found the unknown block \"x\""),
        ("<xacro:if value='maybe'/>", "found the text \"maybe\" as a condition"),
        (
            "<xacro:include filename='$(find nothing)/x.xacro'/>",
            "found the xacro expression \"$(find nothing)/x.xacro\" with the unknown package \"nothing\"",
        ),
        ("<link name='${1 / 0}'/>", "a division by zero"),
        ("<link name='${sqrt(-1)}'/>", "found the xacro expression \"${sqrt(-1)}\" with sqrt(-1)"),
        ("<link name='${1 +}'/>", "with the end of the expression, expected a value"),
        ("<link name='${[1, 2][5]}'/>", "the index 5 of 2 items"),
        ("<link name='$(arg x)'/>", "the unknown argument \"x\", expected one with <xacro:arg>, or that args give: --arg x=VALUE"),
        ("<link name='$(find'/>", "$( without its closing bracket"),
        ("<link name='$(run x)'/>", "the unknown command \"run\""),
        ("<link name='${xacro.fatal(\"no\", 1)}'/>", "the message of the file: no 1"),
        ("<link name='${lambda: 1}'/>", "the word \"lambda\", expected a value"),
        ("<xacro:property name='1a' value='1'/>", "found \"1a\", expected a name"),
        ("<xacro:element xacro:name='a b'/>", "found \"a b\", expected the name of a tag"),
    ];
    for (body, message) in cases {
        let body = body.replace("name='${xacro.fatal(\"no\", 1)}'", "name='${xacro.fatal(&quot;no&quot;, 1)}'");
        let base = if body.contains("<link") { "" } else { "<link name='base'/>" };
        let found = errors(&Files::default(), &format!("{base}{body}"));
        assert_eq!(found.len(), 1, "{body}: {found:#?}");
        assert!(found[0].starts_with("robots/urdf/arm.xacro:2: ") && found[0].contains(message), "{message}\n{found:#?}");
    }
}

#[test]
fn names_of_meshes_that_have_no_value_are_warnings() {
    let body = "<link name='base'><visual><geometry><mesh filename='$(find nothing)/a.stl'/></geometry></visual></link><xacro:property name='a' value='1'/>";
    let reading = expanded(&Files::default(), body, &[]);
    assert_eq!(reading.warnings.iter().map(|w| (w.code, w.line())).collect::<Vec<_>>(), [(Code::Xacro, Some(2))]);
}

#[test]
fn work_is_bounded() {
    let bodies = [
        // Texts, lists and documents that double.
        "<xacro:property name='a' value='x'/><xacro:macro name='m' params='a k'><xacro:if value='${k}'><xacro:m a='${a + a}' k='${k - 1}'/></xacro:if></xacro:macro><xacro:m a='xx' k='200'/>".to_owned(),
        "<xacro:property name='a' value='${[1] * 1000000}'/><link name='${sum([x for y in a for x in a])}'/><link name='${len([0 for x in a if sum(a)])}'/>".to_owned(),
        "<xacro:macro name='m' params='k'><link name='a'/><xacro:if value='${k}'><xacro:m k='${k - 1}'/><xacro:m k='${k - 1}'/></xacro:if></xacro:macro><xacro:m k='60'/>".to_owned(),
        "<xacro:include filename='self.xacro'/>".to_owned(),
        format!("<link name='${{{}1{}}}'/>", "(".repeat(5000), ")".repeat(5000)),
        format!("<link name='${{{}1}}'/>", "1 + ".repeat(900)),
        format!("<link name='${{{}1}}'/>", "-".repeat(5000)),
        format!("<link name='${{{}}}'/>", "[0]".repeat(5000)),
        (0..400).map(|k| format!("<xacro:property name='a{}' value='${{[a{k}, a{k}]}}'/>", k + 1)).collect::<String>() + "<xacro:property name='a0' value='1'/><link name='${a400}'/>",
        "<xacro:property name='a0' value='1'/>".to_owned() + &(0..400).map(|k| format!("<xacro:property name='a{}' value='${{[a{k}, a{k}]}}' lazy_eval='false'/>", k + 1)).collect::<String>() + "<link name='${a400 == a400}'/>",
        "<link name='${9**9**9}'/>".to_owned(),
    ];
    let files = Files::of(&[(
        "robots/urdf/self.xacro",
        "<robot><xacro:include filename='self.xacro'/><xacro:include filename='self.xacro'/></robot>",
    )]);
    for body in bodies {
        let found = result(&files, &format!("<link name='base'/>{body}"), &[]).unwrap_err();
        assert!(found.errors.len() < 1000 && !found.errors.is_empty(), "{found}");
    }
}

/// Pieces of documents in any order: an answer, and no panic.
#[test]
fn no_bytes_make_it_panic() {
    const PIECES: [&str; 30] = [
        "<xacro:macro name='m' params='a:=1 *b **c'>",
        "</xacro:macro>",
        "<xacro:m a='${x}'>",
        "</xacro:m>",
        "<xacro:m/>",
        "<xacro:property name='x' value='",
        "'/>",
        "${",
        "}",
        "$(",
        ")",
        "$",
        "x.y[0](1)",
        "[1, 2",
        "**",
        " if 1 else ",
        "<xacro:if value='1'>",
        "</xacro:if>",
        "<xacro:insert_block name='b'/>",
        "<link name='${x}'/>",
        "'é'",
        "-1:2",
        "load_yaml",
        "<xacro:include filename='*'/>",
        "<xacro:element xacro:name='link'/>",
        "<xacro:attribute name='a' value='${1}'/>",
        " for x in ",
        "%s % ",
        "\u{f0000}",
        "<xacro:call macro='m'/>",
    ];
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for _ in 0..3000 {
        let mut body = String::new();
        for _ in 0..12 {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            body.push_str(PIECES[(state % 30) as usize]);
        }
        let whole = format!(
            "<robot name='r'><link name='l'/><xacro:property name='x' value='1'/><link name='${{{}}}'/>{body}</robot>",
            body.replace(['<', '\'', '&'], "")
        );
        drop(read_with(&NoFiles, whole.as_bytes(), &options(&[])));
    }
}
