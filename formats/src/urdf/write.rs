//! A description as the text of a URDF: the reverse of the reader.

use std::fmt::Write;

use articulated_core::description::{Description, Inertial, Joint, JointKind, LinkId, Origin};

/// The robot as a URDF, without collision geometry, appearance, and dampings and stiffnesses of
/// higher degree, which a URDF does not have. Every number is printed so that the same double is
/// read again.
///
/// A URDF has no follower by a polynomial either. Its coefficients of the powers 2 to 4 are written
/// as the attribute `higher` of `<mimic>`, so that [`read`](crate::read) refuses the file.
#[must_use]
pub fn write(description: &Description) -> String {
    let version = if description.joints.iter().any(needs_version_1_2) { " version=\"1.2\"" } else { "" };
    let mut out = format!("<?xml version=\"1.0\"?>\n<robot name=\"{}\"{version}>\n", escaped(&description.name));
    for link in &description.links {
        let name = escaped(&link.name);
        let _ = match &link.inertial {
            None => writeln!(out, "  <link name=\"{name}\"/>"),
            Some(i) => writeln!(out, "  <link name=\"{name}\">\n{}  </link>", inertial(i)),
        };
    }
    for j in &description.joints {
        joint(&mut out, description, j);
    }
    description.joints.iter().for_each(|j| forces(&mut out, j));
    out + "</robot>\n"
}

/// Whether a missing bound would be zero in older versions, or a given bound does not exist there.
fn needs_version_1_2(joint: &Joint) -> bool {
    let Some(limit) = joint.limit else { return false };
    let is_open = joint.kind.has_bounds() && !(limit.lower.is_finite() && limit.upper.is_finite());
    is_open || [limit.acceleration, limit.deceleration, limit.jerk].iter().any(|limit| limit.is_finite())
}

/// Forces of a joint outside its tag: the inertia of a rotor without a gear, and a spring.
fn forces(out: &mut String, joint: &Joint) {
    let name = escaped(&joint.name);
    if let Some(armature) = joint.dynamics.armature {
        let _ = writeln!(
            out,
            "  <transmission name=\"{name}\">\n    <type>transmission_interface/SimpleTransmission</type>\n    <joint name=\"{name}\"/>\n    \
             <actuator name=\"{name}\"><mechanicalReduction>1</mechanicalReduction><motorInertia>{armature:?}</motorInertia></actuator>\n  \
             </transmission>"
        );
    }
    if let Some(stiffness) = joint.dynamics.stiffness {
        let rest = joint.dynamics.rest.map(|rest| format!("<springReference>{rest:?}</springReference>")).unwrap_or_default();
        let _ = writeln!(out, "  <gazebo reference=\"{name}\"><springStiffness>{stiffness:?}</springStiffness>{rest}</gazebo>");
    }
}

