//! Edits of a robot as words of the command line.

use std::ffi::OsStr;
use std::path::PathBuf;

use articulated_core::description::{Coupling, Origin, Payload};
use articulated_core::spatial::Reference;
use clap::Args;
use clap::builder::{OsStringValueParser, TypedValueParser};

use crate::table::counted;

/// What to do to the robot before anything else: append, then attach, then lock.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct Edits {
    /// Append another robot on a link, or on a frame such as a site; may be given several times.
    /// The placement of its root in that frame: 0 if left out
    #[arg(long, value_name = "FILE@LINK[:PREFIX[:X,Y,Z[,ROLL,PITCH,YAW]]]", value_parser = OsStringValueParser::new().try_map(|text| appended(&text)))]
    pub(crate) append: Vec<Appended>,
    /// Attach a load, kg, to a link or frame: its centre of mass in m, its inertia about that in
    /// kg·m²; may be given several times
    #[arg(long, value_name = "LINK=MASS[@X,Y,Z[:XX,XY,XZ,YY,YZ,ZZ]]", value_parser = payload)]
    pub(crate) payload: Vec<Payload>,
    /// Let a joint follow others: its coordinate is the sum of coefficient times coordinate of
    /// each, and the offset; may be given several times. The word `file`: joints follow as linear
    /// equations of the robot's file, and of those appended, say (MJCF)
    #[arg(long, value_name = "JOINT=LEADER:COEFFICIENT[,…][,OFFSET]|file", value_parser = coupling)]
    pub(crate) coupling: Vec<CouplingArgument>,
    /// Lock a joint at its coordinates (rad or m; a quaternion as x,y,z,w); may be given several
    /// times. Links that nothing moves any more count as the base's: energy and centre of mass are
    /// of the links that move
    #[arg(long, value_name = "JOINT=VALUE[,VALUE…]", value_parser = lock)]
    pub(crate) lock: Vec<Lock>,
}

/// Which frames, and what is given in them.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct FrameArguments {
    /// The links whose frames functions give, in this order
    /// [default: all, in the order of the file]
    #[arg(long, value_name = "LINKS", value_delimiter = ',')]
    pub(crate) frames: Vec<String>,
    /// What the wrenches that functions take refer to: body, world or world_aligned [default: body]
    #[arg(long, value_name = "REFERENCE", value_parser = reference)]
    pub(crate) wrenches_in: Option<Reference>,
}

/// A joint and its coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lock {
    pub(crate) joint: String,
    pub(crate) at: Vec<f64>,
}

/// A robot to append, by its file or its bundled name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Appended {
    pub(crate) file: PathBuf,
    pub(crate) at: String,
    pub(crate) prefix: String,
    pub(crate) origin: Origin,
}

fn reference(text: &str) -> Result<Reference, String> {
    let all = [Reference::Body, Reference::World, Reference::WorldAligned];
    all.into_iter().find(|r| r.name() == text.replace('-', "_")).ok_or_else(|| "expected body, world or world_aligned".into())
}

fn lock(text: &str) -> Result<Lock, String> {
    // The last `=`: a name may contain one, a number does not.
    let (joint, at) = text.rsplit_once('=').ok_or("expected JOINT=VALUE, as elbow=0.5")?;
    Ok(Lock { joint: joint.to_owned(), at: numbers(at)? })
}

/// How joints follow others.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum CouplingArgument {
    /// As the robot's file says.
    File,
    /// One joint.
    Joint(Coupling),
}

