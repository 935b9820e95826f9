//! Common parts of the heads of generated files in all languages: printing of text, and the list of
//! warnings.

use articulated_core::diagnostic::{Diagnostic, Span, summary};

/// Largest number of warnings in a head.
const LISTED: usize = 20;

/// A longer line is cut, in characters.
const LONGEST: usize = 200;

/// The name of a file without its folder, so that the same robot gives the same bytes anywhere.
pub(crate) fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or_default()
}

/// The warnings as lines of a head, below their heading: a line for each sort, with the name of the
/// file but not its folder. Empty where there are none.
pub(crate) fn of_warnings(warnings: &[Diagnostic]) -> Vec<String> {
    let without_folder = |warning: &Diagnostic| {
        let file = file_name(warning.file()).to_owned();
        Diagnostic { span: Span { file, ..warning.span }, ..warning.clone() }
    };
    let all = summary(&warnings.iter().map(without_folder).collect::<Vec<_>>());
    let mut lines: Vec<String> = all.iter().take(LISTED).map(|line| format!("  {}", short(line))).collect();
    if all.len() > LISTED {
        lines.push(format!("  and {} more: `articulated check` lists them all.", all.len() - LISTED));
    }
    if !lines.is_empty() {
        lines.insert(0, "Warnings about the robot:".to_owned());
    }
    lines
}

/// The line, or its beginning.
fn short(line: &str) -> String {
    if line.chars().count() <= LONGEST { line.to_owned() } else { line.chars().take(LONGEST - 1).chain(['…']).collect() }
}

/// Text that stays inside its comment and remains readable: unprintable characters are escaped.
pub(crate) fn printable(text: &str) -> String {
    text.chars().map(|c| if matches!(c, '"' | '\'' | '\\') { c.to_string() } else { c.escape_debug().to_string() }).collect()
}

#[cfg(test)]
mod tests {
    use articulated_core::diagnostic::{At, Code, Place, Subject};

    use super::*;

    fn warning(file: &str, field: &str, found: &str) -> Diagnostic {
        let place = Place { at: At::line_of(3), subject: &Subject::Link("tip".into()), field };
        Diagnostic::error(file, place, Code::Units, found, "less").into_warning()
    }

    #[test]
    fn nothing_gets_out_of_a_comment() {
        assert_eq!(printable("a\nfn b() {}\r \u{202e}\"é\""), "a\\nfn b() {}\\r \\u{202e}\"é\"");
    }

    #[test]
    fn a_head_has_warnings_without_folders_and_of_bounded_length() {
        assert_eq!(of_warnings(&[]), [""; 0]);
        let told = of_warnings(&[warning("/home/me/arm.urdf", "mass", "2"), warning("C:\\me\\arm.urdf", "mass", "3")]);
        let expected = ["Warnings about the robot:", "  arm.urdf:3: link \"tip\": mass: found 2, expected less (and 1 more: link \"tip\")"];
        assert_eq!(told, expected);
        let long = of_warnings(&[warning("arm.urdf", "mass", &"é".repeat(400))]);
        assert_eq!((long[1].chars().count(), long[1].ends_with("éé…")), (LONGEST + 2, true), "{long:?}");
        let many: Vec<Diagnostic> = (0..50).map(|k| warning("arm.urdf", &format!("mass{k}"), "2")).collect();
        let told = of_warnings(&many);
        assert_eq!((told.len(), told[LISTED + 1].as_str()), (LISTED + 2, "  and 30 more: `articulated check` lists them all."));
    }

    /// A link whose moments miss the triangle inequality; `extent` is the largest of them.
    fn head(target: crate::Target, extent: f64) -> String {
        let urdf = format!(
            "<robot name='arm'><link name='base'/>
            <link name='*/tip'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='{extent}'/></inertial></link>
            <joint name='hinge' type='continuous'><parent link='base'/><child link='*/tip'/><axis xyz='0 1 0'/></joint></robot>"
        );
        let mut request = crate::Request::new("some/folder/arm.urdf", urdf);
        request.options.target = target;
        let files = crate::generate(&request).unwrap_or_else(|e| panic!("{e}")).files;
        files.iter().map(|file| file.text.lines().take(16).collect::<Vec<_>>().join("\n")).collect::<Vec<_>>().join("\n\n")
    }

    #[test]
    fn heads_of_rust_and_of_c_list_the_warnings_if_there_are_any() {
        for target in crate::Target::all() {
            let (odd, even) = (head(target.clone(), 3.0), head(target.clone(), 1.5));
            let files = if target.name() == "c" { 2 } else { 1 };
            let told = "arm.urdf:2: link \"* /tip\": inertia: found ";
            let told = if target.name() == "c" { told.to_owned() } else { told.replace("* /", "*/") };
            assert_eq!(odd.matches("Warnings about the robot:").count(), files, "{odd}");
            assert_eq!(odd.lines().filter(|line| line.contains(&told) && !line.contains("folder")).count(), files, "{odd}");
            // The other lines are those of a robot without warnings.
            let others = |text: &str| {
                text.lines()
                    .skip(1)
                    .filter(|line| !line.contains("arm.urdf:2") && !line.contains("Warnings"))
                    .map(str::to_owned)
                    .collect::<Vec<_>>()
            };
            assert!(!even.contains("Warnings about") && others(&odd).iter().take(4).eq(others(&even).iter().take(4)), "{even}");
        }
    }
}