/// The text of an attribute.
fn escaped(name: &str) -> String {
    name.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

fn inertial(i: &Inertial) -> String {
    let [xx, xy, xz, yy, yz, zz] = i.inertia;
    format!(
        "    <inertial>\n      {}\n      <mass value=\"{:?}\"/>\n      <inertia ixx=\"{xx:?}\" ixy=\"{xy:?}\" ixz=\"{xz:?}\" \
         iyy=\"{yy:?}\" iyz=\"{yz:?}\" izz=\"{zz:?}\"/>\n    </inertial>\n",
        origin(&i.origin),
        i.mass
    )
}

fn origin(o: &Origin) -> String {
    format!("<origin xyz=\"{}\" rpy=\"{}\"/>", triple(o.xyz), triple(o.rotation.rpy()))
}

fn triple([x, y, z]: [f64; 3]) -> String {
    format!("{x:?} {y:?} {z:?}")
}

fn joint(out: &mut String, description: &Description, j: &Joint) {
    let link = |l: LinkId| escaped(&description.links[l].name);
    let _ = writeln!(out, "  <joint name=\"{}\" type=\"{}\">", escaped(&j.name), j.kind.name());
    let _ = writeln!(out, "    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n    {}", link(j.parent), link(j.child), origin(&j.origin));
    if j.kind.has_axis() {
        let _ = writeln!(out, "    <axis xyz=\"{}\"/>", triple(j.axis));
    }
    match j.kind {
        JointKind::Universal => drop(writeln!(out, "    <axis2 xyz=\"{}\"/>", triple(j.second_axis))),
        JointKind::Helical => drop(writeln!(out, "    <thread pitch=\"{:?}\"/>", j.pitch)),
        _ => {}
    }
    // A ball joint has no limit in a URDF.
    if let Some(l) = j.limit.as_ref().filter(|_| j.kind != JointKind::Spherical) {
        // An attribute that is missing is infinite.
        let attribute = |(name, x): (&str, f64)| if x.is_finite() { format!(" {name}=\"{x:?}\"") } else { String::new() };
        let all = [
            ("lower", l.lower),
            ("upper", l.upper),
            ("effort", l.effort),
            ("velocity", l.velocity),
            ("acceleration", l.acceleration),
            ("deceleration", l.deceleration),
            ("jerk", l.jerk),
        ];
        let _ = writeln!(out, "    <limit{}/>", all.map(attribute).concat());
    }
    if j.dynamics.damping.is_some() || j.dynamics.friction.is_some() {
        let [damping, friction] = [j.dynamics.damping, j.dynamics.friction].map(Option::unwrap_or_default);
        let _ = writeln!(out, "    <dynamics damping=\"{damping:?}\" friction=\"{friction:?}\"/>");
    }
    for m in j.mimic.iter().chain(&j.also) {
        let leader = escaped(&description.joints[m.joint].name);
        let higher = m.law().higher.map(|higher| format!(" higher=\"{higher:?}\"")).unwrap_or_default();
        let _ = writeln!(out, "    <mimic joint=\"{leader}\" multiplier=\"{:?}\" offset=\"{:?}\"{higher}/>", m.multiplier, m.offset);
    }
    *out += "  </joint>\n";
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Options, read};

    const ROBOT: &str = "<robot name='a &amp; b'><link name='base'/><link name='&lt;tip&gt;'><inertial><origin xyz='0.1 0.2 0.3' rpy='0.1 0 0'/>\
        <mass value='0.30000000000000004'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\
        <link name='finger'/><link name='thumb'/><link name='cup'/>\
        <joint name='hinge' type='revolute'><parent link='base'/><child link='&lt;tip&gt;'/><origin xyz='0 0 1e-3'/><axis xyz='0 0.6 0.8'/>\
        <limit lower='-1' upper='2' effort='3' velocity='4'/><dynamics damping='0.1' friction='0.2'/></joint>\
        <joint name='slide' type='prismatic'><parent link='&lt;tip&gt;'/><child link='finger'/><limit lower='0' upper='1' effort='1' velocity='1'/></joint>\
        <joint name='follow' type='prismatic'><parent link='&lt;tip&gt;'/><child link='thumb'/><limit lower='0' upper='1' effort='1' velocity='1'/>\
        <mimic joint='slide' multiplier='-0.5' offset='0.1'/></joint>\
        <joint name='cardan' type='universal'><parent link='thumb'/><child link='cup'/><axis xyz='1 0 0'/><axis2 xyz='0 1 0'/></joint></robot>";

    #[test]
    fn a_follower_by_a_polynomial_is_not_read_back_as_a_linear_one() {
        let mut description = read(ROBOT.as_bytes(), &Options::default()).unwrap().description;
        let follow = description.joint("follow").unwrap();
        description.joints[follow].mimic.iter_mut().for_each(|mimic| mimic.higher = [0.1, 0.0, 0.0]);
        let error = read(write(&description).as_bytes(), &Options::default()).unwrap_err().to_string();
        assert!(error.contains("follow") && error.contains("higher"), "{error}");
    }

    #[test]
    fn what_is_written_is_read_back() {
        let description = read(ROBOT.as_bytes(), &Options::default()).unwrap().description;
        let text = write(&description);
        assert_eq!(read(text.as_bytes(), &Options::default()).unwrap_or_else(|e| panic!("{e}\n{text}")).description, description);
    }
}
