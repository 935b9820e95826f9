//! One robot at several levels of accuracy, each as a value of the trait in its own numbers.

articulated::robot! {
    mod single {
        urdf = "urdf/arm.urdf",
        functions = [inverse_dynamics],
        level = f32 + fast_7,
    }
}

articulated::robot! {
    mod exact {
        urdf = "urdf/arm.urdf",
        functions = [inverse_dynamics],
        level = double_double + no_fma,
    }
}

use articulated::Dynamics;

fn torques<S: articulated::Scalar, R: Dynamics<S> + Default>() -> Vec<S> {
    let robot = R::default();
    let nv = robot.shape().nv;
    let (q, zero) = (vec![S::from_f64(0.5); nv], vec![S::from_f64(0.0); nv]);
    let mut tau = zero.clone();
    robot.inverse_dynamics(&mut robot.workspace(), &q, &zero, &zero, &mut tau).unwrap();
    tau
}

fn main() {
    let (single, exact): (Vec<f32>, Vec<f64>) = (torques::<f32, single::Robot>(), torques::<f64, exact::Robot>());
    for (a, b) in single.iter().zip(&exact) {
        assert!((f64::from(*a) - b).abs() < 1e-5 * (1.0 + b.abs()), "{a} {b}");
    }
}
