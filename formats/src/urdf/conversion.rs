//! Conversion from and to [`urdf_rs::Robot`].

use std::fmt;

use ::urdf_rs::{Robot, UrdfError, read_from_string, write_to_string};
use articulated_core::description::Description;

use articulated_core::diagnostic::Diagnostics;

use super::write;
use crate::{Options, Reading, read};

/// Why a robot cannot be converted.
#[derive(Debug)]
pub enum ConversionError {
    /// All errors of the robot of `urdf-rs`.
    Diagnostics(Diagnostics),
    /// `urdf-rs` has no word for this, as for helical and universal joints.
    UrdfRs(UrdfError),
}

impl fmt::Display for ConversionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diagnostics(problems) => problems.fmt(f),
            Self::UrdfRs(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ConversionError {}

/// The robot that `urdf-rs` has read, checked like a file. `urdf-rs` does not distinguish a link
/// without `<inertial>` from one with zero mass and inertia.
///
/// # Errors
/// All errors of the robot.
pub fn from_urdf_rs(robot: &Robot, options: &Options) -> Result<Reading, ConversionError> {
    let text = write_to_string(robot).map_err(ConversionError::UrdfRs)?;
    read(text.as_bytes(), options).map_err(ConversionError::Diagnostics)
}

/// The robot in the form of `urdf-rs`, without collision geometry and appearance.
///
/// # Errors
/// Joints of a type that `urdf-rs` does not know.
pub fn to_urdf_rs(description: &Description) -> Result<Robot, ConversionError> {
    read_from_string(&write(description)).map_err(ConversionError::UrdfRs)
}

#[cfg(test)]
mod tests {
    use articulated_core::description::{JointId, LinkId};

    use super::*;

    const ROBOT: &str = "<robot name='door'><link name='frame'/><link name='leaf'><inertial><origin xyz='0.4 0 0.1'/><mass value='0.30000000000000004'/>\
        <inertia ixx='1' ixy='0.1' ixz='0' iyy='1' iyz='0' izz='0.2'/></inertial></link>\
        <joint name='hinge' type='revolute'><parent link='frame'/><child link='leaf'/><origin xyz='0 0 1' rpy='0.1 0.2 0.3'/><axis xyz='0 0 1'/>\
        <limit lower='-1' upper='2' effort='3' velocity='4'/></joint></robot>";

    #[test]
    fn a_robot_goes_there_and_back() {
        let description = read(ROBOT.as_bytes(), &Options::default()).unwrap().description;
        let robot = to_urdf_rs(&description).unwrap();
        assert_eq!((robot.links.len(), robot.joints[0].limit.upper), (2, 2.0));
        let mut back = from_urdf_rs(&robot, &Options::default()).unwrap().description;
        // A link without <inertial> comes back with one of zeros.
        back.links[LinkId(0)].inertial = None;
        back.joints[JointId(0)].dynamics = description.joints[JointId(0)].dynamics;
        assert_eq!(back, description);
    }

    #[test]
    fn mistakes_of_a_robot_are_errors_here_too() {
        let mut robot = read_from_string(ROBOT).unwrap();
        robot.links[1].inertial.mass.value = -1.0;
        let told = from_urdf_rs(&robot, &Options::default()).unwrap_err().to_string();
        assert!(told.contains("a negative mass, -1 kg"), "{told}");
        let universal = ROBOT.replace("revolute", "universal").replace("<axis xyz='0 0 1'/>", "<axis xyz='0 0 1'/><axis2 xyz='1 0 0'/>");
        let description = read(universal.as_bytes(), &Options::default()).unwrap().description;
        assert!(matches!(to_urdf_rs(&description), Err(ConversionError::UrdfRs(_))));
    }
}
