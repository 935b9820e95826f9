//! Code over the trait runs on the generated robot and on the one that is loaded at run time.

use articulated::{Base, Dynamics, FunctionError, FunctionId};

articulated::robot! {
    mod arm {
        urdf = "urdf/arm.urdf",
        functions = [inverse_dynamics],
    }
}

articulated::robot! {
    mod free {
        urdf = "urdf/arm.urdf",
        base = floating,
        functions = [gravity_torque],
        level = f32,
    }
}

/// Joints and frames have the same numbers and names as those of the loaded robot.
fn names<S: articulated::Scalar, G: Dynamics<S>, L: Dynamics<f64>>(generated: &G, loaded: &L) {
    let mut count = 0;
    while let Some(joint) = loaded.joint(count) {
        assert_eq!(generated.joint(count), Some(joint));
        assert_eq!(generated.joint_named(joint.name), Some(joint));
        assert!(
            (joint.v.0..joint.v.0 + joint.v.1).all(|k| generated.joint_of(k) == Some(joint.name) && loaded.joint_of(k) == Some(joint.name))
        );
        count += 1;
    }
    assert!(count > 1 && generated.joint(count).is_none() && generated.joint_named("none").is_none());
    for k in 0..loaded.shape().frames {
        let name = loaded.frame_name(k).unwrap();
        assert_eq!((generated.frame_name(k), generated.frame_named(name), loaded.frame_named(name)), (Some(name), Some(k), Some(k)));
    }
    assert!(generated.frame_name(loaded.shape().frames).is_none() && generated.frame_named("none").is_none());
}

fn torque<R: Dynamics>(robot: &R) -> [f64; 2] {
    let mut tau = [0.0; 2];
    robot.inverse_dynamics(&mut robot.workspace(), &[0.3, -0.7], &[1.0, 2.0], &[-3.0, 0.5], &mut tau).unwrap();
    tau
}

fn main() {
    let loaded = articulated::load(concat!(env!("CARGO_MANIFEST_DIR"), "/urdf/arm.urdf"), Base::Fixed).unwrap();
    let (generated, generic) = (torque(&arm::Robot), torque(&loaded));
    assert!(generated.iter().zip(generic).all(|(a, b)| (a - b).abs() < 1e-12), "{generated:?} {generic:?}");
    assert_eq!((arm::Robot.name(), arm::Robot.shape()), (Dynamics::name(&loaded), Dynamics::shape(&loaded)));

    names(&arm::Robot, &loaded);
    names(&free::Robot, &articulated::load(concat!(env!("CARGO_MANIFEST_DIR"), "/urdf/arm.urdf"), Base::Floating).unwrap());

    let short = arm::Robot.inverse_dynamics(&mut (), &[0.0], &[0.0; 2], &[0.0; 2], &mut [0.0; 2]);
    assert_eq!(short, Err(FunctionError::Length { argument: "q", found: 1, expected: 2 }));
    let few = arm::Robot.call(FunctionId::inverse_dynamics, &mut (), &[&[0.0; 2]], &mut [0.0; 2]);
    assert_eq!(few, Err(FunctionError::Arguments { function: "inverse_dynamics", found: 1, expected: 3 }));
    let absent = arm::Robot.gravity_torque(&mut (), &[0.0; 2], &mut [0.0; 2]);
    assert_eq!(absent, Err(FunctionError::NotGenerated { function: "gravity_torque" }));
}
