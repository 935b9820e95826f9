//! A description as the text of a URDF: the way back from the reader.

use std::fmt::Write;

use articulated_core::description::{Description, Inertial, Joint, JointKind, Origin};

/// The URDF; of what a URDF has words for. Every number is printed so that reading gives the same double.
pub fn urdf_text(description: &Description) -> String {
    let mut out = format!("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", description.name);
    for link in &description.links {
        let _ = match &link.inertial {
            None => writeln!(out, "  <link name=\"{}\"/>", link.name),
            Some(i) => writeln!(out, "  <link name=\"{}\">\n{}  </link>", link.name, inertial(i)),
        };
    }
    for j in &description.joints {
        joint(&mut out, description, j);
    }
    out + "</robot>\n"
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
    format!("<origin xyz=\"{}\" rpy=\"{}\"/>", triple(o.xyz), triple(o.rpy))
}

fn triple([x, y, z]: [f64; 3]) -> String {
    format!("{x:?} {y:?} {z:?}")
}

fn joint(out: &mut String, description: &Description, j: &Joint) {
    let link = |l: usize| &description.links[l].name;
    let _ = writeln!(out, "  <joint name=\"{}\" type=\"{}\">", j.name, j.kind.name());
    let _ = writeln!(out, "    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n    {}", link(j.parent), link(j.child), origin(&j.origin));
    if j.kind.has_axis() {
        let _ = writeln!(out, "    <axis xyz=\"{}\"/>", triple(j.axis));
    }
    match j.kind {
        JointKind::Universal => drop(writeln!(out, "    <axis2 xyz=\"{}\"/>", triple(j.second_axis))),
        JointKind::Helical => drop(writeln!(out, "    <thread pitch=\"{:?}\"/>", j.pitch)),
        _ => {}
    }
    if let Some(l) = &j.limit {
        let _ = writeln!(
            out,
            "    <limit lower=\"{:?}\" upper=\"{:?}\" effort=\"{:?}\" velocity=\"{:?}\"/>",
            l.lower, l.upper, l.effort, l.velocity
        );
    }
    if let Some(m) = &j.mimic {
        let leader = &description.joints[m.joint].name;
        let _ = writeln!(out, "    <mimic joint=\"{leader}\" multiplier=\"{:?}\" offset=\"{:?}\"/>", m.multiplier, m.offset);
    }
    *out += "  </joint>\n";
}
