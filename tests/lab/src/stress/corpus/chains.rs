//! Long chains: condition numbers that grow as the fourth power of the number of joints.

use articulated_core::algorithm::FunctionId;
use articulated_core::description::Base;

use super::Effort;
use crate::stress::condition::condition;
use crate::stress::judge::{BACKWARD, Ends, Judge, call};
use crate::stress::robots::{Shape, built, chain, state};
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "chains";

const WHY: &str = "the mass matrix of N alike rods in a row has a condition number of some 3.9 N⁴";

pub(super) fn rows(effort: Effort) -> Vec<Row> {
    let lengths: &[usize] = if effort == Effort::Full { &[2, 4, 8, 16, 32, 64, 128, 256] } else { &[2, 8, 32, 100] };
    let mut rows = Vec::new();
    for &n in lengths {
        for shape in [Shape::Straight, Shape::Folded, Shape::ZigZag] {
            rows.extend(one(n, shape, 1.0));
        }
    }
    for n in [8, 16, 25] {
        rows.extend(one(n, Shape::Straight, 0.5));
    }
    rows.extend(long(if effort == Effort::Full { 1000 } else { 300 }));
    rows
}

fn one(n: usize, shape: Shape, ratio: f64) -> Vec<Row> {
    let tapering = ratio != 1.0;
    let name = if tapering { format!("{n} rods, each half as long as the one before") } else { format!("{n} rods, {}", shape.name()) };
    let why =
        if tapering { "masses fall by 8 and lengths by 2 from link to link, so that κ(M) grows as 32 to the number of rods" } else { WHY };
    let case = Case::new(NAME, name, why);
    let model = built(&chain(n, ratio), Base::Fixed);
    let states = [state(shape.angles(n), n, 1, 10.0), state(shape.angles(n), n, 2, 1e-3)];
    let mut rows = Vec::new();
    let small = n <= 8;
    let double = Judge::<f64>::new(&case, &model);
    rows.extend(double.forward(&states[..1], small));
    rows.extend(double.solved(&states, Ends::Solved, BACKWARD));
    let single = Judge::<f32>::new(&case, &model);
    rows.extend(single.forward(&states[..1], small));
    rows.extend(single.solved(&states, if n < 30 && !tapering { Ends::Solved } else { Ends::Either }, BACKWARD));
    if shape == Shape::Straight && !tapering && n >= 8 {
        let law = 3.9 * (n as f64).powi(4);
        let kappa = condition(&call(FunctionId::mass_matrix, &model, &[states[0].q.clone()]), &vec![1.0; n]);
        rows.push(case.between("κ₂(M) over 3.9 N⁴, f64", kappa / law, [0.5, 2.0], ""));
    }
    rows
}

/// Linear in the number of joints: recursions alone.
fn long(n: usize) -> Vec<Row> {
    let case = Case::new(
        NAME,
        format!("{n} rods, zig-zag, recursions"),
        "a thousand joints: no matrix is formed, errors may still add up from joint to joint",
    );
    let model = built(&chain(n, 1.0), Base::Fixed);
    let states = [state(Shape::ZigZag.angles(n), n, 3, 10.0)];
    let judge = Judge::<f64>::new(&case, &model);
    judge.recursions(&states)
}
