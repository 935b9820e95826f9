//! Masses that differ by many powers of ten, and zero masses.

use articulated_core::description::{Base, JointKind, Origin};
use articulated_core::index::BodyId;

use super::Effort;
use crate::stress::judge::{BACKWARD, Ends, Judge, State};
use crate::stress::robots::{Body, Builder, arm, built, cardan, rods, state, states};
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "masses";

const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];
const X: [f64; 3] = [1.0, 0.0, 0.0];

pub(super) fn rows(_: Effort) -> Vec<Row> {
    let mut rows = Vec::new();
    for exponent in [-30, -15, -9, 9, 15, 30] {
        rows.extend(ratio(exponent));
    }
    rows.extend(massless_amid());
    rows.extend(massless_tip());
    rows.extend(tiny());
    rows.extend(thin_aligned());
    rows.extend(repeated());
    rows.extend(nearly_repeated());
    rows
}

fn ratio(exponent: i32) -> Vec<Row> {
    let case = Case::new(
        NAME,
        format!("tip of 1e{exponent} times the mass of the rest"),
        "a sum of inertias forgets the smaller one, and elimination may need it again",
    );
    let model = built(&arm([1.0, 1.0, 10.0_f64.powi(exponent)]), Base::Fixed);
    let states = states(&model, 4, 11, 1.0);
    let mut rows = Judge::<f64>::new(&case, &model).all(&states, Ends::Solved, BACKWARD);
    if exponent.abs() <= 15 {
        rows.extend(Judge::<f32>::new(&case, &model).all(&states, Ends::Solved, BACKWARD));
    }
    let case = Case::new(
        NAME,
        format!("middle link of 1e{exponent} times the mass of the rest"),
        "what a link in the middle has for itself is lost in what it carries, or the other way round",
    );
    let model = built(&arm([1.0, 10.0_f64.powi(exponent), 1.0]), Base::Fixed);
    rows.extend(Judge::<f64>::new(&case, &model).all(&states, Ends::Solved, BACKWARD));
    rows
}

fn massless_amid() -> Vec<Row> {
    let case = Case::new(NAME, "a link without mass in the middle", "its own pivot consists of what its child hands on alone");
    let model = built(&cardan(), Base::Fixed);
    let states = states(&model, 4, 12, 1.0);
    let mut rows = Judge::<f64>::new(&case, &model).all(&states, Ends::Solved, BACKWARD);
    rows.extend(Judge::<f32>::new(&case, &model).all(&states, Ends::Solved, BACKWARD));
    rows
}

fn massless_tip() -> Vec<Row> {
    let case = Case::new(
        NAME,
        "a link without mass at the tip",
        "its joint moves nothing: forward dynamics is not defined, and 0/0 is not an answer",
    );
    let body = Some(Body::rod(1.0, 1.0, 0.1));
    let model = Builder::new("bare").turn(Y, [0.0; 3], body).turn(Y, [1.0, 0.0, 0.0], None).model();
    let states = states(&model, 2, 13, 1.0);
    let mut rows = Judge::<f64>::new(&case, &model).all(&states, Ends::Singular("joint_2"), BACKWARD);
    rows.extend(Judge::<f32>::new(&case, &model).solved(&states, Ends::Singular("joint_2"), BACKWARD));
    rows.push(case.holds("massless_joints names it", model.massless_joints() == [BodyId(2)]));
    rows
}

fn tiny() -> Vec<Row> {
    let mut rows = Vec::new();
    for exponent in [-290, -300] {
        let case = Case::new(NAME, format!("all masses 1e{exponent} kg"), "squares of moments of inertia underflow");
        let m = 10.0_f64.powi(exponent);
        let model = built(&arm([m, m, m]), Base::Fixed);
        rows.extend(Judge::<f64>::new(&case, &model).all(&states(&model, 3, 14, m), Ends::Solved, BACKWARD));
    }
    let case =
        Case::new(NAME, "masses of 1e-310 kg, rates and angles of 1e-310", "denormal numbers have fewer digits the smaller they are");
    let model = built(&arm([1e-310; 3]), Base::Fixed);
    let small = State { q: vec![5e-324, 1e-310, -1e-310], v: vec![1e-310; 3], a: vec![1e-310; 3], tau: vec![0.0; 3] };
    rows.extend(denormal(&case, &model, &small));
    rows
}

