//! Code over the trait runs on the generated robot and on the one that is loaded at run time.

use articulated::{Base, Dynamics, FunctionError};

articulated::robot! {
    mod arm {
        urdf = "urdf/arm.urdf",
        functions = [inverse_dynamics],
    }
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

    let short = arm::Robot.inverse_dynamics(&mut (), &[0.0], &[0.0; 2], &[0.0; 2], &mut [0.0; 2]);
    assert_eq!(short, Err(FunctionError::Length { argument: "q", found: 1, expected: 2 }));
    let absent = arm::Robot.gravity_torque(&mut (), &[0.0; 2], &mut [0.0; 2]);
    assert_eq!(absent, Err(FunctionError::NotGenerated { function: "gravity_torque" }));
}