fn coupling(text: &str) -> Result<CouplingArgument, String> {
    if text == "file" {
        return Ok(CouplingArgument::File);
    }
    const EXPECTED: &str =
        "expected JOINT=LEADER:COEFFICIENT,LEADER:COEFFICIENT, as pitch=m1:0.5,m2:-0.5, with an offset at the end if there is one";
    let (joint, rest) = text.split_once('=').ok_or(EXPECTED)?;
    let mut coupling = Coupling { joint: joint.to_owned(), ..Coupling::default() };
    let mut terms: Vec<&str> = rest.split(',').collect();
    if let Some(last) = terms.last().filter(|last| !last.contains(':')) {
        [coupling.offset] = exactly(last, "one number for the offset")?;
        terms.pop();
    }
    for term in terms {
        let (leader, coefficient) = term.rsplit_once(':').ok_or(EXPECTED)?;
        let [coefficient] = exactly(coefficient, "one number for the coefficient")?;
        coupling.leaders.push((leader.to_owned(), coefficient));
    }
    if coupling.leaders.is_empty() { Err(EXPECTED.to_owned()) } else { Ok(CouplingArgument::Joint(coupling)) }
}

fn payload(text: &str) -> Result<Payload, String> {
    let (link, load) = text.rsplit_once('=').ok_or("expected LINK=MASS, as tool=1.2, or LINK=MASS@X,Y,Z, as tool=1.2@0,0,0.1")?;
    let (mass, rest) = load.split_once('@').unwrap_or((load, "0,0,0"));
    let (center, inertia) = rest.split_once(':').unwrap_or((rest, "0,0,0,0,0,0"));
    let [mass] = exactly(mass, "one number of kg")?;
    let center_of_mass = exactly(center, "three numbers of m for the centre of mass")?;
    let inertia = exactly(inertia, "six numbers of kg·m² for the inertia: xx, xy, xz, yy, yz, zz")?;
    Ok(Payload { link: link.to_owned(), name: None, mass, center_of_mass, inertia })
}

fn appended(text: &OsStr) -> Result<Appended, String> {
    let (file, rest) = split(text).ok_or("expected FILE@LINK, as gripper.urdf@tool, or FILE@LINK:PREFIX")?;
    let mut parts = rest.splitn(3, ':');
    let [at, prefix] = [(); 2].map(|()| parts.next().unwrap_or_default().to_owned());
    let origin = parts.next().map_or_else(|| Ok(Origin::default()), origin)?;
    if at.is_empty() || file.as_os_str().is_empty() {
        return Err("expected FILE@LINK, as gripper.urdf@tool".into());
    }
    Ok(Appended { file, at, prefix, origin })
}

/// The file before the last `@`, and the text after it. A path need not be UTF-8, but a name must
/// be.
fn split(text: &OsStr) -> Option<(PathBuf, String)> {
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStrExt;
        let bytes = text.as_bytes();
        let at = bytes.iter().rposition(|byte| *byte == b'@')?;
        Some((OsStr::from_bytes(&bytes[..at]).into(), str::from_utf8(&bytes[at + 1..]).ok()?.to_owned()))
    }
    #[cfg(not(unix))]
    {
        let (file, rest) = text.to_str()?.rsplit_once('@')?;
        Some((file.into(), rest.to_owned()))
    }
}

fn origin(text: &str) -> Result<Origin, String> {
    match *numbers(text)?.as_slice() {
        [x, y, z] => Ok(Origin { xyz: [x, y, z], ..Origin::default() }),
        [x, y, z, roll, pitch, yaw] => Ok(Origin::new([x, y, z], [roll, pitch, yaw])),
        _ => Err("expected X,Y,Z in m, or X,Y,Z,ROLL,PITCH,YAW in m and rad".into()),
    }
}

fn exactly<const N: usize>(text: &str, expected: &str) -> Result<[f64; N], String> {
    let found = numbers(text)?;
    let count = found.len();
    found.try_into().map_err(|_| format!("found {}, expected {expected}", counted(count, "number")))
}

fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let number = |word: &str| word.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    text.split(',').map(|word| number(word).ok_or_else(|| format!("found {word:?}, expected a finite number"))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coupling_is_a_name_and_leaders_with_coefficients() {
        let leaders = vec![("m1".to_owned(), 0.5), ("m:2".to_owned(), -0.5)];
        let expected = Coupling { joint: "pitch".into(), leaders, offset: 0.1, ..Coupling::default() };
        assert_eq!(coupling("pitch=m1:0.5,m:2:-0.5,0.1"), Ok(CouplingArgument::Joint(expected.clone())));
        assert_eq!(coupling("pitch=m1:0.5,m:2:-0.5"), Ok(CouplingArgument::Joint(Coupling { offset: 0.0, ..expected })));
        assert_eq!(coupling("file"), Ok(CouplingArgument::File));
        assert!(["pitch", "pitch=", "pitch=0.1", "pitch=m1:x", "pitch=m1,m2:1"].into_iter().all(|text| coupling(text).is_err()));
    }

    #[test]
    fn a_lock_is_a_name_and_numbers() {
        assert_eq!(lock("elbow=-0.5"), Ok(Lock { joint: "elbow".into(), at: vec![-0.5] }));
        assert_eq!(lock("a=b=0, 0,0,1"), Ok(Lock { joint: "a=b".into(), at: vec![0.0, 0.0, 0.0, 1.0] }));
        assert!(lock("elbow").is_err() && lock("elbow=").is_err() && lock("elbow=nan").is_err());
    }

    #[test]
    fn numbers_of_the_command_line_are_the_nearest_doubles() {
        use crate::states::exact::{doubles, spellings};
        for x in doubles() {
            for text in spellings(x) {
                assert_eq!(numbers(&text).unwrap()[0].to_bits(), x.to_bits(), "{text}");
                let gravity = crate::arguments::gravity(&format!("{text},0,{text}")).unwrap().0;
                assert_eq!(gravity.map(f64::to_bits), [x, 0.0, x].map(f64::to_bits), "{text}");
            }
        }
    }

    #[test]
    fn a_payload_is_a_link_a_mass_and_what_else_is_known() {
        let point = Payload { link: "tool".into(), mass: 1.2, ..Payload::default() };
        assert_eq!(payload("tool=1.2"), Ok(point.clone()));
        assert_eq!(payload("tool=1.2@0,0,0.1"), Ok(Payload { center_of_mass: [0.0, 0.0, 0.1], ..point.clone() }));
        let body = Payload { center_of_mass: [0.0, 0.0, 0.1], inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 2.0], ..point };
        assert_eq!(payload("tool=1.2@0,0,0.1:1,0,0,1,0,2"), Ok(body));
        assert!(payload("tool=1.2@0,0").unwrap_err().contains("found 2 numbers, expected three"));
        assert!(payload("tool").is_err() && payload("tool=x").is_err());
    }

    #[test]
    fn an_appended_robot_is_a_file_a_link_and_what_else_is_known() {
        let appended = |text: &str| super::appended(OsStr::new(text));
        let plain = Appended { file: "a@b/gripper.urdf".into(), at: "tool".into(), prefix: String::new(), origin: Origin::default() };
        assert_eq!(appended("a@b/gripper.urdf@tool"), Ok(plain.clone()));
        let placed = Appended { prefix: "left_".into(), origin: Origin::new([0.0, 0.0, 0.1], [0.0, 0.0, 1.5]), ..plain.clone() };
        assert_eq!(appended("a@b/gripper.urdf@tool:left_:0,0,0.1,0,0,1.5"), Ok(placed.clone()));
        let straight = Appended { prefix: String::new(), origin: Origin::at(placed.origin.xyz), ..placed };
        assert_eq!(appended("a@b/gripper.urdf@tool::0,0,0.1"), Ok(straight));
        assert!(appended("gripper.urdf").is_err() && appended("gripper.urdf@").is_err() && appended("g@l:p:1,2").is_err());
    }

    #[test]
    fn a_reference_has_three_names() {
        assert_eq!(["body", "world", "world-aligned"].map(|x| reference(x).unwrap().name()), ["body", "world", "world_aligned"]);
        assert!(reference("base").is_err());
    }
}