/// Only checks that results are finite, and accurate to the spacing of denormal numbers.
fn denormal(case: &Case, model: &articulated_core::model::Model<f64>, state: &State) -> Vec<Row> {
    use crate::stress::judge::call;
    use articulated_core::algorithm::FunctionId;
    let tau = call(FunctionId::inverse_dynamics, model, &[state.q.clone(), state.v.clone(), state.a.clone()]);
    let finite = tau.iter().all(|x| x.is_finite());
    vec![case.holds("inverse_dynamics is finite, f64", finite)]
}

/// Rods without any inertia about their own axis: in a straight row of them, a turn about the
/// common axis moves no mass.
fn thin_aligned() -> Vec<Row> {
    let rod = Some(Body::rod(1.0, 1.0, 0.0));
    let model = built(&rods(), Base::Fixed);
    let at = |bend: f64| vec![state(vec![0.4, bend, 0.0], 3, 15, 1.0), state(vec![-1.9, 0.0, bend], 3, 16, 1.0)];
    let case = Case::new(
        NAME,
        "thin rods in a row, turned about their common axis",
        "the pivot of the first joint is exactly nothing, or what rounding left of 1",
    );
    let mut rows = Judge::<f64>::new(&case, &model).solved(&at(0.0), Ends::Singular("joint_1"), BACKWARD);
    rows.extend(Judge::<f32>::new(&case, &model).solved(&at(0.0), Ends::Singular("joint_1"), BACKWARD));
    let case = Case::new(NAME, "the same, askew in space", "turned frames leave 10⁻¹⁶ where nothing should be");
    let askew = Origin::new([0.1, 0.2, 0.3], [0.3, -0.7, 1.1]);
    let tilted = Builder::new("rods").link(None, JointKind::Continuous, X, askew, rod).turn(Y, [1.0, 0.0, 0.0], rod).turn(
        [0.0, 0.6, 0.8],
        [1.0, 0.0, 0.0],
        rod,
    );
    rows.extend(Judge::<f64>::new(&case, &tilted.model()).solved(&at(0.0), Ends::Singular("joint_1"), BACKWARD));
    let case = Case::new(NAME, "the same, bent by 0.1°", "what is left of the pivot is a millionth of its terms");
    let bent = at(0.1_f64.to_radians());
    rows.extend(Judge::<f64>::new(&case, &model).all(&bent, Ends::Solved, 16.0));
    rows
}

/// Two joints about one axis, without a link between them.
fn repeated() -> Vec<Row> {
    let case = Case::new(
        NAME,
        "two coaxial joints with a massless link between",
        "every row of M has something in it, and yet M is singular in every configuration",
    );
    let body = Some(Body::of_radii(1.0, [0.4, 0.02, -0.03], [0.1, 0.25, 0.24]));
    let model = Builder::new("twice").turn(Y, [0.0; 3], body).turn(Z, [0.5, 0.0, 0.0], None).turn(Z, [0.0, 0.0, 0.2], body).model();
    let states = states(&model, 3, 17, 1.0);
    let mut rows = Judge::<f64>::new(&case, &model).solved(&states, Ends::Singular("joint_2"), BACKWARD);
    rows.extend(Judge::<f32>::new(&case, &model).solved(&states, Ends::Singular("joint_2"), BACKWARD));
    rows.push(case.holds("massless_joints names it", model.massless_joints() == [BodyId(2)]));
    rows
}

/// The same with almost no mass between, on a slide: the two turn against each other a billion
/// times as fast as the other motions, and their rounding errors reach the slide, which they do not
/// move. With refinement they do not reach it.
fn nearly_repeated() -> Vec<Row> {
    let case = Case::new(
        NAME,
        "two coaxial joints with a link of a milligram between, on a slide",
        "accelerations of 1e9 rad/s² that cancel, and a row of M in which they are not",
    )
    .by_terms();
    let body = |mass: f64, center, radius: f64| Some(Body::of_radii(mass, center, [radius; 3]));
    let model = Builder::new("nearly")
        .link(None, JointKind::Prismatic, X, Origin::default(), body(1.0, [0.0; 3], 0.1))
        .turn(X, [0.0; 3], body(1e-6, [0.0; 3], 0.01))
        .turn(X, [0.0; 3], body(10.0, [0.0, 0.0, -0.2], 0.1))
        .turn(Y, [0.2, -0.4, -0.4], body(10.0, [-0.4, 0.0, 0.0], 0.1))
        .model();
    Judge::<f64>::new(&case, &model).solved(&states(&model, 8, 18, 1.0), Ends::Solved, f64::INFINITY)
}
